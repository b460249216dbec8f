//! Correcting the joint targets while cutting, simulated: what control speed
//! leaves of the deviation.
//!
//! Each control step reads the force, or the encoders on the output side of the
//! gears, and shifts the joint targets so that the tool moves back, within limits
//! of size and rate; the correction reaches the position loops after a delay, and
//! these follow it with their bandwidth. With a reading that is true, no limit
//! reached and a sine of angular frequency `w` as load, what is left of the
//! deviation has the size
//!
//! `|1 - G(i w) exp(-i w T) sin(w s / 2) / (w s / 2) exp(-i w s / 2)|`,
//!
//! where `G` is the position loop, `T` the delay and `s` the control step, for
//! which a correction is held. The force is taken to follow from the cut alone,
//! not from where the correction puts the tool.

mod controller;
mod effort;
mod loops;
#[cfg(test)]
mod tests;
mod timeline;

use core::f64::consts::TAU;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector6};

pub use controller::{Controller, Limits, Sensing, Servo};
pub use effort::Effort;
use loops::Loops;
use robstiff::elements::joint_turns;
use robstiff::{Robot, State};
pub use timeline::{NoFeed, Timeline};

/// The tool at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// The time (s).
    pub time: f64,
    /// Whether something pushes the tool then: not on the way to the cut.
    pub in_cut: bool,
    /// The displacement of the TCP without correction, in the base frame (m).
    pub uncorrected: Vector3<f64>,
    /// The displacement with it (m).
    pub corrected: Vector3<f64>,
    /// Whether a limit held back the correction of the control step.
    pub held_back: HeldBack<bool>,
}

/// What of the [`Limits`] holds a correction back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HeldBack<T> {
    /// That of its size.
    pub by_size: T,
    /// That of its speed.
    pub by_rate: T,
}

impl HeldBack<f64> {
    /// In which part of the time each limit holds back; not a number of no time.
    pub fn share<'i>(instants: impl Iterator<Item = &'i Instant>) -> Self {
        let (mut size, mut rate, mut all) = (0.0, 0.0, 0.0);
        for Instant { held_back, .. } in instants {
            size += f64::from(u8::from(held_back.by_size));
            rate += f64::from(u8::from(held_back.by_rate));
            all += 1.0;
        }
        Self { by_size: size / all, by_rate: rate / all }
    }
}

/// What a correction leaves of the deviation under a sine, as fractions of the
/// deviation without correction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeftOfSine {
    /// Of its amplitude at the load's own frequency.
    pub amplitude: f64,
    /// Of its root mean square, noise and steps included.
    pub rms: f64,
    /// In which part of the time a limit holds the correction back.
    pub held_back: HeldBack<f64>,
}

/// Simulates for a `duration` (s) at joint coordinates `q`. `truth` is the robot,
/// `model` what the controller takes it for; `load` is the wrench at the TCP in
/// the base frame (N, Nm) at a time (s), `reading` what the sensor makes of it,
/// or nothing where it is silent; with hysteresis the model follows what was read,
/// from a robot that was never loaded on. With encoders only whether there is a reading
/// counts, and the wrench it gives is that which turns the gears.
///
/// # Panics
/// If the step is not above zero, or the delay or a limit of size or rate is negative or not a number.
pub fn simulate<const N: usize>(
    (truth, model): (&impl Robot<N>, &impl Robot<N>),
    q: &SVector<f64, N>,
    controller: &Controller,
    duration: f64,
    load: impl Fn(f64) -> Vector6<f64>,
    reading: impl FnMut(f64, &Vector6<f64>) -> Option<Vector6<f64>>,
) -> Vec<Instant> {
    simulate_moving((truth, model), |_| *q, controller, Effort::at_pose(controller, duration), load, reading)
}

/// The same while the arm moves as the [`Timeline`] says, from its begin to its
/// end and under its load. The controller knows where the joints are to be.
///
/// # Panics
/// As [`simulate`].
pub fn simulate_along<const N: usize>(
    robots: (&impl Robot<N>, &impl Robot<N>),
    timeline: &Timeline<N>,
    controller: &Controller,
    reading: impl FnMut(f64, &Vector6<f64>) -> Option<Vector6<f64>>,
) -> Vec<Instant> {
    let (posture, load) = (|time: f64| timeline.posture(time), |time: f64| timeline.wrench(time));
    simulate_moving(robots, posture, controller, Effort::along(controller, timeline.duration()), load, reading)
}

fn simulate_moving<const N: usize>(
    (truth, model): (&impl Robot<N>, &impl Robot<N>),
    posture: impl Fn(f64) -> SVector<f64, N>,
    controller: &Controller,
    Effort { duration, step, points }: Effort,
    load: impl Fn(f64) -> Vector6<f64>,
    mut reading: impl FnMut(f64, &Vector6<f64>) -> Option<Vector6<f64>>,
) -> Vec<Instant> {
    let delay = controller.delay;
    assert!(step > 0.0 && delay >= 0.0, "a control step takes time, and no correction is early");
    let Limits { size, rate, .. } = controller.limits;
    assert!(size >= 0.0 && rate >= 0.0, "a limit is not negative");
    let (mut wanted, mut silent) = (Correction::new(controller), 0.0);
    let mut loops = Loops::new(controller.servo, step / points as f64);
    let mut seen = Vec::new();
    // What the robot remembers of its loads, and what the controller thinks it does.
    let (mut state, mut known) = (State::new(), State::new());
    let mut jacobian: Option<(SVector<f64, N>, SMatrix<f64, 3, N>)> = None;
    for k in 0..(duration / step).ceil() as usize {
        let start = k as f64 * step;
        let read = reading(start, &load(start));
        silent = if read.is_some() { 0.0 } else { silent + step };
        let q = posture(start);
        let asked = match (read, controller.sensing) {
            (Some(wrench), Sensing::Force) => Some(back(model, &q, &wrench, controller.damping, &mut known)),
            (Some(wrench), Sensing::Encoders) => Some(-joint_turns(truth, &q, &wrench, &state)),
            (None, _) => (silent > controller.limits.hold).then(SVector::zeros),
        };
        let (sent, held_back) = wanted.step(asked);
        loops.send(start + delay, sent);
        for point in 1..=points {
            // In the middle of each part, so that a value that is held is seen as late as it is.
            let time = start + step * (point as f64 - 0.5) / points as f64;
            let corrections = loops.at(time);
            let q = posture(time);
            if jacobian.is_none_or(|(at, _)| at != q) {
                jacobian = Some((q, truth.jacobian(&q).fixed_rows::<3>(0).into_owned()));
            }
            let wrench = load(time);
            let uncorrected = truth.deflection_with(&q, &wrench, &mut state).fixed_rows::<3>(0).into_owned();
            let moved = jacobian.map_or_else(Vector3::zeros, |(_, jacobian)| jacobian * corrections);
            let in_cut = wrench != Vector6::zeros();
            seen.push(Instant { time, in_cut, uncorrected, corrected: uncorrected + moved, held_back });
        }
    }
    seen
}

/// What is left under a load that is `wrench` (N, Nm) times a sine of a
/// `frequency` (Hz), in two to ten periods after what comes first has died down.
///
/// Where the load does not move the tool nothing can be left of it, and both fractions are NaN.
///
/// # Panics
/// If the frequency is not above zero, and as [`simulate`].
pub fn left_of_sine<const N: usize>(
    robots: (&impl Robot<N>, &impl Robot<N>),
    q: &SVector<f64, N>,
    controller: &Controller,
    (wrench, frequency): (&Vector6<f64>, f64),
    reading: impl FnMut(f64, &Vector6<f64>) -> Option<Vector6<f64>>,
) -> LeftOfSine {
    assert!(frequency > 0.0, "a sine has a frequency above zero");
    let load = |time: f64| wrench * (TAU * frequency * time).sin();
    let effort = Effort::of_sine(controller, frequency);
    let looked_at = effort.duration - effort::looked_at(frequency)..=effort.duration;
    let seen = simulate_moving(robots, |_| *q, controller, effort, load, reading);
    let seen: Vec<_> = seen.iter().filter(|instant| looked_at.contains(&instant.time)).collect();
    let amplitude = |of: fn(&Instant) -> Vector3<f64>| {
        let part = |wave: fn(f64) -> f64| -> Vector3<f64> {
            seen.iter().map(|instant| of(instant) * wave(TAU * frequency * instant.time)).sum()
        };
        part(f64::sin).norm().hypot(part(f64::cos).norm())
    };
    let square = |of: fn(&Instant) -> Vector3<f64>| seen.iter().map(|instant| of(instant).norm_squared()).sum::<f64>();
    LeftOfSine {
        amplitude: amplitude(|seen| seen.corrected) / amplitude(|seen| seen.uncorrected),
        rms: (square(|seen| seen.corrected) / square(|seen| seen.uncorrected)).sqrt(),
        held_back: HeldBack::share(seen.iter().copied()),
    }
}

/// The correction as limits let it be.
struct Correction<const N: usize> {
    now: SVector<f64, N>,
    size: f64,
    step: f64,
}

impl<const N: usize> Correction<N> {
    fn new(controller: &Controller) -> Self {
        let Limits { size, rate, .. } = controller.limits;
        Self { now: SVector::zeros(), size, step: rate * controller.step }
    }

    /// One control step towards what is asked for; nothing holds it.
    fn step(&mut self, asked: Option<SVector<f64, N>>) -> (SVector<f64, N>, HeldBack<bool>) {
        let mut held_back = HeldBack::default();
        if let Some(asked) = asked {
            let change = asked.map(|x| x.clamp(-self.size, self.size)) - self.now;
            self.now += change.map(|x| x.clamp(-self.step, self.step));
            held_back = HeldBack { by_size: asked.amax() > self.size, by_rate: change.amax() > self.step };
        }
        (self.now, held_back)
    }
}

/// The correction that takes the TCP back, by damped least squares on the rows
/// of the Jacobian that move it: `J^T (J J^T + damping)^-1 (-d)`. The wrench joins
/// the loads in `known`.
fn back<const N: usize>(
    model: &impl Robot<N>,
    q: &SVector<f64, N>,
    wrench: &Vector6<f64>,
    damping: f64,
    known: &mut State<N>,
) -> SVector<f64, N> {
    let moves: SMatrix<f64, 3, N> = model.jacobian(q).fixed_rows::<3>(0).into_owned();
    let displacement = model.deflection_with(q, wrench, known).fixed_rows::<3>(0).into_owned();
    let square = moves * moves.transpose() + Matrix3::identity() * damping;
    square.cholesky().map_or_else(SVector::zeros, |factor| moves.transpose() * factor.solve(&-displacement))
}
