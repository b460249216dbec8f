//! `robstiff stability`: how deep a cut may be before the arm chatters, by the direction of the
//! feed and the speed of the spindle.

mod lobes;
mod page;
mod picture;

use std::path::PathBuf;

use robstiff::Robot;
use robstiff::analysis::translational_compliance;
use robstiff::elements::{compliance_under, contributions, contributions_under};
use robstiff::nalgebra::{Matrix3, SVector, Unit, Vector3, Vector6};
use robstiff_machining::milling::{Cut, Forces};
use robstiff_machining::stability::{FeedLimit, Modes, ModesFile, mass_of_first_mode, over_feeds};
use robstiff_robots::Description;
use robstiff_robots::quantity::Dimension;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::input::{Setup, axis, positive, ratio, whole};
use crate::output::{self, Files};
use crate::{forces, input, json, modes};
use lobes::Lobe;

/// The depths of cut at which the arm chatters, by direction of feed and spindle speed
///
/// At the low frequencies of the arm's own modes, each tooth cutting the surface
/// that the tooth before has left. The modes of spindle, tool and workpiece are
/// another matter, and not looked at.
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue; left out with `--cell`
    #[arg(value_name = "ROBOT.yaml", required_unless_present = "cell")]
    robot: Option<PathBuf>,
    /// The cut (robstiff/docs/commands/forces.md); its depth is the one that is judged. Where left out, that of the cell
    #[arg(value_name = "CUT.yaml")]
    cut: Option<PathBuf>,
    #[command(flatten)]
    cell: input::CellArgument,
    #[command(flatten)]
    at: input::At,
    /// The frequency of the arm's first mode as measured in this pose, e.g. "15 Hz"; by the links' masses where left out
    #[arg(long, value_name = "FREQUENCY", allow_hyphen_values = true, value_parser = positive(Dimension::Frequency))]
    frequency: Option<f64>,
    /// The modes of the tool on the arm as measured in this pose: frequency, damping, stiffness and direction of each,
    /// or the frequency responses to which they are fitted
    #[arg(long, value_name = "MODES.yaml", conflicts_with_all = ["frequency", "damping"])]
    modes: Option<PathBuf>,
    /// The damping ratio of the arm's modes; without it, the arm is taken to have no damping
    #[arg(long, value_name = "RATIO", default_value_t = 0.0, allow_hyphen_values = true, value_parser = ratio)]
    damping: f64,
    /// The axis of the spindle in the TCP's frame, from the spindle to the tip: x, y, z, -x, -y, -z, or a vector "0,0,1".
    /// Where left out, that of the cell, or z where the description tells it
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = axis)]
    tool_axis: Option<Vector3<f64>>,
    /// The speed of the spindle, e.g. "9000 rpm", in place of the cut's
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true, value_parser = positive(Dimension::RotationalSpeed))]
    speed: Option<f64>,
    /// The speeds of the lobe diagram, e.g. "3000 rpm, 18000 rpm"; where left out those of the cell's
    /// spindle, or from a fifth to twice the speed
    #[arg(long, value_name = "FROM,TO", allow_hyphen_values = true, value_parser = lobes::range)]
    speeds: Option<[f64; 2]>,
    /// The greatest depth looked at, e.g. "10 mm", at least the cut's; where left out, ten times that
    #[arg(long, value_name = "DEPTH", allow_hyphen_values = true, value_parser = positive(Dimension::Length))]
    greatest: Option<f64>,
    /// How many directions of the feed are looked at
    #[arg(long, value_name = "COUNT", default_value_t = 72, value_parser = whole::<u16>(4, 3600))]
    feeds: u16,
    /// Draw the depths over the feed and over the spindle speed to FILE
    #[arg(long, value_name = "FILE.svg")]
    out: Option<PathBuf>,
    /// Write the same as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// A compliance that changes by less is the same.
const ROUNDING: f64 = 1e-9;

/// Where the modes come from.
#[derive(Clone, Copy)]
pub enum Source {
    /// A table of measured modes.
    Table,
    /// The measured frequency of the first mode, which gives one mass.
    Frequency,
    /// The masses of the links.
    Links,
}

/// What is predicted of an arm in a cut.
pub struct Predicted {
    /// The mass at the TCP in the base frame (kg), where it has one in all directions.
    mass: Option<Matrix3<f64>>,
    /// Of the arm without load, where a hammer finds them.
    modes: Modes,
    source: Source,
    /// The table that they come from.
    table: Option<ModesFile>,
    /// Whether the arm under the cut is another: backlash or hardening.
    stiffens: bool,
    /// From the spindle to the tip, in the base frame.
    axis: Vector3<f64>,
    /// The greatest depth looked at (m).
    greatest: f64,
    feeds: Vec<FeedLimit>,
    /// The same feeds at other speeds.
    lobes: Vec<Lobe>,
}

/// Predicts.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (robot, behind) = (arguments.robot.as_ref(), arguments.cut.as_ref());
    let (mut setup, given) = arguments.cell.setup(robot, behind, "robstiff stability CUT.yaml")?;
    let measured = arguments.modes.as_deref().map(modes::read).transpose()?;
    // What was measured needs no compliance of the description.
    if measured.is_none() {
        input::refuse_if_rigid(&setup.robot, "`robstiff stability`")?;
    }
    let Some(cut_path) = setup.cut(given.as_ref()) else {
        return Err(Failure::Usage("no CUT.yaml is given, and no cell that names one under `cut:`".to_owned()));
    };
    let file = input::cut(&cut_path)?;
    let Forces::Model(cut) = &file.forces else {
        return Err(Failure::new(
            "a measured force does not say how it changes with the chip; give the cut with tool and material",
        ));
    };
    let cut = &Cut { speed: arguments.speed.or(cut.speed), ..cut.clone() };
    let (Some(speed), Some(period)) = (cut.speed, cut.tooth_period()) else {
        return Err(Failure::new(format!(
            "{} gives no `speed` of the spindle, on which the depth depends; write it there, or give it: \
             --speed \"9000 rpm\"",
            cut_path.display()
        )));
    };
    if let Some(greatest) = arguments.greatest.filter(|greatest| *greatest < cut.depth) {
        let [greatest, depth] = [greatest, cut.depth].map(page::millimetres);
        return Err(Failure::Usage(format!(
            "--greatest: {greatest} mm is less than the depth of the cut, {depth} mm, which is the one that is judged"
        )));
    }
    setup.mount()?;
    let robot = &setup.robot;
    let axis = setup.spindle("--tool-axis", arguments.tool_axis)?.ok_or_else(|| setup.lacks_axis("--tool-axis"))?;
    let q = arguments.at.pose(robot)?;
    let mut files = Files::default();
    setup.protect(&mut files);
    forces::protect(&mut files, &cut_path, &file);
    if let (Some(path), Some(file)) = (&arguments.modes, &measured) {
        modes::protect(&mut files, path, file);
    }
    files.foresee(arguments.out.iter().chain(&arguments.json))?;
    let predicted = with_arm!(robot, |arm| predict(
        &arm,
        &setup,
        cut,
        ([speed, period], axis),
        (&q[..], measured.as_ref()),
        arguments
    ))?;
    if let Some(path) = &arguments.out {
        files.add(path, picture::svg(&predicted, cut));
    }
    if let Some(path) = &arguments.json {
        files.add(path, json::document(&document(&predicted, robot, cut, &q)));
    }
    let said = files.write()?;
    output::print(page::page(&predicted, robot, cut) + &said)
}

fn predict<const N: usize>(
    arm: &impl Robot<N>,
    setup: &Setup,
    cut: &Cut,
    ([speed, period], axis): ([f64; 2], Unit<Vector3<f64>>),
    (q, measured): (&[f64], Option<&ModesFile>),
    arguments: &Arguments,
) -> Result<Predicted, Failure> {
    let (robot, q) = (&setup.robot, SVector::from_column_slice(q));
    let tool: Matrix3<f64> = arm.transform(&q).fixed_view::<3, 3>(0, 0).into_owned();
    let compliance = translational_compliance(&arm.compliance(&q));
    if measured.is_none() && compliance.amax() == 0.0 {
        return Err(Failure::new(format!("{} does not yield in this pose", robot.name)));
    }
    let not_finite = || Failure::new("the compliance in this pose is not finite");
    let first = match arguments.frequency {
        Some(frequency) => Some(mass_of_first_mode(&compliance, frequency).ok_or_else(not_finite)?),
        None => None,
    };
    let (modes, source) = match (measured, &first) {
        (Some(table), _) => {
            let beyond =
                || Failure::new("the measured modes are so stiff or so soft that they cannot be computed with");
            (table.in_base(&tool).ok_or_else(beyond)?, Source::Table)
        }
        (None, Some(mass)) => {
            (Modes::new(&compliance, mass, arguments.damping).ok_or_else(not_finite)?, Source::Frequency)
        }
        (None, None) => {
            let parts = contributions(arm, &q);
            let of_links = Modes::of_links(arm, &robot.links, &q, parts, arguments.damping).map_err(|error| {
                Failure::new(format!(
                    "{error}; measure the first mode at the tool and give it: --frequency \"15 Hz\", or more of \
                     them: --modes MODES.yaml"
                ))
            })?;
            (of_links, Source::Links)
        }
    };
    let axis = tool * axis.as_ref();
    let greatest = arguments.greatest.unwrap_or(10.0 * cut.depth);
    // Masses stay what they are when the cut takes up the backlash.
    let under = |force: &Vector3<f64>| {
        let wrench = Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0);
        match (source, &first) {
            (Source::Table, _) => Some(modes.clone()),
            (_, Some(mass)) => {
                let compliance = translational_compliance(&compliance_under(arm, &q, &wrench));
                Modes::new(&compliance, mass, arguments.damping)
            }
            (_, None) => {
                let parts = contributions_under(arm, &q, &wrench);
                Modes::of_links(arm, &robot.links, &q, parts, arguments.damping).ok()
            }
        }
    };
    let feeds = over_feeds(under, cut, &axis, arguments.feeds.into(), period, greatest)
        .ok_or_else(|| Failure::new("the compliance under the cut is not finite"))?;
    let unloaded = modes.compliance();
    let change = |feed: &FeedLimit| (feed.modes.compliance() - unloaded).amax() / unloaded.amax();
    let stiffens = feeds.iter().any(|feed| change(feed) > ROUNDING);
    let mass = first.or_else(|| modes.mass());
    let of_spindle = setup.cell().and_then(|cell| cell.spindle.as_ref()?.speeds);
    let lobes = lobes::over_speeds(&feeds, cut, lobes::speeds(arguments.speeds.or(of_spindle), speed));
    let table = measured.cloned();
    Ok(Predicted { mass, modes, source, table, stiffens, axis, greatest, feeds, lobes })
}

/// The stiffness of the softest direction (N/m); `None` where all are rigid.
fn softest(modes: &Modes) -> Option<f64> {
    Some(modes.compliance().symmetric_eigenvalues().max()).filter(|most| *most > 0.0).map(f64::recip)
}

/// The damping ratio of all modes, where it is the same.
fn alike(modes: &Modes) -> Option<f64> {
    let (first, others) = modes.damping().split_first()?;
    others.iter().all(|damping| damping == first).then_some(*first)
}

/// Everything in SI units; what does not exist is null.
fn document(predicted: &Predicted, robot: &Description, cut: &Cut, q: &[f64]) -> Value {
    let feed = |feed: &FeedLimit| {
        json!({
            "angle_rad": json::number(feed.angle),
            "feed": json::numbers(feed.feed.iter().copied()),
            "softest_N_per_m": softest(&feed.modes),
            "limiting_depth_m": feed.limits.limiting(),
            "without_delay_m": feed.without_delay.limiting(),
            "at_any_speed_m": feed.lobes.at_any_speed(),
            "unstable_m": feed.limits.unstable,
            "stable": feed.limits.is_stable_up_to(cut.depth),
        })
    };
    let lobe = |lobe: &Lobe| {
        json!({
            "speed_rad_per_s": json::number(lobe.speed),
            // In the order of `feeds`.
            "limiting_depth_m": lobe.limits,
        })
    };
    json!({
        "robot": robot.name,
        "q": json::numbers(q.iter().copied()),
        "covers": page::COVERS,
        "mean_force_N": cut.mean_force().norm(),
        "translational_compliance": json::matrix(predicted.modes.compliance()),
        "mass": predicted.mass.as_ref().map(json::matrix),
        "frequencies_Hz": json::numbers(predicted.modes.frequencies().iter().map(|w| w / std::f64::consts::TAU)),
        // Of all modes, where it is the same.
        "damping": alike(&predicted.modes),
        "dampings": json::numbers(predicted.modes.damping().iter().copied()),
        "fit": predicted.table.as_ref().map(modes::document),
        "tool_axis": json::numbers(predicted.axis.iter().copied()),
        "speed_rad_per_s": cut.speed.map(json::number),
        "teeth_Hz": cut.tooth_period().map(|period| json::number(period.recip())),
        "depth_m": json::number(cut.depth),
        "greatest_depth_m": json::number(predicted.greatest),
        "best": robstiff_machining::stability::best(&predicted.feeds).map(feed),
        "feeds": predicted.feeds.iter().map(feed).collect::<Value>(),
        "lobes": predicted.lobes.iter().map(lobe).collect::<Value>(),
    })
}
