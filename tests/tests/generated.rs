//! Generated code, compiled, against the robots that are read at run time:
//! every robot of the catalogue and arms with every effect, in both
//! conventions, in random poses, with both scalars.

use nalgebra::{Matrix4, Matrix6, SMatrix, SVector, Vector6};
use robstiff::{Generic, JointKind, Robot, State, Statics};
use robstiff_robots::catalogue::catalogue;
use robstiff_tests::arms::{FILES, description};
use robstiff_tests::for_every_arm;
use robstiff_tests::judge::{DOUBLE, SINGLE, Sizes, Tolerance, assert_close, blocks, trials};

const POSES: usize = 1000;

/// What is left of a load on the way back from it.
const BACK: f64 = -0.25;

for_every_arm!(states_the_facts);
for_every_arm!(agrees);
for_every_arm!(agrees_in_single_precision);

#[test]
fn the_whole_catalogue_is_judged() {
    for (file, _) in catalogue() {
        assert!(FILES.contains(file), "{file} is missing in robstiff_tests::arms");
    }
}

fn generic<const N: usize>(file: &str) -> Generic<N> {
    Generic::new(&description(file)).expect("as many joints as the generated robot")
}

fn states_the_facts<const N: usize, R: Robot<N>>(robot: R, file: &str) {
    let generic = generic::<N>(file);
    assert_eq!(robot.name(), generic.name());
    assert_eq!(robot.convention(), generic.convention());
    assert_eq!(robot.joint_kinds(), generic.joint_kinds());
    assert_eq!(robot.joint_compliance(), generic.joint_compliance());
    assert_eq!(robot.limits(), generic.limits());
    assert_eq!(robot.effects(), generic.effects());
    assert!((robot.base() - generic.base()).amax() < 1e-15);
    assert!((robot.tool() - generic.tool()).amax() < 1e-15);
}

fn agrees<const N: usize, R: Robot<N>>(robot: R, file: &str) {
    let (description, generic) = (description(file), generic::<N>(file));
    let far = many_turns(generic.joint_kinds(), 3, 300);
    for (at, q, wrench) in trials::<N>(POSES, 1).map(|(q, wrench)| (q, q, wrench)).chain(far) {
        let sizes = Sizes::of(&description, at.as_slice());
        let (found, expected) = (All::of(&robot, &q, &wrench), All::of(&generic, &q, &wrench));
        found.assert_close(&expected, &sizes, &wrench, DOUBLE);
        let Statics { transform, jacobian, compliance } = robot.statics(&q);
        let together = All { transform, jacobian, compliance, ..found };
        together.assert_close(&expected, &sizes, &wrench, DOUBLE);
        let one_by_one = All { compliance: by_entries(&robot, &q), ..together };
        one_by_one.assert_close(&expected, &sizes, &wrench, DOUBLE);
    }
}

/// Random trials with some joints turned further, by up to `10^digits` rad. The first of a
/// trial's coordinates are within +-3, which a robot is as large as.
fn many_turns<const N: usize>(
    kinds: [JointKind; N],
    seed: u64,
    digits: i32,
) -> impl Iterator<Item = (SVector<f64, N>, SVector<f64, N>, Vector6<f64>)> {
    (0..).zip(trials::<N>(POSES / 4, seed)).map(move |(trial, (at, wrench))| {
        let further = |i: usize| match (kinds[i], (trial + 5 * i) % 4) {
            (JointKind::Prismatic, _) | (_, 0) => at[i],
            // Coordinates of the same size, and of any.
            (_, 1) => at[i] * 10_f64.powi(1 + (trial as i32 % digits)),
            _ => at[i] * 10_f64.powi(((trial * 37 + i * 101) as i32) % digits),
        };
        (at, SVector::from_fn(|i, _| further(i)), wrench)
    })
}

/// The compliance from the entries that are handed over one by one.
fn by_entries<const N: usize>(robot: &impl Robot<N>, q: &SVector<f64, N>) -> Matrix6<f64> {
    let mut entries = [None; 21];
    robot.compliance_entries(q, |place, entry| assert_eq!(entries[place].replace(entry), None, "entry {place} twice"));
    let mut entries = entries.map(|entry| entry.expect("every entry is handed over")).into_iter();
    let mut compliance = Matrix6::zeros();
    for i in 0..6 {
        for j in i..6 {
            compliance[(i, j)] = entries.next().expect("21 entries");
            compliance[(j, i)] = compliance[(i, j)];
        }
    }
    compliance
}

/// Generated `f32` code against the generic robot in `f64`, at the same inputs.
fn agrees_in_single_precision<const N: usize, R: Robot<N>>(robot: R, file: &str) {
    let (description, generic) = (description(file), generic::<N>(file));
    let far = many_turns(generic.joint_kinds(), 4, 37);
    for (at, q, wrench) in trials::<N>(POSES, 2).map(|(q, wrench)| (q, q, wrench)).chain(far) {
        let (q, wrench) = (q.map(|x| x as f32), wrench.map(|x| x as f32));
        let mut state = State::new();
        robot.deflection_with(&q, &wrench, &mut state);
        let back = robot.deflection_with(&q, &(wrench * BACK as f32), &mut state).map(f64::from);
        let found = All {
            back,
            state: State { plays: state.plays.map(|plays| plays.map(f64::from)) },
            transform: robot.transform(&q).map(f64::from),
            link_frames: robot.link_frames(&q).map(|frame| frame.map(f64::from)),
            jacobian: robot.jacobian(&q).map(f64::from),
            compliance: robot.compliance(&q).map(f64::from),
            deflection: robot.deflection(&q, &wrench).map(f64::from),
            joint_torques: robot.joint_torques(&q, &wrench).map(f64::from),
        };
        let (q, wrench) = (q.map(f64::from), wrench.map(f64::from));
        let sizes = Sizes::of(&description, at.as_slice());
        found.assert_close(&All::of(&generic, &q, &wrench), &sizes, &wrench, SINGLE);
    }
}

/// Everything that a robot calculates in one pose.
struct All<const N: usize> {
    transform: Matrix4<f64>,
    link_frames: [Matrix4<f64>; N],
    jacobian: SMatrix<f64, 6, N>,
    compliance: Matrix6<f64>,
    deflection: Vector6<f64>,
    joint_torques: SVector<f64, N>,
    back: Vector6<f64>,
    state: State<N>,
}

impl<const N: usize> All<N> {
    fn of<R: Robot<N>>(robot: &R, q: &SVector<f64, N>, wrench: &Vector6<f64>) -> Self {
        let mut state = State::new();
        robot.deflection_with(q, wrench, &mut state);
        let back = robot.deflection_with(q, &(wrench * BACK), &mut state);
        Self {
            back,
            state,
            transform: robot.transform(q),
            link_frames: robot.link_frames(q),
            jacobian: robot.jacobian(q),
            compliance: robot.compliance(q),
            deflection: robot.deflection(q, wrench),
            joint_torques: robot.joint_torques(q, wrench),
        }
    }

    fn assert_close(&self, expected: &Self, sizes: &Sizes, wrench: &Vector6<f64>, tolerance: Tolerance) {
        let close = |name: &str, found: &[f64], expected: &[f64], size: f64| {
            assert_close(name, found, expected, size, tolerance);
        };
        frames_close("transform", &self.transform, &expected.transform, sizes, tolerance);
        for (i, (found, expected)) in self.link_frames.iter().zip(&expected.link_frames).enumerate() {
            frames_close(&format!("link frame {}", i + 1), found, expected, sizes, tolerance);
        }
        for (name, row, size) in [("translation", 0, sizes.reach), ("rotation", 3, 1.0)] {
            let rows =
                |jacobian: &SMatrix<f64, 6, N>| jacobian.fixed_rows::<3>(row).iter().copied().collect::<Vec<_>>();
            close(&format!("jacobian, {name}"), &rows(&self.jacobian), &rows(&expected.jacobian), size);
        }
        let (found, known) = (blocks(&self.compliance), blocks(&expected.compliance));
        for (k, size) in sizes.compliance().into_iter().enumerate() {
            close(&format!("compliance, block {k}"), &found[k], &known[k], size);
        }
        let torque = sizes.torque(wrench);
        let (found, known) = (self.deflection.as_slice(), expected.deflection.as_slice());
        close("displacement", &found[..3], &known[..3], sizes.softest * sizes.reach * torque);
        close("rotation", &found[3..], &known[3..], sizes.softest * torque);
        let (found, known) = (self.back.as_slice(), expected.back.as_slice());
        close("displacement on the way back", &found[..3], &known[..3], sizes.softest * sizes.reach * torque);
        close("rotation on the way back", &found[3..], &known[3..], sizes.softest * torque);
        close("play operators", self.state.plays.as_flattened(), expected.state.plays.as_flattened(), torque);
        close("joint torques", self.joint_torques.as_slice(), expected.joint_torques.as_slice(), torque);
    }
}

fn frames_close(name: &str, found: &Matrix4<f64>, expected: &Matrix4<f64>, sizes: &Sizes, tolerance: Tolerance) {
    let turn = |frame: &Matrix4<f64>| frame.fixed_view::<3, 3>(0, 0).iter().copied().collect::<Vec<_>>();
    let origin = |frame: &Matrix4<f64>| frame.fixed_view::<3, 1>(0, 3).iter().copied().collect::<Vec<_>>();
    assert_close(&format!("turn of {name}"), &turn(found), &turn(expected), 1.0, tolerance);
    assert_close(&format!("origin of {name}"), &origin(found), &origin(expected), sizes.reach, tolerance);
    assert_eq!(found.row(3), expected.row(3), "{name}");
}
