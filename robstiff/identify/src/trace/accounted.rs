//! What checks of the readings by themselves find that the named effects account for.
//!
//! A spring that is not linear breaks the same laws as a frame that is not what the file says:
//! loads and displacements are then not reciprocal, and the rows of a visit have in common what
//! any load does. So the checks are asked again of what a linear arm would have read, with what the
//! model leaves added. Those that hold there are accounted for.

use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::Vector3;
use robstiff_robots::Description;

use super::{NamedEffect, RowResidual, Trace, Verdict};
use crate::campaign::{Campaign, ClampedRow, Data, Displacements, Observation as Row};
use crate::observe::displacement::Displacement;
use crate::observe::{Observation, as_declared};
use crate::triage::{Answer, Triage, triage};
use robstiff::Effect;

/// Springs that are linear at every pose break no law; nor do single readings.
const LINEAR: [&str; 7] = [
    "transverse_compliance",
    "link_compliance",
    "base_compliance",
    "tool_compliance",
    "joint_coupling",
    "pose_dependent_compliance",
    "outliers",
];

/// What a gear does that is not linear in the load.
const LAWS: [&str; 4] = ["lost_motion", "stiffness_nonlinearity", "hysteresis", "gravity_preload"];

/// Says of each check that fails, and of each reading that does not belong to the others, which
/// named effects account for it, if they do.
pub fn account_for(asked: &mut Triage, campaign: &Campaign, trace: &Trace) {
    let may_account = |named: &&NamedEffect| !LINEAR.contains(&named.effect.kind());
    let names: Vec<String> = trace.effects.iter().filter(may_account).map(|named| named.effect.to_string()).collect();
    if names.is_empty() || trace.verdict == Verdict::Insufficient {
        return;
    }
    let Some(again) = linear(campaign, trace).map(|campaign| triage(&campaign)) else { return };
    for (check, after) in asked.checks.iter_mut().zip(&again.checks) {
        if let (Answer::Asked(finding), Answer::Asked(after)) = (&mut check.answer, &after.answer)
            && finding.violated
            && !after.violated
        {
            finding.accounted_for_by.clone_from(&names);
        }
    }
    for outlier in &mut asked.outliers {
        if again.outliers.iter().all(|other| other.visit != outlier.visit) {
            outlier.accounted_for_by.clone_from(&names);
        }
    }
}

/// The campaign with what the arm would have read if nothing but springs gave way, and what the
/// model leaves; `None` of positions, and of readings along an axis or two, which the checks do not ask.
fn linear(campaign: &Campaign, trace: &Trace) -> Option<Campaign> {
    let mut robot = campaign.robot.clone();
    robot.joints.clone_from(&trace.description.joints);
    let is_law = |effect: &Effect| LAWS.contains(&effect.kind());
    robot.effects = trace.description.effects.iter().filter(|effect| !is_law(effect)).copied().collect();
    let data = match &campaign.data {
        Data::Displacement(data) if data.is_whole() => Data::Displacement(displacements(data, &robot, trace)),
        Data::Clamped(rows) => {
            let row = |(row, left): (&ClampedRow, &RowResidual)| ClampedRow {
                deflection: robot.joints[row.axis - 1].compliance() * row.torque + left.after[0],
                ..*row
            };
            Data::Clamped(rows.iter().zip(&trace.residuals).map(row).collect())
        }
        Data::Displacement(_) | Data::Position(_) => return None,
    };
    Some(Campaign { robot, data, ..campaign.clone() })
}

fn displacements(data: &Displacements, robot: &Description, trace: &Trace) -> Displacements {
    let observation = Displacement::new(robot, data);
    let predicted = as_declared(&observation, observation.world(), robot);
    let mut linear = data.clone();
    for (i, row) in linear.rows.iter_mut().enumerate() {
        // Both are in the frame of the file.
        let read = observation.moved(&predicted, i) + Vector3::from(trace.residuals[i].after);
        // The residuals of rotations and of encoders are not reported.
        *row = Row { displacement: read.into(), rotation: None, encoders: None, motors: None, ..row.clone() };
    }
    linear
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Frame;
    use crate::campaign::made::{Plan, displacements as read};
    use crate::trace::{Options, trace};

    /// Of an arm whose springs are linear that is what was read.
    #[test]
    fn what_a_linear_arm_reads_is_in_the_frame_of_the_file() {
        for measured_frame in [Frame::Base, Frame::Tool] {
            let campaign = Plan { measured_frame, noise: [3e-5; 3], ..Plan::new(5) }.run();
            let found = trace(&campaign, &Options::default(), &|_| ()).expect("it can be traced");
            let linear = linear(&campaign, &found).expect("of displacements");
            let pairs = read(&campaign).rows.iter().zip(&read(&linear).rows);
            let off = |(one, other): (&Row, &Row)| {
                (Vector3::from(one.displacement) - Vector3::from(other.displacement)).norm_squared()
            };
            let off = (pairs.map(off).sum::<f64>() / campaign_rows(&campaign) as f64).sqrt();
            assert!(off < 1e-8, "{measured_frame:?} {off}");
        }
    }

    fn campaign_rows(campaign: &Campaign) -> usize {
        read(campaign).rows.len()
    }
}
