//! What is half-written, and goes when the command is interrupted.

use std::fs;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Temporary files, and folders made for them, in the order in which they came.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// What a shell says of a program that an interrupt has ended.
const INTERRUPTED: i32 = 130;

/// Lets an interrupt (Ctrl-C) or a request to end take what is half-written with it. Where
/// the system does not let this be arranged, it stays, as it does when the power fails.
pub fn goes_when_interrupted() {
    let _ = ctrlc::set_handler(|| {
        // Not let go of until the end: nothing new is begun, and files that are being put in
        // their places are all there.
        let unfinished = held();
        for path in unfinished.iter().rev() {
            // A folder only where it is empty.
            let _ = fs::remove_file(path).or_else(|_| fs::remove_dir(path));
        }
        process::exit(INTERRUPTED);
    });
}

/// Until it is let go of, an interrupt waits.
pub fn held() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file or folder that is no longer of this command alone, or gone.
pub fn finished(path: &Path) {
    held().retain(|unfinished| unfinished != path);
}
