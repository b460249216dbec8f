//! The modes of an arm by the masses of its links.

use core::f64::consts::PI;

use nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector3};
use robstiff_robots::{Description, Link};

use super::tests::cut;
use super::*;
use crate::milling::{CutFrame, Engagement};
use robstiff::Robot;
use robstiff::elements::contributions;
use robstiff::generic::Generic;

/// The modes of an arm without load by the masses of its links.
fn of_links<const N: usize>(robot: &Generic<N>, links: &[Link], q: &SVector<f64, N>) -> Result<Modes, MassError> {
    Modes::of_links(robot, links, q, contributions(robot, q), 0.0)
}

#[test]
fn the_mass_of_links_is_that_of_their_movement() {
    // Three slides along x, y, z, each with a mass that all joints before move.
    let text = "name: Gantry\ndescription: slides\nsource: a test\nconvention: standard\njoints:\n  \
        - {type: prismatic, alpha: -90 deg, compliance: 1e-7 m/N}\n  \
        - {type: prismatic, theta: -90 deg, alpha: -90 deg, compliance: 1e-7 m/N}\n  \
        - {type: prismatic, compliance: 1e-7 m/N}\n";
    let description = Description::parse("gantry.yaml", text).unwrap();
    let robot = Generic::<3>::new(&description).unwrap();
    let q = SVector::from([0.1, 0.2, 0.3]);
    let links = [30.0, 20.0, 10.0].map(|mass| Link { mass, center_of_mass: [0.0; 3] });
    let modes = of_links(&robot, &links, &q).unwrap();
    let mut weights: Vec<f64> = modes.mass().unwrap().symmetric_eigenvalues().iter().copied().collect();
    weights.sort_by(f64::total_cmp);
    for (found, expected) in weights.iter().zip([10.0, 30.0, 60.0]) {
        assert!((found - expected).abs() < 1e-9, "{weights:?}");
    }
    for (found, mass) in modes.frequencies().iter().zip([60.0, 30.0, 10.0]) {
        assert!((found - (1e7_f64 / mass).sqrt()).abs() < 1e-9 * found, "{modes:?}");
    }
    assert_eq!(of_links(&robot, &[Link::default(); 3], &q), Err(MassError::Unknown));
    // The tool gives way along two slides without a mass.
    let one = of_links(&robot, &[links[0], Link::default(), Link::default()], &q).unwrap();
    assert_eq!((one.frequencies().len(), one.mass()), (1, None));
    let rigid = Description::parse("gantry.yaml", &text.replace(", compliance: 1e-7 m/N", "")).unwrap();
    assert_eq!(of_links(&Generic::<3>::new(&rigid).unwrap(), &links, &q), Err(MassError::Still));

    // A pendulum's mass at a lever, seen at the end of the arm.
    let text = "name: Arm\ndescription: two links\nsource: a test\nconvention: standard\njoints:\n  \
        - {a: 1 m, compliance: 1e-6 rad/Nm}\n  - {a: 1 m, compliance: 1e-6 rad/Nm}\n  \
        - {type: prismatic, compliance: 1e-7 m/N}\n";
    let arm = Generic::<3>::new(&Description::parse("arm.yaml", text).unwrap()).unwrap();
    let q = SVector::from([0.3, 0.5 * PI, 0.0]);
    let links = [0.0, 0.0, 8.0].map(|mass| Link { mass, center_of_mass: [0.0; 3] });
    // All the mass is in the TCP.
    let mass = of_links(&arm, &links, &q).unwrap().mass().unwrap();
    assert!((mass - Matrix3::identity() * 8.0).norm() < 1e-9, "{mass}");
}

/// An arm of six joints that all yield, with masses on every link.
fn heavy() -> (Generic<6>, Vec<Link>, SVector<f64, 6>) {
    let mut text = String::from("name: Heavy\ndescription: six\nsource: a test\nconvention: standard\njoints:\n");
    let rows = [(0.75, 0.35, -90), (0.0, 1.25, 0), (0.0, 0.055, -90), (1.1, 0.0, 90), (0.0, 0.0, -90), (0.23, 0.1, 0)];
    for (k, (d, a, alpha)) in rows.into_iter().enumerate() {
        text += &format!("  - {{d: {d} m, a: {a} m, alpha: {alpha} deg, compliance: {}e-7 rad/Nm}}\n", 3 + k * k);
    }
    let robot = Generic::<6>::new(&Description::parse("heavy.yaml", &text).unwrap()).unwrap();
    let masses = [300.0, 150.0, 120.0, 60.0, 30.0, 40.0];
    let link = |(k, mass): (usize, f64)| Link { mass, center_of_mass: [-0.1, 0.02 * k as f64, 0.05] };
    (robot, masses.into_iter().enumerate().map(link).collect(), SVector::from([0.3, -0.9, 0.4, 0.7, 0.9, -0.4]))
}

/// The joints' masses, stiffnesses and what they move the tool by, by differences of the frames.
fn by_joints(robot: &Generic<6>, links: &[Link], q: &SVector<f64, 6>) -> [DMatrix<f64>; 3] {
    let moved = |place: &dyn Fn(&SVector<f64, 6>) -> Vector3<f64>| {
        DMatrix::from_fn(3, 6, |row, joint| {
            let mut step = SVector::<f64, 6>::zeros();
            step[joint] = 1e-5;
            (place(&(q + step)) - place(&(q - step)))[row] / 2e-5
        })
    };
    let mut mass = DMatrix::zeros(6, 6);
    for (body, link) in links.iter().enumerate() {
        let center = moved(&|q| robot.link_frames(q)[body].transform_point(&link.center_of_mass.into()).coords);
        mass += center.transpose() * center * link.mass;
    }
    let stiffness =
        DMatrix::from_diagonal(&DVector::from_iterator(6, robot.joint_compliance().iter().map(|h| 1.0 / h)));
    let tool = moved(&|q| robot.transform(q).fixed_view::<3, 1>(0, 3).into_owned());
    [mass, stiffness, tool]
}

#[test]
fn modes_of_links_are_those_of_the_joints() {
    let (robot, links, q) = heavy();
    let [mass, stiffness, tool] = by_joints(&robot, &links, &q);
    let modes = of_links(&robot, &links, &q).unwrap();
    let squares = (mass.clone().try_inverse().unwrap() * &stiffness).complex_eigenvalues();
    let mut frequencies: Vec<f64> = squares.iter().map(|square| square.re.sqrt()).collect();
    frequencies.sort_by(f64::total_cmp);
    assert_eq!(modes.frequencies().len(), 6);
    for (found, expected) in modes.frequencies().iter().zip(&frequencies) {
        assert!((found / expected - 1.0).abs() < 1e-6, "{:?} {frequencies:?}", modes.frequencies());
    }
    let blow = (&tool * mass.clone().try_inverse().unwrap() * tool.transpose()).try_inverse().unwrap();
    let found = modes.mass().unwrap();
    assert!((0..9).all(|k| (found[k] - blow[k]).abs() < 1e-6 * blow.amax()), "{found} {blow}");
    // And in a cut: M q'' + (K - J^T P J) q = 0.
    for feed in [Vector3::x(), Vector3::y(), Vector3::new(1.0, -2.0, 0.5)] {
        let process = process(&cut(Engagement::SLOT), &CutFrame::new(&-Vector3::z(), &feed).unwrap());
        for depth in (1..60).map(|k| 2e-4 * f64::from(k)) {
            let whole = DMatrix::from_fn(3, 3, |i, j| depth * process[(i, j)]);
            let left = &stiffness - tool.transpose() * whole * &tool;
            let squares = (mass.clone().try_inverse().unwrap() * left).complex_eigenvalues();
            let scale = squares.iter().map(|square| square.norm()).fold(0.0, f64::max);
            let apart = squares.iter().map(|square| square.im.abs()).fold(0.0, f64::max);
            // Differences of frames say no more near a limit.
            if apart > 1e-5 * scale || apart == 0.0 {
                assert_eq!(modes.is_stable(&(process * depth)), apart == 0.0, "{feed} {depth} {squares}");
            }
        }
    }
}

#[test]
fn a_joint_that_moves_no_mass_gives_way_at_once() {
    let (robot, mut links, q) = heavy();
    let all = of_links(&robot, &links, &q).unwrap();
    // The last link lighter and lighter, to nothing.
    links[5].mass = 1e-6;
    let light = of_links(&robot, &links, &q).unwrap();
    links[5].mass = 0.0;
    let none = of_links(&robot, &links, &q).unwrap();
    assert!(all.mass().is_some() && none.mass().is_none());
    assert!((none.compliance() - all.compliance()).amax() < 1e-12 * all.compliance().amax());
    let process = process(&cut(Engagement::SLOT), &CutFrame::new(&-Vector3::z(), &Vector3::x()).unwrap());
    let [with, without] = [&light, &none].map(|modes| modes.limits(&process, 0.02).limiting().unwrap());
    assert!((with / without - 1.0).abs() < 1e-3, "{with} {without}");
}

#[test]
fn the_greatest_depth_has_no_part_in_what_is_below() {
    let (robot, links, q) = heavy();
    let mut narrow = 0;
    for damping in [0.0, 0.01] {
        let parts = contributions(&robot, &q);
        let modes = Modes::of_links(&robot, &links, &q, parts, damping).unwrap();
        for (_, feed) in feeds_in_plane(&-Vector3::z(), 24).unwrap() {
            let process = process(&cut(Engagement::SLOT), &CutFrame::new(&-Vector3::z(), &feed).unwrap());
            let near = modes.limits(&process, 0.02);
            let far = modes.limits(&process, 5.0);
            let within = |bounds: &&[f64; 2]| bounds[0] < 0.019;
            for (one, other) in near.unstable.iter().zip(far.unstable.iter().filter(within)) {
                assert!((one[0] / other[0] - 1.0).abs() < 1e-6, "{feed} {near:?} {far:?}");
                // Narrower than a hundredth of the greatest depth that was looked at.
                narrow += usize::from(one[1] - one[0] < 0.01 * 5.0);
            }
            assert_eq!(near.unstable.iter().filter(within).count(), far.unstable.iter().filter(within).count());
        }
    }
    assert!(narrow > 5, "{narrow}");
}

/// Modes that the force does not meet, however stiff, leave two that it does at their depth.
#[test]
fn stiff_modes_hide_no_pair_that_meets() {
    let process = process(&cut(Engagement::SLOT), &CutFrame::new(&-Vector3::z(), &Vector3::x()).unwrap());
    for apart in [1e-4, 1e-3, 0.05] {
        let modes = |frequencies: &[f64]| {
            let shapes = DMatrix::from_fn(3, frequencies.len(), |row, i| if row == i.min(2) { 0.1 } else { 0.0 });
            let (compliance, massless) = (Matrix3::identity(), Matrix3::zeros());
            let damping = DVector::zeros(frequencies.len());
            Modes { compliance, frequencies: frequencies.to_vec().into(), shapes, massless, damping }
        };
        let pair = [100.0, 100.0 * (1.0 + apart)];
        let alone = modes(&pair).limits(&process, 0.02).limiting().unwrap();
        let among = modes(&[pair[0], pair[1], 2e3, 5e3, 1e4]).limits(&process, 0.02).limiting().unwrap();
        assert!((among / alone - 1.0).abs() < 1e-3, "{apart}: {among} {alone}");
    }
}
