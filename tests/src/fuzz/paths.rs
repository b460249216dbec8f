//! Tool paths.

use nalgebra::Vector3;
use robstiff_machining::path::ToolPath;
use robstiff_robots::Description;

use super::accepted::{assert_same, with_line_breaks_of_windows};
use super::grammar::Grammar;
use super::refused::assert_places;

pub const GRAMMAR: &Grammar = &[
    (
        "file",
        &[
            "q1,q2,q3\n0,1,2\n",
            "x [mm],y [mm],z [mm],ux,uy,uz,feed [mm/min]\n%axes%",
            "x,y,z,qw,qx,qy,qz\n%quaternions%",
            "x [mm],y [mm],z [mm],rx [deg],ry [deg],rz [deg],s [mm]\n%turns%",
            "x [mm],y [mm],z [mm],a [deg],b [deg],c [deg]\n%angles%",
            "q1 [deg],q2 [deg],q3 [deg],x,y,z,s [mm]\n%joints%",
            "%name%,%name%,%name%,%name%,%name%,%name%\n%angles%",
        ],
    ),
    (
        "axes",
        &[
            "1500,0,600,0,0,-1,3600\n",
            "%mm%,%mm%,%mm%,%small%,%small%,%small%,%mm%\n%axes%",
            "1500,20,600,0,0,-1,60\n%axes%",
        ],
    ),
    (
        "quaternions",
        &[
            "1,0,0.5,1,0,0,0\n",
            "%mm%,0,1,%small%,%small%,%small%,%small%\n%quaternions%",
            "1,0,1,0.6,0,0.8,0\n%quaternions%",
        ],
    ),
    (
        "turns",
        &["1500,0,600,0,180,0,0\n", "%mm%,0,600,%mm%,%small%,0,%mm%\n%turns%", "1500,10,600,0,180,0,10\n%turns%"],
    ),
    ("angles", &["1500,0,600,0,180,0\n", "%mm%,%mm%,%mm%,%mm%,%mm%,%mm%\n%angles%", "1500,10,600,0,180,0\n%angles%"]),
    ("joints", &["0,10,20,1,2,3,0\n", "%mm%,%mm%,%mm%,1,2,3,%mm%\n%joints%", "0,11,20,1,2,3,1\n%joints%"]),
    ("mm", &["1500", "0", "-20.5", "1e3", "", "%small%", "%odd%"]),
    (
        "name",
        &[
            "x", "y [mm]", "z", "ux", "uy", "uz", "qw", "qx", "rx [deg]", "a", "feed", "s [m]", "q1", "q2 [deg]",
            "%odd%",
        ],
    ),
];

const ROBOT: &str =
    "name: Three\nconvention: standard\njoints:\n  - {d: 500 mm, alpha: -90 deg}\n  - {a: 1 m}\n  - {a: 1 m}\n";

pub fn check(data: &[u8]) -> Result<(), String> {
    let text = std::str::from_utf8(data).map_err(|error| error.to_string())?;
    let robot = Description::parse("robot.yaml", ROBOT).expect("a robot");
    let parse = |text: &str| ToolPath::parse("path.csv", text, &robot, Vector3::z_axis());
    let read = parse(text);
    if let Some(broken) = with_line_breaks_of_windows(text) {
        let points = [&read, &parse(&broken)].map(|read| read.as_ref().ok().map(|path| path.points.clone()));
        assert_same("with other line breaks", &points[0], &points[1]);
    }
    match read {
        Ok(path) => {
            assert!(!path.points.is_empty() && path.points.iter().all(|point| point.line > 1), "{path:?}");
            let _ = path.gives_joints();
            Ok(())
        }
        Err(problems) => Err(assert_places(&problems, &[("path.csv", text)])),
    }
}
