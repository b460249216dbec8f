//! Support for the tests: the arms they generate code for, a common measure of
//! agreement, an interpreter of generated code, and a simulator that shares no
//! formula with the library.

pub mod arms;
pub mod interpreter;
pub mod judge;
pub mod simulator;
