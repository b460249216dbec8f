//! Measured modes, and those that are fitted to measured responses.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use robstiff::nalgebra::Vector3;
use robstiff_machining::stability::responses::Fit;
use robstiff_machining::stability::{ModesFile, ModesFrame, Spring};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::json::{number, numbers};
use crate::output::{self, Files};
use crate::text::{count, decimals, significant};

/// Reads modes, and says what the reader noticed.
pub fn read(path: &Path) -> Result<ModesFile, Failure> {
    let file = ModesFile::read(path)?;
    for warning in &file.warnings {
        output::complain(format_args!("warning: {warning}"));
    }
    Ok(file)
}

/// The files of modes, which are not to be overwritten.
pub fn protect(files: &mut Files, path: &Path, file: &ModesFile) {
    files.protect(path);
    file.fit.iter().for_each(|(path, _)| files.protect(path));
}

/// How well modes fit the responses of a file, without a full stop.
fn left((path, fit): &(PathBuf, Fit)) -> String {
    format!("{} % of {} (rms)", significant(100.0 * fit.left, 2), path.display())
}

/// The same, of modes that stand for an arm, as what goes on a sentence.
pub fn fitted(file: &ModesFile) -> String {
    file.fit.as_ref().map_or(String::new(), |fit| format!("; fitted, they leave {}", left(fit)))
}

/// What was fitted, as a file of modes has it; nothing of modes that were not.
pub fn page(file: &ModesFile) -> String {
    let Some((path, fit)) = &file.fit else { return String::new() };
    let [from, to] = fit.band.map(|frequency| significant(frequency, 4));
    let mut page = format!(
        "\nModes fitted to {} at {} from {from} to {to} Hz; they leave {}\n",
        count(fit.responses, "response"),
        count(fit.lines, "line"),
        left(&(path.clone(), *fit))
    );
    if fit.below > 0.0 {
        let share = significant(100.0 * fit.below, 2);
        page += &format!("modes below {from} Hz are {share} % of the responses (rms), and not among these\n");
    }
    page += "modes:\n";
    for mode in &file.modes {
        let [frequency, damping] = [mode.frequency / TAU, mode.damping].map(|value| significant(value, 4));
        let spring = spring(mode.stiffness, &mode.direction);
        page += &format!("  - {{frequency: {frequency} Hz, damping: {damping}, {spring}}}\n");
    }
    if !file.massless.is_empty() {
        page += "massless:\n";
    }
    for Spring { stiffness, direction } in &file.massless {
        page += &format!("  - {{{}}}\n", spring(*stiffness, direction));
    }
    page + &format!("frame: {}\n", frame(file))
}

fn spring(stiffness: f64, direction: &Vector3<f64>) -> String {
    let direction = [direction.x, direction.y, direction.z].map(|part| decimals(part, 4)).join(", ");
    format!("stiffness: {} N/um, direction: [{direction}]", significant(1e-6 * stiffness, 4))
}

fn frame(file: &ModesFile) -> &'static str {
    match file.frame {
        ModesFrame::Base => "base",
        ModesFrame::Tool => "tool",
    }
}

/// What was fitted; null of modes that were not.
pub fn document(file: &ModesFile) -> Value {
    let Some((path, fit)) = &file.fit else { return Value::Null };
    let modes = file.modes.iter().map(|mode| {
        json!({
            "frequency_Hz": number(mode.frequency / TAU),
            "damping": number(mode.damping),
            "stiffness_N_per_m": number(mode.stiffness),
            "direction": numbers(mode.direction.iter().copied()),
        })
    });
    let massless = file.massless.iter().map(|spring| {
        json!({
            "stiffness_N_per_m": number(spring.stiffness),
            "direction": numbers(spring.direction.iter().copied()),
        })
    });
    json!({
        "file": path.display().to_string(),
        "responses": fit.responses,
        "lines": fit.lines,
        "band_Hz": numbers(fit.band),
        // Root mean squares over that of the responses.
        "left": number(fit.left),
        "below": number(fit.below),
        "frame": frame(file),
        "modes": modes.collect::<Value>(),
        "massless": massless.collect::<Value>(),
    })
}
