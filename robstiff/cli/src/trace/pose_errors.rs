//! The errors of every pose, or of every clamped axis, and what the effects add there.

use robstiff_identify::campaign::{Campaign, ClampedRow, Data};
use robstiff_identify::identify::without_laws;
use robstiff_identify::predict::predict;
use robstiff_identify::trace::Trace;
use robstiff_robots::Description;

use super::wording::{declared, outliers};
use crate::failure::Failure;
use crate::report::content::PoseError;

/// The errors, in the campaign's order (um; of clamped axes urad or um).
///
/// # Errors
/// What predicting the campaign says against it, which a campaign that was
/// traced does not.
pub fn errors(trace: &Trace, campaign: &Campaign) -> Result<Vec<PoseError>, Failure> {
    match &campaign.data {
        Data::Displacement(data) => of_poses(trace, campaign, &data.poses),
        Data::Position(data) => of_poses(trace, campaign, &data.poses),
        Data::Clamped(rows) => Ok(of_axes(trace, campaign, rows)),
    }
}

fn of_poses(trace: &Trace, campaign: &Campaign, poses: &[String]) -> Result<Vec<PoseError>, Failure> {
    let predict = |robot| predict(robot, campaign).map_err(Failure::about(campaign));
    let as_declared = predict(&campaign.robot)?;
    let (with, without) = (predict(&trace.description)?, predict(&without_effects(trace, &campaign.robot))?);

    let outliers = outliers(trace);
    let mut sums = vec![Sums::default(); poses.len()];
    for (index, residual) in trace.residuals.iter().enumerate() {
        let sum = &mut sums[residual.pose];
        sum.rows += 1;
        sum.outlying |= outliers.contains(&residual.line);
        sum.declared += as_declared.rows[index].error().powi(2);
        sum.identified += mean_square(residual.before);
        sum.after += mean_square(residual.after);
        let (with, without) = (with.rows[index].predicted, without.rows[index].predicted);
        sum.contribution += mean_square(std::array::from_fn(|axis| with[axis] - without[axis]));
    }
    let error = |(id, sum): (&String, &Sums)| PoseError {
        id: id.clone(),
        declared: sum.rms_um(sum.declared),
        identified: sum.rms_um(sum.identified),
        after: sum.rms_um(sum.after),
        contribution: sum.rms_um(sum.contribution),
        held_out: trace.held_out.contains(id),
        outlying: sum.outlying,
    };
    Ok(poses.iter().zip(&sums).map(error).collect())
}

/// Squares of one axis, summed over the rows of a pose (m^2), how many these are, and whether one
/// does not belong to the others.
#[derive(Clone, Default)]
struct Sums {
    rows: usize,
    outlying: bool,
    declared: f64,
    identified: f64,
    after: f64,
    contribution: f64,
}

impl Sums {
    fn rms_um(&self, sum: f64) -> f64 {
        (sum / self.rows.max(1) as f64).sqrt() * 1e6
    }
}

fn mean_square(vector: [f64; 3]) -> f64 {
    vector.iter().map(|component| component * component).sum::<f64>() / 3.0
}

fn of_axes(trace: &Trace, campaign: &Campaign, rows: &[ClampedRow]) -> Vec<PoseError> {
    let less = without_laws(&campaign.robot, rows);
    let as_declared = |name: &str| {
        let of_axis = less.iter().filter(|row| format!("axis {}", row.axis) == name);
        rms(of_axis.map(|row| row.deflection - campaign.robot.joints[row.axis - 1].compliance() * row.torque))
    };
    // What both descriptions have is taken from the same readings.
    let without = without_effects(trace, &campaign.robot);
    let [with, without] = [&trace.description, &without].map(|robot| without_laws(robot, rows));
    let contribution = |name: &str| {
        let of_axis = with.iter().zip(&without).filter(|(row, _)| format!("axis {}", row.axis) == name);
        rms(of_axis.map(|(with, without)| without.deflection - with.deflection))
    };
    let error = |one: &robstiff_identify::trace::PoseError| PoseError {
        id: one.pose.clone(),
        declared: 1e6 * as_declared(&one.pose),
        identified: 1e6 * one.before,
        after: 1e6 * one.after,
        contribution: 1e6 * contribution(&one.pose),
        held_out: one.held_out,
        // Of an axis a few of many rows.
        outlying: false,
    };
    trace.pose_errors.iter().map(error).collect()
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let squares: Vec<f64> = values.map(|value| value * value).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

/// The description that is written without the effects that were added: of those that a robot
/// declares, which are changed in their place, what it declares.
fn without_effects(trace: &Trace, robot: &Description) -> Description {
    let mut without = trace.description.clone();
    without.effects.truncate(robot.effects.len());
    let found = || {
        let suspected = trace.suspected.iter().map(|one| &one.effect);
        trace.effects.iter().map(|one| &one.effect).chain(suspected)
    };
    for (effect, before) in without.effects.iter_mut().zip(&robot.effects) {
        if found().any(|one| declared(robot, one) == Some(before)) {
            *effect = *before;
        }
    }
    without
}

#[cfg(test)]
mod tests {
    use robstiff_identify::campaign::Noise;
    use robstiff_identify::simulate::{Scenario, simulate};
    use robstiff_identify::trace::Options;
    use robstiff_robots::catalogue;

    use super::super::wording::is_written;
    use super::*;

    fn robot(effect: &str) -> Description {
        let text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
        Description::parse("robot.yaml", &format!("{text}{effect}")).expect("of the catalogue")
    }

    fn traced(robot: Description, data: Data) -> (Trace, Campaign) {
        let nowhere = || std::path::PathBuf::new();
        let campaign = Campaign {
            name: "x".to_owned(),
            date: String::new(),
            operator: String::new(),
            path: nowhere(),
            robot_path: nowhere(),
            observations_path: nowhere(),
            robot,
            data,
            noise: Noise::default(),
            holdout: None,
            held_out: Vec::new(),
            warnings: Vec::new(),
        };
        let trace = robstiff_identify::trace::trace(&campaign, &Options::default(), &|_| {}).expect("joints are seen");
        (trace, campaign)
    }

    const PLAN: &str = "\
name: x
seed: 3
poses: {count: 30, floor: 100 mm, column: 600 mm}
visits: 2
ramp: [0.35, 0.7, 1]
force: {bounds: [500 N, 1300 N]}
noise: {displacement: 8 um, stated: no}
";

    /// What is declared and is true no longer is changed in its place, and the change is what
    /// is added.
    #[test]
    fn a_change_of_what_is_declared_adds_something() {
        let measured = robot("");
        let scenario = Scenario::parse("try.yaml", PLAN, &measured).unwrap_or_else(|problems| panic!("{problems}"));
        let data = simulate(&measured, &scenario).expect("it can be measured").data;
        let stale = robot("effects: [{kind: dh_error, at: theta3, value: 0.03 rad}]\n");
        let (trace, campaign) = traced(stale, data);
        assert_eq!(trace.effects.len(), 1, "{}", trace.why);
        assert!(is_written(&trace, &trace.effects[0].effect));
        let without = without_effects(&trace, &campaign.robot);
        assert_eq!(without.effects, campaign.robot.effects);
        assert_ne!(without.effects, trace.description.effects);
        let errors = errors(&trace, &campaign).expect("it was traced");
        assert!(errors.iter().all(|pose| pose.contribution > 1.0));
    }

    /// Of clamped axes as of poses: all that the curve of a gear does, not what the joints alone
    /// could not take up of it.
    #[test]
    fn of_clamped_axes_the_whole_curve_is_added() {
        let robot = robot("");
        let curve = |torque: f64| 2e-7 * torque / (torque / 300.0).hypot(1.0);
        let torques: Vec<f64> = (-10..=10).filter(|k| *k != 0).map(|k| 100.0 * f64::from(k)).collect();
        let mut rows: Vec<ClampedRow> = Vec::new();
        for axis in 1..=robot.joints.len() {
            for (k, &torque) in torques.iter().enumerate() {
                // Rounded as a drawn reading would be off.
                let noise = [3e-7, -4e-7, 1e-7, 5e-7, -5e-7, -2e-7, 2e-7][(3 * k + axis) % 7];
                let more = if axis == 2 { curve(torque) } else { 0.0 };
                let deflection = robot.joints[axis - 1].compliance() * torque + more + noise;
                rows.push(ClampedRow { line: rows.len() + 2, axis, torque, deflection });
            }
        }
        let (trace, campaign) = traced(robot, Data::Clamped(rows));
        // A curve has two names: lost motion and hardening are one law.
        let names = [vec![trace.effects[0].effect.to_string()], trace.effects[0].same_as()].concat();
        assert!(names.iter().any(|name| name == "stiffness_nonlinearity@joint 2"), "{names:?} {}", trace.why);
        let errors = errors(&trace, &campaign).expect("it was traced");
        let whole = (torques.iter().map(|&torque| curve(torque).powi(2)).sum::<f64>() / torques.len() as f64).sqrt();
        let added = errors.iter().find(|axis| axis.id == "axis 2").expect("it was loaded").contribution;
        assert!((added / (1e6 * whole) - 1.0).abs() < 0.2, "{added} of {}", 1e6 * whole);
        assert!(errors.iter().filter(|axis| axis.id != "axis 2").all(|axis| axis.contribution < 1e-6));
    }
}
