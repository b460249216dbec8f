//! Files that are too large to be held whole.

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::{Draft, Files, Folders, cannot_write};
use crate::failure::Failure;

/// A file that is written piece by piece beside its place, and takes that when
/// [`Files::write`] puts all files there; until then nothing is seen of it.
pub struct Growing {
    pub(super) path: PathBuf,
    pub(super) draft: Draft,
    file: File,
    /// Dropped after the draft, when what was made for it is empty.
    _made: Folders,
}

impl Files {
    /// Begins a file that grows.
    ///
    /// # Errors
    /// What cannot be written, or one of the files that were read.
    pub fn grow(&self, path: &Path) -> Result<Growing, Failure> {
        self.refuse(path, &self.files.iter().map(|(path, _)| path.as_path()).collect::<Vec<_>>())?;
        let mut made = Folders::default();
        let mut open = || -> io::Result<(Draft, File)> {
            let (draft, file) = Draft::open(path, &mut made)?;
            let file = match (file, &draft) {
                (Some(file), _) => file,
                // A pipe or a device has no place beside it.
                (None, Draft::Stream { target, .. } | Draft::Beside { target, .. }) => {
                    OpenOptions::new().write(true).open(target)?
                }
            };
            Ok((draft, file))
        };
        let (draft, file) = open().map_err(|error| cannot_write(path, &error))?;
        Ok(Growing { path: path.to_owned(), draft, file, _made: made })
    }

    /// Takes a file that has grown to its end.
    ///
    /// # Errors
    /// What cannot be written.
    pub fn grown(&mut self, growing: Growing) -> Result<(), Failure> {
        self.take(0, growing)
    }

    /// The same, named behind so many of the files that do not grow.
    pub(super) fn take(&mut self, place: usize, growing: Growing) -> Result<(), Failure> {
        if matches!(growing.draft, Draft::Beside { .. }) {
            growing.file.sync_all().map_err(|error| cannot_write(&growing.path, &error))?;
        }
        self.grown.push((place, growing));
        Ok(())
    }
}

impl Growing {
    /// Where it will be.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Write for Growing {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
