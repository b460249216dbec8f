//! Writing FANUC TP programs.

use nalgebra::Isometry3;

use super::{POSE, numbers};
use crate::program::writing::{each, finish, fixed, short, wrong_name};
use crate::program::{
    Configuration, Frame, Instruction, Motion, Move, Position, Program, Speed, Target, TextFile, Unwritable, Zone,
};

/// Names have at most so many characters.
const LONGEST_NAME: usize = 32;

/// Speeds of the tool have one decimal (mm/s).
const SPEED_DECIMALS: usize = 1;

/// Writes a program as a `.ls` file. Where a frame stands, which only the controller
/// can be told, is written as remarks. Further axes are written in mm.
///
/// # Errors
/// The instructions that a TP program cannot express.
pub fn write(program: &Program) -> Result<Vec<TextFile>, Vec<Unwritable>> {
    let name = program.name.to_ascii_uppercase();
    let mut writer = Writer { frame: "0".to_owned(), tool: "1".to_owned(), ..Writer::default() };
    let mut wrong: Vec<Unwritable> = wrong_name(&name, LONGEST_NAME).into_iter().collect();
    wrong.extend(each(program, |instruction| writer.instruction(instruction)));
    let Writer { lines, statements, positions, .. } = writer;
    let text = format!(
        "/PROG  {name}\n/ATTR\nOWNER\t\t= MNEDITOR;\nCOMMENT\t\t= \"\";\nPROG_SIZE\t= 0;\n\
         CREATE\t\t= DATE 100-01-01  TIME 00:00:00;\nMODIFIED\t= DATE 100-01-01  TIME 00:00:00;\n\
         FILE_NAME\t= ;\nVERSION\t\t= 0;\nLINE_COUNT\t= {lines};\nMEMORY_SIZE\t= 0;\nPROTECT\t\t= READ_WRITE;\n\
         TCD:  STACK_SIZE\t= 0,\n      TASK_PRIORITY\t= 50,\n      TIME_SLICE\t= 0,\n      BUSY_LAMP_OFF\t= 0,\n      \
         ABORT_REQUEST\t= 0,\n      PAUSE_REQUEST\t= 0;\nDEFAULT_GROUP\t= 1,*,*,*,*;\n\
         CONTROL_CODE\t= 00000000 00000000;\n/MN\n{statements}/POS\n{positions}/END\n"
    );
    finish(vec![TextFile { name: format!("{name}.ls"), text }], wrong)
}

#[derive(Default)]
struct Writer {
    lines: usize,
    points: usize,
    statements: String,
    positions: String,
    frame: String,
    tool: String,
}

impl Writer {
    fn line(&mut self, space: &str, text: &str) {
        self.lines += 1;
        self.statements += &format!("{:4}:{space}{text} ;\n", self.lines);
    }

    fn instruction(&mut self, instruction: &Instruction) -> Result<(), String> {
        match instruction {
            Instruction::Tool(frame) => {
                self.tool = self.frame("UTOOL", frame)?;
            }
            Instruction::Work(frame) => {
                self.frame = self.frame("UFRAME", frame)?;
            }
            Instruction::Move(to) => self.motion(to)?,
            Instruction::KeptMove { .. } => {
                return Err("a motion that is not known has a position elsewhere".to_owned());
            }
            Instruction::Statement { text, .. } => self.line("  ", text),
        }
        Ok(())
    }

    fn frame(&mut self, which: &str, frame: &Frame) -> Result<String, String> {
        let Ok(number) = frame.name.parse::<u32>() else {
            return Err(format!("`{}` is no frame: FANUC's frames have numbers", frame.name));
        };
        if let Some(pose) = &frame.pose {
            // A remark has 32 characters.
            let numbers = pose_numbers(pose);
            for two in [0, 2, 4] {
                let pair = [two, two + 1].map(|i| format!("{} {}", POSE[i], numbers[i]));
                self.line("  ", &format!("!{which} {number} {}", pair.join(" ")));
            }
        }
        self.line("  ", &format!("{which}_NUM={number}"));
        Ok(number.to_string())
    }

    fn motion(&mut self, to: &Move) -> Result<(), String> {
        let speed = match (&to.speed, to.motion) {
            (Some(Speed::Share(share)), Motion::Joint) => {
                format!("{}%", (share * 1e2).round().clamp(1.0, 100.0))
            }
            (Some(Speed::Tool(speed)), Motion::Linear) => {
                let speed = short(speed * 1e3, SPEED_DECIMALS);
                if speed == "0" {
                    return Err("the speed is less than .1 mm/s, the least that a TP program has".to_owned());
                }
                format!("{speed}mm/sec")
            }
            (Some(Speed::Named(name)), _) => name.clone(),
            (None, _) => return Err("a motion has a speed".to_owned()),
            (Some(Speed::Tool(_) | Speed::Joints(_)), Motion::Joint) => {
                return Err("J takes a share of the fastest, not a speed".to_owned());
            }
            (Some(Speed::Share(_) | Speed::Joints(_)), Motion::Linear) => {
                return Err("L takes a speed of the tool, not one of the joints".to_owned());
            }
        };
        let zone = match &to.zone {
            Zone::Fine => "FINE".to_owned(),
            Zone::Named(name) => name.clone(),
            Zone::Share(share) => format!("CNT{}", (share * 1e2).round().clamp(0.0, 100.0)),
            Zone::Within(_) => return Err("FANUC takes a zone as a share (CNT), not as a distance".to_owned()),
        };
        self.position(&to.position, to.point.as_deref())?;
        let letter = if to.motion == Motion::Joint { "J" } else { "L" };
        let options = if to.options.is_empty() { String::new() } else { format!(" {}", to.options) };
        let point = self.points;
        self.line("", &format!("{letter} P[{point}] {speed} {zone}{options}"));
        Ok(())
    }

    fn position(&mut self, position: &Position, comment: Option<&str>) -> Result<(), String> {
        let numbers = numbers(position);
        let frames = format!("UF : {}, UT : {},", self.frame, self.tool);
        let rows = |fields: Vec<String>| fields.chunks(3).map(|row| row.join(",\t")).collect::<Vec<_>>().join(",\n\t");
        let external = position.external.iter().enumerate().map(|(i, value)| {
            format!("E{}= {:>9}  mm", i + 1, value.map_or("********".to_owned(), |value| fixed(value, 3)))
        });
        let (head, mut fields) = match &position.target {
            Target::Joints(_) => {
                let fields = (1..).zip(&numbers).map(|(i, number)| format!("J{i}= {number:>9} deg"));
                (format!("\t{frames}\t\n"), fields.collect::<Vec<_>>())
            }
            Target::Pose(_, Some(Configuration::Fanuc { flip, left, up, front, turns })) => {
                let letter = |is: bool, yes: &'static str, no: &'static str| if is { yes } else { no };
                let arm = left.map_or("", |left| letter(left, "L ", "R "));
                let letters = [letter(*flip, "F", "N"), " ", arm, letter(*up, "U", "D"), " ", letter(*front, "T", "B")];
                let [a, b, c] = turns;
                let units = ["mm", "mm", "mm", "deg", "deg", "deg"];
                let fields = POSE.iter().zip(&numbers).zip(units);
                let fields = fields.map(|((name, number), unit)| format!("{name} = {number:>9} {unit:>3}"));
                (format!("\t{frames}\t\tCONFIG : '{}, {a}, {b}, {c}',\n", letters.concat()), fields.collect())
            }
            Target::Pose(..) => {
                return Err("a pose needs its CONFIG: give it, or the angles of the joints".to_owned());
            }
        };
        fields.extend(external);
        self.points += 1;
        let comment = comment.map(|comment| format!(":\"{comment}\"")).unwrap_or_default();
        self.positions += &format!("P[{}{comment}]{{\n   GP1:\n{head}\t{}\n}};\n", self.points, rows(fields));
        Ok(())
    }
}

fn pose_numbers(pose: &Isometry3<f64>) -> Vec<String> {
    numbers(&Position::from(Target::Pose(*pose, None)))
}
