//! A cutter on its way through the stock.

use std::sync::Arc;

use nalgebra::{Unit, Vector2, Vector3};

use super::bite::{Bite, Profile};
use super::cutter::Cutter;
use super::heights::{Heights, Removed, TooLarge, to_grid};
use super::stock::Stock;

/// Where a path takes its cutter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The tip (m), in the stock's frame.
    pub tip: Vector3<f64>,
    /// From the tip to the spindle, in the stock's frame.
    pub axis: Unit<Vector3<f64>>,
    /// Whether it gets there by a rapid.
    pub rapid: bool,
    /// Which of the cutters it is.
    pub cutter: usize,
}

/// What a cutter meets on the way from one point of its path to the next.
#[derive(Clone, Debug, PartialEq)]
pub enum Met {
    /// Nothing.
    Air,
    /// Material, stretch by stretch; what is missing of the length is air.
    Cut(Vec<Stretch>),
    /// Material below the tip only.
    Plunge,
    /// Material, in a rapid.
    Collision,
    /// Nobody knows: the tool's axis is not along the stock's z.
    Tilted,
}

/// A part of the way between two points.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// Its length (m).
    pub length: f64,
    /// What is met there.
    pub bite: Arc<Bite>,
}

/// The way from one point of a path to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// What is met.
    pub met: Met,
    /// Its length (m).
    pub length: f64,
    /// What is removed (m^3).
    pub volume: f64,
    /// What of it the flat of the tip takes, from above (m^3): forces do not know it.
    pub by_tip: f64,
}

/// What a path cuts from a stock.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// The way to each point; of the first the place where it begins.
    pub segments: Vec<Segment>,
    /// The width of the grid's cells (m).
    pub pitch: f64,
}

/// The tool's axis is along z within this angle (rad): at a depth of 10 mm it is then 35 um aside.
const TILTED: f64 = 3.5e-3;

/// What the sine of the angle between feed and axis must exceed for a feed across: that of
/// [`CutFrame`](crate::milling::CutFrame).
const ACROSS: f64 = 0.01;

/// What is met is that of a stretch of at least so many cells.
const STRETCH: f64 = 4.0;

/// And a segment has no more of them than these.
const MOST_STRETCHES: f64 = 64.0;

/// Less than this part of a cell's width is no cut.
const NO_WIDTH: f64 = 0.1;

/// Less up or down is rounding (m).
const LEVEL: f64 = 1e-8;

/// A rapid may scratch the material so deep (m).
const SCRATCH: f64 = 1e-5;

impl Survey {
    /// Takes the cutters along the steps, and cuts the stock.
    ///
    /// # Errors
    /// Where the stock needs more memory than is allowed.
    ///
    /// # Panics
    /// If a step has a cutter that is not there.
    pub fn new(stock: &Stock, steps: &[Step], cutters: &[Cutter]) -> Result<Self, TooLarge> {
        let radii = steps.iter().map(|step| cutters[step.cutter].radius());
        let radii = radii.fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], r| [least.min(r), most.max(r)]);
        let upright = steps.iter().filter(|step| !is_tilted(step));
        let heights = Heights::new(stock, upright.map(|step| step.tip.xy()), radii)?;
        let pitch = heights.pitch();
        let top = stock.bottom() + stock.thickness();
        let mut walk = Walk { heights, top, segments: Vec::with_capacity(steps.len()), open: None };
        for (i, step) in steps.iter().enumerate() {
            walk.go(i.checked_sub(1).map(|before| &steps[before]), step, &cutters[step.cutter]);
        }
        walk.close();
        Ok(Self { segments: walk.segments, pitch })
    }

    /// All that is removed (m^3).
    pub fn volume(&self) -> f64 {
        self.segments.iter().map(|segment| segment.volume).sum()
    }
}

impl Segment {
    /// The radial width (m) and the axial depth (m) of what is met, in the mean over the length and over the area;
    /// `None` in the air.
    pub fn width_and_depth(&self) -> Option<[f64; 2]> {
        let Met::Cut(stretches) = &self.met else { return None };
        let area: f64 = stretches.iter().map(|stretch| stretch.length * stretch.bite.width).sum();
        let volume: f64 =
            stretches.iter().map(|stretch| stretch.length * stretch.bite.width * stretch.bite.depth).sum();
        (self.length > 0.0 && area > 0.0).then(|| [area / self.length, volume / area])
    }
}

fn is_tilted(step: &Step) -> bool {
    step.axis.xy().norm() > TILTED || step.axis.z < 0.0
}

/// A cutter in the midst of a stock.
struct Walk {
    heights: Heights,
    /// The height of the stock's top (m).
    top: f64,
    segments: Vec<Segment>,
    open: Option<Open>,
}

/// A stretch that goes on.
struct Open {
    profile: Profile,
    /// The segments that it is part of, and the length of each (m).
    shares: Vec<(usize, f64)>,
}

impl Walk {
    fn go(&mut self, before: Option<&Step>, step: &Step, cutter: &Cutter) {
        let [from, to] = [before.unwrap_or(step), step].map(|step| to_grid(&step.tip));
        let way = to - from;
        let segment = Segment { met: Met::Air, length: way.norm(), volume: 0.0, by_tip: 0.0 };
        self.segments.push(segment);
        if is_tilted(step) || before.is_some_and(is_tilted) {
            self.close();
            self.last().met = Met::Tilted;
            return;
        }
        // What the tool stands in at first was cut before.
        let is_first = before.is_none_or(|before| before.cutter != step.cutter) || self.came_tilted();
        if is_first {
            self.close();
            self.plunge([from, from], cutter);
        }
        if step.rapid {
            self.close();
            self.rapid([from, to], cutter);
        } else if way.xy().norm() > ACROSS * way.norm() {
            self.feed([from, to], cutter);
        } else if way.norm() > 0.0 {
            self.close();
            self.plunge([from, to], cutter);
        }
    }

    fn last(&mut self) -> &mut Segment {
        self.segments.last_mut().expect("a segment was pushed")
    }

    /// Whether the segment before the last was tilted.
    fn came_tilted(&self) -> bool {
        self.segments.iter().rev().nth(1).is_some_and(|segment| segment.met == Met::Tilted)
    }

    fn rapid(&mut self, way: [Vector3<f64>; 2], cutter: &Cutter) {
        let (cell, inside) = (self.heights.pitch().powi(2), cutter.radius() - self.heights.pitch());
        let (mut volume, mut deep) = (0.0, false);
        for [from, to] in parts(way, cutter.radius()) {
            self.sweep([from, to], cutter, |removed, part| {
                let height = removed.height();
                volume += cell * height;
                deep |= height > SCRATCH && (removed.at - from.lerp(&to, part).xy()).norm() < inside;
            });
        }
        let last = self.last();
        last.volume += volume;
        if deep {
            last.met = Met::Collision;
        }
    }

    fn plunge(&mut self, way: [Vector3<f64>; 2], cutter: &Cutter) {
        let pitch = self.heights.pitch();
        let (mut volume, mut area) = (0.0, 0.0);
        self.sweep(way, cutter, |removed, _| {
            area += pitch * pitch;
            volume += pitch * pitch * (removed.height());
        });
        let last = self.last();
        last.volume += volume;
        last.by_tip += volume;
        if area > NO_WIDTH * pitch * cutter.radius() {
            last.met = Met::Plunge;
        }
    }

    fn feed(&mut self, way: [Vector3<f64>; 2], cutter: &Cutter) {
        let (pitch, index) = (self.heights.pitch(), self.segments.len() - 1);
        let length = (way[1] - way[0]).norm();
        let enough = (STRETCH * pitch).max(length / MOST_STRETCHES);
        let ahead = (way[1] - way[0]).xy().normalize();
        let normal = Vector2::new(-ahead.y, ahead.x);
        for [from, to] in parts(way, 2.0 * STRETCH * pitch) {
            let mut open = self
                .open
                .take()
                .unwrap_or_else(|| Open { profile: Profile::new(cutter.slices(), pitch), shares: Vec::new() });
            let descends = to.z < from.z - LEVEL;
            let (mut volume, mut by_tip) = (0.0, 0.0);
            self.sweep([from, to], cutter, |removed, part| {
                let height = removed.height();
                volume += pitch * pitch * height;
                if descends && (removed.at - from.xy()).norm() < cutter.flat() {
                    by_tip += pitch * pitch * height;
                    return;
                }
                let across = (removed.at - from.xy()).dot(&normal);
                let tip = from.z + part * (to.z - from.z);
                let heights = [removed.from, removed.to].map(|height| height - tip);
                open.profile.add(across, heights, pitch * pitch, |height| cutter.radius_at(height));
            });
            let length = (to - from).norm();
            open.profile.length += length;
            match open.shares.last_mut().filter(|(segment, _)| *segment == index) {
                Some((_, share)) => *share += length,
                None => open.shares.push((index, length)),
            }
            let is_long = open.profile.length >= enough;
            self.open = Some(open);
            let last = self.last();
            last.volume += volume;
            last.by_tip += by_tip;
            if is_long {
                self.close();
            }
        }
    }

    /// Gives what was met on a stretch to the segments that it is part of.
    fn close(&mut self) {
        let Some(Open { profile, shares }) = self.open.take() else { return };
        if profile.area <= NO_WIDTH * self.heights.pitch() * profile.length {
            return;
        }
        let bite = Arc::new(profile.bite());
        for (segment, length) in shares {
            let stretch = Stretch { length, bite: Arc::clone(&bite) };
            match &mut self.segments[segment].met {
                Met::Cut(stretches) => stretches.push(stretch),
                met => *met = Met::Cut(vec![stretch]),
            }
        }
    }

    /// Cuts along a straight way, and tells of each cell with the part of the way that is nearest.
    fn sweep(&mut self, [from, to]: [Vector3<f64>; 2], cutter: &Cutter, mut tell: impl FnMut(Removed, f64)) {
        let lowest = from.z.min(to.z);
        if lowest >= self.top {
            return;
        }
        let (way, radius, is_level) = ((to - from).xy(), cutter.radius(), (from.z - to.z).abs() <= LEVEL);
        let squared = way.norm_squared();
        let nearest = |at: &Vector2<f64>| {
            if squared > 0.0 { ((at - from.xy()).dot(&way) / squared).clamp(0.0, 1.0) } else { 0.0 }
        };
        let floor_at = |at: &Vector2<f64>, part: f64| {
            let distance = (at - from.xy() - way * part).norm();
            (distance <= radius).then(|| from.z + part * (to.z - from.z) + cutter.rise(distance))
        };
        let floor = |at: &Vector2<f64>| {
            let level = floor_at(at, nearest(at));
            // Of a way that goes down or up its ends count too; the rest comes with the next parts.
            let ends = [0.0, 1.0].into_iter().filter(|_| !is_level).filter_map(|part| floor_at(at, part));
            ends.chain(level).reduce(f64::min)
        };
        self.heights.cut([from.xy(), to.xy()], radius, lowest, floor, |removed| {
            let part = nearest(&removed.at);
            tell(removed, part);
        });
    }
}

/// A way in equal parts of a length at most.
fn parts([from, to]: [Vector3<f64>; 2], longest: f64) -> impl Iterator<Item = [Vector3<f64>; 2]> {
    let count = ((to - from).norm() / longest).ceil().max(1.0);
    let at = move |k: usize| if k as f64 == count { to } else { from.lerp(&to, k as f64 / count) };
    (0..count as usize).map(move |k| [at(k), at(k + 1)])
}
