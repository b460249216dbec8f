//! The chain of an arm: where its joints, links and tool stand.

use nalgebra::{Matrix3, Rotation3, Vector3, Vector6};
use robstiff::{Convention, JointKind};
use robstiff_robots::{Description, Placement};

/// A frame: the turn of its axes and the place of its origin, in the base frame (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Its axes, as columns.
    pub turn: Matrix3<f64>,
    /// Its origin (m).
    pub at: Vector3<f64>,
}

impl Frame {
    /// The base frame itself.
    pub fn identity() -> Self {
        Self { turn: Matrix3::identity(), at: Vector3::zeros() }
    }

    /// `Rz(yaw) Ry(pitch) Rx(roll)` about the origin at `xyz`.
    pub fn of(placement: &Placement) -> Self {
        let [roll, pitch, yaw] = placement.rpy;
        Self { turn: *Rotation3::from_euler_angles(roll, pitch, yaw).matrix(), at: Vector3::from(placement.xyz) }
    }

    /// A point that is given in this frame, in the base frame (m).
    pub fn point(&self, inside: &Vector3<f64>) -> Vector3<f64> {
        self.at + self.turn * inside
    }

    /// An axis of the frame: 0, 1, 2 for x, y, z.
    pub fn axis(&self, axis: usize) -> Vector3<f64> {
        self.turn.column(axis).into_owned()
    }

    fn turned(&self, by: &Matrix3<f64>) -> Self {
        Self { turn: self.turn * by, at: self.at }
    }

    fn moved(&self, along: &Vector3<f64>) -> Self {
        Self { turn: self.turn, at: self.point(along) }
    }

    /// The frame that stands at `inside` as seen from this one.
    fn then(&self, inside: &Self) -> Self {
        Self { turn: self.turn * inside.turn, at: self.point(&inside.at) }
    }
}

/// The turn by a rotation vector (rad).
pub fn turn_by(vector: &Vector3<f64>) -> Matrix3<f64> {
    // Most vectors of a rig are zero, and it is asked at every row.
    if *vector == Vector3::zeros() { Matrix3::identity() } else { *Rotation3::new(*vector).matrix() }
}

fn about(axis: usize, angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    match axis {
        0 => Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c),
        1 => Matrix3::new(c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c),
        _ => Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0),
    }
}

/// A row of the table (rad, m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Turning or sliding.
    pub kind: JointKind,
    /// Theta, d, a, alpha and beta. Beta turns about y behind alpha: the angle between axes that
    /// should be parallel, which no other number of the table can say (Hayati 1983).
    pub numbers: [f64; 5],
}

/// The places in [`Row::numbers`].
pub const THETA: usize = 0;
/// See [`THETA`].
pub const D: usize = 1;
/// See [`THETA`].
pub const A: usize = 2;
/// See [`THETA`].
pub const ALPHA: usize = 3;
/// See [`THETA`].
pub const BETA: usize = 4;

/// An arm, as a chain of frames.
#[derive(Clone, Debug)]
pub struct Arm {
    convention: Convention,
    base: Frame,
    /// The rows of the table, a joint each.
    pub rows: Vec<Row>,
    tool: Frame,
}

/// Where an arm stands; every frame in the base frame.
#[derive(Clone, Debug)]
pub struct Stand {
    /// Frame 0.
    pub base: Frame,
    /// The frames on whose z axes the joints act, fixed to what carries the joint: x and y do not turn
    /// with it.
    pub joints: Vec<Frame>,
    /// The frames behind the rows of the table; the last is the flange.
    pub links: Vec<Frame>,
    /// What each number of the table moves all behind it about or along: theta, d, a, alpha, beta.
    pub screws: Vec<[Screw; 5]>,
    /// The tool centre point.
    pub tcp: Frame,
}

/// A turn about an axis through a point, or a shift along it.
#[derive(Clone, Copy, Debug)]
pub struct Screw {
    /// The axis.
    pub axis: Vector3<f64>,
    /// A point on it (m).
    pub through: Vector3<f64>,
    /// Whether it shifts.
    pub slides: bool,
}

impl Screw {
    /// The twist `[d; r]` of a point per unit.
    pub fn twist_at(&self, point: &Vector3<f64>) -> Vector6<f64> {
        let (d, r) = match self.slides {
            true => (self.axis, Vector3::zeros()),
            false => (self.axis.cross(&(point - self.through)), self.axis),
        };
        Vector6::new(d.x, d.y, d.z, r.x, r.y, r.z)
    }

    /// The displacement of a point per unit.
    pub fn at(&self, point: &Vector3<f64>) -> Vector3<f64> {
        if self.slides { self.axis } else { self.axis.cross(&(point - self.through)) }
    }
}

impl Arm {
    /// The arm of a description, with what the description corrects in its table.
    pub fn of(description: &Description) -> Self {
        let rows = description.corrected_joints();
        let rows = rows
            .iter()
            .map(|joint| Row { kind: joint.kind, numbers: [joint.theta, joint.d, joint.a, joint.alpha, 0.0] });
        Self {
            convention: description.convention,
            base: Frame::of(&description.base),
            rows: rows.collect(),
            tool: Frame::of(&description.tool),
        }
    }

    /// The number of joints.
    pub fn joints(&self) -> usize {
        self.rows.len()
    }

    /// Where it stands at joint coordinates (rad or m), if joints stand aside as well, each by a
    /// rotation vector in its own frame (rad), of a joint that slides with a shift (m) in place of the
    /// turn about z; none do where `aside` is empty.
    pub fn stand(&self, q: &[f64], aside: &[Vector3<f64>]) -> Stand {
        let mut frame = self.base;
        let count = self.rows.len();
        let (mut joints, mut links) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut screws = Vec::with_capacity(count);
        for (i, Row { kind, numbers: [theta, d, a, alpha, beta] }) in self.rows.iter().enumerate() {
            let by = aside.get(i).copied().unwrap_or_default();
            let (angle, offset, by) = match kind {
                JointKind::Revolute => (theta + q[i], *d, by),
                JointKind::Prismatic => (*theta, d + q[i] + by.z, Vector3::new(by.x, by.y, 0.0)),
            };
            let turns = |frame: &Frame, axis| Screw { axis: frame.axis(axis), through: frame.at, slides: false };
            let slides = |frame: &Frame, axis| Screw { axis: frame.axis(axis), through: frame.at, slides: true };
            let joint = |frame: &Frame| if by == Vector3::zeros() { *frame } else { frame.turned(&turn_by(&by)) };
            let motion = |frame: &Frame| frame.turned(&about(2, angle)).moved(&Vector3::new(0.0, 0.0, offset));
            let along = |frame: &Frame| frame.moved(&Vector3::new(*a, 0.0, 0.0));
            let bend = |frame: &Frame| {
                let by_alpha = frame.turned(&about(0, *alpha));
                let behind = if *beta == 0.0 { by_alpha } else { by_alpha.turned(&about(1, *beta)) };
                (turns(frame, 0), turns(&by_alpha, 1), behind)
            };
            match self.convention {
                Convention::Standard => {
                    let own = joint(&frame);
                    let moved = motion(&own);
                    let reached = along(&moved);
                    let (twist, tilt, behind) = bend(&reached);
                    screws.push([turns(&own, 2), slides(&own, 2), slides(&moved, 0), twist, tilt]);
                    joints.push(own);
                    frame = behind;
                }
                Convention::Modified => {
                    let (twist, tilt, bent) = bend(&frame);
                    let reached = along(&bent);
                    screws.push([turns(&reached, 2), slides(&reached, 2), slides(&bent, 0), twist, tilt]);
                    let moved = motion(&reached);
                    // At the origin of the joint's frame, with the axes of what carries its bearing.
                    let carried = joint(&Frame { turn: reached.turn, at: moved.at });
                    let aside = carried.turn != reached.turn;
                    let turn = if aside { carried.turn * reached.turn.transpose() * moved.turn } else { moved.turn };
                    frame = Frame { turn, at: moved.at };
                    joints.push(carried);
                }
            }
            links.push(frame);
        }
        Stand { base: self.base, joints, links, screws, tcp: frame.then(&self.tool) }
    }
}

impl Stand {
    /// Frame n, before the tool.
    pub fn flange(&self) -> &Frame {
        self.links.last().unwrap_or(&self.base)
    }

    /// The motion of a joint (from 0) along its coordinate.
    pub fn joint_screw(&self, joint: usize, kind: JointKind) -> Screw {
        let frame = &self.joints[joint];
        Screw { axis: frame.axis(2), through: frame.at, slides: kind == JointKind::Prismatic }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::SVector;
    use robstiff::{Generic, Robot};
    use robstiff_robots::samples::{five_axis, odd, poses};

    use super::*;

    /// The generic robot multiplies 4 x 4 matrices.
    #[test]
    fn the_chain_is_that_of_the_generic_robot() {
        let (mut five, six) = (five_axis(), odd());
        five.tool.xyz = [0.1, 0.0, 0.2];
        for q in poses::<6>() {
            let expected = Generic::<6>::new(&six).expect("six joints").transform(&SVector::from(q));
            let found = Arm::of(&six).stand(&q, &[]).tcp;
            assert!((expected.fixed_view::<3, 3>(0, 0) - found.turn).amax() < 1e-14);
            assert!((expected.fixed_view::<3, 1>(0, 3) - found.at).amax() < 1e-14);
            let expected = Generic::<5>::new(&five).expect("five joints").transform(&SVector::from_fn(|i, _| q[i]));
            let found = Arm::of(&five).stand(&q[..5], &[]).tcp;
            assert!((expected.fixed_view::<3, 1>(0, 3) - found.at).amax() < 1e-14);
        }
    }

    /// The screws of the table's numbers are its derivatives, in both conventions.
    #[test]
    fn numbers_of_the_table_move_the_tool_by_their_screws() {
        for description in [five_axis(), odd()] {
            let arm = Arm::of(&description);
            let q: Vec<f64> = (0..arm.joints()).map(|i| 0.3 + 0.2 * i as f64).collect();
            let stand = arm.stand(&q, &[]);
            for joint in 0..arm.joints() {
                for number in [THETA, D, A, ALPHA, BETA] {
                    let tip = |by: f64| {
                        let mut off = arm.clone();
                        off.rows[joint].numbers[number] += by;
                        off.stand(&q, &[]).tcp.at
                    };
                    let slope = (tip(1e-6) - tip(-1e-6)) / 2e-6;
                    let found = stand.screws[joint][number].at(&stand.tcp.at);
                    assert!((slope - found).amax() < 1e-8, "{joint} {number}: {slope} {found}");
                }
            }
        }
    }
}
