//! What a YAML document holds, duplicates and all, and where each part stands
//! in the text.

use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error, IgnoredAny, MapAccess, SeqAccess, VariantAccess,
    Visitor,
};
use std::fmt;

use crate::quantity::number;

/// A YAML value. Maps keep every entry in its order, so that a key given twice
/// can be shown where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Content {
    Null,
    Bool(bool),
    Integer(i64),
    Number(f64),
    Text(String),
    Sequence(Vec<Content>),
    Map(Vec<(Content, Content)>),
    /// A value with a tag such as `!degrees`, which no document here uses.
    Tagged(String),
}

/// The value in words, for "expected a list, found ...".
impl fmt::Display for Content {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Null => f.write_str("nothing"),
            Self::Bool(value) => write!(f, "`{value}`"),
            Self::Integer(value) => write!(f, "the number {value}"),
            Self::Number(value) => write!(f, "the number {}", number(*value)),
            Self::Text(text) if text.chars().count() <= 40 && !text.contains('\n') => write!(f, "`{text}`"),
            Self::Text(_) => f.write_str("a text"),
            Self::Sequence(_) => f.write_str("a list"),
            Self::Map(_) => f.write_str("a map"),
            Self::Tagged(tag) => write!(f, "the tag `{}{tag}`", if tag.starts_with('!') { "" } else { "!" }),
        }
    }
}

impl<'de> Deserialize<'de> for Content {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ContentVisitor)
    }
}

struct ContentVisitor;

impl<'de> Visitor<'de> for ContentVisitor {
    type Value = Content;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("any YAML value")
    }

    fn visit_unit<E>(self) -> Result<Content, E> {
        Ok(Content::Null)
    }

    fn visit_none<E>(self) -> Result<Content, E> {
        Ok(Content::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Content, E> {
        Ok(Content::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Content, E> {
        Ok(Content::Integer(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Content, E> {
        Ok(i64::try_from(value).map_or(Content::Number(value as f64), Content::Integer))
    }

    fn visit_i128<E>(self, value: i128) -> Result<Content, E> {
        Ok(Content::Number(value as f64))
    }

    fn visit_u128<E>(self, value: u128) -> Result<Content, E> {
        Ok(Content::Number(value as f64))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Content, E> {
        Ok(Content::Number(value))
    }

    fn visit_str<E>(self, value: &str) -> Result<Content, E> {
        Ok(Content::Text(value.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Content, A::Error> {
        let mut sequence = Vec::new();
        while let Some(item) = items.next_element()? {
            sequence.push(item);
        }
        Ok(Content::Sequence(sequence))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Content, A::Error> {
        let mut map = Vec::new();
        while let Some(entry) = entries.next_entry()? {
            map.push(entry);
        }
        Ok(Content::Map(map))
    }

    fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<Content, A::Error> {
        let (tag, value) = data.variant::<String>()?;
        value.newtype_variant::<IgnoredAny>()?;
        Ok(Content::Tagged(tag))
    }
}

/// One step from a value to a part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// The key of a map's entry, counted from 0.
    Key(usize),
    /// The value of a map's entry.
    Value(usize),
    /// An item of a sequence.
    Item(usize),
}

/// Line and column, from 1, of the part of `text` at the end of `path`.
///
/// The parser tells places in its errors only, so this reads the text again and
/// raises one there. A part reached through an alias is where its anchor is.
pub(super) fn locate(text: &str, path: &[Step]) -> (usize, usize) {
    match (Raise { path }).deserialize(serde_yaml::Deserializer::from_str(text)) {
        Err(error) => error.location().map_or((1, 1), |at| (at.line(), at.column())),
        Ok(never) => match never {},
    }
}

enum Never {}

struct Raise<'p> {
    path: &'p [Step],
}

impl<'de> DeserializeSeed<'de> for Raise<'_> {
    type Value = Never;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Never, D::Error> {
        deserializer.deserialize_any(self)
    }
}

fn here<E: Error>() -> Result<Never, E> {
    Err(E::custom("here"))
}

impl<'de> Visitor<'de> for Raise<'_> {
    type Value = Never;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Scalars end here: serde's default for them is an error at their place.
        f.write_str("the end of the path")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Never, A::Error> {
        if let [Step::Item(index), rest @ ..] = self.path {
            for _ in 0..*index {
                items.next_element::<IgnoredAny>()?;
            }
            items.next_element_seed(Raise { path: rest })?;
        }
        here()
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Never, A::Error> {
        if let [Step::Key(index) | Step::Value(index), ..] = self.path {
            for _ in 0..*index {
                entries.next_entry::<IgnoredAny, IgnoredAny>()?;
            }
        }
        match self.path {
            [Step::Key(_), ..] => {
                entries.next_key_seed(Raise { path: &[] })?;
            }
            [Step::Value(_), rest @ ..] => {
                entries.next_key::<IgnoredAny>()?;
                entries.next_value_seed(Raise { path: rest })?;
            }
            _ => {}
        }
        here()
    }

    fn visit_enum<A: EnumAccess<'de>>(self, _: A) -> Result<Never, A::Error> {
        here()
    }
}

/// The line of `text` with this number, from 1; empty beyond the end. Lines
/// end where the YAML parser ends them.
pub(super) fn source_line(text: &str, line: usize) -> &str {
    let mut rest = text;
    for _ in 1..line {
        let Some(end) = rest.find(is_break) else { return "" };
        rest = &rest[end..];
        rest = match rest.strip_prefix("\r\n") {
            Some(after) => after,
            None => &rest[rest.chars().next().map_or(0, char::len_utf8)..],
        };
    }
    rest.split(is_break).next().unwrap_or_default()
}

/// How many lines there are, the one behind the last break among them.
pub(super) fn line_count(text: &str) -> usize {
    1 + text.matches(is_break).count() - text.matches("\r\n").count()
}

fn is_break(character: char) -> bool {
    matches!(character, '\n' | '\r' | '\u{85}' | '\u{2028}' | '\u{2029}')
}

/// How many characters of its line the part that starts `rest` covers.
pub(super) fn extent(rest: &str, content: &Content) -> usize {
    let bytes = match rest.chars().next() {
        Some('"' | '\'') => quoted(rest).unwrap_or(rest.len()),
        Some('{' | '[') => closing_bracket(rest).unwrap_or(rest.trim_end().len()),
        Some('|' | '>') => 1,
        _ => match content {
            Content::Text(text) if !text.is_empty() && rest.starts_with(text.as_str()) => text.len(),
            _ => {
                let ends = [",", "}", "]", " #", ": "].iter().filter_map(|end| rest.find(end));
                rest[..ends.min().unwrap_or(rest.len())].trim_end().trim_end_matches(':').len()
            }
        },
    };
    rest[..bytes].chars().count()
}

/// The bytes of the text in quotes that starts `rest`, if it ends there.
fn quoted(rest: &str) -> Option<usize> {
    let mut characters = rest.char_indices().peekable();
    let (_, quote) = characters.next()?;
    while let Some((at, character)) = characters.next() {
        // Between double quotes a backslash escapes, between single ones a quote another.
        let escapes = match quote {
            '"' => character == '\\',
            _ => character == quote && characters.peek().is_some_and(|(_, next)| *next == quote),
        };
        if escapes {
            characters.next();
        } else if character == quote {
            return Some(at + 1);
        }
    }
    None
}

/// The bytes of the list or map in brackets that starts `rest`, if it ends there.
fn closing_bracket(rest: &str) -> Option<usize> {
    let (mut depth, mut at) = (0_usize, 0);
    while let Some(character) = rest[at..].chars().next() {
        match character {
            '"' | '\'' => {
                at += quoted(&rest[at..])?;
                continue;
            }
            '{' | '[' => depth += 1,
            '}' | ']' if depth == 1 => return Some(at + 1),
            '}' | ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        at += character.len_utf8();
    }
    None
}
