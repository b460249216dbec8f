//! What kinds of quantities are called, and how they are written.

use crate::dimension::Dimension;
use crate::suggest::list;
use crate::units::UNITS;

impl Dimension {
    /// The kind with its article: "an angle".
    pub const fn name(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Length => "a length",
            Self::Angle => "an angle",
            Self::Compliance => "a rotational compliance",
            Self::LinearCompliance => "a translational compliance",
            Self::Mass => "a mass",
            Self::Force => "a force",
            Self::Torque => "a torque",
            Self::Time => "a time",
            Self::Speed => "a speed",
            Self::RotationalSpeed => "a rotational speed",
            Self::Frequency => "a frequency",
            Self::Mobility => "a mobility",
            Self::Accelerance => "an accelerance",
            Self::FeedPerTooth => "a feed per tooth",
            Self::Pressure => "a force per area",
            Self::LineForce => "a force per length",
            Self::Temperature => "a temperature",
        }
    }

    const fn example(self) -> &'static str {
        match self {
            Self::Number => "0.25",
            Self::Length => "865 mm",
            Self::Angle => "-90 deg",
            Self::Compliance => "2.97e-7 rad/Nm",
            Self::LinearCompliance => "0.02 um/N",
            Self::Mass => "350 kg",
            Self::Force => "500 N",
            Self::Torque => "120 Nm",
            Self::Time => "0.5 s",
            Self::Speed => "1200 mm/min",
            Self::RotationalSpeed => "9000 rpm",
            Self::Frequency => "15 Hz",
            Self::Mobility => "0.2 mm/s/N",
            Self::Accelerance => "0.01 m/s2/N",
            Self::FeedPerTooth => "0.1 mm",
            Self::Pressure => "800 N/mm2",
            Self::LineForce => "20 N/mm",
            Self::Temperature => "21.5 C",
        }
    }

    /// An example of a list of `N` values, all zero but the last.
    pub(crate) fn example_list<const N: usize>(self) -> String {
        let mut items = ["0"; N];
        items[N - 1] = self.example().trim_start_matches('-');
        format!("[{}]", items.join(", "))
    }

    /// How such a quantity is written.
    pub fn help(self) -> String {
        let units = || UNITS.iter().filter(|unit| unit.dimension == self).map(|unit| unit.name);
        let example = self.example();
        match units().next() {
            None => format!("write a number without a unit, e.g. `{example}`"),
            Some(si) if units().count() == 1 => {
                format!("write a number in {si}, with or without its unit, e.g. `{example}`")
            }
            Some(si) => format!("write a number in {si} or one of {}, e.g. `{example}`", list(units())),
        }
    }

    /// How the header of a table's column of such quantities is written.
    pub fn header_help(self, name: &str) -> String {
        // A column is multiplied, which inverts nothing.
        let units = || UNITS.iter().filter(|unit| unit.dimension == self && !unit.inverse).map(|unit| unit.name);
        match units().next() {
            None => format!("write `{name}`, without a unit"),
            Some(si) if units().count() == 1 => format!("write `{name} [{si}]`"),
            Some(si) => format!("write `{name} [{si}]`, or as its unit one of {}", list(units())),
        }
    }
}
