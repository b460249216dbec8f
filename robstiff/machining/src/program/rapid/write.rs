//! Writing RAPID.

use std::collections::HashMap;

use super::{LENGTH, SPEEDS, ZONES, numbers, pose_numbers};
use crate::program::writing::{each, finish, fixed, is_name, short, wrong_name};
use crate::program::{
    Configuration, Frame, Instruction, Motion, Move, Position, Program, Speed, Target, TextFile, Unwritable, Zone,
};

/// Names have at most so many characters.
const LONGEST_NAME: usize = 32;

/// Writes a program as a module with the routine `main`. Points without a name stand
/// in the motions. Of a tool's load nothing is known: the module says so.
///
/// # Errors
/// The instructions that RAPID cannot express.
pub fn write(program: &Program) -> Result<Vec<TextFile>, Vec<Unwritable>> {
    let mut writer = Writer { tool: "tool0".to_owned(), work: "wobj0".to_owned(), ..Writer::default() };
    let mut wrong: Vec<Unwritable> = wrong_name(&program.name, LONGEST_NAME).into_iter().collect();
    wrong.extend(each(program, |instruction| writer.instruction(instruction)));
    let Writer { data, code, any_posture, .. } = writer;
    let postures = if any_posture { "    ConfJ\\Off;\n    ConfL\\Off;\n" } else { "" };
    let text = format!("MODULE {}\n{data}  PROC main()\n{postures}{code}  ENDPROC\nENDMODULE\n", program.name);
    finish(vec![TextFile { name: format!("{}.mod", program.name), text }], wrong)
}

#[derive(Default)]
struct Writer {
    data: String,
    code: String,
    tool: String,
    work: String,
    /// Whether a pose does not say its posture.
    any_posture: bool,
    /// Data by name, as they are written.
    declared: HashMap<String, String>,
    /// Names of speeds and zones by their value.
    speeds: HashMap<String, String>,
    zones: HashMap<String, String>,
}

impl Writer {
    fn instruction(&mut self, instruction: &Instruction) -> Result<(), String> {
        match instruction {
            Instruction::Tool(frame) => {
                let value = frame
                    .pose
                    .as_ref()
                    .map(|pose| format!("[TRUE,{},[0.001,[0,0,0.001],[1,0,0,0],0,0,0]]", nested(&pose_numbers(pose))));
                let note = "  ! The load of the tool is not known: set it.\n";
                self.tool = self.frame("tooldata", "tool0", frame, value, note)?;
            }
            Instruction::Work(frame) => {
                let value = frame
                    .pose
                    .as_ref()
                    .map(|pose| format!("[FALSE,TRUE,\"\",{},[[0,0,0],[1,0,0,0]]]", nested(&pose_numbers(pose))));
                self.work = self.frame("wobjdata", "wobj0", frame, value, "")?;
            }
            Instruction::Move(to) => self.motion(to)?,
            Instruction::KeptMove { text, .. } | Instruction::Statement { text, .. } => {
                self.code += &format!("    {text}\n");
            }
        }
        Ok(())
    }

    fn frame(
        &mut self,
        kind: &str,
        zero: &str,
        frame: &Frame,
        value: Option<String>,
        note: &str,
    ) -> Result<String, String> {
        if frame.name.eq_ignore_ascii_case(zero) {
            return Ok(frame.name.clone());
        }
        if !is_name(&frame.name, LONGEST_NAME) {
            return Err(format!("`{}` is no name of a frame: write letters, digits and `_`", frame.name));
        }
        if let Some(value) = value {
            self.data += note;
            self.declare("TASK PERS", kind, &frame.name, &value)?;
        }
        Ok(frame.name.clone())
    }

    fn declare(&mut self, how: &str, kind: &str, name: &str, value: &str) -> Result<(), String> {
        match self.declared.get(&name.to_ascii_uppercase()) {
            Some(other) if other == value => return Ok(()),
            Some(_) => return Err(format!("`{name}` has two values")),
            None => {}
        }
        self.data += &format!("  {how} {kind} {name}:={value};\n");
        self.declared.insert(name.to_ascii_uppercase(), value.to_owned());
        Ok(())
    }

    fn motion(&mut self, to: &Move) -> Result<(), String> {
        let (kind, value) = self.position(&to.position)?;
        let word = match (to.motion, kind) {
            (Motion::Joint, "jointtarget") => "MoveAbsJ",
            (Motion::Joint, _) => "MoveJ",
            (Motion::Linear, "robtarget") => "MoveL",
            (Motion::Linear, _) => return Err("MoveL takes a pose: give the pose, or move the joints".to_owned()),
        };
        let position = match &to.point {
            None => value,
            Some(name) if is_name(name, LONGEST_NAME) => {
                self.declare("CONST", kind, name, &value)?;
                name.clone()
            }
            Some(name) => return Err(format!("`{name}` is no name of a point: write letters, digits and `_`")),
        };
        let speed = match &to.speed {
            None => return Err("a motion has a speed".to_owned()),
            Some(Speed::Named(name)) => name.clone(),
            Some(Speed::Tool(speed)) => self.speed(speed * 1e3)?,
            Some(Speed::Share(_) | Speed::Joints(_)) => {
                return Err("RAPID takes a speed of the tool, not one of the joints".to_owned());
            }
        };
        let zone = match &to.zone {
            Zone::Fine => "fine".to_owned(),
            Zone::Named(name) => name.clone(),
            Zone::Within(distance) => self.zone(distance * 1e3)?,
            Zone::Share(_) => return Err("RAPID takes a zone as a distance, not as a share".to_owned()),
        };
        let (tool, work, options) = (&self.tool, &self.work, &to.options);
        self.code += &format!("    {word} {position},{speed},{zone},{tool}\\WObj:={work}{options};\n");
        Ok(())
    }

    fn speed(&mut self, mm: f64) -> Result<String, String> {
        if let Some(known) = SPEEDS.iter().find(|known| (f64::from(**known) - mm).abs() < 1e-9) {
            return Ok(format!("v{known}"));
        }
        let (value, count) = (short(mm, 5), self.speeds.len() + 1);
        let name = self.speeds.entry(value.clone()).or_insert_with(|| format!("vFeed{count}")).clone();
        self.declare("CONST", "speeddata", &name, &format!("[{value},500,5000,1000]"))?;
        Ok(name)
    }

    fn zone(&mut self, mm: f64) -> Result<String, String> {
        if let Some((known, _)) = ZONES.iter().find(|(_, known)| (known - mm).abs() < 1e-9) {
            return Ok((*known).to_owned());
        }
        let (value, count) = (short(mm, 5), self.zones.len() + 1);
        let name = self.zones.entry(value.clone()).or_insert_with(|| format!("zBlend{count}")).clone();
        // In the proportions of the zones that the controller knows.
        let [wide, turn] = [1.5 * mm, 0.15 * mm].map(|part| short(part, 5));
        self.declare("CONST", "zonedata", &name, &format!("[FALSE,{value},{wide},{wide},{turn},{wide},{turn}]"))?;
        Ok(name)
    }

    fn position(&mut self, position: &Position) -> Result<(&'static str, String), String> {
        if position.external.len() > 6 {
            return Err("RAPID has six further axes".to_owned());
        }
        let axis = |i: usize| position.external.get(i).copied().flatten();
        let external: Vec<String> =
            (0..6).map(|i| axis(i).map_or("9E9".to_owned(), |value| fixed(value, LENGTH))).collect();
        let external = external.join(",");
        let numbers = numbers(position);
        match &position.target {
            Target::Joints(angles) if angles.len() > 6 => {
                Err(format!("RAPID has 6 axes of the robot, not {}", angles.len()))
            }
            Target::Joints(angles) => {
                let rest = vec!["9E9".to_owned(); 6 - angles.len()];
                Ok(("jointtarget", format!("[[{}],[{external}]]", [numbers, rest].concat().join(","))))
            }
            Target::Pose(_, configuration) => {
                let [cf1, cf4, cf6, cfx] = match configuration {
                    Some(Configuration::Abb(parts)) => *parts,
                    None => {
                        self.any_posture = true;
                        [0; 4]
                    }
                    Some(_) => return Err("RAPID says the posture by confdata".to_owned()),
                };
                let pose = nested(&numbers);
                let pose = pose.trim_start_matches('[').trim_end_matches(']');
                Ok(("robtarget", format!("[[{pose}],[{cf1},{cf4},{cf6},{cfx}],[{external}]]")))
            }
        }
    }
}

/// `[[x,y,z],[q1,q2,q3,q4]]`.
fn nested(numbers: &[String]) -> String {
    format!("[[{}],[{}]]", numbers[..3].join(","), numbers[3..].join(","))
}
