//! Descriptions of robots.

use nalgebra::SVector;
use robstiff::elements::contributions;
use robstiff::{Generic, Robot, State};
use robstiff_codegen::{Origin, source};
use robstiff_robots::Description;

use super::accepted::{assert_same, with_line_breaks_of_windows};
use super::grammar::Grammar;
use super::refused::assert_places;

pub const GRAMMAR: &Grammar = &[
    (
        "file",
        &[
            "name: Arm\nconvention: standard\njoints:\n%rows%",
            "name: %name%\n%texts%convention: %convention%\n%base%joints:\n%rows%%tool%%links%%effects%",
            "%texts%%effects%name: Arm\njoints:\n%rows%%links%convention: %convention%\n",
            "{name: Arm, convention: modified, joints: [%row%, %row%]}",
        ],
    ),
    ("name", &["Arm", "Kr2", "\"Arm\"", "arm", "Robot", "\u{c4}rm", "%odd%"]),
    ("convention", &["standard", "modified", "standard", "modified", "Standard"]),
    (
        "texts",
        &[
            "",
            "description: an arm\n",
            "source: >\n  made up,\n  for fuzzing\n",
            "description: |\n  lines\n\n  kept\nsource: \"a \\u00e9: \\t # quoted\"\n",
            "# a remark\nsource: 'it''s'\n",
            "description: %odd%\n",
        ],
    ),
    ("base", &["", "base: {xyz: [%length%, %length%, %length%]}\n", "base:\n  rpy: [%angle%, %angle%, %angle%]\n"]),
    ("tool", &["", "tool: {xyz: [0, 0, %length%], rpy: [%angle%, 0, %angle%]}\n", "tool: {}\n"]),
    (
        "rows",
        &["  - %row%\n", "  - %row%\n%rows%", "  - %row%\n  - %row%\n  - %row%\n", "  - %row%\n  - %row%\n%rows%"],
    ),
    (
        "row",
        &[
            "{a: 1 m, compliance: 1e-6 rad/Nm}",
            "{theta: %angle%, d: %length%, a: %length%, alpha: %angle%, compliance: %compliance%}",
            "{type: prismatic, d: %length%, alpha: %angle%, compliance: %linear%}",
            "{theta: %angle%, a: %length%, limits: [%angle%, %angle%], compliance: {gear: %compliance%, belt: %compliance%}}",
            "{theta: -90 deg, a: 500 mm}",
            "{d: %length%, limits: [-180 deg, 180 deg], compliance: %compliance%}",
        ],
    ),
    (
        "compliance",
        &[
            "1e-6 rad/Nm",
            "0",
            "3 Nm/arcmin",
            "4e6 Nm/rad",
            "2e-7",
            "300 kNm/rad",
            "-1e-7 rad/Nm",
            "%small% rad/Nm",
            "%odd%",
        ],
    ),
    ("linear", &["1e-8 m/N", "60 N/um", "0", "1e7 N/m", "1e-9", "1e-6 rad/Nm", "%odd%"]),
    (
        "links",
        &["", "links: [%link%]\n", "links:\n  - %link%\n  - %link%\n", "links:\n  - %link%\n  - %link%\n  - %link%\n"],
    ),
    ("link", &["{mass: 10 kg}", "{mass: 350 kg, center_of_mass: [%length%, 0, %length%]}", "{}", "{mass: %odd%}"]),
    ("effects", &["", "effects:\n%more%", "effects: []\n"]),
    ("more", &["  - {%effect%}\n", "  - {%effect%}\n%more%", "  - {%effect%}\n  - {%effect%}\n"]),
    (
        "effect",
        &[
            "kind: transverse_compliance, at: joint 1, value: 6e-7 rad/Nm",
            "kind: transverse_compliance, at: joint %digit%, value: %compliance%",
            "kind: link_compliance, at: link %digit%, bending: %compliance%, torsion: %compliance%",
            "kind: link_compliance, at: link 1, bending: 1e-7 rad/Nm",
            "kind: base_compliance, at: base, tilt: %compliance%, translation: %linear%",
            "kind: tool_compliance, at: tool, rotation: %compliance%, translation: %linear%",
            "kind: joint_coupling, at: \"joints 1,2\", value: %compliance%",
            "kind: joint_coupling, at: \"joints %digit%,%digit%\", value: 1e-8 rad/Nm",
            "kind: stiffness_nonlinearity, at: joint %digit%, added: %compliance%, knee: %torque%",
            "kind: lost_motion, at: joint %digit%, gap: %angle%, knee: %torque%",
            "kind: hysteresis, at: joint 1, radius1: 50 Nm, weight1: %compliance%, radius2: %torque%, weight2: 1e-8 rad/Nm",
            "kind: hysteresis, at: joint %digit%, radius1: %torque%, weight1: %compliance%",
            "kind: pose_dependent_compliance, at: joint %digit%, cos1: %small%, sin2: %small%",
            "kind: joint_zero_offset, at: joint %digit%, value: %angle%",
            "kind: dh_error, at: a%digit%, value: %length%",
            "kind: dh_error, at: alpha%digit%, value: %angle%",
            "kind: transmission_error, at: joint %digit%, order: %count%, sin: %angle%, cos: %angle%",
            "kind: gravity_sag, at: robot",
            "kind: gravity_sag, at: robot, share: %small%",
            "kind: gravity_preload, at: robot",
            "kind: thermal_drift, at: rig, value: 1",
            "kind: %odd%, at: %odd%",
        ],
    ),
    ("torque", &["700 Nm", "90 Nm", "1e-3 Nm", "0 Nm", "%small% kNm", "%odd%"]),
];

pub fn check(data: &[u8]) -> Result<(), String> {
    let text = match robstiff_robots::text::decoded("robot.yaml", data.to_vec()) {
        Ok(text) => text,
        Err(problems) => return Err(assert_places(&problems, &[("robot.yaml", &String::from_utf8_lossy(data))])),
    };
    let _ = Description::outline(&text);
    let read = Description::parse("robot.yaml", &text);
    if let Some(text) = with_line_breaks_of_windows(&text) {
        let again = Description::parse("robot.yaml", &text);
        assert_same("with other line breaks", &read.as_ref().ok(), &again.as_ref().ok());
    }
    match read {
        Ok(description) => {
            assert_written(&description);
            assert_computed(&description);
            Ok(())
        }
        Err(problems) => Err(assert_places(&problems, &[("robot.yaml", &text)])),
    }
}

/// What is written is read as the same.
///
/// # Panics
/// Where it is not.
pub fn assert_written(description: &Description) {
    let yaml = description.to_yaml();
    let again = Description::parse("written.yaml", &yaml);
    let again = again.unwrap_or_else(|problems| panic!("what was written is refused\n{problems}\n{yaml}"));
    assert_same(&yaml, description, &again);
    let warnings = description.warnings();
    assert!(warnings.iter().all(|warning| !warning.trim().is_empty()), "{warnings:?}");
}

fn assert_computed(description: &Description) {
    match description.joints.len() {
        1 => {
            computed::<1>(description);
            assert_generated(description);
        }
        2 => {
            computed::<2>(description);
            assert_generated(description);
        }
        3 => computed::<3>(description),
        _ => {}
    }
}

/// There is code for it, which is Rust.
fn assert_generated(description: &Description) {
    let path = |text: &str| text.parse().expect("a token");
    let origin = Origin { file: "robot.yaml".to_owned(), runtime: path("robstiff"), visibility: path("pub") };
    let source = source(description, &origin);
    assert!(syn::parse_file(&source).is_ok(), "{source}");
}

/// Numbers may overflow, but the code that computes them does not panic.
fn computed<const N: usize>(description: &Description) {
    let robot = Generic::<N>::new(description).expect("as many joints");
    let (q, wrench) = (SVector::from([0.3; N]), [300.0, -500.0, 700.0, 40.0, -60.0, 80.0].into());
    let compliance = robot.compliance(&q);
    let parts = contributions(&robot, &q).count();
    assert!(parts >= N, "{parts} parts of {N} joints");
    let mut state = State::new();
    let deflection = robot.deflection_with(&q, &wrench, &mut state);
    let all = compliance.iter().chain(&deflection).chain(state.plays.as_flattened()).sum::<f64>();
    let (torques, frames) = (robot.joint_torques(&q, &wrench), robot.link_frames(&q));
    std::hint::black_box((all, torques, frames, robot.preload(&q)));
}
