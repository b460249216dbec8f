//! From the regression that tracing uses to what planning asks for; the only
//! place in planning that knows how numbers become readings.

use std::format;
use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, Matrix4, Vector3, Vector6};
use robstiff_robots::Description;

use super::regressors::{Regressors, Sensor, Visit};
use super::rivals::{Contest, Group, Number, Rival, Rivals};
use crate::campaign::{Campaign, Displacements, Frame, Observation};
use crate::elements::{Geometry, Parameter};
use crate::identify::baseline::columns_of;
use crate::identify::normal::Sign;
use crate::identify::prepare::Prepared;
use crate::identify::problem::Problem;
use crate::identify::samples::{Column, Sample, Samples};
use crate::identify::whitening::whiten;
use crate::identify::{Error, element_name, parameter_name, unit_of};
use crate::trace::Trace;
use crate::trace::candidate::{Candidate, Variant, catalogue};

/// One sigma of a rotation reading where the campaign states none (rad): that
/// of a laser tracker's six-axis probe at some metres.
pub const ROTATION_NOISE: f64 = 5e-5;

/// One sigma of an encoder on the output side of a gear (rad): one second of
/// arc.
pub const ENCODER_NOISE: f64 = 5e-6;

/// How far markers on a link stand from its end, and how much further out the
/// second lever acts (m).
pub const REACH: f64 = 0.3;

/// The levels of [`Sensor::Levels`], as shares of the greatest load.
pub const LEVELS: [f64; 5] = [0.025, 0.25, 0.5, 1.0, -1.0];

/// A traced campaign, with the numbers that planning looks at.
pub struct Adapter<'c> {
    description: &'c Description,
    data: Displacements,
    columns: Vec<Column>,
    known: DMatrix<f64>,
    axes: usize,
    rotation_weight: f64,
    noise: f64,
    rotation_noise: f64,
}

/// The regression of a campaign with the catalogue behind it.
struct Catalogue<'p> {
    prepared: Prepared<'p>,
    candidates: Vec<Candidate>,
    problem: Problem,
    signs: Vec<Sign>,
}

impl<'c> Adapter<'c> {
    /// For a campaign and its trace, with groups of rivals.
    ///
    /// # Errors
    /// A campaign of another kind, or one that sees none of the numbers.
    pub fn new(campaign: &'c Campaign, trace: &Trace, groups: &[Group]) -> Result<(Self, Rivals), Error> {
        let prepared = Prepared::new(campaign)?;
        let (candidates, further) = catalogue(&campaign.robot, &prepared.samples, prepared.own.len());
        let (problem, signs) = (prepared.problem(&further), prepared.signs(&further));
        let catalogue = Catalogue { prepared, candidates, problem, signs };
        let mut kept = catalogue.prepared.seen();
        let rivals = catalogue.rivals(campaign, trace, groups, &mut kept);
        let (prepared, problem) = (&catalogue.prepared, &catalogue.problem);
        let white = problem.white.select_columns(&kept);
        let data = Displacements { wrench_frame: Frame::Base, rows: Vec::new(), ..prepared.data.clone() };
        let adapter = Self {
            description: &campaign.robot,
            data,
            columns: kept.iter().map(|&column| problem.columns[column]).collect(),
            known: white.tr_mul(&white),
            axes: problem.axes,
            rotation_weight: prepared.rotation_weight,
            noise: trace.noise,
            rotation_noise: campaign.noise.rotation.unwrap_or(ROTATION_NOISE),
        };
        Ok((adapter, rivals))
    }

    /// The variance of one displacement reading (m^2).
    pub fn variance(&self) -> f64 {
        self.noise * self.noise
    }

    /// Whether rotations are read.
    pub fn reads_rotations(&self) -> bool {
        self.axes > 3
    }

    /// The number of joints.
    pub fn joints(&self) -> usize {
        self.description.joints.len()
    }

    /// How many numbers some visits read.
    pub fn readings(&self, visits: &[Visit]) -> usize {
        self.axes * visits.iter().map(|visit| visit.loads.len()).sum::<usize>()
    }

    /// The rows of some visits on the robot, with their visits.
    fn samples(&self, visits: &[Visit], axes: usize, further_out: f64) -> Samples {
        let mut data = self.data.clone();
        data.wrench_at[2] += further_out;
        data.rows.extend(visits.iter().enumerate().flat_map(|(index, visit)| {
            visit.loads.iter().map(move |&wrench| Observation {
                line: 0,
                pose: index,
                visit: index,
                time: None,
                temperature: None,
                q: visit.q.clone(),
                wrench,
                displacement: [0.0; 3],
                rotation: (axes > 3).then_some([0.0; 3]),
            })
        }));
        Samples::of_description(self.description, &data)
    }

    /// What is read at the tool.
    fn at_the_tool(&self, visits: &[Visit], axes: usize, weight: f64, further_out: f64) -> Vec<DMatrix<f64>> {
        let samples = self.samples(visits, axes, further_out);
        let mut stacked = DMatrix::zeros(samples.rows.len() * axes, self.columns.len());
        for (k, &column) in self.columns.iter().enumerate() {
            stacked.set_column(k, &samples.column(column));
        }
        for (i, mut row) in stacked.row_iter_mut().enumerate() {
            if i % axes >= 3 {
                row *= weight;
            }
        }
        grams(stacked, &samples, axes, visits)
    }

    /// What is read elsewhere on the robot, `count` numbers a row.
    fn elsewhere(
        &self,
        visits: &[Visit],
        count: usize,
        read: impl Fn(&Geometry<'_, f64>, &Sample, Column) -> Vec<f64>,
    ) -> Vec<DMatrix<f64>> {
        let samples = self.samples(visits, 3, 0.0);
        let mut stacked = DMatrix::zeros(samples.rows.len() * count, self.columns.len());
        for (i, row) in samples.rows.iter().enumerate() {
            let geometry = samples.geometry(row);
            for (k, &column) in self.columns.iter().enumerate() {
                let values = read(&geometry, row, column);
                stacked.view_mut((i * count, k), (count, 1)).copy_from_slice(&values);
            }
        }
        grams(stacked, &samples, count, visits)
    }
}

impl Regressors for Adapter<'_> {
    fn known(&self) -> DMatrix<f64> {
        self.known.clone()
    }

    fn information(&self, visits: &[Visit], besides: Option<Sensor>) -> Vec<DMatrix<f64>> {
        let tool = || self.at_the_tool(visits, self.axes, self.rotation_weight, 0.0);
        let further = match besides {
            None => return tool(),
            Some(Sensor::Rotations) => {
                return self.at_the_tool(visits, 6, self.noise / self.rotation_noise, 0.0);
            }
            Some(Sensor::Levels) => {
                let levels = |visit: &Visit| {
                    let greatest = visit.greatest();
                    let loads = LEVELS.iter().map(|share| greatest.map(|value| share * value));
                    Visit { q: visit.q.clone(), loads: loads.collect() }
                };
                let visits: Vec<Visit> = visits.iter().map(levels).collect();
                return self.at_the_tool(&visits, self.axes, self.rotation_weight, 0.0);
            }
            Some(Sensor::Lever) => self.at_the_tool(visits, self.axes, self.rotation_weight, REACH),
            Some(Sensor::Markers(body)) => {
                self.elsewhere(visits, 9, |geometry, row, column| markers(geometry, row, column, body))
            }
            Some(Sensor::Encoders) => {
                let weight = self.noise / ENCODER_NOISE;
                let joints = self.joints();
                self.elsewhere(visits, joints, |geometry, row, column| {
                    let mut turns = gears(geometry, row, column, joints);
                    turns.iter_mut().for_each(|turn| *turn *= weight);
                    turns
                })
            }
        };
        tool().into_iter().zip(further).map(|(tool, further)| tool + further).collect()
    }
}

/// The information of each visit from its rows' columns, stacked; the readings
/// of a visit share their unloaded one.
fn grams(mut stacked: DMatrix<f64>, samples: &Samples, axes: usize, visits: &[Visit]) -> Vec<DMatrix<f64>> {
    whiten(&mut stacked, &samples.visits(), axes);
    let mut first = 0;
    let mut gram = |visit: &Visit| {
        let count = visit.loads.len() * axes;
        let rows = stacked.rows(first, count);
        first += count;
        rows.tr_mul(&rows)
    };
    visits.iter().map(&mut gram).collect()
}

/// What a unit of a column's number does, as twists of the TCP, each with the
/// number of joints before the place where it happens.
fn parts(geometry: &Geometry<'_, f64>, row: &Sample, column: Column) -> Vec<(usize, Vector6<f64>)> {
    let joints = geometry.joint_frames.len();
    let parameter = match column {
        Column::Linear(parameter) => parameter,
        Column::Knee { joint, .. } => {
            return vec![(joint, geometry.joint_twist(joint) * gears(geometry, row, column, joints)[joint - 1])];
        }
    };
    let place = match parameter {
        Parameter::Joint(i) | Parameter::Transverse(i) => i,
        Parameter::LinkBending(i) | Parameter::LinkTorsion(i) => i,
        Parameter::BaseTilt | Parameter::BaseTranslation => 0,
        Parameter::ToolRotation | Parameter::ToolTranslation => joints + 1,
        Parameter::Coupling(pair) => {
            let turns = gears(geometry, row, column, joints);
            return pair.iter().map(|&i| (i, geometry.joint_twist(i) * turns[i - 1])).collect();
        }
    };
    vec![(place, geometry.unit_compliance(parameter) * row.wrench)]
}

/// How far a unit of a column's number turns each gear.
fn gears(geometry: &Geometry<'_, f64>, row: &Sample, column: Column, joints: usize) -> Vec<f64> {
    let mut turns = vec![0.0; joints];
    let torque = |joint: usize| geometry.joint_twist(joint).dot(&row.wrench);
    match column {
        Column::Linear(Parameter::Joint(joint)) => turns[joint - 1] = torque(joint),
        Column::Linear(Parameter::Coupling([i, j])) => (turns[i - 1], turns[j - 1]) = (torque(j), torque(i)),
        Column::Linear(_) => {}
        Column::Knee { joint, knee } => turns[joint - 1] = torque(joint) / (torque(joint) / knee).hypot(1.0),
    }
    turns
}

/// The displacements of three markers about the far end of the body behind
/// `body` joints.
fn markers(geometry: &Geometry<'_, f64>, row: &Sample, column: Column, body: usize) -> Vec<f64> {
    let origin = |frame: &Matrix4<f64>| -> Vector3<f64> { frame.fixed_view::<3, 1>(0, 3).into_owned() };
    let end = origin(geometry.joint_frames.get(body).unwrap_or(&geometry.flange));
    let mut read = Vec::with_capacity(9);
    for axis in 0..3 {
        let lever = end + Vector3::ith(axis, REACH) - origin(&geometry.tcp);
        let seen = parts(geometry, row, column).into_iter().filter(|(place, _)| *place <= body);
        let moved = seen.map(|(_, twist)| twist.fixed_rows::<3>(0) + twist.fixed_rows::<3>(3).cross(&lever));
        read.extend(moved.sum::<Vector3<f64>>().iter());
    }
    read
}

impl Catalogue<'_> {
    /// The rivals of a trace. `kept` holds the problem's columns that planning
    /// looks at, first those of the description; rivals refer to them by index.
    fn rivals(&self, campaign: &Campaign, trace: &Trace, groups: &[Group], kept: &mut Vec<usize>) -> Rivals {
        let base = kept.clone();
        // Every effect named with its columns, and a group's rivals beside all
        // named ones but its own.
        let named: Vec<Vec<usize>> = trace
            .effects
            .iter()
            .map(|named| {
                let numbers = columns_of(&named.effect).into_iter().filter(|(_, value)| *value != 0.0);
                let at = |column: Column| self.problem.columns.iter().position(|&other| other == column);
                numbers.filter_map(|(column, _)| at(column)).collect()
            })
            .collect();
        let model: Vec<usize> = base.iter().chain(named.iter().flatten()).copied().collect();
        let effects: Vec<usize> = named.concat();
        let numbers = self.numbers(campaign, trace, &model, base.len());
        let mut place = |column: usize| {
            kept.iter().position(|&other| other == column).unwrap_or_else(|| {
                kept.push(column);
                kept.len() - 1
            })
        };
        let mut places = |columns: &[usize]| -> Vec<usize> { columns.iter().map(|&column| place(column)).collect() };
        let mut pairs = Vec::new();
        for Group { named: own, names } in groups {
            let others = named.iter().enumerate().filter(|(k, _)| Some(*k) != *own).flat_map(|(_, columns)| columns);
            let core: Vec<usize> = base.iter().chain(others).copied().collect();
            let found = names.iter().filter_map(|name| Some((name, self.best(name, &core)?)));
            let found: Vec<(&String, (&Variant, Vec<f64>))> = found.collect();
            for (k, (one, of_one)) in found.iter().enumerate() {
                for (other, of_other) in &found[k + 1..] {
                    let rivals = [of_one, of_other].map(|(variant, values)| Rival {
                        columns: places(&variant.columns),
                        values: values.clone(),
                        parameters: variant.parameters,
                    });
                    pairs.push(Contest::new([one.to_string(), other.to_string()], rivals, places(&core)));
                }
            }
        }
        Rivals { model: places(&model), effects: places(&effects), numbers, pairs }
    }

    /// The variant of a candidate that fits best beside other columns, with its
    /// numbers; none that is unphysical.
    fn best(&self, name: &str, core: &[usize]) -> Option<(&Variant, Vec<f64>)> {
        let candidate = self.candidates.iter().find(|candidate| candidate.name() == name)?;
        let rows = self.problem.total.rows as f64;
        let fit = |variant: &'_ Variant| {
            let columns = [core, &variant.columns].concat();
            let signs: Vec<Sign> = columns.iter().map(|&column| self.signs[column]).collect();
            let fit = self.problem.total.solve_signed(&columns, &signs)?;
            let values: Vec<f64> = fit.coefficients.iter().skip(core.len()).copied().collect();
            let price = variant.parameters as f64 * rows.ln();
            let bic = rows * (fit.rss / rows).ln() + price;
            values.iter().all(|value| *value != 0.0).then_some((bic, values))
        };
        let fits = candidate.variants.iter().filter(|variant| !variant.sentinel);
        let fits = fits.filter_map(|variant| fit(variant).map(|(bic, values)| (bic, variant, values)));
        fits.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, variant, values)| (variant, values))
    }

    /// What the model's numbers are; the first `own` are the description's.
    fn numbers(&self, campaign: &Campaign, trace: &Trace, model: &[usize], own: usize) -> Vec<Number> {
        let declared = model[..own].iter().map(|&k| {
            let number = &self.prepared.own[k];
            let name = element_name(&campaign.robot, number);
            let value = trace.estimates.get(k).map_or(number.value, |estimate| estimate.value);
            Number { name, unit: unit_of(&campaign.robot, number.column), value }
        });
        let effects = trace.effects.iter().flat_map(|named| {
            let numbers = columns_of(&named.effect).into_iter().filter(|(_, value)| *value != 0.0);
            numbers.map(|(column, value)| {
                let name: String = match parameter_name(column) {
                    "value" => named.effect.to_string(),
                    number => format!("{} {number}", named.effect),
                };
                Number { name, unit: unit_of(&campaign.robot, column), value }
            })
        });
        declared.chain(effects).collect()
    }
}
