use core::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::Vector3;

use super::*;

mod file;
mod fit;

const MATERIAL: Coefficients = Coefficients { ktc: 631e6, kte: 13e3, krc: 99e6, kre: 10e3, kac: 273e6, kae: 2.8e3 };

fn cut(engagement: Engagement, helix_deg: f64, runout: &[f64]) -> Cut {
    let mill =
        EndMill { diameter: 0.016, teeth: 3, helix: helix_deg.to_radians(), corner: 0.0, runout: runout.to_vec() };
    let speed = Some(9000.0 * PI / 30.0);
    Cut { mill, coefficients: MATERIAL, engagement, depth: 0.004, feed_per_tooth: 1e-4, speed }
}

/// The force on the tool and its torque, disc by disc and tooth by tooth, from
/// where each edge is and where it goes; shares no formula with the module but
/// that of the chip.
fn summed(cut: &Cut, angle: f64, discs: usize) -> (Vector3<f64>, f64) {
    let Cut { mill, coefficients: k, engagement, depth, feed_per_tooth, .. } = cut;
    let radius = 0.5 * mill.diameter;
    let slice = depth / discs as f64;
    let out = |tooth: i64| mill.runout.get(tooth.rem_euclid(mill.teeth as i64) as usize).copied().unwrap_or(0.0);
    let (mut force, mut torque) = (Vector3::zeros(), 0.0);
    for disc in 0..discs {
        let height = (disc as f64 + 0.5) * slice;
        for tooth in 0..mill.teeth as i64 {
            let phi = angle - TAU * tooth as f64 / mill.teeth as f64 - height * mill.helix.tan() / radius;
            let outward = Vector3::new(phi.sin(), phi.cos(), 0.0);
            let ahead = Vector3::new(phi.cos(), -phi.sin(), 0.0);
            let phi = phi.rem_euclid(TAU);
            if phi < engagement.entry || phi > engagement.exit {
                continue;
            }
            let left_by = |k: i64| k as f64 * feed_per_tooth * outward.x + out(tooth) - out(tooth - k);
            let chip = (1..=mill.teeth as i64).map(left_by).fold(f64::INFINITY, f64::min);
            if chip <= 0.0 {
                continue;
            }
            let tangential = (k.ktc * chip + k.kte) * slice;
            force -= ahead * tangential + outward * ((k.krc * chip + k.kre) * slice);
            // Along the chip's way up a right-handed edge, down a left-handed one.
            force.z += (k.kac * chip + k.kae) * slice * if mill.helix < 0.0 { -1.0 } else { 1.0 };
            torque += tangential * radius;
        }
    }
    (force, torque)
}

fn engagements() -> Vec<Engagement> {
    vec![
        Engagement::SLOT,
        Engagement::of_width(Direction::Up, 0.004, 0.016).unwrap(),
        Engagement::of_width(Direction::Down, 0.004, 0.016).unwrap(),
        Engagement::between(0.7, 1.9).unwrap(),
    ]
}

#[test]
fn forces_are_the_sum_over_teeth_and_discs() {
    for engagement in engagements() {
        // The steepest goes round the tool more than once.
        for helix in [0.0, 30.0, -20.0, 79.0] {
            for runout in [&[][..], &[0.0, 12e-6, -7e-6], &[60e-6, -80e-6, 0.0]] {
                let cut = cut(engagement, helix, runout);
                for angle in [0.05, 1.3, 2.9, 4.4] {
                    let (expected, _) = summed(&cut, angle, 40_000);
                    let found = cut.force_at(angle);
                    assert!((found - expected).norm() < 0.02, "{engagement:?} {helix} {runout:?}: {found} {expected}");
                }
            }
        }
    }
}

#[test]
fn the_mean_is_that_over_a_revolution() {
    for engagement in engagements() {
        for runout in [&[][..], &[0.0, 12e-6, -7e-6], &[60e-6, -80e-6, 0.0]] {
            let cut = cut(engagement, 30.0, runout);
            let sums: Vec<_> = (0..3000).map(|k| summed(&cut, TAU * (f64::from(k) + 0.5) / 3000.0, 100)).collect();
            let force = sums.iter().map(|(force, _)| force).sum::<Vector3<f64>>() / 3000.0;
            let torque = sums.iter().map(|(_, torque)| torque).sum::<f64>() / 3000.0;
            assert!((cut.mean_force() - force).norm() < 2e-3 * force.norm(), "{} {force}", cut.mean_force());
            assert!((cut.mean_torque() - torque).abs() < 2e-3 * torque);
            assert!((cut.revolution(3000).mean() - cut.mean_force()).norm() < 1e-3 * force.norm());
        }
    }
}

/// The brackets of Altintas, Manufacturing Automation, equations of the average
/// milling forces, with their antiderivatives as printed there.
#[test]
fn the_mean_is_the_closed_form_of_altintas() {
    for engagement in engagements() {
        let cut = cut(engagement, 30.0, &[]);
        let Coefficients { ktc, kte, krc, kre, kac, kae } = MATERIAL;
        let (n, b, c) = (3.0, cut.depth, cut.feed_per_tooth);
        let bracket = |phi: f64| {
            let (sine, cosine) = phi.sin_cos();
            let (sine2, cosine2) = (2.0 * phi).sin_cos();
            Vector3::new(
                n * b * c / (8.0 * PI) * (ktc * cosine2 - krc * (2.0 * phi - sine2))
                    + n * b / (2.0 * PI) * (-kte * sine + kre * cosine),
                n * b * c / (8.0 * PI) * (ktc * (2.0 * phi - sine2) + krc * cosine2)
                    - n * b / (2.0 * PI) * (kte * cosine + kre * sine),
                n * b / (2.0 * PI) * (-kac * c * cosine + kae * phi),
            )
        };
        let expected = bracket(engagement.exit) - bracket(engagement.entry);
        assert!((cut.mean_force() - expected).norm() < 1e-12 * expected.norm(), "{engagement:?}");
    }
}

/// In a mirror across the axis a right-handed cutter that turns clockwise is a left-handed one
/// that still does, and what pulls it out pushes it in.
#[test]
fn a_left_handed_helix_pushes_the_tool_in() {
    for engagement in engagements() {
        for runout in [&[][..], &[0.0, 12e-6, -7e-6]] {
            let [right, left] = [30.0, -30.0].map(|helix| cut(engagement, helix, runout));
            let (out, into) = (right.mean_force(), left.mean_force());
            assert!(out.z > 0.0);
            assert_eq!(into, Vector3::new(out.x, out.y, -out.z));
            assert!((left.revolution(3000).mean() - into).norm() < 1e-3 * into.norm());
            assert_eq!(left.mean_torque(), right.mean_torque());
        }
    }
}

#[test]
fn a_slot_has_its_own_short_form() {
    let cut = cut(Engagement::SLOT, 30.0, &[]);
    let Coefficients { ktc, kte, krc, kre, kac, kae } = MATERIAL;
    let (nb, c) = (3.0 * cut.depth, cut.feed_per_tooth);
    let expected = Vector3::new(
        -nb * (krc * c / 4.0 + kre / PI),
        nb * (ktc * c / 4.0 + kte / PI),
        nb * (kac * c / PI + kae / 2.0),
    );
    assert!((cut.mean_force() - expected).norm() < 1e-12 * expected.norm());
}

/// Slots measured by Li Jianhui: 6000 rpm, 3 mm deep, two teeth, five feeds
/// (github.com/leekunhwee/ForceCalculation, General/Flat end milling, 2018), the
/// coefficients as printed for this cut with the author's code at
/// blog.csdn.net/2401_82386822/article/details/141181694. The measured force is
/// the mean of the first revolution (100 samples from 3 s on) of the record at
/// 900 mm/min, with the dynamometer's Fx along the normal, Fy along the feed and
/// Fz along the axis, as the code exchanges them.
#[test]
fn a_measured_slot_is_as_published() {
    let mill = EndMill { diameter: 0.025, teeth: 2, helix: PI / 4.0, corner: 0.0, runout: Vec::new() };
    let coefficients = Coefficients {
        ktc: 958.8599e6,
        kte: 15.7580e3,
        krc: 250.8633e6,
        kre: 19.4337e3,
        kac: 146.3614e6,
        kae: 18.2075e3,
    };
    let (depth, feed_per_tooth) = (0.003, 0.9 / (6000.0 * 2.0));
    let cut = Cut { mill, coefficients, engagement: Engagement::SLOT, depth, feed_per_tooth, speed: None };
    let measured = Vector3::new(-71.26, 136.98, 81.49);
    let error = cut.mean_force() - measured;
    // What the regression over five feeds leaves at this one, and the noise.
    assert!(error.norm() < 0.06 * measured.norm(), "{} {measured}", cut.mean_force());
    assert!(error.amax() < 7.0);
}

#[test]
fn up_and_down_milling_push_as_they_do_in_a_workshop() {
    let [up, down] = [Direction::Up, Direction::Down].map(|direction| {
        let engagement = Engagement::of_width(direction, 0.001, 0.016).unwrap();
        (cut(engagement, 30.0, &[]).mean_force(), engagement.wall().unwrap())
    });
    // Up milling resists the feed, down milling draws the tool along.
    assert!(up.0.x < 0.0 && down.0.x > 0.0);
    // Down milling pushes the tool off its wall. Up milling with a shallow cut
    // pushes off its wall by the radial force, against the tangential one.
    assert_eq!((up.1, down.1), (1.0, -1.0));
    assert!(down.0.y * down.1 < 0.0);
    // Both pull the tool out of its holder, alike.
    assert!(up.0.z > 0.0 && (up.0.z - down.0.z).abs() < 1e-9);
    // Mirrored, the tangential force is the same and the radial one.
    assert!((up.0.y - down.0.y).abs() > 1.0);
    assert_eq!(Engagement::SLOT.wall(), None);
    let half = Engagement::of_width(Direction::Down, 0.008, 0.016).unwrap();
    assert!((half.entry - FRAC_PI_2).abs() < 1e-12);
}

#[test]
fn power_is_that_of_the_force_along_the_edge() {
    // Without feed forces: what the spindle gives is what the chip takes.
    let cut = cut(Engagement::SLOT, 0.0, &[]);
    let chip_per_second = cut.feed_speed().unwrap() * cut.depth * cut.mill.diameter;
    let edges = MATERIAL.kte * cut.depth * 3.0 * 0.5 * cut.speed.unwrap() * 0.5 * cut.mill.diameter;
    let expected = MATERIAL.ktc * chip_per_second + edges;
    assert!((cut.power().unwrap() - expected).abs() < 1e-9 * expected);
    assert!((cut.feed_speed().unwrap() * 60.0 - 2.7).abs() < 1e-12);
}

#[test]
fn a_short_way_through_the_material_has_its_greatest_force() {
    // Between two of 72 angles, with a flute that is straight: 5 degrees of a revolution are 72 of them.
    for (from, to) in [(141.2, 144.1_f64), (0.0, 3.0), (100.2, 100.8)] {
        let way = Engagement::between(f64::to_radians(from), to.to_radians()).unwrap();
        let straight = cut(way, 0.0, &[]);
        let fine = straight.revolution(72_000).peak();
        let found = straight.extremes(72);
        assert!(fine > 0.0 && (found.peak() / fine - 1.0).abs() < 1e-3, "{} {fine}", found.peak());
        let helical = cut(way, 30.0, &[]);
        assert!(helical.extremes(72).peak() > 0.995 * helical.revolution(72_000).peak());
    }
    // Runout has pieces of its own.
    let uneven = cut(Engagement::SLOT, 0.0, &[1e-5, 0.0, -1e-5, 0.0]);
    assert!(uneven.extremes(72).peak() > 0.999 * uneven.revolution(72_000).peak());
}

#[test]
fn a_plunge_has_no_direction_but_for_rounding() {
    let axis = Vector3::new(0.3, -0.2, -0.9);
    // Rounded to a micrometre in steps of half a millimetre.
    let rounded = (axis.normalize() * 0.5).map(|length| (length * 1e3_f64).round() / 1e3);
    assert_eq!(CutFrame::new(&axis, &rounded), None);
    let ramp = axis.normalize() + Vector3::x() * 0.1;
    assert!(CutFrame::new(&axis, &ramp).is_some());
}

#[test]
fn the_frame_turns_forces_into_the_base() {
    // A spindle that points down, a feed along x: left of it is +y.
    let frame = CutFrame::new(&Vector3::new(0.0, 0.0, -2.0), &Vector3::new(3.0, 0.0, 1.0)).unwrap();
    assert!((frame.normal - Vector3::y()).norm() < 1e-15);
    let force = Vector3::new(1.0, 2.0, 3.0);
    assert!((frame.force(&force) - Vector3::new(1.0, 2.0, -3.0)).norm() < 1e-15);
    assert!((frame.components(&frame.force(&force)) - force).norm() < 1e-15);
    assert!((frame.wrench(&force).norm() - force.norm()).abs() < 1e-15);
    assert!((frame.matrix().determinant() + 1.0).abs() < 1e-12);
    for (axis, feed) in
        [(Vector3::z(), Vector3::z()), (Vector3::zeros(), Vector3::x()), (Vector3::z(), Vector3::zeros())]
    {
        assert_eq!(CutFrame::new(&axis, &feed), None);
    }
}

#[test]
fn materials_have_their_source() {
    let materials = materials();
    assert_eq!(materials.len(), 5);
    for material in &materials {
        assert!(material.source.contains("doi") && material.coefficients.ktc > 2e8, "{material:?}");
    }
    assert_eq!(materials[0].coefficients, MATERIAL);
}

/// From one sample to the next a recorded angle may be anything: turns are not counted one by one.
#[test]
fn an_angle_may_jump_by_any_number_of_turns() {
    let sample = |angle: f64| Sample { time: None, angle: Some(angle), force: Vector3::new(1.0, 2.0, 3.0) };
    let mean = |angles: &[f64]| {
        let samples = angles.iter().map(|&angle| sample(angle)).collect();
        MeasuredForce { frame: ForceFrame::Tool, samples }.mean(None)
    };
    let expected = Vector3::new(1.0, 2.0, 3.0);
    assert!((mean(&[0.0, 1e30, 0.0, 1.0]) - expected).norm() < 1e-9);
    // Twice around, with an angle that begins again.
    let twice: Vec<f64> = (0..40).map(|k| TAU * f64::from(k % 20) / 20.0).collect();
    assert!((mean(&twice) - expected).norm() < 1e-9);
}
