//! G-code, block by block.

use std::collections::VecDeque;

use super::fault::Fault;
use super::lex::Block;
use super::modal::{FeedMode, Motion, Once, Tcp};
use super::moves::{Move, OFFSETS, Options, tool_number};
use super::notes::{Note, Notes};
use super::state::{LINEAR, ROTARY, State};

/// What is between blocks.
pub struct GCode<'o> {
    state: State<'o>,
    next_tool: Option<u32>,
    block: Block,
    begun: bool,
    ended: bool,
}

impl<'o> GCode<'o> {
    /// The state that programs begin in.
    pub fn new(options: &'o Options) -> Self {
        Self { state: State::new(options), next_tool: None, block: Block::default(), begun: false, ended: false }
    }

    /// Reads a line, and puts its moves behind those in a queue. `false` behind the end of the
    /// program.
    ///
    /// # Errors
    /// What is wrong with the line.
    pub fn line(
        &mut self,
        number: usize,
        text: &str,
        moves: &mut VecDeque<Move>,
        notes: &mut Notes,
    ) -> Result<bool, Fault> {
        if self.ended {
            return Ok(notes.behind(matches!(text.trim(), "" | "%"), number));
        }
        let mut block = core::mem::take(&mut self.block);
        let read = block.read(text).and_then(|marks| {
            if marks.percent {
                self.ended = self.begun;
                return Ok(());
            }
            if marks.deletable {
                notes.add(Note::Deletable, number);
            }
            self.begun |= !block.is_empty();
            self.block(number, &block, moves, notes)
        });
        self.block = block;
        read.map(|()| true)
    }

    fn block(
        &mut self,
        line: usize,
        block: &Block,
        moves: &mut VecDeque<Move>,
        notes: &mut Notes,
    ) -> Result<(), Fault> {
        let (mut groups, mut once, before) = (0, None, self.state.modal.clone());
        for word in &block.g {
            once = self.state.modal.take(word, &mut groups)?.or(once);
        }
        let ends = self.functions(line, block, notes)?;
        self.state.change_tcp(&before);
        if before.feed_mode != self.state.modal.feed_mode {
            self.state.feed = None;
        }
        let offset = self.state.modal.offset;
        // G54 is where programs begin.
        if before.offset != offset && offset > 1 && self.state.options.offsets[offset].is_none() {
            notes.add(Note::Offset(OFFSETS[offset]), line);
        }
        self.feed_and_speed(block)?;
        self.check_words(block, once)?;
        let has_axes = LINEAR.iter().chain(&ROTARY).any(|letter| block.word(*letter).is_some());
        let moved = match once {
            Some(Once::Dwell | Once::Smoothing) => Ok(()),
            Some(Once::Home(tenths)) => {
                self.state.home(line, block, tenths, notes);
                Ok(())
            }
            Some(Once::Machine) if !self.state.machine_is_known() => {
                if has_axes {
                    self.state.home(line, block, 530, notes);
                }
                Ok(())
            }
            _ => self.state.movement(line, block, &before, once, (moves, notes)),
        };
        self.ended |= ends;
        moved
    }

    /// M words; whether the program ends.
    fn functions(&mut self, line: usize, block: &Block, notes: &mut Notes) -> Result<bool, Fault> {
        let mut ends = false;
        if let Some(word) = block.word(b'T') {
            let Some(number) = tool_number(word.value) else {
                return Err(word.fault("a tool has a whole number", "e.g. `T3`"));
            };
            self.next_tool = Some(number);
        }
        for word in &block.m {
            match word.tenths() {
                Some(30 | 40) => self.state.sense = if word.value < 3.5 { 1.0 } else { -1.0 },
                Some(50) => self.state.sense = 0.0,
                Some(60) => self.state.tool = self.next_tool.or(self.state.tool),
                Some(20 | 300) => ends = true,
                Some(1280 | 4280) => self.state.modal.tcp = Tcp::ByFunction,
                Some(1290 | 4290) => self.state.modal.tcp = Tcp::Off,
                Some(970 | 980 | 990) => {
                    return Err(word.fault(
                        "subprograms (M97, M98, M99) are not followed",
                        "have the CAM system write the moves one after another",
                    ));
                }
                // Stops, coolant, clamps, orientation of the spindle, overrides.
                Some(0 | 10 | 70 | 80 | 90 | 100 | 110 | 190 | 480..=530 | 600) => {}
                Some(tenths) => notes.add(Note::Function(tenths), line),
                None => {
                    return Err(word.fault(format!("M{} is not known", word.value), "an M code is a number from 0 on"));
                }
            }
        }
        Ok(ends)
    }

    fn feed_and_speed(&mut self, block: &Block) -> Result<(), Fault> {
        if let Some(word) = block.word(b'F') {
            if word.value < 0.0 {
                return Err(word.fault("the feed is below zero", "how fast the tool moves, e.g. `F1200`"));
            }
            self.state.feed = (word.value > 0.0).then_some([word.value, word.value * self.state.unit()]);
        } else if self.state.modal.feed_mode == FeedMode::Inverse {
            // Each block has its time.
            self.state.feed = None;
        }
        if let Some(word) = block.word(b'S') {
            if word.value < 0.0 {
                return Err(word.fault("the speed of the spindle is below zero", "M4 turns it the other way"));
            }
            self.state.speed = word.value * core::f64::consts::TAU / 60.0;
        }
        Ok(())
    }

    /// Refuses words that the block has no use for.
    fn check_words(&self, block: &Block, once: Option<Once>) -> Result<(), Fault> {
        let motion = self.state.modal.motion;
        let (is_arc, is_cycle) = (matches!(motion, Motion::Arc { .. }), matches!(motion, Motion::Cycle(_)));
        let is_line = matches!(motion, Motion::Rapid | Motion::Feed);
        let stays = matches!(once, Some(Once::Dwell | Once::Smoothing));
        let smooths = block.g.iter().any(|word| matches!(word.tenths(), Some(640 | 610 | 611)));
        for word in block.words() {
            let has_use = match word.letter {
                b'N' | b'F' | b'S' | b'T' | b'H' | b'D' => true,
                // The seconds of a dwell.
                b'X' | b'U' if once == Some(Once::Dwell) => true,
                b'X' | b'Y' | b'Z' | b'A' | b'B' | b'C' => !stays,
                b'I' | b'J' | b'K' => is_arc || is_line && self.state.modal.tcp == Tcp::Vector,
                b'R' => is_arc || is_cycle || once == Some(Once::Smoothing),
                b'P' => is_arc || is_cycle || stays || smooths,
                b'Q' => is_cycle || smooths || once == Some(Once::Smoothing),
                b'L' => is_cycle,
                _ => false,
            };
            if !has_use {
                let letter = char::from(word.letter);
                let help = match word.letter {
                    b'U' | b'V' | b'W' => "axes beside X, Y, Z, A, B, C are not followed",
                    _ => "take it out, or name the code that it belongs to in its block",
                };
                return Err(word.fault(format!("`{letter}` has no meaning here"), help));
            }
        }
        Ok(())
    }
}
