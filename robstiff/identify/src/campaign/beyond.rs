//! Numbers that no robot comes to. They are read as they are and warned of, with the
//! first line: some are slips of a pen, most are of a unit that the header does not say.

use std::format;
use std::string::String;

use robstiff_robots::words::count;

use robstiff::JointKind;
use robstiff_robots::table::{Numbers, Table};

/// The unit that a column without one is taken to be written in.
#[derive(Clone, Copy)]
pub struct Usual {
    what: &'static str,
    named: &'static str,
    unit: &'static str,
}

/// Lengths as drawings and trackers give them.
pub const LENGTHS: Usual = Usual { what: "lengths", named: "millimetres", unit: "mm" };

/// Angles as controllers give them.
pub const ANGLES: Usual = Usual { what: "angles", named: "degrees", unit: "deg" };

/// Displacements under load as gauges and trackers give them.
const MICROMETRES: Usual = Usual { what: "lengths", named: "micrometres", unit: "um" };

/// Rotations under load.
const MILLIRADIANS: Usual = Usual { what: "angles", named: "milliradians", unit: "mrad" };

/// The same, as small as they often are.
const MICRORADIANS: Usual = Usual { what: "angles", named: "microradians", unit: "urad" };

impl Usual {
    /// That of a joint's coordinate.
    pub const fn of_joint(kind: JointKind) -> Self {
        if matches!(kind, JointKind::Revolute) { ANGLES } else { LENGTHS }
    }

    /// Asks for it, behind a colon, where the column says none.
    pub fn asked(&self, table: &Table<'_>, column: Numbers) -> String {
        if table.has_unit(column) {
            return String::new();
        }
        let Self { what, named, unit } = self;
        format!(": are the {what} in {named}? write `{} [{unit}]`", table.name_of(column))
    }
}

/// What is larger than robots come to, of one kind of number.
pub struct Beyond {
    /// In SI.
    pub most: f64,
    /// The same with its unit.
    pub told: &'static str,
    /// What is asked for where the header says no unit: of the first that the largest
    /// number is at most so large in, else of the last.
    pub usual: &'static [(f64, Usual)],
}

/// A tool under load goes less far: by up to 20 mm, so that larger numbers are of um.
pub const DISPLACEMENT: Beyond =
    Beyond { most: 0.1, told: "100 mm", usual: &[(20.0, LENGTHS), (f64::INFINITY, MICROMETRES)] };

/// A tool under load turns less far, a joint as well: by up to 20 mrad, more than a degree.
pub const ROTATION: Beyond =
    Beyond { most: 0.1, told: "0.1 rad", usual: &[(20.0, MILLIRADIANS), (f64::INFINITY, MICRORADIANS)] };

/// The largest arms carry some 2.3 t.
pub const FORCE: Beyond = Beyond { most: 1e5, told: "100 kN", usual: &[] };

/// No joint of them holds so much.
pub const MOMENT: Beyond = Beyond { most: 1e6, told: "1 MNm", usual: &[] };

/// As for forces.
pub const PAYLOAD: Beyond = Beyond { most: 1e4, told: "10 t", usual: &[] };

impl Beyond {
    /// Warns of the numbers of a column, each with its line, that are larger.
    pub fn warn(&self, table: &Table<'_>, column: Numbers, numbers: impl Iterator<Item = (usize, f64)> + Clone) {
        let largest = numbers.clone().map(|(_, number)| number.abs()).fold(0.0, f64::max);
        self.warn_among(table, column, numbers, largest);
    }

    /// The same of a column among others of one unit, with the largest number of all.
    pub fn warn_among(
        &self,
        table: &Table<'_>,
        column: Numbers,
        numbers: impl Iterator<Item = (usize, f64)>,
        largest: f64,
    ) {
        let lines = numbers.filter(|(_, number)| number.abs() > self.most).map(|(line, _)| line);
        let usual = self.usual.iter().find(|(most, _)| largest <= *most).map(|(_, usual)| usual);
        let ask = usual.map(|usual| usual.asked(table, column)).unwrap_or_default();
        warn_of(table, &format!("{} is more than {}", table.name_of(column), self.told), lines, &ask);
    }
}

/// Warns of rows, by their lines, if there are any; says whether there are.
pub fn warn_of(table: &Table<'_>, what: &str, mut lines: impl Iterator<Item = usize>, ask: &str) -> bool {
    let Some(first) = lines.next() else { return false };
    let rows = count(1 + lines.count(), "row");
    table.warn(&format!("{what} in {rows}, first on line {first}{ask}"));
    true
}

/// A length with its unit.
pub fn told_length(length: f64) -> String {
    told(length, &[(1.0, "m"), (1e-3, "mm"), (1e-6, "um")])
}

/// An angle with its unit.
pub fn told_angle(angle: f64) -> String {
    told(angle, &[(1.0, "rad"), (1e-3, "mrad"), (1e-6, "urad")])
}

/// A force with its unit.
pub fn told_force(force: f64) -> String {
    told(force, &[(1e3, "kN"), (1.0, "N")])
}

/// A value to two digits in the first of the units, largest first, that it is one of at
/// least, else in the last.
fn told(value: f64, units: &[(f64, &str)]) -> String {
    let Some((factor, unit)) = units.iter().find(|(factor, _)| value >= *factor).or(units.last()) else {
        return String::new();
    };
    let number = value / factor;
    let digits = usize::from(number < 9.95 && number.fract() != 0.0);
    format!("{number:.digits$} {unit}")
}
