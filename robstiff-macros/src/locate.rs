//! Where a description is found.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use proc_macro2::Span;
use robstiff_robots::catalogue;
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};

/// A description that was found.
pub(crate) struct Located {
    /// The file as errors show it.
    pub shown: String,
    /// What it says.
    pub text: String,
    /// The file's absolute path, for the compiler to watch; nothing for the
    /// catalogue, which changes only with the crate.
    pub watched: Option<String>,
}

/// The file's name with its ending: `.yaml` where it has neither that nor `.yml`.
pub(crate) fn with_ending(file: &str) -> String {
    // Behind another point is a part of the name: `arm-1.5`.
    let is_ending = |ending: &OsStr| ending == "yaml" || ending == "yml";
    if Path::new(file).extension().is_some_and(is_ending) { file.to_owned() } else { format!("{file}.yaml") }
}

/// Looks next to the calling source file, in the crate's manifest folder, in
/// its `robots/`, and in the catalogue that ships with robstiff, in this order.
/// Where the file is nowhere, or cannot be read, the message says so.
pub(crate) fn locate(file: &str, call: Span) -> Result<Located, String> {
    let manifest = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let folders = folders(call, manifest.as_deref());
    for folder in &folders {
        let path = folder.join(file);
        if path.is_dir() {
            continue;
        }
        match text::bytes(&path, MOST_OF_DOCUMENT) {
            Ok(bytes) => {
                let path =
                    fs::canonicalize(&path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
                let shown = shown(&path, manifest.as_deref());
                let text = text::decoded(&shown, bytes)
                    .map_err(|problems| format!("the robot description cannot be read\n\n{problems}"))?;
                return Ok(Located { shown, text, watched: path.to_str().map(str::to_owned) });
            }
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {}
            Err(error) => return Err(format!("cannot read {}: {error}", path.display())),
        }
    }
    if let Some(text) = catalogue::find(file) {
        return Ok(Located { shown: file.to_owned(), text: text.to_owned(), watched: None });
    }
    let mut message = format!("there is no description `{file}`; looked in\n");
    for folder in folders {
        message += &format!("  {}\n", shown(&folder, manifest.as_deref()));
    }
    message += "  the catalogue of robstiff: ";
    let names: Vec<&str> = catalogue::catalogue().iter().map(|(name, _)| *name).collect();
    Err(message + &names.join(", "))
}

fn folders(call: Span, manifest: Option<&Path>) -> Vec<PathBuf> {
    let source = call.unwrap().local_file();
    let beside = source.as_deref().and_then(Path::parent).map(|folder| {
        // Source paths are relative to where the compiler runs, for the
        // members of a workspace its root.
        if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_owned() }
    });
    let mut folders: Vec<PathBuf> = Vec::new();
    for folder in
        [beside, manifest.map(Path::to_owned), manifest.map(|manifest| manifest.join("robots"))].into_iter().flatten()
    {
        if !folders.contains(&folder) {
            folders.push(folder);
        }
    }
    folders
}

/// A path as short as it can be said: relative to the manifest folder if it is
/// inside.
fn shown(path: &Path, manifest: Option<&Path>) -> String {
    let manifest = manifest.and_then(|manifest| fs::canonicalize(manifest).ok());
    let absolute = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    match manifest.and_then(|manifest| absolute.strip_prefix(manifest).ok().map(Path::to_owned)) {
        Some(inside) if inside.as_os_str().is_empty() => "the crate's folder".to_owned(),
        Some(inside) => inside.display().to_string(),
        None => path.display().to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_may_be_left_out() {
        for (file, expected) in [
            ("arm", "arm.yaml"),
            ("arm.yaml", "arm.yaml"),
            ("arm.yml", "arm.yml"),
            ("arms.d/deep", "arms.d/deep.yaml"),
            ("arm-1.5", "arm-1.5.yaml"),
            ("arm-1.5.yaml", "arm-1.5.yaml"),
        ] {
            assert_eq!(with_ending(file), expected);
        }
    }
}
