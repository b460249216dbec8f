//! From the text of a YAML document to what it holds, in one pass, in a time and a memory that
//! grow with the text alone.

use std::collections::HashMap;
use std::mem;
use std::ops::Range;

use granit_parser::{ErrorKind, Event, Options, Parser, ScalarStyle, ScanError, Span, Tag};

use super::content::{Content, Value};
use super::scalar::plain;
use crate::text::{MOST_OF_DOCUMENT, larger};

/// Lists and maps in each other: a document needs a few, and what walks it calls itself for each.
const MOST_NESTED: usize = 128;

/// Bytes of the text that aliases may repeat, all together: without a limit, ten lines in which
/// each repeats the line before nine times are a thousand million values.
const MOST_REPEATED: usize = 1 << 20;

/// Why a text is no document.
#[derive(Debug, PartialEq)]
pub(super) struct Refusal {
    /// The bytes that are wrong.
    pub at: Range<usize>,
    pub message: String,
    pub help: &'static str,
}

const SYNTAX: &str =
    "one document a file; indent with spaces, put a space after every `:`, close every bracket and quote";

/// A document; or why it is none, with the fields of its map that come before.
pub(super) fn load(text: &str) -> Result<Content, (Refusal, Vec<(Content, Content)>)> {
    let mut loader = Loader { text, ..Loader::default() };
    match loader.run() {
        Ok(()) => Ok(loader.root.unwrap_or(Content { at: 0..0, value: Value::Null })),
        Err(refusal) => {
            let fields = match loader.open.into_iter().next().map(|open| open.parts) {
                Some(Parts::Map(entries, _)) => entries,
                _ => Vec::new(),
            };
            Err((refusal, fields))
        }
    }
}

#[derive(Default)]
struct Loader<'t> {
    text: &'t str,
    root: Option<Content>,
    /// The lists and maps that are not closed yet, the outermost first.
    open: Vec<Open>,
    /// What has an anchor, by the parser's number of that.
    anchors: HashMap<usize, Anchored>,
    /// Bytes that aliases have repeated.
    repeated: usize,
}

/// A list or a map that is not closed yet.
struct Open {
    /// Its first byte.
    start: usize,
    anchor: Option<usize>,
    /// What is taken in its place, where it has a tag.
    tag: Option<Content>,
    parts: Parts,
    /// How deep the lists and maps in it are nested.
    depth: usize,
    /// What aliases had repeated before it.
    repeated: usize,
}

enum Parts {
    Sequence(Vec<Content>),
    /// The entries, and the key of the next.
    Map(Vec<(Content, Content)>, Option<Content>),
}

/// What an alias repeats.
struct Anchored {
    content: Content,
    depth: usize,
    /// The bytes of it, with those that it repeats itself.
    bytes: usize,
}

impl Loader<'_> {
    fn run(&mut self) -> Result<(), Refusal> {
        if self.text.len() > MOST_OF_DOCUMENT {
            let message = format!("this document is {}", larger(MOST_OF_DOCUMENT));
            return Err(Refusal { at: 0..0, message, help: "give tables of numbers as CSV" });
        }
        if let Some((at, character)) = self.text.char_indices().find(|(_, character)| !is_printable(*character)) {
            return Err(syntax(at..at + character.len_utf8(), "control characters are not allowed"));
        }
        let mut options = Options::default();
        options.set_emit_comments(false);
        (options.flow_nesting_limit, options.block_nesting_limit) = (MOST_NESTED, MOST_NESTED);
        let text = self.text;
        let mut documents = 0;
        for event in Parser::new_from_str_with_options(text, options) {
            let (event, span) = event.map_err(|error| self.refused(&error))?;
            if matches!(event, Event::DocumentStart(..)) {
                documents += 1;
            }
            if documents > 1 {
                let at = self.bytes(&span);
                return Err(syntax(at.start..at.start + 1, "a second document begins here"));
            }
            self.take(event, &span)?;
        }
        Ok(())
    }

    fn take(&mut self, event: Event<'_>, span: &Span) -> Result<(), Refusal> {
        let at = self.bytes(span);
        match event {
            Event::Scalar(text, style, anchor, tag) => {
                let value = scalar(&text, style, tag.as_deref());
                let bytes = at.len().max(1);
                let at = match value {
                    Value::Tagged(_) => self.of_tag(span),
                    // Nothing is behind its colon.
                    _ if at.is_empty() && self.text[at.start..].starts_with(':') => at.start + 1..at.start + 1,
                    _ => at,
                };
                self.close(Content { at, value }, Some(anchor).filter(|id| *id > 0), 0, bytes);
            }
            Event::SequenceStart(_, anchor, tag) => {
                self.open(span, anchor, tag.as_deref(), Parts::Sequence(Vec::new()))?;
            }
            Event::MappingStart(_, anchor, tag) => {
                self.open(span, anchor, tag.as_deref(), Parts::Map(Vec::new(), None))?;
            }
            Event::SequenceEnd | Event::MappingEnd => {
                let Some(Open { start, anchor, tag, parts, depth, repeated }) = self.open.pop() else { return Ok(()) };
                let at = start..at.end.max(start);
                let bytes = at.len() + (self.repeated - repeated);
                let content = tag.unwrap_or_else(|| {
                    let value = match parts {
                        Parts::Sequence(items) => Value::Sequence(items.into()),
                        Parts::Map(entries, _) => Value::Map(entries.into()),
                    };
                    Content { at, value }
                });
                self.close(content, anchor, depth + 1, bytes);
            }
            Event::Alias(id) => self.repeat(id, at)?,
            _ => {}
        }
        Ok(())
    }

    fn open(&mut self, span: &Span, anchor: usize, tag: Option<&Tag>, parts: Parts) -> Result<(), Refusal> {
        let tag = tag.and_then(local).map(|value| Content { at: self.of_tag(span), value });
        let (anchor, start) = (Some(anchor).filter(|id| *id > 0), self.bytes(span).start);
        self.open.push(Open { start, anchor, tag, parts, depth: 0, repeated: self.repeated });
        if self.open.len() > MOST_NESTED { Err(nested(start)) } else { Ok(()) }
    }

    /// Takes a value that is complete.
    fn close(&mut self, content: Content, anchor: Option<usize>, depth: usize, bytes: usize) {
        if let Some(id) = anchor {
            self.anchors.insert(id, Anchored { content: content.clone(), depth, bytes });
        }
        self.put(content, depth);
    }

    /// Puts a value where it belongs.
    fn put(&mut self, content: Content, depth: usize) {
        let Some(open) = self.open.last_mut() else {
            self.root = Some(content);
            return;
        };
        open.depth = open.depth.max(depth);
        match &mut open.parts {
            Parts::Sequence(items) => items.push(content),
            Parts::Map(entries, key) => match mem::take(key) {
                None => *key = Some(content),
                Some(name) => entries.push((name, content)),
            },
        }
    }

    fn repeat(&mut self, id: usize, at: Range<usize>) -> Result<(), Refusal> {
        let Some(Anchored { content, depth, bytes }) = self.anchors.get(&id) else {
            return Err(syntax(at, "what this repeats is not complete yet"));
        };
        if self.open.len() + depth > MOST_NESTED {
            return Err(nested(at.start));
        }
        self.repeated = self.repeated.saturating_add(*bytes);
        if self.repeated > MOST_REPEATED {
            let message = format!("aliases repeat more than {} MiB of this document", MOST_REPEATED >> 20);
            return Err(Refusal { at, message, help: "write out what is meant, or repeat less" });
        }
        let (content, depth) = (content.clone(), *depth);
        self.put(content, depth);
        Ok(())
    }

    fn bytes(&self, span: &Span) -> Range<usize> {
        let most = self.text.len();
        let range = span.byte_range().unwrap_or(0..0);
        range.start.min(most)..range.end.min(most)
    }

    fn of_tag(&self, span: &Span) -> Range<usize> {
        self.bytes(&span.tag_span().unwrap_or(*span))
    }

    /// The innermost bracket that is open at a byte, where it is on a line before: most likely it is
    /// that which was to be closed.
    fn bracket_before(&self, at: usize) -> String {
        let line = |byte: usize| 1 + self.text[..byte].matches('\n').count();
        let bracket = self.open.last().and_then(|open| Some((open.start, self.text[open.start..].chars().next()?)));
        match bracket {
            Some((start, bracket @ ('[' | '{'))) if line(start) < line(at) => {
                format!(", and the `{bracket}` of line {} is not closed", line(start))
            }
            _ => String::new(),
        }
    }

    /// What the parser refuses.
    fn refused(&self, error: &ScanError) -> Refusal {
        let mark = error.marker();
        let by_character = || self.text.char_indices().nth(mark.index()).map(|(at, _)| at);
        let at = mark.byte_offset().or_else(by_character).unwrap_or(self.text.len()).min(self.text.len());
        let end = at + self.text[at..].chars().next().map_or(0, char::len_utf8);
        match error.kind() {
            ErrorKind::RecursionLimitExceeded => nested(at),
            ErrorKind::UnknownAnchor => syntax(at..end, "nothing before it has this anchor"),
            ErrorKind::ExpectedDocumentStart => {
                syntax(at..end, "the document ends before this; is the line indented less than the first?")
            }
            ErrorKind::TabNotAllowed | ErrorKind::TabInBlockIndentation | ErrorKind::TabInIndentation => {
                // They are told where they end.
                let tab = self.text[..end].rfind('\t').unwrap_or(at);
                syntax(tab..tab + 1, "a tab cannot stand here")
            }
            _ => syntax(at..end, &(error.info() + &self.bracket_before(at))),
        }
    }
}

fn syntax(at: Range<usize>, message: &str) -> Refusal {
    Refusal { at, message: format!("this cannot be read as YAML: {message}"), help: SYNTAX }
}

fn nested(at: usize) -> Refusal {
    Refusal {
        at: at..at + 1,
        message: format!("this is nested more than {MOST_NESTED} deep"),
        help: "close every bracket; a list or a map of a document is in a few others at most",
    }
}

/// YAML 1.2.2, production 1; also without the deletion and the characters of code page 1.
fn is_printable(character: char) -> bool {
    matches!(character, '\t' | '\n' | '\r' | '\u{85}')
        || !(character.is_control() || matches!(character, '\u{fffe}' | '\u{ffff}'))
}

fn scalar(text: &str, style: ScalarStyle, tag: Option<&Tag>) -> Value {
    match tag.map(|tag| (tag.core_suffix(), tag)) {
        None if style == ScalarStyle::Plain => plain(text),
        Some((Some("null" | "bool" | "int" | "float"), _)) => plain(text),
        Some((_, tag)) => local(tag).unwrap_or_else(|| Value::Text(text.into())),
        None => Value::Text(text.into()),
    }
}

/// What is written with a tag that is none of YAML's.
fn local(tag: &Tag) -> Option<Value> {
    let is_local = !tag.handle().starts_with("tag:yaml.org,2002:");
    is_local.then(|| Value::Tagged(tag.original().into()))
}
