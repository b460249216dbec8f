//! Whether another name would do as well, at these poses and loads: judged by
//! the simulator's own campaigns without noise, not by what tracing says.

use nalgebra::DVector;
use robstiff_robots::{Description, Effect};

use super::case::Ready;
use super::visible::{missed, seen};
use crate::simulator::{DhColumn, Follows, Hidden, Mount, Scenario};

/// What is left, as a sum of squares in multiples of the noise's variance, when
/// a name has taken the place of what is hidden: below this, no test tells one
/// from the other (two standard errors of one number). Sharing an unloaded
/// reading makes readings tell less, not more, so it is no less than what they
/// tell.
const TOLD_APART: f64 = 4.0;

/// Whether an effect of this full name could have done what the hidden thing
/// `index` did.
pub fn would_do(ready: &Ready, name: &str, index: usize) -> bool {
    let scenario = &ready.scenario;
    let all = seen(scenario, &scenario.hidden);
    let others: Vec<DVector<f64>> = (0..scenario.hidden.len())
        .filter(|&other| other != index)
        .map(|other| seen(scenario, &scenario.hidden[other..=other]).missed)
        .collect();
    forms(name, &scenario.truth).iter().any(|form| {
        let columns: Vec<DVector<f64>> =
            form.iter().map(|one| seen(scenario, std::slice::from_ref(one)).missed).collect();
        let fitted: Vec<&DVector<f64>> = columns.iter().chain(&others).collect();
        all.chi_square(&all.missed, &fitted) < TOLD_APART
    })
}

/// What every form of every effect of the catalogue does in a campaign, each a
/// few columns; for what none of them alone must account for.
pub fn everything(scenario: &Scenario) -> Vec<Vec<DVector<f64>>> {
    let names = full_names(scenario.truth.joints.len());
    let forms = names.iter().flat_map(|name| forms(name, &scenario.truth));
    forms.map(|form| form.iter().map(|one| missed(scenario, one)).collect()).collect()
}

/// The full names of the catalogue on an arm with so many joints, but for those
/// that have no form.
fn full_names(joints: usize) -> Vec<String> {
    let at_joints = [
        "transverse_compliance",
        "stiffness_nonlinearity",
        "lost_motion",
        "hysteresis",
        "pose_dependent_compliance",
        "joint_zero_offset",
        "transmission_error",
    ];
    let of_rig = [
        "load_cell_misalignment",
        "load_cell_bias",
        "load_cell_scale",
        "lever_arm",
        "tracker_misalignment",
        "reflector_offset",
        "thermal_drift",
        "creep",
    ];
    let mut names: Vec<String> = vec!["base_compliance@base".into(), "tool_compliance@tool".into()];
    names.extend(of_rig.map(|kind| format!("{kind}@rig")));
    for joint in 1..=joints {
        names.extend(at_joints.map(|kind| format!("{kind}@joint {joint}")));
        names.extend(["a", "d", "alpha"].map(|column| format!("dh_error@{column}{joint}")));
        names.push(format!("link_compliance@link {joint}"));
        names.extend((1..joint).map(|other| format!("joint_coupling@joints {other},{joint}")));
    }
    names
}

/// The forms that an effect of a full name can take, each a few numbers, small
/// enough to be in proportion. None for those with a moment or a lot of their
/// own (slips, outliers), which are nobody's alias.
fn forms(name: &str, arm: &Description) -> Vec<Vec<Hidden>> {
    let Some((kind, place)) = name.split_once('@') else { return Vec::new() };
    let number: usize = place.trim_start_matches(|c: char| !c.is_ascii_digit()).parse().unwrap_or(0);
    let known = (1..=arm.joints.len()).contains(&number);
    let torque = if number <= 3 { 1000.0 } else { 200.0 };
    let axes = |of: &dyn Fn([f64; 3]) -> Hidden, size: f64| -> Vec<Hidden> {
        (0..3).map(|axis| of(std::array::from_fn(|k| if k == axis { size } else { 0.0 }))).collect()
    };
    let elastic = |effects: &[Effect]| vec![effects.iter().copied().map(Hidden::Elastic).collect::<Vec<_>>()];
    match kind {
        "transverse_compliance" if known => elastic(&[Effect::TransverseCompliance { joint: number, value: 1e-8 }]),
        "link_compliance" if known && number < arm.joints.len() => {
            let row = &arm.joints[number - 1];
            if row.a.hypot(row.d) == 0.0 {
                return Vec::new();
            }
            elastic(&[
                Effect::LinkCompliance { link: number, bending: 1e-8, torsion: 0.0 },
                Effect::LinkCompliance { link: number, bending: 0.0, torsion: 1e-8 },
            ])
        }
        "base_compliance" => elastic(&[
            Effect::BaseCompliance { tilt: 1e-9, translation: 0.0 },
            Effect::BaseCompliance { tilt: 0.0, translation: 1e-9 },
        ]),
        "tool_compliance" => elastic(&[
            Effect::ToolCompliance { rotation: 1e-8, translation: 0.0 },
            Effect::ToolCompliance { rotation: 0.0, translation: 1e-9 },
        ]),
        "joint_coupling" => {
            let pair: Vec<usize> =
                place.trim_start_matches("joints ").split(',').filter_map(|joint| joint.trim().parse().ok()).collect();
            match pair[..] {
                [i, j] => elastic(&[Effect::JointCoupling { joints: [i, j], value: 1e-9 }]),
                _ => Vec::new(),
            }
        }
        "stiffness_nonlinearity" if known => [0.03, 0.06, 0.12, 0.25, 0.5, 1.0]
            .iter()
            .flat_map(|share| {
                elastic(&[Effect::StiffnessNonlinearity { joint: number, added: 1e-8, knee: share * torque }])
            })
            .collect(),
        "lost_motion" if known => [0.01, 0.03, 0.1]
            .map(|share| vec![Hidden::LostMotion { joint: number, gap: 1e-6, knee: share * torque }])
            .into(),
        "hysteresis" if known => {
            let play = |share: f64| Hidden::Hysteresis { joint: number, operators: vec![(share * torque, 1e-9)] };
            vec![[0.02, 0.05, 0.1, 0.2, 0.4].map(play).into()]
        }
        "pose_dependent_compliance" if known => {
            let one = |cos, sin| Hidden::PoseDependentCompliance { joint: number, cos, sin };
            let e = 1e-2;
            vec![vec![
                one([e, 0.0], [0.0; 2]),
                one([0.0, e], [0.0; 2]),
                one([0.0; 2], [e, 0.0]),
                one([0.0; 2], [0.0, e]),
            ]]
        }
        "joint_zero_offset" if known => vec![vec![Hidden::JointZeroOffset { joint: number, offset: 1e-3 }]],
        "dh_error" if known => {
            let of = match place.trim_end_matches(|c: char| c.is_ascii_digit()) {
                "a" => DhColumn::A,
                "d" => DhColumn::D,
                "alpha" => DhColumn::Alpha,
                _ => return Vec::new(),
            };
            vec![vec![Hidden::DhError { of, row: number, by: 1e-3 }]]
        }
        "transmission_error" if known => [1, 2, 3]
            .map(|order| {
                let one = |sin, cos| Hidden::TransmissionError { joint: number, order, sin, cos };
                vec![one(1e-3, 0.0), one(0.0, 1e-3)]
            })
            .into(),
        "load_cell_misalignment" => [Mount::Ground, Mount::Tool]
            .map(|mount| axes(&|turn| Hidden::LoadCellMisalignment { turn, mount }, 1e-3))
            .into(),
        "load_cell_bias" => {
            [Mount::Ground, Mount::Tool].map(|mount| axes(&|force| Hidden::LoadCellBias { force, mount }, 1.0)).into()
        }
        // Of one axis against another: what is common to all is what the joints could do.
        "load_cell_scale" => {
            let unequal = [[1e-3, -1e-3, 0.0], [0.0, 1e-3, -1e-3]];
            let forms = |mount| unequal.map(|scale| Hidden::LoadCellScale { scale, mount }).into();
            [Mount::Ground, Mount::Tool].map(forms).into()
        }
        "lever_arm" => vec![axes(&Hidden::LeverArm, 1e-3)],
        "reflector_offset" => vec![axes(&Hidden::ReflectorOffset, 1e-3)],
        "tracker_misalignment" => vec![axes(&Hidden::TrackerMisalignment, 1e-3)],
        "thermal_drift" => [Follows::Time, Follows::Temperature, Follows::Settling(3600.0)]
            .map(|follows| axes(&|rate| Hidden::ThermalDrift { rate, follows }, 1e-6))
            .into(),
        "creep" => [3.0, 10.0, 30.0].map(|onset| vec![Hidden::Creep { share: 1e-3, onset }]).into(),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Case, Group};
    use super::*;
    use crate::simulator::{Scenario, six_axis};

    fn hiding(hidden: Hidden) -> Ready {
        let scenario = Scenario { poses: 15, ..Scenario::new(six_axis(), Vec::new(), 4) }.hiding(hidden);
        Ready { scenario, ..Case::new(Group::Nothing, 1, 1).ready() }
    }

    #[test]
    fn what_is_known_to_be_one_is_and_other_things_are_not() {
        let base = hiding(Effect::BaseCompliance { tilt: 0.0, translation: 1e-7 }.into());
        assert!(would_do(&base, "tool_compliance@tool", 0) && would_do(&base, "base_compliance@base", 0));
        assert!(!would_do(&base, "transverse_compliance@joint 3", 0) && !would_do(&base, "outliers@rig", 0));
        // Under forces alone, a tilt of the wrist turns the tool.
        let wrist = hiding(Effect::TransverseCompliance { joint: 5, value: 2e-6 }.into());
        assert!(would_do(&wrist, "transverse_compliance@joint 6", 0) && would_do(&wrist, "tool_compliance@tool", 0));
        // A tilt of the foundation is one of joint 1.
        let foot = hiding(Effect::TransverseCompliance { joint: 1, value: 1e-7 }.into());
        assert!(would_do(&foot, "base_compliance@base", 0) && !would_do(&foot, "link_compliance@link 2", 0));
    }

    #[test]
    fn every_form_is_of_its_name() {
        let arm = six_axis();
        for name in full_names(6) {
            let forms = forms(&name, &arm);
            // Rows 5 and 6 of the wrist have no length, or end the arm.
            let no_beam = ["link_compliance@link 5", "link_compliance@link 6"].contains(&name.as_str());
            assert!(
                forms.is_empty() == no_beam && forms.iter().flatten().all(|hidden| hidden.name() == name),
                "{name}"
            );
        }
        assert!(forms("link_compliance@link 5", &arm).is_empty() && forms("nonsense", &arm).is_empty());
    }
}
