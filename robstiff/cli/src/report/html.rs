//! Pieces of HTML. Names and texts come from files: everything passes
//! [`escape`], or [`data`] where a script reads it.

use std::fmt::Display;

use robstiff_robots::text::is_bidirectional;
use serde_json::Value;
use sha2::{Digest as _, Sha256};

use super::base64::base64;

/// A page of its own that loads nothing and runs nothing but its style and its script: its policy
/// names these two by what they are, so that whatever a file's text would slip in does nothing.
pub fn page(title: &str, style: &str, body: &str, script: &str) -> String {
    let [style, script] = [style, script].map(|text| format!("\n{text}"));
    let hash = |text: &str| format!("'sha256-{}'", base64(&Sha256::digest(text.as_bytes())));
    let (runs, scripts) = match script.trim() {
        "" => (String::new(), "'none'".to_owned()),
        _ => (format!("<script>{script}</script>\n"), hash(&script)),
    };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src {}; \
         script-src {scripts}; base-uri 'none'; form-action 'none'\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{}</title>\n<style>{style}</style>\n</head>\n<body>\n{body}{runs}</body>\n</html>\n",
        hash(&style),
        escape(title)
    )
}

/// What a script reads, by the name of its element. Nothing in a text ends the element, and what
/// turns the direction of writing is spelled out, as in [`escape`].
pub fn data(id: &str, document: &Value) -> String {
    let mut text = String::new();
    for character in document.to_string().chars() {
        match character {
            '<' => text += "\\u003c",
            // Strings only have them, in which the first backslash is for the second.
            turn if is_bidirectional(turn) => text += &format!("\\{}", turn.escape_unicode()),
            other => text.push(other),
        }
    }
    format!("<script type=\"application/json\" id=\"{id}\">{text}</script>\n")
}

/// Text as it can stand in an element or an attribute.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\'' => escaped += "&#39;",
            turn if is_bidirectional(turn) => escaped.extend(turn.escape_unicode()),
            control if control.is_control() && control != '\n' => escaped.push('\u{fffd}'),
            other => escaped.push(other),
        }
    }
    escaped
}

/// An element around HTML.
pub fn element(name: &str, inner: impl Display) -> String {
    format!("<{name}>{inner}</{name}>\n")
}

/// An element around text.
pub fn text(name: &str, text: &str) -> String {
    element(name, escape(text))
}

/// A cell of a table.
pub enum Cell {
    /// Words.
    Words(String),
    /// A number, which lines up at the right.
    Number(String),
    /// HTML that is made of escaped parts.
    Html(String),
}

/// Words for a cell.
pub fn words(text: impl Into<String>) -> Cell {
    Cell::Words(text.into())
}

/// A number for a cell.
pub fn number(text: impl Into<String>) -> Cell {
    Cell::Number(text.into())
}

/// A table; headings over columns of numbers stand at the right like them.
pub struct Table {
    head: Vec<Cell>,
    rows: Vec<(bool, Vec<Cell>)>,
}

impl Table {
    /// A table with its headings.
    pub fn new(head: impl IntoIterator<Item = Cell>) -> Self {
        Self { head: head.into_iter().collect(), rows: Vec::new() }
    }

    /// Adds a row, which may be one that matters more.
    pub fn row(&mut self, strong: bool, cells: impl IntoIterator<Item = Cell>) {
        self.rows.push((strong, cells.into_iter().collect()));
    }

    /// The table as HTML, in a frame that scrolls where it is too wide.
    pub fn html(&self) -> String {
        let head: String = self.head.iter().map(|cell| cell.html("th")).collect();
        let rows = self.rows.iter().map(|(strong, cells)| {
            let cells: String = cells.iter().map(|cell| cell.html("td")).collect();
            format!("<tr{}>{cells}</tr>\n", if *strong { " class=\"strong\"" } else { "" })
        });
        let body: String = rows.collect();
        format!(
            "<div class=\"scroll\"><table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody>\n</table></div>\n"
        )
    }
}

impl Cell {
    fn html(&self, tag: &str) -> String {
        match self {
            Self::Words(text) => format!("<{tag}>{}</{tag}>", escape(text)),
            Self::Number(text) => format!("<{tag} class=\"number\">{}</{tag}>", escape(text)),
            Self::Html(html) => format!("<{tag}>{html}</{tag}>"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The digest of `echo -n 'x' | openssl dgst -sha256 -binary | base64`.
    #[test]
    fn a_policy_names_what_is_between_the_tags() {
        let hash = |text: &str| base64(&Sha256::digest(text.as_bytes()));
        assert_eq!(hash("x"), "LXEWQrcmsEQBYnyp+6wy9chTD7GQPMTbAiWHF5IaSIE=");
        let page = page("a < b", "p { color: red; }\n", "<p>c</p>\n", "run();\n");
        let between = |open: &str, close: &str| page.split_once(open).unwrap().1.split_once(close).unwrap().0;
        for (name, text) in [("style", between("<style>", "</style>")), ("script", between("<script>", "</script>"))] {
            assert!(page.contains(&format!("{name}-src 'sha256-{}'", hash(text))), "{page}");
        }
        assert!(page.contains("<title>a &lt; b</title>"), "{page}");
        assert!(super::page("", "", "", "").contains("script-src 'none'"));
    }

    #[test]
    fn what_a_script_reads_ends_no_element_and_turns_no_line() {
        let document = serde_json::json!({ "name": "</script>\u{202e}\u{2066}" });
        let said = data("data", &document);
        let inside = said.split_once('>').unwrap().1.rsplit_once("</script>").unwrap().0;
        assert!(!inside.contains('<') && inside.is_ascii(), "{inside}");
        let read: Value = serde_json::from_str(inside).unwrap();
        assert_eq!(read["name"], "</script>\\u{202e}\\u{2066}");
        assert_eq!(escape("\u{202e}<"), "\\u{202e}&lt;");
    }
}
