//! `robstiff export`: a URDF file with the kinematics of a description.

use std::path::PathBuf;

use robstiff_robots::Description;
use robstiff_robots::text::MOST_OF_URDF;
use robstiff_robots::urdf::{Export, Moved, Tree, is_said_by_origins};
use serde_json::{Value, json};

use crate::agreement::{POSES, heading, largest_difference};
use crate::failure::Failure;
use crate::output::{self, Files};
use crate::text::{Table, count, decimals};
use crate::{input, json, text};

/// Writes a URDF file with the kinematics of a description: a template whose joints get new origins
///
/// Links, meshes and all else stay as they are. The file is compared with the
/// description at a thousand poses, and written only if both agree.
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue
    #[arg(value_name = "ROBOT.yaml")]
    robot: PathBuf,
    /// The URDF file of the arm, whose joints count as those of the description
    #[arg(long, value_name = "TEMPLATE.urdf")]
    urdf: PathBuf,
    /// The link whose frame is the description's base frame; the root where left out
    #[arg(long, value_name = "LINK")]
    base: Option<String>,
    /// The link whose frame is that of the description's tool; where left out, the end of the tree, if there is one only
    #[arg(long, value_name = "LINK")]
    tip: Option<String>,
    /// Where the URDF file is written
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Write what was done as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// How far apart the entries of the tool's frame may be (m, or of the rotation). The reader takes
/// angles within 1e-9 rad of a multiple of 90 degrees for that, and an arm is some metres long.
const AGREES: f64 = 1e-8;

/// Exports a robot.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (robot, _) = input::robot(&arguments.robot)?;
    let template = robstiff_robots::text::read(&arguments.urdf, MOST_OF_URDF)?;
    let tree = Tree::parse(&arguments.urdf.display().to_string(), &template)?;
    let (base, tip) = (arguments.base.as_deref(), arguments.tip.as_deref());
    let exported = tree.export(base, tip, &robot)?;
    // What rounded angles are taken for concerns those that stay: those of the chain are exact now.
    let name = arguments.out.display().to_string();
    let written = Tree::parse(&name, &exported.text)?;
    let chain = written.chain(base, tip)?;
    for warning in exported.warnings.iter().chain(&chain.warnings) {
        output::complain(format_args!("warning: {warning}"));
    }
    let mut said = robot.clone();
    said.effects.retain(is_said_by_origins);
    let apart = with_arm!(&said, |robot| largest_difference(&robot, &chain));
    if apart.is_nan() || apart > AGREES {
        return Err(Failure::new(format!(
            "the file would be off the description by up to {} m or rad, and is not written",
            text::significant(apart, 2)
        )));
    }
    let mut files = Files::default();
    files.protect(&arguments.robot);
    files.protect(&arguments.urdf);
    if let Some(path) = &arguments.json {
        files.add(path, json::document(&document(&robot, &exported, apart)));
    }
    let page = page(&robot, &exported, apart);
    files.add(&arguments.out, exported.text);
    let said = files.write()?;
    output::print(page + &said)
}

fn page(robot: &Description, exported: &Export, apart: f64) -> String {
    let mut page = heading(robot, &exported.chain, "the file agrees with the description", apart);
    let mut table = Table::new(2, ["", "", "shifted [mm]", "turned [deg]", "limits"]);
    let row = |label: String, moved: &Moved, limits: &str| {
        let numbers = [decimals(moved.shift * 1e3, 3), decimals(moved.turn.to_degrees(), 4)];
        [vec![label, moved.name.clone()], numbers.to_vec(), vec![limits.to_owned()]].concat()
    };
    for (number, moved) in (1..).zip(&exported.joints) {
        table.row(row(format!("joint {number}"), moved, if moved.limits.is_some() { "changed" } else { "" }));
    }
    if let Some(moved) = &exported.tip {
        table.row(row("tool".to_owned(), moved, ""));
    }
    page += &table.to_string();
    page += "\nEach origin in the frame of its parent, against the template.\n";
    if exported.exact > 0 {
        page += &format!("{} such as 1.5708 with all digits now.\n", count(exported.exact, "angle"));
    }
    page
}

fn document(robot: &Description, exported: &Export, apart: f64) -> Value {
    let moved = |moved: &Moved| {
        json!({
            "name": moved.name,
            "shift_m": json::number(moved.shift),
            "turn_rad": json::number(moved.turn),
            "limits": moved.limits.map(json::numbers),
        })
    };
    json!({
        "robot": robot.name,
        "base": exported.chain.base,
        "tip": exported.chain.tip,
        "joints": exported.joints.iter().map(moved).collect::<Value>(),
        "tool": exported.tip.as_ref().map(moved),
        "exact_angles": exported.exact,
        "poses": POSES,
        "largest_difference": json::number(apart),
    })
}
