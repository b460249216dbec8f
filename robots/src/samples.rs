//! Robots for tests, constructed in code.

use crate::{Convention, Description, Effect, Joint, JointKind, Part, Placement};

const QUARTER: f64 = core::f64::consts::FRAC_PI_2;

/// A robot of revolute joints with rows `[theta, d, a, alpha, compliance]`.
pub fn arm(convention: Convention, rows: &[[f64; 5]]) -> Description {
    let joints = rows.iter().map(|&[theta, d, a, alpha, value]| Joint {
        kind: JointKind::Revolute,
        theta,
        d,
        a,
        alpha,
        limits: None,
        compliance: vec![Part { name: String::new(), value }],
    });
    Description {
        name: "Sample".into(),
        description: String::new(),
        source: String::new(),
        convention,
        base: Placement::default(),
        joints: joints.collect(),
        tool: Placement::default(),
        links: Vec::new(),
        effects: Vec::new(),
        controller: None,
    }
}

/// The five-axis fork-head arm of the seed paper.
pub fn five_axis() -> Description {
    arm(
        Convention::Standard,
        &[
            [0.0, 0.865, 0.41, -QUARTER, 2.97e-7],
            [-QUARTER, 0.0, 1.0, 0.0, 2.97e-7],
            [0.0, 0.0, 0.25, -QUARTER, 3.12e-7],
            [0.0, 1.1, 0.0, QUARTER, 1.92e-7],
            [0.0, 0.0, 0.3, 0.0, 78e-7],
        ],
    )
}

/// Six axes in the modified convention with a sliding third joint, odd angles,
/// a placed base and a tool: nothing in it is special.
pub fn odd() -> Description {
    let mut odd = arm(
        Convention::Modified,
        &[
            [0.1, 0.7, 0.02, 0.03, 3e-7],
            [-QUARTER, 0.01, 0.35, -QUARTER, 2e-7],
            [0.2, 0.3, 1.2, 0.4, 5e-8],
            [-0.3, 1.1, 0.05, -QUARTER, 4e-6],
            [0.0, 0.0, 0.0, QUARTER, 5e-6],
            [0.6, 0.2, 0.0, -1.3, 6e-6],
        ],
    );
    odd.joints[2].kind = JointKind::Prismatic;
    odd.base = Placement { xyz: [0.3, -0.2, 0.5], rpy: [0.2, -0.4, 0.7] };
    odd.tool = Placement { xyz: [0.05, -0.02, 0.25], rpy: [QUARTER, 0.3, -0.2] };
    odd
}

/// One effect of every linear kind, for an arm of five joints or more.
pub fn linear_effects() -> Vec<Effect> {
    vec![
        Effect::TransverseCompliance { joint: 3, value: 6e-7 },
        Effect::LinkCompliance { link: 2, bending: 7e-8, torsion: 1.2e-7 },
        Effect::LinkCompliance { link: 4, bending: 3e-7, torsion: 2e-7 },
        Effect::BaseCompliance { tilt: 2e-8, translation: 1e-9 },
        Effect::ToolCompliance { rotation: 3e-7, translation: 1e-8 },
        Effect::JointCoupling { joints: [2, 4], value: -4e-8 },
    ]
}

/// A few poses all over the workspace.
pub fn poses<const N: usize>() -> impl Iterator<Item = [f64; N]> {
    (1..8).map(|k| core::array::from_fn(|i| 2.0 * f64::sin(1.7 * f64::from(k) + 2.3 * i as f64)))
}
