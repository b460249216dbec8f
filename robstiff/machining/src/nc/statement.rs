//! Statements of APT and CLDATA.

use super::fault::Fault;

/// `MAJOR/first,second,..`, on one line or, behind a `$`, on several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statement {
    /// What is before the slash, upper case.
    pub major: String,
    /// Its line (from 1).
    pub line: usize,
    /// Where it begins in its line and how many bytes it has.
    pub place: [usize; 2],
    /// What is behind the slash.
    pub parts: Vec<Part>,
}

/// One of what commas separate.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The word, upper case; empty of a number.
    pub word: String,
    /// The number, not a number of a word.
    pub number: f64,
    /// Its line (from 1).
    pub line: usize,
    /// Where it begins in its line and how many bytes it has.
    pub place: [usize; 2],
}

/// A problem and its line (from 1).
pub type Problem = (usize, Fault);

/// What takes the rest of its line as text.
const TEXTS: [&str; 7] = ["PARTNO", "PPRINT", "TPRINT", "REMARK", "MACHIN", "INSERT", "TOOL PATH"];

/// Parts of a statement; more is no statement of a tool's path.
const MOST_PARTS: usize = 1000;

/// Numbers beyond this are no lengths, in any unit.
const LARGEST: f64 = 1e9;

impl Statement {
    /// Takes a line; whether the statement goes on in the next one.
    ///
    /// # Errors
    /// What is wrong with the line.
    pub fn take(&mut self, line: usize, text: &str, goes_on: bool) -> Result<bool, Problem> {
        let end = text.find('$').unwrap_or(text.len());
        let is_open = end < text.len() && !text[end..].starts_with("$$");
        let code = &text[..end];
        let mut rest = 0;
        if !goes_on {
            let slash = code.find('/').unwrap_or(code.len());
            let before = &code[..slash];
            let start = before.len() - before.trim_start().len();
            let major = before.trim().to_ascii_uppercase();
            let first = major.split([' ', '\t']).next().unwrap_or_default();
            // Texts may have any sign in them.
            let name = TEXTS.into_iter().find(|name| first == *name || major == *name);
            *self = Self { line, place: [start, before.trim().len()], ..Self::default() };
            if let Some(name) = name {
                name.clone_into(&mut self.major);
                return Ok(false);
            }
            self.major = major.split_whitespace().collect::<Vec<_>>().join(" ");
            rest = slash + 1;
        }
        while rest < code.len() {
            let end = code[rest..].find(',').map_or(code.len(), |comma| rest + comma);
            let part = &code[rest..end];
            let start = rest + part.len() - part.trim_start().len();
            // Lines are broken at commas, on either side of them.
            if !part.trim().is_empty() {
                self.push(line, code, [start, part.trim().len()])?;
            }
            rest = end + 1;
        }
        Ok(is_open)
    }

    fn push(&mut self, line: usize, code: &str, place: [usize; 2]) -> Result<(), Problem> {
        let text = &code[place[0]..place[0] + place[1]];
        if self.parts.len() >= MOST_PARTS {
            let [at, width] = place;
            let message = "the statement has more than 1000 parts".to_owned();
            return Err((line, Fault { at, width, message, help: String::new() }));
        }
        let is_number = text.starts_with(is_of_number);
        let number = if is_number { text.parse::<f64>().ok() } else { None };
        // Of a statement that has no use for numbers they may be anything.
        let (word, number) = match number.filter(|number| number.abs() <= LARGEST) {
            Some(number) => (String::new(), number),
            None => (text.to_ascii_uppercase(), f64::NAN),
        };
        self.parts.push(Part { word, number, line, place });
        Ok(())
    }

    /// A problem with all of it.
    pub fn fault(&self, message: impl Into<String>, help: impl Into<String>) -> Problem {
        let [at, width] = self.place;
        (self.line, Fault { at, width, message: message.into(), help: help.into() })
    }

    /// Its numbers, where it has nothing else.
    ///
    /// # Errors
    /// The first word.
    pub fn numbers(&self) -> Result<Vec<f64>, Problem> {
        let number = |part: &Part| match part.word.as_str() {
            "" => Ok(part.number),
            word if word.starts_with(is_of_number) => Err(part.fault(format!("`{word}` is not a number"), "")),
            word => Err(part.fault(format!("`{word}` stands where a number belongs"), "")),
        };
        self.parts.iter().map(number).collect()
    }

    /// The number behind a word.
    pub fn behind(&self, word: &str) -> Option<f64> {
        let at = self.parts.iter().position(|part| part.word == word)?;
        self.parts.get(at + 1).map(|part| part.number).filter(|number| !number.is_nan())
    }

    /// Its first number.
    pub fn first_number(&self) -> Option<f64> {
        self.parts.iter().map(|part| part.number).find(|number| !number.is_nan())
    }

    /// Whether it has a word.
    pub fn has(&self, word: &str) -> bool {
        self.parts.iter().any(|part| part.word == word)
    }
}

/// What a number begins with.
fn is_of_number(character: char) -> bool {
    character.is_ascii_digit() || "+-.".contains(character)
}

impl Part {
    /// A problem with it.
    pub fn fault(&self, message: impl Into<String>, help: impl Into<String>) -> Problem {
        let [at, width] = self.place;
        (self.line, Fault { at, width, message: message.into(), help: help.into() })
    }
}
