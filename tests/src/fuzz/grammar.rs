//! Texts made by rules.

use arbitrary::{Result, Unstructured};

/// Rules by their names. A rule is one of its alternatives, in which `%name%` stands for a rule.
/// The first alternative ends: it is taken when no bytes are left to choose by.
pub type Grammar = [(&'static str, &'static [&'static str])];

/// Rules that many formats share.
pub const COMMON: &Grammar = &[
    ("nl", &["\n"]),
    ("digit", &["1", "2", "3", "4"]),
    ("small", &["0", "0.5", "-0.25", "1", "-1.5", "0.125", "1e-3", "2"]),
    ("count", &["1", "2", "3", "5"]),
    (
        "odd",
        &[
            "-0",
            "1e-320",
            "1e308",
            "-1e308",
            "1e400",
            "nan",
            ".nan",
            "inf",
            "-.inf",
            "0x10",
            "1_000",
            "1e",
            "--1",
            "99999999999999999999",
            "9007199254740993",
            "pi/2",
            "1e999 mm",
            "\"\"",
            "~",
            "true",
            "[]",
            "{}",
            "1 2",
            "0,5",
            "\u{2212}1",
            "1\u{a0}mm",
            "*a",
            "&a 1",
            "!!float 1",
            "1 parsec",
        ],
    ),
    ("length", &["0", "1 m", "865 mm", "-20 mm", "0.3", "15 um", "%small% m", "%small%", "%odd%"]),
    ("angle", &["0", "90 deg", "-90 deg", "0.1", "pi/2", "3 mrad", "12 arcmin", "%small% rad", "%small%", "%odd%"]),
    ("force", &["100 N", "-2 kN", "0", "%small% N", "%small%", "%odd%"]),
];

/// How many rules a text may be made by.
const MOST_RULES: usize = 4000;

/// How long a text may grow.
const LONGEST: usize = 1 << 14;

/// A text of the rule `file`.
///
/// # Errors
/// Never: where no bytes are left, rules end.
pub fn text(grammar: &Grammar, choices: &mut Unstructured<'_>) -> Result<String> {
    let mut text = String::new();
    let mut rules = 0;
    expand(grammar, "%file%", choices, &mut rules, &mut text)?;
    Ok(text)
}

fn expand(
    grammar: &Grammar,
    pattern: &str,
    choices: &mut Unstructured<'_>,
    rules: &mut usize,
    text: &mut String,
) -> Result<()> {
    let mut rest = pattern;
    while let Some((before, behind)) = rest.split_once('%') {
        text.push_str(before);
        let (rule, behind) = behind.split_once('%').unwrap_or((behind, ""));
        rest = behind;
        let named = grammar.iter().chain(COMMON).find(|(name, _)| *name == rule);
        let (_, alternatives) = named.unwrap_or_else(|| panic!("no rule is named {rule}"));
        *rules += 1;
        let ends = *rules > MOST_RULES || text.len() > LONGEST || choices.is_empty();
        let chosen = if ends { 0 } else { choices.choose_index(alternatives.len())? };
        expand(grammar, alternatives[chosen], choices, rules, text)?;
    }
    text.push_str(rest);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::TARGETS;

    #[test]
    fn without_choices_rules_end() {
        for target in TARGETS {
            let text = text(target.grammar, &mut Unstructured::new(&[])).expect("a text");
            assert!(!text.is_empty() && text.len() < 2000, "{}", target.name);
            let accepted = (target.check)(text.as_bytes());
            assert_eq!(accepted, Ok(()), "{} refuses the plainest text:\n{text}", target.name);
        }
    }

    /// A rule that nothing names is one that was misspelt where it is named.
    #[test]
    fn every_rule_is_used() {
        for target in TARGETS {
            for (rule, alternatives) in target.grammar {
                assert!(!alternatives.is_empty(), "{}: {rule}", target.name);
                let named = format!("%{rule}%");
                let used =
                    target.grammar.iter().flat_map(|(_, alternatives)| *alternatives).any(|text| text.contains(&named));
                assert!(used || *rule == "file", "{}: nothing uses {rule}", target.name);
            }
        }
    }
}
