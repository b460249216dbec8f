//! Stability lobes: known depths, and what has none.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::{Matrix3, SVector, Vector3};
use robstiff_robots::Description;

use super::tests::cut;
use super::*;
use crate::milling::{Cut, CutFrame, Direction, Engagement};
use robstiff::generic::Generic;
use robstiff::{Robot, analysis};

fn roughing() -> Cut {
    cut(Engagement::of_width(Direction::Down, 0.008, 0.02).unwrap())
}

/// The KR 270 at the pose of the command's page with a first mode of 15 Hz and a damping ratio of
/// 0.02, and its spindle.
fn kuka() -> (Modes, Vector3<f64>) {
    let text = robstiff_robots::catalogue::find("kuka-kr270-r2700").unwrap();
    let robot = Generic::<6>::new(&Description::parse("kuka.yaml", text).unwrap()).unwrap();
    let q = SVector::from([0.0, -FRAC_PI_2, FRAC_PI_2, 0.0, PI / 3.0, 0.0]);
    let compliance = analysis::translational_compliance(&robot.compliance(&q));
    let mass = mass_of_first_mode(&compliance, 15.0).unwrap();
    let axis = robot.transform(&q).fixed_view::<3, 3>(0, 0) * Vector3::z();
    (Modes::new(&compliance, &mass, 0.02).unwrap(), axis)
}

/// One spring of 1e6 N/m along x with 100 kg, Omega = 100 rad/s.
fn one(damping: f64) -> Modes {
    let compliance = Matrix3::from_diagonal(&Vector3::new(1e-6, 0.0, 0.0));
    Modes::new(&compliance, &(Matrix3::identity() * 100.0), damping).unwrap()
}

/// A force along x that changes by so much with the displacement along x, per depth (N/m^2).
fn along(change: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(change, 0.0, 0.0))
}

/// Computed by others with numpy, by determinant and by simulation; to the digits that they gave.
#[test]
fn depths_are_those_of_an_independent_computation() {
    let (modes, axis) = kuka();
    let roughing = roughing();
    for (quarter, rpm, millimetres) in [
        (1, Some(9000.0), 1.92),
        (2, Some(9000.0), 5.98),
        (1, Some(3000.0), 0.68),
        (1, Some(18000.0), 3.79),
        (1, None, 4.37),
        (2, None, 0.277),
    ] {
        let feed = feeds_in_plane(&axis, 4).unwrap()[quarter].1;
        let process = process(&roughing, &CutFrame::new(&axis, &feed).unwrap());
        let limits = match rpm {
            Some(rpm) => Lobes::new(&modes, &process, 0.02).unwrap().limits(60.0 / (4.0 * rpm)),
            None => modes.limits(&process, 0.02),
        };
        let limit = 1e3 * limits.limiting().unwrap();
        assert!((limit / millimetres - 1.0).abs() < 3e-3, "{limit} {millimetres}");
    }
}

/// `2 zeta (1 + zeta) k / p` where the force opposes the displacement, `2 zeta (1 - zeta) k / p`
/// where it goes with it, at the speeds at which the lobes are deepest.
#[test]
fn one_mode_is_limited_by_its_damping() {
    for zeta in [0.003, 0.02, 0.2] {
        for sign in [-1.0, 1.0] {
            let lobes = Lobes::new(&one(zeta), &along(sign * 1e9), 1.0).unwrap();
            let least = 2.0 * zeta * (1.0 - sign * zeta) * 1e6 / 1e9;
            let found = lobes.at_any_speed().unwrap();
            assert!((found / least - 1.0).abs() < 1e-9, "{zeta} {found} {least}");
            // There the real part of the response is greatest.
            let frequency = 100.0 * (1.0 - sign * 2.0 * zeta).sqrt();
            let response = nalgebra::Complex::new(1e4 - frequency * frequency, 200.0 * zeta * frequency).inv() * sign;
            for waves in 0..20 {
                let period = (PI + 2.0 * response.arg() + TAU * f64::from(waves)) / frequency;
                let limit = lobes.limits(period).limiting().unwrap();
                assert!((limit / least - 1.0).abs() < 1e-9, "{zeta} {waves}: {limit} {least}");
                let beside = lobes.limits(period * 1.01).limiting().unwrap();
                assert!(beside > least, "{zeta} {waves}: {beside} {least}");
            }
        }
    }
}

/// Without damping the root of a mode moves by `i a p (1 - exp(-i W T)) / (2 W)`: it grows at
/// once, or it is held until another wave fits between the teeth, where `1 - exp(-i w T)` is 2.
#[test]
fn without_damping_a_mode_grows_at_once_or_at_the_next_wave() {
    for sign in [-1.0, 1.0] {
        let lobes = Lobes::new(&one(0.0), &along(sign * 1e9), 1.0).unwrap();
        assert_eq!(lobes.at_any_speed(), Some(0.0));
        for turned in [0.1, 1.0, 2.0, 3.0, 3.3, 4.0, 5.0, 6.2, 7.0, 10.0, 40.0] {
            let period = turned / 100.0;
            let found = lobes.limits(period).limiting();
            if sign * f64::sin(turned) > 0.0 {
                assert_eq!(found, Some(0.0), "{sign} {turned}");
                continue;
            }
            // Half a wave beyond whole ones, from the mode on in the direction in which the
            // force draws its frequency.
            let wave = PI / period;
            let waves = (100.0 / wave - 1.0) / 2.0;
            let odd = 2.0 * if sign < 0.0 { waves.ceil() } else { waves.floor() } + 1.0;
            let depth = (1e4 - (odd * wave).powi(2)) * sign * 100.0 / 2e9;
            let expected = Some(depth).filter(|depth| *depth < 1.0);
            match (found, expected) {
                (Some(found), Some(depth)) => assert!((found / depth - 1.0).abs() < 1e-5, "{turned} {found} {depth}"),
                _ => assert_eq!(found, expected, "{sign} {turned}"),
            }
        }
    }
}

#[test]
fn what_cannot_chatter_has_no_limit() {
    let (modes, axis) = kuka();
    let process = process(&roughing(), &CutFrame::new(&axis, &Vector3::y()).unwrap());
    let none = Vec::<[f64; 2]>::new();
    // The tooth before was here just now.
    let lobes = Lobes::new(&modes, &process, 0.02).unwrap();
    assert_eq!(lobes.limits(1e-7).unstable, none);
    for (modes, process) in [
        (modes.clone(), Matrix3::zeros()),
        (Modes::new(&Matrix3::zeros(), &Matrix3::identity(), 0.02).unwrap(), process),
        (one(0.02), along(0.0)),
        // Deeper than anything that is looked at.
        (one(0.02), along(1e-3)),
    ] {
        let lobes = Lobes::new(&modes, &process, 0.02).unwrap();
        assert_eq!(lobes.at_any_speed(), None);
        for period in [1e-3, 0.1, 1e6, 0.0, f64::NAN] {
            assert_eq!(lobes.limits(period).unstable, none);
        }
    }
    for process in [Matrix3::identity() * 1e9, process * f64::NAN] {
        assert_eq!(Lobes::new(&modes, &process, 0.02), None);
    }
    // What overflows ends, and so does what is looked at without end.
    assert_eq!(Lobes::new(&modes, &(process * 1e200), 0.02), None);
    let far = Lobes::new(&modes, &process, 1e300).unwrap();
    let least = far.at_any_speed().unwrap();
    assert_eq!(far.limits(1e-3).unstable, [[least, 1e300]]);
    for greatest in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(Lobes::new(&modes, &process, greatest), None);
    }
}

#[test]
fn slow_teeth_come_to_the_depth_of_any_speed() {
    let (modes, axis) = kuka();
    for (_, feed) in feeds_in_plane(&axis, 24).unwrap() {
        let process = process(&roughing(), &CutFrame::new(&axis, &feed).unwrap());
        let lobes = Lobes::new(&modes, &process, 0.02).unwrap();
        let least = lobes.at_any_speed().unwrap();
        for k in 0..60 {
            let limit = lobes.limits(1e-3 * 1.2_f64.powi(k)).limiting().unwrap_or(0.02);
            assert!(limit >= least * (1.0 - 1e-9), "{k}: {limit} {least}");
            // With many waves between two teeth the deepest lobe is close to any speed.
            let waves = 15.0 * 1e-3 * 1.2_f64.powi(k);
            assert!(waves < 200.0 || limit < 1.02 * least, "{k}: {limit} {least}");
        }
        // The greatest depth has no part in what is below.
        let far = Lobes::new(&modes, &process, 5.0).unwrap();
        for period in [1e-3, 1.0 / 600.0, 0.02, 0.3] {
            let [near, far] = [&lobes, &far].map(|lobes| lobes.limits(period));
            match near.limiting() {
                Some(limit) => assert!((far.limiting().unwrap() / limit - 1.0).abs() < 1e-9, "{near:?} {far:?}"),
                None => assert!(far.limiting().is_none_or(|limit| limit >= 0.02), "{far:?}"),
            }
        }
    }
}

/// `x = a c p (x - x(t - T))` alone grows from `a c p = 1/2` on, however soon the teeth come.
#[test]
fn what_has_no_mass_follows_at_once_up_to_a_half() {
    let mut modes = one(0.02);
    modes.massless = Matrix3::from_diagonal(&Vector3::new(0.0, 1e-7, 0.0));
    modes.compliance += modes.massless;
    for (change, expected) in [(1e9, Some(5e-3)), (-1e9, None)] {
        let process = Matrix3::from_diagonal(&Vector3::new(0.0, change, 0.0));
        let lobes = Lobes::new(&modes, &process, 0.02).unwrap();
        for period in [1e-5, 1e-3, 0.1] {
            let found = lobes.limits(period);
            let ranges: Vec<[f64; 2]> = expected.map(|from| [from, 0.02]).into_iter().collect();
            assert_eq!(found.unstable.len(), ranges.len(), "{period} {found:?}");
            for (one, other) in found.unstable.iter().flatten().zip(ranges.iter().flatten()) {
                assert!((one / other - 1.0).abs() < 1e-9, "{period} {found:?}");
            }
        }
        assert_eq!(lobes.at_any_speed().is_some(), expected.is_some());
    }
}
