//! From a campaign of positions to a regression: where the robot stands, and what the
//! positions can see.

use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DVector, Vector3};

use super::model::{Enters, Model, State};
use super::own::{Own, compliances, kinematic};
use super::registration::Registration;
use super::regression::{Regression, Rows, STANDS};
use crate::campaign::{Campaign, Positions};
use crate::identify::Error;
use crate::identify::baseline::{Visibility, visibility};
use crate::identify::holdout::training_of;
use crate::identify::normal::{Normal, Projected, Scaled, Sign};

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
        let training: Rc<[bool]> = training_of(data.poses.len(), campaign).into();
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
    pub fn leave_out(&mut self, rows: &[usize], campaign: &Campaign) -> Result<(), Error> {
        self.rows.left_out.fill(false);
        rows.iter().for_each(|&row| self.rows.left_out[row] = true);
        let declared = Model::new(&campaign.robot, self.data);
        self.registration = standing(&declared, self.data, |row| self.rows.has(row, self.data))?;
        Ok(())
    }

    /// Holds an own number as declared from now on.
    pub fn hold(&mut self, number: usize) {
        self.visibility[number] = Visibility::Unseen;
        let own = &self.own[number];
        own.add_to(&mut self.start.description, own.value);
    }

    /// The own numbers that the positions show, by index.
    pub fn seen(&self) -> Vec<usize> {
        (0..self.own.len()).filter(|&k| self.visibility[k] == Visibility::Seen).collect()
    }

    /// The regression on all own numbers, and further numbers.
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
///
/// # Errors
/// Rows that do not tell.
pub fn standing(model: &Model, data: &Positions, of_row: impl Fn(usize) -> bool) -> Result<Registration, Error> {
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
