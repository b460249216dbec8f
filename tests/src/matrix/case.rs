//! Which campaigns there are, and how large what is hidden in them.

use nalgebra::DVector;
use rand::seq::{IndexedRandom, SliceRandom};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_robots::Description;

use super::alias::everything;
use super::draw::{KINDS, OUTSIDE, draw, needs_ramps, takes_hours};
use super::visible::{Seen, missed, seen};
use crate::simulator::{Hidden, Mount, Scenario, five_axis, scattered, six_axis};

/// What leaves this many times the noise of a reading, once the joints have
/// been fitted again, is large enough to matter.
pub const MATTERS: f64 = 2.0;

/// What leaves this many times the noise of a reading, whichever effect of the
/// catalogue is fitted besides the joints, is outside the catalogue: over 1200
/// readings of a campaign no name can be taken for all of it.
pub const IS_OUTSIDE: f64 = 1.0;

/// What leaves less than this many times the noise cannot be expected to be
/// seen: over 1200 readings of a campaign, its square sum is some 100 times
/// the noise's variance, that of an average reading a tenth of it.
pub const HARDLY_SEEN: f64 = 0.3;

/// The number of poses of a campaign of the usual size.
pub const POSES: usize = 40;

/// Draws before a kind is taken to be too small everywhere on an arm.
const TRIES: usize = 12;

/// Multiples of [`MATTERS`] (or [`IS_OUTSIDE`]) that sizes are drawn from.
const SIZES: [f64; 2] = [1.05, 2.5];

/// What a campaign is one of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Nothing is hidden.
    Nothing,
    /// One effect of a kind of the catalogue.
    One(&'static str),
    /// So many effects of the catalogue, of different kinds.
    Several(usize),
    /// One thing outside the catalogue.
    Outside(&'static str),
    /// One effect of the catalogue, and beside it one thing that is outside.
    Beside,
}

impl Group {
    /// A name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::One(kind) | Self::Outside(kind) => kind,
            Self::Several(2) => "two",
            Self::Several(_) => "three",
            Self::Beside => "beside",
        }
    }

    /// Whether something outside the catalogue is hidden, alone or beside an effect.
    pub fn hides_what_is_outside(self) -> bool {
        matches!(self, Self::Outside(_) | Self::Beside)
    }

    /// How many times the noise of a reading something of this group has to leave to show.
    pub fn enough(self) -> f64 {
        if matches!(self, Self::Outside(_)) { IS_OUTSIDE } else { MATTERS }
    }

    /// How many of a matrix of 496 campaigns are of this group.
    pub fn share(self) -> usize {
        match self {
            Self::Nothing => 80,
            Self::One(_) | Self::Outside(_) => 8,
            Self::Several(2) | Self::Beside => 48,
            Self::Several(_) => 32,
        }
    }
}

/// So many campaigns of each of some groups, at least one: their shares of a count.
pub fn shares(groups: &[Group], count: usize) -> impl Iterator<Item = (Group, usize)> {
    let all: usize = groups.iter().map(|group| group.share()).sum();
    groups.iter().map(move |&group| (group, (count * group.share()).div_ceil(all)))
}

/// All groups.
pub fn groups() -> Vec<Group> {
    let mut all = vec![Group::Nothing];
    all.extend(KINDS.map(Group::One));
    all.extend([Group::Several(2), Group::Several(3)]);
    all.extend(OUTSIDE.map(Group::Outside));
    all.push(Group::Beside);
    all
}

/// One campaign of the matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// What is hidden in it.
    pub group: Group,
    /// Which one of the group, from 0.
    pub replicate: usize,
    /// Seed of everything random.
    pub seed: u64,
    /// Whether the arm is the one of six axes, not the one of five.
    pub six_axes: bool,
    /// Whether the rows of a visit share an unloaded reading.
    pub shares_unloaded: bool,
    /// Whether rotations are measured.
    pub rotations: bool,
    /// The number of poses, of ten rows each.
    pub poses: usize,
}

/// What is to be expected of tracing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// That it names nothing, for nothing is hidden.
    Nothing,
    /// That it names what is hidden.
    Names,
    /// That it names nothing wrong, if anything at all: what is hidden cannot be
    /// seen, or is something that the joints can do.
    Unseen,
    /// That it tells neither names as the whole truth nor that nothing is missing,
    /// for something is hidden that has no name and shows.
    NoWholeTruth,
    /// Nothing: of what is hidden something is, at its largest, neither large enough to
    /// matter nor, where it is alone, small enough not to be seen. Names that are wrong
    /// are counted as such all the same, and so is what misleads.
    Doubtful,
}

/// A case with sizes.
#[derive(Clone, Debug)]
pub struct Ready {
    /// The case.
    pub case: Case,
    /// The arm as declared.
    pub declared: Description,
    /// The campaign.
    pub scenario: Scenario,
    /// What each hidden thing leaves, in multiples of the noise of a reading,
    /// once the joints and the others have been fitted; of a thing outside the
    /// catalogue that is alone, once the joints and the likest of the catalogue have been.
    pub left: Vec<f64>,
    /// What is to be expected.
    pub expected: Expected,
}

impl Case {
    /// The case of a group; arms, unloaded readings and rotations take turns,
    /// so that eight in a row have every combination.
    pub fn new(group: Group, replicate: usize, seed: u64) -> Self {
        // Fowler, Noll and Vo's hash, so that a group has the same campaigns in
        // any selection.
        let bytes = group.name().bytes().chain(replicate.to_le_bytes()).chain(seed.to_le_bytes());
        let hash =
            bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
        let bit = |place: usize| (replicate >> place) & 1 == 1;
        Self {
            group,
            replicate,
            seed: hash,
            six_axes: bit(0),
            shares_unloaded: !bit(1),
            rotations: bit(2),
            poses: POSES,
        }
    }

    /// Draws what is hidden and finds its size.
    pub fn ready(self) -> Ready {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let declared = if self.six_axes { six_axis() } else { five_axis() };
        let truth = scattered(&declared, 0.7..1.3, self.seed.wrapping_add(1));
        let noise = random.random_range(6e-6..15e-6);
        let moments: bool = random.random();
        let plain = Scenario {
            noise,
            rotation_noise: self.rotations.then_some(5e-5),
            moment: (self.rotations && moments).then_some([50.0, 200.0]),
            shares_unloaded: self.shares_unloaded,
            poses: self.poses,
            swing: 0.5,
            ..Scenario::new(truth, Vec::new(), self.seed)
        };
        let (count, expected) = match self.group {
            Group::Nothing => {
                return Ready { case: self, declared, scenario: plain, left: Vec::new(), expected: Expected::Nothing };
            }
            Group::One(_) => (1, Expected::Names),
            Group::Several(count) => (count, Expected::Names),
            Group::Outside(_) => (1, Expected::NoWholeTruth),
            Group::Beside => (2, Expected::NoWholeTruth),
        };
        let enough = self.group.enough();
        let mut largest: Option<Ready> = None;
        for _ in 0..TRIES {
            let kinds = match self.group {
                Group::One(kind) | Group::Outside(kind) => vec![kind],
                Group::Beside => beside(&mut random),
                _ => several(count, &mut random),
            };
            let tool = random.random();
            let scenario = Scenario {
                shares_unloaded: self.shares_unloaded || kinds.iter().any(|kind| needs_ramps(kind)),
                unloaded_first: kinds.iter().any(|kind| takes_hours(kind)),
                wrench_in_tool: tool && kinds.iter().any(|kind| kind.starts_with("load_cell")),
                ..plain.clone()
            };
            let mount = if scenario.wrench_in_tool { Mount::Tool } else { Mount::Ground };
            let drawn: Vec<_> = kinds.iter().map(|kind| draw(kind, &scenario.truth, mount, &mut random)).collect();
            let targets: Vec<f64> =
                kinds.iter().map(|_| enough * (random.random_range(SIZES[0].ln()..SIZES[1].ln())).exp()).collect();
            let hidden: Vec<(Hidden, f64)> = drawn.into_iter().map(|one| (one.hidden, one.most)).collect();
            let likest = match self.group {
                Group::Outside(_) => everything(&scenario),
                _ => vec![Vec::new()],
            };
            let (hidden, left) = sized(&scenario, &hidden, &targets, &likest);
            let smallest = left.iter().copied().fold(f64::INFINITY, f64::min);
            let hides_all = hidden.iter().all(|one| one.most_is_meant());
            let expected = match () {
                () if smallest >= enough => expected,
                () if smallest < HARDLY_SEEN && count == 1 => Expected::Unseen,
                () => Expected::Doubtful,
            };
            let ready = Ready {
                case: self.clone(),
                declared: declared.clone(),
                scenario: Scenario { hidden, ..scenario },
                left,
                expected,
            };
            if smallest >= enough || hides_all {
                return ready;
            }
            let before = largest.as_ref().map_or(0.0, |ready| ready.left.iter().copied().fold(f64::INFINITY, f64::min));
            if smallest >= before {
                largest = Some(ready);
            }
        }
        largest.expect("there was a try")
    }
}

impl Ready {
    /// Whether something is hidden that shows: a description that is told to lack nothing
    /// leaves it unexplained.
    pub fn hides_what_shows(&self) -> bool {
        self.left.iter().any(|left| *left >= self.case.group.enough())
    }
}

impl Hidden {
    /// Whether it is of one size only, seen or not: weight, and a scale that is
    /// common to all axes.
    fn most_is_meant(&self) -> bool {
        match self {
            Self::GravitySag(_) => true,
            Self::LoadCellScale { scale, .. } => scale[0] == scale[1] && scale[1] == scale[2],
            _ => false,
        }
    }
}

/// Different kinds of the catalogue, of those that can matter.
fn several(count: usize, random: &mut ChaCha8Rng) -> Vec<&'static str> {
    let mut kinds: Vec<&str> = KINDS.into_iter().filter(|kind| *kind != "gravity_sag").collect();
    kinds.shuffle(random);
    kinds.truncate(count);
    kinds
}

/// A kind of the catalogue, of those that can matter, and one that is outside.
fn beside(random: &mut ChaCha8Rng) -> Vec<&'static str> {
    let mut kinds = several(1, random);
    kinds.extend(OUTSIDE.choose(random));
    kinds
}

/// Each hidden thing of such a size that it leaves its target, in multiples of
/// the noise, once the joints and the others have been fitted, or as large as
/// it can be; and what each leaves, whichever of the columns in `likest` are
/// fitted besides.
fn sized(
    scenario: &Scenario,
    hidden: &[(Hidden, f64)],
    targets: &[f64],
    likest: &[Vec<DVector<f64>>],
) -> (Vec<Hidden>, Vec<f64>) {
    let mut factors = vec![1.0; hidden.len()];
    let mut best = (Vec::new(), Vec::new());
    for round in 0..6 {
        let now: Vec<Hidden> =
            hidden.iter().zip(&factors).map(|((hidden, _), factor)| hidden.scaled(*factor)).collect();
        let left = leaves(scenario, &now, likest);
        let done = left.iter().zip(targets).all(|(left, target)| (left / target - 1.0).abs() < 0.03);
        let next: Vec<f64> = factors
            .iter()
            .zip(hidden)
            .zip(left.iter().zip(targets))
            .map(|((factor, (_, most)), (left, target))| {
                (factor * (target / left.max(1e-9)).clamp(0.1, 10.0)).min(*most)
            })
            .collect();
        let stays = round > 0 && next.iter().zip(&factors).all(|(next, factor)| next == factor);
        best = (now, left);
        if done || stays {
            break;
        }
        factors = next;
    }
    best
}

/// What each of several hidden things leaves once the joints and the others,
/// each in proportion to what it does alone, have been fitted, and whichever of
/// the columns in `likest` accounts for most.
fn leaves(scenario: &Scenario, hidden: &[Hidden], likest: &[Vec<DVector<f64>>]) -> Vec<f64> {
    let first: Seen = seen(scenario, &hidden[..1]);
    // Only a load cell's fault changes what the joints could do, by next to
    // nothing.
    let rest = hidden[1..].iter().map(|one| missed(scenario, one));
    let alone: Vec<DVector<f64>> = std::iter::once(first.missed.clone()).chain(rest).collect();
    let one = |index: usize| {
        let others: Vec<_> = (0..alone.len()).filter(|&other| other != index).map(|other| &alone[other]).collect();
        let left = likest.iter().map(|more| {
            let fitted: Vec<_> = others.iter().copied().chain(more).collect();
            first.left(&alone[index], &fitted)
        });
        left.fold(f64::INFINITY, f64::min)
    };
    (0..alone.len()).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_cases_have_every_combination() {
        let cases: Vec<Case> = (0..8).map(|replicate| Case::new(Group::Nothing, replicate, 1)).collect();
        for (k, one) in cases.iter().enumerate() {
            for other in &cases[..k] {
                let plan = |case: &Case| (case.six_axes, case.shares_unloaded, case.rotations);
                assert!(plan(one) != plan(other) && one.seed != other.seed);
            }
        }
        assert_eq!(groups().iter().map(|group| group.share()).sum::<usize>(), 496);
    }

    #[test]
    fn sizes_matter_after_the_joints_have_been_fitted() {
        for (group, replicate) in [
            (Group::One("transverse_compliance"), 0),
            (Group::One("load_cell_bias"), 5),
            (Group::One("base_slip"), 3),
            (Group::Several(2), 1),
            (Group::Outside("cable"), 2),
        ] {
            let ready = Case::new(group, replicate, 7).ready();
            assert!(matches!(ready.expected, Expected::Names | Expected::NoWholeTruth), "{ready:?}");
            let enough = if ready.expected == Expected::Names { MATTERS } else { IS_OUTSIDE };
            assert!(ready.left.iter().all(|left| (enough..3.0 * enough).contains(left)), "{:?}", ready.left);
            let of_joints = leaves(&ready.scenario, &ready.scenario.hidden, &[Vec::new()]);
            let likest = ready.left.iter().zip(&of_joints);
            assert!(likest.clone().all(|(left, of_joints)| left <= of_joints), "{:?} {of_joints:?}", ready.left);
            assert_eq!(ready.left == of_joints, !matches!(group, Group::Outside(_)));
        }
        let sag = Case::new(Group::One("gravity_sag"), 0, 7).ready();
        assert_eq!(sag.expected, Expected::Unseen, "{:?}", sag.left);
    }
}
