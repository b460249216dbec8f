//! What a cutter meets.

use super::cutter::Slice;
use crate::milling::Engagement;

/// A part of what the teeth of a cutter meet: an arc, over a part of their depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sector {
    /// The angles about the tool's axis, from the normal as the spindle turns.
    pub engagement: Engagement,
    /// The axial depth (m), in the mean over the arc.
    pub depth: f64,
    /// The height above the tip from which it is (m).
    pub above: f64,
    /// The radius of the cutter there (m).
    pub radius: f64,
    /// The angle between the tool's axis and the normal of the cutter's surface there (rad): a right angle at the
    /// circumference, less on the corner.
    pub lead: f64,
}

/// What a cutter meets on a stretch of its path.
#[derive(Clone, Debug, PartialEq)]
pub struct Bite {
    /// The arcs, from the tip up and then by their angles.
    pub sectors: Vec<Sector>,
    /// The radial width of the cut (m), seen along the tool's axis: the area that it takes over its length.
    pub width: f64,
    /// The axial depth (m), in the mean over that area.
    pub depth: f64,
}

/// What is less of the deepest is taken for the edge of an arc, or for none.
const EDGE: f64 = 0.05;

/// Neighbouring depths that differ by less, as a part, are one arc.
const EVEN: f64 = 0.2;

/// Volumes removed over a stretch, by where they are in the cutter: slice by slice, and across
/// the feed.
pub struct Profile {
    slices: Vec<Slice>,
    /// Of each slice, from -normal to +normal (m^3).
    bins: Vec<Vec<f64>>,
    /// What is removed, seen along the axis (m^2).
    pub area: f64,
    /// The length of the stretch (m).
    pub length: f64,
}

/// Fewer bins between two depths are the edge between them.
const MOST_OF_EDGE: f64 = 3.5;

/// Bins across a slice, at least.
const LEAST_BINS: usize = 6;

impl Profile {
    /// Nothing yet; the pitch is that of the grid (m).
    pub fn new(slices: Vec<Slice>, pitch: f64) -> Self {
        let count = |radius: f64| ((2.0 * radius / pitch).round() as usize).max(LEAST_BINS);
        let bins = slices.iter().map(|slice| vec![0.0; count(slice.radius)]).collect();
        Self { slices, bins, area: 0.0, length: 0.0 }
    }

    /// Adds material of a cell: `across` is how far along the normal it is from the tool's axis (m), `heights` from
    /// where to where above the tip (m), `area` that of the cell (m^2); `radius_at` gives the
    /// cutter's radius at a height.
    pub fn add(&mut self, across: f64, [from, to]: [f64; 2], area: f64, radius_at: impl Fn(f64) -> f64) {
        self.area += area;
        for (slice, bins) in self.slices.iter().zip(&mut self.bins) {
            let (low, high) = (from.max(slice.from), to.min(slice.to));
            if high > low {
                let radius = radius_at(0.5 * (low + high)).max(f64::MIN_POSITIVE);
                spread(bins, across / radius, area * (high - low));
            }
        }
    }

    /// What it is on the whole stretch.
    pub fn bite(&self) -> Bite {
        let mut sectors = Vec::new();
        let mut section = 0.0;
        for (slice, bins) in self.slices.iter().zip(&self.bins) {
            let width = 2.0 * slice.radius / bins.len() as f64;
            let depths: Vec<f64> = bins.iter().map(|volume| volume / (width * self.length)).collect();
            section += depths.iter().sum::<f64>() * width;
            // Angles count from the normal.
            let arcs = arcs(&depths).into_iter().rev().filter_map(|arc| {
                let angle = |place: f64| (2.0 * place / depths.len() as f64 - 1.0).clamp(-1.0, 1.0).acos();
                let engagement = Engagement::between(angle(arc.to), angle(arc.from))?;
                let (above, radius, lead) = (slice.from, slice.radius, slice.lead);
                Some(Sector { engagement, depth: arc.depth, above, radius, lead })
            });
            sectors.extend(arcs);
        }
        let width = if self.slices.len() == 1 { self.area / self.length } else { across(&sectors) };
        Bite { sectors, width, depth: if width > 0.0 { section / width } else { 0.0 } }
    }
}

/// How wide sectors are together, seen along the axis (m). A corner comes to one place more than once, so that areas cannot be
/// added up.
fn across(sectors: &[Sector]) -> f64 {
    let mut sides: Vec<[f64; 2]> = sectors
        .iter()
        .map(|Sector { engagement, radius, .. }| [engagement.exit, engagement.entry].map(|angle| radius * angle.cos()))
        .collect();
    sides.sort_by(|one, other| one[0].total_cmp(&other[0]));
    let (mut sum, mut end) = (0.0, f64::NEG_INFINITY);
    for [from, to] in sides {
        sum += (to - from.max(end)).max(0.0);
        end = end.max(to);
    }
    sum
}

/// Adds an amount at a place between -1 and 1, shared by the two bins that it is between.
fn spread(bins: &mut [f64], place: f64, amount: f64) {
    let last = bins.len() - 1;
    let at = (0.5 * (place + 1.0) * bins.len() as f64 - 0.5).clamp(0.0, last as f64);
    let (low, part) = (at.floor() as usize, at.fract());
    bins[low] += amount * (1.0 - part);
    bins[(low + 1).min(last)] += amount * part;
}

/// Neighbouring bins of about one depth. Both ends are counted in bins, and lie within one that is full in part.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Arc {
    from: f64,
    to: f64,
    depth: f64,
}

impl Arc {
    fn wide(&self) -> f64 {
        self.to - self.from
    }

    /// Both as one.
    fn with(&self, next: &Self) -> Self {
        let depth = (self.depth * self.wide() + next.depth * next.wide()) / (self.wide() + next.wide());
        Self { from: self.from, to: next.to, depth }
    }
}

/// Bins of about equal depth together, those without any left out.
fn arcs(depths: &[f64]) -> Vec<Arc> {
    let deepest = depths.iter().copied().fold(0.0, f64::max);
    let bins = depths.iter().enumerate().map(|(k, &depth)| {
        let depth = if depth > EDGE * deepest { depth } else { 0.0 };
        Arc { from: k as f64, to: k as f64 + 1.0, depth }
    });
    let even = |one: &Arc, next: &Arc| (next.depth - one.depth).abs() <= EVEN * one.depth;
    let is_edge = |arc: &Arc| arc.depth > 0.0 && arc.wide() < MOST_OF_EDGE;
    let mut arcs = joined(bins, even);
    arcs = joined(arcs.into_iter(), |one, next| is_edge(one) && is_edge(next));
    // A wall cuts through bins: what is between two depths is a part of either.
    for k in 0..arcs.len() {
        let arc = arcs[k];
        let depth_of = |other: Option<&Arc>| other.map(|other| other.depth);
        let [before, after] = [k.checked_sub(1).and_then(|k| arcs.get(k)), arcs.get(k + 1)].map(depth_of);
        // At the tool's side what is full for the greater part is full.
        let beyond = |inner: Option<f64>| inner.filter(|inner| arc.depth >= 0.5 * inner).unwrap_or(0.0);
        let (low, high) = (before.unwrap_or_else(|| beyond(after)), after.unwrap_or_else(|| beyond(before)));
        if !is_edge(&arc) || (before.or(after)).is_none() {
            continue;
        }
        if low == high && (before.is_none() || after.is_none()) {
            let inner = if before.is_none() { k + 1 } else { k - 1 };
            arcs[inner] = if before.is_none() { arc.with(&arcs[inner]) } else { arcs[inner].with(&arc) };
            arcs[k].depth = 0.0;
        } else if (low - arc.depth) * (arc.depth - high) > 0.0 {
            let at = arc.from + arc.wide() * (arc.depth - high) / (low - high);
            if let Some(before) = k.checked_sub(1) {
                arcs[before].to = at;
            }
            if let Some(after) = arcs.get_mut(k + 1) {
                after.from = at;
            }
            arcs[k].depth = 0.0;
        }
    }
    arcs.retain(|arc| arc.depth > 0.0);
    arcs
}

/// Joins neighbours that belong together.
fn joined(arcs: impl Iterator<Item = Arc>, belong: impl Fn(&Arc, &Arc) -> bool) -> Vec<Arc> {
    let mut all: Vec<Arc> = Vec::new();
    for arc in arcs {
        match all.last_mut().filter(|last| belong(last, &arc)) {
            Some(last) => *last = last.with(&arc),
            None => all.push(arc),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(depths: &[f64]) -> Vec<[f64; 3]> {
        arcs(depths).iter().map(|arc| [arc.from, arc.to, arc.depth]).collect()
    }

    #[test]
    fn walls_lie_within_bins() {
        assert_eq!(found(&[0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.5, 0.0]), [[2.0, 6.5, 1.0]]);
        assert_eq!(found(&[1.0, 1.0, 1.0, 1.0, 0.75, 0.25, 0.0]), [[0.0, 5.0, 1.0]]);
        // At the tool's side there is none.
        assert_eq!(found(&[0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]), [[3.0, 7.0, 1.0]]);
        let steps = [2.0, 2.0, 2.0, 2.0, 1.5, 1.0, 1.0, 1.0, 1.0];
        assert_eq!(found(&steps), [[0.0, 4.5, 2.0], [4.5, 9.0, 1.0]]);
        assert_eq!(found(&[0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]), [[1.0, 2.0, 1.0], [5.0, 9.0, 1.0]]);
        assert_eq!(found(&[0.0; 5]), [[0.0; 3]; 0]);
        let [[from, to, depth]] = found(&[0.7, 1.0, 1.0, 1.0, 1.0, 1.0])[..] else { panic!("one arc") };
        assert!(from == 0.0 && to == 6.0 && (depth - 0.95).abs() < 1e-12);
    }

    #[test]
    fn nothing_is_lost_in_bins() {
        let mut bins = vec![0.0; 7];
        for k in 0..1000 {
            spread(&mut bins, f64::from(k) / 499.5 - 1.0, 1.0);
        }
        assert!((bins.iter().sum::<f64>() - 1000.0).abs() < 1e-9);
        assert!(bins.iter().all(|bin| (bin / (1000.0 / 7.0) - 1.0).abs() < 0.01), "{bins:?}");
    }
}
