//! Gears that carry the arm's own weight: what they turn by, from masses, frames and the
//! laws as the textbooks write them, on generated and on generic robots.

use nalgebra::{Matrix6, SVector, Vector4, Vector6};
use robstiff::{Dual, Effect, Generic, Robot, State};
use robstiff_robots::Description;
use robstiff_tests::arms::{Preloaded, description};
use robstiff_tests::judge::trials;

const FILE: &str = "preloaded.yaml";
const POSES: usize = 60;

/// The arm with only some of its effects.
fn with(keep: impl Fn(&Effect) -> bool) -> Generic<6> {
    let mut description = description(FILE);
    description.effects.retain(keep);
    Generic::new(&description).expect("six joints")
}

fn without_preload() -> Generic<6> {
    with(|effect| !matches!(effect, Effect::GravityPreload { .. }))
}

/// What the weights put on the joints: the slope of their potential energy, downwards.
fn weights(robot: &Description, q: &SVector<f64, 6>) -> SVector<f64, 6> {
    let upright = with(|effect| !matches!(effect, Effect::GravitySag { .. }));
    let energy = |q: &SVector<f64, 6>| -> f64 {
        let heights = robot.links.iter().zip(upright.link_frames(q)).map(|(link, frame)| {
            let centre = frame * Vector4::from_fn(|k, _| link.center_of_mass.get(k).copied().unwrap_or(1.0));
            9.80665 * link.mass * centre.z
        });
        heights.sum()
    };
    let step = 1e-4;
    SVector::from_fn(|joint, _| {
        let at = |by: f64| {
            let mut q = *q;
            q[joint] += by;
            energy(&q)
        };
        (at(-step) - at(step)) / (2.0 * step)
    })
}

#[test]
fn the_preload_is_the_share_of_the_weight_that_gears_carry() {
    let robot = description(FILE);
    for (q, _) in trials::<6>(POSES, 61) {
        let expected = weights(&robot, &q) * 0.7;
        let found = Preloaded.preload(&q);
        assert!((found - expected).amax() < 1e-5, "{found} {expected}");
        assert!(found[0].abs() < 1e-12 && found[1].abs() > 0.0);
    }
}

/// `added tau / sqrt(1 + (tau / knee)^2)`.
fn hardening(added: f64, knee: f64, torque: f64) -> f64 {
    added * torque / (1.0 + (torque / knee).powi(2)).sqrt()
}

/// A play operator on all that a gear carries, through these torques one after the other.
fn play(radius: f64, torques: &[f64]) -> f64 {
    torques.iter().fold(0.0, |play: f64, torque| play.min(torque + radius).max(torque - radius))
}

/// A joint turns by `phi(tau0 + tau) - phi(tau0)`: its laws are written out here on the whole
/// torque, and what the weight alone has done is taken off.
#[test]
fn gears_turn_by_what_a_load_adds_to_the_weight() {
    let robot = description(FILE);
    let tilt = with(|effect| matches!(effect, Effect::TransverseCompliance { .. } | Effect::GravitySag { .. }));
    for (q, wrench) in trials::<6>(POSES, 62) {
        let (weight, jacobian) = (weights(&robot, &q) * 0.7, Preloaded.jacobian(&q));
        let expected = |loads: &[f64]| {
            let load = jacobian.transpose() * wrench * *loads.last().expect("a load");
            // From rest to the weight, then through the loads.
            let through = |joint: usize| -> Vec<f64> {
                let torque = (jacobian.transpose() * wrench)[joint];
                let loads = loads.iter().map(|load| weight[joint] + load * torque);
                std::iter::once(weight[joint]).chain(loads).collect()
            };
            let law = |joint: usize, of: &dyn Fn(f64) -> f64| of(weight[joint] + load[joint]) - of(weight[joint]);
            let stays = |joint: usize, radius: f64| {
                let torques = through(joint);
                play(radius, &torques) - play(radius, &torques[..1])
            };
            let arcmin = (1.0_f64 / 60.0).to_radians();
            let own = tilt.joint_compliance()[2];
            let varies = own * (0.15 * q[2].cos() - 0.08 * (2.0 * q[2]).sin()) * load[2];
            let backlash = |gap: f64, knee: f64, torque: f64| gap / 2.0 * torque / torque.hypot(knee);
            let mut turns = SVector::<f64, 6>::zeros();
            turns[1] = law(1, &|torque| hardening(1.5e-7, 900.0, torque) + backlash(0.3 * arcmin, 150.0, torque))
                + 3e-8 * stays(1, 80.0)
                + 2e-8 * stays(1, 300.0);
            turns[2] = law(2, &|torque| backlash(0.5 * arcmin, 110.0, torque)) + varies;
            turns[4] = law(4, &|torque| hardening(-4e-7, 60.0, torque)) + 3e-7 * stays(4, 12.0);
            tilt.deflection(&q, &(wrench * *loads.last().expect("a load"))) + jacobian * turns
        };
        let generic = with(|_| true);
        let (mut one, mut other) = (State::new(), State::new());
        let loads = [0.4, 1.0, 0.2, -0.7, -0.1, 0.3];
        for k in 1..=loads.len() {
            let load = wrench * loads[k - 1];
            let expected = expected(&loads[..k]);
            let found =
                [Preloaded.deflection_with(&q, &load, &mut one), generic.deflection_with(&q, &load, &mut other)];
            for found in found {
                assert!((found - expected).amax() < 2e-7 * expected.amax(), "{found} {expected}");
            }
        }
        let first = Preloaded.deflection(&q, &(wrench * loads[0]));
        assert!((first - expected(&loads[..1])).amax() < 2e-7 * first.amax());
    }
}

/// What a preload is for: it hides the backlash, and keeps a gear that hardens on its stiff
/// side. Where nothing is curved it changes nothing.
#[test]
fn a_preload_hides_backlash_and_leaves_what_is_linear() {
    let linear = |effect: &Effect| effect.row().is_none() || effect.is_linear();
    let (light, heavy) = (without_preload(), with(|_| true));
    let one =
        with(|effect| linear(effect) && !matches!(effect, Effect::GravityPreload { .. } | Effect::Hysteresis { .. }));
    let other = with(|effect| linear(effect) && !matches!(effect, Effect::Hysteresis { .. }));
    for (q, wrench) in trials::<6>(POSES, 63) {
        assert_eq!(one.deflection(&q, &wrench), other.deflection(&q, &wrench));
        assert_eq!(one.compliance(&q), other.compliance(&q));
        // Joint 2 alone, by its work on a wrench: stretched out it carries some 5 kNm.
        let stretched = SVector::from([q[0], 0.0, 0.0, q[3], 0.0, q[5]]);
        let (column, compliances) = (
            heavy.jacobian(&stretched).column(1).into_owned(),
            [heavy.compliance(&stretched), light.compliance(&stretched)],
        );
        let wrench = column / column.norm_squared();
        let [heavy, light] = compliances.map(|compliance| wrench.dot(&(compliance * wrench)));
        let (added, gap) = (1.5e-7, 0.3 / 60.0 * std::f64::consts::PI / 180.0);
        assert!(light - heavy > 0.9 * (added + gap / 300.0), "{light} {heavy}");
    }
}

/// The tangent of what a small load does; play operators rest at the edge of their radius,
/// where a small load either moves them or does not, so not with hysteresis.
#[test]
fn the_compliance_is_the_slope_under_the_weight() {
    let smooth = with(|effect| !matches!(effect, Effect::Hysteresis { .. }));
    for (q, wrench) in trials::<6>(POSES, 64) {
        let slopes = smooth.deflection(&q.map(Dual::<f64, 6>::constant), &Dual::variables(Vector6::repeat(0.0)));
        let slopes = Matrix6::from_fn(|i, j| slopes[i].slopes[j]);
        let compliance = smooth.compliance(&q);
        assert!((slopes - compliance).amax() < 1e-12 * compliance.amax());
        assert!((Preloaded.compliance(&q) - compliance).amax() < 1e-13 * compliance.amax());
        let small = wrench * 1e-6;
        let difference = (smooth.deflection(&q, &small) - smooth.deflection(&q, &-small)) * 0.5;
        assert!((difference - compliance * small).amax() < 1e-7 * difference.amax());
    }
}
