//! Programs of machine tools, move by move: G-code, and APT or CLDATA.
//!
//! A [`Reader`] goes through a program once and gives its [`Move`]s in the frame of the path:
//! the tip of the tool, its axis, rapid or feed. Arcs are split into chords, drilling cycles into
//! their moves. What is not understood is an error at its line and column; what is left out by
//! decision is a warning that names its lines.
//!
//! G-code is that of RS-274/NGC as LinuxCNC documents it, and Fanuc's, where both agree or a code is
//! of one of them only. Rotary axes are those of a [`Machine`].

mod apt;
mod arc;
mod cycle;
mod fault;
mod gcode;
mod lex;
mod machine;
mod modal;
mod moves;
mod notes;
mod reader;
mod state;
mod statement;
#[cfg(test)]
mod tests;
mod track;

pub use machine::{Machine, Rotary};
pub use moves::{Move, OFFSETS, Options};
pub use reader::{Format, Reader};
