//! What a YAML document holds, duplicates and all, and where each part stands
//! in the text.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::quantity::number;

/// A value, and the bytes of the text that it stands in.
#[derive(Clone, Debug)]
pub(crate) struct Content {
    pub at: Range<usize>,
    pub value: Value,
}

/// A YAML value. What an alias repeats is shared with its anchor, and stands where that is. Maps
/// keep every entry in its order, so that a key given twice can be shown where it stands.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Null,
    Bool(bool),
    Integer(i64),
    Number(f64),
    Text(Arc<str>),
    Sequence(Arc<[Content]>),
    Map(Arc<[(Content, Content)]>),
    /// A value with a tag such as `!degrees`, which no document here uses.
    Tagged(Arc<str>),
}

impl Content {
    /// The value as a text.
    pub fn text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }
}

/// The value in words, for "expected a list, found ...".
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Null => f.write_str("nothing"),
            Self::Bool(value) => write!(f, "`{value}`"),
            Self::Integer(value) => write!(f, "the number {value}"),
            Self::Number(value) => write!(f, "the number {}", number(*value)),
            Self::Text(text) if text.chars().nth(40).is_none() && !text.contains('\n') => write!(f, "`{text}`"),
            Self::Text(_) => f.write_str("a text"),
            Self::Sequence(_) => f.write_str("a list"),
            Self::Map(_) => f.write_str("a map"),
            Self::Tagged(tag) => write!(f, "the tag `{tag}`"),
        }
    }
}

/// How many characters a value covers of the line that it begins in, of which `rest` is what is
/// there from the value on.
pub(super) fn width(rest: &str, content: &Content) -> usize {
    let is_block = !rest.starts_with(['[', '{']);
    let end = match &content.value {
        // What is written without brackets ends lines further on; its beginning is shown.
        Value::Sequence(_) | Value::Map(_) if is_block => {
            [",", "}", "]", " #", ": "].iter().filter_map(|end| rest.find(end)).min()
        }
        _ => Some(content.at.len()),
    };
    let shown = rest.get(..end.unwrap_or(rest.len())).unwrap_or(rest).trim_end();
    (if is_block { shown.trim_end_matches(':') } else { shown }).chars().count()
}
