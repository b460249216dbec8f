//! Walking a document, with checks that report rather than stop.

use std::collections::HashSet;
use std::rc::Rc;

use super::content::{Content, Value};
use super::problems::Document;
use crate::bare::in_si;
use crate::quantity::{self, Dimension};
use crate::suggest::{called, closest, list};

impl Document {
    /// The document's top value.
    pub fn root(&self) -> Node<'_> {
        Node::root(self)
    }
}

/// A value in a document, with its place.
#[derive(Clone, Debug)]
pub struct Node<'d> {
    document: &'d Document,
    content: &'d Content,
    way: Option<Rc<Step<'d>>>,
}

/// The last step to a value, and those before it. Put into words only where a problem is: the key
/// of a map may be long, and the items in it many.
#[derive(Debug)]
struct Step<'d> {
    before: Option<Rc<Step<'d>>>,
    part: Part<'d>,
}

#[derive(Clone, Copy, Debug)]
enum Part<'d> {
    Field(&'d str),
    Item(usize),
}

impl<'d> Node<'d> {
    fn root(document: &'d Document) -> Self {
        Self { document, content: &document.root, way: None }
    }

    /// The path of the value, e.g. `joints[1].theta`; items count from 0.
    pub fn path(&self) -> String {
        let mut parts = Vec::new();
        let mut way = self.way.as_deref();
        while let Some(Step { before, part }) = way {
            parts.push(*part);
            way = before.as_deref();
        }
        let mut path = String::new();
        for part in parts.into_iter().rev() {
            match part {
                Part::Item(index) => path += &format!("[{index}]"),
                Part::Field(name) => {
                    path += if path.is_empty() { "" } else { "." };
                    path += name;
                }
            }
        }
        path
    }

    /// The line of the value, from 1.
    pub fn line(&self) -> usize {
        self.document.lines.number_at(self.content.at.start)
    }

    /// What stands in the value's line from there on.
    fn rest_of_line(&self) -> &'d str {
        self.document.rest_of_line(self.content)
    }

    /// Reports a problem with this value.
    pub fn error(&self, message: impl Into<String>, help: impl Into<String>) {
        if !self.document.is_full() {
            self.document.report(self.content, self.path(), message.into(), help.into());
        }
    }

    pub(crate) fn expected(&self, what: &str, help: impl Into<String>) {
        if !self.document.is_full() {
            self.error(format!("{what} is expected here, not {}", self.content.value), help);
        }
    }

    /// Whether the value is a map.
    pub fn is_map(&self) -> bool {
        matches!(self.content.value, Value::Map(_))
    }

    /// Whether the value is a number, and as a quantity one without its unit.
    pub fn is_number(&self) -> bool {
        matches!(self.content.value, Value::Integer(_) | Value::Number(_))
    }

    /// Whether the value is a list.
    pub fn is_sequence(&self) -> bool {
        matches!(self.content.value, Value::Sequence(_))
    }

    /// The value as a map of these fields; any other field is reported.
    pub fn map(&self, fields: &[&str]) -> Option<Map<'d>> {
        let map = self.any_map(&format!("the fields are {}", list(fields.iter().copied())))?;
        for index in 0..map.entries.len() {
            let Some(name) = map.key(index) else { continue };
            if fields.contains(&name) {
                continue;
            }
            if self.document.is_full() {
                break;
            }
            let known = list(fields.iter().copied());
            let slip = map.decimal_comma(index).or_else(|| map.missing_space(index, fields));
            let help = match (slip.or_else(|| called(name, fields)), closest(name, fields.iter().copied())) {
                _ if name == "<<" => "merge keys are not supported: write the fields out".to_owned(),
                (Some(help), _) => help,
                (None, Some(meant)) => format!("did you mean `{meant}`? the fields are {known}"),
                (None, None) => format!("the fields are {known}"),
            };
            map.error_at_key(index, format!("unknown field `{name}`"), help);
        }
        Some(map)
    }

    /// The value as a map with fields of any name; `help` says what such a map
    /// looks like.
    pub fn any_map(&self, help: &str) -> Option<Map<'d>> {
        let Value::Map(entries) = &self.content.value else {
            self.expected("a map", help);
            return None;
        };
        Some(Map { node: self.clone(), entries })
    }

    /// The value as a list.
    pub fn sequence(&self) -> Option<Vec<Node<'d>>> {
        let Value::Sequence(items) = &self.content.value else {
            self.expected("a list", "write `[..]`, or one item a line, each after `- `");
            return None;
        };
        Some(items.iter().enumerate().map(|(index, content)| self.child(Part::Item(index), content)).collect())
    }

    /// The value, where it is a text; nothing is reported.
    pub(crate) fn as_text(&self) -> Option<&'d str> {
        self.content.text()
    }

    /// The value, where it is a whole number; nothing is reported.
    pub(crate) fn as_integer(&self) -> Option<i64> {
        match self.content.value {
            Value::Integer(value) => Some(value),
            _ => None,
        }
    }

    /// The value as text.
    pub fn text(&self) -> Option<&'d str> {
        let Some(text) = self.as_text() else {
            self.expected("a text", "put quotes around a text that looks like a number or another value");
            return None;
        };
        Some(text)
    }

    /// The value as one of several words.
    pub fn choice<T: Copy>(&self, words: &[(&str, T)]) -> Option<T> {
        let names = || words.iter().map(|(name, _)| *name);
        let help = format!("write one of {}", list(names()));
        let Some(text) = self.as_text() else {
            self.expected("a word", help);
            return None;
        };
        let found = words.iter().find(|(name, _)| *name == text).map(|(_, value)| *value);
        if found.is_none() {
            let close = || closest(text, names()).map(|meant| format!("did you mean `{meant}`? {help}"));
            let help = called(text, &names().collect::<Vec<_>>()).or_else(close).unwrap_or_else(|| help.clone());
            self.error(format!("unknown word `{text}`"), help);
        }
        found
    }

    /// The value as a whole number, such as `example`.
    pub fn integer(&self, example: i64) -> Option<i64> {
        let value = self.as_integer();
        let help = format!("e.g. `{example}`");
        match self.content.value {
            Value::Integer(_) => {}
            // Beyond what an integer holds the parser makes it a number.
            Value::Number(value) if value.fract() == 0.0 && value.abs() >= i64::MAX as f64 => {
                self.error(format!("{value:e} is too large a number here"), help);
            }
            Value::Number(value) if value.fract() == 0.0 => {
                self.expected("a whole number without a point or an exponent", format!("write `{value}`"));
            }
            _ => self.expected("a whole number", help),
        }
        value
    }

    /// The value as a finite quantity, in SI units: a number in SI, or a text
    /// `value unit`.
    pub fn quantity(&self, dimension: Dimension) -> Option<f64> {
        let value = match &self.content.value {
            Value::Integer(value) => quantity::checked(*value as f64, dimension),
            Value::Number(value) => quantity::checked(*value, dimension),
            Value::Text(text) => quantity::parse(text, dimension),
            _ => {
                self.expected(dimension.name(), dimension.help());
                return None;
            }
        };
        let value = value.and_then(|value| if self.is_suspect() { in_si(value, dimension) } else { Ok(value) });
        value.map_err(|error| self.error(error.message, error.help)).ok()
    }

    /// Whether it is a number without a unit that may be in another one than SI, in a
    /// [wary](Document::wary) document.
    pub fn is_suspect(&self) -> bool {
        self.document.wary && (self.is_number() || self.as_text().is_some_and(is_number))
    }

    /// A [`quantity`](Self::quantity) that is zero or positive.
    pub fn nonnegative(&self, dimension: Dimension) -> Option<f64> {
        let value = self.quantity(dimension)?;
        if value < 0.0 {
            self.error(format!("{} cannot be negative", dimension.name()), "write zero or a positive number");
            return None;
        }
        Some(value)
    }

    /// A [`quantity`](Self::quantity) that is positive.
    pub fn positive(&self, dimension: Dimension) -> Option<f64> {
        let value = self.quantity(dimension)?;
        if value <= 0.0 {
            self.error(format!("{} above zero is expected here", dimension.name()), dimension.help());
            return None;
        }
        Some(value)
    }

    /// A list of `N` quantities of one dimension.
    pub fn quantities<const N: usize>(&self, dimension: Dimension) -> Option<[f64; N]> {
        let items = self.sequence()?;
        if items.len() != N {
            let found = items.len();
            let example = || format!("write {N}, e.g. `{}`", dimension.example_list::<N>());
            let help = decimal_commas(&items, N).unwrap_or_else(example);
            self.error(format!("{N} values are expected here, not {found}"), help);
        }
        let values: Vec<Option<f64>> = items.iter().map(|item| item.quantity(dimension)).collect();
        let values: Vec<f64> = values.into_iter().collect::<Option<_>>()?;
        values.try_into().ok()
    }

    fn child(&self, part: Part<'d>, content: &'d Content) -> Self {
        let way = Some(Rc::new(Step { before: self.way.clone(), part }));
        Self { document: self.document, content, way }
    }

    /// Reports keys that stand twice and keys that are no text, here and in
    /// everything below.
    pub(super) fn check_keys(&self) {
        match &self.content.value {
            Value::Sequence(items) => {
                for (index, content) in items.iter().enumerate() {
                    self.child(Part::Item(index), content).check_keys();
                }
            }
            Value::Map(entries) => {
                let map = Map { node: self.clone(), entries };
                let mut names = HashSet::new();
                for index in 0..entries.len() {
                    map.check_key(index, &mut names);
                    map.value(index).check_keys();
                }
            }
            _ => {}
        }
    }
}

/// What is right, where a list is longer than its `count` values by as many as there are
/// decimal commas in it: `[0, 1,5 m]` reads as `[0, 1, "5 m"]`.
fn decimal_commas(items: &[Node<'_>], count: usize) -> Option<String> {
    // Who separates values does so with a blank, or there are more such places than values too
    // many.
    let meant = |item: &Node<'_>| {
        let (whole, rest) = item.rest_of_line().split_once(',')?;
        let decimals = rest.split([',', ']']).next()?.trim_end();
        let digits = whole.trim_start_matches(['+', '-', '\u{2212}']);
        let is_whole = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
        (is_whole && decimals.starts_with(|first: char| first.is_ascii_digit())).then(|| format!("{whole}.{decimals}"))
    };
    let before_the_last = items.split_last().map_or(items, |(_, before)| before);
    let meant: Vec<String> = before_the_last.iter().filter_map(meant).collect();
    let fits = !meant.is_empty() && count + meant.len() == items.len();
    fits.then(|| format!("a decimal point, not a comma: {}", list(meant.iter().map(String::as_str))))
}

/// Whether a text is a number without a unit.
fn is_number(text: &str) -> bool {
    quantity::with_plain_minus(text).trim().parse::<f64>().is_ok()
}

/// A map in a document: its fields by name. Of a field given twice, which is
/// reported on reading the document, the first counts.
#[derive(Clone, Debug)]
pub struct Map<'d> {
    node: Node<'d>,
    entries: &'d [(Content, Content)],
}

impl<'d> Map<'d> {
    /// The map as a value.
    pub fn node(&self) -> &Node<'d> {
        &self.node
    }

    /// The field of this name, if it is there.
    pub fn get(&self, name: &str) -> Option<Node<'d>> {
        (0..self.entries.len()).find(|index| self.key(*index) == Some(name)).map(|index| self.value(index))
    }

    /// The field of this name; its absence is reported with an example of it.
    pub fn require(&self, name: &str, example: &str) -> Option<Node<'d>> {
        let field = self.get(name);
        if field.is_none() {
            self.node.error(format!("the field `{name}` is missing"), format!("add it, e.g. `{example}`"));
        }
        field
    }

    /// All fields with a name, in the order of the file.
    pub fn fields(&self) -> impl Iterator<Item = (&'d str, Node<'d>)> {
        (0..self.entries.len()).filter_map(|index| Some((self.key(index)?, self.value(index))))
    }

    fn key(&self, index: usize) -> Option<&'d str> {
        self.entries[index].0.text()
    }

    fn value(&self, index: usize) -> Node<'d> {
        let content = &self.entries[index].1;
        match self.key(index) {
            Some(name) => self.node.child(Part::Field(name), content),
            None => Node { content, ..self.node.clone() },
        }
    }

    fn error_at_key(&self, index: usize, message: String, help: impl Into<String>) {
        let (document, key) = (self.node.document, &self.entries[index].0);
        document.report(key, self.value(index).path(), message, help.into());
    }

    /// What is right, where this field is what stands behind a decimal comma:
    /// `{a: 1,5 m}` reads as `{a: 1, "5 m": nothing}`.
    fn decimal_comma(&self, index: usize) -> Option<String> {
        let name = self.key(index.checked_sub(1)?)?;
        // Places are whole numbers.
        if name == "at" || !self.is_null(index) {
            return None;
        }
        let Value::Integer(_) = self.entries[index - 1].1.value else { return None };
        // As it is written: -0 and 05 are read as other numbers.
        let (whole, rest) = self.value(index - 1).rest_of_line().split_once(',')?;
        let decimals = rest.split([',', '}']).next()?.trim();
        let is_number = decimals.starts_with(|first: char| first.is_ascii_digit());
        is_number.then(|| format!("a decimal point, not a comma: `{name}: {}.{decimals}`", whole.trim()))
    }

    /// What is right, where this field has swallowed its value: `{a:1 m}` reads
    /// as `{"a:1 m": nothing}`.
    fn missing_space(&self, index: usize, fields: &[&str]) -> Option<String> {
        let (name, value) = self.key(index)?.split_once(':')?;
        (self.is_null(index) && fields.contains(&name)).then(|| format!("a space after `:`, e.g. `{name}: {value}`"))
    }

    fn is_null(&self, index: usize) -> bool {
        matches!(self.entries[index].1.value, Value::Null)
    }

    /// Reports a key that is no text or one of the `names` before it.
    fn check_key(&self, index: usize, names: &mut HashSet<&'d str>) {
        if let Some(name) = self.key(index) {
            if !names.insert(name) && !self.node.document.is_full() {
                self.error_at_key(index, format!("the field `{name}` is given twice"), "keep one of the two");
            }
        } else if !self.node.document.is_full() {
            // `{at: joints 2,3}` reads as `{at: joints 2, 3: nothing}`.
            let quotes = || "inside `{..}` a text with a comma needs quotes, e.g. `at: \"joints 2,3\"`".to_owned();
            let help = self.decimal_comma(index).unwrap_or_else(quotes);
            let key = &self.entries[index].0.value;
            self.error_at_key(index, format!("the name of a field is expected here, not {key}"), help);
        }
    }
}
