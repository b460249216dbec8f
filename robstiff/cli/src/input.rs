//! What commands are given: robots by path or by name, and joint coordinates.

use std::f64::consts::TAU;
use std::path::Path;

use robstiff_identify::campaign::Campaign;
use robstiff_machining::milling::CutFile;
use robstiff_robots::quantity::{self, Dimension};
use robstiff_robots::{Description, Joint, JointKind, catalogue};

mod cell;
mod frames;
mod nominal;
mod options;
mod program;

use crate::failure::Failure;
use crate::{output, text};

pub use cell::{Asked, CellArgument, Opened, Setup};
pub use frames::{NamedFrame, RobotLanguage, blend, joint_speed, named_frame};
pub use nominal::{moved, nominal};
pub use options::{
    Force, above_zero, all_with_unit, axis, axis_name, force, length, margin, positive, ratio, seed, three_with_unit,
    tolerance, tool_axis, whole, with_unit,
};
pub use program::ProgramArguments;

/// Reads a robot's description, and says what is doubtful in it, with its file's name: a file, or where there is
/// none of that name, a robot of the catalogue. A folder with its measurements may have its name.
pub fn robot(path: &Path) -> Result<(Description, String), Failure> {
    let is_of_catalogue = path.to_str().and_then(catalogue::find).is_some();
    if path.is_dir() && !is_of_catalogue {
        return Err(Failure::new(format_args!("{} is a folder, a robot's description is a file", path.display())));
    }
    if !path.exists() && !is_of_catalogue && path != Path::new("-") {
        return Err(Failure::new(format!(
            "there is no file {}, and no robot of that name in the catalogue: {}",
            path.display(),
            catalogue::names()
        )));
    }
    let read = catalogue::read(Path::new(""), path);
    // A cell is no description, so only what cannot be read is looked at once more.
    if read.is_err() && cell::is_cell(path) {
        return Err(Failure::new(format_args!(
            "{} is a cell, not a robot's description; `path`, `online`, `stability` and `view` take it by `--cell`",
            path.display()
        )));
    }
    let (robot, file) = read?;
    for warning in robot.warnings() {
        output::complain(format_args!("warning: {}: {warning}", file.display()));
    }
    let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
    Ok((robot, name.into_owned()))
}

/// What is said of a robot that has nothing that gives way.
fn rigid(robot: &Description) -> Option<String> {
    let yields = robot.joints.iter().flat_map(|joint| &joint.compliance).any(|part| part.value > 0.0);
    let rigid = !yields && robot.effects.is_empty();
    rigid.then(|| format!("{} is rigid, nothing moves its tool: none of its joints has a `compliance`", robot.name))
}

/// Whether nothing of the robot of a cell gives way, so that the cut that the cell names has no effect; says so then.
pub fn is_left_out(setup: &Setup, cut: &Path) -> bool {
    let said = rigid(&setup.robot);
    if let Some(said) = &said {
        output::complain(format_args!("warning: {said}; {} is left out", cut.display()));
    }
    said.is_some()
}

/// Says so where nothing of a robot gives way.
pub fn complain_if_rigid(robot: &Description) {
    if let Some(said) = rigid(robot) {
        output::complain(format_args!("warning: {said}"));
    }
}

/// Stops there, where all that is asked for is how far something moves the tool; `asked` is what needs it.
pub fn refuse_if_rigid(robot: &Description, asked: &str) -> Result<(), Failure> {
    rigid(robot).map_or(Ok(()), |said| {
        Err(Failure::new(format_args!(
            "{said}; {asked} needs them: identify them from measurements, or write estimates, e.g. \
             `compliance: 3e-7 rad/Nm`, and say under `source:` that they are guessed"
        )))
    })
}

/// Reads a campaign, and says what its reader noticed.
pub fn campaign(path: &Path) -> Result<Campaign, Failure> {
    let campaign = Campaign::read(path)?;
    for warning in &campaign.warnings {
        output::complain(format_args!("warning: {warning}"));
    }
    Ok(campaign)
}

/// Reads a cut, and says what its reader noticed.
pub fn cut(path: &Path) -> Result<CutFile, Failure> {
    let file = CutFile::read(path)?;
    for warning in &file.warnings {
        output::complain(format_args!("warning: {warning}"));
    }
    Ok(file)
}

/// Joint coordinates as `--at` gives them: numbers in rad (or m), or
/// quantities with their unit, separated by commas.
pub fn coordinates(given: &str, robot: &Description) -> Result<Vec<f64>, Failure> {
    coordinates_of("--at", given, robot)
}

/// The same for another option.
pub fn coordinates_of(option: &str, given: &str, robot: &Description) -> Result<Vec<f64>, Failure> {
    let parts: Vec<&str> = given.split(',').collect();
    let count = robot.joints.len();
    if parts.len() != count {
        let are_numbers = |part: &&str| part.split_whitespace().filter(|word| word.parse::<f64>().is_ok()).count() > 1;
        let ask = if parts.iter().any(are_numbers) { "; commas separate them: `0.5, 30 deg, -pi/2`" } else { "" };
        return Err(Failure::Usage(format!(
            "{option} gives {}, {} has {}{ask}",
            text::count(parts.len(), "joint coordinate"),
            robot.name,
            text::count(count, "joint")
        )));
    }
    let coordinate = |(index, part): (usize, &&str)| {
        let dimension = match robot.joints[index].kind {
            JointKind::Revolute => Dimension::Angle,
            JointKind::Prismatic => Dimension::Length,
        };
        quantity::parse(part, dimension).map_err(|error| Failure::Usage(format!("{option}, q{}: {error}", index + 1)))
    };
    // Of what is no number nothing is asked.
    let coordinates: Vec<f64> = parts.iter().enumerate().map(coordinate).collect::<Result<_, _>>()?;
    let bare = parts.iter().map(|part| part.trim().parse::<f64>().ok());
    if let Some(asked) = are_degrees(bare, robot) {
        output::complain(format_args!("warning: {option}: {asked}"));
    }
    Ok(coordinates)
}

// No doc comment: clap would take it for that of the command.
#[derive(clap::Args)]
pub struct At {
    /// The pose: joint coordinates in rad (or m), or with their unit as in "0.5, 30 deg, -pi/2"; where left out all at
    /// zero, but a joint whose limits leave zero out in their middle
    #[arg(long, value_name = "q1,q2,..", allow_hyphen_values = true)]
    at: Option<String>,
}

impl At {
    /// Whether the pose is given.
    pub fn is_given(&self) -> bool {
        self.at.is_some()
    }

    /// The pose that `--at` gives, or where it does not the [`default_coordinates`]; says which
    /// coordinates the joints' limits leave out.
    pub fn pose(&self, robot: &Description) -> Result<Vec<f64>, Failure> {
        let q = match &self.at {
            Some(text) => coordinates(text, robot)?,
            None => default_coordinates(robot),
        };
        for note in outside_limits(&q, robot) {
            output::complain(format_args!("note: {note}"));
        }
        Ok(q)
    }
}

/// Asks, of numbers given to joints without a unit, whether they are in degrees, if one turns
/// a joint by more than a turn.
pub fn are_degrees(bare: impl Iterator<Item = Option<f64>>, robot: &Description) -> Option<String> {
    let beyond = |((number, joint), value): ((usize, &Joint), Option<f64>)| {
        let value = value.filter(|value| joint.kind == JointKind::Revolute && value.abs() > TAU)?;
        Some((number, value))
    };
    let (number, value) = (1..).zip(&robot.joints).zip(bare).find_map(beyond)?;
    Some(format!(
        "q{number} = {value} rad is more than a turn: are the angles in degrees? write `{value} deg`, and so all others"
    ))
}

/// Sentences on coordinates that the joints' limits leave out.
fn outside_limits(q: &[f64], robot: &Description) -> Vec<String> {
    let outside = |(number, (&q, joint)): (usize, (&f64, &Joint))| {
        let what = joint.outside_limits().filter(|_| !joint.reaches(q))?;
        Some(format!("q{number} = {} {} is {what}", joint.for_people(q), joint.people_unit()))
    };
    (1..).zip(q.iter().zip(&robot.joints)).filter_map(outside).collect()
}

/// The pose that is shown where none is asked for: zero, and for a joint that
/// cannot stand there the middle of its range.
fn default_coordinates(robot: &Description) -> Vec<f64> {
    let coordinate = |limits: Option<[f64; 2]>| match limits {
        Some([low, high]) if !(low..=high).contains(&0.0) => 0.5 * (low + high),
        _ => 0.0,
    };
    robot.joints.iter().map(|joint| coordinate(joint.limits)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn five_axes() -> Description {
        robot(Path::new("rv130hsc")).unwrap().0
    }

    #[test]
    fn coordinates_are_in_rad_or_carry_their_unit() {
        let q = coordinates("0.5, 30 deg, -pi/2,0, 10 mrad", &five_axes()).unwrap();
        assert_eq!(q, [0.5, 30_f64.to_radians(), -core::f64::consts::FRAC_PI_2, 0.0, 0.01]);
    }

    #[test]
    fn wrong_coordinates_are_wrong_usage() {
        for (text, part) in [
            ("0,0,0", "gives 3 joint coordinates, Rv130hsc has 5"),
            ("10 deg 20 deg", "has 5 joints; commas separate them: `0.5, 30 deg, -pi/2`"),
            ("0,0,x,0,0", "q3: `x` is not an angle"),
            ("0,0,0,0,5 mm", "q5"),
        ] {
            let failure = coordinates(text, &five_axes()).unwrap_err();
            assert!(matches!(&failure, Failure::Usage(message) if message.contains(part)), "{failure}");
        }
    }

    #[test]
    fn numbers_of_more_than_a_turn_are_asked_about() {
        let asked = |bare: [Option<f64>; 5]| are_degrees(bare.into_iter(), &five_axes());
        assert_eq!(asked([Some(0.0), Some(-3.1), None, Some(6.2), None]), None);
        let said = asked([Some(0.0), Some(-90.0), None, None, Some(45.0)]).unwrap();
        assert!(said.starts_with("q2 = -90 rad is more than a turn: are the angles in degrees?"), "{said}");
    }

    #[test]
    fn coordinates_outside_limits_are_noted() {
        let mut robot = five_axes();
        robot.joints.iter_mut().for_each(|joint| joint.limits = None);
        robot.joints[1].limits = Some([-90_f64.to_radians(), 90_f64.to_radians()]);
        let noted = |q2: &str| outside_limits(&coordinates(&format!("90,{q2},0,0,0"), &robot).unwrap(), &robot);
        assert_eq!(noted("100 deg"), ["q2 = 100 deg is outside its limits [-90, 90] deg"]);
        assert_eq!(noted("-90 deg"), Vec::<String>::new());
    }

    #[test]
    fn a_tolerance_may_be_a_grade() {
        for (text, most) in [("0.1 mm", 1e-4), ("IT9 of 50 mm", 31e-6), (" it14 of 3.15 m", 2700e-6)] {
            assert!((tolerance(text).unwrap() / most - 1.0).abs() < 1e-12, "{text}");
        }
        for (text, part) in [
            ("IT9", "`IT9 of 50 mm`"),
            ("ITx of 50 mm", "`IT9 of 50 mm`"),
            ("IT3 of 50 mm", "IT6 to IT14"),
            ("IT9 of 50", "no unit"),
            ("IT9 of 4 m", "3150 mm"),
            ("-1 mm", "above zero"),
        ] {
            let said = tolerance(text).unwrap_err();
            assert!(said.contains(part), "{text}: {said}");
        }
    }

    #[test]
    fn a_joint_that_cannot_stand_at_zero_stands_in_the_middle() {
        let mut robot = five_axes();
        robot.joints[1].limits = Some([0.25, 0.75]);
        robot.joints[2].limits = Some([-1.0, 2.0]);
        assert_eq!(default_coordinates(&robot), [0.0, 0.5, 0.0, 0.0, 0.0]);
    }
}
