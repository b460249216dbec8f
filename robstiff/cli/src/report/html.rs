//! Pieces of HTML. Names and texts come from files: everything passes
//! [`escape`].

use std::fmt::Display;

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
