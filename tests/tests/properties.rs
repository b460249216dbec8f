//! The generator, its graphs and its code interpreted, against the generic
//! implementation, on robots drawn at random: both conventions, one to eight
//! joints, sliding ones too, with and without base, tool and effects.

use nalgebra::{Matrix4, Matrix6, SVector, Vector6};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use robstiff::{Convention, DhEntry, Effect, Generic, JointKind, Robot, State, with_robot};
use robstiff_codegen::{Function, Origin, functions, symbolic, tokens};
use robstiff_robots::{Description, Joint, Link, Part, Place, Placement};
use robstiff_tests::interpreter::Code;
use robstiff_tests::judge::{DOUBLE, Sizes, assert_close, blocks};

/// Angles that generators trip over, and any others.
fn angle() -> impl Strategy<Value = f64> {
    let quarter = std::f64::consts::FRAC_PI_2;
    prop_oneof![
        8 => prop::sample::select(vec![0.0, quarter, -quarter, 2.0 * quarter, -2.0 * quarter]),
        2 => -3.0..3.0_f64,
        // Many turns.
        1 => -1e6..1e6_f64,
        // Their sum is no multiple of a quarter turn, by less than what is forgiven one.
        1 => prop::sample::select(vec![0.7, 8e-10 - 0.7]),
        // Its cosine is -1, and its sine is not 0.
        1 => Just(2.0 * quarter + 5e-9),
    ]
}

/// None, a whole metre, or anything from a centimetre: the direction of a
/// shorter link, as a difference of two positions a metre away, has lost more
/// than the digits that are compared.
fn length() -> impl Strategy<Value = f64> {
    prop_oneof![2 => Just(0.0), 1 => Just(1.0), 2 => 0.01..1.5_f64, 1 => -1.5..-0.01_f64]
}

fn compliance() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 5 => 1e-8..1e-5_f64]
}

fn placement() -> impl Strategy<Value = Placement> {
    prop_oneof![
        Just(Placement::default()),
        (prop::array::uniform3(length()), prop::array::uniform3(angle())).prop_map(|(xyz, rpy)| Placement { xyz, rpy }),
    ]
}

fn joint() -> impl Strategy<Value = Joint> {
    let kind = prop_oneof![4 => Just(JointKind::Revolute), 1 => Just(JointKind::Prismatic)];
    (kind, angle(), length(), length(), angle(), compliance()).prop_map(|(kind, theta, d, a, alpha, value)| Joint {
        kind,
        theta,
        d,
        a,
        alpha,
        limits: None,
        compliance: vec![Part { name: String::new(), value }],
    })
}

/// At most one effect of a kind at a place; couplings of turning joints only.
fn effects(joints: Vec<Joint>) -> impl Strategy<Value = Vec<Effect>> {
    let n = joints.len();
    let turning: Vec<usize> = (1..=n).filter(|&i| joints[i - 1].kind == JointKind::Revolute).collect();
    let mut all = vec![
        (1..=n, 1e-8..1e-6_f64).prop_map(|(joint, value)| Effect::TransverseCompliance { joint, value }).boxed(),
        (compliance(), compliance())
            .prop_map(|(tilt, translation)| Effect::BaseCompliance { tilt, translation })
            .boxed(),
        (compliance(), compliance())
            .prop_map(|(rotation, translation)| Effect::ToolCompliance { rotation, translation })
            .boxed(),
    ];
    if n > 1 {
        let link = (1..n, compliance(), compliance());
        all.push(link.prop_map(|(link, bending, torsion)| Effect::LinkCompliance { link, bending, torsion }).boxed());
    }
    if !turning.is_empty() {
        let nonlinear = (prop::sample::select(turning.clone()), 1e-8..1e-6_f64, 10.0..1e4_f64);
        let turning_joint = || prop::sample::select(turning.clone());
        all.push(
            (turning_joint(), 1e-5..1e-3_f64, 10.0..1e3_f64)
                .prop_map(|(joint, gap, knee)| Effect::LostMotion { joint, gap, knee })
                .boxed(),
        );
        all.push(
            (turning_joint(), prop::array::uniform3(1.0..300.0_f64), prop::array::uniform3(compliance()))
                .prop_map(|(joint, steps, [weight1, weight2, weight3])| {
                    let [radius1, radius2, radius3] = [steps[0], steps[0] + steps[1], steps[0] + steps[1] + steps[2]];
                    Effect::Hysteresis { joint, radius1, weight1, radius2, weight2, radius3, weight3 }
                })
                .boxed(),
        );
        all.push(
            (turning_joint(), prop::array::uniform4(-0.2..0.2_f64))
                .prop_map(|(joint, [cos1, sin1, cos2, sin2])| Effect::PoseDependentCompliance {
                    joint,
                    cos1,
                    sin1,
                    cos2,
                    sin2,
                })
                .boxed(),
        );
        all.push(
            (turning_joint(), angle()).prop_map(|(joint, value)| Effect::JointZeroOffset { joint, value }).boxed(),
        );
        all.push(
            (turning_joint(), 1..60_u8, prop::array::uniform2(-3e-3..3e-3_f64))
                .prop_map(|(joint, order, [sin, cos])| Effect::TransmissionError {
                    joint,
                    order: f64::from(order),
                    sin,
                    cos,
                })
                .boxed(),
        );
        let column = prop::sample::select(vec![DhEntry::A, DhEntry::Alpha, DhEntry::D, DhEntry::Theta]);
        all.push(
            (column, 1..=n, 0.02..0.1_f64)
                .prop_map(|(column, row, value)| Effect::DhError { entry: column(row), value })
                .boxed(),
        );
        all.push(
            nonlinear.prop_map(|(joint, added, knee)| Effect::StiffnessNonlinearity { joint, added, knee }).boxed(),
        );
    }
    if turning.len() > 1 {
        let pair = (prop::sample::subsequence(turning, 2), -1e-7..1e-7_f64);
        all.push(pair.prop_map(|(pair, value)| Effect::JointCoupling { joints: [pair[0], pair[1]], value }).boxed());
    }
    let count = all.len();
    prop::sample::subsequence(all, 0..=count).prop_flat_map(|chosen| chosen)
}

/// Masses of which the arm sags by at most some mrad, wherever it stands; now and then its
/// gears carry them, too.
fn sagging(robot: Description) -> impl Strategy<Value = Description> {
    let count = robot.joints.len();
    let link = (0.0..300.0_f64, prop::array::uniform3(length()));
    let link = link.prop_map(|(mass, center_of_mass)| Link { mass, center_of_mass });
    let preload = prop::option::of((0.0..1.5_f64).prop_map(|share| Effect::GravityPreload { share }));
    (prop::collection::vec(link, count), preload, Just(robot)).prop_map(|(links, preload, robot)| {
        let softest = robot.joints.iter().map(Joint::compliance).fold(0.0, f64::max);
        let weight: f64 = links.iter().map(|link| 9.81 * link.mass).sum();
        let share = 1e-2 / (softest * weight * (Sizes::of(&robot, &[4.0; 8]).reach + 3.0)).max(1e-3);
        let own = robot.effects.iter().cloned();
        let effects = own.chain(preload).chain([Effect::GravitySag { share }]).collect();
        Description { links, effects, ..robot }
    })
}

fn robot() -> impl Strategy<Value = Description> {
    upright_robot().prop_flat_map(|robot| prop_oneof![3 => Just(robot.clone()), 1 => sagging(robot)])
}

fn upright_robot() -> impl Strategy<Value = Description> {
    let convention = prop_oneof![Just(Convention::Standard), Just(Convention::Modified)];
    (prop::collection::vec(joint(), 1..=8), convention, placement(), placement())
        .prop_flat_map(|(joints, convention, base, tool)| {
            (effects(joints.clone()), Just((joints, convention, base, tool)))
        })
        .prop_map(|(effects, (joints, convention, base, tool))| Description {
            name: "Drawn".into(),
            description: String::new(),
            source: String::new(),
            convention,
            base,
            joints,
            tool,
            links: Vec::new(),
            effects,
            controller: None,
        })
        .prop_map(|mut robot| {
            let points: Vec<usize> = (1..robot.joints.len()).filter(|&link| !robot.is_beam(link)).collect();
            robot.effects.retain(|effect| !matches!(effect.place(), Place::Link(link) if points.contains(&link)));
            robot
        })
}

/// Coordinates, some of them 0.
fn coordinates() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(prop_oneof![7 => -3.0..3.0_f64, 1 => Just(0.0)], 8)
}

/// That the tokens for the compiler, run by an interpreter, calculate what the
/// graphs do, to the last bit.
fn compare_code(robot: &Description, q: &[f64], wrench: &[f64; 6]) {
    let path = |text: &str| text.parse().expect("a token");
    let origin = Origin { file: "drawn.yaml".into(), runtime: path("robstiff"), visibility: path("pub") };
    let code = Code::of(syn::parse2(tokens(robot, &origin)).expect("generated code is Rust"));
    let mut before = vec![[0.0; 3]; q.len()];
    for (k, play) in before.as_flattened_mut().iter_mut().enumerate() {
        *play = wrench[k % 6] * 0.3;
    }
    for (name, function) in functions(robot) {
        let mut after = before.clone();
        let found = code.call_with(name, q, wrench, &mut after);
        let expected = function.evaluate_with(q, wrench, &before);
        let plays = symbolic::plays(robot).into_iter().map(|(joint, k)| after[joint][k]);
        let found: Vec<f64> = found.into_iter().chain(plays.filter(|_| name == "deflection_with")).collect();
        assert_eq!(found, expected, "{name}");
        if let Some(found) = code.call_in_columns(name, q) {
            compare_columns(robot, name, q, &found, &expected);
        }
    }
}

/// That the formulation in columns, with its frames by columns, says the same.
fn compare_columns(robot: &Description, name: &str, q: &[f64], found: &[f64], expected: &[f64]) {
    let sizes = Sizes::of(robot, q);
    let frame = if matches!(name, "transform" | "statics") { 16 } else { 0 };
    let compliance = if matches!(name, "compliance" | "statics") { 36 } else { 0 };
    let transposed = |k: usize| if k < frame { expected[4 * (k % 4) + k / 4] } else { expected[k] };
    let expected: Vec<f64> = (0..expected.len()).map(transposed).collect();
    let kinematic = expected.len() - compliance;
    assert_close(name, &found[..kinematic], &expected[..kinematic], sizes.reach, DOUBLE);
    for (k, (found, expected)) in found.iter().zip(&expected).skip(kinematic).enumerate() {
        let size = sizes.compliance()[k / 18 + k % 6 / 3];
        assert_close(name, &[*found], &[*expected], size, DOUBLE);
    }
    assert_eq!(found.len(), expected.len(), "{name}");
}

/// Panics where the two disagree, which a property takes for a failure.
fn compare<const N: usize>(robot: &Description, generic: &Generic<N>, q: &[f64], wrench: &[f64; 6]) {
    let at = SVector::<f64, N>::from_column_slice(q);
    let load = Vector6::from_column_slice(wrench);
    let rows = |m: Matrix4<f64>| m.transpose().as_slice().to_vec();
    let close = |name, found: &[f64], expected: &[f64], size| assert_close(name, found, expected, size, DOUBLE);

    let sizes = Sizes::of(robot, q);
    let torque = sizes.torque(&load);
    let transform = Function::of(|g| symbolic::transform(g, robot)).evaluate(q, &[]);
    close("transform", &transform, &rows(generic.transform(&at)), sizes.reach);
    let frames = Function::of(|g| symbolic::link_frames(g, robot)).evaluate(q, &[]);
    close("link_frames", &frames, &generic.link_frames(&at).map(rows).concat(), sizes.reach);
    let jacobian = Function::of(|g| symbolic::jacobian(g, robot)).evaluate(q, &[]);
    close("jacobian", &jacobian, generic.jacobian(&at).as_slice(), sizes.reach);
    let torques = Function::of(|g| symbolic::joint_torques(g, robot)).evaluate(q, wrench);
    close("joint_torques", &torques, generic.joint_torques(&at, &load).as_slice(), torque);
    let compliance = Function::of(|g| symbolic::compliance(g, robot)).evaluate(q, &[]);
    let (found, expected) = (blocks(&Matrix6::from_row_slice(&compliance)), blocks(&generic.compliance(&at)));
    for (k, size) in sizes.compliance().into_iter().enumerate() {
        close(["compliance tt", "compliance tr", "compliance rr"][k], &found[k], &expected[k], size);
    }
    let deflection = Function::of(|g| symbolic::deflection(g, robot)).evaluate(q, wrench);
    let reference = generic.deflection(&at, &load);
    let mut state = State::new();
    let after = Function::of(|g| symbolic::deflection_with(g, robot));
    let mut plays = vec![[0.0; 3]; N];
    for share in [1.0, -0.3, 0.6, 0.0] {
        let found = after.evaluate_with(q, &wrench.map(|x| x * share), &plays);
        let reference = generic.deflection_with(&at, &(load * share), &mut state);
        for (&(joint, k), &play) in symbolic::plays(robot).iter().zip(&found[6..]) {
            plays[joint][k] = play;
        }
        close("displacement after", &found[..3], &reference.as_slice()[..3], sizes.softest * sizes.reach * torque);
        close("rotation after", &found[3..6], &reference.as_slice()[3..], sizes.softest * torque);
        close("play operators", plays.as_flattened(), state.plays.as_flattened(), torque);
    }
    close("displacement", &deflection[..3], &reference.as_slice()[..3], sizes.softest * sizes.reach * torque);
    close("rotation", &deflection[3..], &reference.as_slice()[3..], sizes.softest * torque);
}

/// So many robots, the same ones in every run.
fn cases(count: u32) -> ProptestConfig {
    ProptestConfig { rng_seed: RngSeed::Fixed(1), ..ProptestConfig::with_cases(count) }
}

proptest! {
    #![proptest_config(cases(800))]

    #[test]
    fn generated_agrees_with_generic(
        robot in robot(),
        q in coordinates(),
        wrench in prop::array::uniform6(-1000.0..1000.0_f64),
    ) {
        let q = &q[..robot.joints.len()];
        with_robot!(&robot, |generic| compare(&robot, &generic, q, &wrench))
    }
}

proptest! {
    #![proptest_config(cases(80))]

    #[test]
    fn code_calculates_what_its_graphs_do(
        robot in robot(),
        q in coordinates(),
        wrench in prop::array::uniform6(-1000.0..1000.0_f64),
    ) {
        compare_code(&robot, &q[..robot.joints.len()], &wrench);
    }
}
