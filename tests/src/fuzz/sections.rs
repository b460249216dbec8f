//! Several files in one: `=> loads.csv` on a line begins the next.

/// The text before the first such line, and each file behind with its name.
pub fn sections(text: &str) -> (&str, Vec<(&str, &str)>) {
    let mut parts = text.split("\n=> ");
    let first = parts.next().unwrap_or_default();
    let files = parts.map(|part| part.split_once('\n').unwrap_or((part, "")));
    (first, files.map(|(name, text)| (name.trim(), text)).collect())
}
