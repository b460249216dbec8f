//! What the tests of the command share.
#![allow(dead_code, reason = "every test binary uses its own part")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Mutex, PoisonError};

use serde_json::Value;

/// The command with arguments.
pub fn robstiff(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_robstiff"));
    command.args(arguments);
    command
}

/// What it did.
pub struct Ran {
    pub code: i32,
    pub out: String,
    pub err: String,
}

/// Runs the command to its end.
pub fn run(arguments: &[&str]) -> Ran {
    let Output { status, stdout, stderr } = robstiff(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ran { code: status.code().unwrap(), out: text(stdout), err: text(stderr) }
}

/// Runs the command, which must succeed without a word of complaint.
pub fn succeed(arguments: &[&str]) -> String {
    let ran = run(arguments);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{arguments:?}");
    ran.out
}

/// Runs the command, which must explain why it fails.
pub fn fail(code: i32, arguments: &[&str]) -> String {
    let ran = run(arguments);
    assert_eq!((ran.code, ran.out.as_str()), (code, ""), "{arguments:?}: {}", ran.err);
    assert!(ran.err.starts_with("error: "), "{}", ran.err);
    ran.err
}

/// An empty folder of a test's own. A name is given once: tests run side by side.
pub fn folder(name: &str) -> PathBuf {
    static GIVEN: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    let is_new = GIVEN.lock().unwrap_or_else(PoisonError::into_inner).insert(name.to_owned());
    assert!(is_new, "two tests have the folder {name}");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A path inside a folder, as an argument.
pub fn inside(folder: &Path, name: &str) -> String {
    folder.join(name).to_str().unwrap().to_owned()
}

/// The names of what a folder holds.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A JSON file.
pub fn json(path: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The keys of an object, in their order.
pub fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// The measurements that ship with the robots.
pub fn measured() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/measured/fanuc-r2000ic")
}

/// A copy of them that a test may spoil: campaign, loads and robot in one
/// folder. The campaign's path.
pub fn copy(folder: &Path) -> String {
    fs::copy(measured().join("../../fanuc-r2000ic.yaml"), folder.join("robot.yaml")).unwrap();
    fs::copy(measured().join("loads.csv"), folder.join("loads.csv")).unwrap();
    let campaign = fs::read_to_string(measured().join("campaign.yaml")).unwrap();
    let campaign = campaign.replace("../../fanuc-r2000ic.yaml", "robot.yaml");
    fs::write(folder.join("campaign.yaml"), campaign).unwrap();
    inside(folder, "campaign.yaml")
}

/// A file beside the pages of the commands.
pub fn file(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/commands/files").join(name).to_str().unwrap().to_owned()
}

/// A file of the pages with some of its text replaced.
pub fn changed(folder: &Path, name: &str, [from, to]: [&str; 2]) -> String {
    let text = fs::read_to_string(file(name)).unwrap();
    assert!(text.contains(from), "{name} has no {from}");
    let path = inside(folder, name);
    fs::write(&path, text.replace(from, to)).unwrap();
    path
}

/// The arm of the pages' URDF file, all rigid.
pub fn rigid(folder: &Path) -> String {
    let arm = inside(folder, "arm.yaml");
    assert_eq!(run(&["import", &file("arm.urdf"), "--tip", "cutter_tip", "--out", &arm]).code, 0);
    arm
}
