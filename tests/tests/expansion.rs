//! What generated code costs and looks like, held against the best that was
//! written by hand and against other generators. The counts of every robot are
//! pinned in `golden.rs`.

use robstiff::{Convention, DhEntry, Effect, JointKind};
use robstiff_codegen::{Cost, Function, Origin, functions, skeleton, source, symbolic, tokens};
use robstiff_robots::effect::CATALOGUE;
use robstiff_robots::{Description, Joint, Part, Placement};
use robstiff_tests::arms::{self, description};

/// The operations of every function.
fn costs(robot: &Description) -> Vec<Cost> {
    functions(robot).iter().map(|(_, function)| function.cost()).collect()
}

fn compliance_cost(robot: &Description) -> Cost {
    Function::of(|g| symbolic::compliance(g, robot)).cost()
}

fn deflection_cost(robot: &Description) -> Cost {
    Function::of(|g| symbolic::deflection(g, robot)).cost()
}

fn text(robot: &Description, file: &str) -> String {
    source(robot, &origin(file))
}

fn origin(file: &str) -> Origin {
    let path = |text: &str| text.parse().expect("a token");
    Origin { file: file.to_owned(), runtime: path("robstiff"), visibility: path("pub") }
}

/// One method of a generated source.
fn method<'t>(text: &'t str, name: &str) -> &'t str {
    let start = text.find(&format!("fn {name}")).expect("the method");
    let rest = &text[start..];
    &rest[..rest.find("\n    }\n").expect("its end")]
}

/// A standard arm from rows `[theta, d, a, alpha]`, angles in degrees.
fn arm(rows: &[[f64; 4]]) -> Description {
    let joint = |(i, &[theta, d, a, alpha]): (usize, &[f64; 4])| Joint {
        kind: JointKind::Revolute,
        theta: theta.to_radians(),
        d,
        a,
        alpha: alpha.to_radians(),
        limits: None,
        compliance: vec![Part { name: String::new(), value: 1.1e-7 * (i + 2) as f64 }],
    };
    Description {
        name: "Arm".into(),
        description: String::new(),
        source: String::new(),
        convention: Convention::Standard,
        base: Placement::default(),
        joints: rows.iter().enumerate().map(joint).collect(),
        tool: Placement::default(),
        links: Vec::new(),
        effects: Vec::new(),
        controller: None,
    }
}

fn five_axes() -> Description {
    arm(&[
        [0.0, 0.865, 0.41, -90.0],
        [-90.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.25, -90.0],
        [0.0, 1.1, 0.0, 90.0],
        [0.0, 0.0, 0.3, 0.0],
    ])
}

fn six_axes() -> Description {
    arm(&[
        [0.0, 0.75, 0.35, -90.0],
        [0.0, 0.0, 1.25, 0.0],
        [-90.0, 0.0, 0.055, -90.0],
        [0.0, 1.1, 0.0, 90.0],
        [0.0, 0.0, 0.0, -90.0],
        [0.0, 0.23, 0.0, 0.0],
    ])
}

/// The best known counts of `H_x`, and CasADi's (with common subexpressions
/// eliminated), which must never be reached. Written by hand: 103 and 79 for
/// five axes, 114 and 88 for six.
#[test]
fn compliance_is_cheaper_than_by_hand() {
    for (arm, muls, adds) in [(five_axes(), 96, 78), (six_axes(), 106, 87)] {
        let cost = compliance_cost(&arm);
        assert!(cost.mul <= muls && cost.add <= adds, "{cost}");
        assert!((cost.trig, cost.root) == (10, 0), "{cost}");
    }
    let (five, casadi) = (compliance_cost(&five_axes()), (166, 102));
    assert!(five.mul < casadi.0 && five.add < casadi.1, "{five}");
}

/// A deflection does not form the compliance, which costs more together with
/// its product with the wrench (36 mul, 30 add).
#[test]
fn a_deflection_is_cheaper_than_the_compliance_times_the_wrench() {
    for arm in [five_axes(), six_axes()] {
        let (deflection, compliance) = (deflection_cost(&arm), compliance_cost(&arm));
        assert!(deflection.mul < compliance.mul + 36 && deflection.add < compliance.add + 30, "{deflection}");
    }
}

/// An effect adds its own terms, and what they make of entries that were zero;
/// nothing is carried along for effects that are not there.
#[test]
fn effects_cost_only_their_own_terms() {
    let plain = five_axes();
    // Multiplications and additions on top, of compliance and of deflection.
    let bounds = [
        (Effect::TransverseCompliance { joint: 1, value: 1e-7 }, [10, 14], [10, 11]),
        (Effect::TransverseCompliance { joint: 3, value: 1e-7 }, [8, 11], [19, 18]),
        (Effect::TransverseCompliance { joint: 5, value: 1e-7 }, [4, 6], [21, 20]),
        (Effect::LinkCompliance { link: 2, bending: 1e-7, torsion: 2e-7 }, [34, 40], [35, 31]),
        (Effect::LinkCompliance { link: 2, bending: 0.0, torsion: 2e-7 }, [24, 26], [22, 20]),
        (Effect::BaseCompliance { tilt: 1e-7, translation: 0.0 }, [10, 14], [10, 11]),
        (Effect::BaseCompliance { tilt: 0.0, translation: 1e-9 }, [0, 3], [3, 3]),
        (Effect::ToolCompliance { rotation: 1e-7, translation: 0.0 }, [0, 2], [3, 3]),
        (Effect::ToolCompliance { rotation: 0.0, translation: 1e-9 }, [0, 3], [3, 3]),
        (Effect::JointCoupling { joints: [2, 3], value: 1e-7 }, [10, 11], [2, 2]),
        (Effect::JointCoupling { joints: [1, 5], value: 1e-7 }, [30, 23], [2, 2]),
        (Effect::StiffnessNonlinearity { joint: 2, added: 1e-7, knee: 500.0 }, [0, 0], [4, 2]),
        (Effect::LostMotion { joint: 2, gap: 1e-4, knee: 30.0 }, [0, 0], [4, 2]),
        (hysteresis(1), [0, 0], [1, 5]),
        (hysteresis(3), [0, 0], [3, 15]),
        (pose_dependent(1), [8, 4], [4, 2]),
    ];
    for (effect, compliance, deflection) in bounds {
        let with = Description { effects: vec![effect], ..plain.clone() };
        for (cost, before, [muls, adds]) in [
            (compliance_cost(&with), compliance_cost(&plain), compliance),
            (deflection_cost(&with), deflection_cost(&plain), deflection),
        ] {
            assert!(cost.mul <= before.mul + muls && cost.add <= before.add + adds, "{effect}: {cost} after {before}");
            assert_eq!(cost.trig, before.trig, "{effect}");
        }
        // The root of the nonlinearity and its reciprocal; no effect divides.
        let is_rooted = matches!(effect, Effect::StiffnessNonlinearity { .. } | Effect::LostMotion { .. });
        let roots = if is_rooted { 2 } else { 0 };
        assert_eq!((compliance_cost(&with).root, deflection_cost(&with).root), (0, roots), "{effect}");
        let [before, after] = [&plain, &with].map(costs);
        assert_eq!(before[..3], after[..3], "{effect} has no part in kinematics");
        assert_eq!(before[5], after[5], "{effect} has no part in torques");
    }
}

/// Hysteresis of joint 2 with so many play operators.
fn hysteresis(count: usize) -> Effect {
    let weight = |k: usize| if k <= count { 1e-8 } else { 0.0 };
    let [weight1, weight2, weight3] = [1, 2, 3].map(weight);
    Effect::Hysteresis { joint: 2, radius1: 10.0, weight1, radius2: 20.0, weight2, radius3: 30.0, weight3 }
}

fn pose_dependent(joint: usize) -> Effect {
    Effect::PoseDependentCompliance { joint, cos1: 0.1, sin1: 0.0, cos2: 0.0, sin2: 0.0 }
}

/// Corrections of the DH table are in its numbers; an angle error costs its
/// sine and cosine, and those of the sum.
#[test]
fn kinematic_effects_cost_only_their_own_terms() {
    let plain = five_axes();
    let with = |effect: Effect| Description { effects: vec![effect], ..plain.clone() };
    let corrected = with(Effect::DhError { entry: DhEntry::D(4), value: 1e-3 });
    assert_eq!(costs(&corrected), costs(&plain));
    let wave = with(Effect::TransmissionError { joint: 5, order: 7.0, sin: 1e-3, cos: 0.0 });
    for (cost, before) in costs(&wave).into_iter().zip(costs(&plain)) {
        assert!(cost.trig <= before.trig + 1, "{cost} after {before}");
        assert!(cost.mul <= before.mul + 12 && cost.add <= before.add + 6, "{cost} after {before}");
        assert_eq!(cost.root, before.root);
    }
}

#[test]
fn what_is_zero_costs_nothing() {
    let plain = five_axes();
    let mut with = plain.clone();
    with.effects = vec![
        Effect::TransverseCompliance { joint: 3, value: 0.0 },
        Effect::LinkCompliance { link: 2, bending: 0.0, torsion: 0.0 },
        Effect::BaseCompliance { tilt: 0.0, translation: 0.0 },
        Effect::ToolCompliance { rotation: 0.0, translation: 0.0 },
    ];
    assert_eq!(costs(&with), costs(&plain));
    // A rigid joint does not enter at all.
    with.joints[4].compliance.clear();
    assert!(compliance_cost(&with).mul < compliance_cost(&plain).mul);
    for joint in &mut with.joints {
        joint.compliance.clear();
    }
    assert_eq!((compliance_cost(&with), deflection_cost(&with)), (Cost::default(), Cost::default()));
}

#[test]
fn what_the_result_does_not_depend_on_is_not_computed() {
    // A TCP on the last axis does not move as that turns.
    let text = text(&six_axes(), "six.yaml");
    for name in ["jacobian", "compliance", "deflection", "joint_torques"] {
        let method = method(&text, name);
        assert!(method.contains("q[4]") && !method.contains("q[5]"), "{method}");
    }
    assert!(method(&text, "transform").contains("q[5]"));
    // Nor does it matter to it how high the first joint stands.
    assert!(!method(&text, "jacobian").contains("D1"));
}

#[test]
fn every_line_is_used() {
    for &file in arms::FILES {
        let robot = description(file);
        let text = text(&robot, file);
        for (name, _) in functions(&robot) {
            let method = method(&text, name);
            let words = || method.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
            for line in method.lines().filter_map(|line| line.trim().strip_prefix("let ")) {
                let pattern = line.split('=').next().expect("something");
                for bound in pattern.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')) {
                    let uses = words().filter(|word| *word == bound).count();
                    assert!(["", "_"].contains(&bound) || uses > 1, "{file}, {name}: {bound}");
                }
            }
        }
    }
}

/// Of texts that look like code, and of one with lines as they once ended on a Mac.
#[test]
fn any_description_becomes_docs() {
    let said = "Reads\rMatrix4::new(\nand, besides,\n[links] <and> tags\n```\nnot code\n```\n~~~\nnor this\n~~~\n\
                and \u{202e}back\u{2069}";
    let robot = Description { description: said.into(), source: said.into(), ..five_axes() };
    let text = text(&robot, "arm.yaml");
    assert!(syn::parse_file(&text).is_ok());
    for line in [
        "/// Reads\n",
        "/// Matrix4::new(\n",
        "/// and, besides,\n",
        "/// \\[links] \\<and> tags\n",
        "/// and \\u{202e}back\\u{2069}\n",
    ] {
        assert!(text.contains(line), "{line}");
    }
    // Code would be run as a test of the user's.
    assert!(!text.contains("```") && !text.contains("~~~"), "{text}");
}

/// A line end in the name of a description's file ends no comment.
#[test]
fn the_name_of_a_file_is_no_code() {
    let items = |file: &str| syn::parse_file(&text(&five_axes(), file)).expect("Rust").items.len();
    for file in
        ["arm\npub fn injected() {}\n.yaml", "arm\r\npub fn injected() {}\n.yaml", "arm*/ pub fn f() {} /*.yaml"]
    {
        assert_eq!(items(file), items("arm.yaml"), "{file:?}");
    }
}

/// An address is a link, and of the text around it nothing goes with it.
#[test]
fn addresses_in_a_description_are_links() {
    let of = |said: &str| {
        let robot = Description { source: said.into(), ..five_axes() };
        text(&robot, "arm.yaml")
            .split_once("# Sources\n///\n")
            .expect("sources")
            .1
            .lines()
            .next()
            .expect("one")
            .to_owned()
    };
    for (said, shown) in [
        ("https://a.org/b?c=d_e.", "<https://a.org/b?c=d_e>."),
        ("(see http://a.org/b), and https://a.org/c_(d)", "(see <http://a.org/b>), and <https://a.org/c_(d)>"),
        ("[a](https://a.org)", "\\[a](<https://a.org>)"),
        ("`https://a.org` is https://", "`https://a.org` is <https://>"),
        ("https stands for nothing", "https stands for nothing"),
    ] {
        assert_eq!(of(said), format!("/// {shown}"), "{said}");
    }
}

/// One mistake in a description is one error, whatever the user's code names.
#[test]
fn a_robot_with_mistakes_has_the_constants_of_one_without() {
    let names = |code: String| -> Vec<String> {
        code.split("pub const ").skip(1).map(|rest| rest.split_once(' ').expect("a type").0.to_owned()).collect()
    };
    for &file in arms::FILES {
        let robot = Description { effects: Vec::new(), ..description(file) };
        for joints in [Some(robot.joints.len()), None] {
            let known = names(skeleton(&robot.name, joints, &origin(file)).to_string());
            for name in names(tokens(&robot, &origin(file)).to_string()) {
                assert!(known.contains(&name), "{file}: {name}");
            }
        }
    }
}

#[test]
fn quarter_turns_leave_no_rounding() {
    for &file in arms::FILES {
        for word in text(&description(file), file).split(|c: char| c.is_whitespace() || "(),;[]".contains(c)) {
            if let Ok(number) = word.trim_start_matches('-').parse::<f64>() {
                assert!(number == 0.0 || number > 1e-10, "{file}: {word}");
            }
        }
    }
}

#[test]
fn turns_about_parallel_axes_are_one_angle() {
    let rv130hsc = text(&description("rv130hsc.yaml"), "rv130hsc.yaml");
    for name in ["transform", "link_frames", "jacobian", "compliance", "deflection", "joint_torques"] {
        let method = method(&rv130hsc, name);
        assert!(method.contains("(s23, c23)") && method.contains("q[1] + q[2]"), "{method}");
        // The way back from the TCP turns by q3 before it turns by both.
        assert!(name == "compliance" || !method.contains("c3)"), "{method}");
    }
    // Over half a turn about x, the sense of the turn changes.
    let snake = text(&description("snake.yaml"), "snake.yaml");
    assert!(method(&snake, "transform").contains("q[0] + q[1] + q[2] - q[3]"));
    // All axes of a SCARA are parallel: one sine and cosine for the hand.
    let scara = text(&description("scara.yaml"), "scara.yaml");
    assert!(method(&scara, "jacobian").contains("q[0] + q[1] - q[3]"));
}

#[test]
fn angles_that_differ_in_their_offset_have_two_names() {
    let sliders = text(&description("sliders.yaml"), "sliders.yaml");
    let jacobian = method(&sliders, "jacobian");
    for name in ["(s1o, c1o)", "(s1o_2, c1o_2)", "(s1o_3, c1o_3)"] {
        assert_eq!(jacobian.matches(name).count(), 1, "{jacobian}");
    }
}

/// The program that links only if no panic can be reached calls every method of the trait, of
/// arms with every effect.
#[test]
fn every_method_and_every_effect_is_in_the_proof() {
    let program = include_str!("../no_panic/src/main.rs");
    let source = syn::parse_file(include_str!("../../robstiff/src/robot.rs")).expect("the trait's file");
    let robot = source.items.iter().find_map(|item| match item {
        syn::Item::Trait(robot) if robot.ident == "Robot" => Some(robot),
        _ => None,
    });
    let methods = robot.expect("the trait").items.iter().filter_map(|item| match item {
        syn::TraitItem::Fn(method) => Some(method.sig.ident.to_string()),
        _ => None,
    });
    let missing: Vec<String> = methods.filter(|method| !program.contains(&format!("robot.{method}("))).collect();
    assert!(missing.is_empty(), "{missing:?}");
    let files = program.split("\"../robots/").skip(1).filter_map(|rest| rest.split('"').next());
    let kinds: Vec<&str> =
        files.flat_map(|file| description(file).effects.iter().map(Effect::kind).collect::<Vec<_>>()).collect();
    for about in CATALOGUE {
        assert!(kinds.contains(&about.kind), "no arm has {}", about.kind);
    }
}
