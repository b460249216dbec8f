//! The laws of joints from the catalogue, on numbers.

use core::ops::{Add, Mul, Neg, Sub};

use nalgebra::{Matrix4, SVector, Vector6};
use robstiff_robots::effect::physics::{Joint, PLAYS};
use robstiff_robots::effect::{MOST_PARAMETERS, Scalar, Tangent, gravity_sag};

use crate::{Effect, JointKind, Real, Robot, State};

/// What a load puts on the gear of a joint, which carries something before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torque<T = f64> {
    /// What the arm's own weight puts on it, [`Robot::preload`] (Nm).
    pub preload: T,
    /// What the load adds (Nm).
    pub load: T,
}

impl<T: Real> Torque<T> {
    /// Of a load on a gear that carries nothing before (Nm).
    pub fn of(load: T) -> Self {
        Self { preload: T::zero(), load }
    }

    /// Both together (Nm).
    pub fn whole(self) -> T {
        self.preload + self.load
    }
}

/// By how much a joint turns more (rad) under a load than by its own compliance `own`
/// (rad/Nm), where the effect has a part in the joint's law: at the coordinate `q` (rad),
/// with its play operators `plays` (Nm) after this load, counted from where they rest
/// under the preload.
pub fn turn<T: Real>(effect: &Effect, own: T, q: T, torque: Torque<T>, plays: [T; PLAYS]) -> Option<T> {
    let joint = Joint {
        compliance: Number(own),
        torque: Number(torque.load),
        plays: plays.map(Number),
        harmonic: &harmonic(q),
    };
    let (numbers, count) = numbers(effect);
    effect.turn_beyond(&numbers[..count], Number(torque.preload), &joint).map(|turn| turn.0)
}

/// The slope of [`turn`] against the torque (rad/Nm) at all that the gear carries (Nm),
/// [`Torque::whole`]: how a joint yields to small changes about it. Its play operators stay
/// where they are, for a small change turns back within their radii.
pub fn turn_about<T: Real>(effect: &Effect, own: T, q: T, torque: T) -> Option<T> {
    let (numbers, count) = numbers(effect);
    effect.slope(&numbers[..count], Number(own), Number(torque), &harmonic(q)).map(|turn| turn.0)
}

/// The play operators (Nm) of a joint after a load that follows the state `before`, both
/// counted from where they rest under the preload.
pub fn plays<T: Real>(effect: &Effect, torque: Torque<T>, before: [T; PLAYS]) -> [T; PLAYS] {
    let (numbers, count) = numbers(effect);
    let (preload, load) = (Number(torque.preload), Number(torque.load));
    let after = effect.plays_beyond(&numbers[..count], preload, load, before.map(Number));
    let in_use = effect.plays_in_use();
    core::array::from_fn(|k| if k < in_use { after[k].0 } else { before[k] })
}

/// By how much the joints turn [rad or m] under a wrench `[f; m]` at the TCP in the
/// base frame (N, Nm) that follows the loads in `before`: what encoders on both
/// sides of the gears see between them, and nothing of bearings, links, the base and
/// the tool.
pub fn joint_turns<const N: usize, R: Robot<N>>(
    robot: &R,
    q: &SVector<f64, N>,
    wrench: &Vector6<f64>,
    before: &State<N>,
) -> SVector<f64, N> {
    turns_under(robot, q, &robot.joint_torques(q, wrench), before)
}

/// The same under torques of the joints (Nm or N).
pub fn turns_under<const N: usize, R: Robot<N>>(
    robot: &R,
    q: &SVector<f64, N>,
    torques: &SVector<f64, N>,
    before: &State<N>,
) -> SVector<f64, N> {
    let (own, preload) = (robot.joint_compliance(), robot.preload(q));
    let mut turns = own.component_mul(torques);
    for effect in robot.effects() {
        if let &Effect::JointCoupling { joints: [a, b], value } = effect {
            turns[a - 1] += value * torques[b - 1];
            turns[b - 1] += value * torques[a - 1];
        }
        let Some(i) = effect.row().map(|joint| joint - 1) else { continue };
        let torque = Torque { preload: preload[i], load: torques[i] };
        let after = plays(effect, torque, before.plays[i]);
        turns[i] += turn(effect, own[i], q[i], torque, after).unwrap_or_default();
    }
    turns
}

/// By how much a joint stands aside (rad) of its coordinate `q` (rad), if the
/// effect says so.
pub fn deviation<T: Real>(effect: &Effect, q: T) -> Option<T> {
    let (numbers, count) = numbers(effect);
    effect.deviation(&numbers[..count], &harmonic(q)).map(|deviation| deviation.0)
}

/// The share of the arm's own weight that every joint yields to, unloaded, if
/// the effect says so.
pub fn share_of_weight<T: Real>(effect: &Effect) -> Option<T> {
    let (numbers, count) = numbers(effect);
    effect.share_of_weight(&numbers[..count]).map(|share| share.0)
}

/// The share of the arm's own weight that gears carry before the load, if the effect says
/// so.
pub fn share_of_preload<T: Real>(effect: &Effect) -> Option<T> {
    let (numbers, count) = numbers(effect);
    effect.share_of_preload(&numbers[..count]).map(|share| share.0)
}

/// The torque (Nm) of a weight (N) about the z axis of a joint frame (the
/// force along it (N) for a prismatic joint), with the weight's first moment in
/// x and y of the base frame (Nm); see
/// [`gravity_sag`](robstiff_robots::effect::gravity_sag).
pub fn own_weight_torque<T: Real>(kind: JointKind, joint_frame: &Matrix4<T>, weight: T, moment: [T; 2]) -> T {
    let column = |k: usize| core::array::from_fn(|row| Number(joint_frame[(row, k)]));
    gravity_sag::torque(kind, column(2), column(3), Number(weight), moment.map(Number)).0
}

/// How fast each joint's output turns per unit of its coordinate: 1, but with a
/// transmission error 1 and the error's slope. The TCP moves by
/// [`Robot::jacobian`]'s column times this per unit of the coordinate; of an arm
/// that sags, but for the change of its sag.
pub fn commanded_rates<const N: usize, T, R>(robot: &R, q: &SVector<T, N>) -> SVector<T, N>
where
    T: Real,
    R: Robot<N>,
{
    let mut rates = SVector::repeat(T::one());
    for effect in robot.effects() {
        let Some(joint) = effect.row() else { continue };
        let (numbers, count) = numbers::<T>(effect);
        let constants = numbers.map(Tangent::constant);
        let harmonic = |order: f64| {
            let (s, c) = harmonic(q[joint - 1])(order);
            (Tangent { value: s, slope: c.times(order) }, Tangent { value: c, slope: (-s).times(order) })
        };
        if let Some(deviation) = effect.deviation(&constants[..count], &harmonic) {
            rates[joint - 1] += deviation.slope.0;
        }
    }
    rates
}

/// The numbers of an effect, in the first places.
fn numbers<T: Real>(effect: &Effect) -> ([Number<T>; MOST_PARAMETERS], usize) {
    let mut numbers = [Number(T::zero()); MOST_PARAMETERS];
    let own = effect.numbers();
    for (number, &value) in numbers.iter_mut().zip(own.iter()) {
        *number = Number(T::of(value));
    }
    (numbers, own.len())
}

/// Sine and cosine of whole multiples of a coordinate, of which whole turns do not matter.
fn harmonic<T: Real>(q: T) -> impl Fn(f64) -> (Number<T>, Number<T>) {
    let q = q.wrapped();
    move |order| {
        let (s, c) = (q * T::of(order)).sin_cos();
        (Number(s), Number(c))
    }
}

/// A [`Real`] as the catalogue's formulas compute with it.
#[derive(Clone, Copy)]
struct Number<T>(T);

macro_rules! operator {
    ($($trait:ident $method:ident)*) => {$(
        impl<T: Real> $trait for Number<T> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )*};
}

operator! { Add add Sub sub Mul mul }

impl<T: Real> Neg for Number<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<T: Real> Scalar for Number<T> {
    fn times(self, factor: f64) -> Self {
        Self(self.0 * T::of(factor))
    }

    fn plus(self, summand: f64) -> Self {
        Self(self.0 + T::of(summand))
    }

    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    fn recip(self) -> Self {
        Self(self.0.recip())
    }

    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }

    fn signum(self) -> Self {
        Self(self.0.signum())
    }
}
