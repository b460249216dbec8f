//! Which products the additions take up: `a * b + c` is one instruction on
//! targets with a fused multiply-add, and one rounding less.
//!
//! Rust never fuses on its own, so the generated code says where. Gain: a
//! fifth of the instructions of a compliance; without the instruction,
//! `Real::mul_add` is the product and the sum that it was. Source for people
//! keeps the operators.
//!
//! Only a product that nothing else uses: what is left of another would be
//! multiplied twice, and batches, whose additions have room beside the
//! multiplications, would wait for these. Gain: `benches/README.md`.

use std::collections::BTreeSet;

use super::turns::Turns;
use crate::function::Function;
use crate::op::{Id, Op};

/// A sum of a product and of the rest, each with its sign: `x.mul_add(y, rest)`.
pub(super) struct FusedSum {
    /// The factors of the product.
    pub factors: (Id, Id),
    /// Whether it is subtracted.
    pub product_is_negative: bool,
    /// The other summand.
    pub rest: Id,
    /// Whether that is subtracted.
    pub rest_is_negative: bool,
}

/// For every node, the operand that is a product and is computed together
/// with it.
pub(super) struct Fusion {
    product: Vec<Option<Id>>,
    uses: Vec<usize>,
}

impl Fusion {
    /// Nothing is fused.
    pub fn none(function: &Function) -> Self {
        let uses = function.uses();
        Self { product: vec![None; uses.len()], uses }
    }

    /// What sums take up, and what is left to use each node.
    pub fn of(function: &Function, turns: &Turns) -> Self {
        let product = products(function, turns);
        let uses = uses_left(function, turns, &product);
        Self { product, uses }
    }

    /// What a sum is that takes up a product.
    pub fn sum(&self, function: &Function, id: Id) -> Option<FusedSum> {
        let product = self.product[id]?;
        let nodes = function.graph().nodes();
        let Op::Mul(x, y) = nodes[product].op else { return None };
        let (rest, product_is_negative, rest_is_negative) = match nodes[id].op {
            Op::Add(a, b) => (if a == product { b } else { a }, false, false),
            Op::Sub(a, b) if a == product => (b, false, true),
            Op::Sub(a, _) => (a, true, false),
            _ => return None,
        };
        Some(FusedSum { factors: (x, y), product_is_negative, rest, rest_is_negative })
    }

    /// Whether anything is left that uses a node's value.
    pub fn is_used(&self, id: Id) -> bool {
        self.uses[id] > 0
    }
}

/// Lets every sum take up one product: of two, the one that makes the sum known earlier.
fn products(function: &Function, turns: &Turns) -> Vec<Option<Id>> {
    let graph = function.graph();
    let (nodes, uses) = (graph.nodes(), function.uses());
    let is_product = |id: Id| match nodes[id].op {
        _ if nodes[id].constant.is_some() || turns.with(id).is_some() => false,
        Op::Mul(..) => uses[id] == 1,
        _ => false,
    };
    let mut ready: Vec<usize> = Vec::with_capacity(nodes.len());
    let mut product = Vec::with_capacity(nodes.len());
    for node in nodes.iter() {
        let last = |operands: &mut dyn Iterator<Item = Id>| operands.map(|id| ready[id]).max().unwrap_or(0);
        let fused =
            |taken: Id, other: Id| last(&mut nodes[taken].op.operands().chain([other])) + nodes[taken].op.latency();
        let taken = match node.op {
            Op::Add(a, b) | Op::Sub(a, b) if node.constant.is_none() && a != b => {
                let candidates = [(b, a), (a, b)].into_iter().filter(|&(taken, _)| is_product(taken));
                candidates.map(|(taken, other)| (fused(taken, other), taken)).min_by_key(|(done, _)| *done)
            }
            _ => None,
        };
        let done = match (taken, node.op) {
            _ if node.constant.is_some() => 0,
            (Some((done, _)), _) => done,
            (None, op) => last(&mut op.operands()) + op.latency(),
        };
        product.push(taken.map(|(_, taken)| taken));
        ready.push(done);
    }
    product
}

/// How often each node is used once sums have taken up their products.
fn uses_left(function: &Function, turns: &Turns, product: &[Option<Id>]) -> Vec<usize> {
    let graph = function.graph();
    let nodes = graph.nodes();
    let mut uses = vec![0; nodes.len()];
    for &output in function.outputs() {
        uses[output] += 1;
    }
    let mut written = BTreeSet::new();
    // Also signs that only a turn needs, which are not live in the graph.
    for id in (0..nodes.len()).rev() {
        if uses[id] == 0 {
            continue;
        }
        if let Some(turn) = turns.with(id) {
            if written.insert(turn.first()) {
                turn.operands().for_each(|operand| uses[operand] += 1);
            }
            continue;
        }
        for operand in nodes[id].op.operands() {
            let used =
                if product[id] == Some(operand) { nodes[operand].op.operands().collect() } else { vec![operand] };
            used.into_iter().for_each(|operand| uses[operand] += 1);
        }
    }
    uses
}
