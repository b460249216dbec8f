//! The statements of a module.

use std::ops::Range;

use crate::program::source::Sources;

/// A statement: the file and the bytes, with the `;` where it has one.
pub(super) type Place = (usize, Range<usize>);

/// A routine: its name and its statements.
pub(super) struct Routine {
    pub(super) name: String,
    pub(super) statements: Vec<Place>,
}

/// What the files hold.
#[derive(Default)]
pub(super) struct Contents {
    /// The name of the first module.
    pub(super) module: Option<String>,
    pub(super) routines: Vec<Routine>,
    /// Statements outside of routines: declarations and comments.
    pub(super) outside: Vec<Place>,
}

/// Words that begin a statement that ends with its line.
const LINES: [&str; 22] = [
    "MODULE",
    "ENDMODULE",
    "PROC",
    "ENDPROC",
    "FUNC",
    "ENDFUNC",
    "TRAP",
    "ENDTRAP",
    "RECORD",
    "ENDRECORD",
    "IF",
    "ELSEIF",
    "ELSE",
    "ENDIF",
    "FOR",
    "ENDFOR",
    "WHILE",
    "ENDWHILE",
    "ENDTEST",
    "ERROR",
    "UNDO",
    "BACKWARD",
];

/// The first word of a statement in upper case, behind `LOCAL`.
pub(super) fn first_word(sources: &Sources, (file, bytes): &Place) -> String {
    let mut cursor = sources.cursor(*file, bytes.clone());
    cursor.eat_word("LOCAL");
    cursor.word().unwrap_or_default().to_ascii_uppercase()
}

/// The modules of all files, taken apart.
pub(super) fn contents(sources: &mut Sources) -> Contents {
    let mut contents = Contents::default();
    for file in 0..sources.count() {
        let mut open: Option<Routine> = None;
        let (mut any, mut at) = (false, None);
        for place in statements(sources, file) {
            let first = first_word(sources, &place);
            let mut cursor = sources.cursor(file, place.1.clone());
            cursor.eat_word("LOCAL");
            cursor.word();
            match first.as_str() {
                "MODULE" => {
                    any = true;
                    let name = cursor.word().unwrap_or_default().to_owned();
                    contents.module.get_or_insert(name);
                }
                "PROC" | "FUNC" | "TRAP" if open.is_none() => {
                    if first == "FUNC" {
                        cursor.word();
                    }
                    at = Some(place.1.clone());
                    open = Some(Routine { name: cursor.word().unwrap_or_default().to_owned(), statements: Vec::new() });
                }
                "ENDPROC" | "ENDFUNC" | "ENDTRAP" => contents.routines.extend(open.take()),
                _ => match &mut open {
                    Some(routine) => routine.statements.push(place),
                    None => contents.outside.push(place),
                },
            }
        }
        if let (Some(routine), Some(at)) = (open, at) {
            let message = format!("the routine `{}` does not end", routine.name);
            sources.report(file, at, message, "write `ENDPROC` below its last line");
        } else if !any {
            let first = sources.lines(file).range(1);
            let help = "a program begins with `MODULE name` and ends with `ENDMODULE`";
            sources.report(file, first, "the file has no module", help);
        }
    }
    // What the controller starts.
    contents.routines.sort_by_key(|routine| !routine.name.eq_ignore_ascii_case("main"));
    contents
}

fn statements(sources: &mut Sources, file: usize) -> Vec<Place> {
    let text = sources.text(file).to_owned();
    let (mut places, mut at) = (Vec::new(), 0);
    let mut wrong = None;
    while at < text.len() {
        let rest = &text[at..];
        let start = at + rest.len() - rest.trim_start().len();
        let rest = &text[start..];
        if rest.is_empty() {
            break;
        }
        let line = rest.find(['\n', '\r']).unwrap_or(rest.len());
        let mut cursor = sources.cursor(file, start..start + line);
        cursor.eat_word("LOCAL");
        let first = cursor.word().unwrap_or_default().to_ascii_uppercase();
        let is_mark = cursor.eat(":") && cursor.peek() != Some('=');
        let by_line = rest.starts_with(['!', '%']) || LINES.contains(&first.as_str());
        let length = if by_line {
            line
        } else if matches!(first.as_str(), "CASE" | "TEST" | "DEFAULT") || is_mark {
            rest[..line].find('!').unwrap_or(line)
        } else {
            match end(rest) {
                Some(length) => length,
                None => {
                    wrong = Some(start..start + line);
                    line
                }
            }
        };
        let length = rest[..length].trim_end().len();
        places.push((file, start..start + length.max(1)));
        at = start + length.max(1);
    }
    if let Some(bytes) = wrong {
        sources.report(file, bytes, "the statement does not end", "write `;` behind it");
    }
    places
}

/// How long a statement is, with its `;`, which may not be in quotes or a comment.
fn end(text: &str) -> Option<usize> {
    let (mut quoted, mut comment) = (false, false);
    for (at, letter) in text.char_indices() {
        match letter {
            '\n' | '\r' => (quoted, comment) = (false, false),
            _ if comment => {}
            '"' => quoted = !quoted,
            '!' if !quoted => comment = true,
            ';' if !quoted => return Some(at + 1),
            _ => {}
        }
    }
    None
}
