//! The robots that come with the crate.

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

/// The text of a description by its file name, `.yaml` or not.
pub fn find(file_name: &str) -> Option<&'static str> {
    let stem = file_name.strip_suffix(".yaml").unwrap_or(file_name);
    catalogue().iter().find(|(file, _)| file.strip_suffix(".yaml") == Some(stem)).map(|(_, text)| *text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Description;

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
    fn the_rv130hsc_has_the_compliances_of_table_1() {
        let robot = Description::parse("", find("rv130hsc").unwrap()).unwrap();
        let compliances: Vec<f64> = robot.joints.iter().map(|joint| joint.compliance()).collect();
        assert_eq!(compliances, [2.97e-7, 2.97e-7, 3.12e-7, 1.92e-7, 78.0e-7]);
    }
}
