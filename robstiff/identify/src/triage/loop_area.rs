//! Loop area: what the displacement along the load is on the way back more than
//! on the way there, at the same load, within a visit; in between by straight
//! lines, from the unloaded reading on.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::evidence::{Evidence, Line};
use super::randomisation::{Witness, flip};
use super::{Raw, Unjudged};
use crate::words::{micrometres, percent};

const MATTERS: f64 = 0.005;

pub(super) fn check(evidence: &Evidence<'_>) -> Unjudged {
    let (mut witnesses, mut sum, mut strokes, mut rows) = (Vec::new(), 0.0, 0.0, 0_usize);
    for line in &evidence.lines {
        let mut visits = line.visits.clone();
        // Rows of other visits may come in between.
        visits.sort_unstable();
        visits.dedup();
        for visit in visits {
            let path = path(evidence, line, visit);
            let widths = widths(&path);
            if widths.is_empty() {
                continue;
            }
            let width: f64 = widths.iter().sum();
            sum += width;
            rows += widths.len();
            strokes += path.iter().fold(0.0_f64, |most, (_, moved)| most.max(moved.abs())) * widths.len() as f64;
            witnesses.push(Witness { pose: line.pose, visits: std::vec![visit], scores: std::vec![width] });
        }
    }
    let Some(flipped) = flip(&witnesses) else {
        return Err(String::from("loads up and down again within a visit, in load order, at 12 poses or more"));
    };
    let (width, share) = (sum / rows as f64, sum / strokes);
    let points = if width > 0.0 {
        "The arm stays behind on the way back: friction in gears or in the measuring set-up (hysteresis)."
    } else {
        "The arm is ahead on the way back: readings drift or settle within a visit, or the load order is not that of \
         the file."
    };
    Ok(Raw {
        statistic: 100.0 * share,
        unit: "% of the stroke",
        p_value: Some(flipped.p_value),
        matters_from: 100.0 * MATTERS,
        witnesses: flipped.witnesses,
        said: [
            format!("The way back is the way there, to {} of the stroke.", percent(share.abs().max(MATTERS))),
            format!(
                "The way back is not the way there: {} apart, {} of the stroke. {points}",
                micrometres(width.abs()),
                percent(share.abs())
            ),
        ],
    })
}

/// Load and displacement along it of a visit's rows, in their order; both counted
/// positive in the direction of the visit's largest load.
fn path(evidence: &Evidence<'_>, line: &Line, visit: usize) -> Vec<(f64, f64)> {
    let of_visit = (0..line.rows.len()).filter(|&k| line.visits[k] == visit);
    let path: Vec<(f64, f64)> = of_visit.map(|k| (line.loads[k], evidence.along(line.rows[k], &line.along))).collect();
    let largest = path.iter().copied().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let sign = largest.map_or(1.0, |(load, _)| load.signum());
    path.into_iter().map(|(load, moved)| (sign * load, sign * moved)).collect()
}

/// Back less there, for every load on the way back.
fn widths(path: &[(f64, f64)]) -> Vec<f64> {
    let Some(peak) = (0..path.len()).max_by(|&a, &b| path[a].0.total_cmp(&path[b].0)) else { return Vec::new() };
    let mut there: Vec<(f64, f64)> = std::vec![(0.0, 0.0)];
    there.extend(&path[..=peak]);
    // One that goes up and down several times has no one way there.
    if there.windows(2).any(|pair| pair[1].0 <= pair[0].0) {
        return Vec::new();
    }
    let width = |&(load, moved): &(f64, f64)| {
        let after = there.iter().position(|(known, _)| *known >= load).filter(|after| *after > 0)?;
        let ((from, low), (to, high)) = (there[after - 1], there[after]);
        Some(moved - (low + (high - low) * (load - from) / (to - from)))
    };
    path[peak + 1..].iter().filter_map(width).collect()
}
