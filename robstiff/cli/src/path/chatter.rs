//! Where along the path the arm chatters.

use std::path::PathBuf;

use robstiff::Robot;
use robstiff::elements::contributions_under;
use robstiff::nalgebra::{SVector, Unit, Vector3, Vector6};
use robstiff_machining::deviation::Operation;
use robstiff_machining::path::{SolvedPath, ToolPath};
use robstiff_machining::stability::along::{GREATEST, Place, along, thinned};
use robstiff_machining::stability::{Modes, ModesFile};
use robstiff_robots::Link;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::input::{Setup, ratio};
use crate::json::number;
use crate::modes;
use crate::output::Files;
use crate::text::{Table, count, decimals, significant};

/// Places of a path that are looked at.
const PLACES: usize = 200;

/// Places that are shown.
const MOST_SHOWN: usize = 5;

#[derive(clap::Args)]
pub struct ChatterArguments {
    /// Say where along the path the arm chatters: by the masses of the links, every mode with this damping ratio, e.g. 0.02
    #[arg(long, value_name = "RATIO", allow_hyphen_values = true, value_parser = ratio, conflicts_with_all = ["forces", "modes"])]
    damping: Option<f64>,
    /// The same with measured modes, taken to be the same all along the path
    #[arg(long, value_name = "MODES.yaml", conflicts_with = "forces")]
    modes: Option<PathBuf>,
}

/// Where the modes come from.
enum Source {
    Links(Vec<Link>, f64),
    Table(ModesFile, String),
}

/// What is asked for, read.
pub struct ChatterRequest {
    source: Source,
    /// What the spindle turns (rad/s).
    speeds: Option<[f64; 2]>,
}

/// What was found.
pub struct Chatter {
    /// Where the modes come from.
    modes: String,
    /// The places, each with its line in the path's file.
    pub places: Vec<(usize, Place)>,
}

impl ChatterArguments {
    /// Whether it is asked for, by the name of the option.
    pub fn asked(&self) -> Option<&'static str> {
        match (self.damping, &self.modes) {
            (Some(_), _) => Some("--damping"),
            (None, Some(_)) => Some("--modes"),
            (None, None) => None,
        }
    }

    /// Reads what is named.
    pub fn read(&self, setup: &Setup, files: &mut Files) -> Result<Option<ChatterRequest>, Failure> {
        let source = match (self.damping, &self.modes) {
            (Some(damping), _) => Source::Links(setup.robot.links.clone(), damping),
            (None, Some(path)) => {
                let file = modes::read(path)?;
                modes::protect(files, path, &file);
                Source::Table(file, path.display().to_string())
            }
            (None, None) => return Ok(None),
        };
        let speeds = setup.cell().and_then(|cell| cell.spindle.as_ref()?.speeds);
        Ok(Some(ChatterRequest { source, speeds }))
    }
}

impl ChatterRequest {
    /// The margins along a path of what cuts there.
    pub fn compute<const N: usize>(
        &self,
        robot: &impl Robot<N>,
        (path, solved): (&ToolPath, &SolvedPath<N>),
        operation: &Operation<'_>,
        axis: Unit<Vector3<f64>>,
    ) -> Result<Chatter, Failure> {
        let cutting = operation.cutting(solved, axis);
        if cutting.is_empty() {
            return Err(Failure::new(format_args!(
                "{}: nothing is cut along the path at a speed of the spindle that is known, so nothing chatters; write \
                 `speed` into the cut",
                path.file
            )));
        }
        let places = thinned(cutting, PLACES);
        let asked = &places[0].q;
        let of_links = |links: &[Link], damping: f64, q: &SVector<f64, N>, force: &Vector3<f64>| {
            let wrench = Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0);
            Modes::of_links(robot, links, q, contributions_under(robot, q, &wrench), damping)
        };
        if let Source::Links(links, damping) = &self.source {
            // Links without masses have none anywhere.
            of_links(links, *damping, asked, &Vector3::zeros()).map_err(|error| {
                Failure::new(format_args!("{error}; give the modes as they are measured: --modes MODES.yaml"))
            })?;
        }
        let modes = |q: &SVector<f64, N>, force: &Vector3<f64>| match &self.source {
            Source::Links(links, damping) => of_links(links, *damping, q, force).ok(),
            Source::Table(table, _) => table.in_base(&robot.transform(q).fixed_view::<3, 3>(0, 0).into_owned()),
        };
        let found = along(&places, modes, self.speeds).ok_or_else(|| {
            Failure::new("the modes along the path are so stiff or so soft that they cannot be computed with")
        })?;
        let places = found.into_iter().map(|place| (solved.points[place.point].line, place)).collect();
        let modes = match &self.source {
            Source::Links(_, damping) => {
                format!("modes by the masses of the links, damping ratio {}", significant(*damping, 3))
            }
            Source::Table(table, file) => {
                format!("modes of {file}, the same all along the path{}", modes::fitted(table))
            }
        };
        Ok(Chatter { modes, places })
    }
}

/// A margin as a factor; beyond what was looked at as that.
fn times(margin: Option<f64>) -> String {
    margin.map_or_else(|| format!("over {GREATEST}"), |margin| significant(margin, 3))
}

fn rpm(speed: f64) -> String {
    decimals(speed * 60.0 / core::f64::consts::TAU, 0)
}

impl Chatter {
    /// The places with the least margins, the worst first.
    pub fn worst(&self) -> Vec<&(usize, Place)> {
        let margin = |(_, place): &(usize, Place)| place.margin.unwrap_or(f64::INFINITY);
        let mut worst: Vec<&(usize, Place)> = self.places.iter().filter(|(_, place)| place.margin.is_some()).collect();
        worst.sort_by(|one, other| margin(one).total_cmp(&margin(other)));
        worst.truncate(MOST_SHOWN);
        worst
    }

    /// Where it chatters, in a sentence without its full stop.
    pub fn said(&self) -> String {
        let length = |of: &dyn Fn(&Place) -> bool| -> String {
            let of = self.places.iter().filter(|(_, place)| of(place));
            decimals(of.map(|(_, place)| place.length).sum::<f64>() * 1e3, 0)
        };
        match self.places.iter().filter(|(_, place)| place.chatters()).count() {
            0 => format!("the arm chatters at none of {}", count(self.places.len(), "place")),
            chattering => format!(
                "the arm chatters at {chattering} of {}, {} of {} mm that are cut",
                count(self.places.len(), "place"),
                length(&Place::chatters),
                length(&|_| true)
            ),
        }
    }

    /// The cells of a row of the worst places: line, speed (rpm), margin, and the speed that mends it (rpm).
    pub fn row((line, place): &(usize, Place)) -> [String; 4] {
        let mended = match (place.chatters(), place.mended) {
            (false, _) => "-".to_owned(),
            (true, Some(speed)) => rpm(speed),
            (true, None) => "none".to_owned(),
        };
        [line.to_string(), rpm(place.speed), times(place.margin), mended]
    }

    /// What people are told.
    pub fn page(&self) -> String {
        let mut page = format!("\nChatter: {}\n{}\n", self.modes, crate::text::capital(&self.said()));
        let worst = self.worst();
        if !worst.is_empty() {
            let mut table = Table::new(0, ["line", "speed [rpm]", "stable up to [of its depth]", "stable at [rpm]"]);
            worst.into_iter().for_each(|place| table.row(Self::row(place)));
            page += &table.to_string();
        }
        page
    }

    /// Everything in SI units.
    pub fn document(&self) -> Value {
        json!({
            "modes": self.modes,
            "greatest_margin": number(GREATEST),
            "places": self.places.iter().map(|(line, place)| json!({
                "line": line,
                "point": place.point,
                "length_m": number(place.length),
                "speed_rad_per_s": number(place.speed),
                "margin": place.margin.map(number),
                "chatters": place.chatters(),
                "mended_rad_per_s": place.mended.map(number),
            })).collect::<Value>(),
        })
    }
}
