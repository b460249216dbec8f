//! Every relative link of every page leads to a file that is there, and to a
//! heading that is in it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The pages below a folder, without what is built or hidden.
fn pages(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if name.starts_with('.') || name == "target" {
            continue;
        }
        if path.is_dir() {
            pages(&path, found);
        } else if name.ends_with(".md") {
            found.push(path);
        }
    }
}

/// The lines of a page that are prose, with their numbers from 1; code of a line is blank.
fn prose(page: &str) -> Vec<(usize, String)> {
    let mut fenced = false;
    let mut lines = Vec::new();
    for (number, line) in (1..).zip(page.lines()) {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            let parts = line.split('`').enumerate();
            let outside = parts.map(|(index, part)| if index % 2 == 0 { part } else { "code" });
            lines.push((number, outside.collect::<Vec<_>>().join("")));
        }
    }
    lines
}

/// The targets of a line's links and pictures.
fn links(line: &str) -> Vec<String> {
    line.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0.to_owned())).collect()
}

/// What code hosts make of a heading: small letters, hyphens for blanks, no other signs.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase().replace(' ', "-");
    kept.chars().filter(|sign| sign.is_alphanumeric() || *sign == '-' || *sign == '_').collect()
}

fn anchors(page: &str) -> Vec<String> {
    let mut seen = BTreeMap::new();
    let mut fenced = false;
    let mut found = Vec::new();
    for line in page.lines() {
        fenced ^= line.trim_start().starts_with("```");
        let Some((level, heading)) = line.split_once(' ') else { continue };
        if fenced || level.is_empty() || level.chars().any(|sign| sign != '#') {
            continue;
        }
        let name = anchor(heading);
        let times = seen.entry(name.clone()).or_insert(0);
        found.push(if *times == 0 { name } else { format!("{name}-{times}") });
        *times += 1;
    }
    found
}

/// What is wrong with a link of a page, if anything.
fn broken(page: &Path, link: &str) -> Option<String> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (file, heading) = link.split_once('#').map_or((link, None), |(file, heading)| (file, Some(heading)));
    let target = if file.is_empty() { page.to_owned() } else { page.parent().expect("a folder").join(file) };
    if !target.exists() {
        return Some("no such file".to_owned());
    }
    let heading = heading?;
    let text = fs::read_to_string(&target).unwrap_or_default();
    let known = anchors(&text);
    (!known.iter().any(|anchor| anchor == heading)).then(|| format!("no such heading; there are {}", known.join(", ")))
}

#[test]
fn every_relative_link_leads_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut all = Vec::new();
    pages(&root, &mut all);
    assert!(all.iter().any(|page| page.ends_with("robstiff/docs/README.md")), "{all:?}");
    let mut problems = Vec::new();
    for page in &all {
        let text = fs::read_to_string(page).expect("a page");
        for (line, prose) in prose(&text) {
            for link in links(&prose) {
                if let Some(why) = broken(page, &link) {
                    problems.push(format!("{}:{line}: {link}: {why}", page.display()));
                }
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn broken_links_are_found() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md");
    assert_eq!(broken(&page, "README.md#install"), None);
    assert_eq!(broken(&page, "https://example.org/nothing.md"), None);
    assert!(broken(&page, "nothing.md").is_some());
    assert!(broken(&page, "README.md#nothing").is_some());
}

#[test]
fn links_in_code_are_none_and_headings_have_the_anchors_of_code_hosts() {
    let page = "# `One` two, three\n\nSee [a](b.md) and `[c](d.md)`.\n\n```text\n[e](f.md)\n# no heading\n```\n\n## Two\n## Two\n";
    let found: Vec<String> = prose(page).iter().flat_map(|(_, line)| links(line)).collect();
    assert_eq!(found, ["b.md"]);
    assert_eq!(anchors(page), ["one-two-three", "two", "two-1"]);
}
