//! How an arm yields to the loads of all rows.

use std::rc::Rc;

use nalgebra::{DVector, Vector3, Vector6};
use robstiff::JointKind;

use crate::model::law::shares_since;
use crate::model::{EachRow, Parameter, Spring, Stand, Term, Torques};

/// An arm that stands somewhere at each row, under a load.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// Turning or sliding, a joint each.
    pub kinds: Vec<JointKind>,
    /// Where the arm stands, a station each.
    pub stands: Vec<Stand>,
    /// The station of each row.
    pub station: Vec<usize>,
    /// The wrench at the tool centre point of each row, in the base frame (N, Nm).
    pub wrenches: Vec<Vector6<f64>>,
    /// The twist of the tool centre point per unit of each joint, row by row: columns of the
    /// Jacobian.
    pub twists: Vec<Vec<Vector6<f64>>>,
    /// The torque of the load on each joint (from 0), through all rows (Nm or N).
    pub torques: Vec<Vec<f64>>,
}

impl Loaded {
    /// An arm that stands so, under these wrenches.
    pub fn new(kinds: &[JointKind], stands: Vec<Stand>, station: Vec<usize>, wrenches: Vec<Vector6<f64>>) -> Self {
        let of_stand = |stand: &Stand| -> Vec<Vector6<f64>> {
            (0..kinds.len()).map(|joint| stand.joint_screw(joint, kinds[joint]).twist_at(&stand.tcp.at)).collect()
        };
        let jacobians: Vec<Vec<Vector6<f64>>> = stands.iter().map(of_stand).collect();
        let torque = |joint: usize| -> Vec<f64> {
            station.iter().zip(&wrenches).map(|(&at, wrench)| jacobians[at][joint].dot(wrench)).collect()
        };
        let torques = (0..kinds.len()).map(torque).collect();
        Self { kinds: kinds.to_vec(), stands, station, wrenches, twists: jacobians, torques }
    }

    /// The twist of the tool centre point per unit of a joint (from 0) at a row.
    pub fn twist(&self, row: usize, joint: usize) -> &Vector6<f64> {
        &self.twists[self.station[row]][joint]
    }
}

/// What the laws of joints need to know of all rows beside the torques of the loads.
#[derive(Clone, Debug, Default)]
pub struct Sequence {
    /// What the arm's own weight puts on each joint (from 0), through all rows (Nm or N).
    pub preload: Vec<Vec<f64>>,
    /// All that it weighs on each, if nothing compensates for it, likewise.
    pub weight: Vec<Vec<f64>>,
    /// The coordinate of each joint (from 0), through all rows.
    pub q: Vec<Vec<f64>>,
    /// The visit of each row.
    pub visit: Vec<usize>,
    /// For how long it has lasted (s).
    pub in_visit: Vec<f64>,
}

impl Sequence {
    /// What a law sees of a joint (from 0).
    pub fn torques<'a>(&'a self, loaded: &'a Loaded, joint: usize) -> Torques<'a> {
        Torques {
            load: &loaded.torques[joint],
            preload: &self.preload[joint],
            weight: &self.weight[joint],
            q: &self.q[joint],
            all: &self.q,
            visit: &self.visit,
            in_visit: &self.in_visit,
        }
    }
}

/// How far an arm yields.
pub struct Yielding {
    /// The twist `[d; r]` of the tool centre point, row by row (m, rad).
    pub twists: Vec<Vector6<f64>>,
    /// The turn of each joint (from 0) whose encoder is read, through all rows.
    pub turns: Vec<Vec<f64>>,
}

impl Yielding {
    fn none(rows: usize, encoders: usize) -> Self {
        Self { twists: vec![Vector6::zeros(); rows], turns: vec![vec![0.0; rows]; encoders] }
    }

    fn add(&mut self, other: &Self, share: f64) {
        self.twists.iter_mut().zip(&other.twists).for_each(|(sum, more)| *sum += more * share);
        for (sum, more) in self.turns.iter_mut().zip(&other.turns) {
            sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more * share);
        }
    }

    /// With what grows of it.
    pub fn grown(mut self, growths: &[(Shares, f64)]) -> Self {
        let more: Vec<Self> = growths.iter().map(|(shares, _)| self.shared_by(shares)).collect();
        more.iter().zip(growths).for_each(|(part, (_, value))| self.add(part, *value));
        self
    }

    /// The sum of what rows have, each by its share.
    pub fn shared_by(&self, shares: &Shares) -> Self {
        let twist = |of: &Vec<(usize, f64)>| of.iter().map(|(row, share)| self.twists[*row] * *share).sum();
        let turn = |turns: &Vec<f64>| -> Vec<f64> {
            shares.iter().map(|of| of.iter().map(|(row, share)| turns[*row] * share).sum()).collect()
        };
        Self { twists: shares.iter().map(twist).collect(), turns: self.turns.iter().map(turn).collect() }
    }
}

/// What a unit of a parameter makes the arm yield; none of one that does not yield. `encoders` are
/// the joints (from 1) whose turn is read.
pub fn yielding(term: &Term, loaded: &Loaded, sequence: &Sequence, encoders: &[usize]) -> Option<Yielding> {
    let rows = loaded.wrenches.len();
    // The rows of a station share where a spring is.
    let parts_of =
        |spring: &Spring| -> Vec<_> { loaded.stands.iter().map(|stand| spring.parts(stand, &loaded.kinds)).collect() };
    match term {
        Term::Spring(spring) => {
            let parts = parts_of(spring);
            let twist = |(&at, wrench): (&usize, &Vector6<f64>)| parts[at].iter().map(|part| part.twist(wrench)).sum();
            let twists = loaded.station.iter().zip(&loaded.wrenches).map(twist).collect();
            let turn = |&joint: &usize| -> Vec<f64> {
                (0..rows).map(|row| spring.turn_of(joint, |other| loaded.torques[other - 1][row])).collect()
            };
            Some(Yielding { twists, turns: encoders.iter().map(turn).collect() })
        }
        Term::Hardening(spring, knee) => {
            let parts = parts_of(spring);
            let on_it = |(&at, wrench): (&usize, &Vector6<f64>)| {
                parts[at].iter().map(|part| part.by.dot(wrench).powi(2)).sum::<f64>().sqrt()
            };
            let loads: Vec<f64> = loaded.station.iter().zip(&loaded.wrenches).map(on_it).collect();
            let knee = (knee * loads.iter().copied().fold(0.0, f64::max)).max(f64::MIN_POSITIVE);
            let twist = |(row, wrench): (usize, &Vector6<f64>)| -> Vector6<f64> {
                let linear: Vector6<f64> = parts[loaded.station[row]].iter().map(|part| part.twist(wrench)).sum();
                linear / (loads[row] / knee).hypot(1.0)
            };
            let twists = loaded.wrenches.iter().enumerate().map(twist).collect();
            Some(Yielding { twists, turns: vec![vec![0.0; rows]; encoders.len()] })
        }
        Term::Law(joint, law) => {
            let turns = law(&sequence.torques(loaded, joint - 1));
            let twists = turns.iter().enumerate().map(|(row, turn)| loaded.twist(row, joint - 1) * *turn);
            let twists = twists.collect();
            let of = |encoder: &usize| if encoder == joint { turns.clone() } else { vec![0.0; rows] };
            Some(Yielding { twists, turns: encoders.iter().map(of).collect() })
        }
        Term::Laws(law) => {
            let mut sum = Yielding::none(rows, encoders.len());
            for joint in 1..=loaded.kinds.len() {
                let own = law.clone();
                let law = Term::Law(joint, Rc::new(move |torques: &Torques<'_>| own(joint, torques)));
                yielding(&law, loaded, sequence, encoders).into_iter().for_each(|part| sum.add(&part, 1.0));
            }
            Some(sum)
        }
        Term::Aside(..)
        | Term::Asides(_)
        | Term::Table(..)
        | Term::World(_)
        | Term::Reading(_)
        | Term::Gain(_)
        | Term::Creep(_) => None,
    }
}

/// How far the arm yields with all parameters at these values, but for what [grows](growths) of it.
pub fn sum(
    parameters: &[Parameter],
    values: &[f64],
    (loaded, sequence): (&Loaded, &Sequence),
    encoders: &[usize],
) -> Yielding {
    let mut sum = Yielding::none(loaded.wrenches.len(), encoders.len());
    for (parameter, &value) in parameters.iter().zip(values).filter(|(_, value)| **value != 0.0) {
        if let Some(part) = yielding(&parameter.term, loaded, sequence, encoders) {
            sum.add(&part, value);
        }
    }
    sum
}

/// The share that rows have in what a row yields, by their numbers.
pub type Shares = Vec<Vec<(usize, f64)>>;

/// What a unit of a parameter makes of what the arm yields anyway; none of one that makes nothing of it.
pub fn grown_by(term: &Term, sequence: &Sequence, each: &mut EachRow<'_>) -> Option<Shares> {
    match term {
        Term::Gain(gain) => {
            let mut shares = Vec::new();
            each(&mut |at| shares.push(vec![(at.row, gain(at))]));
            Some(shares)
        }
        Term::Creep(grows) => Some(shares_since(&sequence.visit, &sequence.in_visit, &**grows)),
        _ => None,
    }
}

/// What all parameters make of what the arm yields anyway, each with its value; nothing where none does.
pub fn growths(
    parameters: &[Parameter],
    values: &[f64],
    sequence: &Sequence,
    each: &mut EachRow<'_>,
) -> Vec<(Shares, f64)> {
    let own = parameters.iter().zip(values).filter(|(_, value)| **value != 0.0);
    own.filter_map(|(parameter, value)| Some((grown_by(&parameter.term, sequence, each)?, *value))).collect()
}

/// By how much each joint stands aside at each station, as rotation vectors in its own frame; empty
/// where none does.
pub fn asides(
    parameters: &[Parameter],
    values: &[f64],
    joints: usize,
    each: &mut EachRow<'_>,
) -> Vec<Vec<Vector3<f64>>> {
    let own = parameters.iter().zip(values).filter(|(_, value)| **value != 0.0);
    let own: Vec<_> =
        own.filter(|(parameter, _)| matches!(parameter.term, Term::Aside(..) | Term::Asides(_))).collect();
    if own.is_empty() {
        return Vec::new();
    }
    let mut asides = Vec::new();
    each(&mut |at| {
        let mut aside = vec![Vector3::zeros(); joints];
        for (parameter, value) in own.iter().map(|(parameter, value)| (parameter, **value)) {
            match &parameter.term {
                Term::Aside(joint, axis, of) => aside[joint - 1][*axis] += of(at) * value,
                Term::Asides(of) => (1..=joints).for_each(|joint| aside[joint - 1].z += of(at, joint) * value),
                _ => {}
            }
        }
        asides.push(aside);
    });
    asides
}

/// Stacks so many numbers of each row.
pub fn stacked(rows: usize, width: usize, of: impl Fn(usize, &mut [f64])) -> DVector<f64> {
    let mut stacked = DVector::zeros(rows * width);
    stacked.as_mut_slice().chunks_mut(width.max(1)).enumerate().for_each(|(row, numbers)| of(row, numbers));
    stacked
}
