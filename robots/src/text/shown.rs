//! Text of files and names of files, as it is shown to people.

/// A text in which nothing is hidden: characters that turn the direction of writing are spelled
/// out, since with them a line reads as another one than it is (CVE-2021-42574); other control
/// characters, which could move a terminal's cursor, are replaced, but for line feeds and tabs.
pub fn shown(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '\n' | '\t' => shown.push(character),
            turn if is_bidirectional(turn) => shown.extend(turn.escape_unicode()),
            control if control.is_control() => shown.push('\u{fffd}'),
            other => shown.push(other),
        }
    }
    shown
}

/// The same in one line: of a name, or of a line that is quoted.
pub fn shown_in_line(text: &str) -> String {
    shown(text).replace(['\n', '\t'], "\u{fffd}")
}

/// Whether a character turns the direction of writing: Unicode's `Bidi_Control`.
pub fn is_bidirectional(character: char) -> bool {
    matches!(character, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_turns_the_direction_of_writing_is_spelled_out() {
        let all: String = ['\u{61c}', '\u{200e}', '\u{200f}']
            .into_iter()
            .chain('\u{202a}'..='\u{202e}')
            .chain('\u{2066}'..='\u{2069}')
            .collect();
        let said = shown(&all);
        assert!(said.starts_with("\\u{61c}\\u{200e}") && said.ends_with("\\u{2069}") && said.is_ascii(), "{said}");
        assert_eq!(said.matches("\\u{").count(), all.chars().count());
    }

    #[test]
    fn control_characters_move_no_cursor() {
        assert_eq!(shown("a\u{1b}[2Jb\r\tc\nd"), "a\u{fffd}[2Jb\u{fffd}\tc\nd");
        assert_eq!(shown_in_line("a\u{1b}b\nc"), "a\u{fffd}b\u{fffd}c");
        assert_eq!(shown("µm, 机器, e\u{301}"), "µm, 机器, e\u{301}");
    }
}
