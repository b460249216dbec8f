//! Texts that are broken anywhere are read or refused, and never more.

use proptest::prelude::*;

use super::made::file;
use super::{krl::SRC, ls::TP, rapid::MODULE, ur::SCRIPT};
use crate::program::{Language, Position, read};

/// What breaks texts.
const PIECES: [&str; 20] = [
    "{",
    "}",
    "[",
    "]",
    ";",
    "\"",
    "'",
    "\n",
    ",",
    "µ",
    "1e999",
    "-",
    "P[",
    "DEF A( )\n",
    "PROC a()\n",
    "/POS\n",
    "(",
    ")",
    "def a():\n",
    "end\n",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn broken_texts_are_read_or_refused(
        which in 0usize..4,
        breaks in prop::collection::vec((any::<prop::sample::Index>(), 0usize..20, 0usize..12), 0..6),
    ) {
        let (language, name, text) = [
            (Language::Krl, "a.src", SRC),
            (Language::Rapid, "a.mod", MODULE),
            (Language::Ls, "a.ls", TP),
            (Language::Ur, "a.script", SCRIPT),
        ][which];
        let mut text = text.to_owned();
        for (at, piece, cut) in breaks {
            let at = at.index(text.len());
            let at = (at..=text.len()).find(|&at| text.is_char_boundary(at)).unwrap();
            let end = (at + cut..=text.len()).find(|&end| text.is_char_boundary(end)).unwrap_or(text.len());
            text.replace_range(at..end, PIECES[piece]);
        }
        if let Ok(document) = read(language, vec![file(name, &text)]) {
            let positions: Vec<Position> = document.moves().map(|to| to.position.clone()).collect();
            prop_assert_eq!(document.with_positions(&positions).unwrap(), document.files());
        }
    }
}
