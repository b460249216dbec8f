//! Map files: what is computed, and where.

use robstiff::Generic;
use robstiff_machining::map::read::{Over, Task};
use robstiff_machining::map::{JointSpace, stream};
use robstiff_robots::Description;

use super::accepted::{assert_same, with_line_breaks_of_windows};
use super::grammar::Grammar;
use super::refused::assert_places;

pub const GRAMMAR: &Grammar = &[
    (
        "file",
        &[
            "joints: [0, 0]\n",
            "%measure%joints:\n  - %axis%\n  - %axis%\n",
            "%measure%positions:\n  x: %line%\n  y: %line%\n  z: %line%\ntool: {%tool%}\n",
            "%measure%positions: {frame: {xyz: [%length%, 0, %length%], rpy: [0, %angle%, 0]}, x: %line%, y: 0, z: 1 m}\ntool: {%tool%}\n",
            "joints: [%axis%]\npositions: {x: 1}\n%measure%",
        ],
    ),
    (
        "measure",
        &[
            "",
            "measure: stiffness\n",
            "measure: compliance\n",
            "force: [%force%, %force%, %force%]\n",
            "force: %force%\n",
            "measure: deviation\nforce: [0, 400 N, -200 N]\nmoment: [0, 1 Nm, %small%]\n",
            "measure: %odd%\n",
        ],
    ),
    (
        "axis",
        &["0 deg", "{from: -60 deg, to: 60 deg, count: %count%}", "{from: %angle%, to: %angle%, count: 3}", "%angle%"],
    ),
    (
        "line",
        &["1 m", "{from: 100 mm, to: 900 mm, count: %count%}", "{from: %length%, to: 2 m, count: 1000000}", "%length%"],
    ),
    (
        "tool",
        &[
            "direction: [0, 0, -1]",
            "axis: %side%, direction: [%small%, %small%, %small%], turn: %axis%",
            "direction: [0, 0, -1], turn: {from: 0, to: 90 deg, count: 1000}",
            "axis: %odd%",
        ],
    ),
    ("side", &["x", "-y", "z", "w"]),
];

const ROBOT: &str = "name: Two\nconvention: standard\njoints:\n  - {a: 1 m, compliance: 1e-6 rad/Nm}\n  \
                     - {a: 500 mm, alpha: 90 deg, limits: [-170 deg, 170 deg], compliance: 2e-6 rad/Nm}\n";

/// Cells of maps that are computed.
const MOST_CELLS: usize = 64;

pub fn check(data: &[u8]) -> Result<(), String> {
    let text = std::str::from_utf8(data).map_err(|error| error.to_string())?;
    let description = Description::parse("robot.yaml", ROBOT).expect("a robot");
    let read = Task::parse("map.yaml", text, &description);
    if let Some(broken) = with_line_breaks_of_windows(text) {
        let again = Task::parse("map.yaml", &broken, &description);
        assert_same("with other line breaks", &read.as_ref().ok(), &again.as_ref().ok());
    }
    let task = read.map_err(|problems| assert_places(&problems, &[("map.yaml", text)]))?;
    let cells = task.over.axes().iter().fold(1_usize, |cells, axis| cells.saturating_mul(axis.values.len()));
    if let (Over::Joints(axes), true) = (&task.over, cells <= MOST_CELLS)
        && let Ok(axes) = <&[_; 2]>::try_from(&axes[..])
    {
        let robot = Generic::<2>::new(&description).expect("as many joints");
        let mut tables = Vec::new();
        let space = JointSpace::new(axes, &mut tables);
        let mut computed = 0;
        let summary = stream(
            &robot,
            &space,
            &task.measure,
            |chunk| chunk.cells.len(),
            |cells| {
                computed += cells;
                Ok::<(), ()>(())
            },
        );
        assert!(summary.is_ok() && computed == cells, "{computed} of {cells} cells");
    }
    Ok(())
}
