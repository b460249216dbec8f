//! What the pictures of a report are drawn from: the arm in its poses, and the
//! residual against what it depends on most.

use robstiff::Robot;
use robstiff::elements::Pose;
use robstiff::nalgebra::{DMatrix, DVector, Matrix3, Matrix4, SVector, Vector3};
use robstiff_identify::campaign::{Campaign, Data, Frame, Observation, PositionRow};
use robstiff_identify::trace::Trace;
use robstiff_robots::Description;

use super::wording::outliers;
use crate::report::content::{Arm, Dependence};

/// What a row was read at.
struct Row<'c> {
    pose: usize,
    q: &'c [f64],
    /// Loads by name and unit, the last the size of all.
    loads: Vec<(&'static str, &'static str, f64)>,
    time: Option<f64>,
    temperature: Option<f64>,
}

/// The ids of the poses, and the rows; none of clamped axes, which are at no pose.
fn rows(campaign: &Campaign) -> Option<(&[String], Vec<Row<'_>>)> {
    match &campaign.data {
        Data::Displacement(data) => Some((&data.poses, data.rows.iter().map(displaced).collect())),
        Data::Position(data) => Some((&data.poses, data.rows.iter().map(placed).collect())),
        Data::Clamped(_) => None,
    }
}

fn displaced(row: &Observation) -> Row<'_> {
    let [x, y, z, ..] = row.wrench;
    let size = (x * x + y * y + z * z).sqrt();
    let loads = vec![("Fx", "N", x), ("Fy", "N", y), ("Fz", "N", z), ("|F|", "N", size)];
    Row { pose: row.pose, q: &row.q, loads, time: row.time, temperature: row.temperature }
}

fn placed(row: &PositionRow) -> Row<'_> {
    let loads = vec![("payload", "kg", row.payload)];
    Row { pose: row.pose, q: &row.q, loads, time: row.time, temperature: row.temperature }
}

/// The arm in every pose, with the residual of the row of its largest load in the base frame; none of
/// positions, for how the tracker's frame stands to the base is part of the fit.
pub fn arms(trace: &Trace, campaign: &Campaign) -> Vec<Arm> {
    let Data::Displacement(data) = &campaign.data else { return Vec::new() };
    let Some((poses, rows)) = rows(campaign) else { return Vec::new() };
    let load = |row: usize| rows[row].loads.last().map_or(0.0, |(.., size)| *size);
    let mut largest: Vec<Option<usize>> = vec![None; poses.len()];
    for row in 0..rows.len() {
        let so_far = &mut largest[rows[row].pose];
        if so_far.is_none_or(|other| load(row) >= load(other)) {
            *so_far = Some(row);
        }
    }
    let arm = |(row, id): (&Option<usize>, &String)| {
        let row = (*row)?;
        let residual = trace.residuals.get(row)?;
        let (points, turn) = with_arm!(&trace.description, |robot| chain(&robot, rows[row].q));
        let in_base = |residual: [f64; 3]| -> [f64; 3] {
            let um = Vector3::from(residual) * 1e6;
            match data.measured_frame {
                Frame::Base => um.into(),
                Frame::Tool => (turn * um).into(),
            }
        };
        Some(Arm { id: id.clone(), points, before: in_base(residual.before), after: in_base(residual.after) })
    };
    largest.iter().zip(poses).filter_map(arm).collect()
}

/// From the ground to the TCP, joint by joint (m), in the base frame; and how the tool is turned
/// there.
fn chain<const N: usize>(robot: &impl Robot<N>, q: &[f64]) -> (Vec<[f64; 3]>, Matrix3<f64>) {
    let pose = Pose::of(robot, &SVector::<f64, N>::from_column_slice(q));
    let geometry = pose.geometry();
    let at = |frame: &Matrix4<f64>| -> [f64; 3] { std::array::from_fn(|k| frame[(k, 3)]) };
    let mut points = vec![at(&geometry.base)];
    points.extend(geometry.joint_frames.iter().map(at));
    points.extend([at(&geometry.flange), at(&geometry.tcp)]);
    points.dedup();
    (points, geometry.tcp.fixed_view::<3, 3>(0, 0).into_owned())
}

/// How many quantities are shown.
const SHOWN: usize = 3;

/// The quantities that account for most of the residual, each by a parabola in
/// the component of the residual where it accounts for most; those on which what
/// is left depends come first.
pub fn dependences(trace: &Trace, campaign: &Campaign) -> Vec<Dependence> {
    let Some((_, rows)) = rows(campaign) else { return Vec::new() };
    let mut found: Vec<Dependence> = quantities(&rows, &trace.description)
        .into_iter()
        .filter_map(|(name, unit, values)| strongest(trace, name, unit, &values))
        .collect();
    let rank = |one: &Dependence| trace.depends_on.iter().position(|name| *name == one.name).unwrap_or(usize::MAX);
    found.sort_by(|a, b| rank(a).cmp(&rank(b)).then(b.share[0].total_cmp(&a.share[0])));
    found.truncate(SHOWN);
    found
}

/// Name, unit and value by row of what a residual may depend on.
fn quantities(rows: &[Row<'_>], robot: &Description) -> Vec<(String, &'static str, Vec<f64>)> {
    let mut found: Vec<(String, &'static str, Vec<f64>)> = Vec::new();
    for (i, joint) in robot.joints.iter().enumerate() {
        let values = rows.iter().map(|row| joint.for_people(row.q[i])).collect();
        found.push((format!("q{}", i + 1), joint.people_unit(), values));
    }
    for (k, &(name, unit, _)) in rows.first().iter().flat_map(|row| row.loads.iter().enumerate()) {
        found.push((name.to_owned(), unit, rows.iter().map(|row| row.loads[k].2).collect()));
    }
    if let Some(times) = rows.iter().map(|row| row.time).collect::<Option<Vec<f64>>>() {
        found.push(("time".to_owned(), "min", times.iter().map(|seconds| seconds / 60.0).collect()));
    }
    if let Some(values) = rows.iter().map(|row| row.temperature).collect::<Option<Vec<f64>>>() {
        found.push(("temperature".to_owned(), "°C", values));
    }
    found.push(("row order".to_owned(), "", (0..rows.len()).map(|row| row as f64 + 1.0).collect()));
    found
}

/// A quantity with the component of the residual that depends on it most;
/// none where it does not vary.
fn strongest(trace: &Trace, name: String, unit: &'static str, values: &[f64]) -> Option<Dependence> {
    // One outlier would pass for a law.
    let outliers = outliers(trace);
    let is_outlier = |line: usize| outliers.contains(&line);
    let residuals = || trace.residuals.iter().filter(|row| !is_outlier(row.line));
    let values: Vec<f64> =
        values.iter().zip(&trace.residuals).filter(|(_, row)| !is_outlier(row.line)).map(|(&x, _)| x).collect();
    let component = |axis: usize| -> [Vec<f64>; 2] {
        [
            residuals().map(|row| row.before[axis] * 1e6).collect(),
            residuals().map(|row| row.after[axis] * 1e6).collect(),
        ]
    };
    let before = (0..3).filter_map(|axis| Some((axis, parabola(&values, &component(axis)[0])?)));
    let (axis, share) = before.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let [before, after] = component(axis);
    let share = [share, parabola(&values, &after)?];
    let points = values.into_iter().zip(before).zip(after).map(|((x, before), after)| [x, before, after]).collect();
    Some(Dependence { name, unit: unit.to_owned(), axis, share, points })
}

/// The share of the variance of `y` that a parabola in `x` accounts for, what
/// chance gives it taken off.
fn parabola(x: &[f64], y: &[f64]) -> Option<f64> {
    let count = x.len() as f64;
    let centred = |values: &[f64]| -> Vec<f64> {
        let mean = values.iter().sum::<f64>() / count;
        values.iter().map(|value| value - mean).collect()
    };
    let (x, y) = (centred(x), DVector::from_vec(centred(y)));
    let largest = x.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if x.len() < 6 || x.len() != y.len() || largest < 1e-9 || y.norm_squared() <= 0.0 {
        return None;
    }
    let design = DMatrix::from_fn(x.len(), 3, |row, power| (x[row] / largest).powi(power as i32));
    let fitted = design.clone().svd(true, true).solve(&y, 1e-9).ok()?;
    let left = (&y - design * fitted).norm_squared() / (count - 3.0);
    Some((1.0 - left / (y.norm_squared() / (count - 1.0))).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_found_and_noise_is_not() {
        let x: Vec<f64> = (0..40).map(f64::from).collect();
        let curve: Vec<f64> = x.iter().map(|x| 3.0 + (x - 10.0) * (x - 10.0)).collect();
        let zigzag: Vec<f64> = (0..40).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert!(parabola(&x, &curve).unwrap() > 0.999);
        assert!(parabola(&x, &zigzag).unwrap() < 0.05);
        assert_eq!(parabola(&[2.0; 40], &zigzag), None);
    }
}
