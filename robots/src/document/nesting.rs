//! Lists in lists, deeper than the parser goes: it finds that out only after it has read
//! all of them, in a time that grows with the square of their number.

/// The parser gives up beyond this.
pub(super) const MOST_NESTED: usize = 128;

/// Line and column, from 1, of what is nested too deep.
///
/// Text that is no list may hold brackets and dashes, too: of this it is enough that nobody
/// writes so many of them.
pub(crate) fn too_deep(text: &str) -> Option<(usize, usize)> {
    let (mut depth, mut quote, mut indents) = (0_usize, None, Vec::new());
    for (index, line) in text.lines().enumerate() {
        let mut before = ' ';
        if depth == 0
            && quote.is_none()
            && let Some(column) = block(line, &mut indents)
        {
            return Some((index + 1, column));
        }
        for (column, character) in line.chars().enumerate() {
            let begins = before.is_whitespace() || "[{,:".contains(before);
            match (quote, character) {
                // A quote that is escaped by another ends a text and begins one.
                (Some(open), _) => quote = (character != open || (open == '"' && before == '\\')).then_some(open),
                (None, '"' | '\'') if begins || before == character => quote = Some(character),
                (None, '#') if before.is_whitespace() => break,
                (None, '[' | '{') => depth += 1,
                (None, ']' | '}') => depth = depth.saturating_sub(1),
                _ => {}
            }
            if depth > MOST_NESTED {
                return Some((index + 1, column + 1));
            }
            // A backslash that is escaped escapes nothing.
            before = if before == '\\' && character == '\\' { ' ' } else { character };
        }
    }
    None
}

/// The column, from 1, at which a line is too deep in what is nested by indentation, with the
/// columns of what it is in.
fn block(line: &str, indents: &mut Vec<usize>) -> Option<usize> {
    let mut starts = Vec::new();
    let mut rest = line.trim_start_matches(' ');
    if rest.is_empty() || rest.starts_with('#') {
        return None;
    }
    // Of `- - a` every dash is one more.
    loop {
        starts.push(line.len() - rest.len());
        let Some(behind) = rest.strip_prefix("- ").or_else(|| rest.strip_prefix("? ")) else { break };
        rest = behind.trim_start_matches(' ');
    }
    indents.retain(|indent| *indent < starts[0]);
    indents.extend(starts);
    indents.get(MOST_NESTED).map(|indent| indent + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_nested_too_deep_has_a_place() {
        for open in ["[", "{a: ", "- ", "? "] {
            let text = |count: usize| format!("name: A\n{}", open.repeat(count));
            let place = (2, 1 + MOST_NESTED * open.len());
            assert_eq!(too_deep(&text(MOST_NESTED - 1)), None, "{open}");
            assert_eq!(too_deep(&text(100_000)), Some(place), "{open}");
        }
        let by_indentation: String = (0..1000).map(|depth| format!("{}a:\n", " ".repeat(depth))).collect();
        assert_eq!(too_deep(&by_indentation), Some((1 + MOST_NESTED, 1 + MOST_NESTED)));
    }

    #[test]
    fn brackets_in_texts_nest_nothing() {
        let many = "[".repeat(1000);
        for text in [
            format!("a: \"\\\"{many}\\\\\" # {many}"),
            format!("a: 'it''s {many}'\nb: {{c: '{many}'}}"),
            format!("# {many}\na: b # {many}"),
            "a: [[1], {b: [2]}]\n".repeat(1000),
            "- {a: it's}\n- [it's]\n  # b\n".repeat(1000),
        ] {
            assert_eq!(too_deep(&text), None, "{text}");
        }
    }
}
