//! Two arms to try things on, built in code.

use robstiff_robots::{Convention, Description, Joint, JointKind, Part, Placement};

/// A milling arm of five axes in a fork head: `Rv130hsc`.
///
/// The dimensions are a surrogate of the right size, the compliances those
/// published for the Reis RV130HSC. The limits are those of a working region,
/// with the arm in front of its column, not those of the machine.
pub fn five_axis() -> Description {
    description(
        "Rv130hsc",
        "Five-axis fork-head milling arm of the size of a Reis RV130HSC",
        "Dimensions: surrogate. Compliances: Abele, Weigold, Rothenbuecher, CIRP Annals 56/1 (2007), table 1",
        vec![
            joint([0.0, 0.865, 0.41, -90.0], [-120.0, 120.0], 2.97e-7),
            joint([-90.0, 0.0, 1.0, 0.0], [-55.0, 70.0], 2.97e-7),
            joint([0.0, 0.0, 0.25, -90.0], [-70.0, 80.0], 3.12e-7),
            joint([0.0, 1.1, 0.0, 90.0], [-165.0, 165.0], 1.92e-7),
            joint([0.0, 0.0, 0.3, 0.0], [-100.0, 100.0], 7.80e-6),
        ],
    )
}

/// An arm of six axes with a spherical wrist, of the 240 kg class: `Kr240like`.
///
/// Dimensions and compliances are a surrogate of the right size. The limits are
/// those of a working region, with the arm in front of its column.
pub fn six_axis() -> Description {
    description(
        "Kr240like",
        "Six-axis arm with a spherical wrist, 240 kg class",
        "Surrogate: dimensions and compliances of the right size",
        vec![
            joint([0.0, 0.75, 0.35, -90.0], [-120.0, 120.0], 2.42406e-7),
            joint([0.0, 0.0, 1.25, 0.0], [-118.0, -25.0], 3.30623e-7),
            joint([-90.0, 0.0, 0.055, -90.0], [-25.0, 105.0], 2.66526e-7),
            joint([0.0, 1.1, 0.0, 90.0], [-165.0, 165.0], 3.87455e-6),
            joint([0.0, 0.0, 0.0, -90.0], [-110.0, 110.0], 2.71532e-6),
            joint([0.0, 0.23, 0.0, 0.0], [-175.0, 175.0], 5.0761e-6),
        ],
    )
}

fn description(name: &str, description: &str, source: &str, joints: Vec<Joint>) -> Description {
    Description {
        name: name.into(),
        description: description.into(),
        source: source.into(),
        convention: Convention::Standard,
        base: Placement::default(),
        joints,
        tool: Placement { xyz: [0.0, 0.0, 0.12], rpy: [0.0; 3] },
        links: Vec::new(),
        effects: Vec::new(),
        controller: None,
    }
}

/// A revolute joint from its row `[theta, d, a, alpha]` and limits, angles in
/// degrees, and its compliance (rad/Nm).
fn joint([theta, d, a, alpha]: [f64; 4], limits: [f64; 2], compliance: f64) -> Joint {
    Joint {
        kind: JointKind::Revolute,
        theta: theta.to_radians(),
        d,
        a,
        alpha: alpha.to_radians(),
        limits: Some(limits.map(f64::to_radians)),
        compliance: vec![Part { name: String::new(), value: compliance }],
    }
}
