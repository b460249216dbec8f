//! What the page of a job shows, from what was computed.

use std::path::Path;

use robstiff::nalgebra::{Matrix4, Vector3};
use robstiff_machining::cell::Cell;
use robstiff_machining::deviation::{DeviationPoint, Summary};
use robstiff_machining::engagement::Stock;
use robstiff_machining::path::ToolPath;
use robstiff_robots::{Description, JointKind};

use super::chatter::Chatter;
use super::cutting::{Corrected, Cutting, WRONG};
use super::job::content::{Block, Job, Joint, Left, Point};
use super::stock::Engaged;
use super::{Solved, deviation};

/// What a job is made of, beside the path solved.
pub struct Facts<'a> {
    pub robot: &'a Description,
    pub cell: Option<&'a Cell>,
    pub path: &'a ToolPath,
    /// Where the path's frame stands in the base frame.
    pub place: &'a Matrix4<f64>,
    /// What the forces are computed from, in the path's frame.
    pub stock: Option<&'a Stock>,
    /// The feed where the path has none (m/s).
    pub feed: Option<f64>,
    /// The program's files.
    pub files: Vec<String>,
}

impl Facts<'_> {
    /// The job.
    pub fn job<'s>(&'s self, solved: &'s Solved) -> Job<'s> {
        let cutting = solved.cutting.as_ref();
        let corrected = cutting.and_then(|cutting| cutting.corrected.as_ref());
        let name = Path::new(&self.path.file).file_name();
        Job {
            robot: self.robot.name.clone(),
            file: name.map_or(self.path.file.clone(), |name| name.to_string_lossy().into_owned()),
            forces: cutting.map(|cutting| (cutting.name.clone(), deviation::surface(cutting))),
            is_peak: cutting.is_some_and(|cutting| cutting.deviation.points.iter().any(|point| point.peak.is_some())),
            points: self.points(solved, cutting, corrected),
            joints: self.joints(),
            stock: self.block(),
            tolerance: cutting.and_then(|cutting| cutting.tolerance.as_ref()).map(|(tolerance, _)| *tolerance),
            corrected: cutting.zip(corrected).map(|(cutting, corrected)| left(cutting, corrected)),
            shares: cutting.map(|cutting| cutting.blame.clone()).unwrap_or_default(),
            summary: cutting.map(|cutting| summary(cutting, corrected)).unwrap_or_default(),
            chatter: cutting
                .and_then(|cutting| cutting.chatter.as_ref())
                .map(|chatter| (chatter.said(), chatter.worst().into_iter().map(Chatter::row).collect())),
            files: self.files.clone(),
        }
    }

    fn points<'s>(
        &'s self,
        solved: &'s Solved,
        cutting: Option<&'s Cutting>,
        corrected: Option<&'s Corrected>,
    ) -> Vec<Point<'s>> {
        // A frame is a turn and a shift.
        let back = self.place.try_inverse().unwrap_or_else(Matrix4::identity);
        let each = solved.points.iter().zip(&self.path.points).enumerate();
        let points = each.map(|(i, (point, given))| {
            let found = cutting.map(|cutting| &cutting.deviation.points[i]);
            let in_cut = found.filter(|found| found.in_cut());
            let corrected = corrected.map(|corrected| &corrected.points[i]);
            let engaged = cutting.and_then(|cutting| cutting.engaged.as_ref());
            let position = Vector3::from_fn(|axis, _| point.pose[(axis, 3)]);
            Point {
                line: point.line,
                text: self.path.line(point.line),
                s: point.s,
                at: (back * position.push(1.0)).xyz().into(),
                rapid: point.rapid,
                feed: point.feed.or(self.feed),
                q: corrected.map_or(&point.q, |corrected| &corrected.q),
                force: found.map(|found| found.wrench.fixed_rows::<3>(0).norm()),
                section: match engaged {
                    Some(engaged) => Engaged::section(engaged, i),
                    None => given.width.zip(given.depth).map(|(width, depth)| [width, depth]),
                },
                distance: in_cut.map(DeviationPoint::distance),
                error: in_cut.and_then(DeviationPoint::judged),
                after: in_cut.zip(corrected).map(|(found, corrected)| corrected.remaining + by_revolution(found)),
            }
        });
        points.collect()
    }

    fn joints(&self) -> Vec<Joint> {
        let fastest = |joint: usize| self.cell.and_then(|cell| cell.joint_speeds.get(joint).copied());
        let joints = self.robot.joints.iter().enumerate().map(|(i, joint)| {
            let per = if joint.kind == JointKind::Revolute { 1_f64.to_degrees() } else { 1e3 };
            Joint { unit: (joint.people_unit(), per), limits: joint.limits, fastest: fastest(i) }
        });
        joints.collect()
    }

    fn block(&self) -> Option<Block> {
        let of_cell = || {
            let [from, to] = self.cell?.stock?;
            Stock::of_corners(&from, &to)
        };
        let stock = self.stock.cloned().or_else(of_cell)?;
        let heights = [stock.bottom(), stock.bottom() + stock.thickness()];
        Some(Block { outline: stock.outline().to_vec(), heights })
    }
}

/// By how much the worst force of a revolution is beyond the mean, which is what a correction is for (m).
fn by_revolution(point: &DeviationPoint) -> f64 {
    point.peak.zip(point.error).map_or(0.0, |(peak, mean)| (peak - mean).abs())
}

/// What the correction leaves where the true arm is softer or stiffer: a part of the deviation of that arm.
fn left(cutting: &Cutting, corrected: &Corrected) -> Left {
    let before = cutting.deviation.distances().map_or(0.0, |distances| distances.worst.abs());
    let [softer, stiffer] = corrected.sensitivity.all;
    let mean = before * (softer.worst * (1.0 + WRONG)).max(stiffer.worst * (1.0 - WRONG));
    let revolution = cutting.deviation.in_cut().map(by_revolution).fold(0.0, f64::max);
    Left { by: WRONG, worst: mean + revolution }
}

fn summary(cutting: &Cutting, corrected: Option<&Corrected>) -> Vec<(String, [f64; 3])> {
    let deviation = &cutting.deviation;
    let mut rows = vec![("distance from the path".to_owned(), deviation.distances())];
    for (axis, name) in ["along the feed", "normal to it", "along the tool axis"].into_iter().enumerate() {
        rows.push((name.to_owned(), deviation.summary(|point| Some(point.components?[axis]))));
    }
    rows.push((format!("error of the {}", deviation::surface(cutting)), deviation.errors()));
    if let Some(corrected) = corrected {
        let each = corrected.points.iter().zip(&deviation.points).filter(|(_, found)| found.in_cut());
        let of = Summary::of(each.map(|(point, found)| (point.remaining, found.length)));
        rows.push(("distance with the correction, if the model is true".to_owned(), of));
    }
    rows.into_iter().filter_map(|(name, of)| of.map(|of| (name, [of.mean, of.rms, of.worst]))).collect()
}
