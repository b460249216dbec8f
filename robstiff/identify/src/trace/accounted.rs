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

use super::catalogue::{
    BASE_COMPLIANCE, GRAVITY_PRELOAD, HYSTERESIS, JOINT_COUPLING, Kind, LINK_COMPLIANCE, LOST_MOTION, OUTLIERS,
    POSE_DEPENDENT_COMPLIANCE, STIFFNESS_NONLINEARITY, TOOL_COMPLIANCE, TRANSVERSE_COMPLIANCE,
};
use super::{NamedEffect, RowResidual, Trace, Verdict};
use crate::campaign::{Campaign, ClampedRow, Data, Displacements, Frame, Observation};
use crate::identify::predict;
use crate::identify::samples::Samples;
use crate::triage::{Answer, Triage, triage};
use robstiff::Effect;

/// Springs that are linear at every pose: they break no law.
static LINEAR: [&Kind; 6] = [
    &TRANSVERSE_COMPLIANCE,
    &LINK_COMPLIANCE,
    &BASE_COMPLIANCE,
    &TOOL_COMPLIANCE,
    &JOINT_COUPLING,
    &POSE_DEPENDENT_COMPLIANCE,
];

/// What a gear does that is not linear in the load.
static LAWS: [&Kind; 4] = [&LOST_MOTION, &STIFFNESS_NONLINEARITY, &HYSTERESIS, &GRAVITY_PRELOAD];

/// Says of each check that fails, and of each reading that does not belong to the others, which
/// named effects account for it, if they do.
pub fn account_for(asked: &mut Triage, campaign: &Campaign, trace: &Trace) {
    let may_account = |named: &&NamedEffect| !LINEAR.iter().chain([&&OUTLIERS]).any(|kind| named.effect.is(kind));
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
/// model leaves; `None` of positions.
fn linear(campaign: &Campaign, trace: &Trace) -> Option<Campaign> {
    let mut robot = campaign.robot.clone();
    robot.joints.clone_from(&trace.description.joints);
    let is_law = |effect: &Effect| LAWS.iter().any(|kind| kind.is_of(effect));
    robot.effects = trace.description.effects.iter().filter(|effect| !is_law(effect)).copied().collect();
    let data = match &campaign.data {
        Data::Displacement(data) => Data::Displacement(displacements(data, &robot, campaign, trace)?),
        Data::Clamped(rows) => {
            let row = |(row, left): (&ClampedRow, &RowResidual)| ClampedRow {
                deflection: robot.joints[row.axis - 1].compliance() * row.torque + left.after[0],
                ..*row
            };
            Data::Clamped(rows.iter().zip(&trace.residuals).map(row).collect())
        }
        Data::Position(_) => return None,
    };
    Some(Campaign { robot, data, ..campaign.clone() })
}

fn displacements(
    data: &Displacements,
    robot: &Description,
    campaign: &Campaign,
    trace: &Trace,
) -> Option<Displacements> {
    let predicted = predict(robot, campaign).ok()?;
    let samples = Samples::of_description(robot, data);
    let mut linear = data.clone();
    for (i, row) in linear.rows.iter_mut().enumerate() {
        let in_base = Vector3::from(predicted.rows[i].predicted) + Vector3::from(trace.residuals[i].after);
        let read = match data.measured_frame {
            Frame::Base => in_base,
            Frame::Tool => samples.rows[i].tcp.fixed_view::<3, 3>(0, 0).transpose() * in_base,
        };
        // What is left of rotations and of encoders is not told.
        *row = Observation { displacement: read.into(), rotation: None, encoders: None, motors: None, ..row.clone() };
    }
    Some(linear)
}
