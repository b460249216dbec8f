//! Programs that are made up, and how near to them they come back.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

use crate::program::{
    Configuration, Document, Frame, Instruction, Language, Motion, Move, Position, Program, Speed, Target, TextFile,
    Zone,
};

/// A number of decimals of a unit.
fn rounded(range: std::ops::Range<f64>, step: f64) -> impl Strategy<Value = f64> {
    range.prop_map(move |value| (value / step).round() * step)
}

/// Poses within 5 m; one in four with an orientation at which angles are not determined.
pub fn pose() -> impl Strategy<Value = Isometry3<f64>> {
    let place = prop::array::uniform3(-5.0..5.0);
    let turn = prop_oneof![
        3 => prop::array::uniform3(-3.2..3.2).prop_map(|v| UnitQuaternion::new(Vector3::from(v))),
        1 => (-180i32..180, -2i32..=2, -180i32..180).prop_map(|(a, b, c)| {
            let [a, b, c] = [a, 90 * b, c].map(|degrees| f64::from(degrees).to_radians());
            UnitQuaternion::from_euler_angles(c, b, a)
        }),
    ];
    (place, turn).prop_map(|([x, y, z], turn)| Isometry3::from_parts(Translation3::new(x, y, z), turn))
}

pub fn configuration(language: Language) -> BoxedStrategy<Option<Configuration>> {
    match language {
        Language::Krl => prop::option::of((0u32..8, 0u32..64))
            .prop_map(|bits| bits.map(|(status, turn)| Configuration::Kuka { status: Some(status), turn: Some(turn) }))
            .boxed(),
        Language::Rapid => prop::array::uniform4(-4i32..4).prop_map(|parts| Some(Configuration::Abb(parts))).boxed(),
        Language::Ls => (any::<bool>(), prop::option::of(any::<bool>()), any::<bool>(), any::<bool>())
            .prop_flat_map(|(flip, left, up, front)| {
                prop::array::uniform3(-2i32..3)
                    .prop_map(move |turns| Some(Configuration::Fanuc { flip, left, up, front, turns }))
            })
            .boxed(),
        Language::Ur => Just(None).boxed(),
    }
}

fn position(language: Language, motion: Motion) -> BoxedStrategy<Position> {
    let most_external = if language == Language::Ur { 0 } else { 2 };
    let external = prop::collection::vec(rounded(-900.0..900.0, 1e-3).prop_map(Some), 0..=most_external);
    let pose = (pose(), configuration(language)).prop_map(|(pose, which)| Target::Pose(pose, which));
    let joints = prop::collection::vec(-6.0..6.0, 6).prop_map(Target::Joints);
    let linear_joints = matches!(language, Language::Ls | Language::Ur);
    let target = match motion {
        Motion::Linear if !linear_joints => pose.boxed(),
        _ => prop_oneof![pose, joints].boxed(),
    };
    (target, external).prop_map(|(target, external)| Position { target, external }).boxed()
}

fn speed(language: Language, motion: Motion) -> BoxedStrategy<Speed> {
    let tool = (1u32..2000).prop_map(|mm| Speed::Tool(f64::from(mm) * 1e-3));
    let share = (1u32..=100).prop_map(|percent| Speed::Share(f64::from(percent) * 1e-2));
    match (language, motion) {
        (Language::Krl | Language::Ls, Motion::Joint) => share.boxed(),
        (Language::Ur, Motion::Joint) => (1u32..3000).prop_map(|mrad| Speed::Joints(f64::from(mrad) * 1e-3)).boxed(),
        _ => tool.boxed(),
    }
}

fn zone(language: Language) -> BoxedStrategy<Zone> {
    let within = (1u32..500).prop_map(|tenths| Zone::Within(f64::from(tenths) * 1e-4));
    let share = (0u32..=100).prop_map(|percent| Zone::Share(f64::from(percent) * 1e-2));
    match language {
        Language::Krl => prop_oneof![Just(Zone::Fine), within, share].boxed(),
        Language::Rapid | Language::Ur => prop_oneof![Just(Zone::Fine), within].boxed(),
        Language::Ls => prop_oneof![Just(Zone::Fine), share].boxed(),
    }
}

fn motion(language: Language) -> BoxedStrategy<Instruction> {
    prop_oneof![Just(Motion::Joint), Just(Motion::Linear)]
        .prop_flat_map(move |motion| {
            (Just(motion), position(language, motion), speed(language, motion), zone(language))
        })
        .prop_map(|(motion, position, speed, zone)| {
            Instruction::Move(Move { speed: Some(speed), zone, ..Move::to(motion, position) })
        })
        .boxed()
}

/// A statement of the language.
pub fn statement(language: Language) -> &'static str {
    match language {
        Language::Krl => "$OUT[12]=TRUE ; spindle on",
        Language::Rapid => "SetDO doSpindle,1;",
        Language::Ls => "DO[12:spindle]=ON",
        Language::Ur => "set_digital_out(3, True) # spindle on",
    }
}

/// Programs that begin with a tool and a work frame.
pub fn program(language: Language) -> impl Strategy<Value = Program> {
    let instruction = prop_oneof![8 => motion(language), 1 => Just(Instruction::statement(statement(language)))];
    let frames = (pose(), pose(), 1u32..9).prop_map(move |(tool, work, number)| frames(language, tool, work, number));
    (frames, prop::collection::vec(instruction, 0..12)).prop_map(|(mut instructions, rest)| {
        instructions.extend(rest);
        Program { name: "PART_7".to_owned(), instructions }
    })
}

fn frames(language: Language, tool: Isometry3<f64>, work: Isometry3<f64>, number: u32) -> Vec<Instruction> {
    let frame = |name: String, pose| Frame { name, pose };
    match language {
        Language::Krl => vec![
            Instruction::Tool(frame(number.to_string(), Some(tool))),
            Instruction::Work(frame(String::new(), Some(work))),
        ],
        Language::Rapid | Language::Ur => vec![
            Instruction::Tool(frame("tSpindle".to_owned(), Some(tool))),
            Instruction::Work(frame("wPart".to_owned(), Some(work))),
        ],
        Language::Ls => vec![
            Instruction::Tool(frame(number.to_string(), None)),
            Instruction::Work(frame((number - 1).to_string(), None)),
        ],
    }
}

/// Digits: of lengths (m) and of angles (rad) half of the last one, and a little.
#[derive(Clone, Copy)]
pub struct Digits {
    pub length: f64,
    pub angle: f64,
}

/// Whether two programs are the same to the digits that are written.
///
/// # Errors
/// What differs.
pub fn same(written: &Program, read: &Program, digits: Digits) -> Result<(), String> {
    if written.name != read.name || written.instructions.len() != read.instructions.len() {
        return Err(format!("{written:#?}\n{read:#?}"));
    }
    for (a, b) in written.instructions.iter().zip(&read.instructions) {
        let alike = match (a, b) {
            (Instruction::Move(a), Instruction::Move(b)) => {
                near(&a.position, &b.position, digits) && b.line > 0 && close(a, b)
            }
            (Instruction::Tool(a), Instruction::Tool(b)) | (Instruction::Work(a), Instruction::Work(b)) => {
                a.name == b.name && a.pose.is_some() == b.pose.is_some() && {
                    let poses = a.pose.zip(b.pose);
                    poses.is_none_or(|(a, b)| near_pose(&a, &b, digits))
                }
            }
            (Instruction::Statement { text: a, .. }, Instruction::Statement { text: b, .. }) => a == b,
            _ => false,
        };
        if !alike {
            return Err(format!("{a:#?}\n{b:#?}"));
        }
    }
    Ok(())
}

/// Whether motion, speed, zone and options are the same.
fn close(a: &Move, b: &Move) -> bool {
    let number = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(1.0);
    let speed = match (&a.speed, &b.speed) {
        (Some(Speed::Tool(a)), Some(Speed::Tool(b)))
        | (Some(Speed::Joints(a)), Some(Speed::Joints(b)))
        | (Some(Speed::Share(a)), Some(Speed::Share(b))) => number(*a, *b),
        (a, b) => a == b,
    };
    let zone = match (&a.zone, &b.zone) {
        (Zone::Within(a), Zone::Within(b)) | (Zone::Share(a), Zone::Share(b)) => number(*a, *b),
        (a, b) => a == b,
    };
    speed && zone && a.motion == b.motion && a.options == b.options
}

fn near_pose(a: &Isometry3<f64>, b: &Isometry3<f64>, digits: Digits) -> bool {
    let apart = (a.translation.vector - b.translation.vector).amax();
    apart <= digits.length && a.rotation.angle_to(&b.rotation) <= digits.angle
}

/// Whether two positions are the same to these digits.
pub fn near(a: &Position, b: &Position, digits: Digits) -> bool {
    let targets = match (&a.target, &b.target) {
        (Target::Joints(a), Target::Joints(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= digits.angle)
        }
        (Target::Pose(a, x), Target::Pose(b, y)) => x == y && near_pose(a, b, digits),
        _ => false,
    };
    let external = |position: &Position| position.external.iter().map(|value| value.unwrap_or(0.0)).collect::<Vec<_>>();
    let (x, y) = (external(a), external(b));
    targets && x.len() == y.len() && x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-3)
}

/// A text as a file.
pub fn file(name: &str, text: &str) -> TextFile {
    TextFile { name: name.to_owned(), text: text.to_owned() }
}

/// Gives every position of a document another one, and checks that the files then say
/// this, and that the old ones give the old bytes.
///
/// # Errors
/// What differs.
pub fn edits(document: &Document, moved: impl Fn(&Position) -> Position, digits: Digits) -> Result<(), String> {
    let old: Vec<Position> = document.moves().map(|to| to.position.clone()).collect();
    let same = document.with_positions(&old).map_err(|shared| shared.to_string())?;
    if same != document.files() {
        return Err("the same positions give other files".to_owned());
    }
    let new: Vec<Position> = old.iter().map(moved).collect();
    let files = document.with_positions(&new).map_err(|shared| shared.to_string())?;
    let read = crate::program::read(document.language(), files.clone()).map_err(|problems| problems.to_string())?;
    for (new, read) in new.iter().zip(read.moves()) {
        if !near(new, &read.position, digits) {
            return Err(format!("{new:?}\n{:?}\n{}", read.position, files[0].text));
        }
    }
    Ok(())
}

/// A position moved by a little.
pub fn moved(position: &Position) -> Position {
    let target = match &position.target {
        Target::Joints(angles) => Target::Joints(angles.iter().map(|angle| angle + 1e-3).collect()),
        Target::Pose(pose, which) => {
            let shift = Translation3::new(1e-4, -2e-4, 3e-4);
            let turn = UnitQuaternion::new(Vector3::new(1e-3, 2e-3, -1e-3));
            Target::Pose(Isometry3::from_parts(shift * pose.translation, turn * pose.rotation), *which)
        }
    };
    Position { target, external: position.external.clone() }
}

/// The lines of the motions that are kept as they are.
pub fn kept_lines(document: &Document) -> Vec<usize> {
    let line = |one: &Instruction| match one {
        Instruction::KeptMove { line, .. } => Some(*line),
        _ => None,
    };
    document.program().instructions.iter().filter_map(line).collect()
}
