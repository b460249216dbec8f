//! A campaign at one setting of the nonlinear numbers, and what small changes
//! of these do to what is read: where regressors come from.

use std::rc::Rc;
use std::vec::Vec;

use nalgebra::{Const, DVector, Dyn, Matrix3, Matrix6, OMatrix, Vector3, Vector6};
use robstiff_robots::Description;

use crate::campaign::Displacements;
use crate::identify::samples::{Sample, Samples, stack, turn_of, turn_of_joint};
use crate::identify::setup::Setup;
use robstiff::elements::Spring;

/// A campaign's rows at one setting.
pub struct Point<'c> {
    /// The description as declared.
    pub description: &'c Description,
    /// The rows of the table.
    pub data: &'c Displacements,
    /// The setting.
    pub setup: Setup,
    /// The rows on the robot, at the setting.
    pub samples: Rc<Samples>,
    /// What a model's elastic effects do to the readings, stacked; empty where
    /// no model was given.
    pub elastic: DVector<f64>,
    /// The compliance of each joint (rad/Nm or m/N), from 0.
    pub compliance: Vec<f64>,
    /// By row, the readings (six) per wrench at the TCP in the base frame.
    readings: Vec<Matrix6<f64>>,
    /// By pose, those of the encoders.
    turned: Vec<Turned>,
    /// By pose, joint and entry `[theta, d, a, alpha]` of its row, the change
    /// of the readings per wrench as the file gives it.
    slopes: Slopes<Matrix6<f64>>,
    /// Those of the encoders; empty where there are none.
    turned_slopes: Slopes<Turned>,
}

/// By pose, joint and entry of its row.
type Slopes<T> = Vec<Vec<[T; 4]>>;

/// What encoders read (a row each) per wrench.
type Turned = OMatrix<f64, Dyn, Const<6>>;

/// Steps of central differences (rad, m), some tenths of a millimetre at the tool. Their error
/// goes with the square of the step, some 1e-8 of the slope, and rounding, 1e-16 m over such a
/// step, is less.
const STEP: f64 = 1e-4;

impl<'c> Point<'c> {
    /// The rows at a setting, without a model.
    pub fn bare(description: &'c Description, data: &'c Displacements, declared: &Rc<Samples>, setup: Setup) -> Self {
        // A setup that changes nothing is that of every model without nonlinear
        // numbers.
        let samples = match setup == Setup::as_declared(declared.joints()) {
            true => Rc::clone(declared),
            false => Rc::new(declared.with_setup(description, data, &setup)),
        };
        let (elastic, compliance) = (DVector::zeros(0), Vec::new());
        Self {
            description,
            data,
            setup,
            samples,
            elastic,
            compliance,
            readings: Vec::new(),
            turned: Vec::new(),
            slopes: Vec::new(),
            turned_slopes: Vec::new(),
        }
    }

    /// The same with a model: what its elastic effects do to the readings, and
    /// its springs, each with its compliance.
    pub fn with_model(mut self, declared: &Samples, elastic: DVector<f64>, springs: &[(Spring, f64)]) -> Self {
        self.elastic = elastic;
        let value = |joint: usize| {
            let own = springs.iter().filter(|(spring, _)| *spring == Spring::Joint(joint));
            own.map(|(_, value)| value).sum::<f64>()
        };
        self.compliance = (1..=self.samples.joints()).map(value).collect();
        let first = first_rows(self.data);
        let by_pose: Vec<Matrix6<f64>> =
            first.iter().map(|&row| compliance(&self.samples, &self.samples.rows[row], springs)).collect();
        let reading = |row: &Sample| {
            let per_wrench = by_pose[row.pose];
            let columns: [Vector6<f64>; 6] = core::array::from_fn(|k| row.read(&per_wrench.column(k).into_owned()));
            Matrix6::from_columns(&columns)
        };
        self.readings = self.samples.rows.iter().map(reading).collect();
        let rows = first.iter().map(|&row| &self.samples.rows[row]);
        self.turned = rows.map(|row| turned(&self.samples, row, springs)).collect();
        (self.slopes, self.turned_slopes) = self.find_slopes(declared, springs, &first);
        self
    }

    /// The changes by pose, by central differences of one row a pose.
    fn find_slopes(
        &self,
        declared: &Samples,
        springs: &[(Spring, f64)],
        first: &[usize],
    ) -> (Slopes<Matrix6<f64>>, Slopes<Turned>) {
        let mut data = self.data.clone();
        data.rows = first.iter().map(|&row| self.data.rows[row].clone()).collect();
        let mut one_a_pose = declared.clone();
        one_a_pose.rows = first.iter().map(|&row| declared.rows[row].clone()).collect();
        let mut slopes = std::vec![std::vec![[Matrix6::zeros(); 4]; declared.joints()]; first.len()];
        let encoders = declared.encoders.len();
        let still = || core::array::from_fn(|_| Turned::zeros(encoders));
        let mut by_encoders: Slopes<Turned> = Vec::new();
        if encoders > 0 {
            by_encoders = first.iter().map(|_| (0..declared.joints()).map(|_| still()).collect()).collect();
        }
        for joint in 0..declared.joints() {
            for entry in 0..4 {
                let [there, back] = [STEP, -STEP].map(|step| {
                    let mut setup = self.setup.clone();
                    setup.table[joint][entry] += step;
                    // Time, sag and what a load is off by are each row's own.
                    setup.creep = [0.0, 1.0];
                    setup.sag = None;
                    setup.loads.clear();
                    let samples = one_a_pose.with_setup(self.description, &data, &setup);
                    let per_file = |row: &Sample| {
                        let compliance = compliance(&samples, row, springs);
                        let tool = turn_of(&row.tcp);
                        let offset = setup.wrench(&data, &tool, &[0.0; 6]);
                        let column = |k: usize| {
                            let mut unit = [0.0; 6];
                            unit[k] = 1.0;
                            setup.wrench(&data, &tool, &unit) - offset
                        };
                        let wrenches = Matrix6::from_columns(&core::array::from_fn::<_, 6, _>(column));
                        let read = wrenches.column_iter().map(|wrench| row.read(&(compliance * wrench)));
                        let read = Matrix6::from_columns(&read.collect::<Vec<_>>());
                        (read, turned(&samples, row, springs) * wrenches)
                    };
                    samples.rows.iter().map(per_file).collect::<Vec<_>>()
                });
                for (pose, (there, back)) in there.into_iter().zip(back).enumerate() {
                    slopes[pose][joint][entry] = (there.0 - back.0) / (2.0 * STEP);
                    if encoders > 0 {
                        by_encoders[pose][joint][entry] = (there.1 - back.1) / (2.0 * STEP);
                    }
                }
            }
        }
        (slopes, by_encoders)
    }

    /// The change of the readings with an entry `[theta, d, a, alpha]` of the
    /// row of a joint (from 1), times a factor of each of the campaign's rows.
    pub fn slope(&self, joint: usize, entry: usize, factor: impl Fn(usize) -> f64) -> DVector<f64> {
        let wrench = |at: usize| Vector6::from(self.data.rows[at].wrench) * self.setup.of_load(at);
        self.samples.stacked_with(
            |at, row| self.slopes[row.pose][joint - 1][entry] * wrench(at) * factor(at),
            |at, k| {
                let slopes = &self.turned_slopes[self.samples.rows[at].pose][joint - 1][entry];
                slopes.row(k).tr_dot(&wrench(at)) * factor(at)
            },
        )
    }

    /// The change of the readings with a number of the setup that the wrench
    /// depends on.
    pub fn of_wrench(&self, enters: impl Fn(&mut Setup, f64), step: f64) -> DVector<f64> {
        let [there, back] = self.setups(enters, step);
        let change = |at: usize| {
            let tool = turn_of(&self.samples.rows[at].tcp);
            let wrench = |setup: &Setup| setup.wrench(self.data, &tool, &self.data.rows[at].wrench);
            (wrench(&there) - wrench(&back)) * (self.setup.of_load(at) / (2.0 * step))
        };
        self.samples.stacked_with(
            |at, _| self.readings[at] * change(at),
            |at, k| self.turned[self.samples.rows[at].pose].row(k).tr_dot(&change(at)),
        )
    }

    /// The change of the readings with a number of the setup that decides how
    /// vectors are seen.
    pub fn of_sight(&self, declared: &[Matrix3<f64>], enters: impl Fn(&mut Setup, f64), step: f64) -> DVector<f64> {
        let [there, back] = self.setups(enters, step);
        self.samples.stacked_by(|at, row| {
            let tool = turn_of(&row.tcp);
            let seen = |setup: &Setup| setup.seen(self.data, &declared[at], &tool);
            let turn = (seen(&there) - seen(&back)) / (2.0 * step) * row.seen.transpose();
            let elastic = self.elastic_of(at);
            let [moved, turned] = [0, 3].map(|k| turn * elastic.fixed_rows::<3>(k));
            stack(&moved, &turned)
        })
    }

    /// The change of the readings with where on the tool the point that is read sits,
    /// along an axis of the tool frame: what the tool turns by makes a lever of it.
    pub fn of_marker(&self, axis: usize) -> DVector<f64> {
        self.samples.stacked_by(|at, row| {
            let turn = (self.readings[at] * row.wrench).fixed_rows::<3>(3).into_owned();
            let along = row.seen * turn_of(&row.tcp).column(axis);
            stack(&turn.cross(&along), &Vector3::zeros())
        })
    }

    /// What the elastic effects do to a row, six.
    pub fn elastic_of(&self, row: usize) -> Vector6<f64> {
        let axes = self.samples.axes;
        Vector6::from_fn(|k, _| if k < axes { self.elastic[row * axes + k] } else { 0.0 })
    }

    /// The change of the readings where the load of each row is by so much of itself another.
    pub fn of_loads(&self, factors: &[f64]) -> DVector<f64> {
        let share = |at: usize| factors[at] / self.setup.of_load(at);
        let by_encoder = |at: usize, k: usize| self.elastic[self.samples.encoders_of(at).start + k] * share(at);
        self.samples.stacked_with(|at, _| self.elastic_of(at) * share(at), by_encoder)
    }

    /// The displacement of a joint (from 1) by an amount that depends on the
    /// row, as it is read; (rad or m).
    pub fn of_joint(&self, joint: usize, amount: impl Fn(usize) -> f64) -> DVector<f64> {
        self.samples.turned(joint, amount)
    }

    /// A displacement of the point that is read, in the base frame (m), as it is
    /// seen.
    pub fn of_reading(&self, of: impl Fn(usize) -> Vector3<f64>) -> DVector<f64> {
        self.samples.stacked_by(|at, row| stack(&(row.seen * of(at)), &Vector3::zeros()))
    }

    /// What creep adds of stacked elastic displacements at a share of 1: every
    /// step from one row of a visit to the next grows by `log10(1 + t / onset)`
    /// of itself in the time `t` since it was made. The load of a row is put on
    /// when the row before it was read.
    pub fn crept(&self, elastic: &DVector<f64>, onset: f64) -> DVector<f64> {
        let (clock, pace) = self.data.clock();
        let axes = self.samples.axes;
        let places = |row: usize| (row * axes..(row + 1) * axes).chain(self.samples.encoders_of(row));
        let mut grown = DVector::zeros(elastic.len());
        let mut visits = std::vec![Vec::new(); self.data.visits.len()];
        for (row, observation) in self.data.rows.iter().enumerate() {
            let before: &mut Vec<usize> = &mut visits[observation.visit];
            before.push(row);
            for (k, &step) in before.iter().enumerate() {
                let made = if k == 0 { clock[step] - pace } else { clock[before[k - 1]] };
                let share = ((clock[row] - made).max(0.0) / onset).ln_1p() / core::f64::consts::LN_10;
                let mut last = (k > 0).then(|| places(before[k - 1])).into_iter().flatten();
                for (at, own) in places(row).zip(places(step)) {
                    let last = last.next().map_or(0.0, |last| elastic[last]);
                    grown[at] += share * (elastic[own] - last);
                }
            }
        }
        grown
    }

    /// Stacked elastic displacements with the creep of the setting.
    pub fn with_creep(&self, elastic: DVector<f64>) -> DVector<f64> {
        let [share, onset] = self.setup.creep;
        if share == 0.0 {
            return elastic;
        }
        let grown = self.crept(&elastic, onset);
        elastic + grown * share
    }

    /// The torque of every row about a joint (from 1).
    pub fn torques(&self, joint: usize) -> Vec<f64> {
        self.samples.torques(joint)
    }

    fn setups(&self, enters: impl Fn(&mut Setup, f64), step: f64) -> [Setup; 2] {
        [step, -step].map(|step| {
            let mut setup = self.setup.clone();
            enters(&mut setup, step);
            setup
        })
    }
}

/// The first row of each pose; of one without rows, which nothing asks for, that of all.
fn first_rows(data: &Displacements) -> Vec<usize> {
    let mut first = std::vec![0; data.poses.len()];
    for (i, row) in data.rows.iter().enumerate().rev() {
        first[row.pose] = i;
    }
    first
}

/// What encoders read per wrench, of springs, at a row.
fn turned(samples: &Samples, row: &Sample, springs: &[(Spring, f64)]) -> Turned {
    let of = |joint: usize, k: usize| -> f64 {
        let of = |&(spring, value): &(Spring, f64)| {
            value * samples.share(spring, row) * turn_of_joint(spring, joint, |j| row.twists[j - 1][k])
        };
        springs.iter().map(of).sum()
    };
    Turned::from_fn(samples.encoders.len(), |encoder, k| of(samples.encoders[encoder], k))
}

/// The Cartesian compliance of springs, at a row.
fn compliance(samples: &Samples, row: &Sample, springs: &[(Spring, f64)]) -> Matrix6<f64> {
    let geometry = samples.geometry(row);
    let of = |&(spring, value): &(Spring, f64)| geometry.unit_compliance(spring) * (value * samples.share(spring, row));
    springs.iter().filter(|(_, value)| *value != 0.0).map(of).sum()
}
