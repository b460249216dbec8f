//! Broken descriptions, with what a person is told of each: `bad/*.yaml` and
//! `bad/*.txt`. To accept new wording, run with `ROBSTIFF_BLESS=1` and read the diff.
#![cfg(feature = "read")]

use robstiff_robots::Description;
use std::fs;
use std::path::Path;

#[test]
fn problems_are_told_in_these_words() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let mut files: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "yaml"));
    assert!(!files.is_empty());
    for file in files {
        let name = file.file_name().unwrap().to_str().unwrap();
        let told = Description::parse(name, &fs::read_to_string(&file).unwrap()).expect_err(name).to_string() + "\n";
        let expected = file.with_extension("txt");
        if std::env::var_os("ROBSTIFF_BLESS").is_some_and(|value| value == "1") {
            fs::write(&expected, told).unwrap();
        } else {
            assert_eq!(told, fs::read_to_string(&expected).unwrap_or_default(), "{name}");
        }
    }
}
