//! What generated functions cost: a change that costs more shows here.

use robstiff_codegen::{Cost, Function, Origin, symbolic};
use robstiff_robots::{Convention, Description, Joint, JointKind, Part, Placement};

#[test]
fn show() {
    let r = arm([
        (0.0, 0.865, 0.41, -90.0),
        (-90.0, 0.0, 1.0, 0.0),
        (0.0, 0.0, 0.25, -90.0),
        (0.0, 1.1, 0.0, 90.0),
        (0.0, 0.0, 0.3, 0.0),
    ]);
    let r6 = arm([
        (0., 0.75, 0.35, -90.),
        (0., 0., 1.25, 0.),
        (-90., 0., 0.055, -90.),
        (0., 1.1, 0., 90.),
        (0., 0., 0., -90.),
        (0., 0.23, 0., 0.),
    ]);
    for r in [&r, &r6] {
        println!("T {}", Function::of(|g| symbolic::transform(g, r)).cost());
        println!("J {}", Function::of(|g| symbolic::jacobian(g, r)).cost());
        println!("H {}", Function::of(|g| symbolic::compliance(g, r)).cost());
        println!("D {}", Function::of(|g| symbolic::deflection(g, r)).cost());
    }
    let o = Origin { file: "r5.yaml".into(), runtime: "robstiff".parse().unwrap(), visibility: "pub".parse().unwrap() };
    println!("{}", robstiff_codegen::source(&r, &o));
    let _ = Cost::default();
}

fn arm<const N: usize>(rows: [(f64, f64, f64, f64); N]) -> Description {
    Description {
        name: "R".into(),
        description: String::new(),
        source: String::new(),
        convention: Convention::Standard,
        base: Placement::default(),
        joints: rows
            .iter()
            .enumerate()
            .map(|(i, r)| Joint {
                kind: JointKind::Revolute,
                theta: r.0.to_radians(),
                d: r.1,
                a: r.2,
                alpha: r.3.to_radians(),
                limits: None,
                compliance: vec![Part { name: String::new(), value: 1.1e-7 * (i + 2) as f64 }],
            })
            .collect(),
        tool: Placement::default(),
        links: vec![],
        effects: vec![],
    }
}
