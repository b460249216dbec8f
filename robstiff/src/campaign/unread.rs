//! Readings that nobody read: a column of zeros, rows that were copied. Both pass for
//! readings without noise, which all others then contradict.

use std::collections::HashSet;
use std::vec::Vec;

use super::Observation;

/// Fewer rows than this are too few to tell.
pub const FEWEST_ROWS: usize = 10;

/// So large a part of the rows is not read with the same result once more by chance.
const COPIED: f64 = 0.1;

/// Which of three components are zero in every row, though the others are not.
pub fn still(rows: &[Observation], of: fn(&Observation) -> Option<[f64; 3]>) -> [bool; 3] {
    let is_still = [0, 1, 2].map(|k| rows.iter().filter_map(of).all(|three| three[k] == 0.0));
    if rows.len() < FEWEST_ROWS || is_still == [true; 3] { [false; 3] } else { is_still }
}

/// The lines of rows that repeat earlier ones to the last digit, their time included, if
/// these are too many for chance. Rows without a displacement may.
pub fn copies(rows: &[Observation]) -> Vec<usize> {
    let mut known = HashSet::new();
    let is_copy = |row: &&Observation| row.displacement != [0.0; 3] && !known.insert(digits(row));
    let lines: Vec<usize> = rows.iter().filter(is_copy).map(|row| row.line).collect();
    let is_chance = rows.len() < FEWEST_ROWS || (lines.len() as f64) < COPIED * rows.len() as f64;
    if is_chance { Vec::new() } else { lines }
}

/// All that a row says, by its bits, but for what it is called.
fn digits(row: &Observation) -> Vec<u64> {
    let numbers = [row.time, row.temperature].into_iter().flatten().chain(row.q.iter().copied());
    let numbers = numbers.chain(row.wrench).chain(row.displacement).chain(row.rotation.into_iter().flatten());
    let angles = row.encoders.iter().chain(&row.motors).flatten().copied();
    numbers.chain(angles).map(f64::to_bits).collect()
}
