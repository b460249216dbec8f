//! Writing KRL.

use std::collections::HashMap;

use super::{AXES, EXTERNAL, POSE, numbers, pose_numbers};
use crate::program::writing::{each, finish, fixed, is_name, short, wrong_name};
use crate::program::{
    Configuration, Frame, Instruction, Motion, Move, Position, Program, Speed, Target, TextFile, Unwritable, Zone,
};

/// Names have at most so many characters.
const LONGEST_NAME: usize = 24;

/// What may be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Points stand in the motions; else they are declared in the `.dat`, where the
    /// pendant can teach them.
    pub inline: bool,
    /// A program with more instructions is split into routines that it calls, each
    /// in its file.
    pub most_instructions: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { inline: true, most_instructions: 2000 }
    }
}

/// Writes a program as `.src`, and `.dat` where points are declared.
///
/// # Errors
/// The instructions that KRL cannot express.
pub fn write(program: &Program, options: &Options) -> Result<Vec<TextFile>, Vec<Unwritable>> {
    let mut writer = Writer { options: *options, ..Writer::default() };
    let mut wrong: Vec<Unwritable> = wrong_name(&program.name, LONGEST_NAME).into_iter().collect();
    wrong.extend(each(program, |instruction| writer.instruction(instruction)));
    writer.end_routine();
    let routines = writer.routines;
    if let [routine] = &routines[..] {
        return finish(files(&program.name, INI.to_owned() + &routine.code, &routine.points), wrong);
    }
    // Four digits are enough for a split of any size that is useful.
    let name = |i: usize| format!("{}_{:04}", program.name, i + 1);
    wrong.extend(wrong_name(&name(0), LONGEST_NAME));
    let calls: String = (0..routines.len()).map(|i| format!("{}( )\n", name(i))).collect();
    let mut all = files(&program.name, INI.to_owned() + &calls, "");
    for (i, routine) in routines.iter().enumerate() {
        all.extend(files(&name(i), routine.code.clone(), &routine.points));
    }
    finish(all, wrong)
}

/// What initialises motions.
const INI: &str = ";FOLD INI\nBAS(#INITMOV,0)\n;ENDFOLD (INI)\n";

fn files(name: &str, code: String, points: &str) -> Vec<TextFile> {
    let head = "&ACCESS RVP\n&REL 1\n";
    let src = TextFile { name: format!("{name}.src"), text: format!("{head}DEF {name}( )\n{code}END\n") };
    let dat = TextFile { name: format!("{name}.dat"), text: format!("{head}DEFDAT {name}\n{points}ENDDAT\n") };
    if points.is_empty() { vec![src] } else { vec![src, dat] }
}

#[derive(Default)]
struct Routine {
    code: String,
    points: String,
}

#[derive(Default)]
struct Writer {
    options: Options,
    routines: Vec<Routine>,
    now: Routine,
    /// Instructions in the routine.
    count: usize,
    /// How many blocks are open: inside of one no routine ends.
    depth: usize,
    /// A `GOTO` finds its mark in its routine alone.
    jumps: bool,
    /// Points that the routine has declared, as they are written.
    points: HashMap<String, String>,
    unnamed: usize,
    set: HashMap<&'static str, String>,
}

impl Writer {
    fn end_routine(&mut self) {
        self.routines.push(std::mem::take(&mut self.now));
        self.points.clear();
        self.count = 0;
    }

    fn instruction(&mut self, instruction: &Instruction) -> Result<(), String> {
        if self.count >= self.options.most_instructions && self.depth == 0 && !self.jumps {
            self.end_routine();
        }
        self.count += 1;
        match instruction {
            Instruction::Tool(frame) => self.frame("TOOL", frame),
            Instruction::Work(frame) => self.frame("BASE", frame),
            Instruction::Move(to) => self.motion(to)?,
            Instruction::KeptMove { text, .. } => self.line(text),
            Instruction::Statement { text, .. } => {
                self.blocks(text);
                self.line(text);
            }
        }
        Ok(())
    }

    fn line(&mut self, text: &str) {
        self.now.code += text;
        self.now.code.push('\n');
    }

    fn blocks(&mut self, text: &str) {
        let first = text.split(|letter: char| !letter.is_ascii_alphanumeric()).next().unwrap_or_default();
        match first.to_ascii_uppercase().as_str() {
            "IF" | "FOR" | "WHILE" | "LOOP" | "REPEAT" | "SWITCH" | "SPLINE" => self.depth += 1,
            "ENDIF" | "ENDFOR" | "ENDWHILE" | "ENDLOOP" | "UNTIL" | "ENDSWITCH" | "ENDSPLINE" => {
                self.depth = self.depth.saturating_sub(1);
            }
            "GOTO" => self.jumps = true,
            _ => {}
        }
    }

    fn frame(&mut self, which: &str, frame: &Frame) {
        let written = frame.pose.as_ref().map(|pose| fields(&POSE, &pose_numbers(pose)));
        let Ok(number) = frame.name.parse::<u32>() else {
            let value = written.map_or(frame.name.clone(), |fields| format!("{{FRAME: {fields}}}"));
            return self.line(&format!("${which}={value}"));
        };
        if let Some(fields) = written.filter(|_| number != 0) {
            self.line(&format!("{which}_DATA[{number}]={{FRAME: {fields}}}"));
        }
        self.line(&format!("BAS(#{which},{number})"));
    }

    /// Sets a variable if it has another value.
    fn set(&mut self, variable: &'static str, value: String, line: String) {
        if self.set.get(variable) != Some(&value) {
            self.set.insert(variable, value);
            self.line(&line);
        }
    }

    fn assign(&mut self, variable: &'static str, value: String) {
        let line = format!("{variable}={value}");
        self.set(variable, value, line);
    }

    fn motion(&mut self, to: &Move) -> Result<(), String> {
        let aggregate = aggregate(&to.position)?;
        if to.motion == Motion::Linear && matches!(to.position.target, Target::Joints(_)) {
            return Err("LIN takes a pose: give the pose, or move the joints".to_owned());
        }
        match (&to.speed, to.motion) {
            (None, _) => {}
            (Some(Speed::Share(share)), Motion::Joint) => {
                let percent = short(share * 1e2, 4);
                self.set("PTP", percent.clone(), format!("BAS(#VEL_PTP,{percent})"));
            }
            (Some(Speed::Named(name)), Motion::Joint) => {
                self.set("PTP", name.clone(), format!("BAS(#VEL_PTP,{name})"));
            }
            (Some(Speed::Tool(_) | Speed::Joints(_)), Motion::Joint) => {
                return Err("PTP takes a share of the fastest, not a speed".to_owned());
            }
            (Some(Speed::Tool(speed)), Motion::Linear) => self.assign("$VEL.CP", short(*speed, 7)),
            (Some(Speed::Named(name)), Motion::Linear) => self.assign("$VEL.CP", name.clone()),
            (Some(Speed::Share(_) | Speed::Joints(_)), Motion::Linear) => {
                return Err("LIN takes a speed of the tool, not one of the joints".to_owned());
            }
        }
        let zone = match (&to.zone, to.motion) {
            (Zone::Fine, _) => "",
            (Zone::Named(words), _) => words,
            (Zone::Within(distance), _) => {
                self.assign("$APO.CDIS", short(distance * 1e3, 4));
                "C_DIS"
            }
            (Zone::Share(share), Motion::Joint) => {
                self.assign("$APO.CPTP", short(share * 1e2, 4));
                "C_PTP"
            }
            (Zone::Share(share), Motion::Linear) => {
                self.assign("$APO.CVEL", short(share * 1e2, 4));
                "C_VEL"
            }
        };
        let position = match &to.point {
            None if self.options.inline => format!("{{{aggregate}}}"),
            name => self.declared(name.as_deref(), &aggregate)?,
        };
        let word = if to.motion == Motion::Joint { "PTP" } else { "LIN" };
        let parts = [word, &position, zone, &to.options];
        let parts: Vec<&str> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        self.line(&parts.join(" "));
        Ok(())
    }

    /// The name of a point that the `.dat` declares.
    fn declared(&mut self, name: Option<&str>, aggregate: &str) -> Result<String, String> {
        let name = match name {
            Some(name) if is_name(name, LONGEST_NAME) => name.to_owned(),
            Some(name) => return Err(format!("`{name}` is no name of a point: write letters, digits and `_`")),
            None => {
                self.unnamed += 1;
                format!("XP{}", self.unnamed)
            }
        };
        match self.points.get(&name.to_ascii_uppercase()) {
            Some(other) if other == aggregate => return Ok(name),
            Some(_) => return Err(format!("the point `{name}` is in two places")),
            None => {}
        }
        let (kind, values) = aggregate.split_once(": ").unwrap_or(("E6POS", aggregate));
        self.now.points += &format!("DECL {kind} {name}={{{values}}}\n");
        self.points.insert(name.to_ascii_uppercase(), aggregate.to_owned());
        Ok(name)
    }
}

fn fields(names: &[&str], numbers: &[String]) -> String {
    names.iter().zip(numbers).map(|(name, number)| format!("{name} {number}")).collect::<Vec<_>>().join(",")
}

/// `E6POS: X 1.0,..`.
fn aggregate(position: &Position) -> Result<String, String> {
    let numbers = numbers(position);
    let (kind, mut text) = match &position.target {
        Target::Joints(angles) if angles.len() > AXES.len() => {
            return Err(format!("KRL has {} axes of the robot, not {}", AXES.len(), angles.len()));
        }
        Target::Joints(_) => ("E6AXIS", fields(&AXES, &numbers)),
        Target::Pose(_, configuration) => {
            let mut text = fields(&POSE, &numbers);
            match configuration {
                None => {}
                Some(Configuration::Kuka { status, turn }) => {
                    text += &status.map(|bits| format!(",S {bits}")).unwrap_or_default();
                    text += &turn.map(|bits| format!(",T {bits}")).unwrap_or_default();
                }
                Some(_) => return Err("KRL says the posture by status and turn".to_owned()),
            }
            ("E6POS", text)
        }
    };
    if position.external.len() > EXTERNAL.len() {
        return Err("KRL has six further axes".to_owned());
    }
    for (name, value) in EXTERNAL.iter().zip(&position.external) {
        text += &value.map(|value| format!(",{name} {}", fixed(value, 4))).unwrap_or_default();
    }
    Ok(format!("{kind}: {text}"))
}
