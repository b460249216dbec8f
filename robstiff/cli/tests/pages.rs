//! The pages of the book: every command has one, and what the pages say to type
//! works.
//!
//! The blocks marked `sh` of a page are run in their order, in one copy of
//! `commands/files`; a block `text printed` after one is what that printed, `..` for
//! lines left out; a block `yaml NAME` or `csv NAME` is the beginning of that
//! file of `commands/files`. Blocks of cargo are not run.
#![cfg(unix)]

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use common::{folder, succeed};

/// A block between fences.
struct Block {
    /// What follows the opening fence.
    info: String,
    /// The line of the page that it begins in, from 1.
    line: usize,
    text: String,
}

/// The book.
fn book() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")
}

/// The pages of the commands.
fn docs() -> PathBuf {
    book().join("commands")
}

fn readme() -> String {
    fs::read_to_string(book().join("../../README.md")).unwrap()
}

/// The pages by command.
fn pages() -> Vec<(String, String)> {
    let mut pages = Vec::new();
    for entry in fs::read_dir(docs()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        if path.extension().is_some_and(|extension| extension == "md") && name != "README" {
            pages.push((name, fs::read_to_string(&path).unwrap()));
        }
    }
    pages.sort();
    pages
}

fn blocks(page: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut inside = false;
    for (line, text) in (1..).zip(page.lines()) {
        match text.strip_prefix("```") {
            Some(_) if inside => inside = false,
            Some(info) => {
                inside = true;
                blocks.push(Block { info: info.to_owned(), line, text: String::new() });
            }
            None if inside => blocks.last_mut().unwrap().text += &format!("{text}\n"),
            None => {}
        }
    }
    assert!(!inside, "a fence is left open");
    blocks
}

/// The subcommands that `--help` lists, without `help` itself.
fn commands() -> BTreeSet<String> {
    let help = succeed(&["--help"]);
    let list = help.split_once("Commands:\n").unwrap().1.split_once("\n\n").unwrap().0;
    // A description that wraps goes on further to the right.
    let names = list.lines().filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')));
    names.map(|line| line.split(' ').next().unwrap().to_owned()).filter(|name| name != "help").collect()
}

/// A folder of example files with the catalogue of robots in it.
fn workplace(name: &str) -> PathBuf {
    let place = folder(&format!("page-{name}"));
    for entry in fs::read_dir(docs().join("files")).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, place.join(path.file_name().unwrap())).unwrap();
    }
    symlink(book().join("../../robots").canonicalize().unwrap(), place.join("robots")).unwrap();
    place
}

/// Runs a block in a folder; what it printed.
fn bash(block: &Block, page: &str, place: &Path) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_robstiff"));
    let path = format!("{}:{}", program.parent().unwrap().display(), std::env::var("PATH").unwrap());
    let output = Command::new("bash")
        .args(["-euo", "pipefail", "-c", &block.text])
        .current_dir(place)
        .env("PATH", path)
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let out = String::from_utf8(output.stdout).unwrap();
    let err = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{page}.md:{}: {}\n{out}{err}", block.line, output.status);
    out
}

/// The lines of a block are printed in its order, one right after the other but
/// where a line `..` stands for others. The first line that is not.
fn unprinted<'b>(block: &'b str, printed: &str) -> Option<&'b str> {
    let mut rest: Vec<&str> = printed.lines().collect();
    for part in block.split("..\n") {
        let part: Vec<&str> = part.lines().collect();
        let Some(first) = part.first() else { continue };
        let longest = |start: &usize| rest[*start..].iter().zip(&part).take_while(|(one, other)| one == other).count();
        let Some(start) = (0..rest.len()).max_by_key(|start| (longest(start), usize::MAX - start)) else {
            return Some(first);
        };
        let same = longest(&start);
        if same < part.len() {
            return Some(part[same]);
        }
        rest.drain(..start + same);
    }
    None
}

#[test]
fn every_command_has_a_page_and_every_page_a_command() {
    let pages: BTreeSet<String> = pages().into_iter().map(|(name, _)| name).collect();
    assert_eq!(pages, commands());
}

#[test]
fn the_outline_lists_every_page() {
    let outline = fs::read_to_string(docs().join("README.md")).unwrap();
    for (name, _) in pages() {
        assert!(outline.contains(&format!("[{name}]({name}.md)")), "commands/README.md does not list {name}.md");
    }
}

#[test]
fn the_summary_lists_every_page_of_the_book() {
    let summary = fs::read_to_string(book().join("SUMMARY.md")).unwrap();
    for folder in ["", "commands/", "pictures/"] {
        for entry in fs::read_dir(book().join(folder)).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            let listed = summary.contains(&format!("({folder}{name})")) || name == "SUMMARY.md";
            assert!(!name.ends_with(".md") || listed, "SUMMARY.md does not list {folder}{name}");
        }
    }
}

/// Runs the blocks of a page in their order, and compares what they print with
/// what the page shows. All that was run.
fn follow(name: &str, page: &str) -> String {
    let place = workplace(name);
    let (mut printed, mut typed) = (String::new(), String::new());
    for block in blocks(page) {
        match block.info.as_str() {
            "sh" if !block.text.contains("cargo ") => {
                printed = bash(&block, name, &place);
                typed += &block.text;
            }
            "text printed" => {
                let missing = unprinted(&block.text, &printed);
                assert_eq!(missing, None, "{name}.md:{}: the command does not print this\n{printed}", block.line);
            }
            _ => {}
        }
    }
    typed
}

#[test]
fn what_the_pages_say_to_type_works() {
    for (name, page) in pages() {
        let typed = follow(&name, &page);
        assert!(typed.contains(&format!("robstiff {name} ")), "{name}.md has no sh block that runs `robstiff {name}`");
    }
}

#[test]
fn what_the_readme_says_to_type_works() {
    let readme = readme();
    let typed = follow("README", &readme);
    for command in ["import", "show", "simulate", "trace", "path"] {
        assert!(typed.contains(&format!("robstiff {command} ")), "README.md does not run `robstiff {command}`");
    }
    assert!(readme.lines().count() <= 180, "README.md is no longer read at one sitting");
}

#[test]
fn what_the_guides_say_to_type_works() {
    for name in ["guide", "machining", "cell"] {
        let typed = follow(name, &fs::read_to_string(book().join(format!("{name}.md"))).unwrap());
        assert!(typed.contains("robstiff "), "{name}.md runs no command");
    }
}

/// The page on tracing shows all that the README's main command prints, and nothing else.
#[test]
fn the_page_on_tracing_shows_what_the_readmes_main_command_prints() {
    let cargo = "cargo run --bin robstiff --";
    let main = blocks(&readme()).into_iter().find(|block| block.text.starts_with(cargo)).unwrap();
    let command = Block { info: String::new(), line: main.line, text: main.text.replace(cargo, "robstiff") };
    let page = fs::read_to_string(book().join("tracing.md")).unwrap();
    let shown = blocks(&page).into_iter().find(|block| block.info == "text printed").unwrap();
    assert_eq!(bash(&command, "README", &workplace("main")), shown.text);
}

#[test]
fn files_that_pages_show_are_the_files() {
    for (name, page) in pages() {
        for block in blocks(&page) {
            if let Some(("yaml" | "csv", file)) = block.info.split_once(' ') {
                let text = fs::read_to_string(docs().join("files").join(file)).unwrap_or_default();
                let begins = !block.text.is_empty() && text.starts_with(&block.text);
                assert!(begins, "{name}.md:{}: files/{file} does not begin like this", block.line);
            }
        }
    }
}

#[test]
fn lines_are_looked_for_in_their_order() {
    let printed = "one\ntwo\nthree\nfour\n";
    for block in ["one\n", "two\nthree\n", "one\n..\nfour\n", "..\nthree\n", ""] {
        assert_eq!(unprinted(block, printed), None, "{block}");
    }
    for (block, line) in [("one\nthree\n", "three"), ("three\n..\none\n", "one"), ("five\n", "five")] {
        assert_eq!(unprinted(block, printed), Some(line), "{block}");
    }
}
