//! The generator against the generic implementation, on robots drawn at
//! random: both conventions, one to eight joints, sliding ones too, with and
//! without base, tool and effects.

use nalgebra::{SVector, Vector6};
use proptest::prelude::*;
use robstiff::{Convention, Effect, Generic, JointKind, Robot};
use robstiff_codegen::{Function, symbolic};
use robstiff_robots::{Description, Joint, Part, Placement};

/// Angles that generators trip over, and any others.
fn angle() -> impl Strategy<Value = f64> {
    let quarter = std::f64::consts::FRAC_PI_2;
    prop_oneof![
        4 => prop::sample::select(vec![0.0, quarter, -quarter, 2.0 * quarter, -2.0 * quarter]),
        1 => -3.0..3.0_f64,
    ]
}

fn length() -> impl Strategy<Value = f64> {
    prop_oneof![2 => Just(0.0), 1 => Just(1.0), 3 => -1.5..1.5_f64]
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

fn robot() -> impl Strategy<Value = Description> {
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
        })
}

/// Relative to the largest entry of the same kind, because a cancelled entry
/// has the rounding of what cancelled; where all cancel, to a thousandth of
/// `size`, what they would be if nothing did.
fn close(name: &str, generated: &[f64], generic: &[f64], size: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(generated.len(), generic.len());
    let scale = generic.iter().fold(1e-3 * size, |scale, x| scale.max(x.abs()));
    for (k, (a, b)) in generated.iter().zip(generic).enumerate() {
        prop_assert!((a - b).abs() <= 1e-12 * scale, "{name}[{k}]: {a} generated, {b} generic");
    }
    Ok(())
}

fn blocks(m: &[f64]) -> [Vec<f64>; 3] {
    let block = |rows: std::ops::Range<usize>, columns: std::ops::Range<usize>| {
        rows.flat_map(|i| columns.clone().map(move |j| (i, j))).map(|(i, j)| m[6 * i + j]).collect()
    };
    [block(0..3, 0..3), block(0..3, 3..6), block(3..6, 3..6)]
}

fn compare<const N: usize>(robot: &Description, q: &[f64], wrench: &[f64; 6]) -> Result<(), TestCaseError> {
    let generic = Generic::<N>::new(robot).expect("N joints");
    let at = SVector::<f64, N>::from_column_slice(q);
    let load = Vector6::from_column_slice(wrench);
    let rows = |m: nalgebra::Matrix4<f64>| m.transpose().as_slice().to_vec();

    let reach = reach(robot, q);
    let load_size = wrench.iter().fold(0.0_f64, |most, x| most.max(x.abs())) * reach;
    let softest = softest(robot);

    let transform = Function::of(|g| symbolic::transform(g, robot)).evaluate(q, &[]);
    close("transform", &transform, &rows(generic.transform(&at)), 1.0)?;
    let frames = Function::of(|g| symbolic::link_frames(g, robot)).evaluate(q, &[]);
    close("link_frames", &frames, &generic.link_frames(&at).map(rows).concat(), 1.0)?;
    let jacobian = Function::of(|g| symbolic::jacobian(g, robot)).evaluate(q, &[]);
    close("jacobian", &jacobian, generic.jacobian(&at).as_slice(), 1.0)?;
    let torques = Function::of(|g| symbolic::joint_torques(g, robot)).evaluate(q, wrench);
    close("joint_torques", &torques, generic.joint_torques(&at, &load).as_slice(), load_size)?;
    let compliance = Function::of(|g| symbolic::compliance(g, robot)).evaluate(q, &[]);
    let reference: nalgebra::Matrix6<f64> = generic.compliance(&at);
    let sizes = [softest * reach * reach, softest * reach, softest];
    for (k, (a, b)) in blocks(&compliance).iter().zip(&blocks(reference.transpose().as_slice())).enumerate() {
        close(["compliance tt", "compliance tr", "compliance rr"][k], a, b, sizes[k])?;
    }
    let deflection = Function::of(|g| symbolic::deflection(g, robot)).evaluate(q, wrench);
    let reference = generic.deflection(&at, &load);
    close("displacement", &deflection[..3], &reference.as_slice()[..3], softest * reach * load_size)?;
    close("rotation", &deflection[3..], &reference.as_slice()[3..], softest * load_size)
}

/// The length of the outstretched arm (m), at least 1.
fn reach(robot: &Description, q: &[f64]) -> f64 {
    let placed = |placement: &Placement| placement.xyz.iter().map(|x| x.abs()).sum::<f64>();
    let joints = robot.joints.iter().zip(q).map(|(joint, q)| joint.d.abs() + joint.a.abs() + q.abs());
    (placed(&robot.base) + placed(&robot.tool) + joints.sum::<f64>()).max(1.0)
}

/// The largest compliance in the description.
fn softest(robot: &Description) -> f64 {
    let joints = robot.joints.iter().map(Joint::compliance);
    let effects = robot.effects.iter().map(|effect| match *effect {
        Effect::TransverseCompliance { value, .. } => value,
        Effect::LinkCompliance { bending, torsion, .. } => bending.max(torsion),
        Effect::BaseCompliance { tilt, translation } => tilt.max(translation),
        Effect::ToolCompliance { rotation, translation } => rotation.max(translation),
        Effect::JointCoupling { value, .. } => value.abs(),
        Effect::StiffnessNonlinearity { added, .. } => added,
    });
    joints.chain(effects).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn generated_agrees_with_generic(
        robot in robot(),
        q in prop::collection::vec(-3.0..3.0_f64, 8),
        wrench in prop::array::uniform6(-1000.0..1000.0_f64),
    ) {
        let q = &q[..robot.joints.len()];
        match robot.joints.len() {
            1 => compare::<1>(&robot, q, &wrench)?,
            2 => compare::<2>(&robot, q, &wrench)?,
            3 => compare::<3>(&robot, q, &wrench)?,
            4 => compare::<4>(&robot, q, &wrench)?,
            5 => compare::<5>(&robot, q, &wrench)?,
            6 => compare::<6>(&robot, q, &wrench)?,
            7 => compare::<7>(&robot, q, &wrench)?,
            _ => compare::<8>(&robot, q, &wrench)?,
        }
    }
}
