//! Cuts: milling files, with recorded forces.

use std::fs;

use robstiff_machining::milling::{CutFile, Forces};

use super::accepted::{assert_same, with_line_breaks_of_windows};
use super::grammar::Grammar;
use super::refused::assert_told;
use super::sections::sections;
use crate::folder::Folder;

pub const GRAMMAR: &Grammar = &[
    (
        "file",
        &[
            "tool: {diameter: 20 mm, teeth: 4}\nmaterial: al7075-t6\nmilling: slot\ndepth: 2 mm\nfeed: 0.1 mm/tooth\n",
            "name: roughing\n%tool%%material%%milling%depth: %length%\n%feed%speed: 9000 rpm\n",
            "%tool%%material%%milling%depth: 2 mm\n%feed%",
            "name: recorded\nmeasured: {file: forces.csv, frame: %frame%, on: %on%}\nspeed: %speed%\n=> forces.csv\n%forces%",
            "%tool%measured: {file: %file_name%, frame: cut, on: tool}\n=> forces.csv\n%forces%",
        ],
    ),
    (
        "tool",
        &[
            "tool: {diameter: 20 mm, teeth: 4, helix: 30 deg}\n",
            "tool: {diameter: %length%, teeth: %count%, helix: %angle%, runout: [%length%, 0 um]}\n",
            "tool: {diameter: 16 mm, teeth: 2, runout: [%length%, 12 um]}\n",
            "tool: {diameter: 16, teeth: %odd%}\n",
        ],
    ),
    (
        "material",
        &[
            "material: al7075-t6\n",
            "coefficients: {tangential: {cutting: 800 N/mm2, edge: 25 N/mm}, radial: {cutting: %small%}, axial: {edge: 1 N/mm}}\n",
            "coefficients: {tangential: %coefficient%, radial: %coefficient%, axial: %coefficient%}\n",
            "material: %odd%\n",
        ],
    ),
    ("coefficient", &["{cutting: 800 N/mm2, edge: 25 N/mm}", "{cutting: %small% N/mm2, edge: %small%}", "{}", "%odd%"]),
    (
        "milling",
        &[
            "milling: slot\n",
            "milling: down\nwidth: %length%\n",
            "milling: up\nwidth: 8 mm\n",
            "engagement: [%angle%, 180 deg]\n",
            "engagement: [30 deg, %angle%]\n",
            "milling: %odd%\n",
        ],
    ),
    (
        "feed",
        &[
            "feed: 0.1 mm/tooth\n",
            "feed_speed: %small% m/min\n",
            "feed: %length%\n",
            "feed_speed: 3600 mm/min\nfeed: 1\n",
        ],
    ),
    ("speed", &["9000 rpm", "900", "%small% rpm", "%odd%"]),
    ("frame", &["cut", "base", "tool", "%odd%"]),
    ("on", &["tool", "workpiece", "%odd%"]),
    ("file_name", &["forces.csv", ".", "nowhere.csv", "%odd%"]),
    (
        "forces",
        &[
            "t [ms],Fx,Fy,Fz\n0,1,2,3\n1,2,3,4\n2,3,4,5\n",
            "angle [deg],Fx [N],Fy [N],Fz [N]\n0,1,2,3\n60,%newtons%,2,3\n120,%newtons%,2,3\n180,%newtons%,2,3\n240,0,0,1\n300,1,1,1\n",
            "Fx,Fy,Fz\n%newtons%,%newtons%,%newtons%\n",
            "t [ms],Fx,Fy,Fz\n%newtons%,1,2,3\n%newtons%,%newtons%,2,3\n",
        ],
    ),
    ("newtons", &["100", "-200", "0", "%small%", "%odd%"]),
];

pub fn check(data: &[u8]) -> Result<(), String> {
    let text = std::str::from_utf8(data).map_err(|error| error.to_string())?;
    let (cut, files) = sections(text);
    let folder = Folder::new();
    let path = folder.0.join("forces.csv");
    let recorded = files.iter().find(|(file, _)| *file == "forces.csv").map_or("", |(_, text)| *text);
    fs::write(&path, recorded).expect("a temporary file");
    let read = CutFile::parse("cut.yaml", cut, &folder.0);
    if let Some(broken) = with_line_breaks_of_windows(cut) {
        let again = CutFile::parse("cut.yaml", &broken, &folder.0);
        assert_same("with other line breaks", &read.as_ref().ok(), &again.as_ref().ok());
    }
    match read {
        Ok(cut) => {
            computed(&cut.forces);
            Ok(())
        }
        Err(error) => Err(assert_told(&error, &[("cut.yaml", cut), (&path.display().to_string(), recorded)])),
    }
}

fn computed(forces: &Forces) {
    let mean = forces.mean();
    let revolution = match forces {
        Forces::Model(cut) => Some(cut.revolution(36)),
        Forces::Measured { force, speed } => force.revolution(36, *speed),
    };
    assert!(revolution.iter().all(|revolution| !revolution.samples.is_empty()));
    std::hint::black_box((mean, revolution));
}
