use nalgebra::{SVector, Vector3, Vector6};

use super::read::{Over, Positions, Task};
use super::{Axis, CartesianSpace, JointSpace, Measure, Space, Tool, best_placement, stream};
use robstiff::analysis::principal_directions;
use robstiff::robots::{Description, catalogue};
use robstiff::{Generic, Robot};

robstiff::robot!("rv130hsc.yaml");

fn description(file: &str) -> Description {
    Description::parse(file, catalogue::find(file).unwrap()).unwrap()
}

fn axes() -> [Axis; 5] {
    // More than a chunk, and no multiple of it.
    [
        Axis::angles("q1", -1.0, 2.0, 41),
        Axis::angles("q2", -0.9, 0.1, 37),
        Axis::angles("q3", 0.1, 0.8, 29),
        Axis::angles("q4", 0.3, 0.3, 1),
        Axis::angles("q5", 0.9, 1.3, 2),
    ]
}

fn all<const N: usize>(robot: &(impl Robot<N> + Sync), space: &impl Space<N>, measure: &Measure) -> Vec<Vec<f64>> {
    let mut columns = std::vec![Vec::new(); measure.columns().len()];
    let summary = stream(
        robot,
        space,
        measure,
        |chunk| chunk.clone(),
        |chunk| {
            assert_eq!(chunk.cells.start, columns[0].len());
            for (all, column) in columns.iter_mut().zip(chunk.columns) {
                all.extend(column);
            }
            Ok::<(), ()>(())
        },
    );
    let (summary, figures) = (summary.unwrap(), &columns[0]);
    assert_eq!((summary.cells, summary.unreachable), (space.cells(), 0));
    let (low, high) = figures.iter().fold((f64::MAX, 0.0_f64), |(low, high), &x| (low.min(x), high.max(x)));
    let (best, worst) = (summary.best.unwrap(), summary.worst.unwrap());
    assert_eq!([best.values[0], worst.values[0]], if measure.worse_is_larger() { [low, high] } else { [high, low] });
    assert_eq!([figures[best.cell], figures[worst.cell]], [best.values[0], worst.values[0]]);
    let mean = figures.iter().sum::<f64>() / figures.len() as f64;
    assert!((summary.mean - mean).abs() < 1e-12 * mean);
    columns
}

#[test]
fn cells_are_what_the_reference_says_there() {
    let generic = Generic::<5>::new(&description("rv130hsc.yaml")).unwrap();
    let (axes, mut tables) = (axes(), Vec::new());
    let space = JointSpace::new(&axes, &mut tables);
    let wrench = Vector6::new(300.0, -500.0, 700.0, 4.0, -6.0, 8.0);
    let deviation = all(&Rv130hsc, &space, &Measure::Deviation(wrench));
    let any = all(&Rv130hsc, &space, &Measure::AnyDirection(500.0));
    let compliance = all(&Rv130hsc, &space, &Measure::Compliance);
    for cell in (0..space.cells()).step_by(997) {
        let indices = space.indices(cell);
        let q = SVector::<f64, 5>::from_fn(|joint, _| axes[joint].values[indices[joint]]);
        let d = generic.deflection(&q, &wrench);
        let close = |one: f64, other: f64, size: f64| assert!((one - other).abs() < 1e-12 * size, "{one} {other}");
        close(deviation[0][cell], d.fixed_rows::<3>(0).norm(), d.norm());
        close(deviation[3][cell], d[2], d.norm());
        let h = generic.compliance(&q);
        let principal = principal_directions(&h).unwrap();
        close(any[0][cell], 500.0 * principal.compliances[0], any[0][cell]);
        close(compliance[0][cell] * principal.compliances[0], 1.0, 1.0);
        let weak = SVector::<f64, 3>::new(any[1][cell], any[2][cell], any[3][cell]);
        let along = weak.dot(&(h.fixed_view::<3, 3>(0, 0) * weak));
        close(along, principal.compliances[0], along);
        close(compliance[4 + 3][cell], h[(0, 3)], h.amax());
        close(compliance[4 + 20][cell], h[(5, 5)], h.amax());
    }
}

/// With backlash the slope without a load is several times that under one: the largest of
/// many directions is found, and none that was tried is larger.
#[test]
fn the_largest_deviation_is_that_under_the_force() {
    let own = catalogue::find("rv130hsc.yaml").unwrap();
    let laws = "effects:\n  - {kind: lost_motion, at: joint 2, gap: 200 urad, knee: 100 Nm}\n  \
                - {kind: stiffness_nonlinearity, at: joint 3, added: -1e-7, knee: 300 Nm}\n";
    let bent = Description::parse("bent.yaml", &std::format!("{own}{laws}")).unwrap();
    let generic = Generic::<5>::new(&bent).unwrap();
    let at = |name: &str, from: f64, to: f64, count| Axis::angles(name, from, to, count);
    let axes = [
        at("q1", 0.4, 0.4, 1),
        at("q2", -0.9, 0.1, 3),
        at("q3", 0.1, 0.8, 3),
        at("q4", 0.3, 0.3, 1),
        at("q5", 0.9, 0.9, 1),
    ];
    let mut tables = Vec::new();
    let space = JointSpace::new(&axes, &mut tables);
    let any = all(&generic, &space, &Measure::AnyDirection(500.0));
    let moved = |q: &SVector<f64, 5>, u: Vector3<f64>| {
        let force = u.normalize() * 500.0;
        generic.deflection(q, &Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0)).xyz().norm()
    };
    for (cell, &largest) in any[0].iter().enumerate() {
        let indices = space.indices(cell);
        let q = SVector::<f64, 5>::from_fn(|joint, _| axes[joint].values[indices[joint]]);
        let weak = Vector3::new(any[1][cell], any[2][cell], any[3][cell]);
        assert!((moved(&q, weak) / largest - 1.0).abs() < 1e-12);
        // Fibonacci's lattice on half a sphere, three degrees apart.
        let most = (0..2000).map(|k| {
            let (z, turn) = ((f64::from(k) + 0.5) / 2e3, f64::from(k) * 2.399_963);
            let radius = (1.0 - z * z).sqrt();
            moved(&q, Vector3::new(radius * turn.cos(), radius * turn.sin(), z))
        });
        let most = most.fold(0.0, f64::max);
        assert!(largest >= most && largest < 1.002 * most, "{largest} {most}");
        assert!(largest < 0.9 * 500.0 * principal_directions(&generic.compliance(&q)).unwrap().compliances[0]);
    }
}

/// An arm that turns about z and slides outwards: a force moves it only around z,
/// most where it acts around, by the compliance times the radius squared.
const POLAR: &str = "name: Polar\nconvention: standard\njoints:\n  \
    - {alpha: 90 deg, compliance: 2e-7 rad/Nm}\n  - {type: prismatic, limits: [0.4 m, 1.8 m]}\n";

#[test]
fn a_workpiece_is_put_where_a_simple_arm_is_stiffest() {
    let polar = Generic::<2>::new(&Description::parse("polar.yaml", POLAR).unwrap()).unwrap();
    let axes = [Axis::lengths("x", 0.5, 1.8, 14), Axis::lengths("y", -0.5, 0.5, 11), Axis::lengths("z", 0.0, 0.0, 1)];
    let tool = Tool { axis: Vector3::y_axis(), direction: Vector3::z_axis(), turns: Vec::new() };
    let space = CartesianSpace::new(&polar, axes.clone(), tool);
    let measure = Measure::AnyDirection(500.0);
    let mut columns = std::vec![Vec::new(); 4 + 2];
    let summary = stream(
        &polar,
        &space,
        &measure,
        |chunk| chunk.columns.clone(),
        |chunk| {
            for (all, column) in columns.iter_mut().zip(chunk) {
                all.extend(column);
            }
            Ok::<(), ()>(())
        },
    );
    let radius = |cell: usize| {
        let at = space.indices(cell);
        axes[0].values[at[0]].hypot(axes[1].values[at[1]])
    };
    let mut missed = 0;
    for cell in 0..space.cells() {
        let (radius, deviation) = (radius(cell), columns[0][cell]);
        if radius > 1.8 + 1e-9 {
            assert!(columns.iter().all(|column| column[cell].is_nan()), "{radius}");
            missed += 1;
        } else {
            assert!((deviation - 500.0 * 2e-7 * radius * radius).abs() < 1e-12, "{radius}: {deviation}");
            assert!((columns[5][cell].abs() - radius).abs() < 1e-9);
        }
    }
    assert_eq!(summary.unwrap().unreachable, missed);
    let best = best_placement(&axes, &columns[0], [0.3, 0.2, 0.0], &measure).unwrap();
    let near = |one: [f64; 3], other: [f64; 3]| one.iter().zip(other).all(|(one, other)| (one - other).abs() < 1e-9);
    assert!(near(best.corner, [0.5, -0.1, 0.0]) && best.span == [4, 3, 1], "{best:?}");
    assert!((best.worst - 500.0 * 2e-7 * (0.8 * 0.8 + 0.1 * 0.1)).abs() < 1e-12);
    // Too large for the map, and too large for the arm.
    assert_eq!(best_placement(&axes, &columns[0], [1.6, 0.2, 0.0], &measure), None);
    assert_eq!(best_placement(&axes, &columns[0], [1.3, 0.2, 0.0], &measure), None);
}

#[test]
fn the_best_turn_is_no_worse_than_any() {
    let arm = Generic::<6>::new(&description("kuka-kr270-r2700.yaml")).unwrap();
    let axes = [Axis::lengths("x", 1.4, 2.0, 3), Axis::lengths("y", 0.2, 0.2, 1), Axis::lengths("z", 0.6, 0.6, 1)];
    let measure = Measure::Deviation(Vector6::new(0.0, 400.0, 0.0, 0.0, 0.0, 0.0));
    let with = |turns: &[f64]| {
        let tool = Tool { axis: Vector3::z_axis(), direction: -Vector3::z_axis(), turns: turns.to_vec() };
        let space = CartesianSpace::new(&arm, axes.clone(), tool);
        space.compute(&arm, &measure, 0..3)
    };
    let turns = [0.0, 0.7, 1.4];
    let (best, single) = (with(&turns), turns.map(|turn| with(&[turn])));
    for cell in 0..3 {
        let least = single.iter().map(|columns| columns[0][cell]).fold(f64::MAX, f64::min);
        assert!((best[0][cell] - least).abs() < 1e-12, "{cell}");
        // The turn and the joints are those of that pose.
        let q = SVector::<f64, 6>::from_fn(|joint, _| best[5 + joint][cell]);
        let pose = arm.transform(&q);
        assert!((pose[(0, 3)] - axes[0].values[cell]).abs() < 1e-9 && (pose[(2, 2)] + 1.0).abs() < 1e-9);
        assert!(
            (arm.deflection(&q, &Vector6::new(0.0, 400.0, 0.0, 0.0, 0.0, 0.0)).fixed_rows::<3>(0).norm() - least).abs()
                < 1e-12
        );
        assert!(turns.contains(&best[4][cell]));
    }
}

/// Another posture than the one nearest to the middle of the joints' ranges: elbow
/// down, 1.120 N/um where elbow up has 0.773.
#[test]
fn five_axes_take_their_best_posture() {
    let arm = Generic::<5>::new(&description("rv130hsc.yaml")).unwrap();
    let axes = [Axis::lengths("x", 1.0, 1.1, 2), Axis::lengths("y", 0.0, 0.0, 1), Axis::lengths("z", 0.6, 0.6, 1)];
    let tool = Tool { axis: Vector3::x_axis(), direction: -Vector3::z_axis(), turns: Vec::new() };
    let columns = CartesianSpace::new(&arm, axes, tool).compute(&arm, &Measure::Compliance, 0..2);
    let down = SVector::<f64, 5>::new(0.0, 3.017_302_543_079, -3.938_736_027_099, 0.0, -2.220_159_169_569);
    let pose = arm.transform(&down);
    assert!((pose.fixed_view::<3, 1>(0, 3) - Vector3::new(1.0, 0.0, 0.6)).norm() < 1e-9, "{pose}");
    let stiffness = principal_directions(&arm.compliance(&down)).unwrap().compliances[0].recip();
    assert!(columns[0][0] > stiffness * (1.0 - 1e-9), "{} {stiffness}", columns[0][0]);
}

/// A frame that is aside and turned: the tool stands where and as it says there.
#[test]
fn a_plane_may_lie_anywhere() {
    let arm = Generic::<6>::new(&description("kuka-kr270-r2700.yaml")).unwrap();
    let text = "positions:\n  frame: {xyz: [1.5 m, 0.2 m, 0.9 m], rpy: [0, 50 deg, 20 deg]}\n  \
        x: {from: -100 mm, to: 150 mm, count: 3}\n  y: {from: -200 mm, to: 200 mm, count: 2}\n  z: 50 mm\n\
        tool: {direction: [0, 0, -1], turn: {from: -30 deg, to: 30 deg, count: 2}}\nmeasure: stiffness\n";
    let task = Task::parse("plane.yaml", text, &description("kuka-kr270-r2700.yaml")).unwrap();
    let Over::Positions(positions) = &task.over else { panic!("{task:?}") };
    let Positions { frame, axes, tool } = positions.as_ref();
    let space = CartesianSpace::new(&arm, axes.clone(), tool.clone()).in_frame(*frame);
    let columns = space.compute(&arm, &task.measure, 0..space.cells());
    let (pitch, yaw) = (50_f64.to_radians(), 20_f64.to_radians());
    let poses = (0..space.cells()).map(|cell| SVector::<f64, 6>::from_fn(|joint, _| columns[5 + joint][cell]));
    for (cell, q) in poses.enumerate() {
        let at = space.indices(cell);
        let [x, y, z] = [0, 1, 2].map(|k| axes[k].values[at[k]]);
        // About y, then about z.
        let (along, up) = (x * pitch.cos() + z * pitch.sin(), z * pitch.cos() - x * pitch.sin());
        let expected = [1.5 + along * yaw.cos() - y * yaw.sin(), 0.2 + along * yaw.sin() + y * yaw.cos(), 0.9 + up];
        let pose = arm.transform(&q);
        let normal = [pitch.sin() * yaw.cos(), pitch.sin() * yaw.sin(), pitch.cos()];
        let (position, axis) = (pose.fixed_view::<3, 1>(0, 3), pose.fixed_view::<3, 1>(0, 2));
        assert!((position - Vector3::from(expected)).amax() < 1e-9, "{cell}: {pose}");
        assert!((axis + Vector3::from(normal)).amax() < 1e-9, "{cell}: {pose}");
    }
}

#[test]
fn a_moment_alone_is_a_load() {
    let read = |load: &str| {
        let text = format!("{load}joints: [0 deg, {{from: -80 deg, to: 60 deg, count: 3}}, 0 deg, 0 deg, 60 deg]\n");
        Task::parse("reach.yaml", &text, &description("rv130hsc.yaml")).map(|task| task.measure)
    };
    let moment = Measure::Deviation(Vector6::new(0.0, 0.0, 0.0, 10.0, 0.0, 20.0));
    assert_eq!(read("moment: [10 Nm, 0, 20 Nm]\n").unwrap(), moment);
    assert_eq!(read("measure: deviation\nmoment: [10 Nm, 0, 20 Nm]\n").unwrap(), moment);
    assert_eq!(read("").unwrap(), Measure::Stiffness);
    for load in
        ["force: 500 N\nmoment: [10 Nm, 0, 0]\n", "measure: deviation\n", "measure: stiffness\nmoment: [1 Nm, 0, 0]\n"]
    {
        assert!(read(load).is_err(), "{load}");
    }
}

#[test]
fn ends_of_axes_are_met() {
    let axis = Axis::angles("q1", -0.1, 0.7, 29);
    assert_eq!((axis.values[0], axis.values[28], axis.values.len()), (-0.1, 0.7, 29));
    assert_eq!(Axis::lengths("x", 0.3, 0.9, 1).values, [0.3]);
    assert_eq!(Axis::lengths("x", 0.0, 0.3, 4).for_people(1), 100.0);
}
