//! The words of a block of G-code.

use super::fault::Fault;

/// A letter and its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Word {
    /// The letter, upper case.
    pub letter: u8,
    /// Its number.
    pub value: f64,
    /// Where it begins in its line, in bytes.
    pub at: usize,
    /// How many bytes it has.
    pub width: usize,
}

impl Word {
    /// Ten times the number of a code, where that is whole: 434 of `G43.4`.
    pub fn tenths(&self) -> Option<u32> {
        let tenths = self.value * 10.0;
        let rounded = tenths.round();
        ((tenths - rounded).abs() < 1e-6 && (0.0..1e5).contains(&rounded)).then_some(rounded as u32)
    }

    /// A problem with it.
    pub fn fault(&self, message: impl Into<String>, help: impl Into<String>) -> Fault {
        Fault { at: self.at, width: self.width, message: message.into(), help: help.into() }
    }
}

/// What a line is beside its words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    /// It begins with `/`: a switch of the machine leaves it out.
    pub deletable: bool,
    /// It is `%`, which begins and ends a program.
    pub percent: bool,
}

/// The words of a line.
#[derive(Clone, Debug, Default)]
pub struct Block {
    /// G words, in their order.
    pub g: Vec<Word>,
    /// M words, in their order.
    pub m: Vec<Word>,
    letters: [Option<Word>; 26],
}

/// Numbers beyond this are no lengths of a machine, in any unit.
const LARGEST: f64 = 1e9;

/// More codes in a block than there are modal groups.
const MOST_CODES: usize = 32;

const LETTERS: &str = "a word is a letter and a number, e.g. `X12.5`; comments are in ( ) or after ;";

impl Block {
    /// The word with a letter, if the block has one.
    pub fn word(&self, letter: u8) -> Option<&Word> {
        self.letters[usize::from(letter - b'A')].as_ref()
    }

    /// The number of a letter.
    pub fn value(&self, letter: u8) -> Option<f64> {
        self.word(letter).map(|word| word.value)
    }

    /// Whether it has any word.
    pub fn is_empty(&self) -> bool {
        self.g.is_empty() && self.m.is_empty() && self.letters.iter().all(|word| word.is_none())
    }

    /// All words but G and M.
    pub fn words(&self) -> impl Iterator<Item = &Word> {
        self.letters.iter().flatten()
    }

    /// Reads a line in place of what the block held.
    ///
    /// # Errors
    /// The first thing that is not a word or a comment.
    pub fn read(&mut self, line: &str) -> Result<Marks, Fault> {
        self.g.clear();
        self.m.clear();
        self.letters = [None; 26];
        let (bytes, mut at, mut marks) = (line.as_bytes(), 0, Marks::default());
        while let Some(&byte) = bytes.get(at) {
            match byte {
                b' ' | b'\t' | 0xb | 0xc => at += 1,
                b';' => break,
                b'(' => at = comment(line, at)?,
                b'/' if line[..at].trim().is_empty() => {
                    marks.deletable = true;
                    at += 1;
                }
                b'%' if line.trim() == "%" => return Ok(Marks { percent: true, ..marks }),
                b'O' | b'o' => return self.program_number(line, at, marks),
                b'#' | b'[' | b'=' | b'<' => {
                    return Err(Fault::new(
                        line,
                        at,
                        "variables and expressions are not followed",
                        "have the CAM system write numbers",
                    ));
                }
                byte if byte.is_ascii_alphabetic() => {
                    let word = word(line, at)?;
                    at += word.width;
                    self.take(word)?;
                }
                _ => {
                    let character = line[at..].chars().next().unwrap_or_default();
                    return Err(Fault::new(line, at, format!("`{character}` begins no word"), LETTERS));
                }
            }
        }
        Ok(marks)
    }

    fn take(&mut self, word: Word) -> Result<(), Fault> {
        let codes = match word.letter {
            b'G' => &mut self.g,
            b'M' => &mut self.m,
            letter => {
                let place = &mut self.letters[usize::from(letter - b'A')];
                if place.is_some() {
                    let letter = char::from(letter);
                    return Err(word.fault(format!("`{letter}` is in the block twice"), "keep one of them"));
                }
                *place = Some(word);
                return Ok(());
            }
        };
        if codes.len() >= MOST_CODES {
            return Err(word.fault("the block has more codes than there are", "write a block a line"));
        }
        codes.push(word);
        Ok(())
    }

    /// `O1234` alone names the program; every other O word calls or loops.
    fn program_number(&self, line: &str, at: usize, marks: Marks) -> Result<Marks, Fault> {
        let rest = line[at + 1..].trim_start();
        let name = rest.trim_start_matches(|c: char| c.is_ascii_digit());
        let is_comment = |rest: &str| rest.is_empty() || rest.starts_with([';', '(']);
        if self.is_empty() && name.len() < rest.len() && is_comment(name.trim()) {
            return Ok(marks);
        }
        let mut fault = Fault::new(
            line,
            at,
            "subprograms, loops and conditions (O words) are not followed",
            "have the CAM system write the moves one after another",
        );
        fault.width = line[at..].trim_end().len();
        Err(fault)
    }
}

/// Where the comment that begins at a byte ends.
fn comment(line: &str, at: usize) -> Result<usize, Fault> {
    let mut depth = 0_usize;
    for (offset, byte) in line.as_bytes()[at..].iter().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Ok(at + offset + 1);
        }
    }
    Err(Fault::new(line, at, "the comment does not end in its line", "close it by `)`"))
}

fn word(line: &str, at: usize) -> Result<Word, Fault> {
    let (bytes, letter) = (line.as_bytes(), line.as_bytes()[at].to_ascii_uppercase());
    let blank = |byte: &&u8| matches!(byte, b' ' | b'\t');
    let start = at + 1 + bytes[at + 1..].iter().take_while(blank).count();
    let sign = bytes.get(start).copied().filter(|byte| matches!(byte, b'+' | b'-'));
    let start = start + usize::from(sign.is_some());
    let start = start + bytes[start..].iter().take_while(blank).count();
    let mut end = start;
    let (mut digits, mut points) = (0_usize, 0_usize);
    while let Some(byte) = bytes.get(end) {
        match byte {
            b'0'..=b'9' => digits += 1,
            b'.' if points == 0 => points += 1,
            _ => break,
        }
        end += 1;
    }
    let value = line[start..end].parse::<f64>().ok().filter(|_| digits > 0);
    let value = value.map(|value| if sign == Some(b'-') { -value } else { value });
    let shown = char::from(letter);
    let Some(value) = value else {
        return Err(Fault::new(line, at, format!("`{shown}` has no number"), LETTERS));
    };
    let word = Word { letter, value, at, width: end - at };
    if value.abs() > LARGEST {
        return Err(word.fault(format!("the number of `{shown}` is beyond all machines"), ""));
    }
    Ok(word)
}
