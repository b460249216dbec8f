//! The robots that come with the crate.

use std::path::{Path, PathBuf};

use crate::{Description, ReadError};

/// The descriptions by file name, e.g. `rv130hsc.yaml`, with their text.
pub const fn catalogue() -> &'static [(&'static str, &'static str)] {
    macro_rules! robots {
        ($($file:literal),* $(,)?) => { &[$(($file, include_str!(concat!("../", $file)))),*] };
    }
    robots![
        "abb-irb6600-225-255.yaml",
        "abb-irb6640-185-280.yaml",
        "fanuc-m900ib-700.yaml",
        "fanuc-r2000ic.yaml",
        "kuka-kr210-l150.yaml",
        "kuka-kr270-r2700.yaml",
        "rv130hsc.yaml",
        "staubli-rx160.yaml",
    ]
}

/// The names of the robots, as [`find`] takes them, for the list of what would be right.
pub fn names() -> String {
    let names: Vec<&str> = catalogue().iter().map(|(file, _)| file.trim_end_matches(".yaml")).collect();
    names.join(", ")
}

/// The text of a description by its file name, `.yaml` or not.
pub fn find(file_name: &str) -> Option<&'static str> {
    let stem = file_name.strip_suffix(".yaml").unwrap_or(file_name);
    catalogue().iter().find(|(file, _)| file.strip_suffix(".yaml") == Some(stem)).map(|(_, text)| *text)
}

/// Reads the description at a path from a folder or, where no file is there, the one of this name
/// in the catalogue; with its path, which of the catalogue is the file's name alone. A folder with
/// measurements may have a robot's name.
///
/// # Errors
/// A file that cannot be read, also where there is none and the catalogue has none of its name;
/// all that is wrong with it.
pub fn read(folder: &Path, name: &Path) -> Result<(Description, PathBuf), ReadError> {
    let path = folder.join(name);
    // A pipe is no regular file, and can be read.
    let is_there = path.exists() && !path.is_dir();
    match name.to_str().and_then(|name| Some((name, find(name)?))).filter(|_| !is_there) {
        Some((name, text)) => {
            let file = format!("{}.yaml", name.trim_end_matches(".yaml"));
            let robot = Description::parse(&file, text).map_err(ReadError::Invalid)?;
            Ok((robot, file.into()))
        }
        None => Ok((Description::read(&path)?, path)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_robot_reads_and_says_where_it_comes_from() {
        let mut names: Vec<String> = Vec::new();
        for (file, text) in catalogue() {
            let robot = Description::parse(file, text).unwrap_or_else(|problems| panic!("{problems}"));
            assert!(!robot.description.is_empty() && !robot.source.is_empty(), "{file}");
            assert!(!names.contains(&robot.name), "{file}");
            names.push(robot.name);
        }
    }

    #[test]
    fn holds_every_description_in_the_folder() {
        let folder = std::fs::read_dir(env!("CARGO_MANIFEST_DIR")).unwrap();
        let mut files: Vec<String> = folder.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        files.retain(|file| file.ends_with(".yaml"));
        files.sort();
        assert_eq!(files, catalogue().iter().map(|(file, _)| *file).collect::<Vec<_>>());
    }

    #[test]
    fn finds_a_robot_with_and_without_the_ending() {
        assert!(find("rv130hsc").is_some() && find("rv130hsc") == find("rv130hsc.yaml"));
        assert_eq!(find("rv130"), None);
    }

    #[test]
    fn a_file_counts_before_a_name_and_a_folder_does_not() {
        let folder = std::env::temp_dir().join(format!("robstiff-catalogue-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("rv130hsc")).unwrap();
        let read = |name: &str| read(&folder, Path::new(name));
        for name in ["rv130hsc", "rv130hsc.yaml"] {
            let (robot, path) = read(name).unwrap();
            assert_eq!((robot.name.as_str(), path), ("Rv130hsc", PathBuf::from("rv130hsc.yaml")));
        }
        let own = folder.join("rv130hsc.yaml");
        std::fs::write(&own, "name: Own\nconvention: standard\njoints: [{a: 1 m}]\n").unwrap();
        let (robot, path) = read("rv130hsc.yaml").unwrap();
        assert_eq!((robot.name.as_str(), path), ("Own", own));
        // Only a name by itself is one of the catalogue.
        for name in ["rv130", "robots/rv130hsc"] {
            assert!(matches!(read(name), Err(ReadError::Io { .. })), "{name}");
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn the_rv130hsc_has_the_compliances_of_table_1() {
        let robot = Description::parse("", find("rv130hsc").unwrap()).unwrap();
        let compliances: Vec<f64> = robot.joints.iter().map(|joint| joint.compliance()).collect();
        assert_eq!(compliances, [2.97e-7, 2.97e-7, 3.12e-7, 1.92e-7, 78.0e-7]);
    }
}
