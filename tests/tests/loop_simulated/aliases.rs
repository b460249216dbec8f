//! What no data, or not these, can tell apart: shown by algebra on the elements
//! themselves, and then told by tracing.

use nalgebra::{Matrix3, Matrix6, SVector, Vector3};
use robstiff::elements::{Pose, Spring};
use robstiff::{Effect, Generic};
use robstiff_identify::trace::Trace;
use robstiff_robots::Description;
use robstiff_tests::judge::trials;
use robstiff_tests::simulator::{Scenario, five_axis, six_axis};

use crate::bench::{arm, assert_most, names_all, plan, trace_files, traced};

/// The compliances of elements of value 1 in random poses.
fn units<const N: usize, const K: usize>(arm: &Description, springs: [Spring; K]) -> Vec<[Matrix6<f64>; K]> {
    let generic = Generic::<N>::new(arm).expect("as many joints");
    let unit = |q: &SVector<f64, N>| {
        let pose = Pose::of(&generic, q);
        springs.map(|spring| pose.geometry().unit_compliance(spring))
    };
    trials::<N>(50, 60).map(|(q, _)| unit(&q)).collect()
}

fn same(one: &Matrix6<f64>, other: &Matrix6<f64>) -> bool {
    (one - other).amax() < 1e-12 * one.amax()
}

/// Displacement per force.
fn of_forces(compliance: &Matrix6<f64>) -> Matrix6<f64> {
    let mut part = Matrix6::zeros();
    part.fixed_view_mut::<3, 3>(0, 0).copy_from(&compliance.fixed_view::<3, 3>(0, 0));
    part
}

fn assert_told(what: &str, arm: &Description, hidden: Effect, aliases: &[&str], change: impl Fn(Scenario) -> Scenario) {
    let trace = |seed| trace_files(&change(plan(arm, &[hidden], seed)).run(), arm, "");
    let traces: Vec<(u64, Trace)> = (600..603).map(|seed| (seed, trace(seed))).collect();
    assert_most(what, 2, &traces, |_, trace| {
        let named = |alias: &str| {
            let one = &trace.effects[0];
            one.effect.to_string() == alias || one.same_as().iter().any(|name| name == alias)
        };
        names_all(trace, &[hidden]) && aliases.iter().all(|alias| named(alias))
    });
}

/// Tilt and turn of a joint are a turn about all axes through its centre, so
/// with the joints fitted two joints with one centre have one tilt. In the
/// standard convention the joint frames 5 and 6 of a spherical wrist are at its
/// centre, that of joint 4 is at the elbow. The tilt is smaller than what joints
/// 5 and 6 have: a larger one of joint 5 could be one of joint 6 only with a
/// joint that yields against its load.
#[test]
fn tilts_of_a_wrist_are_one() {
    let arm = six_axis();
    let [t4, t5, t6] = [4, 5, 6].map(Spring::Transverse);
    let [j4, j5, j6] = [4, 5, 6].map(Spring::Joint);
    for [t4, t5, t6, j4, j5, j6] in units::<6, 6>(&arm, [t4, t5, t6, j4, j5, j6]) {
        assert!(same(&(t5 + j5), &(t6 + j6)) && !same(&(t4 + j4), &(t5 + j5)));
    }
    let aliases = ["transverse_compliance@joint 5", "transverse_compliance@joint 6"];
    let moments = |scenario| Scenario { moment: Some([50.0, 200.0]), rotation_noise: Some(5e-5), ..scenario };
    for joint in [5, 6] {
        let hidden = Effect::TransverseCompliance { joint, value: 1.5e-6 };
        assert_told("a tilt of the wrist", &arm, hidden, &aliases, moments);
    }
}

/// Under forces alone, and with the tool on the flange axis, a turn of the tool
/// moves the TCP as one about the wrist's centre does, only less.
#[test]
fn under_forces_a_wrist_tilts_as_its_tool() {
    let arm = six_axis();
    let lever = [0.12, 0.12 + 0.23].map(|length: f64| length * length);
    for [tool, t6, j6] in units::<6, 3>(&arm, [Spring::ToolRotation, Spring::Transverse(6), Spring::Joint(6)]) {
        assert!(of_forces(&j6).amax() < 1e-20);
        assert!(same(&(of_forces(&tool) / lever[0]), &(of_forces(&t6) / lever[1])));
        assert!(!same(&(tool / lever[0]), &(t6 / lever[1])));
    }
    let hidden = Effect::TransverseCompliance { joint: 5, value: 1.5e-6 };
    let aliases = ["tool_compliance@tool", "transverse_compliance@joint 6"];
    assert_told("a tilt of the wrist, forces alone", &arm, hidden, &aliases, |scenario| scenario);
}

#[test]
fn translation_of_the_base_is_that_of_the_tool() {
    for arm in [five_axis(), six_axis()] {
        let hidden = Effect::BaseCompliance { tilt: 0.0, translation: 8e-8 };
        assert_told("a translation", &arm, hidden, &["tool_compliance@tool"], |scenario| scenario);
    }
    for [base, tool] in units::<5, 2>(&five_axis(), [Spring::BaseTranslation, Spring::ToolTranslation]) {
        assert_eq!(base, tool);
    }
}

/// In the standard convention the frame of joint 1 stands on the base.
#[test]
fn tilt_of_the_base_is_that_of_joint_1() {
    for [base, tilt] in units::<5, 2>(&five_axis(), [Spring::BaseTilt, Spring::Transverse(1)]) {
        assert!(same(&base, &tilt));
    }
    let hidden = Effect::TransverseCompliance { joint: 1, value: 4e-8 };
    assert_told("a tilt at the foot", &five_axis(), hidden, &["base_compliance@base"], |scenario| scenario);
}

/// In the plane of an arm, with no turn of the wrist out of it, a beam bends as
/// its two joints turn, each and both together: as joints with a coupling that
/// is positive. A negative one is no beam.
#[test]
fn bending_in_the_plane_is_two_joints_and_their_coupling() {
    let springs = [Spring::LinkBending(2), Spring::Joint(2), Spring::Joint(3), Spring::Coupling([2, 3])];
    let generic = Generic::<6>::new(&six_axis()).expect("six joints");
    for (mut q, _) in trials::<6>(50, 60) {
        q[3] = 0.0;
        let pose = Pose::of(&generic, &q);
        let [beam, two, three, both] = springs.map(|spring| pose.geometry().unit_compliance(spring));
        let axis: Vector3<f64> = pose.geometry().joint_frames[1].fixed_view::<3, 1>(0, 2).into_owned();
        let plane = Matrix3::identity() - axis * axis.transpose();
        let in_plane = |compliance: Matrix6<f64>| plane * compliance.fixed_view::<3, 3>(0, 0) * plane;
        let off = in_plane(beam) - in_plane((two + three) / 3.0 + both / 6.0);
        assert!(off.amax() < 1e-12 * beam.amax(), "{off}");
    }
    let negative = Effect::JointCoupling { joints: [2, 3], value: -1.4e-7 };
    let traces: Vec<(u64, Trace)> = (600..603).map(|seed| (seed, traced(&six_axis(), &[negative], seed))).collect();
    assert_most("a negative coupling", 3, &traces, |_, trace| {
        trace.effects[0].effect.kind() == negative.kind() && trace.effects[0].same_as().is_empty()
    });
}

/// A short link that bends is the bearing at its end that tilts, nearly: both
/// names are told wherever the data do not decide.
#[test]
fn bending_of_a_link_is_named_or_told() {
    for link in [2, 4] {
        let hidden = Effect::LinkCompliance { link, bending: 3e-7, torsion: 0.0 };
        let traces: Vec<(u64, Trace)> = (600..604).map(|seed| (seed, traced(&arm(seed), &[hidden], seed))).collect();
        assert_most(&hidden.to_string(), 3, &traces, |_, trace| names_all(trace, &[hidden]));
    }
}
