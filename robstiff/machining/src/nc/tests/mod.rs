//! Programs of machine tools. The samples are written for these tests.

mod apt;
mod arcs;
mod cycles;
mod machines;
mod mistakes;
mod random;
mod words;

use std::path::Path;

use robstiff_robots::text::Lines;

use super::{Format, Machine, Move, Options, Reader};

/// The moves of a program and its warnings, or what is wrong with it.
fn read(format: Format, text: &str, options: &Options) -> Result<(Vec<Move>, Vec<String>), String> {
    let lines = Lines::new(text.to_owned());
    Reader::new(format, "part.ngc", &lines, options).all().map_err(|problems| problems.to_string())
}

/// The moves of G-code in mm that is right.
fn moves(text: &str) -> Vec<Move> {
    let (moves, warnings) = read(Format::GCode, &format!("G21\n{text}"), &Options::default()).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    moves
}

/// With a machine's rotary axes.
fn on(machine: &str) -> Options {
    Options { machine: Some(Machine::parse(machine).unwrap()), ..Options::default() }
}

/// Points in mm, rounded to nm.
fn points(moves: &[Move]) -> Vec<[f64; 3]> {
    moves.iter().map(|each| each.point.map(|part| (part * 1e9).round() / 1e6 + 0.0).into()).collect()
}

#[test]
fn the_end_of_a_name_tells_the_language() {
    let of = |name: &str| Format::of(Path::new(name));
    for name in ["a.ngc", "a.NC", "a.tap", "a.gcode", "a.cnc"] {
        assert_eq!(of(name), Some(Format::GCode), "{name}");
    }
    for name in ["a.apt", "a.CLS", "a.cl"] {
        assert_eq!(of(name), Some(Format::Apt), "{name}");
    }
    assert_eq!([of("a.csv"), of("ngc"), of("a")], [None; 3]);
}
