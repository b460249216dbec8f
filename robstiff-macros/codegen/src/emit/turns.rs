//! Which turns are one operation: `T::turn_blocks`.
//!
//! A turn about z does the same to all four blocks of a compliance, so a scalar
//! that has vectors holds the blocks in the lanes of one. Putting entries into
//! lanes and taking them out costs as much as it saves where several are zero;
//! those turns stay products and sums, and so do all in source for people.
//! Gain: `benches/README.md`.

use std::collections::{BTreeMap, BTreeSet};

use crate::function::Function;
use crate::graph::{BlockTurn, Node};
use crate::op::{Id, Op};

/// The turns of a function that are written as one operation.
pub(super) struct Turns(Vec<Turn>);

/// One of them.
pub(super) struct Turn {
    /// Its nodes.
    pub nodes: BlockTurn,
    results: BTreeMap<Id, Lane>,
}

/// Where a node stands in the result of a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lane {
    pub row: usize,
    pub lane: usize,
    /// Whether the node is the negative of what stands there: signs move
    /// outwards and into differences.
    pub is_negated: bool,
}

/// Of the 20 entries of a turn, how many must not be zero.
const DENSE: usize = 18;

impl Turns {
    /// None.
    pub fn none() -> Self {
        Self(Vec::new())
    }

    /// Those that are dense.
    pub fn of(function: &Function) -> Self {
        let graph = function.graph();
        let nodes = graph.nodes();
        Self(graph.block_turns().iter().filter_map(|turn| Turn::of(turn, &nodes)).collect())
    }

    /// The turn that a node is a result of.
    pub fn with(&self, id: Id) -> Option<&Turn> {
        self.0.iter().find(|turn| turn.results.contains_key(&id))
    }

    /// What no output depends on and goes into a turn all the same, which takes whole blocks; with
    /// the constants that this is made of.
    pub fn besides(&self, function: &Function) -> BTreeSet<Id> {
        let (nodes, uses) = (function.graph().nodes(), function.uses());
        let mut besides = BTreeSet::new();
        let mut left: Vec<Id> = self.0.iter().flat_map(Turn::operands).collect();
        while let Some(id) = left.pop() {
            if nodes[id].constant.is_some() {
                besides.insert(id);
            } else if uses[id] == 0 && besides.insert(id) {
                left.extend(nodes[id].op.operands());
            }
        }
        besides
    }

    /// The results of all turns.
    pub fn results(&self) -> impl Iterator<Item = Id> {
        self.0.iter().flat_map(|turn| turn.results.keys().copied())
    }
}

impl Turn {
    fn of(turn: &BlockTurn, nodes: &[Node]) -> Option<Self> {
        let mut results = BTreeMap::new();
        for (row, entries) in turn.after.iter().enumerate() {
            for (lane, &id) in entries.iter().enumerate() {
                let (id, is_negated) = if let Op::Neg(inner) = nodes[id].op { (inner, true) } else { (id, false) };
                results.entry(id).or_insert(Lane { row, lane, is_negated });
                // The negative of a difference is the other difference.
                let Op::Sub(a, b) = nodes[id].op else { continue };
                let other = nodes.iter().position(|node| node.op == Op::Sub(b, a));
                if let Some(other) = other.filter(|&other| other > id) {
                    results.entry(other).or_insert(Lane { row, lane, is_negated: !is_negated });
                }
            }
        }
        let (sin, cos) = turn.sin_cos;
        // Constants meet other constants in products and sums.
        let is_constant = nodes[sin].constant.is_some() || nodes[cos].constant.is_some();
        let turn = Self { nodes: turn.clone(), results };
        let last_operand = turn.operands().max()?;
        let is_new = turn.first() > last_operand && turn.results.keys().all(|&id| nodes[id].constant.is_none());
        let there = turn.nodes.before.iter().flatten().filter(|&&id| nodes[id].constant != Some(0.0)).count();
        (is_new && !is_constant && there >= DENSE).then_some(turn)
    }

    /// The first node that it results in.
    pub fn first(&self) -> Id {
        *self.results.keys().next().expect("a turn has results")
    }

    /// The nodes that it results in, with their places.
    pub fn results(&self) -> impl Iterator<Item = (Id, Lane)> {
        self.results.iter().map(|(&id, &lane)| (id, lane))
    }

    /// What goes into it.
    pub fn operands(&self) -> impl Iterator<Item = Id> {
        let (sin, cos) = self.nodes.sin_cos;
        self.nodes.before.iter().flatten().copied().chain([sin, cos])
    }
}
