//! The columns of a displacement: `dx`, `dy` and `dz`, or what one dial gauge reads.

use std::vec::Vec;

use robstiff_robots::quantity::Dimension;
use robstiff_robots::table::{Numbers, Record, Table};

use super::AXES;

/// The columns, and along what each reads, as unit vectors in the frame of the file.
pub struct Gauges {
    pub columns: Vec<Numbers>,
    pub directions: Vec<[f64; 3]>,
}

const NAMES: [&str; 3] = ["dx", "dy", "dz"];

/// What a gauge along a direction of its own reads.
const ALONG: &str = "d";

impl Gauges {
    /// Finds them; `along` is the direction of a single gauge, if the campaign says one. `None` with the
    /// problems reported.
    pub fn find(table: &Table<'_>, along: Option<[f64; 3]>) -> Option<Self> {
        let length = |name: &str| table.require(name, Dimension::Length);
        if let Some(along) = along {
            return Some(Self { columns: [length(ALONG)?].into(), directions: [along].into() });
        }
        if NAMES.iter().all(|name| table.position(name).is_none()) && table.position(ALONG).is_some() {
            table.report_header(
                "the column `d` is a displacement along one direction, and the campaign does not say which",
                "write the direction as a vector into the campaign, e.g. `measured: {at: tcp, along: [0, 0, 1]}`",
            );
            return None;
        }
        let there: Vec<usize> = (0..NAMES.len()).filter(|&axis| table.position(NAMES[axis]).is_some()).collect();
        if let [axis] = there[..]
            && NAMES.iter().all(|name| table.position(name).is_some() || !table.is_near(name))
        {
            let name = NAMES[axis];
            table.warn(&std::format!(
                "of the displacement only `{name}` is read: how far the tool moves across is not known"
            ));
            return Some(Self { columns: [length(name)?].into(), directions: [AXES[axis]].into() });
        }
        let found = NAMES.map(length);
        Some(Self { columns: found.into_iter().collect::<Option<_>>()?, directions: AXES.into() })
    }

    /// What to fill in, in words.
    pub fn names(&self, table: &Table<'_>) -> std::string::String {
        self.columns.iter().map(|&column| table.name_of(column)).collect::<Vec<_>>().join(", ")
    }

    /// The displacement that a row reads (m); zero across what is read.
    pub fn read(&self, table: &Table<'_>, record: &Record) -> Option<[f64; 3]> {
        // Every number is checked before any gives up.
        let read: Vec<Option<f64>> = self.columns.iter().map(|&column| table.number(record, column)).collect();
        let mut sum = [0.0; 3];
        for (read, direction) in read.into_iter().zip(&self.directions) {
            let read = read?;
            sum.iter_mut().zip(direction).for_each(|(sum, direction)| *sum += read * direction);
        }
        Some(sum)
    }

    /// What each column reads of a displacement (m).
    pub fn of<'a>(&'a self, displacement: [f64; 3]) -> impl Iterator<Item = f64> + 'a {
        self.directions.iter().map(move |direction| direction.iter().zip(displacement).map(|(a, b)| a * b).sum())
    }
}
