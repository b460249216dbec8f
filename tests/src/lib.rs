//! Support for the tests: the arms they generate code for, a common measure of
//! agreement, an interpreter of generated code, a simulator that shares no
//! formula with the library, a matrix of simulated campaigns to judge tracing
//! by, and the targets of fuzzing.

pub mod arms;
pub mod folder;
pub mod fuzz;
pub mod interpreter;
pub mod judge;
pub mod judge_tracing;
pub mod matrix;
pub mod parallel;
pub mod positions;
pub mod reach;
pub mod reliability;
pub mod simulator;
