//! The files of a program.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use robstiff_machining::program::{Language, TextFile};
use robstiff_robots::text::{self, MOST_OF_TABLE};

use crate::failure::Failure;

/// What some editors begin a file with.
const MARK: char = '\u{feff}';

/// Files of one program.
const MOST_FILES: usize = 10_000;

/// A file of a program.
pub struct Source {
    /// Its path.
    pub path: PathBuf,
    /// What it says, without a mark of its encoding.
    text: String,
    has_mark: bool,
}

impl Source {
    fn read(path: PathBuf) -> Result<Self, Failure> {
        let mut text = text::read(&path, MOST_OF_TABLE)?;
        let has_mark = text.starts_with(MARK);
        if has_mark {
            text.drain(..MARK.len_utf8());
        }
        Ok(Self { path, text, has_mark })
    }

    /// The name under which problems show it.
    pub fn text_file(&self) -> TextFile {
        TextFile { name: self.path.display().to_string(), text: self.text.clone() }
    }

    /// Its name in a folder.
    pub fn name(&self) -> &Path {
        Path::new(self.path.file_name().unwrap_or_default())
    }

    /// Another text, that begins as the file does.
    pub fn with_mark(&self, text: &str) -> String {
        if self.has_mark { format!("{MARK}{text}") } else { text.to_owned() }
    }
}

/// Reads the files of a program: those that are named, and beside each of them the `.dat` of a `.src` and the
/// programs that it calls.
pub fn gather(named: &[PathBuf]) -> Result<(Language, Vec<Source>), Failure> {
    let mut language = None;
    for path in named {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let Some(of_file) = Language::of_file(&name) else {
            return Err(Failure::Usage(format!(
                "{}: the language is known by the end of the name: .src and .dat (KRL), .mod (RAPID), .ls (FANUC), .script (UR)",
                path.display()
            )));
        };
        if language.is_some_and(|language| language != of_file) {
            return Err(Failure::Usage("the files are in different languages".to_owned()));
        }
        language = Some(of_file);
    }
    let language = language.expect("a file is named");
    let (mut sources, mut seen): (Vec<Source>, HashSet<PathBuf>) = Default::default();
    let mut waiting: Vec<PathBuf> = named.iter().rev().cloned().collect();
    while let Some(path) = waiting.pop() {
        let place = fs::canonicalize(&path).unwrap_or_else(|_| path.clone());
        if !seen.insert(place) || sources.len() >= MOST_FILES {
            continue;
        }
        let source = Source::read(path)?;
        waiting.extend(beside(language, &source).into_iter().rev());
        sources.push(source);
    }
    // Declared points are looked up in the files behind; what runs is first.
    sources.sort_by_key(|source| is_data(&source.path));
    let mut names = HashSet::new();
    if let Some(twice) = sources.iter().find(|source| !names.insert(source.name().to_owned())) {
        return Err(Failure::Usage(format!(
            "{}: two files have this name; correct them one by one",
            twice.path.display()
        )));
    }
    Ok((language, sources))
}

fn is_data(path: &Path) -> bool {
    path.extension().is_some_and(|end| end.eq_ignore_ascii_case("dat"))
}

/// The files beside one that it needs.
fn beside(language: Language, source: &Source) -> Vec<PathBuf> {
    let names: Vec<String> = match language {
        Language::Krl if !is_data(&source.path) => {
            let stem = source.path.file_stem().unwrap_or_default().to_string_lossy();
            let calls = source.text.lines().filter_map(called).map(|name| format!("{name}.src"));
            std::iter::once(format!("{stem}.dat")).chain(calls).collect()
        }
        Language::Ls => {
            let calls = source.text.lines().filter_map(|line| line.split_once("CALL ")).map(|(_, name)| {
                let end =
                    name.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').unwrap_or(name.len());
                format!("{}.ls", &name[..end])
            });
            calls.collect()
        }
        _ => Vec::new(),
    };
    if names.is_empty() {
        return Vec::new();
    }
    let folder = source.path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // In letters of either case, as controllers have names.
    let there: Vec<(String, PathBuf)> = fs::read_dir(folder)
        .map(|entries| entries.flatten().collect::<Vec<_>>())
        .unwrap_or_default()
        .into_iter()
        .map(|entry| {
            (entry.file_name().to_string_lossy().to_ascii_lowercase(), source.path.with_file_name(entry.file_name()))
        })
        .collect();
    let found = |name: &String| {
        let name = name.to_ascii_lowercase();
        there.iter().find(|(other, _)| *other == name).map(|(_, path)| path.clone())
    };
    names.iter().filter_map(found).collect()
}

/// The routine that a line of KRL calls without arguments.
fn called(line: &str) -> Option<&str> {
    let (name, rest) = line.trim().split_once('(')?;
    let name = name.trim_end();
    let is_name = !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    (is_name && rest.trim_start().starts_with(')')).then_some(name)
}
