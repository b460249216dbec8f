//! What a scene shows: the poses with compliance and displacement, computed.

use robstiff::analysis::principal_directions;
use robstiff::nalgebra::{Matrix4, SVector, Vector3, Vector6};
use robstiff::{Convention, Generic, JointKind, Robot, State};
use robstiff_identify::campaign::{Campaign, Data};
use robstiff_identify::predict::{PredictedRow, predict};
use robstiff_robots::quantity::{self, Dimension};
use robstiff_robots::{Description, Joint};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::json::{number, numbers};
use crate::text::significant;

/// Longer paths are thinned out: no screen has more points across.
const MOST_POSES: usize = 3000;

/// What the poses are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One pose.
    Pose,
    /// A path, in its order.
    Path,
    /// A campaign.
    Campaign,
}

/// A pose that is asked for.
pub struct Row {
    /// Joint coordinates (rad or m).
    pub q: Vec<f64>,
    /// The force and the moment on the tool in the base frame (N, Nm).
    pub wrench: Option<[f64; 6]>,
    /// What colours it, in its unit, in place of the displacement.
    pub value: Option<(f64, String)>,
    /// Whether it is reached by a rapid, in which nothing is cut.
    pub rapid: bool,
}

/// A pose that is drawn.
pub struct Pose {
    /// Its place among those asked for, from 0.
    pub row: usize,
    /// Joint coordinates (rad or m).
    pub q: Vec<f64>,
    /// Points of the arm in the base frame (m), from its foot to the TCP.
    pub points: Vec<[f64; 3]>,
    /// The translational compliance in the base frame, xx yy zz xy xz yz (um/N).
    pub compliance: [f64; 6],
    /// The compliance along the principal directions, the softest first (um/N).
    pub principal: Option<[f64; 3]>,
    /// The displacement of the TCP that is computed (um).
    pub displacement: Option<[f64; 3]>,
    /// The displacement that was measured (um).
    pub measured: Option<[f64; 3]>,
    /// By how much the position that was read is off the one that is computed (um).
    pub off: Option<[f64; 3]>,
    /// What colours the pose; nothing colours a rapid.
    pub value: Option<f64>,
    /// Whether it is reached by a rapid.
    pub rapid: bool,
    /// What the campaign calls it.
    pub name: Option<String>,
}

impl Pose {
    /// How bad the pose is: errors have signs.
    pub fn size(&self) -> f64 {
        self.value.unwrap_or_default().abs()
    }
}

/// What colours the poses.
pub struct Values {
    /// Its name.
    pub name: String,
    /// Its unit; empty for a number.
    pub unit: String,
    /// The least.
    pub least: f64,
    /// The greatest.
    pub most: f64,
    /// How large it may be, either way, in its unit.
    pub tolerance: Option<f64>,
    /// The values of all rows that have one, drawn or not.
    all: Vec<f64>,
}

impl Values {
    /// The least and the greatest distance from zero: errors have signs.
    pub fn sizes(&self) -> [f64; 2] {
        let [least, most] = [self.least, self.most].map(f64::abs);
        [if self.least * self.most < 0.0 { 0.0 } else { least.min(most) }, least.max(most)]
    }

    /// Whether the rows are within the tolerance, in a sentence; nothing without one.
    pub fn verdict(&self) -> Option<(bool, String)> {
        let most = self.tolerance?;
        let unit = if self.unit == "um" { "µm" } else { &self.unit };
        let (tolerance, worst) = (significant(most, 4), significant(self.sizes()[1], 4));
        let beyond = self.all.iter().filter(|value| value.abs() > most).count();
        let (passes, count) = (beyond == 0, self.all.len());
        let said = match passes {
            true => {
                format!("Pass: none of {count} points is beyond {tolerance} {unit}. The worst is at {worst} {unit}.")
            }
            false => {
                format!(
                    "Fail: {beyond} of {count} points are beyond {tolerance} {unit}. The worst is at {worst} {unit}."
                )
            }
        };
        Some((passes, said))
    }
}

/// Everything that is drawn.
pub struct Scene {
    /// What the poses are of.
    pub kind: Kind,
    /// The poses, in order.
    pub poses: Vec<Pose>,
    /// How many there were before the path was thinned out.
    pub rows: usize,
    /// Each of how many is drawn; what is extreme is drawn besides.
    pub stride: usize,
    /// What colours them.
    pub values: Option<Values>,
    /// The force, where it is one for all poses, without a moment (N).
    pub force: Option<[f64; 3]>,
}

impl Scene {
    /// The poses asked for.
    pub fn new(robot: &Description, kind: Kind, rows: &[Row]) -> Self {
        let displacements = with_arm!(robot, |arm| displacements(&arm, kind, rows));
        // Of all rows: the worst of a path counts whether or not it is drawn.
        let sizes = rows.iter().zip(&displacements);
        // A row without a value among others that have one has none.
        let has_values = rows.iter().any(|row| row.value.is_some());
        let sizes = sizes.map(|(row, moved)| match &row.value {
            _ if row.rapid => None,
            Some((value, _)) => Some(*value),
            None => moved.map(length).filter(|_| !has_values),
        });
        let sizes: Vec<Option<f64>> = sizes.collect();
        let stride = rows.len().div_ceil(MOST_POSES).max(1);
        let drawn = drawn(&sizes, stride);
        let mut poses: Vec<Pose> =
            with_arm!(robot, |arm| drawn.iter().map(|&row| pose(robot, &arm, row, &rows[row].q)).collect());
        for pose in &mut poses {
            (pose.displacement, pose.value) = (displacements[pose.row], sizes[pose.row]);
            pose.rapid = rows[pose.row].rapid;
        }
        let unit = rows.iter().find_map(|row| row.value.as_ref().map(|(_, unit)| unit.clone()));
        let name = if rows.iter().any(|row| row.wrench.is_some()) { "deviation under the force" } else { "" };
        let values = values(name, unit.unwrap_or_else(|| "um".to_owned()), &sizes);
        let first = rows.first().and_then(|row| row.wrench);
        let force = first.filter(|&first| rows.iter().all(|row| row.wrench == Some(first)));
        let force = force.filter(|wrench| wrench[3..] == [0.0; 3]).map(|[x, y, z, ..]| [x, y, z]);
        Self { kind, poses, rows: rows.len(), stride, values, force }
    }

    /// The same with the name of the column that colours it.
    pub fn coloured_by(mut self, column: Option<&str>) -> Self {
        if let (Some(values), Some(column)) = (&mut self.values, column) {
            column.clone_into(&mut values.name);
        }
        self
    }

    /// The same with the tolerance (m) of what colours it.
    ///
    /// # Errors
    /// Where that is no length.
    pub fn within(mut self, tolerance: Option<f64>) -> Result<Self, Failure> {
        let Some(tolerance) = tolerance else { return Ok(self) };
        let Some(values) = &mut self.values else {
            return Err(Failure::Usage(
                "a tolerance is of the deviation under a force: give `--force`, or `--column` for one that the path has"
                    .to_owned(),
            ));
        };
        let scale = quantity::scale(&values.unit, Dimension::Length).map_err(|error| {
            Failure::Usage(format!("a tolerance is a length, and {} is not: {}", values.name, error.message))
        })?;
        // As it was typed: a division leaves a last digit.
        values.tolerance = Some((tolerance / scale * 1e9).round() / 1e9);
        Ok(self)
    }

    /// The poses of a campaign, each with the row of its largest displacement, or of the
    /// position that is farthest off.
    ///
    /// # Errors
    /// A campaign that cannot be predicted, or is at no poses.
    pub fn of_campaign(robot: &Description, campaign: &Campaign) -> Result<Self, Failure> {
        let (ids, read, name): (_, Vec<(usize, &[f64])>, _) = match &campaign.data {
            Data::Displacement(data) => {
                (&data.poses, data.rows.iter().map(|row| (row.pose, &row.q[..])).collect(), "measured less predicted")
            }
            Data::Position(data) => {
                (&data.poses, data.rows.iter().map(|row| (row.pose, &row.q[..])).collect(), "read less predicted")
            }
            Data::Clamped(_) => {
                return Err(Failure::new(format_args!(
                    "{}: campaigns of kind `clamped` are at no poses to show",
                    campaign.path.display()
                )));
            }
        };
        let tracked = matches!(campaign.data, Data::Position(_));
        let predicted = predict(robot, campaign).map_err(Failure::about(campaign))?.rows;
        let size = |row: &PredictedRow| length(if tracked { row.off } else { row.measured });
        // By pose, the row of the largest displacement.
        let mut largest = vec![None; ids.len()];
        for row @ ((pose, _), seen) in read.iter().zip(&predicted) {
            if largest[*pose].is_none_or(|(_, known)| size(seen) >= size(known)) {
                largest[*pose] = Some(row);
            }
        }
        let rows: Vec<_> = largest.into_iter().flatten().collect();
        let asked = rows.iter().map(|((_, q), row)| Row {
            q: q.to_vec(),
            wrench: None,
            value: Some((length(row.off) * 1e6, "um".to_owned())),
            rapid: false,
        });
        let asked: Vec<Row> = asked.collect();
        let mut scene = Self::new(robot, Kind::Campaign, &asked).coloured_by(Some(name));
        let micrometres = |vector: [f64; 3]| Some(vector.map(|d| d * 1e6));
        for pose in &mut scene.poses {
            let ((of, _), row) = rows[pose.row];
            match tracked {
                true => pose.off = micrometres(row.off),
                false => (pose.displacement, pose.measured) = (micrometres(row.predicted), micrometres(row.measured)),
            }
            pose.name = Some(ids[*of].clone());
        }
        Ok(scene)
    }

    /// All that is drawn, for scripts: lengths in m, compliances in um/N,
    /// displacements in um, angles in rad.
    pub fn document(&self, robot: &Description) -> Value {
        let joints = robot.corrected_joints();
        json!({
            "robot": robot.name,
            "convention": robot.convention.word(),
            "base": with_arm!(robot, |arm| placement(&base(&arm))),
            "tool": with_arm!(robot, |arm| placement(&tool(&arm))),
            "joints": joints.iter().map(joint).collect::<Value>(),
            // Their part in the compliance is in that of the poses.
            "effects": robot.effects.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "kind": match self.kind { Kind::Pose => "pose", Kind::Path => "path", Kind::Campaign => "campaign" },
            "rows": self.rows,
            "stride": self.stride,
            "force": self.force.map(numbers),
            "value": self.values.as_ref().map(|values| json!({
                "name": values.name, "unit": values.unit, "least": number(values.least), "most": number(values.most),
                "tolerance": values.tolerance.map(number), "passes": values.verdict().map(|(passes, _)| passes),
            })),
            "poses": self.poses.iter().map(|pose| json!({
                "row": pose.row + 1,
                "q": numbers(pose.q.iter().copied()),
                "tcp": pose.points.last().map(|&point| numbers(point)),
                "compliance": numbers(pose.compliance),
                "displacement": pose.displacement.map(numbers),
                "measured": pose.measured.map(numbers),
                "off": pose.off.map(numbers),
                "value": pose.value.map(number),
                "rapid": pose.rapid,
                "name": pose.name,
            })).collect::<Value>(),
        })
    }
}

fn joint(joint: &Joint) -> Value {
    json!({
        "slides": joint.kind == JointKind::Prismatic,
        "theta": joint.theta, "d": joint.d, "a": joint.a, "alpha": joint.alpha,
        "limits": joint.limits.map(numbers), "compliance": joint.compliance(),
    })
}

fn base<const N: usize>(robot: &Generic<N>) -> Matrix4<f64> {
    robot.base()
}

fn tool<const N: usize>(robot: &Generic<N>) -> Matrix4<f64> {
    robot.tool()
}

/// The first three rows, one after the other.
fn placement(frame: &Matrix4<f64>) -> Value {
    numbers(frame.fixed_rows::<3>(0).transpose().iter().copied())
}

/// The displacements under the wrenches (um). Joints with hysteresis follow those of
/// a path in its order.
fn displacements<const N: usize>(robot: &Generic<N>, kind: Kind, rows: &[Row]) -> Vec<Option<[f64; 3]>> {
    let mut state = State::new();
    let displacement = |row: &Row| {
        if kind != Kind::Path {
            state = State::new();
        }
        let q = SVector::<f64, N>::from_column_slice(&row.q);
        let moved = robot.deflection_with(&q, &Vector6::from(row.wrench?), &mut state);
        Some([moved[0] * 1e6, moved[1] * 1e6, moved[2] * 1e6])
    };
    rows.iter().map(displacement).collect()
}

/// The rows that are drawn, with the least and the greatest value among them.
fn drawn(values: &[Option<f64>], stride: usize) -> Vec<usize> {
    let valued = || values.iter().enumerate().filter_map(|(row, value)| Some((row, (*value)?)));
    let least = valued().min_by(|(_, one), (_, other)| one.total_cmp(other));
    let most = valued().max_by(|(_, one), (_, other)| one.total_cmp(other));
    let extreme = [least, most].into_iter().flatten().map(|(row, _)| row);
    let mut drawn: Vec<usize> = (0..values.len()).step_by(stride).chain(extreme).collect();
    drawn.sort_unstable();
    drawn.dedup();
    drawn
}

/// A pose with nothing that acts on it.
fn pose<const N: usize>(description: &Description, robot: &Generic<N>, row: usize, q: &[f64]) -> Pose {
    let q = SVector::<f64, N>::from_column_slice(q);
    let compliance = robot.compliance(&q);
    let entry = |(i, j)| compliance[(i, j)] * 1e6;
    Pose {
        row,
        q: q.iter().copied().collect(),
        points: points(description, robot, &q),
        compliance: [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(entry),
        principal: principal_directions(&compliance).map(|found| (found.compliances * 1e6).into()),
        displacement: None,
        measured: None,
        off: None,
        value: None,
        rapid: false,
        name: None,
    }
}

/// Where each joint's axis begins and where the offset `d` along it ends, then
/// flange and TCP.
fn points<const N: usize>(description: &Description, robot: &Generic<N>, q: &SVector<f64, N>) -> Vec<[f64; 3]> {
    let at =
        |frame: &Matrix4<f64>, column: usize| Vector3::new(frame[(0, column)], frame[(1, column)], frame[(2, column)]);
    let frames = robot.link_frames(q);
    let mut before = robot.base();
    let mut points = Vec::with_capacity(2 * N + 2);
    for ((frame, joint), q) in frames.iter().zip(description.corrected_joints()).zip(q.iter()) {
        let d = joint.d + if joint.kind == JointKind::Prismatic { *q } else { 0.0 };
        match robot.convention() {
            Convention::Standard => points.extend([at(&before, 3), at(&before, 3) + at(&before, 2) * d]),
            Convention::Modified => points.extend([at(frame, 3) - at(frame, 2) * d, at(frame, 3)]),
        }
        before = *frame;
    }
    points.extend([at(&before, 3), at(&robot.transform(q), 3)]);
    points.into_iter().map(|point| [point.x, point.y, point.z]).collect()
}

fn values(name: &str, unit: String, values: &[Option<f64>]) -> Option<Values> {
    let values = || values.iter().copied().flatten();
    let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let all = || values().collect();
    (least <= most).then(|| Values { name: name.to_owned(), unit, least, most, tolerance: None, all: all() })
}

/// The length of a vector.
pub fn length(vector: [f64; 3]) -> f64 {
    vector.iter().map(|component| component * component).sum::<f64>().sqrt()
}
