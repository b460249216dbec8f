//! How programs of machine tools are read.

use std::path::Path;

use robstiff::nalgebra::Vector3;
use robstiff_machining::cell::Cell;
use robstiff_machining::nc::{Format, Machine, OFFSETS, Options};
use robstiff_robots::quantity::Dimension;

use super::options::{positive, three_with_unit};
use crate::failure::Failure;

// No doc comment: clap would take it for that of the command.
#[derive(clap::Args)]
#[command(next_help_heading = "Programs of machine tools (G-code, APT)")]
pub struct ProgramArguments {
    /// How far chords may be off the arcs of a program; 0.01 mm where left out
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = positive(Dimension::Length))]
    arc_tolerance: Option<f64>,
    /// The rotary axes of the machine that a program is for: `xyzac-trt`, `xyzbc-trt`, or as in "table A C", "head C B",
    /// "head B table -C", the carrying axis first
    #[arg(long, value_name = "AXES", allow_hyphen_values = true, value_parser = Machine::parse)]
    machine: Option<Machine>,
    /// Where the axes of the table meet, in the path's frame; needed without TCP
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, value_parser = point)]
    center: Option<Vector3<f64>>,
    /// From where the axes of the head meet to the tip; needed without TCP
    #[arg(long, value_name = "LENGTH", value_parser = positive(Dimension::Length))]
    pivot_length: Option<f64>,
    /// Whether coordinates are those of the tip on the workpiece (TCP), whatever the program's codes say
    #[arg(long, value_name = "WHETHER", value_enum)]
    tcp: Option<OnOff>,
    /// The zero of a work offset in the path's frame, as in "G55 = 100 mm, 0, 0"; for each of them. G53 is followed only
    /// where its zero is given
    #[arg(long, value_name = "G5x=x,y,z", allow_hyphen_values = true, value_parser = offset)]
    offset: Vec<Offset>,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum OnOff {
    On,
    Off,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Offset {
    index: usize,
    zero: Vector3<f64>,
}

impl ProgramArguments {
    /// The options for a path of that name: what is given, else what the cell says.
    pub fn options(&self, path: &Path, cell: Option<&Cell>) -> Result<Options, Failure> {
        let given = [
            ("--arc-tolerance", self.arc_tolerance.is_some()),
            ("--machine", self.machine.is_some()),
            ("--offset", !self.offset.is_empty()),
        ];
        if let (None, Some((name, _))) = (Format::of(path), given.iter().find(|(_, given)| *given)) {
            let message = format!(
                "{name} is for G-code (.ngc, .nc, .tap, .gcode, .cnc) and APT (.apt, .cls, .cl), {} is a table",
                path.display()
            );
            return Err(Failure::Usage(message));
        }
        let mut options = cell.map_or_else(Options::default, Cell::options);
        options.tcp = self.tcp.map(|tcp| tcp == OnOff::On).or(options.tcp);
        options.arc_tolerance = self.arc_tolerance.unwrap_or(options.arc_tolerance);
        // Another machine has axes that meet elsewhere.
        options.machine = self.machine.clone().or(options.machine).map(|machine| Machine {
            center: self.center.or(machine.center),
            pivot_length: self.pivot_length.or(machine.pivot_length),
            ..machine
        });
        let of_machine = [
            ("--center", self.center.is_some()),
            ("--pivot-length", self.pivot_length.is_some()),
            ("--tcp", self.tcp.is_some()),
        ];
        if let (None, Some((name, _))) = (&options.machine, of_machine.iter().find(|(_, given)| *given)) {
            return Err(Failure::Usage(format!("{name} goes with `--machine`, e.g. `--machine \"table A C\"`")));
        }
        for Offset { index, zero } in &self.offset {
            options.offsets[*index] = Some(*zero);
        }
        Ok(options)
    }
}

fn point(text: &str) -> Result<Vector3<f64>, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let [x, y, z] = parts[..] else { return Err("three lengths are expected, e.g. \"0, 0, -50 mm\"".to_owned()) };
    three_with_unit([x, y, z], Dimension::Length).map(Vector3::from)
}

fn offset(text: &str) -> Result<Offset, String> {
    let help = || {
        format!(
            "a work offset and its zero are expected, e.g. \"G55 = 100 mm, 0, 0\"; offsets are {}",
            OFFSETS.join(", ")
        )
    };
    let (name, zero) = text.split_once('=').ok_or_else(help)?;
    let name = name.trim().to_ascii_uppercase();
    let index = OFFSETS.iter().position(|offset| **offset == name).ok_or_else(help)?;
    Ok(Offset { index, zero: point(zero)? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_work_offset_has_a_name_and_a_zero() {
        let zero = Vector3::new(0.1, 0.0, -0.02);
        assert_eq!(offset("g59.1 = 100 mm, 0, -20 mm"), Ok(Offset { index: 7, zero }));
        for wrong in ["G55", "G60=0,0,0", "G55=1,2", "G55=1,2,3"] {
            assert!(offset(wrong).is_err(), "{wrong}");
        }
    }
}
