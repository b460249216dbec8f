//! A force that stands alone: a factor of ten that slipped into one row passes for a load.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::Observation;
use super::beyond::told_force;
use super::unread::FEWEST_ROWS;

/// A force that is so many times the next largest stands alone.
const TIMES: f64 = 3.0;

/// Likewise visits, beside the one that a force stands alone in.
const FEWEST_VISITS: usize = 3;

/// What is said of the largest force, with its line, if one row, or one visit, has it and
/// all others are far below. That every row of a campaign is far above its unloaded ones
/// is no sign of a slip.
pub fn largest_force(rows: &[Observation]) -> Option<String> {
    let force = |row: &Observation| row.wrench[..3].iter().map(|force| force * force).sum::<f64>().sqrt();
    let (row, most) = rows.iter().map(|row| (row, force(row))).max_by(|one, other| one.1.total_cmp(&other.1))?;
    let among = |others: &dyn Fn(&Observation) -> bool| {
        rows.iter().filter(|other| others(other)).map(force).fold(0.0, f64::max)
    };
    let next = among(&|other| other.line != row.line);
    let elsewhere = among(&|other| other.visit != row.visit);
    let alone = |next: f64| next > 0.0 && most > TIMES * next;
    let mut visits: Vec<usize> = rows.iter().map(|row| row.visit).collect();
    visits.sort_unstable();
    visits.dedup();
    let said = |next, of: &str| {
        let (line, most, next) = (row.line, told_force(most), told_force(next));
        format!("line {line}: a force of {most}, the next largest{of} is {next}: is that so, or a slip of the pen?")
    };
    if rows.len() < FEWEST_ROWS {
        None
    } else if alone(next) {
        Some(said(next, ""))
    } else if alone(elsewhere) && visits.len() > FEWEST_VISITS {
        Some(said(elsewhere, " of another visit"))
    } else {
        None
    }
}
