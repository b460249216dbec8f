//! The robots that come with the crate.

/// The descriptions by file name, e.g. `rv130hsc.yaml`, with their text.
pub const fn catalogue() -> &'static [(&'static str, &'static str)] {
    macro_rules! robots {
        ($($file:literal),* $(,)?) => { &[$(($file, include_str!(concat!("../", $file)))),*] };
    }
    robots!["rv130hsc.yaml"]
}

/// The text of a description by its file name, `.yaml` or not.
pub fn find(file_name: &str) -> Option<&'static str> {
    let stem = file_name.strip_suffix(".yaml").unwrap_or(file_name);
    catalogue().iter().find(|(file, _)| file.strip_suffix(".yaml") == Some(stem)).map(|(_, text)| *text)
}
