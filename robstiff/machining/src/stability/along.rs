//! Where along a path the arm chatters.

use core::f64::consts::TAU;

use nalgebra::{Matrix3, SVector, Vector3};

use super::{Lobes, Modes, process};
use crate::milling::{Cut, CutFrame};

/// What is cut at a point of a path.
#[derive(Clone, Debug)]
pub struct Cutting<const N: usize> {
    /// The point, by its place in the path.
    pub point: usize,
    /// Joint coordinates (rad or m).
    pub q: SVector<f64, N>,
    /// Feed, normal and tool axis in the base frame.
    pub frame: CutFrame,
    /// What the teeth meet there: cuts of one tool, each with an arc and its depth.
    pub cuts: Vec<Cut>,
    /// The speed of the spindle (rad/s).
    pub speed: f64,
    /// The length that is cut up to here from the place before (m).
    pub length: f64,
}

impl<const N: usize> Cutting<N> {
    /// The change of the force with the tool's displacement, for all that the teeth meet, 3 x 3 (N/m) in the base frame.
    fn process(&self) -> Matrix3<f64> {
        self.cuts.iter().map(|cut| process(cut, &self.frame) * cut.depth).sum()
    }

    /// The mean force on the tool in the base frame (N).
    fn force(&self) -> Vector3<f64> {
        self.frame.force(&self.cuts.iter().map(Cut::mean_force).sum())
    }
}

/// What a place of a path bears.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The point, by its place in the path.
    pub point: usize,
    /// The length that is cut up to here from the place before (m).
    pub length: f64,
    /// The speed of the spindle (rad/s).
    pub speed: f64,
    /// How many times what is met there could be as deep before the arm chatters: below 1 it does. `None` beyond
    /// [`GREATEST`].
    pub margin: Option<f64>,
    /// Where it chatters, the nearest speed of the spindle (rad/s), with the same feed per tooth, at which it does not.
    pub mended: Option<f64>,
}

impl Place {
    /// Whether the arm chatters there.
    pub fn chatters(&self) -> bool {
        self.margin.is_some_and(|margin| margin <= 1.0)
    }
}

/// Margins beyond that are not looked for.
pub const GREATEST: f64 = 10.0;

/// A speed mends where the cut could be deeper by this factor: models of chatter are no better.
const MENDS: f64 = 1.25;

/// Speeds that are tried, from half to double.
const SPEEDS: i32 = 48;

/// The margin of each place, with the modes of the arm at its joint coordinates under its mean force (N, in the base frame);
/// `speeds` are those of the spindle (rad/s).
///
/// All that the teeth meet grows alike, so the margin stands for the depth in
/// [`Lobes`]. `None` where there are no modes, and where they or the cut give no lobes.
pub fn along<const N: usize>(
    places: &[Cutting<N>],
    modes: impl Fn(&SVector<f64, N>, &Vector3<f64>) -> Option<Modes>,
    speeds: Option<[f64; 2]>,
) -> Option<Vec<Place>> {
    let [slowest, fastest] = speeds.unwrap_or([0.0, f64::INFINITY]);
    let place = |of: &Cutting<N>| {
        let lobes = Lobes::new(&modes(&of.q, &of.force())?, &of.process(), GREATEST)?;
        let teeth = of.cuts.first()?.mill.teeth as f64;
        let margin = |speed: f64| lobes.limits(TAU / (speed * teeth)).limiting();
        let is_mended =
            |speed: &f64| (slowest..=fastest).contains(speed) && margin(*speed).is_none_or(|margin| margin >= MENDS);
        let place =
            Place { point: of.point, length: of.length, speed: of.speed, margin: margin(of.speed), mended: None };
        // The nearest first, by their ratio.
        let mut tried =
            (1..=SPEEDS).flat_map(|k| [k, -k]).map(|k| of.speed * 2_f64.powf(f64::from(k) / f64::from(SPEEDS)));
        let mended = if place.chatters() { tried.find(is_mended) } else { None };
        Some(Place { mended, ..place })
    };
    places.iter().map(place).collect()
}

/// Of what is cut along a path so many places at most: of each stretch of one length that at which the force
/// changes most with the displacement.
pub fn thinned<const N: usize>(cutting: Vec<Cutting<N>>, most: usize) -> Vec<Cutting<N>> {
    let whole: f64 = cutting.iter().map(|of| of.length).sum();
    let (mut thinned, mut so_far): (Vec<(usize, f64, Cutting<N>)>, f64) = (Vec::new(), 0.0);
    for of in cutting {
        let middle = so_far + 0.5 * of.length;
        let stretch = (most as f64 * middle / whole.max(f64::MIN_POSITIVE)) as usize;
        so_far += of.length;
        let size = of.process().norm();
        match thinned.last_mut().filter(|(known, ..)| *known == stretch.min(most - 1)) {
            Some((_, greatest, kept)) => {
                let length = kept.length + of.length;
                if size > *greatest {
                    (*greatest, *kept) = (size, of);
                }
                kept.length = length;
            }
            None => thinned.push((stretch.min(most - 1), size, of)),
        }
    }
    thinned.into_iter().map(|(.., of)| of).collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::Unit;

    use super::*;
    use crate::milling::{Coefficients, Direction, EndMill, Engagement};

    fn slot(depth: f64) -> Cut {
        let coefficients = Coefficients { ktc: 8e8, krc: 3e8, kac: 1e8, kte: 2e4, kre: 1e4, kae: 0.0 };
        Cut {
            mill: EndMill { diameter: 0.02, teeth: 4, helix: 0.5, corner: 0.0, runout: Vec::new() },
            coefficients,
            engagement: Engagement::of_width(Direction::Up, 0.01, 0.02).expect("half the tool"),
            depth,
            feed_per_tooth: 1e-4,
            speed: None,
        }
    }

    fn modes() -> Modes {
        let compliance = Matrix3::from_diagonal(&Vector3::new(1.2e-6, 0.8e-6, 0.3e-6));
        let mass = Matrix3::identity() * 100.0;
        Modes::new(&compliance, &mass, 0.02).expect("finite")
    }

    fn at(point: usize, depths: &[f64], feed: Vector3<f64>) -> Cutting<2> {
        let frame = CutFrame::new(&-Vector3::z(), &feed).expect("across the axis");
        let cuts = depths.iter().map(|depth| slot(*depth)).collect();
        Cutting { point, q: SVector::zeros(), frame, cuts, speed: 900.0, length: 0.001 }
    }

    /// The margin times the depth is the depth of the lobes, however the depth is made of parts.
    #[test]
    fn a_margin_is_the_limit_over_the_depth() {
        let feed = *Unit::new_normalize(Vector3::new(1.0, -0.6, 0.0));
        let process = process(&slot(1.0), &CutFrame::new(&-Vector3::z(), &feed).unwrap());
        let period = slot(1.0).mill.teeth as f64;
        let limit = Lobes::new(&modes(), &process, 0.1).unwrap().limits(TAU / (900.0 * period)).limiting().unwrap();
        for depths in [&[0.5 * limit][..], &[1.5 * limit], &[0.5 * limit, limit]] {
            let places = along(&[at(7, depths, feed)], |_, _| Some(modes()), None).unwrap();
            let depth: f64 = depths.iter().sum();
            let margin = places[0].margin.unwrap();
            assert!((margin * depth / limit - 1.0).abs() < 1e-6, "{margin} {depth} {limit}");
            assert_eq!((places[0].point, places[0].chatters()), (7, depth > limit));
        }
    }

    #[test]
    fn a_speed_mends_only_where_it_is_stable_and_the_spindle_turns_it() {
        let feed = *Unit::new_normalize(Vector3::new(1.0, -0.6, 0.0));
        let process = process(&slot(1.0), &CutFrame::new(&-Vector3::z(), &feed).unwrap());
        let lobes = Lobes::new(&modes(), &process, 1.0).unwrap();
        let limit = |speed: f64| lobes.limits(TAU / (speed * 4.0)).limiting().unwrap_or(1.0);
        let depth = 1.05 * limit(900.0);
        let places = along(&[at(0, &[depth], feed)], |_, _| Some(modes()), None).unwrap();
        let mended = places[0].mended.expect("where teeth pass quicker the arm bears more");
        assert!(limit(mended) >= 1.2 * depth, "{mended} {} {depth} {}", limit(mended), limit(900.0));
        assert!((450.0..=1800.0).contains(&mended), "{mended}");
        let places = along(&[at(0, &[depth], feed)], |_, _| Some(modes()), Some([890.0, 910.0])).unwrap();
        assert_eq!(places[0].mended, None);
        // What is stable is not mended.
        let places = along(&[at(0, &[0.5 * depth], feed)], |_, _| Some(modes()), None).unwrap();
        assert_eq!((places[0].chatters(), places[0].mended), (false, None));
    }

    #[test]
    fn of_many_points_the_heaviest_of_each_stretch_is_kept() {
        let depth = |k: usize| if k % 25 == 13 { 0.004 } else { 0.001 };
        let all: Vec<_> = (0..1000).map(|k| at(k, &[depth(k)], Vector3::x())).collect();
        let kept = thinned(all.clone(), 40);
        assert_eq!(kept.len(), 40);
        assert!(kept.iter().all(|of| of.point % 25 == 13));
        assert!((kept.iter().map(|of| of.length).sum::<f64>() - 1.0).abs() < 1e-9);
        assert_eq!(thinned(all, 5000).len(), 1000);
    }
}
