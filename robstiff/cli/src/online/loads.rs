//! What pushes the tool: read, and simulated with each of the controllers.

use std::ops::Range;
use std::path::Path;

use robstiff::Robot;
use robstiff::nalgebra::{Matrix3, SVector, Unit, Vector3, Vector6};
use robstiff_machining::deviation::{Deviation, ForceTable, Operation, Surface};
use robstiff_machining::milling::{CutFile, CutFrame, ForceFrame, Forces};
use robstiff_machining::online::{HeldBack, Instant, LeftOfSine, Timeline, left_of_sine, simulate_along};
use robstiff_machining::path::ToolPath;

use super::reach::Reach;
use super::{Arguments, FREQUENCIES, Frequencies, Variant, bound};
use crate::failure::Failure;
use crate::input::{Asked, Force, Opened, Setup};
use crate::output::{self, Files};
use crate::path::cutting::load_along;
use crate::path::doubts::complain_of_feed;
use crate::text::significant;
use crate::{forces, input};

/// In how many parts a record is told.
const PARTS: usize = 100;

/// What pushes the tool, read.
pub enum LoadRequest {
    /// A wrench that comes and goes.
    Sine { q: Vec<f64>, wrench: Vector6<f64>, frequencies: Vec<f64>, name: String },
    /// A record of forces over time (s; N, Nm).
    Record { q: Vec<f64>, samples: Vec<(f64, Vector6<f64>)>, name: String },
    /// A path.
    Path { path: Box<ToolPath>, source: Source, axis: Unit<Vector3<f64>>, feed: Option<f64>, name: String },
}

pub enum Source {
    Cut(CutFile),
    Table(ForceTable),
}

/// What came of it.
pub struct Simulated {
    /// What was simulated.
    pub name: String,
    pub outcome: Outcome,
}

pub enum Outcome {
    /// By frequency (Hz).
    Sine {
        q: Vec<f64>,
        wrench: Vector6<f64>,
        /// The displacement without correction (m).
        deviation: f64,
        frequencies: Vec<f64>,
        /// For each variant and frequency.
        left: Vec<Vec<LeftOfSine>>,
        /// For each variant, up to which frequency less than half and less than all is left.
        useful: Vec<[Reach; 2]>,
    },
    /// Along a path or over a record.
    Along {
        stops: Vec<Stop>,
        /// Which part of the time something pushes the tool.
        in_cut: f64,
        without: Course,
        /// For each variant.
        with: Vec<Course>,
        /// For each variant, in which part of the time a limit holds it back.
        held_back: Vec<HeldBack<f64>>,
    },
}

/// A point of the path, or the end of a part of the record.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    pub time: f64,
    /// The line and the arc length (m) of a path's point.
    pub place: Option<(usize, f64)>,
}

/// Distances of the tool from where it should be (m).
pub struct Course {
    /// While something pushes the tool.
    pub rms: f64,
    pub worst: f64,
    /// The worst while nothing does: what a correction has not yet taken back, or an
    /// arm with hysteresis keeps.
    pub aside: f64,
    /// The stop that the worst comes before or at.
    pub at: usize,
    /// The worst since the stop before, in the cut or not; not a number where there
    /// is nothing between the two.
    pub since: Vec<f64>,
}

impl LoadRequest {
    /// Reads what is named.
    pub fn read(
        arguments: &Arguments,
        path: Option<&Path>,
        setup: &mut Setup,
        files: &mut Files,
    ) -> Result<Self, Failure> {
        let load = &arguments.load;
        let has_force = load.forces.is_some() || load.force.is_some();
        let cut = match setup.cut(load.cut.as_ref()).filter(|_| !has_force) {
            Some(path) => {
                let file = input::cut(&path)?;
                forces::protect(files, &path, &file);
                Some((file, path.display().to_string()))
            }
            None => None,
        };
        if let Some(path) = path {
            let (source, by) = match (&load.forces, cut) {
                (Some(path), _) => {
                    let table = ForceTable::read(path)?;
                    table.warnings.iter().for_each(|warning| output::complain(format_args!("warning: {warning}")));
                    files.protect(path);
                    (Source::Table(table), path.display().to_string())
                }
                (None, Some((file, name))) => (Source::Cut(file), name),
                (None, None) => {
                    return Err(Failure::Usage(
                        "a path needs a force: give `--cut CUT.yaml` or `--forces FORCES.csv`".to_owned(),
                    ));
                }
            };
            let name = format!("{} under {by}", path.display());
            let Opened { path, spindle, .. } = setup.open(&Asked {
                path,
                tool_axis: load.tool_axis,
                spindle_axis: load.spindle_axis,
                place: load.place,
                program: &arguments.program,
            })?;
            if let Source::Cut(file) = &source {
                complain_of_feed(file, &by, &path, false);
                let whole = Operation { forces: &file.forces, tools: &[], at_feeds: false, survey: None, angles: None };
                whole.check(&path)?;
            }
            let axis = spindle.ok_or_else(|| setup.lacks_axis("--spindle-axis"))?;
            return Ok(Self::Path { path: Box::new(path), source, axis, feed: load.feed, name });
        }
        setup.mount()?;
        let q = load.at.pose(&setup.robot)?;
        let frequencies = load.frequencies.as_ref().map_or(FREQUENCIES.to_vec(), |Frequencies(given)| given.clone());
        let sine = |wrench, name| Self::Sine { q: q.clone(), wrench, frequencies: frequencies.clone(), name };
        match (cut, load.force) {
            (Some((file, name)), _) => {
                let turn = turn(&file.forces, setup, &q, arguments)?;
                let wrench = |force: Vector3<f64>| {
                    let force = turn * force;
                    Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0)
                };
                if let Forces::Measured { force, .. } = &file.forces {
                    let sample =
                        |sample: &robstiff_machining::milling::Sample| Some((sample.time?, wrench(sample.force)));
                    if let Some(samples) = force.samples.iter().map(sample).collect() {
                        if load.frequencies.is_some() {
                            return Err(Failure::Usage(format!(
                                "--frequencies: {name} records forces over time, which are played once"
                            )));
                        }
                        return Ok(Self::Record { q, samples, name });
                    }
                }
                Ok(sine(wrench(file.forces.mean()), format!("the mean force of {name}")))
            }
            (None, Some(Force([x, y, z]))) => Ok(sine(Vector6::new(x, y, z, 0.0, 0.0, 0.0), "the force".to_owned())),
            (None, None) => Err(Failure::Usage(
                "a pose needs a force: give `--force \"0, 0, -400 N\"` or `--cut CUT.yaml`, or a path".to_owned(),
            )),
        }
    }

    /// Simulates each variant on the robot, with a model for what a controller that does not
    /// know it takes it for; the sensor is silent in this time (s).
    ///
    /// # Errors
    /// What cannot be simulated, or would take too long: why.
    pub fn simulate<const N: usize>(
        &self,
        (robot, model): (&impl Robot<N>, &impl Robot<N>),
        variants: &[Variant],
        silent: Option<&Range<f64>>,
    ) -> Result<Simulated, Failure> {
        let (name, outcome) = match self {
            Self::Sine { q, wrench, frequencies, name } => {
                if silent.is_some() {
                    return Err(Failure::Usage(
                        "--lost needs a path or a record of forces over time, not a force by its frequency".to_owned(),
                    ));
                }
                let q = SVector::from_column_slice(q);
                (name, by_frequency((robot, model), &q, wrench, frequencies, variants)?)
            }
            Self::Record { q, samples, name } => {
                let (timeline, stops) = of_record(q, samples, name)?;
                (name, along(name, (robot, model), (&timeline, stops), variants, silent)?)
            }
            Self::Path { path, source, axis, feed, name } => {
                let (timeline, stops) = of_path(robot, path, source, *axis, *feed)?;
                (name, along(name, (robot, model), (&timeline, stops), variants, silent)?)
            }
        };
        Ok(Simulated { name: name.clone(), outcome })
    }
}

/// A record at a pose over time, told in parts of equal length.
fn of_record<const N: usize>(
    q: &[f64],
    samples: &[(f64, Vector6<f64>)],
    name: &str,
) -> Result<(Timeline<N>, Vec<Stop>), Failure> {
    let timeline = Timeline::at_pose(&SVector::from_column_slice(q), samples.iter().copied())
        .filter(|timeline| timeline.duration() > 0.0)
        .ok_or_else(|| Failure::new(format!("the record of {name} has no duration")))?;
    let part = timeline.duration() / PARTS as f64;
    let stops = (1..=PARTS).map(|k| Stop { time: part * k as f64, place: None }).collect();
    Ok((timeline, stops))
}

/// A path under what pushes the tool, over time, told point by point.
fn of_path<const N: usize>(
    robot: &impl Robot<N>,
    path: &ToolPath,
    source: &Source,
    axis: Unit<Vector3<f64>>,
    feed: Option<f64>,
) -> Result<(Timeline<N>, Vec<Stop>), Failure> {
    let solved = path.solve(robot, None)?;
    let load = match source {
        Source::Table(table) => table.load(&solved, ForceFrame::Base, axis, Surface::Side)?,
        Source::Cut(file) => load_along(&file.forces, path, &solved, axis, Surface::Side),
    };
    let speed = match source {
        Source::Cut(CutFile { forces: Forces::Model(cut), .. }) => feed.or(cut.feed_speed()),
        _ => feed,
    };
    // The force of the tool where the arm lets it go, as without correction.
    let deviation = Deviation::of(robot, &solved, &load).map_err(Failure::new)?;
    let wrenches: Vec<Vector6<f64>> = deviation.points.iter().map(|point| point.wrench).collect();
    let timeline = Timeline::of_path(&solved, &wrenches, speed).map_err(|error| {
        let help = "give --feed \"600 mm/min\", or a column `feed [mm/min]`";
        Failure::new(format_args!("{}: {error}; {help}", path.file))
    })?;
    let stops = timeline.times().zip(&solved.points);
    let stops = stops.map(|(time, point)| Stop { time, place: Some((point.line, point.s)) }).collect();
    Ok((timeline, stops))
}

/// Simulates each variant over a path or a record of this name.
fn along<const N: usize>(
    name: &str,
    (robot, model): (&impl Robot<N>, &impl Robot<N>),
    (timeline, stops): (&Timeline<N>, Vec<Stop>),
    variants: &[Variant],
    silent: Option<&Range<f64>>,
) -> Result<Outcome, Failure> {
    let duration = timeline.duration();
    if duration == 0.0 {
        return Err(Failure::new(format_args!("{name} takes no time: it has no two points apart")));
    }
    if let Some(variant) = variants.iter().find(|variant| variant.controller.step > duration) {
        return Err(Failure::new(format!(
            "{name} takes {} s, less than a control step of {} s",
            significant(duration, 4),
            significant(variant.controller.step, 4)
        )));
    }
    bound::along(name, duration, variants)?;
    if silent.is_some_and(|silent| silent.start >= duration) {
        output::complain(format_args!(
            "warning: {name} ends after {} s, before --lost begins",
            significant(duration, 4)
        ));
    }
    let reading =
        |time: f64, wrench: &Vector6<f64>| (!silent.is_some_and(|silent| silent.contains(&time))).then_some(*wrench);
    let mut without = None;
    let mut in_cut = 0.0;
    let (mut with, mut held_back) = (Vec::new(), Vec::new());
    for variant in variants {
        let seen = if variant.knows {
            simulate_along((robot, robot), timeline, &variant.controller, reading)
        } else {
            simulate_along((robot, model), timeline, &variant.controller, reading)
        };
        in_cut = seen.iter().filter(|instant| instant.in_cut).count() as f64 / seen.len() as f64;
        if in_cut == 0.0 {
            return Err(Failure::new(format!("{name}: there is no force anywhere")));
        }
        without.get_or_insert_with(|| Course::of(&seen, &stops, |instant| instant.uncorrected));
        with.push(Course::of(&seen, &stops, |instant| instant.corrected));
        held_back.push(HeldBack::share(seen.iter()));
    }
    let without = without.expect("there is at least one variant");
    Ok(Outcome::Along { stops, in_cut, without, with, held_back })
}

fn by_frequency<const N: usize>(
    (robot, model): (&impl Robot<N>, &impl Robot<N>),
    q: &SVector<f64, N>,
    wrench: &Vector6<f64>,
    frequencies: &[f64],
    variants: &[Variant],
) -> Result<Outcome, Failure> {
    bound::sines(variants, frequencies)?;
    let deviation = robot.deflection(q, wrench).fixed_rows::<3>(0).norm();
    if !(deviation > 0.0 && deviation.is_finite()) {
        return Err(Failure::new("the force does not move the tool in this pose"));
    }
    let left_of = |variant: &Variant, frequency: f64| {
        let reading = |_: f64, wrench: &Vector6<f64>| Some(*wrench);
        match variant.knows {
            true => left_of_sine((robot, robot), q, &variant.controller, (wrench, frequency), reading),
            false => left_of_sine((robot, model), q, &variant.controller, (wrench, frequency), reading),
        }
    };
    let left = variants.iter().map(|variant| frequencies.iter().map(|&each| left_of(variant, each)).collect());
    let [lowest, highest] = [f64::min, f64::max].map(|of| frequencies.iter().copied().fold(frequencies[0], of));
    let first = 1.0_f64.clamp(lowest, highest);
    let useful = variants.iter().map(|variant| {
        let of = |frequency: f64| left_of(variant, frequency).rms;
        let affordable = |frequency: f64| bound::is_quick(&variant.controller, frequency);
        let lag = variant.controller.lag();
        let half = Reach::of(0.5, (first, lag), affordable, of);
        [half, Reach::of(1.0, (half.found().unwrap_or(first), lag), affordable, of)]
    });
    let (left, useful) = (left.collect(), useful.collect());
    Ok(Outcome::Sine {
        q: q.iter().copied().collect(),
        wrench: *wrench,
        deviation,
        frequencies: frequencies.to_vec(),
        left,
        useful,
    })
}

impl Course {
    fn of(seen: &[Instant], stops: &[Stop], of: impl Fn(&Instant) -> Vector3<f64>) -> Self {
        let mut since = vec![f64::NAN; stops.len()];
        let (mut squares, mut count) = (0.0, 0_usize);
        let (mut worst, mut worst_at, mut aside) = (f64::NAN, 0, f64::NAN);
        for instant in seen {
            let at = stops.partition_point(|stop| stop.time < instant.time);
            if at == stops.len() {
                break;
            }
            let distance = of(instant).norm();
            since[at] = distance.max(since[at]);
            if !instant.in_cut {
                aside = distance.max(aside);
                continue;
            }
            squares += distance * distance;
            count += 1;
            if worst.is_nan() || distance > worst {
                (worst, worst_at) = (distance, at);
            }
        }
        Self { rms: (squares / count.max(1) as f64).sqrt(), worst, aside, at: worst_at, since }
    }
}

/// What turns the forces of a cut at a pose into the base frame.
fn turn(forces: &Forces, setup: &Setup, q: &[f64], arguments: &Arguments) -> Result<Matrix3<f64>, Failure> {
    let pose = with_arm!(&setup.robot, |arm| arm.transform(&SVector::from_column_slice(q)));
    let tool: Matrix3<f64> = pose.fixed_view::<3, 3>(0, 0).into_owned();
    let (given, option) = match arguments.load.spindle_axis {
        Some(axis) => (Some(axis), "--spindle-axis"),
        None => (arguments.load.tool_axis, "--tool-axis"),
    };
    let axis = setup.spindle(option, given.map(Unit::into_inner))?;
    let frame =
        axis.and_then(|axis| CutFrame::new(&(tool * axis.as_ref()), &arguments.load.toward.unwrap_or(Vector3::x())));
    forces.to_base(frame.as_ref(), &tool).ok_or_else(|| match axis {
        Some(_) => Failure::Usage("--toward goes along the tool's axis; a cut feeds across it".to_owned()),
        None => setup.lacks_axis("--tool-axis"),
    })
}
