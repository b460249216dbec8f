//! One of each: a kind at a place that is drawn, of its usual size, and how
//! many times that it can be at most.

use nalgebra::Vector3;
use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;
use robstiff_robots::{Description, Effect, JointKind, Link};

use crate::simulator::{DhColumn, Follows, Hidden, Mount, Outside};

/// The kinds of the catalogue.
pub const KINDS: [&str; 23] = [
    "transverse_compliance",
    "link_compliance",
    "base_compliance",
    "tool_compliance",
    "joint_coupling",
    "stiffness_nonlinearity",
    "lost_motion",
    "hysteresis",
    "pose_dependent_compliance",
    "joint_zero_offset",
    "dh_error",
    "transmission_error",
    "gravity_sag",
    "load_cell_misalignment",
    "load_cell_bias",
    "load_cell_scale",
    "lever_arm",
    "tracker_misalignment",
    "thermal_drift",
    "creep",
    "outliers",
    "base_slip",
    "reflector_slip",
];

/// Those outside it.
pub const OUTSIDE: [&str; 13] = [
    "viscous_joint",
    "cable",
    "link_growth",
    "soft_foundation",
    "cross_dependence",
    "loose_flange",
    "loose_taper",
    "hardening_bearing",
    "warming_joint",
    "one_sided_joint",
    "gain_of_angle",
    "bent_cell",
    "load_friction",
];

/// What was drawn.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// At its usual size.
    pub hidden: Hidden,
    /// The largest multiple of it that still makes sense.
    pub most: f64,
}

/// Draws one of a kind on an arm; `mount` is where load cells are.
///
/// # Panics
/// For a kind there is none of.
pub fn draw(kind: &str, arm: &Description, mount: Mount, random: &mut ChaCha8Rng) -> Drawn {
    let joints = arm.joints.len();
    let joint = random.random_range(1..=joints);
    let h = arm.joints[joint - 1].compliance();
    // What a joint carries in such campaigns: some kN at the lever of the arm
    // or of the wrist.
    let torque = if joint <= 3 { 1000.0 } else { 200.0 };
    let sign = if random.random() { 1.0 } else { -1.0 };
    let turn: f64 = random.random_range(0.0..std::f64::consts::TAU);
    let along = three(random);
    let when = random.random_range(0.2..0.8);
    let degree = 1_f64.to_radians();
    let order = random.random_range(1..=2);
    let (hidden, most) = match kind {
        "transverse_compliance" => (Effect::TransverseCompliance { joint, value: 2e-7 }.into(), 100.0),
        "link_compliance" => {
            let beams: Vec<usize> =
                (1..joints).filter(|link| arm.joints[link - 1].a.hypot(arm.joints[link - 1].d) > 0.0).collect();
            let link = *beams.choose(random).expect("an arm has links");
            (Effect::LinkCompliance { link, bending: 7e-8, torsion: 1.2e-7 }.into(), 100.0)
        }
        "base_compliance" => (Effect::BaseCompliance { tilt: 2e-8, translation: 3e-9 }.into(), 30.0),
        "tool_compliance" => (Effect::ToolCompliance { rotation: 3e-7, translation: 1e-8 }.into(), 60.0),
        "joint_coupling" => {
            let wrist = (4..=joints).flat_map(|j| (4..j).map(move |i| [i, j]));
            let pairs: Vec<[usize; 2]> = std::iter::once([2, 3]).chain(wrist).collect();
            let [i, j] = *pairs.choose(random).expect("there are some");
            let most = (arm.joints[i - 1].compliance() * arm.joints[j - 1].compliance()).sqrt();
            (Effect::JointCoupling { joints: [i, j], value: 0.3 * sign * most }.into(), 3.1)
        }
        "stiffness_nonlinearity" => {
            let knee = torque * random.random_range(0.1..0.4);
            let effect = Effect::StiffnessNonlinearity { joint, added: 0.5 * sign * h, knee };
            (effect.into(), if sign > 0.0 { 8.0 } else { 1.9 })
        }
        "lost_motion" => (Hidden::LostMotion { joint, gap: 1.5e-4, knee: 0.03 * torque }, 20.0),
        "hysteresis" => {
            let operators = [0.05, 0.15, 0.3].map(|share| (share * torque, 0.15 * h)).into();
            (Hidden::Hysteresis { joint, operators }, 8.0)
        }
        "pose_dependent_compliance" => {
            let (mut cos, mut sin) = ([0.0; 2], [0.0; 2]);
            (cos[order - 1], sin[order - 1]) = (0.3 * turn.cos(), 0.3 * turn.sin());
            (Hidden::PoseDependentCompliance { joint, cos, sin }, 3.1)
        }
        "joint_zero_offset" => (Hidden::JointZeroOffset { joint, offset: 0.5 * sign * degree }, 12.0),
        "dh_error" => {
            let of = *[DhColumn::A, DhColumn::D, DhColumn::Alpha].choose(random).expect("there are three");
            let by = if of == DhColumn::Alpha { 0.3 * degree } else { 5e-3 };
            (Hidden::DhError { of, row: joint, by: sign * by }, 20.0)
        }
        "transmission_error" => {
            let (sin, cos) = (0.2 * degree * turn.sin(), 0.2 * degree * turn.cos());
            (Hidden::TransmissionError { joint, order, sin, cos }, 25.0)
        }
        "gravity_sag" => (Hidden::GravitySag(masses(arm)), 1.0),
        "load_cell_misalignment" => {
            (Hidden::LoadCellMisalignment { turn: along.map(|share| share * degree), mount }, 10.0)
        }
        "load_cell_bias" => (Hidden::LoadCellBias { force: along.map(|share| 10.0 * share), mount }, 15.0),
        "load_cell_scale" => {
            // Every fourth is a common one, which no campaign can tell from
            // softer joints.
            let common = random.random_range(0..4) == 0;
            let scale = if common { [0.05; 3] } else { along.map(|share| 0.04 * share) };
            (Hidden::LoadCellScale { scale, mount }, if common { 1.0 } else { 10.0 })
        }
        "lever_arm" => (Hidden::LeverArm(along.map(|share| 0.01 * share)), 20.0),
        "tracker_misalignment" => (Hidden::TrackerMisalignment(along.map(|share| share * degree)), 10.0),
        "thermal_drift" => {
            let (amount, follows) = *[
                (30e-6, Follows::Time),
                (20e-6, Follows::Temperature),
                (80e-6, Follows::Settling(random.random_range(1800.0..7200.0))),
            ]
            .choose(random)
            .expect("there are three");
            (Hidden::ThermalDrift { rate: along.map(|share| share * amount), follows }, 20.0)
        }
        "creep" => (Hidden::Creep { share: 0.02, onset: 10.0 }, 10.0),
        "outliers" => (Hidden::Outliers { share: random.random_range(0.02..0.06), size: 1e-4 }, 30.0),
        "base_slip" => {
            let turn = three(random).map(|share| 1e-5 * share);
            (Hidden::BaseSlip { shift: along.map(|share| 3e-5 * share), turn, when }, 20.0)
        }
        "reflector_slip" => (Hidden::ReflectorSlip { shift: along.map(|share| 5e-5 * share), when }, 20.0),
        _ => outside(kind, arm, random),
    };
    Drawn { hidden, most }
}

fn outside(kind: &str, arm: &Description, random: &mut ChaCha8Rng) -> (Hidden, f64) {
    let joint: usize = random.random_range(1..=3);
    let h = arm.joints[joint - 1].compliance();
    let turn: f64 = random.random_range(0.0..std::f64::consts::TAU);
    let (outside, most) = match kind {
        "viscous_joint" => {
            let constant = random.random_range(60.0..180.0);
            (Outside::ViscousJoint { joint, compliance: 0.3 * h, constant }, 10.0)
        }
        "cable" => {
            let anchor = [random.random_range(-1.0..-0.3), random.random_range(-0.8..0.8), 2.2];
            (Outside::Cable { link: 3, anchor, stiffness: 5e4, length: 0.3 }, 8.0)
        }
        "link_growth" => (Outside::LinkGrowth { link: if random.random() { 2 } else { 4 }, per_kelvin: 12e-6 }, 10.0),
        "soft_foundation" => (Outside::SoftFoundation { compliance: 4e-8, knee: 600.0 }, 30.0),
        "cross_dependence" => {
            let of = joint % 3 + 1;
            (Outside::CrossDependence { joint, of, cos: 0.3 * turn.cos(), sin: 0.3 * turn.sin() }, 3.1)
        }
        "loose_flange" => (Outside::LooseFlange { gap: 1e-4, knee: 40.0 }, 20.0),
        "loose_taper" => (Outside::LooseTaper { gap: 2e-4, knee: 15.0 }, 20.0),
        "hardening_bearing" => (Outside::HardeningBearing { joint, compliance: 3e-7, knee: 150.0 }, 30.0),
        "warming_joint" => (Outside::WarmingJoint { joint, per_kelvin: 0.02 }, 10.0),
        "one_sided_joint" => (Outside::OneSided { joint, added: 0.2 * h }, 4.0),
        "gain_of_angle" => (Outside::GainOfAngle { joint: 1, gain: 0.05 }, 3.0),
        "bent_cell" => (Outside::BentCell { bend: 0.05 }, 6.0),
        "load_friction" => (Outside::LoadFriction { share: 0.02 }, 10.0),
        _ => panic!("there is no kind `{kind}`"),
    };
    (Hidden::Outside(outside), most)
}

/// Three numbers, none of them next to nothing, of unit length.
fn three(random: &mut ChaCha8Rng) -> [f64; 3] {
    let one = Vector3::from_fn(|_, _| random.random_range(0.3..1.0) * if random.random() { 1.0 } else { -1.0 });
    one.normalize().into()
}

/// Masses of an arm of this class, each link's at the middle of its straight
/// piece.
fn masses(arm: &Description) -> Vec<Link> {
    let kilograms = [300.0, 250.0, 180.0, 60.0, 40.0, 150.0];
    let links = arm.joints.iter().zip(kilograms).map(|(joint, mass)| {
        assert_eq!(joint.kind, JointKind::Revolute, "an arm as those here");
        Link { mass, center_of_mass: [-0.5 * joint.a, 0.0, 0.0] }
    });
    links.collect()
}

/// Whether it shows only in displacements from an unloaded reading long before.
pub fn takes_hours(kind: &str) -> bool {
    ["thermal_drift", "base_slip", "link_growth", "reflector_slip"].contains(&kind)
}

/// Whether it needs the loads of a visit to follow each other without the arm
/// being unloaded between.
pub fn needs_ramps(kind: &str) -> bool {
    ["hysteresis", "creep", "viscous_joint", "load_friction"].contains(&kind)
}
