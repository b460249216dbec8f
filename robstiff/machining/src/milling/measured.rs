//! Forces as a dynamometer recorded them.

use core::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};
use robstiff_robots::Diagnostics;
use robstiff_robots::quantity::Dimension;

use super::{CutFrame, Revolution, dynoware};
use robstiff_robots::table::Table;

/// Which axes Fx, Fy and Fz of a measured force are along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceFrame {
    /// Feed, normal and axis of the cut ([`CutFrame`]).
    Cut,
    /// The robot's base frame.
    Base,
    /// The tool's (TCP's) frame.
    Tool,
}

/// A recorded force on the tool.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredForce {
    /// The axes of the force.
    pub frame: ForceFrame,
    /// The samples, in the file's order.
    pub samples: Vec<Sample>,
}

/// One sample of a recorded force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time (s), where recorded.
    pub time: Option<f64>,
    /// Angle of the spindle (rad), where recorded.
    pub angle: Option<f64>,
    /// The force on the tool (N).
    pub force: Vector3<f64>,
}

/// Times and speeds are written with fewer digits.
const ROUNDING: f64 = 1e-6;

/// Samples further apart than this (rad) do not show a revolution.
const COARSEST: f64 = 0.25 * TAU * (1.0 + ROUNDING);

/// What the columns are.
const COLUMNS: [&str; 3] = ["Fx", "Fy", "Fz"];

impl MeasuredForce {
    /// Reads a table with the columns `Fx`, `Fy`, `Fz` (N) and, where recorded,
    /// `t` (s) or `angle` (rad) (or other units, `Fx [kN]`); `file` is the
    /// name that problems show, `on_workpiece` says that the forces are those on
    /// the workpiece, which the tool has with the opposite sign. With what the
    /// reader noticed without refusing the table. `time` stands for `t`, too. The head of a file that
    /// Kistler's DynoWare exports names columns, units and, where there is no column of times, the
    /// sampling rate.
    ///
    /// # Errors
    /// All that is wrong with the table, each problem with its place.
    pub fn parse(
        file: &str,
        text: &str,
        frame: ForceFrame,
        on_workpiece: bool,
    ) -> Result<(Self, Vec<std::string::String>), Diagnostics> {
        let export = dynoware::export(file, text).transpose()?;
        let rate = export.as_ref().and_then(|export| export.rate);
        let table = Table::parse(file, export.as_ref().map_or(text, |export| &export.table))?;
        let forces = COLUMNS.map(|name| table.require(name, Dimension::Force));
        let (time, angle) = (table.numbers("t", Dimension::Time), table.numbers("angle", Dimension::Angle));
        let time = time.or_else(|| table.numbers("time", Dimension::Time));
        let sign = if on_workpiece { -1.0 } else { 1.0 };
        let sample = |record| {
            let force = table.all(record, [forces[0]?, forces[1]?, forces[2]?])?;
            let time = time.map(|column| table.number(record, column));
            let angle = angle.map(|column| table.number(record, column));
            if time == Some(None) || angle == Some(None) {
                return None;
            }
            Some(Sample { time: time.flatten(), angle: angle.flatten(), force: Vector3::from(force) * sign })
        };
        let samples: Vec<Option<Sample>> = table.records.iter().map(sample).collect();
        let mut samples: Option<Vec<Sample>> = samples.into_iter().collect();
        if let (None, Some(rate)) = (time, rate) {
            for (index, sample) in samples.iter_mut().flatten().enumerate() {
                sample.time = Some(index as f64 / rate);
            }
        }
        let times = || samples.iter().flatten().map(|sample| sample.time);
        if let Some(back) = times().zip(times().skip(1)).position(|(one, next)| next < one) {
            table.warn(&std::format!("the times go back on line {}", table.records[back + 1].line));
        }
        table.finish(samples.map(|samples| Self { frame, samples }))
    }

    /// The mean of the samples (N), of those of whole revolutions where times or angles, with
    /// the speed of the spindle (rad/s), say which these are: half a revolution more would
    /// count some teeth twice. Each counts by the angle from halfway to the one before to halfway
    /// to the next, so that a record may be denser where more happens.
    pub fn mean(&self, speed: Option<f64>) -> Vector3<f64> {
        let Some((angles, revolutions)) = self.whole_revolutions(speed) else {
            return self.samples.iter().map(|sample| sample.force).sum::<Vector3<f64>>()
                / self.samples.len().max(1) as f64;
        };
        let (last, period) = (angles.len() - 1, revolutions * TAU);
        let before = |k: usize| if k == 0 { angles[last] - period } else { angles[k - 1] };
        let next = |k: usize| if k == last { angles[0] + period } else { angles[k + 1] };
        let counted = |(k, sample): (usize, &Sample)| sample.force * (next(k) - before(k));
        self.samples[..=last].iter().enumerate().map(counted).sum::<Vector3<f64>>() / (2.0 * period)
    }

    /// The angles (rad) of the samples, from the first, that are those of whole revolutions, and how
    /// many these are; `None` where the spindle does not go on from each to the next, or not once
    /// around.
    fn whole_revolutions(&self, speed: Option<f64>) -> Option<(Vec<f64>, f64)> {
        let mut angles = self.angles(speed)?;
        // Recorded angles may begin again at each revolution.
        for k in 1..angles.len() {
            // All turns at once: an angle may be anything.
            let behind = angles[k - 1] - 0.5 * TAU - angles[k];
            angles[k] += TAU * (behind / TAU).ceil().max(0.0);
        }
        let (first, last) = (*angles.first()?, *angles.last()?);
        if !angles.is_sorted() {
            return None;
        }
        let step = (last - first) / (angles.len() - 1).max(1) as f64;
        // A record may be sparser where less happens, at its end, too.
        let gap = angles[angles.len() - 1] - angles[angles.len().saturating_sub(2)];
        let behind = step.max(gap.min(0.25 * TAU));
        let revolutions = ((last - first + behind) / TAU * (1.0 + ROUNDING)).floor();
        let end = first + revolutions * TAU - 0.5 * step;
        angles.truncate(angles.partition_point(|angle| *angle < end));
        (revolutions >= 1.0).then_some((angles, revolutions))
    }

    /// The angle of the spindle at each sample (rad): the recorded one, or the time's at
    /// the speed of the spindle (rad/s); `None` where neither is known.
    pub(super) fn angles(&self, speed: Option<f64>) -> Option<Vec<f64>> {
        self.samples.iter().map(|sample| sample.angle.or_else(|| Some(sample.time? * speed?))).collect()
    }

    /// Whether the record, with the speed of the spindle (rad/s), says at which angle
    /// each sample was taken.
    pub fn has_angles(&self, speed: Option<f64>) -> bool {
        self.angles(speed).is_some()
    }

    /// Whether the record resolves a revolution: by its times it is at least as long as
    /// one, and has a sample for each quarter; recorded angles leave out no more than a
    /// quarter. A record that is coarser has its samples at whatever angles.
    pub fn resolves_revolution(&self, speed: Option<f64>) -> bool {
        let Some(mut angles) = self.angles(speed) else { return false };
        let recorded = self.samples.iter().all(|sample| sample.angle.is_some());
        if recorded {
            angles.iter_mut().for_each(|angle| *angle = angle.rem_euclid(TAU));
        }
        angles.sort_by(f64::total_cmp);
        let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return false };
        if recorded {
            let gaps = angles.windows(2).map(|pair| pair[1] - pair[0]);
            gaps.fold(first + TAU - last, f64::max) <= COARSEST
        } else {
            let step = (last - first) / (angles.len() - 1).max(1) as f64;
            step <= COARSEST && last - first + step >= TAU * (1.0 - ROUNDING)
        }
    }

    /// The mean force over a revolution in so many equal parts, each at the angle
    /// of its middle; a part without samples is left out. The angle is the
    /// recorded one, or the time's at the speed of the spindle (rad/s); `None`
    /// where neither is known, and of a record that does not
    /// [resolve](Self::resolves_revolution) a revolution.
    pub fn revolution(&self, count: usize, speed: Option<f64>) -> Option<Revolution> {
        if !self.resolves_revolution(speed) {
            return None;
        }
        let mut sums = std::vec![(0_usize, Vector3::zeros()); count];
        for (sample, angle) in self.samples.iter().zip(self.angles(speed)?) {
            // On the bound between two parts it is of the later one, whatever rounding says.
            let part = (angle.rem_euclid(TAU) / TAU * count as f64 + ROUNDING) as usize;
            // Just below a whole turn the quotient may round up to it.
            let (number, sum) = &mut sums[part.min(count - 1)];
            *number += 1;
            *sum += sample.force;
        }
        let parts = sums.into_iter().enumerate().filter(|(_, (number, _))| *number > 0);
        let sample = |(part, (number, sum)): (usize, (usize, Vector3<f64>))| {
            ((part as f64 + 0.5) * TAU / count as f64, sum / number as f64)
        };
        Some(Revolution { samples: parts.map(sample).collect() })
    }

    /// What turns a force of these axes into the robot's base frame, with the rotation
    /// of the TCP's frame; `None` where only the frame of a cut could tell and the
    /// tool has none, since it plunges or stays in place.
    pub fn to_base(&self, cut: Option<&CutFrame>, tool: &Matrix3<f64>) -> Option<Matrix3<f64>> {
        match self.frame {
            ForceFrame::Cut => cut.map(CutFrame::matrix),
            ForceFrame::Base => Some(Matrix3::identity()),
            ForceFrame::Tool => Some(*tool),
        }
    }
}
