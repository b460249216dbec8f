//! What can be seen at all: least squares on campaigns without noise, done
//! with the simulator alone, so that what is asked of tracing does not depend
//! on tracing.
//!
//! What a campaign *misses* is what would be read without noise, less what the
//! arm without anything hidden does under the wrenches of the file at the joint
//! coordinates of the file. What is *left* of it is beyond what other
//! compliances of the joints could do: the residual of a plain least-squares
//! fit with a column a joint.

use nalgebra::{DMatrix, DVector, Vector3};
use robstiff_robots::{Description, Part};

use crate::simulator::{Arm, Hidden, Scenario, Simulated};

/// A compliance small enough for first order (rad/Nm).
const TINY: f64 = 1e-10;

/// Readings of a campaign, in multiples of their noise.
#[derive(Clone, Debug)]
pub struct Seen {
    /// What is missed: of each row the displacement, and the rotation where it
    /// is measured.
    pub missed: DVector<f64>,
    /// What a unit of each joint's compliance would add.
    pub joints: DMatrix<f64>,
    /// Numbers a row: 3 or 6.
    pub axes: usize,
}

impl Seen {
    /// What the readings of a campaign, as they would be without noise, show.
    pub fn of(simulated: &Simulated) -> Self {
        Self::with(simulated, true)
    }

    fn with(simulated: &Simulated, joints: bool) -> Self {
        let scenario = &simulated.scenario;
        let axes = if scenario.rotation_noise.is_some() { 6 } else { 3 };
        let scale = |displacement: [f64; 3], rotation: [f64; 3]| -> Vec<f64> {
            let turns = scenario.rotation_noise.map(|noise| rotation.map(|turn| turn / noise));
            let moves = displacement.map(|moved| moved / scenario.noise);
            moves.into_iter().chain(turns.into_iter().flatten()).collect()
        };
        let plain = scenario.arm(&scenario.truth);
        let single: Vec<Arm> = (0..if joints { scenario.truth.joints.len() } else { 0 })
            .map(|joint| scenario.arm(&only(&scenario.truth, joint)))
            .collect();
        let count = simulated.rows.len() * axes;
        let (mut missed, mut joints) = (DVector::zeros(count), DMatrix::zeros(count, single.len()));
        for (index, row) in simulated.rows.iter().enumerate() {
            let posed = plain.at(&row.q);
            let wrench = if scenario.wrench_in_tool { to_base(&posed.axes(), &row.wrench) } else { row.wrench };
            let put = |column: &mut [f64], values: Vec<f64>| column[index * axes..][..axes].copy_from_slice(&values);
            let said = scenario.reads(&posed, &posed.settle(&wrench));
            let off = |read: [f64; 3], said: [f64; 3]| std::array::from_fn(|axis| read[axis] - said[axis]);
            let values = scale(off(row.exact_displacement, said.0), off(row.exact_rotation, said.1));
            put(missed.as_mut_slice(), values);
            for (arm, mut column) in single.iter().zip(joints.column_iter_mut()) {
                let posed = arm.at(&row.q);
                let (displacement, rotation) = scenario.reads(&posed, &posed.settle(&wrench));
                let values = scale(displacement, rotation);
                put(column.as_mut_slice(), values.iter().map(|value| value / TINY).collect());
            }
        }
        Self { missed, joints, axes }
    }

    /// The rms of one axis of the displacements that is left of `missed`, in
    /// multiples of the noise, when the joints and `others` have been fitted.
    pub fn left(&self, missed: &DVector<f64>, others: &[&DVector<f64>]) -> f64 {
        let left = residual(missed, &self.joints, others);
        let rows = left.len() / self.axes;
        let squares: f64 = (0..rows).map(|row| left.rows(row * self.axes, 3).norm_squared()).sum();
        (squares / (3 * rows) as f64).sqrt()
    }

    /// The same over all readings, as a sum of squares.
    pub fn chi_square(&self, missed: &DVector<f64>, others: &[&DVector<f64>]) -> f64 {
        residual(missed, &self.joints, others).norm_squared()
    }
}

/// What is left of a vector after columns have been fitted to it.
fn residual(vector: &DVector<f64>, joints: &DMatrix<f64>, others: &[&DVector<f64>]) -> DVector<f64> {
    // Modified Gram and Schmidt, twice, leaving out what there is nothing new
    // in.
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let columns = joints.column_iter().map(|column| column.into_owned()).chain(others.iter().map(|&one| one.clone()));
    let clear = |vector: &mut DVector<f64>, basis: &[DVector<f64>]| {
        for _ in 0..2 {
            for direction in basis {
                let share = direction.dot(vector);
                vector.axpy(-share, direction, 1.0);
            }
        }
    };
    for mut column in columns {
        let size = column.norm();
        clear(&mut column, &basis);
        let rest = column.norm();
        if rest > 1e-9 * size {
            basis.push(column / rest);
        }
    }
    let mut left = vector.clone();
    clear(&mut left, &basis);
    left
}

/// The arm with one joint that gives way a little, and no other.
fn only(arm: &Description, joint: usize) -> Description {
    let mut arm = arm.clone();
    for (index, row) in arm.joints.iter_mut().enumerate() {
        row.compliance.clear();
        if index == joint {
            row.compliance.push(Part { name: String::new(), value: TINY });
        }
    }
    arm
}

fn to_base(tool: &[[f64; 3]; 3], wrench: &[f64; 6]) -> [f64; 6] {
    let turned = |first: usize| -> Vector3<f64> {
        tool.iter().zip(&wrench[first..]).map(|(axis, value)| Vector3::from(*axis) * *value).sum()
    };
    let (force, moment) = (turned(0), turned(3));
    [force.x, force.y, force.z, moment.x, moment.y, moment.z]
}

/// The campaign with these hidden, as it would be without noise.
pub fn seen(scenario: &Scenario, hidden: &[Hidden]) -> Seen {
    Seen::of(&with(scenario, hidden))
}

/// What is missed in it, without what the joints could do.
pub fn missed(scenario: &Scenario, hidden: &Hidden) -> DVector<f64> {
    Seen::with(&with(scenario, std::slice::from_ref(hidden)), false).missed
}

fn with(scenario: &Scenario, hidden: &[Hidden]) -> Simulated {
    Scenario { hidden: hidden.to_vec(), ..scenario.clone() }.run()
}

#[cfg(test)]
mod tests {
    use robstiff_robots::Effect;

    use super::*;
    use crate::simulator::{Mount, six_axis};

    fn scenario() -> Scenario {
        Scenario { poses: 12, ..Scenario::new(six_axis(), Vec::new(), 3) }
    }

    #[test]
    fn nothing_hidden_leaves_nothing() {
        let seen = seen(&scenario(), &[]);
        assert!(seen.left(&seen.missed, &[]) < 1e-6);
    }

    #[test]
    fn joints_account_for_a_common_scale_and_not_for_one_axis() {
        let of = |scale: [f64; 3]| {
            let cell = Hidden::LoadCellScale { scale, mount: Mount::Ground };
            let seen = seen(&scenario(), &[cell]);
            (seen.left(&seen.missed, &[]), seen.missed.amax())
        };
        let ((common, much), (one, _)) = (of([0.1; 3]), of([0.1, 0.0, 0.0]));
        assert!(common < 0.05 && much > 5.0 && one > 1.0, "{common} {much} {one}");
    }

    #[test]
    fn a_wrench_in_the_tool_frame_is_the_same() {
        let tilt = Hidden::Elastic(Effect::TransverseCompliance { joint: 3, value: 3e-7 });
        let base = seen(&scenario(), std::slice::from_ref(&tilt));
        let tool = seen(&Scenario { wrench_in_tool: true, ..scenario() }, &[tilt]);
        assert!((base.missed - tool.missed).amax() < 1e-6);
    }

    #[test]
    fn exact_aliases_leave_nothing_to_each_other() {
        let base = Hidden::Elastic(Effect::BaseCompliance { tilt: 0.0, translation: 5e-8 });
        let tool = Hidden::Elastic(Effect::ToolCompliance { rotation: 0.0, translation: 5e-8 });
        let (base, tool) = (seen(&scenario(), &[base]), seen(&scenario(), &[tool]));
        assert!(base.left(&base.missed, &[]) > 0.5 && base.left(&base.missed, &[&tool.missed]) < 1e-3);
        assert!(base.chi_square(&base.missed, &[&tool.missed]) < 1e-2);
    }
}
