//! Where results of measurements are written, and what is not overwritten for them.

mod common;

use std::fs;
use std::path::Path;

use common::{copy, fail, folder, inside, measured, names};

/// The campaign that ships with the robots.
fn campaign() -> String {
    inside(&measured(), "campaign.yaml")
}

#[test]
fn what_was_read_is_not_overwritten() {
    let folder = folder("overwrite");
    let campaign = copy(&folder);
    let robot = fs::read_to_string(folder.join("robot.yaml")).unwrap();
    let here = folder.to_str().unwrap();
    for command in ["identify", "trace"] {
        let message = fail(1, &[command, &campaign, "--out", here]);
        assert!(message.contains("would be overwritten"), "{message}");
    }
    let loads = inside(&folder, "loads.csv");
    assert!(fail(1, &["predict", "fanuc-r2000ic", &campaign, "--csv", &loads]).contains("would be overwritten"));
    assert_eq!(fs::read_to_string(folder.join("robot.yaml")).unwrap(), robot);
    assert_eq!(names(&folder), ["campaign.yaml", "loads.csv", "robot.yaml"]);
}

/// An older result of the same robot is replaced, no description of another one.
#[test]
fn another_robot_is_not_overwritten() {
    let folder = folder("another-robot");
    let robot = folder.join("robot.yaml");
    let written = robstiff_robots::catalogue::find("rv130hsc").unwrap();
    fs::write(&robot, written).unwrap();
    for command in ["identify", "trace"] {
        let message = fail(1, &[command, &campaign(), "--out", folder.to_str().unwrap()]);
        assert!(message.contains("describes another robot, Rv130hsc"), "{message}");
    }
    assert_eq!(fs::read_to_string(&robot).unwrap(), written);
    assert_eq!(names(&folder), ["robot.yaml"]);
}

/// Even one that is not there yet.
#[test]
fn a_file_under_two_names_is_one_file() {
    let folder = folder("spellings");
    let campaign = copy(&folder);
    let (one, other) = (inside(&folder, "new/rows"), inside(&folder, "../spellings/new/rows"));
    let message = fail(2, &["predict", "fanuc-r2000ic", &campaign, "--csv", &one, "--json", &other]);
    assert!(message.contains("would be written twice"), "{message}");
    assert_eq!(names(&folder), ["campaign.yaml", "loads.csv", "robot.yaml"]);
}

#[test]
fn a_folder_that_cannot_be_made_is_a_failure() {
    let folder = folder("no-folder");
    let file = inside(&folder, "file");
    fs::write(&file, "in the way").unwrap();
    for command in ["identify", "trace"] {
        let message = fail(1, &[command, &campaign(), "--out", &inside(Path::new(&file), "out")]);
        assert!(message.contains("cannot write") && message.contains("file is a file, not a folder"), "{message}");
        let message = fail(1, &[command, &campaign(), "--out", &file]);
        assert!(message.contains("file is a file, not a folder"), "{message}");
    }
    assert_eq!(names(&folder), ["file"]);
}

/// What was made for files that could not all be written goes again; what was
/// there stays.
#[test]
fn a_folder_that_would_stay_empty_is_not_left_behind() {
    let folder = folder("empty-folder");
    let taken = inside(&folder, "taken");
    fs::create_dir(&taken).unwrap();
    for out in ["new/out", "taken"] {
        let message = fail(1, &["identify", &campaign(), "--out", &inside(&folder, out), "--json", &taken]);
        assert!(message.contains("cannot write"), "{message}");
    }
    assert_eq!(names(&folder), ["taken"]);
    assert!(names(Path::new(&taken)).is_empty());
}
