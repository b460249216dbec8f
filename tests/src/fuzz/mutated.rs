//! Changes of texts, as people and programs make mistakes, and as nobody does.

use rand::seq::IndexedRandom;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::grammar::{COMMON, Grammar};

/// No text grows beyond.
const LONGEST: usize = 1 << 14;

/// Signs that mean something in one of the formats.
const SIGNS: &str = "{}[]()<>:;,.\"'`#&*!|?-+=%@\\/~^$_ \t\n\r\0\u{feff}\u{2028}\u{202e}\u{e9}";

/// A text changed in one to four places; `other` lends parts. The same for the same seed.
pub fn mutated(text: &[u8], other: &[u8], grammar: &Grammar, seed: u64) -> Vec<u8> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut text = text.to_vec();
    for _ in 0..random.random_range(1..=4) {
        text = changed(&text, other, grammar, &mut random);
        text.truncate(LONGEST);
    }
    text
}

fn changed(text: &[u8], other: &[u8], grammar: &Grammar, random: &mut impl Rng) -> Vec<u8> {
    let lines: Vec<&[u8]> = text.split_inclusive(|byte| *byte == b'\n').collect();
    let others: Vec<&[u8]> = other.split_inclusive(|byte| *byte == b'\n').collect();
    let words = words(text);
    match random.random_range(0..12) {
        // Words: as the grammar has them, left out, put elsewhere, repeated.
        0..=3 => replaced(text, &words, alternative(grammar, random).as_bytes(), random),
        4 => replaced(text, &words, b"", random),
        5 => {
            let word = words.choose(random).map_or(&b""[..], |word| &text[word.clone()]).to_vec();
            replaced(text, &words, &word, random)
        }
        6 => {
            let word = words.choose(random).map_or(&b""[..], |word| &text[word.clone()]).to_vec();
            replaced(text, &words, &word.repeat(random.random_range(2..40)), random)
        }
        // Lines.
        7 => {
            let mut lines = lines;
            match lines.len() {
                0 => Vec::new(),
                count => {
                    let at = random.random_range(0..count);
                    if random.random() {
                        lines.remove(at);
                    } else {
                        lines.swap(at, random.random_range(0..count));
                    }
                    lines.concat()
                }
            }
        }
        8 => {
            let mut lines = lines;
            let line = [lines.choose(random), others.choose(random)][random.random_range(0..2)].copied();
            for _ in 0..random.random_range(1..8) {
                lines.insert(random.random_range(0..=lines.len()), line.unwrap_or_default());
            }
            lines.concat()
        }
        9 => {
            let (from, to) = (random.random_range(0..=lines.len()), random.random_range(0..=others.len()));
            [lines[..from].concat(), others[to..].concat()].concat()
        }
        // Signs and bytes.
        10 => {
            let signs: Vec<char> = SIGNS.chars().collect();
            let sign = signs.choose(random).copied().unwrap_or(' ').to_string();
            inserted(text, sign.as_bytes(), random)
        }
        _ => {
            let mut text = text.to_vec();
            if text.is_empty() || random.random() {
                return inserted(&text, &[random.random()], random);
            }
            let at = random.random_range(0..text.len());
            if random.random() {
                text[at] ^= 1 << random.random_range(0..8);
            } else {
                text.remove(at);
            }
            text
        }
    }
}

/// Where words are: letters, digits and what numbers have beside them.
fn words(text: &[u8]) -> Vec<core::ops::Range<usize>> {
    let is_of_word = |byte: u8| byte.is_ascii_alphanumeric() || b"_.+-".contains(&byte);
    let mut words: Vec<core::ops::Range<usize>> = Vec::new();
    for (at, _) in text.iter().enumerate().filter(|(_, byte)| is_of_word(**byte)) {
        match words.last_mut() {
            Some(word) if word.end == at => word.end += 1,
            _ => words.push(at..at + 1),
        }
    }
    words
}

/// An alternative of some rule, as it stands there.
fn alternative(grammar: &Grammar, random: &mut impl Rng) -> &'static str {
    let rules: Vec<&[&'static str]> = grammar.iter().chain(COMMON).map(|(_, alternatives)| *alternatives).collect();
    let alternatives = rules.choose(random).copied().unwrap_or_default();
    alternatives.choose(random).copied().unwrap_or_default()
}

fn replaced(text: &[u8], words: &[core::ops::Range<usize>], by: &[u8], random: &mut impl Rng) -> Vec<u8> {
    let Some(word) = words.choose(random) else { return by.to_vec() };
    [&text[..word.start], by, &text[word.end..]].concat()
}

fn inserted(text: &[u8], what: &[u8], random: &mut impl Rng) -> Vec<u8> {
    let at = random.random_range(0..=text.len());
    [&text[..at], what, &text[at..]].concat()
}
