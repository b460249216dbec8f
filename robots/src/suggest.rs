//! What a misspelt word was probably meant to be.

/// The longest word, in bytes, of which it is asked what it was meant to be: how many edits are
/// between two words takes a time that grows with the product of their lengths.
const LONGEST: usize = 100;

/// The candidate nearest to `word`, if one is near enough to be meant.
pub(crate) fn closest<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    if word.len() > LONGEST {
        return None;
    }
    let allowed = (word.chars().count() / 3).max(1);
    candidates
        .into_iter()
        .filter(|candidate| candidate.len() <= 2 * LONGEST)
        .map(|candidate| (distance(&word.to_lowercase(), &candidate.to_lowercase()), candidate))
        .filter(|(distance, candidate)| *distance <= allowed && *distance < candidate.chars().count())
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// A name that a field or a word has elsewhere, what stands for it here, and how to write that.
const CALLED: [(&str, &str, &str); 6] = [
    ("stiffness", "compliance", "`compliance: 3e6 Nm/rad`, which is inverted"),
    ("h", "value", "`value`, which reports call `h`"),
    ("offset", "value", "`value`, which reports call `offset`"),
    ("offset", "theta", "`theta` of a joint that turns, `d` of one that slides"),
    ("climb", "down", "`down`, which is climb milling"),
    ("conventional", "up", "`up`, which is conventional milling"),
];

/// How a field or a word is written that others call by this name.
pub(crate) fn called(word: &str, fields: &[&str]) -> Option<String> {
    let (.., help) = CALLED.iter().find(|(other, field, _)| *other == word && fields.contains(field))?;
    Some(format!("write {help}"))
}

/// "`a`, `b`, `c`", for the list of what would be right.
pub(crate) fn list<'c>(words: impl IntoIterator<Item = &'c str>) -> String {
    words.into_iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

/// Edits (insert, delete, replace, swap neighbours) from one word to the other.
fn distance(from: &str, to: &str) -> usize {
    let (from, to): (Vec<char>, Vec<char>) = (from.chars().collect(), to.chars().collect());
    let mut before_last = vec![0; to.len() + 1];
    let mut last: Vec<usize> = (0..=to.len()).collect();
    for i in 0..from.len() {
        let mut row = vec![i + 1];
        for j in 0..to.len() {
            let mut edits = (last[j] + usize::from(from[i] != to[j])).min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && from[i] == to[j - 1] && from[i - 1] == to[j] {
                edits = edits.min(before_last[j - 1] + 1);
            }
            row.push(edits);
        }
        before_last = last;
        last = row;
    }
    last[to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_edits() {
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("complience", "compliance"), 1);
        assert_eq!(distance("alhpa", "alpha"), 1);
        assert_eq!(distance("théta", "theta"), 1);
    }

    #[test]
    fn suggests_only_what_is_near() {
        assert_eq!(closest("Complience", ["theta", "compliance"]), Some("compliance"));
        assert_eq!(closest("stiffness", ["theta", "compliance"]), None);
        assert_eq!(closest("x", ["d", "a"]), None);
        // Nobody means a word like this one, and to compare two of a megabyte takes hours.
        let long = "a".repeat(1 << 20);
        assert_eq!((closest(&long, [&*long]), closest("theta", [&*long])), (None, None));
    }
}
