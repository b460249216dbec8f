//! YAML documents that people write, read so that every problem is reported
//! with its line, its column and what would be right.
//!
//! A [`Document`] is walked with [`Node`]s. A check that fails records a
//! problem and gives `None`; the reader goes on, and [`Document::finish`] hands
//! out either the value or all the problems:
//!
//! ```
//! use robstiff_robots::document::Document;
//! use robstiff_robots::quantity::Dimension;
//!
//! let document = Document::parse("spindle.yaml", "name: HSC\nlength: 120 mn\n").unwrap();
//! let value = document.root().map(&["name", "length"]).and_then(|map| {
//!     let name = map.require("name", "name: HSC").and_then(|node| node.text());
//!     let length = map.require("length", "length: 120 mm").and_then(|node| node.quantity(Dimension::Length));
//!     Some((name?.to_owned(), length?))
//! });
//! let problems = document.finish(value).unwrap_err();
//! assert!(problems.to_string().starts_with("error: unknown unit `mn` for a length\n --> spindle.yaml:2:9  (length)"));
//! ```

mod content;
mod load;
mod node;
mod problems;
mod scalar;

pub(crate) use content::{Content, Value};
pub use node::{Map, Node};
pub use problems::Document;

use crate::diagnostic::{Diagnostic, Diagnostics, Line};
use crate::text::Lines;
use load::{Refusal, load};

impl Document {
    /// Reads a document; `file` is the name that problems show.
    ///
    /// It takes a time and a memory that grow with the text alone, whatever that is: aliases share
    /// what they repeat, and may not repeat much.
    ///
    /// # Errors
    /// What is not YAML, with its place; more text than
    /// [`MOST_OF_DOCUMENT`](crate::text::MOST_OF_DOCUMENT), lists and maps that are nested too deep,
    /// aliases that repeat too much.
    pub fn parse(file: &str, text: &str) -> Result<Self, Diagnostics> {
        let text = without_byte_order_mark(text);
        let root = load(text).map_err(|(refusal, _)| refused(file, text, refusal))?;
        let document = Self::new(file, text, root);
        document.root().check_keys();
        Ok(document)
    }
}

/// The text as the parser wants it: it takes a mark for a document of its own.
pub(crate) fn without_byte_order_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// The fields of the map that a text is, or begins to be before it breaks.
pub(crate) fn fields_before_the_break(text: &str) -> Vec<(Content, Content)> {
    match load(without_byte_order_mark(text)) {
        Ok(Content { value: Value::Map(entries), .. }) => entries.to_vec(),
        Ok(_) => Vec::new(),
        Err((_, entries)) => entries,
    }
}

fn refused(file: &str, text: &str, Refusal { at, message, help }: Refusal) -> Diagnostic {
    let lines = Lines::new(text);
    let (number, column) = lines.place(at.start);
    let end = at.end.min(lines.range(number).end).max(at.start);
    let place = (column, text.get(at.start..end).unwrap_or_default().chars().count());
    Diagnostic::new(file, Line { number, text: lines.line(number) }, place, message, help)
}
