//! What commands leave behind: text on the terminal, and files that are there
//! completely or not at all.

use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use robstiff_identify::campaign::Campaign;
use robstiff_robots::Description;
use robstiff_robots::text::shown;

use crate::failure::Failure;
use crate::json::Lazy;

mod growing;
mod progress;
mod target;
mod unfinished;

pub use growing::Growing;
pub use progress::working;
use target::{Target, folder_of, present, same_file, temporary};
pub use unfinished::goes_when_interrupted;

/// Prints to standard output. A reader that has gone away (`| head`) has seen
/// what it wanted.
pub fn print(text: impl fmt::Display) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match write!(out, "{}", shown(&text.to_string())).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::new(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints to standard error; where that is gone, nobody is there to be told.
pub fn complain(message: impl fmt::Display) {
    let message = shown(&message.to_string());
    let _ = progress::beside(|| writeln!(io::stderr(), "{message}"));
}

/// Files to write, all together when everything is computed.
#[derive(Default)]
pub struct Files {
    files: Vec<(PathBuf, String)>,
    inputs: Vec<PathBuf>,
    /// Each with the number of the others that are named before it.
    grown: Vec<(usize, Growing)>,
}

impl Files {
    /// A file with its whole text; asked for twice, it is written once.
    pub fn add(&mut self, path: impl Into<PathBuf>, text: String) {
        let file = (path.into(), text);
        if !self.files.contains(&file) {
            self.files.push(file);
        }
    }

    /// A file with a document that may be larger than the memory.
    ///
    /// # Errors
    /// What cannot be written.
    pub fn add_document(&mut self, path: &Path, document: &Lazy<'_>) -> Result<(), Failure> {
        let mut out = BufWriter::new(self.grow(path)?);
        let written = document.write(&mut out).and_then(|()| out.into_inner().map_err(io::IntoInnerError::into_error));
        self.take(self.files.len(), written.map_err(|error| cannot_write(path, &error))?)
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

    /// Stops, before the work, where one of the files that will come of it could not be
    /// written, is one that is read, or is another of them, each with a text of its own.
    ///
    /// # Errors
    /// Which, and why not.
    pub fn foresee<P: AsRef<Path>>(&self, paths: impl IntoIterator<Item = P>) -> Result<(), Failure> {
        let paths: Vec<P> = paths.into_iter().collect();
        let paths: Vec<&Path> = paths.iter().map(AsRef::as_ref).collect();
        for (index, path) in paths.iter().enumerate() {
            self.refuse(path, &paths[..index])?;
            Target::of(path).and_then(|target| target.check()).map_err(|error| cannot_write(path, &error))?;
        }
        Ok(())
    }

    /// The same for a robot's description: an earlier one of the same robot is replaced, what is
    /// of another robot or cannot be read is somebody's.
    ///
    /// # Errors
    /// As for [`foresee`](Self::foresee); whose description is there.
    pub fn foresee_robot(&self, path: &Path, robot: &Description) -> Result<(), Failure> {
        self.foresee([path])?;
        // A pipe would wait for its writer.
        match path.is_file().then(|| Description::read(path)) {
            Some(Ok(there)) if there.name != robot.name => Err(Failure::new(format_args!(
                "{} describes another robot, {}, and would be overwritten with {}; choose another folder",
                path.display(),
                there.name,
                robot.name
            ))),
            Some(Err(_)) => Err(Failure::new(format_args!(
                "{} is no description of a robot, and would be overwritten with {}; choose another folder, or mend it",
                path.display(),
                robot.name
            ))),
            _ => Ok(()),
        }
    }

    /// Stops where a path is one of the files read, or one of `others`, or a dash.
    fn refuse(&self, path: &Path, others: &[&Path]) -> Result<(), Failure> {
        if path == Path::new("-") {
            return Err(Failure::Usage(
                "`-` does not stand for standard output, where the text for people goes; name a file".to_owned(),
            ));
        }
        if others.iter().any(|other| same_file(other, path)) {
            return Err(Failure::Usage(format!("{} would be written twice", path.display())));
        }
        if self.inputs.iter().any(|input| same_file(input, path)) {
            return Err(Failure::new(format!(
                "{} is one of the files that were read, and would be overwritten; choose another name or folder",
                path.display()
            )));
        }
        Ok(())
    }

    /// Writes every file under a temporary name in its folder, which is made
    /// where it is missing, and renames them only when all are complete.
    /// Returns a line for each that says so.
    ///
    /// # Errors
    /// What cannot be written, two outputs of the same name, or an input among
    /// the outputs; no file is touched then.
    pub fn write(self) -> Result<String, Failure> {
        let paths: Vec<&Path> = self
            .grown
            .iter()
            .map(|(_, one)| one.path())
            .chain(self.files.iter().map(|(path, _)| path.as_path()))
            .collect();
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
        let grown = self.grown.iter().map(|(_, Growing { draft, .. })| draft);
        let drafts: Vec<(&Path, &Draft)> = paths.into_iter().zip(grown.chain(&drafts)).collect();
        // A device may be full: that shows before any file is in its place.
        let (streams, files): (Vec<_>, Vec<_>) = drafts.iter().partition(|(_, draft)| draft.is_stream());
        for (path, draft) in streams {
            draft.publish().map_err(|error| cannot_write(path, &error))?;
        }
        let all_or_none = unfinished::held();
        for (path, draft) in files {
            draft.publish().map_err(|error| cannot_write(path, &error))?;
        }
        drop(all_or_none);
        let (grown, files) = drafts.split_at(self.grown.len());
        let places = self.grown.iter().map(|(place, _)| *place).zip(grown).chain((1..).zip(files));
        let mut named: Vec<(usize, &(&Path, &Draft))> = places.collect();
        named.sort_by_key(|(place, _)| *place);
        Ok(named.iter().map(|(_, (path, _))| format!("wrote {}\n", path.display())).collect())
    }
}

fn cannot_write(path: &Path, error: &io::Error) -> Failure {
    Failure::new(format!("cannot write {}: {error}", path.display()))
}

/// Folders that were made for files, which go again where they stay empty.
#[derive(Default)]
struct Folders(Vec<PathBuf>);

impl Folders {
    /// Makes a folder, and those it is in.
    fn make(&mut self, folder: &Path) -> io::Result<()> {
        let there = present(folder)?;
        let missing = folder.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && *folder != there);
        let missing: Vec<&Path> = missing.collect();
        // The outermost first.
        for folder in missing.into_iter().rev() {
            let mut unfinished = unfinished::held();
            match fs::create_dir(folder) {
                Ok(()) => {
                    unfinished.push(folder.to_owned());
                    self.0.push(folder.to_owned());
                }
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
            unfinished::finished(folder);
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
        match Target::of(path)? {
            Target::Stream(target) => Ok((Self::Stream { target, text: String::new() }, None)),
            Target::File { path: target, permissions } => {
                let folder = folder_of(&target);
                made.make(folder)?;
                let (temporary, file) = temporary(folder)?;
                let draft = Self::Beside { temporary, target };
                // Before anything is in it that not everybody may read.
                permissions.map_or(Ok(()), |permissions| file.set_permissions(permissions))?;
                Ok((draft, Some(file)))
            }
        }
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
            let _ = fs::remove_file(&temporary);
            unfinished::finished(temporary);
        }
    }
}
