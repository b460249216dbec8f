//! Absolute positions: what a description says of them, and the compliances that
//! payloads show.
//!
//! Positions are read in a frame of their own, wherever the tracker stands. Where the
//! robot stands in it is fitted with everything ([`registration`]), so what is the
//! same as another stand (the zero of a joint that the base turns with, a length
//! along its axis) cannot show. A description's numbers enter its forward model
//! ([`model`]), not a linear one; they are fitted in steps ([`regression`]).
//!
//! A compliance shows where a payload loads its joint, and with a description that
//! sags (`gravity_sag`) where links do.

pub mod model;
pub mod own;
pub mod registration;
pub mod regression;
#[cfg(test)]
mod tests;
pub mod wild;
mod within;

use std::format;
use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Vector3};
use robstiff_robots::Description;

use self::model::{Enters, Model, State};
use self::own::{Own, compliances, kinematic, with_values};
use self::registration::Registration;
use self::regression::{Regression, Rows, STANDS, Solved};
use self::wild::wild_rows;
use self::within::within_visits;
use super::baseline::{Visibility, visibility};
use super::displacement::among_all;
use super::holdout::training;
use super::normal::{Normal, Projected, Scaled, Sign};
use super::predict::{PredictedRow, Prediction};
use super::problem::rms;
use super::readable::is_readable;
use super::uncertainty::{correlation, covariance};
use super::untold::untold;
use super::{Error, Estimate, Identification, NoiseSource, is_at_bound};
use crate::campaign::{Campaign, Positions};

/// Positions are all but linear in compliances: a step is off by some 1e-3 of itself. As
/// often are wild rows looked for.
const PASSES: usize = 3;

/// A campaign of positions, ready to be fitted.
#[derive(Clone)]
pub struct Prepared<'c> {
    /// The positions.
    pub data: &'c Positions,
    /// The description's own numbers that may be fitted, compliances first.
    pub own: Vec<Own>,
    /// What the positions say of each.
    pub visibility: Vec<Visibility>,
    /// The description as declared, without the numbers that are fitted.
    pub start: Model,
    /// Which rows are fitted to.
    pub rows: Rows,
    /// Where the robot stands, by the description as declared.
    pub registration: Registration,
}

impl<'c> Prepared<'c> {
    /// Finds out what the positions show of the description's compliances; the errors of
    /// its kinematics are as declared.
    ///
    /// # Errors
    /// Positions that do not tell where the robot stands.
    pub fn new(campaign: &Campaign, data: &'c Positions) -> Result<Self, Error> {
        Self::of(campaign, data, compliances(&campaign.robot), [])
    }

    /// The same of the errors of its kinematics, too. One that says what numbers of `rig`
    /// say as well is not fitted: that is then the rig's.
    ///
    /// # Errors
    /// Likewise.
    pub fn with_kinematics(
        campaign: &Campaign,
        data: &'c Positions,
        rig: impl IntoIterator<Item = Enters>,
    ) -> Result<Self, Error> {
        let own = [compliances(&campaign.robot), kinematic(&campaign.robot)].concat();
        Self::of(campaign, data, own, rig)
    }

    fn of(
        campaign: &Campaign,
        data: &'c Positions,
        own: Vec<Own>,
        rig: impl IntoIterator<Item = Enters>,
    ) -> Result<Self, Error> {
        let training: Rc<[bool]> = training(data.poses.len(), campaign.holdout).into();
        let rows = Rows { training: Rc::clone(&training), left_out: std::vec![false; data.rows.len()] };
        let mut start = Model::new(&campaign.robot, data);
        let registration = standing(&start, data, |row| training[data.rows[row].pose])?;
        let visibility = visible(&own, rig, (&start, registration), data, &rows);
        for (number, _) in own.iter().zip(&visibility).filter(|(_, visibility)| **visibility == Visibility::Seen) {
            number.add_to(&mut start.description, -number.value);
        }
        Ok(Self { data, own, visibility, start, rows, registration })
    }

    /// Leaves some rows out of the fit, and no others, and of where the robot stands by the
    /// description as declared.
    ///
    /// # Errors
    /// Rows of which the others do not tell where the robot stands.
    fn leave_out(&mut self, rows: &[usize], campaign: &Campaign) -> Result<(), Error> {
        self.rows.left_out.fill(false);
        rows.iter().for_each(|&row| self.rows.left_out[row] = true);
        let declared = Model::new(&campaign.robot, self.data);
        self.registration = standing(&declared, self.data, |row| self.rows.has(row, self.data))?;
        Ok(())
    }

    /// Holds an own number as declared from now on.
    fn hold(&mut self, number: usize) {
        self.visibility[number] = Visibility::Unseen;
        let own = &self.own[number];
        own.add_to(&mut self.start.description, own.value);
    }

    /// The own numbers that the positions show, by index.
    pub fn seen(&self) -> Vec<usize> {
        (0..self.own.len()).filter(|&k| self.visibility[k] == Visibility::Seen).collect()
    }

    /// The regression on all own numbers, and numbers besides.
    pub fn regression(&self, more: impl IntoIterator<Item = (Enters, Sign)>) -> Regression<'c> {
        let own = self.own.iter().map(|number| (number.enters(), number.sign));
        let (numbers, signs) = own.chain(more).unzip();
        Regression { data: self.data, start: self.start.clone(), numbers, signs }
    }

    /// The own numbers as declared, those that are not fitted counting as zero.
    pub fn state(&self, numbers: usize) -> State {
        let mut values = std::vec![0.0; numbers];
        self.seen().into_iter().for_each(|k| values[k] = self.own[k].value);
        State { registration: self.registration, values }
    }

    /// All own numbers, of which some were fitted.
    pub fn values(&self, state: &State) -> Vec<f64> {
        let value = |(k, number): (usize, &Own)| match self.visibility[k] {
            Visibility::Seen => state.values[k],
            _ => number.value,
        };
        self.own.iter().enumerate().map(value).collect()
    }

    /// The residuals with the description as declared, stacked (m).
    pub fn declared_residuals(&self, campaign: &Campaign) -> DVector<f64> {
        let points = Model::new(&campaign.robot, self.data).points(self.data);
        let left = points
            .iter()
            .zip(&self.data.rows)
            .map(|(point, row)| Vector3::from(row.position) - self.registration.placed(point));
        let left: Vec<f64> = left.flat_map(|left| [left.x, left.y, left.z]).collect();
        DVector::from_vec(left)
    }
}

/// Where the robot stands by a model, from some of the rows.
fn standing(model: &Model, data: &Positions, of_row: impl Fn(usize) -> bool) -> Result<Registration, Error> {
    let points = model.points(data);
    let rows: Vec<usize> = (0..points.len()).filter(|&row| of_row(row)).collect();
    let pairs = rows.iter().map(|&row| (points[row], Vector3::from(data.rows[row].position)));
    Registration::fitted(pairs).ok_or_else(|| {
        Error::NotShown(String::from(
            "the positions do not tell where the robot stands: they are fewer than three, or on a line by its description",
        ))
    })
}

/// What the positions say of own numbers at a model. Compliances come first, then the
/// rig's numbers, then errors of the kinematics: what one says, those behind it do not.
fn visible(
    own: &[Own],
    rig: impl IntoIterator<Item = Enters>,
    (start, registration): (&Model, Registration),
    data: &Positions,
    rows: &Rows,
) -> Vec<Visibility> {
    let elastic = own.iter().take_while(|own| own.is_compliance()).count();
    let mut numbers: Vec<Enters> = own.iter().map(Own::enters).collect();
    numbers.splice(elastic..elastic, rig);
    let of_rig = elastic..elastic + numbers.len() - own.len();
    let all: Vec<usize> = (0..numbers.len()).collect();
    let (signs, values) = (std::vec![Sign::Free; all.len()], std::vec![0.0; all.len()]);
    let regression = Regression { data, start: start.clone(), numbers, signs };
    let (problem, _) = regression.at(&State { registration, values }, &all, rows);
    let Some(total) = beyond_standing(&problem.total) else { return std::vec![Visibility::Unseen; own.len()] };
    let unit = |k: usize| match k.checked_sub(of_rig.end) {
        Some(k) => Some(own[elastic + k].unit),
        None => own[..elastic].get(k).map(|own| own.unit),
    };
    let mut seen = visibility(&unitless(total, &problem.total, unit), all.len());
    seen.drain(of_rig.clone());
    for one in &mut seen {
        if let Visibility::Confounded(others) = one {
            others.retain(|other| !of_rig.contains(other));
            others.iter_mut().filter(|other| **other >= of_rig.end).for_each(|other| *other -= of_rig.len());
        }
    }
    seen
}

/// The normal equations of numbers with columns over the largest of their unit, as they
/// are with where the robot stands: a share of a weight and a compliance have no size in
/// common. What has no unit given is a measure of its own.
fn unitless<'u>(mut beyond: Normal, whole: &Normal, unit: impl Fn(usize) -> Option<&'u str>) -> Normal {
    let count = beyond.moment.len();
    let square = |k: usize| whole.gram[(STANDS + k, STANDS + k)];
    let alike = |k: usize, other: usize| other == k || (unit(k).is_some() && unit(k) == unit(other));
    for k in 0..count {
        let largest = (0..count).filter(|&other| alike(k, other)).map(square).fold(0.0, f64::max).sqrt();
        if largest > 0.0 {
            beyond.gram.row_mut(k).unscale_mut(largest);
            beyond.gram.column_mut(k).unscale_mut(largest);
            beyond.moment[k] /= largest;
        }
    }
    beyond
}

/// The normal equations of the numbers, with where the robot stands projected out.
fn beyond_standing(total: &Normal) -> Option<Normal> {
    let stands: Vec<usize> = (0..STANDS).collect();
    let numbers: Vec<usize> = (STANDS..total.moment.len()).collect();
    let Projected { gram, shares } = total.projected(&numbers, &Scaled::of(&total.gram_of(&stands))?, &stands);
    Some(Normal {
        gram,
        moment: total.moment_of(&numbers) - shares.tr_mul(&total.moment_of(&stands)),
        energy: total.energy,
        rows: total.rows,
    })
}

/// Identifies the compliances that payloads show: from what payloads of one visit
/// differ by, or where that does not tell, from all positions with the kinematics as
/// declared.
///
/// # Errors
/// Positions that show none, or not where the robot stands; compliances that no
/// description takes beside its own effects.
pub fn identify(campaign: &Campaign, data: &Positions) -> Result<Identification, Error> {
    let mut prepared = Prepared::new(campaign, data)?;
    let seen = prepared.seen();
    if seen.is_empty() {
        let why = match data.rows.iter().all(|row| row.payload == 0.0) {
            true => "no row has a payload, so these positions show no compliance",
            false => "these payloads load no joint in a way that could not be another stand of the robot",
        };
        return Err(Error::NotShown(format!("{why}; `robstiff trace` asks what they show of the kinematics")));
    }
    let regression = prepared.regression([]);
    // A row that is off by metres hides others: they are looked for again without it.
    let (every, mut wild) = (prepared.rows.clone(), Vec::new());
    for _ in 0..PASSES {
        let Some(fitted) = regression.solve(&seen, &prepared.state(prepared.own.len()), &prepared.rows) else { break };
        let (whole, _) = regression.at(&fitted.state, &seen, &every);
        // The table may be off: rows must stand out from that, too.
        let mut found = wild_rows(&whole, false).map_or_else(Vec::new, |wild| wild.rows);
        found.sort_unstable();
        if found == wild {
            break;
        }
        wild = found;
        prepared.leave_out(&wild, campaign)?;
    }
    let (regression, seen, state, spread) = told(&mut prepared)?;
    let values = prepared.values(&state);
    let (rows, left) = (data.rows.len(), residuals(&regression, &state));
    let noise = match campaign.noise_of_reading() {
        Some(noise) => (noise, NoiseSource::of_declared(campaign)),
        None => {
            // By what the robot misses a pose is in it, whatever compliances are found by.
            let fitted: Vec<usize> = (0..rows).filter(|&row| prepared.rows.has(row, data)).collect();
            let readings = 3.0 * fitted.len() as f64;
            let freedom = (readings - (STANDS + seen.len()) as f64).max(1.0);
            (rms(&left, 3, fitted) * (readings / freedom).sqrt(), NoiseSource::Residuals)
        }
    };
    let estimates = estimated(&prepared, &values, &spread);
    let description = with_values(&campaign.robot, &prepared.own, &values);
    if !is_readable(&description) {
        return Err(Error::NoDescription);
    }
    let kept = (0..rows).filter(|&row| !prepared.rows.left_out[row]);
    let left_out: Vec<usize> = wild.iter().map(|&row| data.rows[row].line).collect();
    Ok(Identification {
        description,
        correlation: among_all(&correlation(&spread), &seen, estimates.len()),
        estimates,
        rows,
        poses: data.poses.len(),
        noise: Some(noise),
        covariance: None,
        left_out,
        rms_declared: Some(rms(&prepared.declared_residuals(campaign), 3, kept.clone())),
        rms: Some(rms(&left, 3, kept)),
    })
}

/// The numbers that are told, by index, their regression, values and covariance. What positions
/// tell no more of than was declared is held at that, and the rest fitted beside it.
fn told<'c>(prepared: &mut Prepared<'c>) -> Result<(Regression<'c>, Vec<usize>, State, DMatrix<f64>), Error> {
    loop {
        let (regression, seen) = (prepared.regression([]), prepared.seen());
        let start = prepared.state(prepared.own.len());
        let solved = match by_payloads(&regression, &start, &seen, &prepared.rows)? {
            Some(solved) => solved,
            None => regression.solve(&seen, &start, &prepared.rows).ok_or_else(confounded)?,
        };
        let Solved { state, problem, fit, signs } = solved;
        let spread = covariance(&problem, &fit, &signs, None);
        let stands = fit.columns.len() - seen.len();
        let mut declared = std::vec![None; stands];
        declared.extend(seen.iter().map(|&k| Some(prepared.own[k].value)));
        // Positions against the payloads are refused as such, not held as if they told nothing.
        let is_clipped = |&k: &usize| is_at_bound(prepared.own[k].sign, prepared.own[k].value, state.values[k]);
        let against = seen.iter().all(is_clipped);
        let place = untold(&problem, &fit, &signs, &declared, &spread, None).filter(|_| !against);
        let Some(place) = place else {
            let numbers = spread.view((stands, stands), (seen.len(), seen.len())).into_owned();
            return Ok((regression, seen, state, numbers));
        };
        if seen.len() == 1 {
            return Err(Error::NotShown(String::from(
                "the positions scatter by more than the payloads do to any joint",
            )));
        }
        prepared.hold(seen[place - stands]);
    }
}

/// The own numbers by what payloads of one visit differ by; `None` where that does not tell
/// them from each other.
fn by_payloads(
    regression: &Regression<'_>,
    start: &State,
    seen: &[usize],
    rows: &Rows,
) -> Result<Option<Solved>, Error> {
    let data = regression.data;
    let (signs, columns) = (&regression.signs_of(seen)[STANDS..], Vec::from_iter(0..seen.len()));
    let mut state = start.clone();
    let mut pass = 1;
    loop {
        let (problem, _) = regression.at(&state, seen, rows);
        let Some(within) = within_visits(&problem, data) else { return Ok(None) };
        let fit = within.total.solve_signed(&columns, signs).ok_or_else(confounded)?;
        seen.iter().zip(fit.coefficients.iter()).for_each(|(&k, &value)| state.values[k] = value);
        if pass == PASSES {
            let model = state.model(&regression.start, &regression.numbers);
            state.registration = standing(&model, data, |row| rows.has(row, data))?;
            return Ok(Some(Solved { state, problem: within, fit, signs: signs.to_vec() }));
        }
        pass += 1;
    }
}

fn confounded() -> Error {
    Error::NotShown(String::from("these positions do not tell the compliances from each other"))
}

/// Of a covariance, the part without where the robot stands.
pub fn of_numbers(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let count = covariance.nrows() - STANDS;
    covariance.view((STANDS, STANDS), (count, count)).into_owned()
}

/// What a state leaves of the readings, stacked (m).
pub fn residuals(regression: &Regression<'_>, state: &State) -> DVector<f64> {
    let points = state.model(&regression.start, &regression.numbers).points(regression.data);
    let left = regression.data.rows.iter().enumerate().flat_map(|(row, read)| {
        let point = points[row] + state.beside(&regression.numbers, row);
        let left = Vector3::from(read.position) - state.registration.placed(&point);
        [left.x, left.y, left.z]
    });
    DVector::from_vec(left.collect())
}

/// Predicts the positions of a campaign with a description; where the robot stands
/// is fitted, in the frame that positions are read in.
///
/// # Errors
/// Positions that do not tell where the robot stands, numbers so large that an error is
/// not finite.
pub fn predict(description: &Description, data: &Positions) -> Result<Prediction, Error> {
    let model = Model::new(description, data);
    let registration = standing(&model, data, |_| true)?;
    let row = |(point, row): (Vector3<f64>, &crate::campaign::PositionRow)| PredictedRow {
        line: row.line,
        predicted: registration.placed(&point).into(),
        measured: row.position,
        off: (registration.in_base(&row.position.into()) - point).into(),
    };
    Prediction::of(model.points(data).into_iter().zip(&data.rows).map(row).collect())
}

/// The estimates of a description's numbers after a fit; `spread` is the covariance of
/// those that are seen.
pub fn estimated(prepared: &Prepared<'_>, values: &[f64], spread: &DMatrix<f64>) -> Vec<Estimate> {
    let seen = prepared.seen();
    let one = |(k, own): (usize, &Own)| {
        let fitted = seen.iter().position(|&number| number == k).map(|at| spread[(at, at)]);
        Estimate::new((own.name.clone(), own.unit), (own.value, own.sign), values[k], fitted, &prepared.visibility[k])
    };
    prepared.own.iter().enumerate().map(one).collect()
}
