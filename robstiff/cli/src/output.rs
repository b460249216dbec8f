//! What commands leave behind: text on the terminal, and files that are there
//! completely or not at all.

use std::ffi::OsString;
use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;

use robstiff::campaign::Campaign;

use crate::failure::Failure;

mod growing;

pub use growing::Growing;

/// Prints to standard output. A reader that has gone away (`| head`) has seen
/// what it wanted.
pub fn print(text: impl fmt::Display) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match write!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::new(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints to standard error; where that is gone, nobody is there to be told.
pub fn complain(message: impl fmt::Display) {
    let _ = writeln!(io::stderr(), "{message}");
}

/// Files to write, all together when everything is computed.
#[derive(Default)]
pub struct Files {
    files: Vec<(PathBuf, String)>,
    inputs: Vec<PathBuf>,
    grown: Vec<Growing>,
}

impl Files {
    /// A file with its whole text; asked for twice, it is written once.
    pub fn add(&mut self, path: impl Into<PathBuf>, text: String) {
        let file = (path.into(), text);
        if !self.files.contains(&file) {
            self.files.push(file);
        }
    }

    /// A file that was read and must not be overwritten with what was made of
    /// it.
    pub fn protect(&mut self, input: impl Into<PathBuf>) {
        self.inputs.push(input.into());
    }

    /// The files of a campaign, which are not to be overwritten either.
    pub fn protect_campaign(&mut self, campaign: &Campaign) {
        self.protect(&campaign.path);
        self.protect(&campaign.robot_path);
        self.protect(&campaign.observations_path);
    }

    /// Writes every file under a temporary name in its folder, which is made
    /// where it is missing, and renames them only when all are complete.
    /// Returns a line for each that says so.
    ///
    /// # Errors
    /// What cannot be written, two outputs of the same name, or an input among
    /// the outputs; no file is touched then.
    pub fn write(self) -> Result<String, Failure> {
        let paths: Vec<&Path> =
            self.grown.iter().map(Growing::path).chain(self.files.iter().map(|(path, _)| path.as_path())).collect();
        for (index, path) in paths.iter().enumerate() {
            self.refuse(path, &paths[..index])?;
        }
        // Dropped after the drafts, when what was made for them is empty.
        let mut made = Folders::default();
        let mut drafts = Vec::new();
        for (path, text) in &self.files {
            // A draft that is dropped takes its file with it.
            drafts.push(Draft::new(path, text, &mut made).map_err(|error| cannot_write(path, &error))?);
        }
        let grown = self.grown.iter().map(|Growing { draft, .. }| draft);
        let drafts: Vec<(&Path, &Draft)> = paths.into_iter().zip(grown.chain(&drafts)).collect();
        // A device may be full: that shows before any file is in its place.
        let (streams, files): (Vec<_>, Vec<_>) = drafts.iter().partition(|(_, draft)| draft.is_stream());
        for (path, draft) in streams.into_iter().chain(files) {
            draft.publish().map_err(|error| cannot_write(path, &error))?;
        }
        Ok(drafts.iter().map(|(path, _)| format!("wrote {}\n", path.display())).collect())
    }
}

fn cannot_write(path: &Path, error: &io::Error) -> Failure {
    Failure::new(format!("cannot write {}: {error}", path.display()))
}

/// Whether two paths are one file, by whatever name.
fn same_file(one: &Path, other: &Path) -> bool {
    place(one) == place(other)
}

/// A path without detours. Of a file that is not there yet the folder may be, or the
/// one that it will be made in.
fn place(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| match (path.parent(), path.file_name()) {
        (Some(folder), Some(name)) if folder.as_os_str().is_empty() => place(Path::new(".")).join(name),
        (Some(folder), Some(name)) => place(folder).join(name),
        _ => path.to_owned(),
    })
}

/// Folders that were made for files, which go again where they stay empty.
#[derive(Default)]
struct Folders(Vec<PathBuf>);

impl Folders {
    /// Makes a folder, and those it is in.
    fn make(&mut self, folder: &Path) -> io::Result<()> {
        let missing = folder.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists());
        let missing: Vec<&Path> = missing.collect();
        let present = folder.ancestors().nth(missing.len()).filter(|folder| !folder.as_os_str().is_empty());
        if let Some(file) = present.filter(|folder| !folder.is_dir()) {
            return Err(io::Error::other(format!("{} is a file, not a folder", file.display())));
        }
        // The outermost first.
        for folder in missing.into_iter().rev() {
            match fs::create_dir(folder) {
                Ok(()) => self.0.push(folder.to_owned()),
                Err(_) if folder.is_dir() => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

impl Drop for Folders {
    fn drop(&mut self) {
        for folder in self.0.iter().rev() {
            // Only what is empty can be removed this way.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// A complete text on its way to its place.
enum Draft {
    /// A file beside the one it becomes.
    Beside { temporary: PathBuf, target: PathBuf },
    /// A pipe or a device cannot be replaced: it is written to at the end.
    Stream { target: PathBuf, text: String },
}

impl Draft {
    /// A draft with its whole text.
    fn new(path: &Path, text: &str, made: &mut Folders) -> io::Result<Self> {
        let (mut draft, file) = Self::open(path, made)?;
        if let Some(mut file) = file {
            file.write_all(text.as_bytes())?;
            file.sync_all()?;
        }
        if let Self::Stream { text: held, .. } = &mut draft {
            text.clone_into(held);
        }
        Ok(draft)
    }

    /// An empty draft, and the file to write to where there is one beside.
    fn open(path: &Path, made: &mut Folders) -> io::Result<(Self, Option<File>)> {
        // Through a link, so that the link stays one.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        match fs::metadata(&target) {
            Ok(found) if found.is_dir() => return Err(io::Error::from(io::ErrorKind::IsADirectory)),
            Ok(found) if !found.is_file() => return Ok((Self::Stream { target, text: String::new() }, None)),
            _ => {}
        }
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        made.make(folder)?;
        let name = target.file_name().ok_or_else(|| io::Error::from(io::ErrorKind::InvalidInput))?;
        let mut hidden = OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}.tmp", process::id()));
        let temporary = folder.join(hidden);
        let file = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
        Ok((Self::Beside { temporary, target }, Some(file)))
    }

    fn is_stream(&self) -> bool {
        matches!(self, Self::Stream { .. })
    }

    fn publish(&self) -> io::Result<()> {
        match self {
            Self::Beside { temporary, target } => fs::rename(temporary, target),
            Self::Stream { text, .. } if text.is_empty() => Ok(()),
            Self::Stream { target, text } => OpenOptions::new().write(true).open(target)?.write_all(text.as_bytes()),
        }
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if let Self::Beside { temporary, .. } = self {
            // Gone where it was published.
            let _ = fs::remove_file(temporary);
        }
    }
}
