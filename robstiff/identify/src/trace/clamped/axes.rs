//! The rows of clamped axes, and what effects do to them.

use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::DVector;

use crate::campaign::ClampedRow;
use crate::identify::Identification;
use crate::identify::baseline::Visibility;
use crate::identify::clamped::regression::rows_of;
use crate::identify::clamped::rounding::of_rounding;
use crate::identify::clamped::without_laws;
use crate::identify::column::Column;
use crate::trace::catalogue::Kind;
use crate::trace::found::{EffectParameter, Place};
use crate::trace::slip::SLIPPED_AT;
use robstiff::elements::Torque;
use robstiff::{Effect, JointKind};
use robstiff_robots::Description;
use robstiff_robots::effect::Place as Part;

/// The rows of a campaign, axis by axis.
#[derive(Clone, Debug)]
pub struct Axes {
    /// The rows that are used, in the file's order, less what declared laws do.
    pub rows: Vec<ClampedRow>,
    /// All rows: a load was put on, whatever was read.
    every: Rc<[ClampedRow]>,
    /// Those that are used, by index.
    kept: Rc<[usize]>,
    /// The compliance of each axis (rad/Nm or m/N), from 0.
    pub compliance: Vec<f64>,
    /// The least variance of the readings of each axis that their
    /// [rounding](of_rounding) lets be, from 0.
    pub rounding: Rc<[f64]>,
    /// What acts besides the torque that is read (Nm), by a model that says so.
    pub bias: f64,
    kinds: Vec<JointKind>,
    seen: Vec<bool>,
    declared: Vec<Effect>,
}

impl Axes {
    /// The rows of a campaign on a robot whose axes were identified.
    pub fn new(robot: &Description, rows: &[ClampedRow], identified: &Identification) -> Self {
        let joints = &identified.estimates[..robot.joints.len()];
        let (rounding, rows) = (of_rounding(rows), without_laws(robot, rows));
        Self {
            rounding: rounding.into(),
            every: rows.as_slice().into(),
            kept: (0..rows.len()).collect(),
            rows,
            compliance: joints.iter().map(|estimate| estimate.value).collect(),
            bias: 0.0,
            kinds: robot.joints.iter().map(|joint| joint.kind).collect(),
            declared: robot.effects.clone(),
            seen: joints.iter().map(|estimate| estimate.visibility == Visibility::Seen).collect(),
        }
    }

    /// The same axes with all rows.
    pub fn whole(&self) -> Self {
        Self { rows: self.every.to_vec(), kept: (0..self.every.len()).collect(), ..self.clone() }
    }

    /// The same axes without some rows, by index.
    pub fn without(&self, rows: &[usize]) -> Self {
        let kept: Rc<[usize]> =
            self.kept.iter().enumerate().filter(|(row, _)| !rows.contains(row)).map(|(_, &row)| row).collect();
        Self { rows: kept.iter().map(|&row| self.every[row]).collect(), kept, ..self.clone() }
    }

    /// The rows that are left out.
    pub fn left_out(&self) -> impl Iterator<Item = &ClampedRow> {
        (0..self.every.len()).filter(|row| !self.kept.contains(row)).map(|row| &self.every[row])
    }

    /// What effects do to the rows that are used, given what they do to all.
    pub fn of_used(&self, offers: Vec<OnAxes>) -> Vec<OnAxes> {
        let used = |form: OnAxesForm| {
            let (all, kept) = (form.columns, Rc::clone(&self.kept));
            let columns: Columns =
                Rc::new(move |shape| all(shape).iter().map(|column| column.select_rows(kept.iter())).collect());
            OnAxesForm { columns, ..form }
        };
        let used = |one: OnAxes| OnAxes { forms: one.forms.into_iter().map(used).collect(), ..one };
        offers.into_iter().map(used).collect()
    }

    /// Whether the description has an effect of a kind at a place.
    pub fn declares(&self, kind: &Kind, place: Place) -> bool {
        self.declared.iter().any(|effect| kind.is_of(effect) && place == effect.place().into())
    }

    /// The axes (from 1) that are loaded.
    pub fn loaded(&self) -> impl Iterator<Item = usize> + '_ {
        (1..=self.seen.len()).filter(|axis| self.seen[axis - 1])
    }

    /// The rows of an axis, by index.
    pub fn rows_of(&self, axis: usize) -> Vec<usize> {
        rows_of(&self.rows, axis)
    }

    /// The torques on an axis (Nm), in order.
    pub fn torques(&self, axis: usize) -> Vec<f64> {
        self.rows.iter().filter(|row| row.axis == axis).map(|row| row.torque).collect()
    }

    /// What loads the gear of an axis (Nm), in order: what is read, and what acts besides.
    pub fn loads(&self, axis: usize) -> Vec<f64> {
        self.torques(axis).into_iter().map(|torque| torque + self.bias).collect()
    }

    /// How far an axis turns by its compliance alone (rad), in order.
    pub fn turns(&self, axis: usize) -> Vec<f64> {
        self.torques(axis).into_iter().map(|torque| torque * self.compliance[axis - 1]).collect()
    }

    /// Whether an axis is loaded to both sides.
    pub fn is_loaded_both_ways(&self, axis: usize) -> bool {
        let torques = self.torques(axis);
        torques.iter().any(|&torque| torque > 0.0) && torques.iter().any(|&torque| torque < 0.0)
    }

    /// The largest torque on an axis (Nm), without sign.
    pub fn largest(&self, axis: usize) -> f64 {
        self.torques(axis).into_iter().map(f64::abs).fold(0.0, f64::max)
    }

    /// Whether an axis turns, and does not slide.
    fn turns_about(&self, axis: usize) -> bool {
        self.kinds[axis - 1] == JointKind::Revolute
    }

    /// The unit of the compliance of an axis.
    pub fn unit(&self, axis: usize) -> &'static str {
        if self.turns_about(axis) { "rad/Nm" } else { "m/N" }
    }

    /// The unit of what moves an axis.
    pub fn torque_unit(&self, axis: usize) -> &'static str {
        if self.turns_about(axis) { "Nm" } else { "N" }
    }

    /// The unit of how far it moves.
    pub fn turn_unit(&self, axis: usize) -> &'static str {
        if self.turns_about(axis) { "rad" } else { "m" }
    }
}

/// A column that is zero but in some of `count` rows.
pub fn axes_column(count: usize, rows: &[usize], values: impl IntoIterator<Item = f64>) -> DVector<f64> {
    let mut column = DVector::zeros(count);
    rows.iter().zip(values).for_each(|(&row, value)| column[row] = value);
    column
}

/// A number of an effect.
#[derive(Clone, Copy, Debug)]
pub struct AxisNumber {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The values that are physically possible, exclusive.
    pub range: [f64; 2],
}

/// The number by which a slip says the axis.
pub const SLIPPED_AXIS: &str = "axis";

/// What a unit of each number does to the rows, given the numbers out of grids.
type Columns = Rc<dyn Fn(&[f64]) -> Vec<DVector<f64>>>;

/// An effect on clamped axes: its forms, of which it has one.
#[derive(Clone)]
pub struct OnAxes {
    /// Where it is.
    pub place: Place,
    /// The forms.
    pub forms: Vec<OnAxesForm>,
}

/// One form of it.
#[derive(Clone)]
pub struct OnAxesForm {
    /// Its numbers.
    pub numbers: Vec<AxisNumber>,
    /// Those out of a grid.
    pub shape: Vec<EffectParameter>,
    /// What is told of it besides, as it is: which row of which axis it begins at.
    pub told: Vec<EffectParameter>,
    /// What a unit of each number does to the rows.
    pub columns: Columns,
    /// Where numbers out of a grid go by this name.
    pub within: [f64; 2],
    /// What such a number is likely to be, and by what factor off, in logarithms.
    pub likely: Option<[f64; 2]>,
}

impl OnAxes {
    /// An effect with numbers and, by name and unit, those out of a grid, a form
    /// for each set of them.
    pub fn new(
        place: impl Into<Place>,
        numbers: Vec<AxisNumber>,
        shape: &[(&'static str, &'static str)],
        grid: Vec<Vec<f64>>,
        columns: impl Fn(&[f64]) -> Vec<DVector<f64>> + 'static,
    ) -> Self {
        let columns: Columns = Rc::new(columns);
        let form = |values: Vec<f64>| OnAxesForm {
            numbers: numbers.clone(),
            shape: shape
                .iter()
                .zip(values)
                .map(|(&(name, unit), value)| EffectParameter { name, value, std: None, unit })
                .collect(),
            told: Vec::new(),
            columns: Rc::clone(&columns),
            within: [0.0, f64::INFINITY],
            likely: None,
        };
        Self { place: place.into(), forms: grid.into_iter().map(form).collect() }
    }

    /// A shift of the readings of an axis from one of its rows on, by its place among them.
    pub fn slip(axes: &Axes, axis: usize, from: usize, most: f64) -> Self {
        let at = axes.rows_of(axis).split_off(from);
        let (count, line) = (axes.rows.len(), axes.rows[at[0]].line);
        let number = AxisNumber { name: "shift", unit: axes.turn_unit(axis), range: [-most, most] };
        let told = |name, value: usize| EffectParameter { name, value: value as f64, std: None, unit: "1" };
        let column = move |_: &[f64]| vec![axes_column(count, &at, at.iter().map(|_| 1.0))];
        let mut slip = Self::new(Part::Base, vec![number], &[], vec![Vec::new()], column);
        slip.forms[0].told = vec![told(SLIPPED_AT, line), told(SLIPPED_AXIS, axis)];
        slip
    }

    /// A law of a joint with one number and a knee, which is tried at fractions of
    /// the largest torque and goes by its name between two others: `curve` is the number
    /// of a joint at a knee.
    pub fn with_knee(
        axes: &Axes,
        axis: usize,
        number: AxisNumber,
        [tried, within]: [&[f64]; 2],
        curve: fn(joint: usize, knee: f64) -> Column,
    ) -> Self {
        let (torques, largest) = (axes.loads(axis), axes.largest(axis));
        let (at, count) = (axes.rows_of(axis), axes.rows.len());
        let column = move |knee: f64| {
            axes_column(count, &at, torques.iter().map(|&torque| curve(axis, knee).turn(Torque::of(torque))))
        };
        let knees = tried.iter().map(|fraction| vec![fraction * largest]).collect();
        let shape = [("knee", axes.torque_unit(axis))];
        Self::new(Part::Joint(axis), vec![number], &shape, knees, move |shape| vec![column(shape[0])])
            .within([within[0] * largest, within[1] * largest])
    }

    /// One effect with the forms of several.
    pub fn one_of(several: Vec<Self>) -> Option<Self> {
        let place = several.first()?.place;
        Some(Self { place, forms: several.into_iter().flat_map(|one| one.forms).collect() })
    }

    /// The same with numbers out of the grid that go by this name within bounds
    /// only.
    pub fn within(mut self, bounds: [f64; 2]) -> Self {
        self.forms.iter_mut().for_each(|form| form.within = bounds);
        self
    }

    /// The same with numbers out of the grid that are likely to be this.
    pub fn likely(mut self, likely: [f64; 2]) -> Self {
        self.forms.iter_mut().for_each(|form| form.likely = Some(likely));
        self
    }
}

impl OnAxesForm {
    /// The values of the numbers out of the grid.
    pub fn values(&self) -> Vec<f64> {
        self.shape.iter().map(|number| number.value).collect()
    }
}
