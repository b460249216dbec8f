//! That something goes on, on a terminal.

use std::cell::RefCell;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

thread_local! {
    /// What is shown while something is computed.
    static SHOWN: RefCell<Option<ProgressBar>> = const { RefCell::new(None) };
}

/// Computes something, and shows on a terminal that it goes on, nowhere else; the work may say
/// what it is at.
pub fn working<T>(message: &'static str, work: impl FnOnce(&ProgressBar) -> T) -> T {
    let spinner = ProgressBar::new_spinner().with_message(message);
    spinner.set_style(ProgressStyle::with_template("{spinner} {msg} ({elapsed})").expect("the template is one"));
    spinner.enable_steady_tick(Duration::from_millis(100));
    SHOWN.set(Some(spinner.clone()));
    let done = work(&spinner);
    SHOWN.set(None);
    spinner.finish_and_clear();
    done
}

/// Does something with the line of the progress out of the way.
pub fn beside<T>(write: impl FnOnce() -> T) -> T {
    match SHOWN.with_borrow(Clone::clone) {
        Some(spinner) => spinner.suspend(write),
        None => write(),
    }
}
