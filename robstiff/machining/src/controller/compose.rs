//! A robot program of a path.

use core::f64::consts::TAU;

use nalgebra::SVector;
use robstiff::{JointKind, Robot};

use super::posture::Postures;
use crate::program::{Frame, Instruction, Language, Motion, Move, Position, Program, Speed, Target, Zone};

/// Remarks of a TP program have at most so many characters.
const LONGEST_REMARK: usize = 30;

/// A point that the robot is sent to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sent<const N: usize> {
    /// The line of the path's file, from 1.
    pub line: usize,
    /// Joint coordinates to command (rad or m).
    pub q: SVector<f64, N>,
    /// Whether it is reached by a rapid.
    pub rapid: bool,
    /// How fast the TCP moves there (m/s), where the path says it.
    pub feed: Option<f64>,
    /// The speed of the spindle (rad/s), clockwise seen from it, where the path says it.
    pub spindle: Option<f64>,
    /// The number of the tool, where the path says it.
    pub tool: Option<u32>,
}

/// How positions are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Targets {
    /// Poses, with the posture where the language has words for it.
    Poses,
    /// Angles as the pendant shows them.
    Joints,
}

/// What a program is to be.
#[derive(Clone, Debug)]
pub struct Order {
    /// Its language.
    pub language: Language,
    /// Its name.
    pub name: String,
    /// The tool in the controller's flange, with its pose.
    pub tool: Frame,
    /// The work frame in the controller's world, with its pose.
    pub work: Frame,
    /// How positions are given; `None` to take what fits arm and language.
    pub targets: Option<Targets>,
    /// How fast rapids are, and all motions that have no feed because they move the joints.
    pub rapid: Speed,
    /// The feed (m/s) where the path has none.
    pub feed: Option<f64>,
    /// How near the tool passes points of a cut.
    pub zone: Zone,
    /// What starts the spindle and what stops it, in the language; `{rpm}` stands for its speed.
    pub spindle: [Option<String>; 2],
}

/// A program, and what was chosen for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Composed {
    /// The program.
    pub program: Program,
    /// How its positions are given.
    pub targets: Targets,
    /// Why so, where nobody asked for it.
    pub why: Option<String>,
    /// Whether cuts move the joints, without a feed.
    pub without_feed: bool,
}

/// Why there is no program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Uncomposable {
    /// A point of a cut has no feed: its line.
    NoFeed(usize),
    /// The posture of poses cannot be said, and the language needs it.
    NoPosture(&'static str),
    /// A turntable carries the arm, and the language has further axes in mm alone.
    Turntable,
}

impl core::fmt::Display for Uncomposable {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NoFeed(_) => f.write_str("the point has no feed"),
            Self::NoPosture(why) => write!(f, "a pose of a TP program needs its CONFIG, and the arm has none: {why}"),
            Self::Turntable => {
                f.write_str("a turntable carries the arm, and a TP program is written with further axes in mm")
            }
        }
    }
}

impl core::error::Error for Uncomposable {}

/// A program that sends the robot through points: to the first one and in rapids by its joints,
/// else along lines. A pose is the one at which the nominal model has the joint coordinates.
///
/// # Errors
/// Why there is none.
///
/// # Panics
/// If tool or work frame have no pose.
pub fn compose<const N: usize>(
    postures: &Postures<'_, N>,
    points: &[Sent<N>],
    order: &Order,
) -> Result<Composed, Uncomposable> {
    let (targets, why) = targets(postures, order)?;
    let tool = order.tool.pose.expect("the tool is known");
    let work = order.work.pose.expect("the work frame is known");
    let to_work = postures.nominal.in_base(&work).inverse();
    let carriers = postures.carriers();
    let angles = |q: &SVector<f64, N>| postures.nominal.pendant(q).split_off(carriers);
    let kinds = postures.nominal.arm.joint_kinds();
    if order.language == Language::Ls && kinds[..carriers].contains(&JointKind::Revolute) {
        return Err(Uncomposable::Turntable);
    }
    // As programs have them, in mm or degrees.
    let external = |q: &SVector<f64, N>| -> Vec<Option<f64>> {
        let of = postures.nominal.pendant(q).into_iter().zip(kinds).take(carriers);
        of.map(|(at, kind)| Some(if kind == JointKind::Prismatic { at * 1e3 } else { at.to_degrees() })).collect()
    };
    // Without words for a posture the joints alone say which it is; lines then go on in it.
    let joints_by_angles = order.language == Language::Ur;
    let target = |q: &SVector<f64, N>, motion: Motion| match targets {
        Targets::Joints => Target::Joints(angles(q)),
        Targets::Poses if joints_by_angles && motion == Motion::Joint => Target::Joints(angles(q)),
        Targets::Poses => {
            let pose = to_work * postures.nominal.pose(q, &tool);
            Target::Pose(pose, postures.configuration(q, order.language))
        }
    };
    // TP programs and URScript take angles for lines, too.
    let line_by_joints = targets == Targets::Joints && !matches!(order.language, Language::Ls | Language::Ur);
    let mut instructions = vec![Instruction::Tool(order.tool.clone()), Instruction::Work(order.work.clone())];
    let mut spindle = Spindle { on: None, tool: None, order };
    let mut without_feed = false;
    for (i, point) in points.iter().enumerate() {
        spindle.before(point, i == 0, points, &mut instructions);
        let is_line = i > 0 && !point.rapid;
        let by_joints = !is_line || line_by_joints;
        let speed = match (is_line, order.language) {
            (false, _) => order.rapid.clone(),
            // A share of the fastest is all that joints take there.
            (true, Language::Krl) if by_joints => {
                without_feed = true;
                order.rapid.clone()
            }
            (true, _) => Speed::Tool(point.feed.or(order.feed).ok_or(Uncomposable::NoFeed(point.line))?),
        };
        let passes = is_line && points.get(i + 1).is_some_and(|next| !next.rapid && next.spindle == point.spindle);
        let zone = if passes { order.zone.clone() } else { Zone::Fine };
        let motion = if by_joints { Motion::Joint } else { Motion::Linear };
        let position = Position { target: target(&point.q, motion), external: external(&point.q) };
        let to = Move { speed: Some(speed), zone, ..Move::to(motion, position) };
        instructions.push(Instruction::Move(to));
    }
    spindle.stop(&mut instructions);
    Ok(Composed { program: Program { name: order.name.clone(), instructions }, targets, why, without_feed })
}

/// How positions are given, and why.
fn targets<const N: usize>(
    postures: &Postures<'_, N>,
    order: &Order,
) -> Result<(Targets, Option<String>), Uncomposable> {
    let unfit = postures.unfit();
    match (order.targets, unfit, order.language) {
        (Some(Targets::Poses), Some(why), Language::Ls) => Err(Uncomposable::NoPosture(why)),
        (Some(targets), _, _) => Ok((targets, None)),
        (None, _, Language::Ur) => Ok((Targets::Poses, None)),
        (None, Some(why), _) => Ok((Targets::Joints, Some(format!("the posture of a pose cannot be said: {why}")))),
        (None, None, _) => Ok((Targets::Poses, None)),
    }
}

/// Whether the spindle turns, and which tool is in it.
struct Spindle<'o> {
    /// Its speed (rad/s); 0 where it turns and the path does not say how fast.
    on: Option<f64>,
    tool: Option<u32>,
    order: &'o Order,
}

impl Spindle<'_> {
    /// What is said before a point.
    fn before<const N: usize>(
        &mut self,
        point: &Sent<N>,
        is_first: bool,
        points: &[Sent<N>],
        instructions: &mut Vec<Instruction>,
    ) {
        if point.tool != self.tool {
            self.tool = point.tool;
            if let Some(tool) = point.tool {
                instructions.push(Instruction::statement(self.remark(&format!("tool {tool} of the path"))));
            }
        }
        match point.spindle {
            Some(speed) if speed != 0.0 => {
                if self.on != Some(speed) {
                    self.start(Some(speed), instructions);
                }
                self.on = Some(speed);
            }
            Some(_) => self.stop(instructions),
            // A path that never says it cuts all along.
            None if is_first
                && points.iter().all(|point| point.spindle.is_none())
                && self.order.spindle[0].is_some() =>
            {
                self.start(None, instructions);
                self.on = Some(0.0);
            }
            None => {}
        }
    }

    fn start(&self, speed: Option<f64>, instructions: &mut Vec<Instruction>) {
        let rpm = speed.map_or_else(String::new, |speed| format!("{}", (speed * 60.0 / TAU * 1e3).round() / 1e3));
        let text = match &self.order.spindle[0] {
            Some(text) => self.statement(&text.replace("{rpm}", &rpm)),
            None => self.remark(&format!("spindle on, {rpm} rpm")),
        };
        instructions.push(Instruction::statement(text));
    }

    fn stop(&mut self, instructions: &mut Vec<Instruction>) {
        if self.on.take().is_none() {
            return;
        }
        let text = match &self.order.spindle[1] {
            Some(text) => self.statement(text),
            None => self.remark("spindle off"),
        };
        instructions.push(Instruction::statement(text));
    }

    /// RAPID ends a statement with `;`, a TP program ends its line so by itself.
    fn statement(&self, text: &str) -> String {
        let text = text.trim().trim_end_matches(';').trim_end();
        if self.order.language == Language::Rapid { format!("{text};") } else { text.to_owned() }
    }

    fn remark(&self, text: &str) -> String {
        match self.order.language {
            Language::Krl => format!("; {text}"),
            Language::Rapid => format!("! {text}"),
            Language::Ur => format!("# {text}"),
            Language::Ls => format!("!{}", text.chars().take(LONGEST_REMARK).collect::<String>()),
        }
    }
}
