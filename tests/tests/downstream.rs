//! `robot!` in the hands of a user: an own crate, with the dependency renamed
//! (`tests/fixtures/renamed`), built by cargo from a copy. Judged by what it
//! prints: where descriptions are found and which comes first, that a changed
//! description changes the program, and that a broken one says where.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const PRINTED: &str = "\
BesideInner 1e-6
BesideMain 2e-6
InManifest 3e-6
InFolder 4e-6
InSubfolder 5e-6
OwnRv130hsc 6e-6
StaubliRx160, KukaKr270R2700
";

#[test]
fn finds_descriptions_and_follows_them() {
    let user = User::new();
    assert_eq!(user.prints(), PRINTED);

    // Nothing else changes than the description.
    user.edit("src/beside.yaml", "2e-6 rad/Nm", "125000 Nm/rad");
    assert_eq!(user.prints(), PRINTED.replace("BesideMain 2e-6", "BesideMain 8e-6"));
    user.edit("robots/arms/deep.yaml", "1 m,", "2 m,");
    assert!(user.prints().contains("InSubfolder 2e-5\n"));

    // A mistake: at its place in the description, and no other error for it.
    user.edit("robots/folder.yaml", "compliance: 4e-6", "complience: 4e-6");
    let message = user.fails();
    assert!(message.contains("robots/folder.yaml:5:14"), "{message}");
    assert!(message.contains("`compliance`"), "{message}");
    assert!(message.contains("due to 1 previous error"), "{message}");
    user.edit("robots/folder.yaml", "complience", "compliance");
    assert!(user.prints().contains("InFolder 4e-6\n"));
}

/// A copy of the crate that may be edited.
struct User {
    folder: PathBuf,
}

impl User {
    fn new() -> Self {
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("renamed");
        // What was built before stays.
        for copied in ["src", "robots"] {
            fs::remove_dir_all(folder.join(copied)).ok();
        }
        copy(&workspace.join("tests/fixtures/renamed"), &folder);
        // The workspace's versions, which are here without a network.
        fs::copy(workspace.join("Cargo.lock"), folder.join("Cargo.lock")).expect("the lock file");
        let user = Self { folder };
        let runtime = workspace.join("robstiff").display().to_string().replace('\\', "/");
        user.edit("Cargo.toml", "../../../robstiff", &runtime);
        user
    }

    /// Replaces a text that occurs once.
    fn edit(&self, file: &str, before: &str, after: &str) {
        let path = self.folder.join(file);
        let text = fs::read_to_string(&path).expect("a file of the crate");
        assert_eq!(text.matches(before).count(), 1, "{before} in {file}");
        fs::write(path, text.replace(before, after)).expect("the copy can be written");
    }

    fn run(&self) -> Output {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        Command::new(cargo)
            .args(["run", "--offline", "--quiet", "--color", "never"])
            .current_dir(&self.folder)
            .env("CARGO_TARGET_DIR", self.folder.join("target"))
            .env("CARGO_TERM_COLOR", "never")
            .output()
            .expect("cargo runs")
    }

    /// What the program prints.
    fn prints(&self) -> String {
        let output = self.run();
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{message}");
        assert_eq!(message, "", "a warning");
        String::from_utf8(output.stdout).expect("text").replace("\r\n", "\n")
    }

    /// What the compiler says when it refuses.
    fn fails(&self) -> String {
        let output = self.run();
        assert!(!output.status.success(), "it compiled");
        String::from_utf8_lossy(&output.stderr).replace('\\', "/")
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
