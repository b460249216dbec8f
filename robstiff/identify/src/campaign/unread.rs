//! Readings that nobody read: a column of zeros, rows that were copied. Both pass for
//! readings without noise, which all others then contradict. So copies are left out: they
//! repeat a reading, its noise and all, and would count it twice besides.

use core::mem;
use std::collections::HashSet;
use std::string::String;
use std::vec;
use std::vec::Vec;

use super::Observation;
use super::rounded::step;

/// Fewer rows than this are too few to tell.
pub const FEWEST_ROWS: usize = 10;

/// So large a part of the rows is not read with the same result once more by chance.
const COPIED: f64 = 0.1;

/// Which of three components are zero in every row, though the others are not.
pub fn still(rows: &[Observation], of: fn(&Observation) -> Option<[f64; 3]>) -> [bool; 3] {
    let is_still = [0, 1, 2].map(|k| rows.iter().filter_map(of).all(|three| three[k] == 0.0));
    if rows.len() < FEWEST_ROWS || is_still == [true; 3] { [false; 3] } else { is_still }
}

/// A displacement in steps of more than this part of the largest is read alike once more by
/// rounding alone.
const FINE_STEP: f64 = 1e-3;

/// Which rows, in order, repeat earlier ones to the last digit, their time included, if these are too many
/// for chance. Rows without a displacement may.
pub fn copies(rows: &[Observation]) -> Vec<usize> {
    let mut known = HashSet::new();
    let is_copy = |&i: &usize| rows[i].displacement != [0.0; 3] && !known.insert(digits(&rows[i]));
    let copies: Vec<usize> = (0..rows.len()).filter(is_copy).collect();
    let is_chance = rows.len() < FEWEST_ROWS || (copies.len() as f64) < COPIED * rows.len() as f64;
    if is_chance { Vec::new() } else { copies }
}

/// Whether rows that are [alike](copies) can be nothing but copies: where every reading has a
/// time of its own, or a fine gauge agrees in all digits. Otherwise readings of a coarse one are
/// alike for it rounds them alike, as on the way up and down.
pub fn are_copies(copies: &[usize], rows: &[Observation]) -> bool {
    let readings = rows.iter().flat_map(|row| row.displacement);
    let largest = readings.clone().map(f64::abs).fold(0.0, f64::max);
    let mut times = HashSet::new();
    let others = rows.iter().enumerate().filter(|(row, _)| copies.binary_search(row).is_err());
    others.map(|(_, row)| row.time).all(|time| time.is_some_and(|time| times.insert(time.to_bits())))
        || step(readings).is_none_or(|step| step < FINE_STEP * largest)
}

/// Takes rows away, and the visits that no row is left of.
pub fn take_away(copies: &[usize], rows: &mut Vec<Observation>, visits: &mut Vec<String>) {
    let mut is_copy = vec![false; rows.len()];
    copies.iter().for_each(|&row| is_copy[row] = true);
    let mut is_copy = is_copy.into_iter();
    rows.retain(|_| !is_copy.next().unwrap_or_default());
    let mut place = vec![None; visits.len()];
    let mut kept = Vec::new();
    for row in rows {
        let visit = place[row.visit].unwrap_or_else(|| {
            kept.push(mem::take(&mut visits[row.visit]));
            kept.len() - 1
        });
        place[row.visit] = Some(visit);
        row.visit = visit;
    }
    *visits = kept;
}

/// All that a row says, by its bits, but for what it is called.
fn digits(row: &Observation) -> Vec<u64> {
    let numbers = [row.time, row.temperature].into_iter().flatten().chain(row.q.iter().copied());
    let numbers = numbers.chain(row.wrench).chain(row.displacement).chain(row.rotation.into_iter().flatten());
    let angles = row.encoders.iter().chain(&row.motors).flatten().copied();
    numbers.chain(angles).map(f64::to_bits).collect()
}
