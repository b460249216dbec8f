//! Writing URScript.

use std::collections::HashMap;

use super::numbers;
use crate::program::writing::{each, finish, is_name, short, wrong_name};
use crate::program::{Frame, Instruction, Motion, Move, Position, Program, Speed, Target, TextFile, Unwritable, Zone};

/// Names have at most so many characters.
const LONGEST_NAME: usize = 32;

/// Axes of the robot.
const AXES: usize = 6;

/// Decimals of speeds (m/s, rad/s) and radii (m).
const DECIMALS: usize = 7;

/// Writes a program as one function. Accelerations that the options of a motion do not say are those that the
/// controller has where none is given.
///
/// # Errors
/// The instructions that URScript cannot express.
pub fn write(program: &Program) -> Result<Vec<TextFile>, Vec<Unwritable>> {
    let mut writer = Writer::default();
    let mut wrong: Vec<Unwritable> = wrong_name(&program.name, LONGEST_NAME).into_iter().collect();
    wrong.extend(each(program, |instruction| writer.instruction(instruction)));
    let text = format!("def {}():\n{}end\n", program.name, writer.code);
    finish(vec![TextFile { name: format!("{}.script", program.name), text }], wrong)
}

#[derive(Default)]
struct Writer {
    code: String,
    /// The frame of poses as it stands in motions; empty for the base.
    work: String,
    /// What names hold.
    values: HashMap<String, String>,
}

impl Writer {
    fn line(&mut self, text: &str) {
        self.code += &format!("  {text}\n");
    }

    fn instruction(&mut self, instruction: &Instruction) -> Result<(), String> {
        match instruction {
            Instruction::Tool(frame) => match self.frame(frame)? {
                tool if tool.is_empty() => return Err("a tool has a name, a pose or both".to_owned()),
                tool => self.line(&format!("set_tcp({tool})")),
            },
            Instruction::Work(frame) => {
                let is_base = frame.name.is_empty() && frame.pose.is_none_or(|pose| pose == Default::default());
                self.work = if is_base { String::new() } else { self.frame(frame)? };
            }
            Instruction::Move(to) => self.motion(to)?,
            Instruction::KeptMove { text, .. } | Instruction::Statement { text, .. } => self.line(text),
        }
        Ok(())
    }

    /// What stands for a frame: its name, which holds its pose where that is known, or the pose.
    fn frame(&mut self, frame: &Frame) -> Result<String, String> {
        let pose = frame.pose.map(|pose| literal(&Target::Pose(pose, None).into()));
        if frame.name.is_empty() {
            return Ok(pose.unwrap_or_default());
        }
        if let Some(pose) = pose {
            self.hold(&frame.name, &pose)?;
        }
        Ok(frame.name.clone())
    }

    /// Gives a name a pose or angles, if it does not have them.
    fn hold(&mut self, name: &str, value: &str) -> Result<(), String> {
        if !is_name(name, LONGEST_NAME) {
            return Err(format!("`{name}` is no name: write letters, digits and `_`, a letter first"));
        }
        if self.values.get(name).is_none_or(|held| held != value) {
            self.line(&format!("{name} = {value}"));
            self.values.insert(name.to_owned(), value.to_owned());
        }
        Ok(())
    }

    fn motion(&mut self, to: &Move) -> Result<(), String> {
        if to.position.external.iter().any(Option::is_some) {
            return Err("URScript has no further axes".to_owned());
        }
        let mut place = literal(&to.position);
        if let Some(name) = &to.point {
            self.hold(name, &place)?;
            place.clone_from(name);
        }
        match &to.position.target {
            Target::Joints(angles) if angles.len() != AXES => {
                return Err(format!("URScript has {AXES} axes of the robot, not {}", angles.len()));
            }
            Target::Pose(_, Some(_)) => return Err("URScript has no words for the posture of a pose".to_owned()),
            Target::Pose(..) if !self.work.is_empty() => place = format!("pose_trans({}, {place})", self.work),
            _ => {}
        }
        let speed = match (&to.speed, to.motion) {
            (None, _) => None,
            (Some(Speed::Named(name)), _) => Some(name.clone()),
            (Some(Speed::Joints(speed)), Motion::Joint) | (Some(Speed::Tool(speed)), Motion::Linear) => {
                Some(short(*speed, DECIMALS)).filter(|speed| speed != "0").map(Some).ok_or("the speed is 0")?
            }
            (Some(_), Motion::Joint) => return Err("movej takes a speed of the joints (rad/s)".to_owned()),
            (Some(_), Motion::Linear) => return Err("movel takes a speed of the tool (m/s)".to_owned()),
        };
        let radius = match &to.zone {
            Zone::Fine => None,
            Zone::Within(radius) => Some(short(*radius, DECIMALS)),
            Zone::Named(name) => Some(name.clone()),
            Zone::Share(_) => return Err("URScript takes a zone as a distance, not as a share".to_owned()),
        };
        // A process motion goes through its blends at a constant speed.
        let word = match (to.motion, &radius) {
            (Motion::Joint, _) => "movej",
            (Motion::Linear, None) => "movel",
            (Motion::Linear, Some(_)) => "movep",
        };
        let of = |name: &str, value: Option<String>| value.map(|value| format!("{name}={value}"));
        let options = Some(to.options.clone()).filter(|options| !options.is_empty());
        let arguments = [Some(place), options, of("v", speed), of("r", radius)];
        self.line(&format!("{word}({})", arguments.into_iter().flatten().collect::<Vec<_>>().join(", ")));
        Ok(())
    }
}

/// `p[..]` or `[..]`.
fn literal(position: &Position) -> String {
    let pose = if matches!(position.target, Target::Pose(..)) { "p" } else { "" };
    format!("{pose}[{}]", numbers(position).join(", "))
}
