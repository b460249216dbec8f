use nalgebra::{Matrix3, SVector, Unit, Vector3, Vector6};
use robstiff_robots::{Description, catalogue};

use super::*;
use crate::compensation::{Keep, compensate};
use crate::milling::{Cut, CutFile, Direction, Engagement, ForceFrame, Forces, MeasuredForce};
use crate::path::ToolPath;
use robstiff::elements::Element;
use robstiff::{Effect, Generic, Robot, State, with_robot};
use robstiff_robots::samples;

pub fn described(name: &str) -> Description {
    Description::parse(name, catalogue::find(name).unwrap()).unwrap()
}

/// A rectangular pocket of 300 mm by 200 mm, a point every 20 mm, the tool down.
pub fn pocket() -> String {
    let mut text = String::from("x [mm],y [mm],z [mm],ux,uy,uz\n");
    let mut at = [1400, -100];
    for (axis, way, steps) in [(0, 20, 15), (1, 20, 10), (0, -20, 15), (1, -20, 10)] {
        for _ in 0..steps {
            text += &format!("{},{},600,0,0,-1\n", at[0], at[1]);
            at[axis] += way;
        }
    }
    text
}

pub fn solved<const N: usize>(name: &str, axis: Unit<Vector3<f64>>) -> (Generic<N>, ToolPath, SolvedPath<N>) {
    let description = described(name);
    let robot = Generic::new(&description).unwrap();
    let path = ToolPath::parse("pocket.csv", &pocket(), &description, axis).unwrap();
    let solved = path.solve(&robot, None).unwrap();
    (robot, path, solved)
}

/// Aluminium, along a wall.
pub fn cut(depth: &str, speed: &str, feed: &str) -> Cut {
    let text = format!(
        "tool: {{diameter: 20 mm, teeth: 4, helix: 30 deg}}\nmaterial: al7075-t6\nmilling: down\nwidth: 8 mm\n\
         depth: {depth}\nfeed: {feed}\nspeed: {speed}\n"
    );
    match CutFile::parse("cut.yaml", &text, std::path::Path::new("")).unwrap().forces {
        Forces::Model(cut) => cut,
        Forces::Measured { .. } => panic!("a model"),
    }
}

fn table(text: &str) -> Result<ForceTable, String> {
    ForceTable::parse("forces.csv", text).map_err(|problems| problems.to_string())
}

#[test]
fn a_force_displaces_as_the_robot_says() {
    let (robot, _, path) = solved::<5>("rv130hsc", Vector3::x_axis());
    let mut text = String::from("Fx [N],Fy [N],Fz [N],My [Nm]\n");
    (0..path.points.len()).for_each(|i| text += &format!("{},-200,300,{i}\n", 10 * i));
    let load = table(&text).unwrap().load(&path, ForceFrame::Base, Vector3::x_axis(), Surface::Side).unwrap();
    let found = Deviation::of(&robot, &path, &load).unwrap();
    assert_eq!(found.points.len(), path.points.len());
    for (i, (point, found)) in path.points.iter().zip(&found.points).enumerate() {
        let wrench = Vector6::new(10.0 * i as f64, -200.0, 300.0, 0.0, i as f64, 0.0);
        let expected = robot.deflection(&point.q, &wrench);
        assert!((found.displacement - expected).norm() < 1e-9 * expected.norm() + 1e-15, "{found:?} {expected}");
        let shift = expected.fixed_rows::<3>(0).into_owned();
        let feed = point.tangent.unwrap().into_inner();
        let normal = feed.cross(&-Vector3::z());
        let expected = Vector3::new(shift.dot(&feed), shift.dot(&normal), -shift.z);
        assert!((found.components.unwrap() - expected).norm() < 1e-9 * shift.norm());
        assert!((found.error.unwrap() - expected.y).abs() < 1e-9 * shift.norm());
    }
    let face = table(&text).unwrap().load(&path, ForceFrame::Base, Vector3::x_axis(), Surface::Face).unwrap();
    let found = Deviation::of(&robot, &path, &face).unwrap();
    assert!(found.points.iter().all(|point| (point.error.unwrap() + point.displacement.z).abs() < 1e-12));
}

#[test]
fn arm_and_cut_settle_where_both_agree() {
    let (robot, _, path) = solved::<6>("kuka-kr270-r2700", Vector3::z_axis());
    let cut = cut("3 mm", "9000 rpm", "0.15 mm/tooth");
    let load = load_of_cut(&Forces::Model(cut.clone()), &path, Vector3::z_axis(), Surface::Side);
    assert!(load.undirected.is_empty());
    let found = Deviation::of(&robot, &path, &load).unwrap();
    for (point, found) in path.points.iter().zip(&found.points) {
        let frame = crate::milling::CutFrame::new(&-Vector3::z(), &point.tangent.unwrap()).unwrap();
        let off = found.components.unwrap();
        assert!(off.norm() > 1e-6);
        // Down milling: the wall is at -normal, and the width grows that way.
        let engagement = Engagement::of_width(Direction::Down, width(&cut) - off.y, cut.mill.diameter).unwrap();
        let met = Cut { engagement, depth: cut.depth + off.z, ..cut.clone() };
        let wrench = frame.wrench(&met.mean_force());
        assert!((wrench - found.wrench).norm() < 1e-3 * wrench.norm(), "{wrench} {}", found.wrench);
        assert!((robot.deflection(&point.q, &found.wrench) - found.displacement).norm() < 1e-11);
        assert!((found.error.unwrap() + off.y).abs() < 1e-15, "into the wall is against the normal");
    }
}

#[test]
fn a_force_that_grows_too_fast_pulls_the_tool_in() {
    let (robot, _, path) = solved::<6>("kuka-kr270-r2700", Vector3::z_axis());
    let mut load =
        load_of_cut(&Forces::Model(cut("3 mm", "9000 rpm", "0.15 mm/tooth")), &path, Vector3::z_axis(), Surface::Side);
    load.contacts[7].response = Matrix3::identity() * 1e9;
    let failed = Deviation::of(&robot, &path, &load).unwrap_err();
    assert_eq!(failed.lines, [path.points[7].line]);
}

/// The arm with backlash in its first joints, under conventional milling.
fn loose() -> (Generic<6>, SolvedPath<6>, Load) {
    let mut description = described("kuka-kr270-r2700");
    let path = ToolPath::parse("pocket.csv", &pocket(), &description, Vector3::z_axis()).unwrap();
    let (gap, knee) = (1.0_f64.to_radians() / 60.0, 20.0);
    description.effects = (1..=3).map(|joint| Effect::LostMotion { joint, gap, knee }).collect();
    let robot = Generic::new(&description).unwrap();
    let path = path.solve(&robot, None).unwrap();
    let cut = cut("2 mm", "9000 rpm", "0.1 mm/tooth");
    let engagement = Engagement::of_width(Direction::Up, 8e-3, cut.mill.diameter).unwrap();
    let load = load_of_cut(&Forces::Model(Cut { engagement, ..cut }), &path, Vector3::z_axis(), Surface::Side);
    (robot, path, load)
}

#[test]
fn arms_with_backlash_settle_where_they_are_stiff_under_the_cut() {
    let (robot, path, load) = loose();
    let found = Deviation::of(&robot, &path, &load).unwrap();
    for ((point, contact), found) in path.points.iter().zip(&load.contacts).zip(&found.points) {
        // Relaxation: slow, but it takes no slope.
        let mut off = Vector3::zeros();
        for _ in 0..500 {
            let force = contact.response * off;
            let wrench = contact.wrench + Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0);
            off += 0.5 * (robot.deflection(&point.q, &wrench).fixed_rows::<3>(0) - off);
        }
        assert!((found.displacement.fixed_rows::<3>(0) - off).norm() < 1e-9, "{off} {found:?}");
    }
}

#[test]
fn arms_with_backlash_are_corrected() {
    let (robot, path, load) = loose();
    let compensated = compensate(&robot, &path, &load, Keep::Pose).unwrap();
    assert!(compensated.points.iter().all(|point| point.remaining.distance < 1e-9));
}

#[test]
fn parts_sum_to_the_deflection_with_every_effect() {
    for file in ["every-effect.yaml", "every-law.yaml"] {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/robots");
        let description = Description::read(folder.join(file)).unwrap();
        assert!(!description.effects.is_empty());
        with_robot!(&description, |robot| sum(&robot));
    }
    fn sum<const N: usize>(robot: &Generic<N>) {
        let (mut one, mut other) = (State::new(), State::new());
        for (k, q) in samples::poses::<N>().map(SVector::from).enumerate() {
            let wrench = Vector6::from_fn(|i, _| 300.0 * f64::sin(1.3 * k as f64 + i as f64));
            let whole = robot.deflection_with(&q, &wrench, &mut one);
            let sum: Vector6<f64> = parts(robot, &q, &wrench, &mut other).map(|(_, part)| part).sum();
            assert!((sum - whole).norm() < 1e-12 * whole.norm(), "{sum} {whole}");
            assert_eq!(one, other);
        }
    }
}

#[test]
fn shares_of_the_error_sum_to_one_and_find_the_soft_joint() {
    let mut description = described("kuka-kr270-r2700");
    let path = ToolPath::parse("pocket.csv", &pocket(), &description, Vector3::z_axis()).unwrap();
    description.effects = samples::linear_effects();
    description.joints[0].compliance[0].value *= 20.0;
    let robot = Generic::<6>::new(&description).unwrap();
    let path = path.solve(&robot, None).unwrap();
    let forces = Forces::Model(cut("3 mm", "9000 rpm", "0.15 mm/tooth"));
    let load = load_of_cut(&forces, &path, Vector3::z_axis(), Surface::Side);
    let found = Deviation::of(&robot, &path, &load).unwrap();
    for picked in [0..50, 10..20] {
        let shares = blame(&robot, &path, &load, &found, |i| picked.contains(&i));
        assert_eq!(shares.len(), 6 + description.effects.len());
        assert!((shares.iter().map(|(_, share)| share).sum::<f64>() - 1.0).abs() < 1e-12);
        assert_eq!(shares[0].0, Element::Joint(1), "{shares:?}");
        assert!(shares[0].1 > 0.5 && shares.windows(2).all(|pair| pair[0].1 >= pair[1].1), "{shares:?}");
    }
    assert!(blame(&robot, &path, &load, &found, |_| false).is_empty());
}

#[test]
fn stretches_hold_and_break_a_tolerance() {
    let errors = [0.0, 4e-5, -2e-4, 3e-4, 5e-5, -1.1e-4];
    let points = errors.iter().enumerate().map(|(i, &error)| DeviationPoint {
        line: i + 2,
        s: 0.01 * i as f64,
        length: 0.01,
        wrench: Vector6::x(),
        displacement: Vector6::zeros(),
        components: None,
        error: Some(error),
        peak: None,
    });
    let deviation = Deviation { points: points.collect() };
    let stretches = deviation.stretches(1e-4);
    let told: Vec<_> = stretches.iter().map(|found| (found.lines, found.holds, found.worst.unwrap())).collect();
    assert_eq!(told, [([2, 3], true, 4e-5), ([4, 5], false, 3e-4), ([6, 6], true, 5e-5), ([7, 7], false, -1.1e-4)]);
    assert_eq!(stretches[1].s, [0.02, 0.03]);
    assert_eq!(deviation.errors().unwrap().worst, 3e-4);
    assert!(deviation.stretches(1e-3).iter().all(|stretch| stretch.holds));
}

#[test]
fn moves_without_force_do_not_dilute_the_errors() {
    let point = |force: f64, distance: f64| DeviationPoint {
        line: 2,
        s: 0.0,
        length: 0.01,
        wrench: Vector6::x() * force,
        displacement: Vector6::x() * distance,
        components: None,
        error: Some(-distance),
        peak: None,
    };
    let cut = [point(100.0, 3e-4), point(50.0, 1e-4)];
    let whole = Deviation { points: [&[point(0.0, 0.0); 6][..], &cut].concat() };
    let summary = Summary { mean: 2e-4, rms: 5e-8_f64.sqrt(), worst: 3e-4 };
    for (found, sign) in [(whole.distances().unwrap(), 1.0), (whole.errors().unwrap(), -1.0)] {
        assert!((found.mean - sign * summary.mean).abs() < 1e-18 && (found.rms - summary.rms).abs() < 1e-18);
        assert!((found.worst - sign * summary.worst).abs() < 1e-18, "{found:?}");
    }
    assert_eq!(whole.in_cut().count(), 2);
    let idle = Deviation { points: [point(0.0, 1e-4); 2].into() };
    assert_eq!((idle.distances(), idle.errors()), (None, None));
}

/// More points on a leg do not make it count for more; a single point has no length.
#[test]
fn averages_are_by_length() {
    let (robot, ..) = solved::<6>("kuka-kr270-r2700", Vector3::z_axis());
    let leg = |count: usize| {
        // A leg of 400 mm to the side, pushed hard, then one of 400 mm away, pushed little.
        let mut text = String::from("x [mm],y [mm],z [mm],ux,uy,uz\n");
        let side = (0..=count).map(|k| (1400.0, 400.0 * k as f64 / count as f64));
        let away = (1..=10).map(|k| (1400.0 + 40.0 * f64::from(k), 400.0));
        side.chain(away).for_each(|(x, y)| text += &format!("{x},{y},600,0,0,-1\n"));
        let path = ToolPath::parse("leg.csv", &text, &described("kuka-kr270-r2700"), Vector3::z_axis()).unwrap();
        let path = path.solve(&robot, None).unwrap();
        let mut forces = String::from("Fx,Fy,Fz\n");
        (0..path.points.len()).for_each(|i| forces += if i <= count { "0,900,0\n" } else { "0,100,0\n" });
        let load = table(&forces).unwrap().load(&path, ForceFrame::Base, Vector3::z_axis(), Surface::Side).unwrap();
        Deviation::of(&robot, &path, &load).unwrap().distances().unwrap()
    };
    let (few, many) = (leg(10), leg(400));
    // The mean of a few points is off by the ends of the legs.
    assert!((few.mean / many.mean - 1.0).abs() < 0.06 && (few.rms / many.rms - 1.0).abs() < 0.06, "{few:?} {many:?}");
    assert_eq!(Summary::of([(2.0, 0.0), (4.0, 0.0)]).unwrap().mean, 3.0);
    assert_eq!(Summary::of([(2.0, 0.0), (4.0, 1.0)]).unwrap().mean, 4.0);
}

#[test]
fn what_hysteresis_keeps_out_of_the_cut_breaks_no_tolerance() {
    let (_, _, path) = solved::<6>("kuka-kr270-r2700", Vector3::z_axis());
    let mut description = described("kuka-kr270-r2700");
    let ([radius1, weight1], none) = ([100.0, 1e-6], 0.0);
    let lagging = |joint| Effect::Hysteresis {
        joint,
        radius1,
        weight1,
        radius2: none,
        weight2: none,
        radius3: none,
        weight3: none,
    };
    description.effects = (1..=3).map(lagging).collect();
    let robot = Generic::<6>::new(&description).unwrap();
    let mut text = String::from("Fx,Fy,Fz\n");
    (0..path.points.len()).for_each(|i| text += if i < 4 { "100,800,-300\n" } else { "0,0,0\n" });
    let load = table(&text).unwrap().load(&path, ForceFrame::Base, Vector3::z_axis(), Surface::Side).unwrap();
    let found = Deviation::of(&robot, &path, &load).unwrap();
    assert!(found.points[3..6].iter().all(|point| point.error.unwrap().abs() > 5e-5), "{found:?}");
    let told: Vec<_> = found.stretches(5e-5).iter().map(|stretch| (stretch.points, stretch.holds)).collect();
    assert_eq!(told, [([0, 3], false), ([4, 49], true)]);
    assert_eq!((found.stretches(5e-5)[1].worst, found.judged().count()), (None, 4));
}

#[test]
fn high_speed_cutting_removes_as_much_with_less_force_and_error() {
    let (robot, _, path) = solved::<5>("rv130hsc", Vector3::x_axis());
    let conventional = cut("3 mm", "6000 rpm", "0.1 mm/tooth");
    let fast = cut("1 mm", "18000 rpm", "0.1 mm/tooth");
    let [slow_rate, fast_rate] = [&conventional, &fast].map(|cut| removal_rate(cut).unwrap());
    // 8 mm x 3 mm x 2400 mm/min.
    assert!((slow_rate * 6e7 - 57.6).abs() < 1e-9 && (fast_rate / slow_rate - 1.0).abs() < 1e-12);
    let error = |cut| {
        let load = load_of_cut(&Forces::Model(cut), &path, Vector3::x_axis(), Surface::Side);
        Deviation::of(&robot, &path, &load).unwrap().errors().unwrap().rms
    };
    let ratio = error(fast) / error(conventional);
    assert!((0.3..0.36).contains(&ratio), "{ratio}");
}

#[test]
fn the_peak_of_a_revolution_is_beyond_the_mean() {
    let (robot, _, path) = solved::<5>("rv130hsc", Vector3::x_axis());
    let cut = cut("3 mm", "6000 rpm", "0.1 mm/tooth");
    let load = load_of_cut(&Forces::Model(cut.clone()), &path, Vector3::x_axis(), Surface::Side);
    let forces = cut.revolution(72).samples.into_iter().map(|(_, force)| force).collect();
    let found = Deviation::of(&robot, &path, &load.with_revolution(forces)).unwrap();
    for point in &found.points {
        let [peak, mean] = [point.peak.unwrap(), point.error.unwrap()];
        assert!(peak.abs() > mean.abs() && peak.abs() < 5.0 * mean.abs(), "{peak} {mean}");
        assert_eq!(point.judged(), point.peak);
    }
}

#[test]
fn the_peak_of_a_force_that_stays_is_its_mean() {
    let (robot, _, path) = solved::<5>("rv130hsc", Vector3::x_axis());
    let cut = cut("3 mm", "6000 rpm", "0.1 mm/tooth");
    let same = std::vec![cut.mean_force(); 72];
    // The force follows the displacement, in both.
    let load = load_of_cut(&Forces::Model(cut), &path, Vector3::x_axis(), Surface::Side).with_revolution(same);
    for point in Deviation::of(&robot, &path, &load).unwrap().points {
        let [peak, mean] = [point.peak.unwrap(), point.error.unwrap()];
        assert!((peak - mean).abs() < 1e-12, "{peak} {mean}");
    }
}

#[test]
fn forces_come_by_row_or_by_arc_length() {
    let (_, _, path) = solved::<6>("kuka-kr270-r2700", Vector3::z_axis());
    let load = |text: &str, frame| table(text).unwrap().load(&path, frame, Vector3::z_axis(), Surface::Side);
    let by_length = load("s [mm],Fx,Fy,Fz\n0,0,0,0\n500,100,0,50\n1000,300,0,50\n", ForceFrame::Base).unwrap();
    for (point, contact) in path.points.iter().zip(&by_length.contacts) {
        let s = point.s * 1e3;
        let expected = if s < 500.0 { s / 5.0 } else { 100.0 + (s - 500.0) / 2.5 };
        assert!((contact.wrench[0] - expected).abs() < 1e-6, "{s} {}", contact.wrench);
    }
    let along_feed = load("s,Fx,Fy,Fz\n0,100,0,0\n1,100,0,0\n", ForceFrame::Cut).unwrap();
    let feed = path.points[3].tangent.unwrap().into_inner();
    assert!((along_feed.contacts[3].wrench.fixed_rows::<3>(0) - feed * 100.0).norm() < 1e-9);
    let along_tool = load("s,Fx,Fy,Fz\n0,0,0,100\n1,0,0,100\n", ForceFrame::Tool).unwrap();
    assert!((along_tool.contacts[3].wrench[2] + 100.0).abs() < 1e-6, "the tool points down");

    let short = load("s [mm],Fx,Fy,Fz\n0,0,0,0\n500,100,0,50\n", ForceFrame::Base).unwrap_err().to_string();
    assert!(short.contains("the forces end at s = 500.000 mm, the path at"), "{short}");
    let few = load("Fx,Fy,Fz\n0,0,0\n", ForceFrame::Base).unwrap_err().to_string();
    assert!(few.contains("here is 1 row, the path has 50 points"), "{few}");
    let problems = table("s,Fx,Fy\n0,1,2\n0,3,x\n").unwrap_err();
    assert!(problems.contains("the column `Fz` is missing"), "{problems}");
    let problems = table("s,Fx,Fy,Fz\n0,1,2,3\n0,3,2,x\n").unwrap_err();
    assert!(problems.contains("forces.csv:3:1") && problems.contains("`x` is not a number"), "{problems}");
}

#[test]
fn where_the_tool_plunges_the_cut_has_no_direction() {
    let description = described("kuka-kr270-r2700");
    let robot = Generic::<6>::new(&description).unwrap();
    let text = "x,y,z,ux,uy,uz\n1.5,0,0.7,0,0,-1\n1.5,0,0.65,0,0,-1\n1.5,0,0.6,0,0,-1\n1.6,0,0.6,0,0,-1\n";
    let path = ToolPath::parse("plunge.csv", text, &description, Vector3::z_axis()).unwrap();
    let path = path.solve(&robot, None).unwrap();
    let cut = cut("3 mm", "6000 rpm", "0.1 mm/tooth");
    let revolution: Vec<_> = cut.revolution(72).samples.into_iter().map(|(_, force)| force).collect();
    let forces = Forces::Model(cut);
    let load = load_of_cut(&forces, &path, Vector3::z_axis(), Surface::Side);
    assert_eq!(load.undirected, [2, 3]);
    let found = Deviation::of(&robot, &path, &load).unwrap();
    assert_eq!((found.points[0].distance(), found.points[0].error), (0.0, None));
    let q: SVector<f64, 6> = path.points[3].q;
    assert!((found.points[3].displacement - robot.deflection(&q, &found.points[3].wrench)).norm() < 1e-11);

    // The floor is there without a feed; the forces of a revolution are not.
    let load = load_of_cut(&forces, &path, Vector3::z_axis(), Surface::Face).with_revolution(revolution);
    let found = Deviation::of(&robot, &path, &load).unwrap();
    assert_eq!((found.points[0].error, found.points[0].peak), (Some(0.0), None));
    assert_eq!((found.points[1].error, found.points[1].peak), (Some(0.0), None));
    assert!(found.points[2].peak.unwrap() != 0.0 && found.points[3].peak.unwrap() != 0.0);
    assert!(found.stretches(1e-9)[0].holds);
}

#[test]
fn recorded_forces_along_fixed_axes_need_no_feed() {
    let description = described("kuka-kr270-r2700");
    let robot = Generic::<6>::new(&description).unwrap();
    let text = "x,y,z,ux,uy,uz\n1.5,0,0.7,0,0,-1\n1.5,0,0.65,0,0,-1\n1.5,0,0.6,0,0,-1\n";
    let path = ToolPath::parse("drill.csv", text, &description, Vector3::z_axis()).unwrap();
    let path = path.solve(&robot, None).unwrap();
    let load = |frame| {
        let (force, _) = MeasuredForce::parse("f.csv", "Fx,Fy,Fz\n10,20,300\n", frame, false).unwrap();
        load_of_cut(&Forces::Measured { force, speed: None }, &path, Vector3::z_axis(), Surface::Face)
    };
    let base = load(ForceFrame::Base);
    assert!(base.undirected.is_empty());
    assert!(base.contacts.iter().all(|contact| contact.wrench == Vector6::new(10.0, 20.0, 300.0, 0.0, 0.0, 0.0)));
    let tool = load(ForceFrame::Tool);
    assert!(tool.undirected.is_empty() && (tool.contacts[1].wrench[2] + 300.0).abs() < 1e-6, "the tool points down");
    assert_eq!(load(ForceFrame::Cut).undirected, [2, 3, 4]);
    // The floor meets each of them, and none where there is no force.
    let revolution = std::vec![Vector3::z() * 400.0];
    let found = Deviation::of(&robot, &path, &base.with_revolution(revolution)).unwrap();
    assert!(found.points.iter().all(|point| point.judged().is_some_and(|peak| peak < point.error.unwrap())));
}
