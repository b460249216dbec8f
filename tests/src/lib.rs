//! Support for the tests: a simulator that shares no formula with the library.

pub mod simulator;
