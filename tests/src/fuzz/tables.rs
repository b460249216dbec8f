//! Tables: of forces along a path, of joint coordinates, of recorded forces.

use std::fs;

use robstiff_identify::campaign::JointTable;
use robstiff_machining::deviation::ForceTable;
use robstiff_machining::milling::{ForceFrame, MeasuredForce};
use robstiff_machining::stability::Modes;
use robstiff_machining::stability::responses::{FittedModes, Motion, Responses};
use robstiff_robots::Description;

use super::accepted::{assert_same, with_line_breaks_of_windows};
use super::grammar::Grammar;
use super::refused::{assert_places, assert_told};
use crate::folder::Folder;

pub const GRAMMAR: &Grammar = &[
    (
        "file",
        &[
            "Fx,Fy,Fz\n1,2,3\n",
            "s [mm],Fx [N],Fy [N],Fz [N]\n0,%cell%,%cell%,%cell%\n10,%cell%,1,2\n%four%",
            "Fx [kN],Fy [N],Fz [N],Mx [Nm],My [Nm],Mz [Nm]\n%six%",
            "t [ms],Fx [N],Fy [N],Fz [N]\n0,1,2,3\n0.5,%cell%,%cell%,%cell%\n1,2,3,4\n%four%",
            "angle [deg],Fx,Fy,Fz\n0,1,2,3\n30,%cell%,2,3\n60,2,3,4\n%four%",
            "q1 [deg],q2 [deg],stiffness [N/um]\n%three%",
            "frequency [Hz],zx_mag [um/N],zx_phase [deg],xx_re,xx_im,yx_re,yx_im\n%lines%",
            "q1,q2,Fx,Fy,Fz\n0,1,%cell%,%cell%,%cell%\n%three%",
            "%name%,%name%,%name%\n%three%",
            "%name%%separator%%name%%separator%%name%\n1%separator%2%separator%3\n",
            "# %cell%\n\n%name%,Fx,Fy,Fz\n%four%",
        ],
    ),
    ("three", &["1,2,3\n", "%cell%,%cell%,%cell%\n", "%cell%,%cell%,%cell%\n%three%"]),
    ("four", &["", "%cell%,%cell%,%cell%,%cell%\n", "%cell%,%cell%,%cell%,%cell%\n%four%"]),
    (
        "lines",
        &[
            "1,0,0,1,-0.1,1,-0.1\n2,0,0,1,-0.1,1,-0.1\n3,1,-90,4,-4,4,-3\n4,1,-90,-4,-4,-4,-3\n5,1,-90,-1,-0.2,-1,-0.2\n\
             6,0,0,-0.5,-0.1,-0.5,-0.1\n7,0,0,-0.3,-0.1,-0.3,0\n8,0,0,-0.2,0,-0.2,0\n%line%",
            "%cell%,1,90,0,-1,0.5,-1\n%lines%",
        ],
    ),
    ("line", &["", "9,%cell%,%cell%,%cell%,%cell%,%cell%,%cell%\n"]),
    ("six", &["1,2,3,4,5,6\n", "%cell%,%cell%,%cell%,%cell%,%cell%,%cell%\n%six%"]),
    ("cell", &["0", "1", "-2.5", "1e3", "\" 4 \"", "", "\"", "\"\"\"\"", "%small%", "%odd%"]),
    (
        "name",
        &[
            "Fx",
            "Fy [N]",
            "s [mm]",
            "q1",
            "q2 [deg]",
            "t",
            "Mx",
            "time [min]",
            "\"Fz [kN]\"",
            "Fx [",
            "Fx []",
            "",
            "%odd%",
        ],
    ),
    ("separator", &[",", ";", "\t", " ", "|", ", "]),
];

const ROBOT: &str = "name: Two\nconvention: standard\njoints: [{a: 1 m}, {a: 500 mm}]\n";

pub fn check(data: &[u8]) -> Result<(), String> {
    let text = std::str::from_utf8(data).map_err(|error| error.to_string())?;
    let forces = ForceTable::parse("table.csv", text);
    let measured = [false, true].map(|turned| MeasuredForce::parse("table.csv", text, ForceFrame::Cut, turned));
    let responses = [Motion::Receptance, Motion::Mobility, Motion::Accelerance]
        .map(|motion| Responses::parse("table.csv", text, motion, [0.0, f64::MAX]));
    for (responses, _) in responses.iter().flatten() {
        for asked in [None, Some(1)] {
            if let Ok(FittedModes { modes, massless, .. }) = responses.fit(asked) {
                let modes = Modes::measured(&modes).and_then(|modes| modes.with_massless(&massless));
                assert!(modes.is_some(), "modes that cannot be computed with");
            }
        }
    }
    let refused =
        [forces.as_ref().err(), measured[0].as_ref().err(), responses[0].as_ref().err()].into_iter().flatten();
    let refused: Vec<String> = refused.map(|problems| assert_places(problems, &[("table.csv", text)])).collect();
    assert_eq!(measured[0].is_ok(), measured[1].is_ok());
    if let Some(broken) = with_line_breaks_of_windows(text) {
        let again = ForceTable::parse("table.csv", &broken);
        assert_same("with other line breaks", &forces.as_ref().ok(), &again.as_ref().ok());
    }
    if let Ok((force, _)) = &measured[0] {
        for speed in [None, Some(900.0)] {
            let (mean, revolution) = (force.mean(speed), force.revolution(64, speed));
            std::hint::black_box((mean, revolution, force.has_angles(speed), force.resolves_revolution(speed)));
        }
    }
    let folder = Folder::new();
    let path = folder.0.join("table.csv");
    fs::write(&path, text).expect("a temporary file");
    let robot = Description::parse("robot.yaml", ROBOT).expect("a robot");
    let joints = [None, Some("stiffness")].map(|column| JointTable::read(&path, &robot, column));
    for error in joints.iter().filter_map(|read| read.as_ref().err()) {
        assert_told(error, &[(&path.display().to_string(), text)]);
    }
    if forces.is_ok() || measured[0].is_ok() || joints[0].is_ok() || responses[0].is_ok() {
        Ok(())
    } else {
        Err(refused.concat())
    }
}
