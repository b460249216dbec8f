//! A free turn about the tool's axis, planned along the path.

use core::f64::consts::TAU;

use nalgebra::{SVector, Unit, Vector3, Vector6};
use robstiff_robots::{Description, catalogue};

use super::stations::margin;
use super::steps::{Rank, follow};
use super::turn::FreeTurns;
use super::{Goal, Known, SolvedPath, ToolPath, Unreached, stations};
use crate::inverse::Inverse;
use robstiff::{Generic, Robot};

/// A KR 270 with a spindle across its last axis: a turn about the tool's axis moves all joints.
fn with_spindle() -> (Description, Generic<6>) {
    let text = catalogue::find("kuka-kr270-r2700").unwrap();
    let text = format!("{text}\ntool: {{xyz: [250 mm, 0, 180 mm], rpy: [0, 90 deg, 0]}}\n");
    let description = Description::parse("spindle.yaml", &text).unwrap();
    let robot = Generic::new(&description).unwrap();
    (description, robot)
}

/// A row for each point: the tip goes round a circle (m), the tool leans outwards by an angle (deg).
fn cone(center: [f64; 3], radius: f64, lean: f64, turns: f64, count: usize, sign: f64) -> String {
    let (sin, cos) = lean.to_radians().sin_cos();
    let rows = (0..=count).map(|k| {
        let (y, x) = (TAU * turns * k as f64 / count as f64).sin_cos();
        let at = [center[0] + radius * x, center[1] + radius * y, center[2]];
        let [u, v, w] = [sin * x, sin * y, -cos].map(|part| sign * part);
        format!("{},{},{},{u},{v},{w}\n", at[0], at[1], at[2])
    });
    format!("x,y,z,ux,uy,uz\n{}", rows.collect::<String>())
}

fn read(text: &str, description: &Description, axis: Unit<Vector3<f64>>) -> ToolPath {
    ToolPath::parse("path.csv", text, description, axis).unwrap()
}

/// The least margin (deg, ten at most) along a path.
fn least(robot: &Generic<6>, q: impl Iterator<Item = SVector<f64, 6>>) -> u8 {
    let inverse = Inverse::new(robot);
    q.map(|q| margin(&inverse, &q)).min().unwrap()
}

fn postures(solved: &SolvedPath<6>) -> impl Iterator<Item = SVector<f64, 6>> {
    solved.points.iter().map(|point| point.q)
}

/// Step by step joint 5 runs into its limit, from every turn at the first point.
#[test]
fn a_plan_keeps_away_from_a_limit_that_greed_runs_into() {
    let (description, robot) = with_spindle();
    let path = read(&cone([1.5, 0.0, 0.8], 0.05, 60.0, 1.0, 120, 1.0), &description, Vector3::z_axis());
    let greedy = path.stepwise(&robot, &Inverse::new(&robot), None);
    assert_eq!(least(&robot, greedy.postures.into_iter().map(Result::unwrap)), 0);
    let solved = path.solve(&robot, None).unwrap();
    assert!(solved.jumps.is_empty(), "{:?}", solved.jumps);
    assert_eq!(least(&robot, postures(&solved)), 10);
    for (point, of_path) in solved.points.iter().zip(&path.points) {
        let Goal::Tool(target) = &of_path.goal else { panic!("a pose") };
        let off = target.remaining(&point.pose);
        assert!(off.distance < 1e-9 && off.angle < 1e-9, "{off:?}");
    }
}

#[test]
fn a_plan_does_not_know_which_way_along_the_axis_is_named() {
    let (description, robot) = with_spindle();
    for (lean, turns) in [(60.0, 1.0), (45.0, -3.0), (0.0, 1.0)] {
        let solved = [1.0, -1.0].map(|sign| {
            let axis = if sign > 0.0 { Vector3::z_axis() } else { -Vector3::z_axis() };
            let text = cone([1.6, 0.2, 0.7], 0.05, lean, turns, 180, sign);
            read(&text, &description, axis).solve(&robot, None).unwrap()
        });
        let apart = postures(&solved[0]).zip(postures(&solved[1])).map(|(one, other)| (one - other).amax());
        assert!(apart.fold(0.0, f64::max) < 1e-9, "lean {lean}");
    }
}

/// A whole orientation leaves nothing to plan, and neither do five axes: it is bit by bit what steps give.
#[test]
fn what_is_not_free_is_not_planned() {
    let (description, robot) = with_spindle();
    let rows = (0..30).map(|k| format!("1.5,{},0.9,0,1,0.01,0\n", 0.01 * f64::from(k)));
    let path = read(&format!("x,y,z,qw,qx,qy,qz\n{}", rows.collect::<String>()), &description, Vector3::z_axis());
    let steps = path.stepwise(&robot, &Inverse::new(&robot), None);
    let solved = path.solve(&robot, None).unwrap();
    assert!(steps.postures.into_iter().map(Result::unwrap).eq(postures(&solved)));

    let description = Description::parse("rv130hsc", catalogue::find("rv130hsc").unwrap()).unwrap();
    let robot = Generic::<5>::new(&description).unwrap();
    let path = read(&cone([1.4, 0.0, 0.7], 0.05, 10.0, 1.0, 40, 1.0), &description, Vector3::x_axis());
    let steps = path.stepwise(&robot, &Inverse::new(&robot), None);
    let solved = path.solve(&robot, None).unwrap();
    assert!(steps.postures.into_iter().map(Result::unwrap).eq(solved.points.iter().map(|point| point.q)));
}

/// Tight cones, several times round: not all can be done without a change.
#[test]
fn a_plan_is_never_worse_than_steps() {
    let (description, robot) = with_spindle();
    for (lean, turns) in [(45.0, 3.0), (60.0, 2.0), (75.0, -2.0)] {
        let path = read(&cone([1.6, 0.2, 0.7], 0.03, lean, turns, 200, 1.0), &description, Vector3::z_axis());
        let steps = path.stepwise(&robot, &Inverse::new(&robot), None);
        let solved = path.solve(&robot, None).unwrap();
        let inverse = Inverse::new(&robot);
        let free = FreeTurns::of(&path.points, inverse.scale(), &Known::default()).unwrap();
        let again = follow(&robot, &path.points, |i, _| Ok(solved.points[i].q));
        let [rank, greedy] = [again, steps].map(|of| Rank::of(&of, &robot, &inverse, &free));
        assert!(rank <= greedy && rank.changes_and_nearer() <= (1, 9), "lean {lean}: {rank:?} {greedy:?}");
    }
}

#[test]
fn a_plan_begins_where_it_is_told() {
    let (description, robot) = with_spindle();
    let path = read(&cone([1.5, 0.0, 0.8], 0.05, 60.0, 1.0, 120, 1.0), &description, Vector3::z_axis());
    let Goal::Tool(first) = &path.points[0].goal else { panic!("a pose") };
    let inverse = Inverse::new(&robot);
    for start in inverse.all(first, &SVector::zeros()).unwrap().into_iter().step_by(40) {
        let solved = path.solve(&robot, Some(&start)).unwrap();
        assert!((solved.points[0].q - start).amax() < 1e-8, "{start}");
    }
}

/// Without speeds the joints move least; with a slow last joint, another shares its work.
#[test]
fn a_joint_that_is_too_slow_has_less_to_do() {
    let (description, robot) = with_spindle();
    let text = cone([1.5, 0.0, 0.8], 0.05, 60.0, 1.0, 120, 1.0);
    let text = text.lines().map(|line| format!("{line},0.02\n")).collect::<String>();
    let text = text.replacen("uz,0.02", "uz,feed", 1);
    let path = read(&text, &description, Vector3::z_axis());
    // How long the fastest joint lags behind the feed (s).
    let late = |solved: &SolvedPath<6>, speeds: &[f64]| {
        let ways = solved.points.windows(2).map(|pair| {
            let needed = (0..6).map(|i| (pair[1].q[i] - pair[0].q[i]).abs() / speeds[i]).fold(0.0, f64::max);
            (needed - (pair[1].s - pair[0].s) / 0.02).max(0.0)
        });
        ways.sum::<f64>()
    };
    let speeds = [1.0, 1.0, 1.0, 0.6, 1.0, 0.3];
    let [free, bound] = [&[][..], &speeds].map(|known| {
        let known = Known { speeds: known, ..Known::default() };
        late(&path.solve_knowing(&robot, None, &known).unwrap(), &speeds)
    });
    assert!(free > 0.5 && bound < 0.5 * free, "{free} {bound}");
}

/// A KR 270 with a spindle on a rail along the base's y, or on a turntable about its z.
fn carried(by: &str) -> (Description, Generic<7>) {
    let text = catalogue::find("kuka-kr270-r2700").unwrap();
    let (base, row) = match by {
        "rail" => ("base: {rpy: [-90 deg, 0, 0]}", "{type: prismatic, alpha: -90 deg, limits: [-2 m, 2 m]}"),
        _ => ("base: {rpy: [180 deg, 0, 0]}", "{a: 300 mm, limits: [-170 deg, 170 deg]}"),
    };
    let text =
        text.replace("base: {rpy: [180 deg, 0, 0]}", base).replace("joints:\n", &format!("joints:\n  - {row}\n"));
    let text = format!("{text}\ntool: {{xyz: [250 mm, 0, 180 mm], rpy: [0, 90 deg, 0]}}\n");
    let description = Description::parse("carried.yaml", &text).unwrap_or_else(|problems| panic!("{problems}"));
    let robot = Generic::new(&description).unwrap();
    (description, robot)
}

/// A cut that is longer than the arm reaches, and one that is not: the axis that carries it goes as far as is needed.
#[test]
fn a_rail_and_a_turntable_are_planned_with_the_turn() {
    for by in ["rail", "table"] {
        let (description, robot) = carried(by);
        let inverse = Inverse::new(&robot);
        assert!(inverse.takes_every_turn(), "{by}");
        for length in [if by == "rail" { 5.0 } else { 3.4 }, 0.4] {
            let row = |k: usize| match by {
                "rail" => format!("1.7,{},0.8,0,0,-1\n", length * (k as f64 / 100.0 - 0.5)),
                _ => {
                    let (y, x) = (length * (k as f64 / 100.0 - 0.5)).sin_cos();
                    format!("{},{},0.8,0,0,-1\n", 1.9 * x, 1.9 * y)
                }
            };
            let text = format!("x,y,z,ux,uy,uz\n{}", (0..=100).map(row).collect::<String>());
            let path = read(&text, &description, Vector3::z_axis());
            let solved = path.solve(&robot, None).unwrap_or_else(|unsolved| panic!("{by} {length}: {unsolved}"));
            assert!(solved.jumps.is_empty(), "{by} {length}: {:?}", solved.jumps);
            let margins = solved.points.iter().map(|point| margin(&inverse, &point.q));
            assert_eq!(margins.min(), Some(10), "{by} {length}");
            for (point, of_path) in solved.points.iter().zip(&path.points) {
                let Goal::Tool(target) = &of_path.goal else { panic!("a pose") };
                let off = target.remaining(&point.pose);
                assert!(off.distance < 1e-9 && off.angle < 1e-9, "{off:?}");
            }
            // Smoothly, and not more than the path is long.
            let first = |i: usize| solved.points[i].q[0];
            let moved: f64 = (1..=100).map(|i| (first(i) - first(i - 1)).abs()).sum();
            let most = (1..=100).map(|i| (first(i) - first(i - 1)).abs()).fold(0.0, f64::max);
            assert!(by != "rail" || length < 1.0 || moved > 0.5, "{moved}");
            assert!(moved <= 1.2 * length && most < 0.1 * length.max(1.0), "{by} {length}: {moved} {most}");
        }
    }
}

/// Of turns that keep clear of limits alike, those at which the force pushes the tool off less.
#[test]
fn a_plan_that_knows_the_force_is_stiffer() {
    let (description, robot) = with_spindle();
    let rows = (0..60).map(|k| format!("{},{},0.9,0,0,-1\n", 1.4 + 0.003 * f64::from(k), 0.01 * f64::from(k) - 0.3));
    let path = read(&format!("x,y,z,ux,uy,uz\n{}", rows.collect::<String>()), &description, Vector3::z_axis());
    let force = Vector6::new(400.0, -300.0, 100.0, 0.0, 0.0, 0.0);
    let forces = vec![force; path.points.len()];
    let [blind, seeing] = [&[][..], &forces].map(|forces| {
        let solved = path.solve_knowing(&robot, None, &Known { forces, ..Known::default() }).unwrap();
        assert!(solved.jumps.is_empty() && least(&robot, postures(&solved)) == 10);
        let off = postures(&solved).map(|q| robot.deflection(&q, &force).fixed_rows::<3>(0).norm_squared());
        (off.sum::<f64>() / path.points.len() as f64).sqrt()
    });
    assert!(seeing < 0.95 * blind, "{seeing} {blind}");
    // An arm that does not yield is planned as without a force.
    let rigid = Generic::<6>::new(&{
        let mut rigid = description.clone();
        rigid.joints.iter_mut().for_each(|joint| joint.compliance.clear());
        rigid
    });
    let rigid = rigid.unwrap();
    let with = path.solve_knowing(&rigid, None, &Known { forces: &forces, ..Known::default() }).unwrap();
    assert_eq!(with, path.solve(&rigid, None).unwrap());
}

#[test]
fn points_out_of_reach_are_all_named_where_a_turn_is_free() {
    let (description, robot) = with_spindle();
    let text = cone([1.5, 0.0, 0.8], 0.05, 60.0, 0.5, 60, 1.0);
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for line in [1, 20, 21, 61] {
        lines[line] = lines[line].replacen("1.", "9.", 1);
    }
    let far = read(&lines.join("\n"), &description, Vector3::z_axis());
    let unsolved = far.solve(&robot, None).unwrap_err();
    assert_eq!(unsolved.points.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [2, 21, 22, 62], "{unsolved}");
    assert!(unsolved.points.iter().all(|(_, why)| matches!(why, Unreached::OutOfReach { .. })), "{unsolved}");
}

/// One point has no way: of the turns that are far enough from everything the nearest to the middle.
#[test]
fn a_single_point_is_solved() {
    let (description, robot) = with_spindle();
    let path = read("x,y,z,ux,uy,uz\n1.5,0.1,0.8,0,0.2,-1\n", &description, Vector3::z_axis());
    let solved = path.solve(&robot, None).unwrap();
    assert_eq!((solved.points.len(), least(&robot, postures(&solved))), (1, 10));
}

#[test]
fn turns_are_measured_from_a_reference_that_does_not_spin() {
    let (description, _) = with_spindle();
    // Through the vertical, where a projected direction would turn round.
    let rows = (-20..=20).map(|k| format!("1.5,0,0.8,{},0.0001,-1\n", 0.05 * f64::from(k)));
    let path = read(&format!("x,y,z,ux,uy,uz\n{}", rows.collect::<String>()), &description, Vector3::z_axis());
    let free = FreeTurns::of(&path.points, 0.5, &Known::default()).unwrap();
    let mut last: Option<nalgebra::Rotation3<f64>> = None;
    for point in 0..path.points.len() {
        let super::Orientation::Full(rotation) = free.target(point, 0.7).orientation else { panic!("a pose") };
        let pose = rotation.to_homogeneous();
        assert!((free.turn_of(point, &pose) - 0.7).abs() < 1e-12);
        let Goal::Tool(target) = &path.points[point].goal else { panic!("a pose") };
        assert!(target.apart(&pose).1.norm() < 1e-12);
        // No more than the axis turns by, 2.9 degrees at most.
        assert!(last.is_none_or(|last| last.angle_to(&rotation) < 0.0501), "{point}");
        last = Some(rotation);
    }
    let progress = free.progress();
    assert!((progress[40] - 2.0 * 1.0_f64.atan()).abs() < 1e-3, "{progress:?}");
}

#[test]
fn stations_are_a_step_apart_and_at_both_ends_of_long_chords() {
    let progress = [0.0, 0.1, 0.15, 0.2, 0.25, 0.9, 0.95, 1.0];
    assert_eq!(stations::points(&progress, 1), [0, 2, 4, 5, 7]);
    assert_eq!(stations::points(&[0.0], 1), [0]);
    assert_eq!(stations::points(&[0.0, 0.0], 1), [0, 1]);
}
