//! The first poses and loads, on a robot of which nothing was measured yet.
//!
//! A Bayesian D-optimal design (Chaloner and Verdinelli, Statistical Science 10, 1995): every
//! number of the description, of what it may lack and of what may be wrong with load cell and
//! tracker has its likely size as prior, and each visit in turn is the one that adds most to the
//! logarithm of the determinant of the information. What is alike in all visits so far tells
//! nothing apart, and gains nothing.

use std::string::String;
use std::vec;
use std::vec::Vec;

use nalgebra::{Cholesky, DMatrix};
use robstiff_robots::Description;

use super::Options;
use super::regressors::Visit;
use super::space::{Space, directions};
use crate::campaign::{AXES, Campaign, Data, Displacements, Frame, Noise, Observation as Row};
use crate::effects::Side;
use crate::fit::case::Case;
use crate::identify::Error;
use crate::model::Size;
use crate::select::Layout;

/// The loads of a visit as shares of its greatest: up, and down again, so that play and friction show.
pub const RAMP: [f64; 4] = [0.25, 0.5, 1.0, 0.5];

/// The greatest force where none is given (N).
pub const FORCE: f64 = 500.0;

/// The noise that is assumed of a reading (m): that of a dial gauge.
const NOISE: f64 = 1e-5;

/// What nothing is known of may move the readings so far (m).
const FLAT: f64 = 1e-3;

/// So many poses are looked at for each that is wanted, and at least so many.
const CANDIDATES: usize = 3;
const FEWEST: usize = 60;

/// Faults of the rig that every reading has; those of a moment or of single readings no pose tells
/// apart.
const OF_RIG: [&str; 6] = [
    "load_cell_bias",
    "load_cell_scale",
    "load_cell_misalignment",
    "lever_arm",
    "tracker_misalignment",
    "reflector_offset",
];

/// What to measure first.
#[derive(Clone, Debug)]
pub struct First {
    /// The visits, the one that gives most first.
    pub visits: Vec<Visit>,
    /// The greatest force (N).
    pub force: f64,
    /// What was taken for granted, a sentence each.
    pub assumptions: Vec<String>,
}

/// The first visits of a robot, of as many poses as the options ask for.
///
/// # Errors
/// Too few poses in the region; a robot of which nothing gives way.
pub fn first(robot: &Description, options: &Options) -> Result<First, Error> {
    let candidates = (CANDIDATES * options.poses).max(FEWEST);
    let space = Space::of_robot(robot, &Options { candidates, ..*options })?;
    let force = options.force.unwrap_or(FORCE);
    let pulls = directions();
    let with = |q: &Vec<f64>| {
        let q = q.clone();
        let loads = |pull: &nalgebra::Vector3<f64>| {
            let load = |share: f64| {
                let at = pull * (share * force);
                // To a tenth of a newton, as the table has it.
                [at.x, at.y, at.z, 0.0, 0.0, 0.0].map(|value| (value * 10.0).round() / 10.0 + 0.0)
            };
            Vec::from(RAMP.map(load))
        };
        pulls.iter().map(|pull| Visit { q: q.clone(), loads: loads(pull) }).collect::<Vec<_>>()
    };
    let visits: Vec<Visit> = space.poses.iter().flat_map(with).collect();
    let campaign = campaign(robot, unread(&visits));
    let shown = shown(&campaign, robot)?;
    let chosen = most_informative(&shown, options.poses, |one, other| visits[one].q == visits[other].q);
    Ok(First {
        visits: chosen.into_iter().map(|visit| visits[visit].clone()).collect(),
        force,
        assumptions: space.assumptions,
    })
}

/// The rows of these visits before anything was read, each at a pose of its own.
pub fn unread(visits: &[Visit]) -> Displacements {
    let names: Vec<String> = (1..=visits.len()).map(|visit| std::format!("{visit}")).collect();
    let mut rows = Vec::new();
    for (index, visit) in visits.iter().enumerate() {
        for load in &visit.loads {
            rows.push(Row {
                line: rows.len() + 2,
                pose: index,
                visit: index,
                time: None,
                temperature: None,
                q: visit.q.clone(),
                wrench: *load,
                displacement: [0.0; 3],
                rotation: None,
                encoders: None,
                motors: None,
            });
        }
    }
    Displacements {
        wrench_frame: Frame::Base,
        wrench_at: [0.0; 3],
        measured_frame: Frame::Base,
        measured_at: [0.0; 3],
        directions: AXES.to_vec(),
        poses: names.clone(),
        visits: names,
        rows,
    }
}

/// A campaign of such rows, of which nothing is known.
fn campaign(robot: &Description, data: Displacements) -> Campaign {
    Campaign {
        name: String::new(),
        date: String::new(),
        operator: String::new(),
        path: "".into(),
        robot_path: "".into(),
        observations_path: "".into(),
        robot: robot.clone(),
        data: Data::Displacement(data),
        noise: Noise::default(),
        holdout: None,
        held_out: Vec::new(),
        warnings: Vec::new(),
    }
}

/// What each visit shows of every number at its likely size, over the noise: a row for each of its
/// readings, as if they were independent.
fn shown(campaign: &Campaign, robot: &Description) -> Result<Vec<DMatrix<f64>>, Error> {
    let case = Case::new(campaign, robot);
    let engine = case.engine(robot);
    let layout = engine.layout();
    let of = asked(&layout);
    let values = layout.values(&Default::default());
    let mut columns = engine.observation.columns(&engine.point.world, &layout.parameters, &values, &of);
    let readings = engine.observation.readings();
    let (rows, width) = (readings.rows(), readings.width);
    let mut kept = Vec::new();
    for (k, &parameter) in of.iter().enumerate() {
        let moves = columns.column(k).norm() / ((rows * readings.reported) as f64).sqrt();
        let size = match layout.parameters[parameter].size {
            Size::Of(size) | Size::Learned(_, size) => size,
            Size::Moves(by) => by / moves,
            Size::Flat(_) => FLAT / moves,
            Size::Noise => NOISE,
        };
        // What the poses and loads do not show at all, no choice of them tells.
        if moves > 0.0 && size.is_finite() && size * moves > 1e-3 * NOISE {
            columns.column_mut(k).scale_mut(size / NOISE);
            kept.push(k);
        }
    }
    if kept.is_empty() {
        return Err(Error::NotShown(String::from("nothing of this robot gives way: no load moves its tool")));
    }
    let columns = columns.select_columns(&kept);
    let mut shown = Vec::new();
    let mut row = 0;
    while row < rows {
        let count = readings.visit[row..].iter().take_while(|visit| **visit == readings.visit[row]).count();
        let mut of_visit = columns.rows(row * width, count * width).into_owned();
        independent(&mut of_visit, count, width);
        shown.push(of_visit);
        row += count;
    }
    Ok(shown)
}

/// The columns of what is asked about: what is always fitted, and of each candidate the form in the middle
/// of its forms, for those of a grid of knees show much the same.
fn asked(layout: &Layout) -> Vec<usize> {
    let is_asked = |candidate: usize| {
        let kind = layout.candidates[candidate].kind;
        match kind.side {
            Side::Robot => true,
            Side::Rig => OF_RIG.contains(&kind.name),
            Side::Unnamed => false,
        }
    };
    let middle = |candidate: usize| layout.candidates[candidate].forms.len() / 2;
    let forms = layout.forms.iter().filter(|form| is_asked(form.candidate) && form.form == middle(form.candidate));
    let mut all: Vec<usize> = layout.always().chain(forms.flat_map(|form| form.columns.iter().copied())).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Makes the readings of a visit, which share an unloaded one, independent: their covariance is
/// `I + 1 1'` on each axis, and its inverse root `I - c 1 1'` with `c = (1 - 1 / sqrt(1 + n)) / n`.
fn independent(of_visit: &mut DMatrix<f64>, count: usize, width: usize) {
    let n = count as f64;
    let c = (1.0 - 1.0 / (1.0 + n).sqrt()) / n;
    for mut column in of_visit.column_iter_mut() {
        for axis in 0..width {
            let sum: f64 = (0..count).map(|row| column[row * width + axis]).sum();
            (0..count).for_each(|row| column[row * width + axis] -= c * sum);
        }
    }
}

/// The visits that tell most, one after the other, no two of which are alike, by index.
///
/// What a visit gains falls with every one before it, so one whose gain was less than another's is now
/// is not looked at again.
pub fn most_informative(shown: &[DMatrix<f64>], count: usize, alike: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let parameters = shown.first().map_or(0, DMatrix::ncols);
    let mut covariance = DMatrix::<f64>::identity(parameters, parameters);
    let mut bounds = vec![f64::INFINITY; shown.len()];
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < count {
        let mut best: Option<(f64, usize)> = None;
        let mut order: Vec<usize> =
            (0..shown.len()).filter(|&visit| !chosen.iter().any(|&other| alike(visit, other))).collect();
        order.sort_by(|&a, &b| bounds[b].total_cmp(&bounds[a]));
        for visit in order {
            if best.is_some_and(|(gain, _)| gain >= bounds[visit]) {
                break;
            }
            bounds[visit] = gain(&shown[visit], &covariance);
            if best.is_none_or(|(gain, _)| bounds[visit] > gain) {
                best = Some((bounds[visit], visit));
            }
        }
        let Some((_, visit)) = best else { break };
        let x = &shown[visit];
        let along = &covariance * x.transpose();
        let inner = DMatrix::identity(x.nrows(), x.nrows()) + x * &along;
        let Some(inner) = Cholesky::new(inner) else { break };
        covariance -= &along * inner.solve(&along.transpose());
        chosen.push(visit);
    }
    chosen
}

/// What a visit adds to the logarithm of the determinant.
fn gain(x: &DMatrix<f64>, covariance: &DMatrix<f64>) -> f64 {
    let inner = DMatrix::identity(x.nrows(), x.nrows()) + x * covariance * x.transpose();
    Cholesky::new(inner).map_or(0.0, |root| 2.0 * root.l_dirty().diagonal().iter().map(|value| value.ln()).sum::<f64>())
}
