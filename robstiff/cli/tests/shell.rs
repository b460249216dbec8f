//! `completions` and `man`: they hold every command and every option that `--help` lists.

mod common;

use std::fs;

use common::{fail, folder, inside, names, run, succeed};

/// The commands that `--help` lists, without `help` itself.
fn commands() -> Vec<String> {
    let help = succeed(&["--help"]);
    let list = help.split_once("Commands:\n").unwrap().1.split_once("\n\n").unwrap().0.to_owned();
    let lines = list.lines().filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')));
    let names: Vec<String> = lines.map(|line| line.split(' ').next().unwrap().to_owned()).collect();
    names.into_iter().filter(|name| name != "help").collect()
}

/// The long options that the help of a command lists.
fn options(command: &str) -> Vec<String> {
    let help = succeed(&[command, "--help"]);
    let words = help.lines().filter_map(|line| {
        let line = line.trim_start();
        line.starts_with('-').then(|| line.split([' ', ',']).find(|word| word.starts_with("--")))?
    });
    words.map(str::to_owned).collect()
}

#[test]
fn completions_hold_every_command_and_option() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = succeed(&["completions", shell]);
        for command in commands() {
            assert!(script.contains(&command), "{shell}: {command}");
            for option in options(&command) {
                // The script for fish writes `-l out`.
                let name = if shell == "fish" { format!("-l {}", &option[2..]) } else { option };
                assert!(script.contains(&name), "{shell}: {command} {name}");
            }
        }
    }
}

#[test]
fn a_shell_that_is_not_known_is_wrong_usage() {
    let message = fail(2, &["completions", "tcsh"]);
    assert!(message.contains("bash") && message.contains("zsh"), "{message}");
}

#[test]
fn every_command_has_a_manual_page_with_its_options() {
    let folder = folder("man");
    let said = succeed(&["man", "--out", &inside(&folder, "pages")]);
    let mut expected: Vec<String> = commands().iter().map(|command| format!("robstiff-{command}.1")).collect();
    expected.push("robstiff.1".to_owned());
    expected.sort();
    assert_eq!(names(&folder.join("pages")), expected);
    for command in commands() {
        let page = fs::read_to_string(folder.join(format!("pages/robstiff-{command}.1"))).unwrap();
        assert!(said.contains(&format!("robstiff-{command}.1")), "{said}");
        // The hyphens of roff are escaped.
        let page = page.replace("\\-", "-");
        assert!(page.contains(&format!("robstiff {command}")), "{page}");
        for option in options(&command) {
            assert!(page.contains(&option), "{command} {option}: {page}");
        }
    }
}

#[test]
fn without_a_folder_the_page_is_printed() {
    let page = succeed(&["man"]);
    assert!(page.starts_with(".ie") && page.contains(".TH robstiff 1"), "{page}");
    for command in commands() {
        assert!(page.contains(&format!("robstiff\\-{command}(1)")), "{command}: {page}");
    }
}

#[test]
fn a_folder_that_is_a_file_is_a_failure() {
    let folder = folder("man-file");
    let file = inside(&folder, "file");
    fs::write(&file, "").unwrap();
    let ran = run(&["man", "--out", &file]);
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert_eq!(fs::read_to_string(&file).unwrap(), "");
}
