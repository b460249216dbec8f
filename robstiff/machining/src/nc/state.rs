//! Where a G-code program has got to, and how its blocks move.

use core::cell::Cell;
use std::collections::VecDeque;

use nalgebra::{Unit, Vector3};

use super::arc::{Arc, Given};
use super::cycle::{Hole, Step, steps};
use super::fault::Fault;
use super::lex::{Block, Word};
use super::machine::Angles;
use super::modal::{FeedMode, Modal, Motion, Once, Tcp};
use super::moves::{Move, Options};
use super::notes::{Note, Notes};
use super::track::{Common, MOST_PARTS, Pace, Shape, Turn, split};

/// What stays from block to block.
pub struct State<'o> {
    /// How the program is read.
    pub options: &'o Options,
    /// Codes that stay.
    pub modal: Modal,
    /// Where the machine is, or the tip with TCP (m); none of what is not known.
    at: [Option<f64>; 3],
    angles: [Option<f64>; 3],
    /// The tool's axis that I J K of G43.5 have given.
    axis: Option<Unit<Vector3<f64>>>,
    /// The number of F, and what it is in m.
    pub feed: Option<[f64; 2]>,
    /// The number of S as rad/s.
    pub speed: f64,
    /// Clockwise 1, the other way -1, 0 where the spindle stands.
    pub sense: f64,
    /// The tool that is changed to.
    pub tool: Option<u32>,
    cycle: Cycle,
    /// Whether it is said that no machine is named: once is enough.
    lacks_machine: Cell<bool>,
}

/// What stays of a drilling cycle: words as they were given, and where it began (m).
#[derive(Clone, Copy, Debug, Default)]
struct Cycle {
    z: Option<f64>,
    r: Option<f64>,
    peck: f64,
    initial: f64,
}

/// Where a block leads.
#[derive(Clone, Copy)]
struct Goal {
    at: [Option<f64>; 3],
    angles: [Option<f64>; 3],
    axis: Option<Unit<Vector3<f64>>>,
}

/// Linear axes.
pub const LINEAR: [u8; 3] = *b"XYZ";
/// Rotary axes.
pub const ROTARY: [u8; 3] = *b"ABC";
const CENTER: [u8; 3] = *b"IJK";

/// Holes that one block may drill.
const MOST_HOLES: f64 = 1e4;

impl<'o> State<'o> {
    /// The state that programs begin in.
    pub fn new(options: &'o Options) -> Self {
        Self {
            options,
            modal: Modal::default(),
            at: [None; 3],
            angles: [Some(0.0); 3],
            axis: None,
            feed: None,
            speed: 0.0,
            sense: 0.0,
            tool: None,
            cycle: Cycle::default(),
            lacks_machine: Cell::new(false),
        }
    }

    /// The unit of lengths (m).
    pub fn unit(&self) -> f64 {
        self.modal.unit.unwrap_or(1e-3)
    }

    /// Whether G53 can be followed.
    pub fn machine_is_known(&self) -> bool {
        self.options.offsets[0].is_some() && (self.options.machine.is_none() || !self.has_tcp())
    }

    fn has_tcp(&self) -> bool {
        self.options.tcp.unwrap_or(self.modal.tcp != Tcp::Off)
    }

    /// With TCP a position is that of the tip on the workpiece, without where the machine is sent.
    pub fn change_tcp(&mut self, before: &Modal) {
        if self.modal.tcp != Tcp::Vector {
            self.axis = None;
        }
        let had = self.options.tcp.unwrap_or(before.tcp != Tcp::Off);
        let (Some(machine), true) = (&self.options.machine, had != self.has_tcp()) else { return };
        let ([Some(x), Some(y), Some(z)], [Some(a), Some(b), Some(c)]) = (self.at, self.angles) else { return };
        let at = Vector3::new(x, y, z);
        let at = if had { machine.sent(at, [a, b, c]) } else { machine.tip(at, [a, b, c]) };
        self.at = at.data.0[0].map(Some);
    }

    /// What a move to a place of the machine leaves unknown.
    pub fn home(&mut self, line: usize, block: &Block, tenths: u32, notes: &mut Notes) {
        notes.add(Note::Home(tenths), line);
        let named = |letter: &u8| block.word(*letter).is_some();
        let all = !LINEAR.iter().chain(&ROTARY).any(named);
        for i in 0..3 {
            if all || named(&LINEAR[i]) {
                self.at[i] = None;
            }
            let turns = self.options.machine.as_ref().is_some_and(|machine| machine.has(i));
            if turns && (all || named(&ROTARY[i])) {
                self.angles[i] = None;
            }
        }
    }

    /// Where the words of a block lead.
    fn goal(&self, block: &Block, once: Option<Once>) -> Result<Goal, Fault> {
        let mut goal = Goal { at: self.at, angles: self.angles, axis: self.axis };
        let index = if once == Some(Once::Machine) { 0 } else { self.modal.offset };
        let zero = self.options.offsets[index].unwrap_or_default();
        let relative = |word: &Word, from: Option<f64>, value: f64| {
            from.map(|from| from + value).ok_or_else(|| {
                let message = format!("`{}` counts from a position that is not known (G91)", char::from(word.letter));
                word.fault(message, "name X, Y and Z with G90 before")
            })
        };
        let incremental = self.modal.incremental && once != Some(Once::Machine);
        for i in 0..3 {
            if let Some(word) = block.word(LINEAR[i]) {
                let length = word.value * self.unit();
                goal.at[i] = Some(if incremental { relative(word, self.at[i], length)? } else { length + zero[i] });
            }
            if let Some(word) = block.word(ROTARY[i]) {
                let angle = word.value.to_radians();
                let angle = if incremental { relative(word, self.angles[i], angle)? } else { angle };
                if angle != 0.0 {
                    self.check_rotary(word, i)?;
                }
                goal.angles[i] = Some(angle);
            }
        }
        if self.modal.tcp == Tcp::Vector && CENTER.iter().any(|letter| block.word(*letter).is_some()) {
            let [i, j, k] = CENTER.map(|letter| block.value(letter).unwrap_or(0.0));
            let axis = Unit::try_new(Vector3::new(i, j, k), 1e-6);
            let word = CENTER.iter().find_map(|letter| block.word(*letter));
            goal.axis = Some(axis.ok_or_else(|| fault(word, "the tool's axis has no direction", "e.g. `I0 J0 K1`"))?);
        }
        Ok(goal)
    }

    fn check_rotary(&self, word: &Word, axis: usize) -> Result<(), Fault> {
        let letter = char::from(word.letter);
        let Some(machine) = &self.options.machine else {
            if self.lacks_machine.replace(true) {
                return Ok(());
            }
            return Err(word.fault(
                format!("`{letter}` turns the tool or the workpiece, and which is not known"),
                "name the machine: `--machine xyzac-trt`, `--machine \"table A C\"`, `--machine \"head C B\"`",
            ));
        };
        if !machine.has(axis) {
            return Err(word.fault(format!("the machine has no axis {letter}"), "name all its axes by `--machine`"));
        }
        match machine.lacks().filter(|_| !self.has_tcp()) {
            Some(lacks) => Err(word.fault(
                format!("`{letter}` turns without TCP, and it is not known {lacks}"),
                "give that, or `--tcp on` if the coordinates are those of the tip on the workpiece",
            )),
            None => Ok(()),
        }
    }

    /// Moves as the words of a block say; `before` is what stayed from the one before it.
    ///
    /// # Errors
    /// What is wrong with the block.
    pub fn movement(
        &mut self,
        line: usize,
        block: &Block,
        before: &Modal,
        once: Option<Once>,
        (moves, notes): (&mut VecDeque<Move>, &mut Notes),
    ) -> Result<(), Fault> {
        let words = LINEAR.iter().chain(&ROTARY).chain(&CENTER);
        let first = words.filter_map(|letter| block.word(*letter)).min_by_key(|word| word.at);
        let motion = self.modal.motion;
        let names = block.g.iter().find(|word| matches!(word.tenths(), Some(20 | 30 | 730 | 810..=890)));
        let Some(word) = first.or(names) else { return Ok(()) };
        if self.modal.unit.is_none() && LINEAR.iter().any(|letter| block.word(*letter).is_some()) {
            notes.add(Note::Unit, line);
            // Noted once.
            self.modal.unit = Some(1e-3);
        }
        let mut out = Out { line, word, moves, notes };
        match motion {
            Motion::None => {
                Err(word.fault("the block has axes, and no code says how they move", "begin with G0, G1, G2 or G3"))
            }
            Motion::Cycle(code) => self.drill(&mut out, block, before, code),
            Motion::Rapid | Motion::Feed => {
                let goal = self.goal(block, once)?;
                let done = self.pace(&out, motion).and_then(|pace| self.go(&mut out, &goal, pace, None));
                // What follows begins there, whatever is wrong with this block.
                (self.at, self.angles, self.axis) = (goal.at, goal.angles, goal.axis);
                done
            }
            Motion::Arc { clockwise } => {
                let goal = self.goal(block, once)?;
                let done = self.arc(&out, block, &goal, clockwise).and_then(|arc| {
                    let pace = self.pace(&out, motion)?;
                    self.go(&mut out, &goal, pace, Some(arc))
                });
                (self.at, self.angles, self.axis) = (goal.at, goal.angles, goal.axis);
                done
            }
        }
    }

    fn pace(&self, out: &Out<'_>, motion: Motion) -> Result<Pace, Fault> {
        if motion == Motion::Rapid {
            return Ok(Pace::Rapid);
        }
        let missing = |message: &str, help: &str| Err(out.word.fault(message, help));
        let Some([number, length]) = self.feed else {
            return match self.modal.feed_mode {
                FeedMode::Inverse => missing("a block with G93 has its own F", "the moves of the block a minute"),
                _ => missing("the move has no feed", "how fast the tool moves, e.g. `F1200`"),
            };
        };
        match self.modal.feed_mode {
            FeedMode::Inverse => Ok(Pace::Time(60.0 / number)),
            FeedMode::PerMinute => Ok(Pace::Speed(length / 60.0, number.to_radians() / 60.0)),
            FeedMode::PerRevolution => {
                let turns = self.speed * self.sense.abs() / core::f64::consts::TAU;
                if turns > 0.0 {
                    return Ok(Pace::Speed(length * turns, number.to_radians() * turns));
                }
                missing("the feed is per revolution (G95), and the spindle stands", "give S and M3 before")
            }
        }
    }

    fn arc(&self, out: &Out<'_>, block: &Block, goal: &Goal, clockwise: bool) -> Result<Arc, Fault> {
        let ([Some(x), Some(y), Some(z)], [Some(to_x), Some(to_y), Some(to_z)]) = (self.at, goal.at) else {
            return Err(out.word.fault("the arc begins where nobody knows", "name X, Y and Z by G0 or G1 before"));
        };
        let (from, to) = (Vector3::new(x, y, z), Vector3::new(to_x, to_y, to_z));
        let sense = if clockwise { -1.0 } else { 1.0 };
        let turns = match block.word(b'P') {
            None => 0,
            Some(word) if word.value.fract() == 0.0 && (1.0..=1e4).contains(&word.value) => word.value as u32 - 1,
            Some(word) => return Err(word.fault("P is the number of turns", "a whole number from 1 to 10000")),
        };
        let given = Given { from, to, axis: Vector3::ith(self.modal.across, sense), turns };
        let center = CENTER.map(|letter| block.word(letter));
        let radius = block.word(b'R');
        let in_plane = (0..3).filter(|axis| *axis != self.modal.across);
        let arc = match (center.iter().flatten().next(), radius) {
            (Some(_), Some(word)) => {
                return Err(word.fault("the arc has a centre and a radius", "keep I, J, K or R"));
            }
            (None, None) => {
                return Err(out.word.fault("the arc has no centre and no radius", "give I, J, K or R"));
            }
            (None, Some(word)) => {
                Arc::of_radius(&given, word.value * self.unit()).map_err(|why| word.fault(why, ""))?
            }
            (Some(word), None) => {
                let mut at = from;
                for axis in in_plane {
                    let offset = center[axis].map(|word| word.value * self.unit());
                    at[axis] = match (offset, self.modal.absolute_centers) {
                        (Some(center), true) => {
                            center + self.options.offsets[self.modal.offset].unwrap_or_default()[axis]
                        }
                        (None, true) => {
                            let help = "both count from zero (G90.1)";
                            return Err(word.fault("the centre of the arc has one coordinate", help));
                        }
                        (offset, false) => from[axis] + offset.unwrap_or(0.0),
                    };
                }
                Arc::about(&given, at)
                    .map_err(|why| word.fault(why, "centres count from the start (G91.1) or from zero (G90.1)"))?
            }
        };
        if let Some(word) = center[self.modal.across] {
            return Err(word.fault("this centre is across the plane of the arc", "G17 has I J, G18 I K, G19 J K"));
        }
        Ok(arc)
    }

    fn go(&self, out: &mut Out<'_>, goal: &Goal, pace: Pace, arc: Option<Arc>) -> Result<(), Fault> {
        let (Some(to), Some(to_angles)) = (known(goal.at), known(goal.angles)) else {
            if pace != Pace::Rapid {
                out.notes.add(Note::Before, out.line);
            }
            return Ok(());
        };
        let (from, from_angles) = (known(self.at), known(self.angles));
        let is_first = from.is_none() || from_angles.is_none();
        let (from, from_angles) = (from.unwrap_or(to), from_angles.unwrap_or(to_angles));
        let up = |axis: Option<Unit<Vector3<f64>>>, angles: Angles| {
            let of_machine = || self.options.machine.as_ref().map_or(Vector3::z_axis(), |machine| machine.axis(angles));
            axis.unwrap_or_else(of_machine)
        };
        let turn = match &self.options.machine {
            _ if goal.axis.is_some() => Turn::Axis(up(self.axis, from_angles), up(goal.axis, to_angles)),
            None => Turn::Axis(Vector3::z_axis(), Vector3::z_axis()),
            Some(machine) if self.has_tcp() => Turn::Tcp(machine, from_angles, to_angles),
            Some(machine) => Turn::Sent(machine, from_angles, to_angles),
        };
        let shape = arc.map_or(Shape::Line(from.into(), to.into()), Shape::Arc);
        let common = Common { line: out.line, pace, spindle: self.speed * self.sense, tool: self.tool };
        split(out.moves, common, &shape, &turn, is_first, self.options.arc_tolerance).map_err(|parts| {
            out.word.fault(
                format!("the move takes {parts:.0} chords, more than {MOST_PARTS:.0}"),
                "allow for a larger `--arc-tolerance`",
            )
        })
    }

    fn drill(&mut self, out: &mut Out<'_>, block: &Block, before: &Modal, code: u32) -> Result<(), Fault> {
        let across = self.modal.across;
        let (level, unit) = (self.at[across], self.unit());
        if !matches!(before.motion, Motion::Cycle(_)) {
            let Some(level) = level else {
                return Err(out.word.fault("the cycle begins where nobody knows", "name X, Y and Z by G0 before"));
            };
            self.cycle = Cycle { initial: level, ..Cycle::default() };
        }
        if self.modal.feed_mode == FeedMode::Inverse {
            return Err(out.word.fault("a cycle has no inverse time (G93)", "use G94 or G95"));
        }
        let zero = self.options.offsets[self.modal.offset].unwrap_or_default()[across];
        let length = |letter: u8| block.value(letter).map(|value| value * unit);
        self.cycle.z = length(LINEAR[across]).or(self.cycle.z);
        self.cycle.r = length(b'R').or(self.cycle.r);
        self.cycle.peck = length(b'Q').unwrap_or(self.cycle.peck);
        let Cycle { z: Some(z), r: Some(r), peck, initial } = self.cycle else {
            let message = format!("G{code} needs the bottom of the hole, {}, and R", char::from(LINEAR[across]));
            return Err(out.word.fault(message, "e.g. `G81 X10 Y5 Z-12 R2 F200`"));
        };
        let incremental = self.modal.incremental;
        let r = if incremental { initial + r } else { zero + r };
        let z = if incremental { r + z } else { zero + z };
        let back = if self.modal.to_r { r } else { initial.max(r) };
        let steps = steps(&Hole { code, r, z, peck, back }).map_err(|why| out.word.fault(why, ""))?;
        let count = match block.word(b'L') {
            None => 1.0,
            Some(word) if word.value.fract() == 0.0 && (0.0..=MOST_HOLES).contains(&word.value) => word.value,
            Some(word) => return Err(word.fault("L is the number of holes", "a whole number from 0 to 10000")),
        };
        let feed = self.pace(out, Motion::Feed)?;
        for _ in 0..count as usize {
            let mut goal = self.goal(block, None)?;
            let level = self.at[across];
            // Never sideways below R.
            if level.is_some_and(|level| level < r) {
                let mut up = Goal { at: self.at, angles: self.angles, axis: self.axis };
                up.at[across] = Some(r);
                self.step(out, &up, Pace::Rapid)?;
            }
            goal.at[across] = self.at[across];
            self.step(out, &goal, Pace::Rapid)?;
            for step in &steps {
                let (to, pace) = match *step {
                    Step::Rapid(to) => (to, Pace::Rapid),
                    Step::Feed(to) => (to, feed),
                };
                goal.at[across] = Some(to);
                self.step(out, &goal, pace)?;
            }
        }
        Ok(())
    }

    /// One move of a cycle, unless the tool is there.
    fn step(&mut self, out: &mut Out<'_>, goal: &Goal, pace: Pace) -> Result<(), Fault> {
        if goal.at != self.at || goal.angles != self.angles {
            self.go(out, goal, pace, None)?;
            (self.at, self.angles, self.axis) = (goal.at, goal.angles, goal.axis);
        }
        Ok(())
    }
}

/// Where the moves of a block go to.
struct Out<'b> {
    line: usize,
    /// What a problem with the move is shown at.
    word: &'b Word,
    moves: &'b mut VecDeque<Move>,
    notes: &'b mut Notes,
}

fn known(all: [Option<f64>; 3]) -> Option<[f64; 3]> {
    let [x, y, z] = all;
    Some([x?, y?, z?])
}

fn fault(word: Option<&Word>, message: &str, help: &str) -> Fault {
    word.map_or_else(|| Fault::whole("", message, help), |word| word.fault(message, help))
}
