//! A URDF file whose chain moves as a description does.
//!
//! The text is edited where it must be: `xyz` and `rpy` of the joints of the chain, and limits.
//! All else stays byte for byte.

use core::f64::consts::{PI, TAU};
use core::ops::Range;
use std::collections::HashMap;
use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};
use roxmltree::{Document, Node};

use super::placing::{Axis, Posture, motions};
use super::read::{element, exact_turn, unrounded};
use super::{Chain, Tree};
use crate::description::ON_THE_LIMIT;
use crate::words::count;
use crate::{Description, Diagnostics, Effect, JointKind};

/// A URDF file with the kinematics of a description.
#[derive(Clone, Debug)]
pub struct Export {
    /// The file.
    pub text: String,
    /// The template's chain.
    pub chain: Chain,
    /// What was done to the moving joints, from the base to the tip.
    pub joints: Vec<Moved>,
    /// What was done to the fixed joint in front of the tip, if there is one.
    pub tip: Option<Moved>,
    /// Rounded angles (`1.5708`) that have all their digits now.
    pub exact: usize,
    /// What a URDF file cannot say.
    pub warnings: Vec<String>,
}

/// How the origin of a joint was moved.
#[derive(Clone, Debug, PartialEq)]
pub struct Moved {
    /// The joint's name.
    pub name: String,
    /// How far (m).
    pub shift: f64,
    /// How far it was turned (rad).
    pub turn: f64,
    /// The limits (rad or m) that replaced the template's.
    pub limits: Option<[f64; 2]>,
}

/// No calibration turns a link by more (rad): the description counts a joint from another zero or
/// the other way round, or is another arm's.
const LARGEST_TURN: f64 = 0.2;

/// Few calibrations move a joint by more (m).
const LARGE_SHIFT: f64 = 0.05;

/// Numbers that differ by less (m, and as entries of a rotation) stay as they are written.
const KEPT: f64 = 1e-11;

/// How near the tool must be to where a tip without a fixed joint can be (m, rad).
const REACHED: f64 = 1e-9;

impl Tree {
    /// The file with the kinematics of a description, which counts its joints as the chain from
    /// `base` to `tip` does; where these are left out, as for [`chain`](Self::chain).
    ///
    /// Zeros, lengths, twists, base and tool go into the origins of the moving joints and of the
    /// last fixed one. Each link keeps its place but for these corrections, and so do its
    /// meshes.
    ///
    /// # Errors
    /// A chain that cannot be, another count or kind of joints, an axis that the description has
    /// elsewhere altogether, a tool that the origins cannot give.
    pub fn export(&self, base: Option<&str>, tip: Option<&str>, robot: &Description) -> Result<Export, Diagnostics> {
        let chain = self.chain(base, tip)?;
        self.refuse_other_joints(&chain, robot)?;
        let fixed_behind = chain.path.last().is_some_and(|&index| self.joints[index].motion.is_none());
        let (from, frames) = template(&chain);
        let to = Posture::of(robot);
        let moved = motions(&from, &to, !fixed_behind);
        let mut exported =
            Export { text: String::new(), chain, joints: Vec::new(), tip: None, exact: 0, warnings: unsaid(robot) };
        self.refuse_other_axes(&exported.chain, (&from, &to), &moved)?;
        let mut links: Vec<Isometry3<f64>> = moved.iter().zip(&frames).map(|(moved, frame)| moved * frame).collect();
        links.push(to.tip);

        let document = Document::parse(self.lines.text()).expect("it was read before");
        let nodes: HashMap<usize, Node<'_, '_>> =
            document.root_element().children().map(|node| (node.range().start, node)).collect();
        let mut edits = Vec::new();
        // The frame that a joint is in: the link before it, with the fixed joints between, which stay.
        let (mut parent, mut segment) = (Isometry3::identity(), 0);
        let path = exported.chain.path.clone();
        for (position, &index) in path.iter().enumerate() {
            let joint = &self.joints[index];
            let node = nodes[&joint.place.start];
            let moves = joint.motion.is_some();
            let is_last = position + 1 == path.len();
            let origin = if moves || is_last { parent.inverse() * links[segment] } else { joint.origin };
            let literal = literal(node);
            exported.exact += literal.rounded;
            write_origin(node, &literal, &origin, self.lines.text(), &mut edits);
            let mut done = Moved {
                name: joint.name.clone(),
                shift: (origin.translation.vector - joint.origin.translation.vector).norm(),
                turn: joint.origin.rotation.angle_to(&origin.rotation),
                limits: None,
            };
            if done.shift > LARGE_SHIFT {
                let line = self.lines.number_at(joint.place.start);
                exported.warnings.push(format!(
                    "{}:{line}: the joint `{}` is moved by {:.0} mm: is the description of this arm, and in the same \
                     base frame?",
                    self.file,
                    joint.name,
                    done.shift * 1e3
                ));
            }
            if moves {
                let limits = robot.joints[segment].limits;
                done.limits = limits.filter(|&limits| write_limits(node, limits, self.lines.text(), &mut edits));
                if done.limits.is_none() && limits.is_some() && exported.chain.joints[segment].limits.is_none() {
                    exported.warnings.push(format!(
                        "the description's limits of the joint `{}` are left out: it has none in the template",
                        joint.name
                    ));
                }
                exported.joints.push(done);
                (parent, segment) = (links[segment], segment + 1);
            } else {
                parent *= origin;
                exported.tip = is_last.then_some(done);
            }
        }
        let mark = if self.is_marked { "\u{feff}" } else { "" };
        exported.text = mark.to_owned() + &edited(self.lines.text(), edits);
        Ok(exported)
    }

    fn refuse_other_joints(&self, chain: &Chain, robot: &Description) -> Result<(), Diagnostics> {
        let [has, there] = [robot.joints.len(), chain.joints.len()].map(|joints| count(joints, "moving joint"));
        if has != there {
            let message = format!("{there} from `{}` to `{}`, {has} in the description", chain.base, chain.tip);
            return Err(self.problem(
                &self.whole(),
                &message,
                "choose another base or tip, or the template of this arm",
            ));
        }
        let moving = self.moving(chain);
        for ((joint, row), place) in chain.joints.iter().zip(&robot.joints).zip(moving) {
            if joint.kind != row.kind {
                let word = |kind| if kind == JointKind::Revolute { "turns" } else { "slides" };
                let message =
                    format!("the joint `{}` {}, the description's {}", joint.name, word(joint.kind), word(row.kind));
                return Err(self.problem(&place, &message, "the template is another arm's"));
            }
        }
        Ok(())
    }

    /// Where the moving joints of a chain are in the file.
    fn moving(&self, chain: &Chain) -> Vec<Range<usize>> {
        let joints = chain.path.iter().map(|&index| &self.joints[index]);
        joints.filter(|joint| joint.motion.is_some()).map(|joint| joint.place.clone()).collect()
    }

    fn refuse_other_axes(
        &self,
        chain: &Chain,
        (from, to): (&Posture, &Posture),
        moved: &[Isometry3<f64>],
    ) -> Result<(), Diagnostics> {
        let places = self.moving(chain);
        let mut before = UnitQuaternion::identity();
        for (index, (old, new)) in from.axes.iter().zip(&to.axes).enumerate() {
            let name = &chain.joints[index].name;
            let turn = (moved[index].rotation * before.inverse()).angle();
            if turn > LARGEST_TURN {
                let turn = turn.to_degrees();
                let message = format!("at zero the description turns what the joint `{name}` carries by {turn:.1} deg");
                let help = "joints count as in the template, in direction and zero, and the frames are its base and \
                            tip; `robstiff import` makes such a description";
                return Err(self.problem(&places[index], &message, help));
            }
            before = moved[index].rotation;
            // A last link that is where the tool says may be beside its axis.
            let apart = beside(&moved[index], old, new);
            if apart > REACHED {
                let message = format!(
                    "the tip `{}` turns with the joint `{name}` itself, and the description's tool is {apart:.1e} m or \
                     rad beside its axis",
                    chain.tip
                );
                let help = "choose a tip that a fixed joint carries, or add a link with one: an origin can place it";
                return Err(self.problem(&places[index], &message, help));
            }
        }
        Ok(())
    }
}

/// How far a motion takes an axis beside another (m, rad).
fn beside(motion: &Isometry3<f64>, old: &Axis, new: &Axis) -> f64 {
    let turned = (motion.rotation * old.direction - new.direction).norm();
    let off = motion * nalgebra::Point3::from(old.point) - nalgebra::Point3::from(new.point);
    let across = off - new.direction * new.direction.dot(&off);
    if old.kind == JointKind::Prismatic { turned } else { turned.max(across.norm()) }
}

/// The chain at zero, and the frames of its joints.
fn template(chain: &Chain) -> (Posture, Vec<Isometry3<f64>>) {
    let mut frame = Isometry3::identity();
    let (mut axes, mut frames) = (Vec::new(), Vec::new());
    for joint in &chain.joints {
        frame *= joint.before;
        let direction = frame.rotation * joint.axis.into_inner();
        axes.push(Axis { kind: joint.kind, point: frame.translation.vector, direction });
        frames.push(frame);
    }
    (Posture { axes, tip: frame * chain.end }, frames)
}

/// Whether the origins of a file say what an effect does to the frames: one of the table, or none.
pub fn is_said_by_origins(effect: &Effect) -> bool {
    !effect.is_kinematic() || matches!(effect, Effect::JointZeroOffset { .. } | Effect::DhError { .. })
}

/// The effects that move frames by the pose, for which URDF has no words.
fn unsaid(robot: &Description) -> Vec<String> {
    let by_pose = robot.effects.iter().filter(|effect| !is_said_by_origins(effect));
    by_pose.map(|effect| format!("{effect} is left out: a URDF file has no word for it")).collect()
}

/// An origin as its digits say it.
struct Literal {
    frame: Isometry3<f64>,
    rpy: [f64; 3],
    /// How many of the angles are rounded multiples of 90 degrees.
    rounded: usize,
}

fn literal(joint: Node<'_, '_>) -> Literal {
    let text = |name| element(joint, "origin").and_then(|origin| origin.attribute(name)).unwrap_or("0 0 0");
    let numbers = |text: &str| {
        let mut words = text.split_whitespace().map(|word| word.parse::<f64>().unwrap_or(0.0));
        [0.0; 3].map(|other| words.next().unwrap_or(other))
    };
    let (rpy, angles) = (text("rpy"), numbers(text("rpy")));
    let is_rounded = |&(word, angle): &(&str, f64)| {
        unrounded(angle, word).is_some_and(|exact| (exact - angle).abs() > crate::angle::SNAP)
    };
    let rounded = rpy.split_whitespace().zip(angles).filter(is_rounded).count();
    let [roll, pitch, yaw] = angles;
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_euler_angles(roll, pitch, yaw));
    let frame = Isometry3::from_parts(Translation3::from(Vector3::from(numbers(text("xyz")))), turn);
    Literal { frame, rpy: angles, rounded }
}

/// A change of the text.
type Edit = (Range<usize>, String);

/// The text with the edits, which do not overlap.
fn edited(text: &str, mut edits: Vec<Edit>) -> String {
    edits.sort_by_key(|(range, _)| range.start);
    let (mut result, mut from) = (String::with_capacity(text.len() + 1024), 0);
    for (range, new) in edits {
        result += &text[from..range.start];
        result += &new;
        from = range.end;
    }
    result + &text[from..]
}

fn write_origin(joint: Node<'_, '_>, literal: &Literal, origin: &Isometry3<f64>, text: &str, edits: &mut Vec<Edit>) {
    let moves = (literal.frame.translation.vector - origin.translation.vector).amax() > KEPT;
    let matrix = |frame: &Isometry3<f64>| frame.rotation.to_rotation_matrix().into_inner();
    let turns = (matrix(&literal.frame) - matrix(origin)).amax() > KEPT;
    if !moves && !turns {
        return;
    }
    let shift = origin.translation.vector;
    let xyz = [shift.x, shift.y, shift.z].map(|value| (value * 1e12).round() / 1e12 + 0.0);
    let rpy = angles(&origin.rotation, literal.rpy);
    let xyz = xyz.map(|value| value.to_string()).join(" ");
    let rpy = rpy.map(digits).join(" ");
    let Some(node) = element(joint, "origin") else {
        let start = joint.range().start;
        let name = text[start + 1..].split(|c: char| c.is_whitespace() || c == '>').next().unwrap_or_default();
        let prefix = name.split_once(':').map_or(String::new(), |(prefix, _)| format!("{prefix}:"));
        let space = joint.first_child().filter(Node::is_text).map(|node| node.range());
        let indent = space.clone().map(|range| &text[range]).filter(|space| space.trim().is_empty());
        let first = joint.first_child().map_or(start, |node| node.range().start);
        let at = space.filter(|_| indent.is_some()).map_or(first, |range| range.end);
        let new = format!("<{prefix}origin xyz=\"{xyz}\" rpy=\"{rpy}\"/>{}", indent.unwrap_or_default());
        edits.push((at..at, new));
        return;
    };
    if moves {
        write_attribute(node, "xyz", &xyz, text, edits);
    }
    if turns {
        write_attribute(node, "rpy", &rpy, text, edits);
    }
}

/// Replaces the value of an attribute, or adds it behind the others.
fn write_attribute(node: Node<'_, '_>, name: &str, value: &str, text: &str, edits: &mut Vec<Edit>) {
    if let Some(attribute) = node.attribute_node(name) {
        edits.push((attribute.range_value(), value.to_owned()));
        return;
    }
    let start = node.range().start + 1;
    let tag = text[start..].find(|c: char| c.is_whitespace() || c == '/' || c == '>').unwrap_or_default();
    let at = node.attributes().map(|attribute| attribute.range().end).max().unwrap_or(start + tag);
    edits.push((at..at, format!(" {name}=\"{value}\"")));
}

/// Replaces limits that differ; says whether it did.
fn write_limits(joint: Node<'_, '_>, limits: [f64; 2], text: &str, edits: &mut Vec<Edit>) -> bool {
    let Some(node) = element(joint, "limit").filter(|_| joint.attribute("type") != Some("continuous")) else {
        return false;
    };
    let value = |name| node.attribute(name).and_then(|word| word.trim().parse().ok()).unwrap_or(0.0);
    let mut differ = false;
    for (name, limit) in ["lower", "upper"].into_iter().zip(limits) {
        if f64::abs(value(name) - limit) > ON_THE_LIMIT {
            differ = true;
            write_attribute(node, name, &limit.to_string(), text, edits);
        }
    }
    differ
}

/// Roll, pitch and yaw (rad), of all that are the same turn those nearest to the template's.
///
/// Roll and pitch are those of what the yaw leaves: where the pitch is nearly 90 degrees the yaw is
/// badly determined, and they make up for its error.
fn angles(turn: &UnitQuaternion<f64>, before: [f64; 3]) -> [f64; 3] {
    const EXACT: f64 = 1e-12;
    let turn = turn.to_rotation_matrix();
    let snapped = |angle: f64| {
        let exact = crate::angle::snapped(angle);
        if (exact - angle).abs() < EXACT { exact + 0.0 } else { angle }
    };
    let level = turn[(0, 0)].hypot(turn[(1, 0)]);
    // Pointing up or down, roll and yaw are one turn.
    let yaw = if level < EXACT { snapped(before[2]) } else { snapped(turn[(1, 0)].atan2(turn[(0, 0)])) };
    let rest = Rotation3::from_matrix_unchecked(exact_turn(0.0, 0.0, -yaw)) * turn;
    let roll = snapped((-rest[(1, 2)]).atan2(rest[(1, 1)]));
    let pitch = snapped((-rest[(2, 0)]).atan2(rest[(0, 0)]));
    let nearest =
        |angles: [f64; 3]| [0, 1, 2].map(|index| angles[index] - ((angles[index] - before[index]) / TAU).round() * TAU);
    let far = |angles: &[f64; 3]| angles.iter().zip(before).map(|(angle, before)| (angle - before).abs()).sum::<f64>();
    let [first, second] = [nearest([roll, pitch, yaw]), nearest([roll + PI, PI - pitch, yaw + PI])];
    if far(&second) < far(&first) { second } else { first }
}

/// An angle with all its digits, and as many as keep a reader from taking it for a rounded
/// multiple of 90 degrees.
fn digits(angle: f64) -> String {
    let text = angle.to_string();
    match unrounded(angle, &text) {
        Some(exact) if (exact - angle).abs() > crate::angle::SNAP => format!("{angle:.12}"),
        _ => text,
    }
}
