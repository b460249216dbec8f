use core::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{DMatrix, Matrix2, Matrix3, SVector, Unit, Vector3};
use proptest::prelude::*;
use robstiff_robots::Description;

use super::*;
use crate::milling::{Coefficients, Cut, CutFrame, Direction, EndMill, Engagement};
use robstiff::generic::Generic;
use robstiff::{Robot, analysis};

/// A mass in a plane: two springs, rigid across.
fn plane(k1: f64, k2: f64, mass: f64, damping: f64) -> Modes {
    let compliance = Matrix3::from_diagonal(&Vector3::new(1.0 / k1, 1.0 / k2, 0.0));
    Modes::new(&compliance, &(Matrix3::identity() * mass), damping).unwrap()
}

fn in_plane(angle: f64) -> Unit<Vector3<f64>> {
    Unit::new_normalize(Vector3::new(angle.cos(), angle.sin(), 0.0))
}

pub(super) fn cut(engagement: Engagement) -> Cut {
    let mill = EndMill { diameter: 0.02, teeth: 4, helix: 0.5, corner: 0.0, runout: Vec::new() };
    let coefficients = Coefficients { ktc: 767e6, kte: 27.7e3, krc: 169e6, kre: 26.6e3, kac: 222e6, kae: 700.0 };
    Cut { mill, coefficients, engagement, depth: 0.002, feed_per_tooth: 1e-4, speed: None }
}

/// How much a small displacement has grown after so many seconds: the equation
/// of motion by Runge and Kutta, in the tool's own coordinates.
fn growth(mass: &Matrix3<f64>, damping: &Matrix3<f64>, stiffness: &Matrix3<f64>, seconds: f64, step: f64) -> f64 {
    let inverse = mass.try_inverse().unwrap();
    let force = |x: Vector3<f64>, v: Vector3<f64>| -inverse * (stiffness * x + damping * v);
    let (mut x, mut v) = (Vector3::new(1.0, -0.7, 0.4), Vector3::zeros());
    let mut largest: f64 = 0.0;
    let steps = (seconds / step) as usize;
    for k in 0..steps {
        let (x1, v1) = (v, force(x, v));
        let (x2, v2) = (v + v1 * (0.5 * step), force(x + x1 * (0.5 * step), v + v1 * (0.5 * step)));
        let (x3, v3) = (v + v2 * (0.5 * step), force(x + x2 * (0.5 * step), v + v2 * (0.5 * step)));
        let (x4, v4) = (v + v3 * step, force(x + x3 * step, v + v3 * step));
        x += (x1 + x2 * 2.0 + x3 * 2.0 + x4) * (step / 6.0);
        v += (v1 + v2 * 2.0 + v3 * 2.0 + v4) * (step / 6.0);
        if k > steps * 9 / 10 {
            largest = largest.max(x.norm());
        }
    }
    largest
}

proptest! {
    #[test]
    fn the_criterion_in_a_plane_is_that_of_the_eigenvalues(
        k1 in 0.1e6..3e6_f64, k2 in 0.1e6..3e6_f64, mass in 20.0..400.0_f64,
        kp in 1e3..2e6_f64, force in 0.0..TAU, normal in 0.0..TAU,
    ) {
        let modes = plane(k1, k2, mass, 0.0);
        let process = rank_one(kp, &in_plane(force), &in_plane(normal));
        let reduced = (Matrix2::new(k1, 0.0, 0.0, k2) - process.fixed_view::<2, 2>(0, 0)) / mass;
        let eigenvalues = reduced.complex_eigenvalues();
        let complex = eigenvalues.iter().any(|value| value.im.abs() > 1e-6 * value.norm());
        let near = (eigenvalues[0] - eigenvalues[1]).norm() < 1e-5 * eigenvalues[0].norm();
        prop_assume!(!near);
        prop_assert_eq!(has_complex_pair(&reduced), complex);
        let stable = !complex && eigenvalues.iter().all(|value| value.re > 0.0);
        prop_assert_eq!(modes.is_stable(&process), stable);
    }

    #[test]
    fn three_modes_are_judged_as_by_their_eigenvalues(
        k in prop::array::uniform3(0.1e6..3e6_f64), mass in 20.0..400.0_f64,
        entries in prop::array::uniform9(-0.5e6..0.5e6_f64),
    ) {
        let compliance = Matrix3::from_diagonal(&Vector3::from(k).map(f64::recip));
        let modes = Modes::new(&compliance, &(Matrix3::identity() * mass), 0.0).unwrap();
        let process = Matrix3::from_row_slice(&entries);
        let eigenvalues = ((Matrix3::from_diagonal(&Vector3::from(k)) - process) / mass).complex_eigenvalues();
        let gap = |i: usize, j: usize| (eigenvalues[i] - eigenvalues[j]).norm() / eigenvalues.camax();
        prop_assume!(gap(0, 1).min(gap(0, 2)).min(gap(1, 2)) > 1e-4);
        prop_assume!(eigenvalues.iter().all(|value| value.norm() > 1e-6 * eigenvalues.camax()));
        let stable = eigenvalues.iter().all(|value| value.im.abs() < 1e-9 * value.norm() && value.re > 0.0);
        prop_assert_eq!(modes.is_stable(&process), stable);
    }

    /// The product of the couplings is at most (kp / 2)^2 in size.
    #[test]
    fn a_cut_soft_against_the_difference_of_the_stiffnesses_never_couples(
        k1 in 0.1e6..3e6_f64, k2 in 0.1e6..3e6_f64, share in 0.0..0.49_f64, force in 0.0..TAU, normal in 0.0..TAU,
    ) {
        prop_assume!((k1 - k2).abs() > 1e3);
        let kp = share * (k1 - k2).abs();
        let reduced = Matrix2::new(k1, 0.0, 0.0, k2)
            - rank_one(kp, &in_plane(force), &in_plane(normal)).fixed_view::<2, 2>(0, 0);
        prop_assert!(!has_complex_pair(&reduced));
    }

    #[test]
    fn limits_of_two_modes_are_where_the_eigenvalues_change(
        k1 in 0.1e6..3e6_f64, k2 in 0.1e6..3e6_f64, force in 0.0..TAU, normal in 0.0..TAU,
    ) {
        let modes = plane(k1, k2, 100.0, 0.0);
        let process = rank_one(1e9, &in_plane(force), &in_plane(normal));
        let limits = modes.limits(&process, 0.01);
        for k in 1..200 {
            let depth = 0.01 * f64::from(k) / 200.0;
            let near = limits.unstable.iter().flatten().any(|bound| (bound - depth).abs() < 1e-7);
            if !near {
                prop_assert_eq!(limits.is_stable(depth), modes.is_stable(&(process * depth)), "{} {:?}", depth, limits);
            }
        }
    }
}

#[test]
fn a_simulation_in_time_agrees() {
    let (compliance, weight) = (Vector3::new(2e-6, 1.5e-6, 1.1e-6), 120.0);
    let turn = *nalgebra::Rotation3::from_euler_angles(0.4, -0.7, 1.1).matrix();
    let compliance = turn * Matrix3::from_diagonal(&compliance) * turn.transpose();
    let (mass, stiffness) = (Matrix3::identity() * weight, compliance.try_inverse().unwrap());
    let mut seen = (0, 0);
    for damping in [0.0, 0.02] {
        let modes = Modes::new(&compliance, &mass, damping).unwrap();
        // 2 zeta sqrt(K M), by the modes.
        let back = modes.shapes().clone().try_inverse().unwrap();
        let rates = DMatrix::from_diagonal(&(nalgebra::DVector::from_row_slice(modes.frequencies()) * 2.0 * damping));
        let dashpots = back.transpose() * rates * back;
        let dashpots = Matrix3::from_fn(|i, j| dashpots[(i, j)]);
        for engagement in [
            Engagement::SLOT,
            Engagement::of_width(Direction::Up, 0.005, 0.02).unwrap(),
            Engagement::of_width(Direction::Down, 0.005, 0.02).unwrap(),
        ] {
            for feed in [Vector3::x(), Vector3::y(), Vector3::new(1.0, -2.0, 0.0)] {
                let process = process(&cut(engagement), &CutFrame::new(&-Vector3::z(), &feed).unwrap());
                let limits = modes.limits(&process, 0.01);
                let Some(limit) = limits.limiting() else { continue };
                for (depth, expected) in [(0.8 * limit, true), (1.2 * limit, false)] {
                    if limits.is_stable(depth) != expected {
                        continue;
                    }
                    let grown = growth(&mass, &dashpots, &(stiffness - process * depth), 30.0, 1e-3);
                    assert_eq!(grown < 30.0, expected, "{engagement:?} {feed} {depth}: {grown}");
                    if expected { seen.0 += 1 } else { seen.1 += 1 }
                }
            }
        }
    }
    assert!(seen.0 > 6 && seen.1 > 6, "{seen:?}");
}

/// How much a small displacement grows while the teeth turn, one by one and 400 of
/// them a second, over the last 20 of 30 seconds: chips are as thick as each edge
/// is further out, and there is no mean.
fn growth_in_cut(k: [f64; 2], mass: f64, damping: f64, cut: &Cut, frame: &CutFrame, depth: f64) -> f64 {
    let Coefficients { ktc, krc, .. } = cut.coefficients;
    let (speed, step) = (TAU * 100.0, 1e-4);
    let (mut x, mut v) = (Vector3::new(1e-6, -0.7e-6, 0.0), Vector3::<f64>::zeros());
    let mut largest = [0.0_f64; 2];
    for at in 0..300_000_u32 {
        let moved = frame.components(&x);
        let mut force = Vector3::zeros();
        for tooth in 0..cut.mill.teeth {
            let phi = (speed * step * f64::from(at) + TAU * tooth as f64 / cut.mill.teeth as f64).rem_euclid(TAU);
            if phi >= cut.engagement.entry && phi <= cut.engagement.exit {
                let outward = Vector3::new(phi.sin(), phi.cos(), 0.0);
                let ahead = Vector3::new(phi.cos(), -phi.sin(), 0.0);
                force -= (ahead * ktc + outward * krc) * (outward.dot(&moved) * depth);
            }
        }
        let force = frame.force(&force);
        for i in 0..2 {
            let back = k[i] * x[i] + 2.0 * damping * (k[i] * mass).sqrt() * v[i];
            v[i] += (force[i] - back) / mass * step;
            x[i] += v[i] * step;
        }
        match at {
            80_000..100_000 => largest[0] = largest[0].max(x.norm()),
            280_000.. => largest[1] = largest[1].max(x.norm()),
            _ => {}
        }
    }
    largest[1] / largest[0]
}

#[test]
fn with_teeth_that_turn_it_flutters_where_their_mean_says() {
    let (k, mass, damping) = ([0.6e6, 0.8e6], 120.0, 0.02);
    let modes = plane(k[0], k[1], mass, damping);
    let mut seen = 0;
    for engagement in [
        Engagement::SLOT,
        Engagement::of_width(Direction::Up, 0.008, 0.02).unwrap(),
        Engagement::of_width(Direction::Down, 0.008, 0.02).unwrap(),
    ] {
        for angle in [0.0, 0.8, 2.1, 4.0] {
            let (cut, feed) = (cut(engagement), in_plane(angle));
            let frame = CutFrame::new(&-Vector3::z(), &feed).unwrap();
            let limits = modes.limits(&process(&cut, &frame), 0.01);
            let Some(limit) = limits.limiting().filter(|limit| !limits.is_stable(1.1 * limit)) else { continue };
            let [below, above] = [0.9, 1.1].map(|part| growth_in_cut(k, mass, damping, &cut, &frame, part * limit));
            assert!(below < 1.0 && above > 1.0, "{engagement:?} {angle} {limit}: {below} {above}");
            seen += 1;
        }
    }
    assert!(seen > 5, "{seen}");
}

/// In a full slot the tangential forces couple any two perpendicular directions
/// alike, with `N Kt b / 4`, and the radial ones stiffen both by `N Kr b / 4`:
/// they flutter where the coupling exceeds half the difference of the
/// stiffnesses, whatever the feed.
#[test]
fn a_slot_couples_with_a_quarter_of_the_teeth() {
    let (k1, k2) = (0.5e6, 0.9e6);
    let modes = plane(k1, k2, 150.0, 0.0);
    let slot = cut(Engagement::SLOT);
    let expected = 0.5 * (k2 - k1) / (0.25 * 4.0 * slot.coefficients.ktc);
    let feeds = over_feeds(|_| Some(modes.clone()), &slot, &-Vector3::z(), 12, 1e-3, 0.01).unwrap();
    assert_eq!(feeds.len(), 12);
    for feed in &feeds {
        let limit = feed.without_delay.limiting().unwrap();
        assert!((limit - expected).abs() < 1e-6 * expected, "{limit} {expected}");
    }
}

#[test]
fn the_process_is_the_change_of_the_mean_force() {
    // A displacement that is the same at every tooth: along n at each angle, by
    // summing over teeth at many angles.
    let engagement = Engagement::of_width(Direction::Down, 0.007, 0.02).unwrap();
    let cut = cut(engagement);
    let frame = CutFrame::new(&-Vector3::z(), &Vector3::new(1.0, 1.0, 0.0)).unwrap();
    let found = process(&cut, &frame);
    let Coefficients { ktc, krc, kac, .. } = cut.coefficients;
    for displacement in [Vector3::x(), Vector3::y(), Vector3::new(0.3, -0.5, 0.8)] {
        let local = frame.components(&displacement);
        let mut force = Vector3::zeros();
        let count = 200_000;
        for k in 0..count {
            let phi = TAU * (f64::from(k) + 0.5) / f64::from(count);
            if phi < engagement.entry || phi > engagement.exit {
                continue;
            }
            let outward = Vector3::new(phi.sin(), phi.cos(), 0.0);
            let ahead = Vector3::new(phi.cos(), -phi.sin(), 0.0);
            let chip = outward.dot(&local);
            force += (-ahead * ktc - outward * krc + Vector3::z() * kac) * chip * (4.0 / f64::from(count));
        }
        let expected = frame.force(&force);
        assert!((found * displacement - expected).norm() < 1e-4 * expected.norm());
    }
}

/// Two links of length `l` on springs `c`, masses on both ends and a force `P`
/// that follows the last link: `P l / c` is to this pendulum what a cutting
/// stiffness is to a tool, a stiffness along one direction from a displacement
/// along another.
fn zieglers_pendulum(masses: [f64; 2], springs: [f64; 2]) -> Limits {
    let [m1, m2] = masses;
    let [c1, c2] = springs;
    // The angles of the links for coordinates, l = 1, and rigid across.
    let mass = Matrix3::new(m1 + m2, m2, 0.0, m2, m2, 0.0, 0.0, 0.0, 1.0);
    let stiffness = Matrix2::new(c1 + c2, -c2, -c2, c2);
    let mut compliance = Matrix3::zeros();
    compliance.fixed_view_mut::<2, 2>(0, 0).copy_from(&stiffness.try_inverse().unwrap());
    let follower = Vector3::x() * (Vector3::x() - Vector3::y()).transpose();
    Modes::new(&compliance, &mass, 0.0).unwrap().limits(&follower, 20.0)
}

/// H. Ziegler, Die Stabilitaetskriterien der Elastomechanik, Ingenieur-Archiv 20
/// (1952) 49-56: with masses 2 m and m and equal springs `c` it flutters from
/// `P l / c = 7/2 - sqrt 2 = 2.086` on. At `7/2 + sqrt 2` the pair of complex
/// eigenvalues meets again, both on the negative side.
#[test]
fn zieglers_pendulum_flutters_where_he_printed_it() {
    let limits = zieglers_pendulum([2.0, 1.0], [1.0, 1.0]);
    let printed = 3.5 - f64::sqrt(2.0);
    assert!((printed - 2.086).abs() < 5e-4);
    assert!((limits.limiting().unwrap() - printed).abs() < 1e-9, "{limits:?}");
    assert_eq!(limits.unstable.len(), 1);
    assert_eq!(limits.unstable[0][1], 20.0);
}

/// O. N. Kirillov, Structural optimization of the Ziegler's pendulum
/// (arXiv:1101.0246): the load at which it begins to flutter is least where the
/// masses are to each other as the springs.
#[test]
fn zieglers_pendulum_is_weakest_with_masses_like_its_springs() {
    for ratio in [0.5, 1.0, 3.0] {
        let load = |masses: f64| zieglers_pendulum([masses, 1.0], [ratio, 1.0]).limiting().unwrap();
        let least = load(ratio);
        for factor in [0.5, 0.9, 0.99, 1.01, 1.1, 2.0] {
            assert!(load(ratio * factor) > least, "{ratio} {factor}");
        }
    }
}

#[test]
fn equal_stiffnesses_couple_at_once_and_damping_holds_them() {
    let slot = process(&cut(Engagement::SLOT), &CutFrame::new(&-Vector3::z(), &Vector3::x()).unwrap());
    assert_eq!(plane(1e6, 1e6, 100.0, 0.0).limits(&slot, 0.01).limiting(), Some(0.0));
    let damped = plane(1e6, 1e6, 100.0, 0.05).limits(&slot, 0.01).limiting().unwrap();
    let more = plane(1e6, 1e6, 100.0, 0.10).limits(&slot, 0.01).limiting().unwrap();
    assert!(damped > 1e-5 && more > damped);
    // However far beyond it is looked.
    let far = plane(1e6, 1e6, 100.0, 0.05).limits(&slot, 1e4).limiting().unwrap();
    assert!((far / damped - 1.0).abs() < 1e-6, "{far} {damped}");
    // Close to the threshold of flutter with damping: N Kt b / 4 = 2 zeta k.
    let expected = 2.0 * 0.05 * 1e6 / (0.25 * 4.0 * 767e6);
    assert!((damped / expected - 1.0).abs() < 0.05, "{damped} {expected}");
}

/// Of a displacement along the tool the force does not know: a spring there changes nothing,
/// whether it is as soft as the others or far stiffer.
#[test]
fn springs_that_nearly_agree_meet_at_the_depth_of_the_plane() {
    let spring = |k: [f64; 3]| {
        let compliance = Matrix3::from_diagonal(&Vector3::from(k.map(f64::recip)));
        Modes::new(&compliance, &(Matrix3::identity() * 100.0), 0.0).unwrap()
    };
    let down = cut(Engagement::of_width(Direction::Down, 0.008, 0.02).unwrap());
    for apart in [1e-4, 5e-4, 3e-3, 0.02] {
        for along in [1.0, 1.0 + 0.5 * apart, 1.0 + apart, 1.0 + 2.0 * apart, 1e3, 1e5] {
            for angle in [0.0, 0.7, FRAC_PI_2, 2.5] {
                let process = process(&down, &CutFrame::new(&-Vector3::z(), &in_plane(angle)).unwrap());
                let two = plane(1e6, 1e6 * (1.0 + apart), 100.0, 0.0).limits(&process, 0.02).limiting();
                let three = spring([1e6, 1e6 * (1.0 + apart), 1e6 * along]).limits(&process, 0.02).limiting();
                let (two, three) = (two.unwrap(), three.unwrap());
                assert!((three / two - 1.0).abs() < 1e-3, "{apart} {along} {angle}: {three} {two}");
            }
        }
    }
    let process = process(&down, &CutFrame::new(&-Vector3::z(), &Vector3::x()).unwrap());
    for greatest in [1e-5, 0.02] {
        assert_eq!(spring([1e6; 3]).limits(&process, greatest).limiting(), Some(0.0));
        assert_eq!(spring([1e6, 1e6, 1e9]).limits(&process, greatest).limiting(), Some(0.0));
        assert_eq!(plane(1e6, 1e6, 100.0, 0.0).limits(&process, greatest).limiting(), Some(0.0));
    }
    // One spring that pulls along its own direction makes no pair, however alike they are.
    let pull = in_plane(0.3).as_ref() * in_plane(0.3).transpose() * -1e9;
    assert_eq!(spring([1e6; 3]).limits(&pull, 0.02).unstable, Vec::<[f64; 2]>::new());
}

#[test]
fn what_does_not_yield_takes_no_part() {
    let mass = Matrix3::identity() * 100.0;
    let rigid = Modes::new(&Matrix3::zeros(), &mass, 0.0).unwrap();
    let slot = process(&cut(Engagement::SLOT), &CutFrame::new(&-Vector3::z(), &Vector3::x()).unwrap());
    assert!(rigid.frequencies().is_empty());
    assert_eq!(rigid.limits(&slot, 0.01).unstable, Vec::<[f64; 2]>::new());
    let one = Matrix3::from_diagonal(&Vector3::new(1e-6, 0.0, 0.0));
    for damping in [0.0, 0.03] {
        let one = Modes::new(&one, &mass, damping).unwrap();
        assert_eq!(one.frequencies().len(), 1);
        assert!((one.frequencies()[0] - 100.0).abs() < 1e-9);
        assert_eq!(one.limits(&slot, 0.01).limiting(), None);
    }
    for (compliance, mass, damping) in [
        (Matrix3::identity() * f64::NAN, mass, 0.0),
        (Matrix3::identity(), Matrix3::zeros(), 0.0),
        (Matrix3::identity(), mass, -0.1),
    ] {
        assert_eq!(Modes::new(&compliance, &mass, damping), None);
    }
    assert_eq!(feeds_in_plane(&Vector3::zeros(), 4), None);
}

#[test]
fn the_first_mode_has_its_measured_frequency() {
    let text = robstiff_robots::catalogue::find("kuka-kr270-r2700").unwrap();
    let robot = Generic::<6>::new(&Description::parse("kuka.yaml", text).unwrap()).unwrap();
    let q = SVector::from([0.2, -1.0, 1.4, 0.3, 0.8, 0.1]);
    let compliance = analysis::translational_compliance(&robot.compliance(&q));
    let mass = mass_of_first_mode(&compliance, 15.0).unwrap();
    let modes = Modes::new(&compliance, &mass, 0.0).unwrap();
    assert!((modes.frequencies()[0] / TAU - 15.0).abs() < 1e-9);
    assert_eq!(mass_of_first_mode(&Matrix3::zeros(), 15.0), None);
    assert_eq!(mass_of_first_mode(&compliance, 0.0), None);
}

#[test]
fn the_best_feed_is_the_one_with_the_greatest_depth() {
    let modes = plane(0.5e6, 0.9e6, 150.0, 0.02);
    let down = cut(Engagement::of_width(Direction::Down, 0.004, 0.02).unwrap());
    let feeds = over_feeds(|_| Some(modes.clone()), &down, &-Vector3::z(), 36, 1e-3, 0.02).unwrap();
    let depth = |feed: &FeedLimit| feed.limits.limiting().unwrap_or(f64::INFINITY);
    let found = best(&feeds).unwrap();
    assert!(feeds.iter().all(|feed| depth(feed) <= depth(found)));
    let worst = feeds.iter().map(depth).fold(f64::INFINITY, f64::min);
    assert!(worst < 0.8 * depth(found), "{worst} {}", depth(found));
    // The feed and its opposite meet the same springs.
    for k in 0..18 {
        assert_eq!(feeds[k].limits.unstable.len(), feeds[k + 18].limits.unstable.len());
    }
    assert_eq!(best(&[]), None);
}
