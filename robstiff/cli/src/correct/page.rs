//! What is corrected: for people, and for programs.

use robstiff_machining::deviation::Summary;
use robstiff_machining::program::{Document, Instruction};
use robstiff_robots::Description;
use serde_json::{Value, json};

use super::{Corrected, Motion};
use crate::json::{Lazy, number, numbers};
use crate::path::deviation;
use crate::text::{Table, count, fine_micrometres};

/// Motions that are shown; the others are counted.
const MOST_SHOWN: usize = 20;

/// A motion that is kept: its file, its line, its text and why.
type Kept<'d> = (usize, usize, &'d str, &'d str);

fn kept(document: &Document) -> Vec<Kept<'_>> {
    let kept = document.program().instructions.iter().filter_map(|one| match one {
        Instruction::KeptMove { file, line, text, why } => Some((*file, *line, text.as_str(), why.as_str())),
        _ => None,
    });
    kept.collect()
}

/// What a person is shown.
pub fn page(robot: &Description, document: &Document, corrected: &Corrected) -> String {
    let (motions, kept) = (&corrected.motions, kept(document));
    let place = |file: usize, line: usize| format!("{}:{line}", document.files()[file].name);
    let shifts: Vec<f64> = motions.iter().filter_map(|motion| motion.shift).collect();
    let mut page = format!(
        "{} on {} ({}): {}, {} corrected\n",
        robot.name,
        document.files()[0].name,
        document.language().word(),
        count(motions.len() + kept.len(), "motion"),
        shifts.len()
    );
    if let Some(Summary { mean, rms, worst }) = Summary::of(shifts.iter().map(|shift| (*shift, 1.0))) {
        let mut table = Table::new(1, ["", "mean", "rms", "worst"]);
        let cells = [mean, rms, worst].map(fine_micrometres);
        table.row(["positions are moved by [um]".to_owned()].into_iter().chain(cells));
        page += &format!("\n{table}");
    }
    let stays = motions.iter().filter(|motion| motion.shift.is_none()).count();
    if stays > 0 {
        let motions = count(stays, "motion");
        page += &format!("\nas before, without need of a correction or to angles of the joints: {motions}\n");
    }
    if !kept.is_empty() {
        page += "\nNot corrected\n";
    }
    for (file, line, text, why) in kept.iter().take(MOST_SHOWN) {
        page += &format!("  {}: `{text}`: {why}\n", place(*file, *line));
    }
    page += &more(kept.len());
    if !corrected.otherwise.is_empty() {
        page += "\nThe corrected position is in another posture or turn than the program says: teach these\n";
    }
    for (i, what) in corrected.otherwise.iter().take(MOST_SHOWN) {
        let Motion { file, line, .. } = &motions[*i];
        page += &format!("  {}: {what}\n", place(*file, *line));
    }
    page += &more(corrected.otherwise.len());
    if let Some(cutting) = &corrected.cutting {
        page += &deviation::page(cutting);
    }
    page
}

fn more(all: usize) -> String {
    if all > MOST_SHOWN { format!("  and {} more\n", all - MOST_SHOWN) } else { String::new() }
}

/// Everything in SI units.
pub fn document<'d>(robot: &Description, document: &'d Document, corrected: &'d Corrected) -> Lazy<'d> {
    let file = |file: usize| document.files()[file].name.clone();
    let motion = move |motion: &Motion| {
        json!({
            "file": file(motion.file),
            "line": motion.line,
            "rapid": motion.rapid,
            "q_before": numbers(motion.before.iter().copied()),
            "q": numbers(motion.after.iter().copied()),
            "moved_m": motion.shift.map(number),
        })
    };
    let kept = kept(document).into_iter().map(|(of, line, text, why)| {
        json!({
            "file": file(of), "line": line, "text": text, "why": why,
        })
    });
    let otherwise = corrected.otherwise.iter().map(|(i, what)| {
        json!({
            "file": file(corrected.motions[*i].file), "line": corrected.motions[*i].line, "what": what,
        })
    });
    let files: Vec<_> = document.files().iter().map(|file| file.name.clone()).collect();
    let mut fields = vec![
        ("robot", json!(robot.name).into()),
        ("language", json!(document.language().word()).into()),
        ("files", json!(files).into()),
        ("motions", Lazy::list(&corrected.motions, motion)),
        ("not_corrected", kept.collect::<Value>().into()),
        ("other_posture", otherwise.collect::<Value>().into()),
    ];
    fields.extend(corrected.cutting.as_ref().map(|cutting| ("deviation", deviation::document(cutting))));
    Lazy::Fields(fields)
}
