//! A crate of a user: a copy of a fixture that may be edited, built by cargo
//! apart from the workspace.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A copy of the crate `tests/fixtures/<name>`.
pub struct User {
    /// Where it is.
    pub folder: PathBuf,
}

impl User {
    /// A fresh copy, but for what was built before.
    pub fn new(fixture: &str) -> Self {
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(fixture);
        for copied in ["src", "robots"] {
            fs::remove_dir_all(folder.join(copied)).ok();
        }
        copy(&workspace.join("tests/fixtures").join(fixture), &folder);
        // The workspace's versions, which are here without a network.
        fs::copy(workspace.join("Cargo.lock"), folder.join("Cargo.lock")).expect("the lock file");
        let user = Self { folder };
        let runtime = workspace.join("robstiff").display().to_string().replace('\\', "/");
        user.edit("Cargo.toml", "../../../robstiff", &runtime);
        user
    }

    /// Replaces a text that occurs once.
    pub fn edit(&self, file: &str, before: &str, after: &str) {
        let path = self.folder.join(file);
        let text = fs::read_to_string(&path).expect("a file of the crate");
        assert_eq!(text.matches(before).count(), 1, "{before} in {file}");
        fs::write(path, text.replace(before, after)).expect("the copy can be written");
    }

    /// Builds and runs the program.
    pub fn run(&self) -> Output {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        Command::new(cargo)
            .args(["run", "--offline", "--quiet", "--color", "never"])
            .current_dir(&self.folder)
            // One for all copies: what they depend on is the same.
            .env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("users"))
            .env("CARGO_TERM_COLOR", "never")
            .output()
            .expect("cargo runs")
    }

    /// What the program prints.
    pub fn prints(&self) -> String {
        let output = self.run();
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{message}");
        assert_eq!(message, "", "a warning");
        String::from_utf8(output.stdout).expect("text").replace("\r\n", "\n")
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("the copy's folder");
    for entry in fs::read_dir(from).expect("the fixture") {
        let entry = entry.expect("an entry of the fixture");
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if !from.is_dir() {
            fs::copy(from, to).expect("a copied file");
        } else if entry.file_name() != "target" {
            copy(&from, &to);
        }
    }
}
