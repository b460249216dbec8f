//! `robstiff import`: a description from a URDF file.

use std::path::PathBuf;

use robstiff_robots::Description;
use robstiff_robots::urdf::{Chain, Tree};
use serde_json::{Value, json};

use crate::agreement::{POSES, heading, largest_difference};
use crate::failure::Failure;
use crate::output::{self, Files};
use crate::text::{Table, decimals};
use crate::{json, text};

/// Writes the description of a serial chain of a URDF file: standard DH table, base, tool, limits, masses
///
/// The description is compared with the file at a thousand poses, and written
/// only if both agree.
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot (for a xacro file: `xacro FILE.xacro > FILE.urdf`)
    #[arg(value_name = "FILE.urdf")]
    urdf: PathBuf,
    /// The link whose frame is the base frame; the root where left out
    #[arg(long, value_name = "LINK")]
    base: Option<String>,
    /// The link whose frame is that of the tool; where left out, the end of the tree, if there is one only
    #[arg(long, value_name = "LINK")]
    tip: Option<String>,
    /// Where the description is written
    #[arg(long, value_name = "ROBOT.yaml")]
    out: PathBuf,
    /// Replace a description that is there already and differs
    #[arg(long)]
    force: bool,
    /// Write what was done as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Longer than the links of any arm (m).
const LONGEST: f64 = 20.0;

/// How far apart they may be (m, and as entries of the rotation).
const AGREES: f64 = 1e-9;

/// Imports a robot.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let tree = Tree::read(&arguments.urdf)?;
    let chain = tree.chain(arguments.base.as_deref(), arguments.tip.as_deref())?;
    for warning in tree.warnings.iter().chain(&chain.warnings) {
        output::complain(format_args!("warning: {warning}"));
    }
    let file = arguments.urdf.file_name().unwrap_or_default().to_string_lossy();
    let mut robot = chain.description();
    robot.source = format!(
        "The chain from {} to {} of {file}, by robstiff import: geometry, limits{} are the file's. \
         A URDF file says nothing of compliances: the joints are rigid until they are given.",
        chain.base,
        chain.tip,
        if robot.links.is_empty() { "" } else { " and masses" },
    );
    complain_of_length(&robot);
    // As it will be read, with every number as it is written.
    let yaml = robot.to_yaml();
    let robot = Description::parse(&arguments.out.display().to_string(), &yaml)?;
    let apart = with_arm!(&robot, |robot| largest_difference(&robot, &chain));
    if apart.is_nan() || apart > AGREES {
        return Err(Failure::new(format!(
            "the description would be off the file by up to {} m or rad, and is not written; \
             are there axes that are almost parallel, by angles that were rounded?",
            text::significant(apart, 2)
        )));
    }
    // Compliances may have been typed into it since.
    let differs =
        || robstiff_robots::text::bytes(&arguments.out, yaml.len()).map_or(true, |there| there != yaml.as_bytes());
    if arguments.out.is_file() && !arguments.force && differs() {
        return Err(Failure::there_already(&arguments.out, "file"));
    }
    let mut files = Files::default();
    files.protect(&arguments.urdf);
    files.add(&arguments.out, yaml);
    if let Some(path) = &arguments.json {
        files.add(path, json::document(&document(&robot, &chain, apart)));
    }
    let said = files.write()?;
    output::print(page(&robot, &chain, apart) + &said)
}

/// Says so of axes that are almost parallel: their common normal is far away, and the joint's
/// frame with it.
fn complain_of_length(robot: &Description) {
    for (number, joint) in (1..).zip(&robot.joints) {
        if joint.d.abs().max(joint.a.abs()) > LONGEST {
            output::complain(format_args!(
                "warning: joint {number} has d = {} m and a = {} m: its axis and a neighbour's are almost parallel, so \
                 its frame is far from the arm, where a tilt of its bearing or a link that bends would be wrong; \
                 if they are parallel but for a calibration, round the angles in the file",
                text::significant(joint.d, 4),
                text::significant(joint.a, 4)
            ));
        }
    }
}

fn page(robot: &Description, chain: &Chain, apart: f64) -> String {
    let mut page = heading(robot, chain, "agrees with the file", apart);
    let mut table = Table::new(2, ["", "", "theta [deg]", "d [mm]", "a [mm]", "alpha [deg]", "limits", ""]);
    for (number, (joint, row)) in (1..).zip(chain.joints.iter().zip(&robot.joints)) {
        let limits = row.limits.map(|limits| limits.map(|limit| decimals(row.for_people(limit), 1)));
        table.row([
            format!("joint {number}"),
            joint.name.clone(),
            decimals(row.theta.to_degrees(), 3),
            decimals(row.d * 1e3, 3),
            decimals(row.a * 1e3, 3),
            decimals(row.alpha.to_degrees(), 3),
            limits.map_or("none".to_owned(), |[low, high]| format!("[{low}, {high}]")),
            row.people_unit().to_owned(),
        ]);
    }
    page += &table.to_string();
    page += "\nEvery joint is rigid until you give it a `compliance`.\n";
    page
}

fn document(robot: &Description, chain: &Chain, apart: f64) -> Value {
    json!({
        "robot": robot.name,
        "base": chain.base,
        "tip": chain.tip,
        "joints": chain.joints.iter().map(|joint| joint.name.as_str()).collect::<Value>(),
        "poses": POSES,
        "largest_difference": json::number(apart),
    })
}
