//! What would help most, by what is known of a job.

use super::content::{Job, Travel};
use crate::text::{decimals, significant};

/// Shares that are smaller are not worth a change of the arm.
const WORTHWHILE: f64 = 0.2;

/// A joint that comes nearer to a limit than this part of its range.
const NEAR: f64 = 0.03;

/// Sentences, the most helpful first; `fast` are the joints that are too fast, from 1, with the point at which they
/// are fastest.
pub fn of(job: &Job<'_>, travels: &[Travel], fast: &[(usize, usize)]) -> Vec<String> {
    let mut said = Vec::new();
    let broken = job.tolerance.is_some_and(|limit| job.commanded().iter().flatten().any(|size| *size > limit));
    let has_error = job.sizes().flatten().any(|size| size > 0.0);
    if has_error && job.corrected.is_none() {
        said.push("Correct the path: --compensate commands the path that makes up for what the arm yields.".to_owned());
    }
    if let (Some(left), Some(limit)) = (&job.corrected, job.tolerance)
        && left.worst > limit
    {
        said.push(format!(
            "Measure the arm: the correction is worth what its compliances are, and {} % of them are too much here.",
            decimals(left.by * 100.0, 0)
        ));
    }
    said.extend(fast.iter().filter_map(|&(joint, i)| {
        let (point, fastest) = (&job.points[i], job.joints[joint - 1].fastest?);
        let feed = point.feed? * fastest / travels[joint - 1].speed?.1;
        Some(format!(
            "Line {}: a feed of {} mm/min at most, so that joint {joint} can follow.",
            point.line,
            // Never more than the joint can.
            significant((feed * 6e4 * 100.0).floor() / 100.0, 3)
        ))
    }));
    let large: Vec<&(String, f64)> = job.shares.iter().filter(|(_, share)| *share >= WORTHWHILE).take(2).collect();
    for (k, (name, share)) in large.into_iter().enumerate() {
        let at = if broken { "where the tolerance is broken, " } else { "" };
        let share = decimals(share * 100.0, 0);
        said.push(match k {
            0 => format!(
                "Relieve {name}: {at}it makes {share} % of the error. A pose in which it carries less, or a stiffer \
                 {name}, gains most."
            ),
            _ => format!("Then {name}: {share} %."),
        });
    }
    for (j, (travel, joint)) in travels.iter().zip(&job.joints).enumerate() {
        if let (Some((i, margin)), Some([low, high])) = (travel.margin, joint.limits)
            && margin < NEAR * (high - low)
        {
            let (unit, per) = joint.unit;
            said.push(format!(
                "Joint {} comes within {} {unit} of a limit at line {}: another place or turn of the workpiece gives it room.",
                j + 1,
                decimals(margin * per, 1),
                job.points[i].line
            ));
        }
    }
    said
}
