//! Cutting coefficients from recorded forces, by linear least squares.
//!
//! The mean force, and the force at each angle, are linear in the coefficients (Altintas,
//! Manufacturing Automation, 2nd ed. 2012, chapter 2): those along feed and normal in the
//! tangential and radial ones, those along the axis in the axial ones. The two parts have nothing
//! in common and are each fitted with its noise.

use core::f64::consts::TAU;
use core::fmt;

use nalgebra::{DMatrix, DVector, Vector3};

use super::{Coefficients, Cut, Recorded};

/// The coefficients in the order of the columns: Ktc, Kte, Krc, Kre, and Kac, Kae.
type Numbers = [f64; 6];

/// Coefficients with what is known of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The coefficients.
    pub coefficients: Coefficients,
    /// One standard deviation of each, where there are more forces than coefficients.
    pub std: Option<Coefficients>,
    /// Each record.
    pub records: Vec<Fitted>,
}

/// What a fit says of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// The mean force on the tool as it was measured (N), along feed, normal and axis.
    pub measured: Vector3<f64>,
    /// The mean force by the fit on all records (N).
    pub fitted: Vector3<f64>,
    /// The mean force by a fit on all the other records (N), where these suffice.
    pub predicted: Option<Vector3<f64>>,
    /// The force over the revolution against a fit on the other records, where these suffice and
    /// the record resolves a revolution.
    pub turn: Option<Turn>,
}

/// A force over a revolution against a prediction, the first tooth where it fits best.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// The rms of the size of the difference (N).
    pub rms: f64,
    /// The rms of the size of the force (N).
    pub force: f64,
    /// The greatest size of the force, as measured (N).
    pub peak: f64,
    /// The same as predicted (N).
    pub predicted_peak: f64,
}

/// Why there is no fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unfit {
    /// The records do not tell cutting and edge coefficients apart.
    OneFeed,
    /// None of the records resolves a revolution.
    NoRevolution,
}

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OneFeed => {
                "the records cannot tell cutting from edge coefficients: they need cuts of two feeds per tooth at \
                 least, better of four"
            }
            Self::NoRevolution => {
                "no record resolves a revolution: it needs `angle`, or `t` and the `speed` of the spindle, a whole \
                 revolution and four samples a turn or more"
            }
        })
    }
}

/// Forces of a record, and what each coefficient of one adds to them.
struct Part {
    /// The forces (N).
    forces: Vec<Vector3<f64>>,
    /// For each force the columns of the six coefficients (N per unit).
    columns: Vec<[Vector3<f64>; 6]>,
}

/// By the mean force of each record, of whole revolutions where the record tells them.
///
/// # Errors
/// Records that do not determine the coefficients.
pub fn by_means(records: &[Recorded]) -> Result<Fit, Unfit> {
    let part = |record: &Recorded| Part {
        forces: vec![record.force.mean(record.cut.speed)],
        columns: vec![units(&record.cut).map(|cut| cut.mean_force())],
    };
    let parts: Vec<Part> = records.iter().map(part).collect();
    let all: Vec<&Part> = parts.iter().collect();
    let (numbers, std) = solve(&all).ok_or(Unfit::OneFeed)?;
    let turns: Vec<Option<Measured>> = records.iter().map(Measured::of).collect();
    let fitted = |index: usize| {
        let without = solve(&others(&all, index)).map(|(numbers, _)| numbers);
        let part = &parts[index];
        Fitted {
            measured: part.forces[0],
            fitted: sum(&part.columns[0], &numbers),
            predicted: without.map(|numbers| sum(&part.columns[0], &numbers)),
            turn: without.zip(turns[index].as_ref()).map(|(numbers, turn)| turn.against(&numbers)),
        }
    };
    Ok(Fit {
        coefficients: coefficients(&numbers),
        std: std.as_ref().map(coefficients),
        records: (0..records.len()).map(fitted).collect(),
    })
}

/// By the force over the revolution of each record that resolves one, from coefficients to begin
/// with. Where the first tooth stood is fitted, too. The standard deviations are those of the
/// jackknife over records: the differences along a revolution are no independent noise.
///
/// # Errors
/// No such record; records that do not determine the coefficients.
pub fn by_revolutions(records: &[Recorded], start: &Coefficients) -> Result<Fit, Unfit> {
    let turns: Vec<Option<Measured>> = records.iter().map(Measured::of).collect();
    let all: Vec<&Measured> = turns.iter().flatten().collect();
    if all.is_empty() {
        return Err(Unfit::NoRevolution);
    }
    let start = numbers(start);
    let found = turning(&all, &start).ok_or(Unfit::OneFeed)?;
    let mut left_out = Vec::new();
    let mut fitted = Vec::new();
    let mut position = 0;
    for (record, turn) in records.iter().zip(&turns) {
        let columns = units(&record.cut).map(|cut| cut.mean_force());
        let without = turn.as_ref().and_then(|_| {
            position += 1;
            turning(&others(&all, position - 1), &start)
        });
        left_out.extend(without);
        fitted.push(Fitted {
            measured: record.force.mean(record.cut.speed),
            fitted: sum(&columns, &found),
            predicted: without.map(|numbers| sum(&columns, &numbers)),
            turn: without.zip(turn.as_ref()).map(|(numbers, turn)| turn.against(&numbers)),
        });
    }
    let count = all.len() as f64;
    let jackknife = |index: usize| {
        let mean = left_out.iter().map(|numbers| numbers[index]).sum::<f64>() / count;
        let squares = left_out.iter().map(|numbers| (numbers[index] - mean).powi(2)).sum::<f64>();
        ((count - 1.0) / count * squares).sqrt()
    };
    let std = (left_out.len() == all.len() && all.len() > 2).then(|| core::array::from_fn(jackknife));
    Ok(Fit { coefficients: coefficients(&found), std: std.as_ref().map(coefficients), records: fitted })
}

fn others<'p, P>(all: &[&'p P], index: usize) -> Vec<&'p P> {
    all.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, part)| *part).collect()
}

fn coefficients(numbers: &Numbers) -> Coefficients {
    let [ktc, kte, krc, kre, kac, kae] = *numbers;
    Coefficients { ktc, kte, krc, kre, kac, kae }
}

fn numbers(of: &Coefficients) -> Numbers {
    [of.ktc, of.kte, of.krc, of.kre, of.kac, of.kae]
}

/// The cut with each coefficient in turn as 1, the others 0.
fn units(cut: &Cut) -> [Cut; 6] {
    core::array::from_fn(|index| {
        let mut unit = [0.0; 6];
        unit[index] = 1.0;
        Cut { coefficients: coefficients(&unit), ..cut.clone() }
    })
}

fn sum(columns: &[Vector3<f64>; 6], numbers: &Numbers) -> Vector3<f64> {
    columns.iter().zip(numbers).map(|(column, number)| column * *number).sum()
}

/// Columns that are this near to depend on each other determine nothing but rounding.
const SINGULAR: f64 = 1e-6;

/// The coefficients with the least sum of squares, and their standard deviations where there are
/// more forces than coefficients; `None` where they are not determined.
fn solve(parts: &[&Part]) -> Option<(Numbers, Option<Numbers>)> {
    let (plane, plane_std) = block(parts, &[0, 1], &[0, 1, 2, 3])?;
    let (axial, axial_std) = block(parts, &[2], &[4, 5])?;
    let joined =
        |plane: &[f64], axial: &[f64]| -> Numbers { [plane, axial].concat().try_into().expect("four and two are six") };
    Some((joined(&plane, &axial), plane_std.zip(axial_std).map(|(plane, axial)| joined(&plane, &axial))))
}

/// The part of the problem with these components of the force and these coefficients.
fn block(parts: &[&Part], axes: &[usize], unknowns: &[usize]) -> Option<(Vec<f64>, Option<Vec<f64>>)> {
    let forces = || parts.iter().flat_map(|part| part.forces.iter().zip(&part.columns));
    let rows = forces().count() * axes.len();
    let mut matrix = DMatrix::zeros(rows, unknowns.len());
    let mut right = DVector::zeros(rows);
    for (row, ((force, columns), &axis)) in
        forces().flat_map(|one| axes.iter().map(move |axis| (one, axis))).enumerate()
    {
        right[row] = force[axis];
        for (column, &unknown) in unknowns.iter().enumerate() {
            matrix[(row, column)] = columns[unknown][axis];
        }
    }
    if rows < unknowns.len() {
        return None;
    }
    // A pressure and a force per length differ by orders of magnitude.
    let scales: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
    if scales.contains(&0.0) {
        return None;
    }
    for (mut column, scale) in matrix.column_iter_mut().zip(&scales) {
        column /= *scale;
    }
    let svd = matrix.clone().svd(true, true);
    let values = &svd.singular_values;
    if values.min() < SINGULAR * values.max() {
        return None;
    }
    let scaled = svd.solve(&right, 0.0).ok()?;
    let residuals = &right - &matrix * &scaled;
    let found = scaled.iter().zip(&scales).map(|(value, scale)| value / scale).collect();
    let free = rows - unknowns.len();
    let std = (free > 0).then(|| {
        let variance = residuals.norm_squared() / free as f64;
        let v_t = svd.v_t.as_ref().expect("it was asked for");
        let std = |(column, scale): (usize, &f64)| {
            let inverse: f64 = values.iter().enumerate().map(|(k, value)| (v_t[(k, column)] / value).powi(2)).sum();
            (variance * inverse).sqrt() / scale
        };
        scales.iter().enumerate().map(std).collect()
    });
    Some((found, std))
}

/// Parts of a revolution into which a record is averaged.
const PARTS: usize = 72;

/// Angles of a revolution at which the first tooth may stand.
const ANGLES: usize = 720;

/// The mean force in a part of a revolution.
struct Average {
    force: Vector3<f64>,
    /// The angles of its samples, by index, and how often each is there (as a part of them).
    angles: Vec<(usize, f64)>,
}

/// A measured revolution, and what each coefficient adds at any angle.
struct Measured {
    averages: Vec<Average>,
    /// The columns at each of the angles.
    columns: Vec<[Vector3<f64>; 6]>,
    /// How many places of the first tooth are looked at: with even teeth one period.
    shifts: usize,
}

impl Measured {
    fn of(record: &Recorded) -> Option<Self> {
        let (force, speed) = (&record.force, record.cut.speed);
        let angles = force.angles(speed).filter(|_| force.resolves_revolution(speed))?;
        let mut parts = vec![(Vector3::zeros(), vec![0_usize; ANGLES / PARTS]); PARTS];
        for (sample, angle) in force.samples.iter().zip(angles) {
            let index = (angle.rem_euclid(TAU) / TAU * ANGLES as f64) as usize % ANGLES;
            let (sum, counts) = &mut parts[index / (ANGLES / PARTS)];
            *sum += sample.force;
            counts[index % (ANGLES / PARTS)] += 1;
        }
        let average = |(part, (sum, counts)): (usize, (Vector3<f64>, Vec<usize>))| {
            let count = counts.iter().sum::<usize>() as f64;
            let angles = counts.into_iter().enumerate().filter(|(_, number)| *number > 0);
            let angles = angles.map(|(angle, number)| (part * (ANGLES / PARTS) + angle, number as f64 / count));
            (count > 0.0).then(|| Average { force: sum / count, angles: angles.collect() })
        };
        let averages = parts.into_iter().enumerate().filter_map(average).collect();
        let units = units(&record.cut);
        // In the middle of what is rounded to it.
        let angle = |k: usize| TAU * (k as f64 + 0.5) / ANGLES as f64;
        let columns = (0..ANGLES).map(|k| core::array::from_fn(|unit| units[unit].force_at(angle(k)))).collect();
        let is_even = record.cut.mill.runout.is_empty();
        let shifts = if is_even { ANGLES.div_ceil(record.cut.mill.teeth) } else { ANGLES };
        Some(Self { averages, columns, shifts })
    }

    /// The force that coefficients predict of each average, with the first tooth at a place.
    fn predicted<'m>(&'m self, forces: &'m [Vector3<f64>], shift: usize) -> impl Iterator<Item = Vector3<f64>> + 'm {
        let mean = move |average: &Average| {
            average.angles.iter().map(|(angle, share)| forces[(angle + shift) % ANGLES] * *share).sum()
        };
        self.averages.iter().map(mean)
    }

    fn forces(&self, numbers: &Numbers) -> Vec<Vector3<f64>> {
        self.columns.iter().map(|columns| sum(columns, numbers)).collect()
    }

    /// The sum of the squares of the differences.
    fn apart(&self, forces: &[Vector3<f64>], shift: usize) -> f64 {
        let pairs = self.averages.iter().zip(self.predicted(forces, shift));
        pairs.map(|(average, predicted)| (average.force - predicted).norm_squared()).sum()
    }

    /// Where the first tooth stands with coefficients.
    fn shift(&self, numbers: &Numbers) -> usize {
        let forces = self.forces(numbers);
        let shifts = (0..self.shifts).map(|shift| (shift, self.apart(&forces, shift)));
        shifts.min_by(|(_, one), (_, other)| one.total_cmp(other)).map_or(0, |(shift, _)| shift)
    }

    fn part(&self, shift: usize) -> Part {
        let column = |average: &Average| {
            core::array::from_fn(|unit| {
                let at = |(angle, share): &(usize, f64)| self.columns[(angle + shift) % ANGLES][unit] * *share;
                average.angles.iter().map(at).sum()
            })
        };
        Part {
            forces: self.averages.iter().map(|average| average.force).collect(),
            columns: self.averages.iter().map(column).collect(),
        }
    }

    fn against(&self, numbers: &Numbers) -> Turn {
        let (shift, forces) = (self.shift(numbers), self.forces(numbers));
        let count = self.averages.len() as f64;
        let measured = || self.averages.iter().map(|average| average.force.norm());
        Turn {
            rms: (self.apart(&forces, shift) / count).sqrt(),
            force: (measured().map(|force| force * force).sum::<f64>() / count).sqrt(),
            peak: measured().fold(0.0, f64::max),
            predicted_peak: self.predicted(&forces, shift).map(|force| force.norm()).fold(0.0, f64::max),
        }
    }
}

/// Coefficients and angles of the first teeth in turn, until these stay.
fn turning(turns: &[&Measured], start: &Numbers) -> Option<Numbers> {
    const MOST: usize = 50;
    let mut found = *start;
    let mut shifts: Vec<usize> = Vec::new();
    for _ in 0..MOST {
        let next: Vec<usize> = turns.iter().map(|turn| turn.shift(&found)).collect();
        if next == shifts {
            break;
        }
        shifts = next;
        let parts: Vec<Part> = turns.iter().zip(&shifts).map(|(turn, &shift)| turn.part(shift)).collect();
        found = solve(&parts.iter().collect::<Vec<_>>())?.0;
    }
    Some(found)
}
