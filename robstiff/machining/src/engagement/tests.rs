//! Against a count of pixels, rays and integrals of their own.

use core::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Unit, Vector3};

use super::*;
use crate::deviation::tests::cut;
use crate::milling::{Cut, Direction, Engagement};

const MM: f64 = 1e-3;

fn flat(diameter: f64) -> Cutter {
    Cutter { diameter: diameter * MM, corner: 0.0 }
}

/// Steps through points (mm), all feeds.
fn steps(points: &[[f64; 3]]) -> Vec<Step> {
    let step = |&[x, y, z]: &[f64; 3]| Step {
        tip: Vector3::new(x, y, z) * MM,
        axis: Vector3::z_axis(),
        rapid: false,
        cutter: 0,
    };
    points.iter().map(step).collect()
}

/// A box from -half to half (mm), from -10 mm to 0.
fn block(half: [f64; 2]) -> Stock {
    let [x, y] = half.map(|half| half * MM);
    Stock::of_corners(&Vector3::new(-x, -y, -10.0 * MM), &Vector3::new(x, y, 0.0)).unwrap()
}

/// The area that each segment takes (mm^2), by pixels: a flat tool on a plate from -half to half (mm).
struct Pixels {
    half: [f64; 2],
    size: f64,
    uncut: Vec<bool>,
    wide: usize,
}

impl Pixels {
    fn new(half: [f64; 2], size: f64) -> Self {
        let [wide, high] = half.map(|half| (2.0 * half / size).round() as usize);
        Self { half, size, uncut: vec![true; wide * high], wide }
    }

    fn sweep(&mut self, [from, to]: [[f64; 3]; 2], radius: f64) -> f64 {
        let mut count = 0;
        let (wx, wy) = (to[0] - from[0], to[1] - from[1]);
        let among = |axis: usize| {
            let [low, high] = [from[axis].min(to[axis]) - radius, from[axis].max(to[axis]) + radius];
            let [first, end] = [low, high + self.size].map(|place| ((place + self.half[axis]) / self.size) as usize);
            first..end.min((2.0 * self.half[axis] / self.size).round() as usize)
        };
        for (row, column) in among(1).flat_map(|row| among(0).map(move |column| (row, column))) {
            let x = (column as f64 + 0.5) * self.size - self.half[0] - from[0];
            let y = (row as f64 + 0.5) * self.size - self.half[1] - from[1];
            let along = if wx == 0.0 && wy == 0.0 { 0.0 } else { (x * wx + y * wy) / (wx * wx + wy * wy) };
            let along = along.clamp(0.0, 1.0);
            let uncut = &mut self.uncut[row * self.wide + column];
            if *uncut && (x - along * wx).hypot(y - along * wy) <= radius {
                *uncut = false;
                count += 1;
            }
        }
        f64::from(count) * self.size * self.size
    }
}

/// From the middle out in squares, 8 mm each: what a pocket of a 20 mm tool looks like.
fn pocket() -> Vec<[f64; 3]> {
    let mut points = vec![[0.0, 0.0, -2.0]];
    for ring in 1..=4 {
        let half = 8.0 * f64::from(ring);
        for [x, y] in [[half, -half], [half, half], [-half, half], [-half, -half], [half, -half]] {
            points.push([x, y, -2.0]);
        }
    }
    points
}

#[test]
fn a_pocket_is_as_wide_as_by_pixels() {
    let points = pocket();
    let half = [50.0, 50.0];
    let survey = Survey::new(&block(half), &steps(&points), &[flat(20.0)]).unwrap();
    let mut pixels = Pixels::new(half, 0.1);
    pixels.sweep([points[0], points[0]], 10.0);
    let mut widths = Vec::new();
    for (k, pair) in points.windows(2).enumerate() {
        let area = pixels.sweep([pair[0], pair[1]], 10.0);
        let length = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
        let segment = &survey.segments[k + 1];
        let [width, depth] = segment.width_and_depth().unwrap();
        assert!((width / MM / (area / length) - 1.0).abs() < 0.05, "{k}: {} {}", width / MM, area / length);
        assert!((depth - 2.0 * MM).abs() < 1e-6, "{k}: {depth}");
        widths.push(width / MM);
    }
    // The first way out is a slot, the last square takes about the step.
    assert!((widths[0] - 20.0).abs() < 0.2, "{widths:?}");
    assert!(widths[17..].iter().all(|width| (5.5..10.0).contains(width)), "{widths:?}");
}

/// Forward by 2 mm a turn, circles of 5 mm, at an angle to the axes.
fn trochoid() -> Vec<[f64; 3]> {
    let point = |k: i32| {
        let turn = f64::from(k) / 72.0;
        let (sine, cosine) = (2.0 * PI * turn).sin_cos();
        let (along, across) = (2.0 * turn - 10.0 + 5.0 * sine, 5.0 * cosine);
        let (s, c) = 0.3_f64.sin_cos();
        [c * along - s * across, s * along + c * across, -1.0]
    };
    (0..=72 * 8).map(point).collect()
}

#[test]
fn a_trochoid_is_as_wide_as_by_pixels() {
    let points = trochoid();
    let half = [30.0, 30.0];
    let survey = Survey::new(&block(half), &steps(&points), &[flat(6.0)]).unwrap();
    let mut pixels = Pixels::new(half, 0.05);
    pixels.sweep([points[0], points[0]], 3.0);
    let areas: Vec<f64> = points.windows(2).map(|pair| pixels.sweep([pair[0], pair[1]], 3.0)).collect();
    // By an eighth of a turn, and the whole: single segments are of some ten pixels.
    let of = |k: usize| {
        let found = survey.segments[1 + 9 * k..].iter().take(9);
        let area: f64 = found.map(|one| one.width_and_depth().map_or(0.0, |[width, _]| width * one.length)).sum();
        (area / MM / MM, areas[9 * k..][..9].iter().sum::<f64>())
    };
    let mut air = 0;
    for k in 0..64 {
        let (found, expected) = of(k);
        assert!((found - expected).abs() < 0.05 * expected + 0.15, "{k}: {found} {expected}");
        air += usize::from(found == 0.0);
    }
    // Half of each turn is in the air.
    assert!((8..=32).contains(&air), "{air}");
    let volume = areas.iter().sum::<f64>() + PI * 9.0;
    assert!((survey.volume() / MM.powi(3) / volume - 1.0).abs() < 0.01, "{} {volume}", survey.volume());
}

/// Where rays from the tool's axis at so many angles about it meet uncut pixels, at the front.
fn rays(pixels: &Pixels, at: [f64; 3], heading: f64, radius: f64) -> Vec<bool> {
    let met = |k: u32| {
        // From the normal, on the left, as the spindle turns: clockwise.
        let direction = heading + FRAC_PI_2 - f64::from(k).to_radians();
        let reach = radius + 1.5 * pixels.size;
        let [x, y] = [at[0] + reach * direction.cos(), at[1] + reach * direction.sin()];
        let [column, row] = [x + pixels.half[0], y + pixels.half[1]].map(|place| (place / pixels.size) as usize);
        pixels.uncut[row * pixels.wide + column]
    };
    (0..=180).map(met).collect()
}

#[test]
fn arcs_are_where_rays_meet_material() {
    let points = trochoid();
    let survey = Survey::new(&block([30.0, 30.0]), &steps(&points), &[flat(6.0)]).unwrap();
    let mut pixels = Pixels::new([30.0, 30.0], 0.05);
    pixels.sweep([points[0], points[0]], 3.0);
    let (mut compared, mut off) = (0, 0.0);
    for (k, pair) in points.windows(2).enumerate() {
        let heading = (pair[1][1] - pair[0][1]).atan2(pair[1][0] - pair[0][0]);
        if k > 288 && k % 12 == 0 {
            let met = rays(&pixels, pair[0], heading, 3.0);
            // The part of the feed across that they take: by rays, and by arcs.
            let across = |k: usize| (k as f64).to_radians().sin() * 1_f64.to_radians();
            let by_rays: f64 = (0..=180).filter(|&k| met[k]).map(across).sum();
            let by_arcs = match &survey.segments[k + 1].met {
                Met::Cut(stretches) => {
                    let sectors = stretches.iter().flat_map(|stretch| &stretch.bite.sectors);
                    sectors.map(|one| (one.engagement.entry.cos() - one.engagement.exit.cos()) * one.depth / MM).sum()
                }
                _ => 0.0,
            };
            (compared, off) = (compared + 1, off + f64::abs(by_rays - by_arcs));
            assert!((by_rays - by_arcs).abs() < 0.25, "{k}: {by_rays} {by_arcs} {:?}", survey.segments[k + 1]);
        }
        pixels.sweep([pair[0], pair[1]], 3.0);
    }
    assert!(compared > 20 && off / f64::from(compared) < 0.06, "{compared} {off}");
}

fn sectors(segment: &Segment) -> &[Sector] {
    match &segment.met {
        Met::Cut(stretches) => &stretches[stretches.len() / 2].bite.sectors,
        met => panic!("{met:?}"),
    }
}

/// The same wall, from both sides; the second way cuts with half the circumference of the first.
#[test]
fn a_wall_beside_the_tool_is_up_or_down_milling() {
    // The block ends at y = -20; 8 mm are left of the tool at y = -22, feeding to +x.
    for (from, to, direction) in [(-60.0, 60.0, Direction::Up), (60.0, -60.0, Direction::Down)] {
        let points = [[from, -22.0, -3.0], [to, -22.0, -3.0]];
        let survey = Survey::new(&block([40.0, 20.0]), &steps(&points), &[flat(20.0)]).unwrap();
        let met = sectors(&survey.segments[1]);
        let expected = Engagement::of_width(direction, 8.0, 20.0).unwrap();
        assert_eq!(met.len(), 1, "{met:?}");
        let found = met[0].engagement;
        assert!((found.entry - expected.entry).abs() < 0.02 && (found.exit - expected.exit).abs() < 0.02, "{found:?}");
        assert!((met[0].depth - 3.0 * MM).abs() < 0.06 * MM, "{met:?}");
        let Met::Cut(stretches) = &survey.segments[1].met else { panic!() };
        let bite = &stretches[stretches.len() / 2].bite;
        assert_eq!(bite.wall(), Some(if direction == Direction::Up { 1.0 } else { -1.0 }));
        // Force and slope are those of the cut of that width.
        let own = Cut { engagement: expected, ..cut("3 mm", "6000 rpm", "0.1 mm/tooth") };
        let force = own.mean_force();
        assert!((bite.mean_force(&own) - force).norm() < 0.02 * force.norm());
        let given = Bite::of_engagement(expected, 3.0 * MM, 20.0 * MM);
        assert!((given.mean_force(&own) - force).norm() < 1e-9 * force.norm());
        let slopes = [bite, &given].map(|bite| bite.response(&own, 1e-6));
        for axis in [1, 2] {
            let [found, expected] = [slopes[0][axis], slopes[1][axis]];
            assert!((found - expected).norm() < 0.05 * expected.norm(), "{axis}: {found} {expected}");
        }
        let wider = Cut { engagement: Engagement::of_width(direction, 8.001, 20.0).unwrap(), ..own.clone() };
        let slope = (wider.mean_force() - force) / 1e-6 * bite.wall().unwrap();
        assert!((slopes[1][1] - slope).norm() < 1e-2 * slope.norm(), "{} {slope}", slopes[1][1]);
    }
}

#[test]
fn a_groove_in_the_middle_leaves_two_arcs() {
    let [groove, wide] = [flat(6.0), flat(20.0)];
    let mut path = steps(&[[-60.0, 0.0, -2.0], [60.0, 0.0, -2.0], [60.0, 0.0, 5.0], [-60.0, 0.0, 5.0]]);
    path.extend(steps(&[[-60.0, 0.0, -2.0], [60.0, 0.0, -2.0]]).into_iter().map(|step| Step { cutter: 1, ..step }));
    let survey = Survey::new(&block([40.0, 20.0]), &path, &[groove, wide]).unwrap();
    let met = sectors(&survey.segments[5]);
    let [one, other] = met else { panic!("{met:?}") };
    let edge = (0.3_f64).acos();
    assert!(one.engagement.entry == 0.0 && (one.engagement.exit - edge).abs() < 0.02, "{met:?}");
    assert!(other.engagement.exit == PI && (other.engagement.entry - (PI - edge)).abs() < 0.02, "{met:?}");
    let [width, depth] = survey.segments[5].width_and_depth().unwrap();
    // Of 120 mm 80 and the lead-in are in the block.
    assert!((width / (14.0 * MM * 80.0 / 120.0) - 1.0).abs() < 0.05 && (depth - 2.0 * MM).abs() < 1e-6, "{width}");
    assert_eq!((&survey.segments[2].met, &survey.segments[3].met), (&Met::Air, &Met::Air));
}

/// A ball in a slot meets a segment of a circle; each of its slices is in a slot as wide as that.
#[test]
fn a_ball_cuts_a_segment_of_a_circle() {
    let (radius, depth) = (5.0, 2.0);
    let ball = Cutter { diameter: 2.0 * radius * MM, corner: radius * MM };
    let points = [[-60.0, 1.0, -depth], [60.0, 3.0, -depth]];
    let survey = Survey::new(&block([40.0, 20.0]), &steps(&points), &[ball]).unwrap();
    let half = (radius * radius - (radius - depth).powi(2)).sqrt();
    let section = radius * radius * ((radius - depth) / radius).acos() - (radius - depth) * half;
    let Met::Cut(stretches) = &survey.segments[1].met else { panic!() };
    let bite = &stretches[stretches.len() / 2].bite;
    assert!((bite.width / (2.0 * half * MM) - 1.0).abs() < 0.03, "{bite:?}");
    assert!((bite.width * bite.depth / (section * MM * MM) - 1.0).abs() < 0.01, "{bite:?}");
    let full = |one: &&Sector| one.engagement.is_slot() && (one.depth * 2.0 * one.radius) > 0.0;
    assert!(bite.sectors.iter().filter(full).count() >= 4, "{:?}", bite.sectors);

    // Lee and Altintas by sums over angles about the axis and along the edge, straight from their matrix.
    for helix in [0.5, -0.5] {
        let mut own = cut("1 mm", "6000 rpm", "0.1 mm/tooth");
        own.mill.helix = helix;
        let k = own.coefficients;
        let (count, steps) = (400, 400);
        let mut expected = Vector3::zeros();
        let most = ((radius - depth) / radius).acos();
        for i in 0..steps {
            let lead = most * (f64::from(i) + 0.5) / f64::from(steps);
            let (sine, cosine) = lead.sin_cos();
            let edge = radius * MM * most / f64::from(steps);
            for j in 0..count {
                let phi = PI * (f64::from(j) + 0.5) / f64::from(count);
                let chip = own.feed_per_tooth * phi.sin() * sine;
                let [t, r, a] = [(k.ktc, k.kte), (k.krc, k.kre), (k.kac, k.kae)].map(|(c, e)| (c * chip + e) * edge);
                let a = a * helix.signum();
                let out = r * sine + a * cosine;
                expected += Vector3::new(
                    -out * phi.sin() - t * phi.cos(),
                    -out * phi.cos() + t * phi.sin(),
                    a * sine - r * cosine,
                ) / f64::from(count);
            }
        }
        // Half of a turn, by each tooth.
        expected *= 0.5 * own.mill.teeth as f64;
        let found = bite.mean_force(&own);
        assert!((found - expected).norm() < 0.03 * expected.norm(), "{helix}: {found} {expected}");
        let turn = bite.extremes(&own, 720);
        assert!(turn.iter().map(|force| force.norm()).fold(0.0, f64::max) > 0.99 * found.norm());
    }
}

/// A bull nose is a ball at its corner, and a flat between.
#[test]
fn a_bull_nose_has_both() {
    let bull = Cutter { diameter: 20.0 * MM, corner: 3.0 * MM };
    let survey = Survey::new(&block([40.0, 20.0]), &steps(&[[-60.0, 0.0, -4.0], [60.0, 0.0, -4.0]]), &[bull]).unwrap();
    let Met::Cut(stretches) = &survey.segments[1].met else { panic!() };
    let bite = &stretches[stretches.len() / 2].bite;
    let section = 20.0 * 4.0 - 2.0 * (9.0 - PI * 9.0 / 4.0);
    assert!((bite.width * bite.depth / MM / MM / section - 1.0).abs() < 0.01, "{}", bite.width * bite.depth);
    let height: f64 = bite.sectors.iter().filter(|one| one.lead == FRAC_PI_2).map(|one| one.depth).sum();
    assert!((height / MM - 1.0).abs() < 0.02, "{:?}", bite.sectors);
}

#[test]
fn rapids_ramps_and_tilted_axes_are_reported() {
    let mut path = steps(&[
        [-60.0, 0.0, 5.0],
        [0.0, 0.0, 5.0],
        [0.0, 0.0, -3.0],
        [20.0, 0.0, -3.0],
        [30.0, 0.0, -5.0],
        [35.0, 0.0, -5.0],
        [35.0, 12.0, -5.0],
        [35.0, 12.0, 5.0],
        [0.0, 0.0, 5.0],
        [0.0, -10.0, -1.0],
    ]);
    for rapid in [1, 6, 8, 7] {
        path[rapid].rapid = true;
    }
    let tilt = |angle: f64| Unit::new_normalize(Vector3::new(angle.sin(), 0.0, angle.cos()));
    path[9].axis = tilt(0.05);
    let survey = Survey::new(&block([40.0, 20.0]), &path, &[flat(10.0)]).unwrap();
    let met = |k: usize| &survey.segments[k].met;
    assert_eq!([0, 1, 7, 8].map(met), [&Met::Air; 4]);
    assert_eq!([2, 6, 9].map(met), [&Met::Plunge, &Met::Collision, &Met::Tilted]);
    let removed = |k: usize| survey.segments[k].volume / MM.powi(3);
    assert!((removed(2) / (PI * 25.0 * 3.0) - 1.0).abs() < 0.02 && survey.segments[2].by_tip > 0.0);
    assert!((removed(3) / 600.0 - 1.0).abs() < 0.02 && survey.segments[3].by_tip == 0.0);
    // The ramp takes a wedge from the front, and as much as the front has left below from above.
    let ramp = &survey.segments[4];
    assert!(ramp.by_tip > 0.1 * ramp.volume && ramp.by_tip < 0.5 * ramp.volume, "{ramp:?}");
    assert!(survey.segments[9].volume == 0.0);
    // A hundredth of a degree is none.
    path[9].axis = tilt(2e-4);
    let survey = Survey::new(&block([40.0, 20.0]), &path, &[flat(10.0)]).unwrap();
    assert!(matches!(survey.segments[9].met, Met::Cut(_)), "{:?}", survey.segments[9]);
}

#[test]
fn a_wall_is_passed_again_in_the_air() {
    let line = [[-60.0, -24.0, -3.0], [60.0, -24.0, -3.0]];
    let again = [line[0], line[1], [60.0, -24.0, -3.0], line[0]];
    let survey = Survey::new(&block([40.0, 20.0]), &steps(&again), &[flat(20.0)]).unwrap();
    assert!(matches!(survey.segments[1].met, Met::Cut(_)));
    assert_eq!((&survey.segments[2].met, &survey.segments[3].met), (&Met::Air, &Met::Air));
    assert_eq!(survey.segments[3].volume, 0.0);
}

#[test]
fn what_needs_too_much_memory_is_refused_and_what_is_out_of_reach_costs_none() {
    let far = [[-900.0, -900.0, -1.0], [900.0, 900.0, -1.0]];
    let small = Survey::new(&block([1000.0, 1000.0]), &steps(&far), &[flat(1.0)]);
    let said = small.unwrap_err().to_string();
    assert!(said.contains("with a tool of 1 mm") && said.contains("write a smaller stock"), "{said}");
    // Coarser than wanted, and still within a twentieth of the radius.
    let survey = Survey::new(&block([150.0, 150.0]), &steps(&far), &[flat(3.0)]).unwrap();
    assert!(survey.pitch > 1.5 * MM * FINE && survey.pitch < 1.5 * MM / 20.0, "{}", survey.pitch);
    let near = [[0.0, 0.0, -1.0], [20.0, 0.0, -1.0]];
    let survey = Survey::new(&block([1000.0, 1000.0]), &steps(&near), &[flat(1.0)]).unwrap();
    assert_eq!(survey.pitch, 0.5 * MM * FINE);
    let [width, _] = survey.segments[1].width_and_depth().unwrap();
    assert!((width / MM - 1.0).abs() < 0.02, "{width}");
}

#[test]
fn a_stock_may_have_any_outline() {
    let outline = vec![[-40.0 * MM, -40.0 * MM], [40.0 * MM, -40.0 * MM], [0.0, 40.0 * MM]];
    let stock = Stock::of_outline(outline, -10.0 * MM, 0.0).unwrap();
    let points: Vec<[f64; 3]> = (0..=20).map(|k| [-50.0 + 5.0 * f64::from(k), 0.0, -1.0]).collect();
    let survey = Survey::new(&stock, &steps(&points), &[flat(10.0)]).unwrap();
    // 10 mm about the middle of a triangle 40 mm wide there.
    assert!((survey.volume() / MM.powi(3) / 400.0 - 1.0).abs() < 0.01, "{}", survey.volume());
    assert_eq!(survey.segments[3].met, Met::Air);
}
