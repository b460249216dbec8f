//! How joints give way under their torques, and what they remember of earlier
//! ones.

use super::encoders::{MOST_JOINTS, Turns};

/// A joint's deflection beyond its plain compliance.
#[derive(Clone, Copy, Debug)]
pub(super) enum Gear {
    /// `added tau / sqrt(1 + (tau / knee)^2)`.
    Softening { added: f64, knee: f64 },
    /// Half the gap to the side the torque pushes: `gap / 2 tau / |(tau, knee)|`.
    LostMotion { gap: f64, knee: f64 },
    /// A slider that sticks until the spring before it carries `radius`:
    /// `weight P`, `P = max(tau - radius, min(tau + radius, P before))`.
    Play { weight: f64, radius: f64 },
    /// A spring and a dashpot side by side (Kelvin, Voigt), in line with the
    /// gear: comes to `compliance tau` with a time constant (s).
    Lag { compliance: f64, constant: f64 },
    /// The controller's, which holds the motor like a spring of this compliance.
    Droop { compliance: f64 },
    /// `added` more under a torque above zero than below.
    OneSided { added: f64 },
    /// Compliance per kelvin above the temperature of the beginning.
    Warming { per_kelvin: f64 },
}

/// When a load is read, seen from the load before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moment {
    /// How long this load has been on (s).
    pub held: f64,
    /// How much warmer the arm is than at the beginning (K).
    pub warmer: f64,
}

/// What the joints remember of the loads so far: where sliders and dashpots
/// stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Memory(Vec<f64>);

/// Deflection of the joints about their own axes under their torques.
#[derive(Clone, Debug)]
pub(super) struct JointLaw {
    compliances: Vec<f64>,
    /// Two joints and the entry of the compliance matrix they share.
    pub couplings: Vec<(usize, usize, f64)>,
    /// What a joint, from 0, has besides.
    pub gears: Vec<(usize, Gear)>,
}

impl JointLaw {
    pub fn new(compliances: Vec<f64>) -> Self {
        Self { compliances, couplings: Vec::new(), gears: Vec::new() }
    }

    pub fn joints(&self) -> usize {
        self.compliances.len()
    }

    /// The memory of joints that have never been loaded.
    pub fn fresh(&self) -> Memory {
        Memory(vec![0.0; self.gears.len()])
    }

    /// Joint deflections (rad or m) under the torques (Nm or N), after what
    /// `memory` has seen.
    pub fn deflections(&self, torques: &[f64], memory: &Memory, moment: Moment, out: &mut [f64]) {
        for ((out, torque), compliance) in out.iter_mut().zip(torques).zip(&self.compliances) {
            *out = compliance * torque;
        }
        for &(one, other, value) in &self.couplings {
            out[one] += value * torques[other];
            out[other] += value * torques[one];
        }
        for (&(joint, gear), &kept) in self.gears.iter().zip(&memory.0) {
            let torque = torques[joint];
            out[joint] += match gear {
                Gear::Softening { added, knee } => added * torque / 1_f64.hypot(torque / knee),
                Gear::LostMotion { gap, knee } => 0.5 * gap * torque / torque.hypot(knee),
                Gear::Play { weight, .. } => weight * gear.state(torque, kept, moment),
                Gear::Lag { .. } => gear.state(torque, kept, moment),
                Gear::Droop { compliance } => compliance * torque,
                Gear::OneSided { added } => added * torque.max(0.0),
                Gear::Warming { per_kelvin } => per_kelvin * moment.warmer * torque,
            };
        }
    }

    /// What of the deflections is the motors', and not behind them (rad or m).
    pub fn of_motors(&self, torques: &[f64]) -> Turns {
        let mut turns = [0.0; MOST_JOINTS];
        for &(joint, gear) in &self.gears {
            if let Gear::Droop { compliance } = gear {
                turns[joint] += compliance * torques[joint];
            }
        }
        turns
    }

    /// Takes note of the torques that the joints have come to.
    pub fn remember(&self, torques: &[f64], memory: &mut Memory, moment: Moment) {
        for (&(joint, gear), kept) in self.gears.iter().zip(&mut memory.0) {
            *kept = gear.state(torques[joint], *kept, moment);
        }
    }

    /// The integral of the deflections over the torques (J); gears with a
    /// memory give none back.
    pub fn complementary_energy(&self, torques: &[f64]) -> f64 {
        let straight: f64 = self.compliances.iter().zip(torques).map(|(h, torque)| 0.5 * h * torque * torque).sum();
        let coupled: f64 = self.couplings.iter().map(|&(i, j, value)| value * torques[i] * torques[j]).sum();
        let of_gear = |&(joint, gear): &(usize, Gear)| match gear {
            Gear::Softening { added, knee } => added * knee * knee * (1_f64.hypot(torques[joint] / knee) - 1.0),
            Gear::LostMotion { gap, knee } => 0.5 * gap * (torques[joint].hypot(knee) - knee),
            Gear::Droop { compliance } => 0.5 * compliance * torques[joint] * torques[joint],
            Gear::OneSided { added } => 0.5 * added * torques[joint].max(0.0).powi(2),
            Gear::Play { .. } | Gear::Lag { .. } | Gear::Warming { .. } => 0.0,
        };
        straight + coupled + self.gears.iter().map(of_gear).sum::<f64>()
    }
}

impl Gear {
    /// Where a slider or dashpot stands under a torque, after it stood at
    /// `kept`.
    fn state(&self, torque: f64, kept: f64, moment: Moment) -> f64 {
        match *self {
            Self::Play { radius, .. } => kept.clamp(torque - radius, torque + radius),
            Self::Lag { compliance, constant } => {
                let end = compliance * torque;
                end + (kept - end) * (-moment.held / constant).exp()
            }
            Self::Softening { .. }
            | Self::LostMotion { .. }
            | Self::Droop { .. }
            | Self::OneSided { .. }
            | Self::Warming { .. } => kept,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(gear: Gear) -> JointLaw {
        JointLaw { gears: vec![(0, gear)], ..JointLaw::new(vec![0.0]) }
    }

    /// Deflections along a path of torques.
    fn along(gear: Gear, path: &[f64], held: f64) -> Vec<f64> {
        let law = law(gear);
        let mut memory = law.fresh();
        let moment = Moment { held, warmer: 2.0 };
        let step = |&torque: &f64| {
            let mut out = [0.0];
            law.deflections(&[torque], &memory, moment, &mut out);
            law.remember(&[torque], &mut memory, moment);
            out[0]
        };
        path.iter().map(step).collect()
    }

    #[test]
    fn flanks_that_differ_give_way_otherwise_one_way() {
        let gear = Gear::OneSided { added: 0.5 };
        assert_eq!(along(gear, &[64.0, -64.0, 128.0], 0.0), [32.0, 0.0, 64.0]);
        assert_eq!([64.0, -64.0].map(|torque| law(gear).complementary_energy(&[torque])), [1024.0, 0.0]);
    }

    #[test]
    fn a_play_makes_a_parallelogram() {
        let play = Gear::Play { weight: 2e-7, radius: 30.0 };
        let path = [20.0, 100.0, 70.0, 40.0, 0.0, -100.0, 0.0, 100.0];
        let expected = [0.0, 70.0, 70.0, 70.0, 30.0, -70.0, -30.0, 70.0];
        for (found, expected) in along(play, &path, 0.0).iter().zip(expected) {
            assert!((found - 2e-7 * expected).abs() < 1e-20);
        }
        // The loop between +-100: twice the radius wide, its sides 2 * 70 high.
        let steps = 4000;
        let at = |k: usize| 100.0 * (std::f64::consts::TAU * k as f64 / steps as f64).cos();
        let torques: Vec<f64> = (0..=2 * steps).map(at).collect();
        let moved = along(play, &torques, 0.0);
        let last = steps..2 * steps;
        let area: f64 = last.map(|k| 0.5 * (torques[k] + torques[k + 1]) * (moved[k + 1] - moved[k])).sum();
        assert!((area / (4.0 * 30.0 * 70.0 * 2e-7) - 1.0).abs() < 1e-3, "{area}");
    }

    #[test]
    fn lost_motion_is_half_the_gap_to_either_side() {
        let gap = Gear::LostMotion { gap: 3e-4, knee: 5.0 };
        let [small, ahead, behind] = along(gap, &[1e-3, 1e4, -1e4], 0.0)[..] else { unreachable!() };
        assert!((small - 3e-4 / 2.0 / 5.0 * 1e-3).abs() < 1e-7 * small);
        assert!((ahead - 1.5e-4).abs() < 1e-10 && ahead == -behind);
        // Energy: the derivative of its complement is the deflection.
        let energy = |torque: f64| law(gap).complementary_energy(&[torque]);
        let slope = (energy(7.0 + 1e-4) - energy(7.0 - 1e-4)) / 2e-4;
        assert!((slope - along(gap, &[7.0], 0.0)[0]).abs() < 1e-9 * slope);
    }

    #[test]
    fn a_dashpot_lags_and_arrives() {
        let lag = Gear::Lag { compliance: 1e-7, constant: 60.0 };
        let moved = along(lag, &[100.0; 20], 30.0);
        let expected = |k: usize| 1e-5 * (1.0 - (-0.5 * (k + 1) as f64).exp());
        assert!(moved.iter().enumerate().all(|(k, found)| (found - expected(k)).abs() < 1e-18));
        assert!((along(lag, &[100.0], 1e9)[0] - 1e-5).abs() < 1e-18);
        assert_eq!(along(lag, &[100.0], 0.0), [0.0]);
    }

    #[test]
    fn warmth_softens_in_proportion() {
        assert_eq!(along(Gear::Warming { per_kelvin: 1e-8 }, &[100.0], 0.0), [2e-6]);
    }
}
