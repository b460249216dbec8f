//! Encoders: how much of the displacement along the load the joints account for
//! by their angles under load, `J (j - q)`; of angles on the output side what
//! survives is not in the gears. Where only the motors' angles under load are
//! given, what the controller lets through, `J (m - q)`.

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::Vector6;

use super::evidence::{Evidence, Line};
use super::randomisation::{Witness, flip};
use super::{Raw, Unjudged};
use crate::campaign::Observation;
use crate::words::percent;

/// What encoders resolve of it at best.
const MATTERS: f64 = 0.02;

pub(super) fn check(evidence: &Evidence<'_>) -> Unjudged {
    let all =
        |of: fn(&Observation) -> Option<&[f64]>| evidence.data.rows.iter().all(|row| of(row).is_some()).then_some(of);
    let output = all(|row| row.encoders.as_deref());
    let Some(angles) = output.or_else(|| all(|row| row.motors.as_deref())) else {
        return Err(String::from("angles under load on the output side of the gears, columns `j1` to `jn`"));
    };
    let shared = evidence.covariance.shared;
    let (mut witnesses, mut accounted, mut whole) = (Vec::new(), 0.0, 0.0);
    for line in &evidence.lines {
        let slope = line.slope(shared).weights;
        let sum =
            |of: &dyn Fn(usize) -> f64| -> f64 { line.rows.iter().zip(&slope).map(|(&row, w)| w * of(row)).sum() };
        // With what the motors let through, which is taken from readings elsewhere.
        let given = |row: usize| evidence.samples.rows[row].given.dot(&line.along);
        let read = sum(&|row| evidence.along(row, &line.along) + given(row));
        let joints = sum(&|row| by_joints(evidence, line, row, angles));
        // Weighed by the stroke, so that small ones do not drown it in noise.
        let size = read.abs();
        accounted += size * joints;
        whole += size * read;
        witnesses.push(Witness {
            pose: line.pose,
            visits: line.visits.clone(),
            scores: std::vec![size * if output.is_some() { read - joints } else { joints }],
        });
    }
    let Some(flipped) = flip(&witnesses).filter(|_| whole != 0.0) else {
        return Err(String::from("angles under load at 12 poses or more"));
    };
    let share = accounted / whole;
    let said = if output.is_some() {
        [
            format!("The joints' output angles account for {} of the displacement along the load.", percent(share)),
            format!(
                "The joints' output angles account for {} of the displacement along the load. The other {} are not in \
                 the gears: bearings that tilt, links, base or tool.",
                percent(share),
                percent(1.0 - share)
            ),
        ]
    } else {
        [
            format!("The motors hold their angles: {} of the displacement along the load.", percent(share)),
            format!(
                "The motors give way under the load: {} of the displacement along it is the controller's, and not \
                 elastic.",
                percent(share)
            ),
        ]
    };
    Ok(Raw {
        statistic: 100.0 * if output.is_some() { 1.0 - share } else { share },
        unit: if output.is_some() { "% not by the joints" } else { "% by the motors" },
        p_value: Some(flipped.p_value),
        matters_from: 100.0 * MATTERS,
        witnesses: flipped.witnesses,
        said,
    })
}

/// The displacement of the marker along the load by the joints' angles under it,
/// less those of the visit's row without a load, where there is one (m).
fn by_joints(evidence: &Evidence<'_>, line: &Line, row: usize, angles: impl Fn(&Observation) -> Option<&[f64]>) -> f64 {
    let sample = &evidence.samples.rows[row];
    let still = evidence.unloaded.iter().find(|&&other| evidence.samples.rows[other].visit == sample.visit);
    let turned = |row: usize, joint: usize| {
        let row = &evidence.data.rows[row];
        angles(row).map_or(0.0, |angles| angles[joint] - row.q[joint])
    };
    let moves = |twist: &Vector6<f64>| sample.read(twist).fixed_rows::<3>(0).dot(&line.along);
    let beyond = |joint: usize| turned(row, joint) - still.map_or(0.0, |&still| turned(still, joint));
    evidence.samples.twists(row).iter().enumerate().map(|(joint, twist)| moves(twist) * beyond(joint)).sum()
}
