//! Where outputs go: by what name, and whether anything can be written there.

use std::fs::{self, File, Metadata, OpenOptions, Permissions};
use std::io;
use std::path::{Path, PathBuf};
use std::process;

use super::unfinished;

/// Links that are followed from one to the next, as many as Linux does.
const MOST_LINKS: usize = 40;

/// Where an output goes.
pub enum Target {
    /// A file, with its permissions where it is there already.
    File { path: PathBuf, permissions: Option<Permissions> },
    /// A pipe or a device, which cannot be replaced.
    Stream(PathBuf),
}

impl Target {
    /// That of a path.
    ///
    /// # Errors
    /// A folder, or a file that must not be replaced.
    pub fn of(path: &Path) -> io::Result<Self> {
        // Through links, so that they stay.
        let target = followed(path);
        let found = match fs::metadata(&target) {
            Ok(found) => found,
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
                return Ok(Self::File { path: target, permissions: None });
            }
            Err(error) => return Err(error),
        };
        if found.is_dir() {
            return Err(io::Error::from(io::ErrorKind::IsADirectory));
        }
        if !found.is_file() {
            return Ok(Self::Stream(target));
        }
        // In its place would be another file, and what is still written to it is lost.
        if is_printed_to(&found) {
            return Err(io::Error::other("what is printed goes to this file; name another one"));
        }
        if is_descriptor(path) {
            return Err(io::Error::other("it stands for a file that is open; name the file itself"));
        }
        // To put another in its place takes no permission to write to it.
        if found.permissions().readonly() {
            return Err(io::Error::other("it is read-only"));
        }
        OpenOptions::new().write(true).open(&target)?;
        Ok(Self::File { path: target, permissions: Some(found.permissions()) })
    }

    /// Whether it can be written, as far as that shows without a trace.
    ///
    /// # Errors
    /// Why not.
    pub fn check(&self) -> io::Result<()> {
        match self {
            Self::File { path, .. } => {
                let (trial, _) = temporary(present(folder_of(path))?)?;
                let removed = fs::remove_file(&trial);
                unfinished::finished(&trial);
                removed
            }
            // A pipe may wait for its reader.
            Self::Stream(_) => Ok(()),
        }
    }
}

/// A new file in a folder. Its name is not made of that which it will have: that may be as
/// long as names can be.
pub fn temporary(folder: &Path) -> io::Result<(PathBuf, File)> {
    let mut count = 0;
    let mut unfinished = unfinished::held();
    loop {
        let path = folder.join(format!(".robstiff-{}-{count}.tmp", process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => count += 1,
            Err(error) => return Err(error),
            Ok(file) => {
                unfinished.push(path.clone());
                return Ok((path, file));
            }
        }
    }
}

/// The folder that a file is in.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The innermost of a folder and those it is in that is there.
///
/// # Errors
/// Where that is a file.
pub fn present(folder: &Path) -> io::Result<&Path> {
    let is_there = |folder: &&Path| !folder.as_os_str().is_empty() && folder.exists();
    let there = folder.ancestors().find(is_there).unwrap_or(Path::new("."));
    if there.is_dir() {
        Ok(there)
    } else {
        Err(io::Error::other(format!("{} is a file, not a folder", there.display())))
    }
}

/// Whether two paths are one file, by whatever name.
pub fn same_file(one: &Path, other: &Path) -> bool {
    place(one) == place(other)
}

/// A path without detours. Of a file that is not there yet the folder may be, or the
/// one that it will be made in.
fn place(path: &Path) -> PathBuf {
    let path = followed(path);
    fs::canonicalize(&path).unwrap_or_else(|_| match (path.parent(), path.file_name()) {
        (Some(folder), Some(name)) if folder.as_os_str().is_empty() => place(Path::new(".")).join(name),
        (Some(folder), Some(name)) => place(folder).join(name),
        _ => path.clone(),
    })
}

/// The end of a path's links, also where nothing is there yet.
fn followed(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        if let Ok(found) = fs::canonicalize(&path) {
            return found;
        }
        match fs::read_link(&path) {
            // What a descriptor of a pipe links to is no path.
            Ok(link) if fs::metadata(&path).is_err() => path = folder_of(&path).join(link),
            _ => break,
        }
    }
    path
}

/// Whether a path leads to what a process has open, such as `/dev/stdout`.
fn is_descriptor(path: &Path) -> bool {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(folder) = fs::canonicalize(folder_of(&path)) else { return false };
        if folder == Path::new("/dev/fd") || (folder.starts_with("/proc") && folder.ends_with("fd")) {
            return true;
        }
        match fs::read_link(&path) {
            Ok(link) => path = folder.join(link),
            Err(_) => return false,
        }
    }
    false
}

/// Whether standard output or standard error go to a file.
#[cfg(unix)]
fn is_printed_to(file: &Metadata) -> bool {
    use std::os::fd::AsFd;
    use std::os::unix::fs::MetadataExt;

    let printed = [io::stdout().as_fd().try_clone_to_owned(), io::stderr().as_fd().try_clone_to_owned()];
    let printed = printed.into_iter().flatten().filter_map(|printed| File::from(printed).metadata().ok());
    printed.into_iter().any(|printed| (printed.dev(), printed.ino()) == (file.dev(), file.ino()))
}

#[cfg(not(unix))]
fn is_printed_to(_: &Metadata) -> bool {
    false
}
