//! Constants that are multiplied by, moved to where they cost nothing.
//!
//! A compliance is a sum of `(sqrt(h) T) (sqrt(h) R)^T`, so that columns are multiplied by
//! roots of compliances and by lengths. An expression may be computed times a scale of its
//! own instead, if what is made of it is too: a sum has the scale of its summands, a product
//! the product of its factors' scales, and a result is as it is. Nothing is lost with a sine
//! or a cosine that is scaled ([`Graph::factors`]: a constant of its polynomial is) or where
//! a constant stands anyway. So every scale is an unknown, every operation an equation, and
//! every product with a constant `k` of `x` would vanish if `k x` had `k` times the scale of
//! `x`: the equations of those are added one by one, columns before numbers and long chains
//! of operations before short ones, where they do not contradict the others.
//!
//! Only for scalars that compute with columns, and whose code nobody reads. Gain:
//! `benches/README.md`.

mod system;

use std::cell::Ref;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use self::system::{Equation, System, is_one};
use crate::function::Function;
use crate::graph::{Graph, Node, Sym};
use crate::op::{Id, Op};
use crate::symbolic::column::Column;

/// The function with scales, if it has fewer operations so.
pub fn with_scales(function: Function) -> Function {
    if !function.graph().block_turns().is_empty() {
        return function;
    }
    let scaled = Scaling::of(&function).rewritten();
    match scaled {
        Some(scaled) if scaled.cost_in_columns() < function.cost_in_columns() => scaled,
        _ => function,
    }
}

/// What is scaled by how much.
struct Scaling<'f> {
    graph: &'f Graph,
    outputs: &'f [Id],
    nodes: Ref<'f, [Node]>,
    uses: Vec<usize>,
    /// The scales that are not 1.
    scales: BTreeMap<Id, f64>,
}

/// What it is worth if an equation holds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Gain {
    /// A product of a column less.
    Column,
    /// One of numbers less, which are known earlier.
    Number,
    /// A sum where there would be a fused product, which takes a pipe of the products.
    Sum,
}

impl<'f> Scaling<'f> {
    fn of(function: &'f Function) -> Self {
        let (graph, outputs) = (function.graph(), function.outputs());
        let mut scaling = Self { graph, outputs, nodes: graph.nodes(), uses: function.uses(), scales: BTreeMap::new() };
        let mut system = System::default();
        for equation in scaling.demands() {
            // No two contradict each other: with no scales at all they hold.
            system.demand(equation);
        }
        let mut wishes = scaling.wishes();
        let delays = scaling.delays();
        wishes.sort_by_key(|&(gain, id, _)| (gain, Reverse(delays[id]), Reverse(id)));
        for (_, _, equation) in wishes {
            system.demand(equation);
        }
        scaling.scales = system.scales();
        scaling
    }

    fn live(&self) -> impl Iterator<Item = (Id, Op)> {
        (0..self.nodes.len()).filter(|&id| self.uses[id] > 0).map(|id| (id, self.nodes[id].op))
    }

    /// Those that depend on an input.
    fn varying(&self) -> impl Iterator<Item = (Id, Op)> {
        self.live().filter(|&(id, _)| !self.is_constant(id))
    }

    fn is_constant(&self, id: Id) -> bool {
        self.nodes[id].constant.is_some() || Column::of_node(self.graph, id).is_constant()
    }

    /// The summands of a sum: those that must have its scale, and one that may be multiplied
    /// by a constant in the same instruction.
    fn summands(&self, a: Id, b: Id) -> ([Option<Id>; 2], Option<Id>) {
        // A product that the sum takes up leaves no room for another one.
        let is_taken_up = |id: Id| matches!(self.nodes[id].op, Op::Mul(..)) && self.uses[id] == 1;
        let [varying, other] = if self.is_constant(a) { [b, a] } else { [a, b] };
        match (self.is_constant(other), is_taken_up(varying) || is_taken_up(other)) {
            (true, true) => ([Some(varying), None], None),
            (true, false) => ([None, None], Some(varying)),
            (false, true) => ([Some(varying), Some(other)], None),
            (false, false) => ([Some(varying), None], Some(other)),
        }
    }

    /// How long the longest chain of operations through each is.
    fn delays(&self) -> Vec<usize> {
        let mut after = vec![0; self.nodes.len()];
        for (id, op) in (0..self.nodes.len()).rev().map(|id| (id, self.nodes[id].op)) {
            for operand in op.operands().filter(|_| self.uses[id] > 0) {
                after[operand] = after[operand].max(after[id] + op.latency());
            }
        }
        self.nodes.iter().zip(after).map(|(node, after)| node.ready + after).collect()
    }

    /// What must hold.
    fn demands(&self) -> Vec<Equation> {
        let mut equations = Vec::new();
        // Constants are scaled as is wanted wherever they are used.
        let mut is_product = |id: Id, factors: &[Id]| {
            if factors.iter().all(|&factor| !self.is_constant(factor)) {
                equations.push(Equation::new(id, 1.0, factors));
            }
        };
        for (id, op) in self.varying() {
            match op {
                Op::Sin(_) | Op::Cos(_) => {}
                Op::Add(a, b) | Op::Sub(a, b) => {
                    let (demanded, _) = self.summands(a, b);
                    demanded.into_iter().flatten().for_each(|summand| is_product(id, &[summand]));
                }
                Op::Mul(a, b) | Op::Scaled(a, b) | Op::Product(a, b) => is_product(id, &[a, b]),
                Op::PlusScaled(a, b, c) | Op::PlusProduct(a, b, c) => {
                    is_product(id, &[a]);
                    is_product(id, &[b, c]);
                }
                Op::Neg(a) | Op::Cycled(a) | Op::Direction(a) | Op::Entry(a, _) => is_product(id, &[a]),
                Op::Column(entries) => entries.iter().for_each(|&entry| is_product(id, &[entry])),
                // Inputs are as they are, and a root or the larger of two is left alone.
                other => [id].into_iter().chain(other.operands()).for_each(|id| is_product(id, &[])),
            }
        }
        let results = self.outputs.iter().filter(|&&id| !self.is_constant(id));
        equations.extend(results.map(|&id| Equation::new(id, 1.0, &[])));
        equations
    }

    /// What is good to hold, and of which node it speaks.
    fn wishes(&self) -> Vec<(Gain, Id, Equation)> {
        let sums = self
            .varying()
            .filter_map(|(_, op)| if let Op::Add(a, b) | Op::Sub(a, b) = op { Some([a, b]) } else { None });
        let summed: BTreeSet<Id> = sums.flatten().filter(|&id| self.uses[id] == 1).collect();
        let mut wishes = Vec::new();
        for (id, op) in self.varying() {
            if let Op::Add(a, b) | Op::Sub(a, b) = op {
                let (_, free) = self.summands(a, b);
                wishes.extend(free.map(|summand| (Gain::Sum, id, Equation::new(id, 1.0, &[summand]))));
            }
            let Some((constant, other)) = self.factor(op) else { continue };
            // The sign of what is added is that of an instruction.
            let gain = match op {
                Op::PlusScaled(..) | Op::PlusProduct(..) => Gain::Sum,
                _ if summed.contains(&id) => Gain::Sum,
                Op::Mul(..) => Gain::Number,
                _ => Gain::Column,
            };
            if constant > 0.0 || matches!(op, Op::PlusScaled(..)) {
                wishes.push((gain, id, Equation::new(id, constant.abs().recip(), &[other])));
            }
        }
        wishes
    }

    /// The constant factor of a product, and the other one.
    fn factor(&self, op: Op) -> Option<(f64, Id)> {
        let (a, b) = match op {
            Op::Mul(a, b) | Op::Scaled(a, b) | Op::Product(a, b) => (a, b),
            Op::PlusScaled(_, a, b) | Op::PlusProduct(_, a, b) => (a, b),
            _ => return None,
        };
        let (constant, other) = if self.is_constant(a) { (a, b) } else { (b, a) };
        let value = match self.nodes[constant].op {
            Op::Column([x, y, z, w]) if self.nodes[other].op.is_column() => {
                let [x, y, z, w] = [x, y, z, w].map(|entry| self.nodes[entry].constant);
                let is_vector = Column::of_node(self.graph, other).is_zero_at(3);
                x.filter(|_| x == y && y == z && w == Some(0.0) && is_vector)
            }
            _ => self.nodes[constant].constant,
        };
        value.filter(|&value| value != 0.0).map(|value| (value, other))
    }

    /// The function with these scales, if no number is too large or too small for it: of a
    /// joint that is all but rigid a scale may be so small that it is 0 in `f32`.
    fn rewritten(&self) -> Option<Function> {
        if self.scales.values().any(|scale| !(1e-15..1e15).contains(scale)) {
            return None;
        }
        let mut factors = vec![[1.0; 2]; self.graph.angles().len()];
        for (id, op) in self.live() {
            match op {
                Op::Sin(angle) => factors[angle][0] = self.scale(id),
                Op::Cos(angle) => factors[angle][1] = self.scale(id),
                _ => {}
            }
        }
        let graph = self.graph.with_factors(factors);
        let mut written = BTreeMap::new();
        for (id, _) in self.live() {
            let new = Rewriter { scaling: self, graph: &graph, written: &written }.node(id);
            if self.scale(id) == 1.0
                && let Some(name) = self.graph.hints().get(&id)
            {
                new.named(name);
            }
            let new = new.id();
            written.insert(id, new);
        }
        let outputs = self.outputs.iter().map(|id| written[id]).collect();
        Some(Function::new(graph, outputs))
    }

    fn scale(&self, id: Id) -> f64 {
        self.scales.get(&id).copied().unwrap_or(1.0)
    }
}

/// Writes nodes down in another graph.
struct Rewriter<'s, 'g> {
    scaling: &'s Scaling<'s>,
    graph: &'g Graph,
    /// The nodes of the graph by those of the old one.
    written: &'s BTreeMap<Id, Id>,
}

impl<'g> Rewriter<'_, 'g> {
    fn node(&self, id: Id) -> Sym<'g> {
        let node = self.scaling.nodes[id];
        if self.scaling.is_constant(id) {
            return self.graph.intern(node.op.map_operands(|id| self.written[&id]), node.constant);
        }
        let own = self.scaling.scale(id);
        let as_own = |id: Id| self.times(id, own / self.scaling.scale(id));
        let op = match node.op {
            Op::Add(a, b) => Op::Add(as_own(a), as_own(b)),
            Op::Sub(a, b) => Op::Sub(as_own(a), as_own(b)),
            Op::Column(entries) => Op::Column(entries.map(as_own)),
            Op::Mul(a, b) => match self.factors(own, a, b) {
                (one, other) | (other, one) if self.is_one(one) => return self.sym(other),
                (a, b) => Op::Mul(a, b),
            },
            Op::Scaled(a, b) => match self.factors(own, a, b) {
                (column, one) if self.is_one(one) => return self.sym(column),
                (a, b) => Op::Scaled(a, b),
            },
            Op::Product(a, b) => match self.factors(own, a, b) {
                (one, vector) | (vector, one) if self.is_vector_times_one(vector, one) => return self.sym(vector),
                (a, b) => Op::Product(a, b),
            },
            Op::PlusScaled(a, b, c) => {
                let (b, c) = self.factors(own, b, c);
                Op::PlusScaled(as_own(a), b, c)
            }
            Op::PlusProduct(a, b, c) => match self.factors(own, b, c) {
                (one, vector) | (vector, one) if self.is_vector_times_one(vector, one) => {
                    Op::PlusScaled(as_own(a), vector, self.graph.number(1.0).id())
                }
                (b, c) => Op::PlusProduct(as_own(a), b, c),
            },
            other => other.map_operands(|id| self.written[&id]),
        };
        self.graph.intern(op, None)
    }

    fn sym(&self, id: Id) -> Sym<'g> {
        Sym { graph: self.graph, id }
    }

    fn is_one(&self, id: Id) -> bool {
        self.sym(id).constant() == Some(1.0)
    }

    /// Whether a column without a last entry is multiplied by 1 in all directions.
    fn is_vector_times_one(&self, vector: Id, one: Id) -> bool {
        let [vector, one] = [vector, one].map(|id| Column::of_node(self.graph, id));
        one.is_one() && vector.is_zero_at(3)
    }

    /// The factors of a product that has a scale: of two that vary they have it already.
    fn factors(&self, own: f64, a: Id, b: Id) -> (Id, Id) {
        let factor = own / (self.scaling.scale(a) * self.scaling.scale(b));
        match self.scaling.is_constant(a) {
            true => (self.times(a, factor), self.written[&b]),
            false => (self.written[&a], self.times(b, factor)),
        }
    }

    fn times(&self, id: Id, factor: f64) -> Id {
        if is_one(factor) {
            return self.written[&id];
        }
        let Node { op, constant, .. } = self.scaling.nodes[id];
        let number =
            |value: f64| self.graph.number(if is_one(value.abs()) { 1.0_f64.copysign(value) } else { value }).id();
        match (op, constant) {
            (Op::Column(entries), _) => {
                let entries = entries.map(|entry| self.times(entry, factor));
                self.graph.intern(Op::Column(entries), None).id()
            }
            (_, Some(value)) => number(value * factor),
            (_, None) => self.graph.intern(Op::Mul(self.written[&id], number(factor)), None).id(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angle::Angle;

    #[test]
    fn a_factor_goes_into_sines_and_constants() {
        let function = Function::of(|g| {
            let (s, c) = g.sin_cos(&Angle::of_joint(0, 0.0));
            let [s, c] = [s, c].map(|x| x * g.number(3.0));
            vec![s, c * g.number(0.5), (c + g.number(2.0)) * g.number(4.0)]
        });
        let outputs = |function: &Function| function.evaluate(&[0.7], &[]);
        let scaled = Scaling::of(&function).rewritten().expect("no large scales");
        // The sine has its factor; of what is made of the cosine one is for nothing.
        assert_eq!((function.cost().mul, scaled.cost().mul), (4, 1));
        for (plain, scaled) in outputs(&function).iter().zip(outputs(&scaled)) {
            assert!((plain - scaled).abs() < 1e-15 * plain.abs(), "{plain} {scaled}");
        }
    }

    #[test]
    fn nothing_is_scaled_by_what_single_precision_has_not() {
        let times = |factor: f64| {
            let function = Function::of(|g| vec![g.sin_cos(&Angle::of_joint(0, 0.0)).0 * g.number(factor)]);
            with_scales(function).cost().mul
        };
        assert_eq!([1e-14, 1e-16, 1e16].map(times), [0, 1, 1]);
    }

    #[test]
    fn what_a_factor_cannot_leave_stays() {
        let function = Function::of(|g| {
            let x = g.coordinate(0);
            vec![x * g.number(3.0), x]
        });
        assert_eq!(with_scales(function).cost().mul, 1);
    }
}
