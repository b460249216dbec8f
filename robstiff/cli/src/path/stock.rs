//! What a path cuts from a stock: asked for, computed, reported.

use std::fmt::Write as _;
use std::path::PathBuf;

use robstiff::nalgebra::{Matrix4, Unit, Vector3};
use robstiff_machining::deviation::Operation;
use robstiff_machining::engagement::{Cutter, Met, Stock, Survey, steps};
use robstiff_machining::milling::{CutFile, Forces};
use robstiff_machining::path::{SolvedPath, ToolPath, lines};
use robstiff_robots::quantity::Dimension;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::forces;
use crate::input::{self, all_with_unit};
use crate::json::{Lazy, number, numbers};
use crate::output::{Files, complain};
use crate::text::{cell, count, decimals};

/// What the tip takes from above is said where it is more than this part of a segment.
const BY_TIP: f64 = 0.05;

// No doc comment: clap would take it for that of the command.
#[derive(clap::Args)]
pub struct StockArguments {
    /// Compute what the tool meets from this box, in place of that of the cell: two corners in the path's frame, as in "-50, -50, -10 .. 50, 50, 0 mm"
    #[arg(
        long,
        value_name = "x,y,z .. x,y,z",
        allow_hyphen_values = true,
        value_parser = corners,
        conflicts_with = "forces"
    )]
    stock: Option<Stock>,
    /// The cut of another tool by its number, as in "2 = ball.yaml"; for each of them
    #[arg(long, value_name = "T = CUT.yaml", value_parser = of_tool, conflicts_with = "forces")]
    cut_of: Vec<(u32, PathBuf)>,
}

/// What is asked for, read.
pub struct StockRequest {
    stock: Option<Stock>,
    /// Where the path's frame stands in the base frame.
    place: Matrix4<f64>,
    /// The cuts of tools by their number.
    pub tools: Vec<(u32, Forces)>,
}

/// What is cut where.
pub struct Engaged {
    survey: Survey,
    lines: Vec<usize>,
}

fn corners(text: &str) -> Result<Stock, String> {
    let help = || "two corners are expected, e.g. \"-50, -50, -10 .. 50, 50, 0 mm\"".to_owned();
    let (one, other) = text.split_once("..").ok_or_else(help)?;
    let parts: Vec<&str> = one.split(',').chain(other.split(',')).collect();
    if parts.len() != 6 || one.split(',').count() != 3 {
        return Err(help());
    }
    let at = all_with_unit(&parts, Dimension::Length)?;
    let stock = Stock::of_corners(&Vector3::new(at[0], at[1], at[2]), &Vector3::new(at[3], at[4], at[5]));
    stock.ok_or_else(|| format!("the box has no volume: the corners are not opposite in x, y and z; {}", help()))
}

fn of_tool(text: &str) -> Result<(u32, PathBuf), String> {
    let help = "the number of a tool and its cut are expected, e.g. \"2 = ball.yaml\"";
    let (tool, file) = text.split_once('=').ok_or(help)?;
    let tool = tool.trim().trim_start_matches(['T', 't']).parse().map_err(|_| help)?;
    Ok((tool, PathBuf::from(file.trim())))
}

impl StockArguments {
    /// Whether a stock, or the cut of a tool, is given.
    pub fn is_given(&self) -> [bool; 2] {
        [self.stock.is_some(), !self.cut_of.is_empty()]
    }

    /// Reads what is named, with the stock of the cell where none is. `place` is where the path's frame stands in the
    /// base frame.
    pub fn read(
        &self,
        of_cell: Option<Stock>,
        place: Matrix4<f64>,
        files: &mut Files,
    ) -> Result<StockRequest, Failure> {
        let mut tools: Vec<(u32, Forces)> = Vec::new();
        for (tool, path) in &self.cut_of {
            if tools.iter().any(|(other, _)| other == tool) {
                return Err(Failure::Usage(format!("--cut-of gives the cut of tool {tool} twice")));
            }
            let file = input::cut(path)?;
            forces::protect(files, path, &file);
            tools.push((*tool, file.forces));
        }
        Ok(StockRequest { stock: self.stock.clone().or(of_cell), place, tools })
    }
}

impl StockRequest {
    /// Whether anything but the cut itself says what is met.
    pub fn is_asked(&self, path: &ToolPath) -> bool {
        self.stock.is_some()
            || !self.tools.is_empty()
            || path.points.iter().any(|point| point.width.is_some() || point.depth.is_some())
    }

    /// Whether there is a stock.
    pub fn has_stock(&self) -> bool {
        self.stock.is_some()
    }

    /// The stock.
    pub fn stock(&self) -> Option<&Stock> {
        self.stock.as_ref()
    }

    /// What is cut where with a cut of that name; `None` without a stock.
    pub fn survey<const N: usize>(
        &self,
        file: &CutFile,
        name: &str,
        solved: &SolvedPath<N>,
        axis: Unit<Vector3<f64>>,
    ) -> Result<Option<Engaged>, Failure> {
        let Some(stock) = &self.stock else { return Ok(None) };
        let of = |forces: &Forces, name: &str| match forces {
            Forces::Model(cut) => Ok(Cutter { diameter: cut.mill.diameter, corner: cut.mill.corner }),
            Forces::Measured { .. } => Err(Failure::Usage(format!(
                "--stock needs the shape of the tool, and {name} has measured forces: give a cut with a `tool`"
            ))),
        };
        let mut cutters = vec![of(&file.forces, name)?];
        for (tool, forces) in &self.tools {
            cutters.push(of(forces, &format!("the cut of tool {tool}"))?);
        }
        let cutter = |tool: Option<u32>| self.tools.iter().position(|(number, _)| Some(*number) == tool);
        let steps = steps(solved, &self.place, axis, |point| cutter(point.tool).map_or(0, |index| index + 1));
        let survey =
            Survey::new(stock, &steps, &cutters).map_err(|error| Failure::new(format_args!("--stock: {error}")))?;
        let lines = solved.points.iter().map(|point| point.line).collect();
        Ok(Some(Engaged { survey, lines }))
    }

    /// Says so where tools of several numbers have one cut, and refuses cuts of tools that are not there.
    pub fn complain_of_tools(&self, name: &str, path: &ToolPath) -> Result<(), Failure> {
        if let Some((tool, _)) =
            self.tools.iter().find(|(tool, _)| !path.points.iter().any(|point| point.tool == Some(*tool)))
        {
            return Err(Failure::Usage(format!("--cut-of: {} has no tool {tool}", path.file)));
        }
        let mut others: Vec<u32> =
            path.points.iter().filter(|point| !point.rapid).filter_map(|point| point.tool).collect();
        others.sort_unstable();
        others.dedup();
        others.retain(|tool| !self.tools.iter().any(|(number, _)| number == tool));
        if others.len() > 1 {
            let others: Vec<String> = others.iter().map(ToString::to_string).collect();
            complain(format_args!(
                "warning: {}: tools {} are all taken to be that of {name}: give the cuts of others by --cut-of",
                path.file,
                others.join(", ")
            ));
        }
        Ok(())
    }
}

impl Engaged {
    /// For the force.
    pub fn survey(&self) -> &Survey {
        &self.survey
    }

    /// Says with their lines what segments have no force for, or should not be.
    pub fn complain(&self, path: &ToolPath) {
        let which = |of: &dyn Fn(usize) -> bool| {
            let mut found: Vec<usize> = (0..self.lines.len()).filter(|&i| of(i)).map(|i| self.lines[i]).collect();
            found.dedup();
            found
        };
        let segments = &self.survey.segments;
        let say = |found: Vec<usize>, what: &str| {
            if !found.is_empty() {
                complain(format_args!("warning: {}: {}: {what}", path.file, lines(found)));
            }
        };
        say(which(&|i| segments[i].met == Met::Collision), "a rapid goes through the stock; it has no force here");
        say(
            which(&|i| i == 0 && segments[i].met == Met::Plunge),
            "the path begins in the stock: the hole there is taken to be made before",
        );
        let is_given = |i: usize| path.points[i].width.is_some() || path.points[i].depth.is_some();
        say(
            which(&|i| segments[i].met == Met::Tilted && !path.points[i].rapid && !is_given(i)),
            "the tool's axis is not along the stock's z, so what it meets is not known: no force, and nothing is cut; \
             columns `ae [mm]` and `ap [mm]` of a table give it",
        );
        say(
            which(&|i| {
                let segment = &segments[i];
                matches!(segment.met, Met::Cut(_)) && segment.by_tip > BY_TIP * segment.volume
            }),
            "the flat of the tip cuts on the way down; that part has no force",
        );
    }

    /// What a person reads.
    pub fn page(&self) -> String {
        let segments = &self.survey.segments;
        let cutting: Vec<(f64, [f64; 2])> =
            segments.iter().filter_map(|segment| Some((segment.length, segment.width_and_depth()?))).collect();
        let most = |axis: usize| cutting.iter().map(|(_, of)| of[axis]).fold(0.0, f64::max);
        let (length, area, volume) =
            cutting.iter().fold((0.0, 0.0, 0.0), |(length, area, volume), (part, [width, depth])| {
                (length + part, area + part * width, volume + part * width * depth)
            });
        let mm = |length: f64| decimals(1e3 * length, 2);
        let mut page = format!(
            "\n{} cm3 are cut from the stock, on {} of {}",
            decimals(1e6 * self.survey.volume(), 2),
            cutting.len(),
            count(segments.len(), "segment")
        );
        if length > 0.0 && area > 0.0 {
            write!(
                page,
                ":\nwidth {} mm in the mean, {} at most; depth {} mm in the mean, {} at most; on a grid of {} mm",
                mm(area / length),
                mm(most(0)),
                mm(volume / area),
                mm(most(1)),
                decimals(1e3 * self.survey.pitch, 3)
            )
            .expect("a string takes any text");
        }
        page + "\n"
    }

    /// Width and depth (m) of what is cut on the way to a point; 0 in the air, `None` where nobody knows.
    pub fn section(&self, index: usize) -> Option<[f64; 2]> {
        let segment = &self.survey.segments[index];
        match (segment.width_and_depth(), &segment.met) {
            (Some(section), _) => Some(section),
            (None, Met::Tilted | Met::Plunge) => None,
            (None, _) => Some([0.0; 2]),
        }
    }

    /// The cells of `ae [mm],ap [mm]` at a point; 0 in the air, empty where nobody knows.
    pub fn cells(&self, index: usize) -> String {
        match self.section(index) {
            Some([0.0, 0.0]) => "0,0".to_owned(),
            Some(section) => section.map(|side| cell(side * 1e3, 4)).join(","),
            None => ",".to_owned(),
        }
    }

    /// Everything in SI units.
    pub fn document(&self) -> Lazy<'_> {
        let met = |met: &Met| match met {
            Met::Air => "air",
            Met::Cut(_) => "cut",
            Met::Plunge => "plunge",
            Met::Collision => "collision",
            Met::Tilted => "tilted",
        };
        let segment = move |i: usize| {
            let segment = &self.survey.segments[i];
            let section = segment.width_and_depth();
            let stretches = match &segment.met {
                Met::Cut(stretches) => &stretches[..],
                _ => &[],
            };
            json!({
                "line": self.lines[i],
                "met": met(&segment.met),
                "removed_m3": number(segment.volume),
                "by_tip_m3": number(segment.by_tip),
                "width_m": section.map(|[width, _]| number(width)),
                "depth_m": section.map(|[_, depth]| number(depth)),
                "stretches": stretches.iter().map(|stretch| json!({
                    "length_m": number(stretch.length),
                    "arcs": stretch.bite.sectors.iter().map(|sector| json!({
                        "angles_rad": numbers([sector.engagement.entry, sector.engagement.exit]),
                        "above_tip_m": number(sector.above),
                        "depth_m": number(sector.depth),
                    })).collect::<Value>(),
                })).collect::<Value>(),
            })
        };
        Lazy::Fields(vec![
            ("removed_m3", number(self.survey.volume()).into()),
            ("grid_m", number(self.survey.pitch).into()),
            ("segments", Lazy::List(self.survey.segments.len().min(self.lines.len()), Box::new(segment))),
        ])
    }

    /// What is removed in a time (m^3/s), over the time of the segments that cut; `None` where the speed of one is not
    /// known.
    pub fn removal_rate<const N: usize>(&self, operation: &Operation<'_>, solved: &SolvedPath<N>) -> Option<f64> {
        let (mut volume, mut time) = (0.0, 0.0);
        for (segment, point) in self.survey.segments.iter().zip(&solved.points) {
            if matches!(segment.met, Met::Cut(_)) {
                volume += segment.volume;
                time += segment.length / operation.feed_speed(point)?;
            }
        }
        (time > 0.0).then(|| volume / time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stock_is_two_corners() {
        let stock = corners("-50, -50, -10 .. 50, 50, 0 mm").unwrap();
        assert_eq!((stock.bottom(), stock.thickness(), stock.outline()[2]), (-0.01, 0.01, [0.05, 0.05]));
        for wrong in ["1,2,3", "0,0 .. 0,0,1,1 mm", "0,0,0 .. 1,1,1", "0,0,0 .. 1,1,0 mm", "0,0,0 .. a,b,c mm"] {
            assert!(corners(wrong).is_err(), "{wrong}");
        }
        assert_eq!(of_tool("T2=a.yaml"), Ok((2, PathBuf::from("a.yaml"))));
        assert!(of_tool("a.yaml").is_err() && of_tool("x = a.yaml").is_err());
    }
}
