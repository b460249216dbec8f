//! Where loads act on the tool, and how what the arm does is read.

use nalgebra::{Matrix3, Vector3};
use robstiff_robots::Description;

use super::equilibrium::{Equilibrium, PosedArm};
use super::frame::exp;
use super::{Arm, Hidden, Scenario};

impl Scenario {
    /// An arm that is loaded where the loads act.
    pub(crate) fn arm(&self, description: &Description) -> Arm {
        Arm::new(description, &[]).hiding(&Hidden::LeverArm(self.hook))
    }

    /// Where the marker is (m), in the tool frame.
    pub(super) fn read_at(&self) -> Vector3<f64> {
        let off = self.hidden.iter().map(|hidden| match hidden {
            Hidden::ReflectorOffset(off) => Vector3::from(*off),
            _ => Vector3::zeros(),
        });
        Vector3::from(self.marker) + off.sum::<Vector3<f64>>()
    }

    /// The displacement of the marker (m), given that of the TCP and the rotation
    /// vector of a tool that had these axes.
    pub(super) fn at_marker(
        &self,
        tool: &Matrix3<f64>,
        displacement: Vector3<f64>,
        rotation: &Vector3<f64>,
    ) -> Vector3<f64> {
        let marker = tool * self.read_at();
        displacement + exp(rotation) * marker - marker
    }

    /// Displacement (m) and rotation (rad) as a rig that is in order reads them.
    pub(crate) fn reads(&self, posed: &PosedArm, settled: &Equilibrium) -> ([f64; 3], [f64; 3]) {
        let [displacement, rotation] = [settled.displacement, settled.rotation].map(Vector3::from);
        let tool = posed.tool();
        let frame = if self.measured_in_tool { tool.transpose() } else { Matrix3::identity() };
        let displacement = self.at_marker(&tool, displacement, &rotation);
        ((frame * displacement).into(), (frame * rotation).into())
    }
}

#[cfg(test)]
mod tests {
    use robstiff_robots::{Effect, Placement};

    use super::super::hidden_tests::{assert_near, force, vector};
    use super::super::{Row, Simulated, six_axis};
    use super::*;

    const MARKER: [f64; 3] = [0.15, -0.1, 0.25];
    const HOOK: [f64; 3] = [-0.05, 0.12, 0.1];

    /// A campaign with pulls and torques, on an arm of which a bearing tilts.
    fn scenario(arm: Description) -> Scenario {
        let tilt = Effect::TransverseCompliance { joint: 5, value: 2e-6 };
        Scenario {
            poses: 4,
            noise: 0.0,
            rotation_noise: Some(0.0),
            moment: Some([50.0, 200.0]),
            floor: -10.0,
            column: 0.0,
            ..Scenario::new(arm, vec![tilt], 21)
        }
    }

    fn both(row: &Row) -> [Vector3<f64>; 2] {
        [vector(row.displacement), vector(row.rotation.expect("rotations are read"))]
    }

    /// The marker is the TCP of an arm with another tool, loaded at the same
    /// point.
    #[test]
    fn a_marker_moves_as_the_end_of_a_tool_that_reaches_it() {
        let arm = six_axis();
        assert!(arm.tool.rpy == [0.0; 3], "the tool's frame is the flange's, shifted");
        let xyz = std::array::from_fn(|k| arm.tool.xyz[k] + MARKER[k]);
        let longer = Description { tool: Placement { xyz, ..arm.tool }, ..arm.clone() };
        let seen = Scenario { marker: MARKER, hook: HOOK, ..scenario(arm.clone()) }.run();
        let hook = std::array::from_fn(|k| HOOK[k] - MARKER[k]);
        let there = Scenario { hook, ..scenario(longer) }.run();
        let tcp = Scenario { hook: HOOK, ..scenario(arm) }.run();
        for ((row, there), tcp) in seen.rows.iter().zip(&there.rows).zip(&tcp.rows) {
            assert_eq!((&row.q, row.wrench), (&there.q, there.wrench));
            let ([moved, turned], [there, also]) = (both(row), both(there));
            assert_near(moved, there, 1e-12);
            assert_near(turned, also, 1e-12);
            assert!((moved - vector(tcp.displacement)).norm() > 1e-6);
        }
    }

    #[test]
    fn what_is_read_in_the_tool_frame_is_the_same() {
        let base = Scenario { marker: MARKER, ..scenario(six_axis()) };
        let tool = Scenario { measured_in_tool: true, wrench_in_tool: true, ..base.clone() }.run();
        assert!(tool.campaign_yaml().contains("wrench: {frame: tool, at: tcp}"));
        assert!(tool.campaign_yaml().contains("measured: {frame: tool, at: [0.15, -0.1, 0.25]}"));
        let Simulated { scenario, rows } = base.run();
        for (row, other) in rows.iter().zip(&tool.rows) {
            let turn = scenario.arm(&six_axis()).at(&row.q).tool();
            let ([moved, turned], [seen, also]) = (both(row), both(other));
            assert_near(turn * seen, moved, 1e-15);
            assert_near(turn * also, turned, 1e-15);
            assert_near(turn * force(&other.wrench), force(&row.wrench), 1e-11);
        }
    }
}
