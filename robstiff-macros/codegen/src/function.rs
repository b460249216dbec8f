//! A function as a graph with outputs: what is live in it, what it costs, and
//! its value at a point.

use std::collections::HashMap;
use std::fmt;

use robstiff_robots::effect::physics::PLAYS;

use crate::graph::{Graph, Node, Sym};
use crate::op::{CYCLED, Id, Op};

/// The expressions of one function and which of them are its results.
#[derive(Debug)]
pub struct Function {
    graph: Graph,
    outputs: Vec<Id>,
}

impl Function {
    /// Runs an algorithm on symbols.
    pub fn of(algorithm: impl for<'g> FnOnce(&'g Graph) -> Vec<Sym<'g>>) -> Self {
        let graph = Graph::new();
        let outputs = algorithm(&graph).into_iter().map(Sym::id).collect();
        Self { graph, outputs }
    }

    /// From a graph and which of its nodes are results.
    pub(crate) fn new(graph: Graph, outputs: Vec<Id>) -> Self {
        Self { graph, outputs }
    }

    /// The expressions.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// The results, in order.
    pub fn outputs(&self) -> &[Id] {
        &self.outputs
    }

    /// How often each node is used by live nodes and outputs; 0 for dead ones.
    pub fn uses(&self) -> Vec<usize> {
        let nodes = self.graph.nodes();
        let mut uses = vec![0; nodes.len()];
        for &output in &self.outputs {
            uses[output] += 1;
        }
        // Operands come before their users: one sweep backwards sees all uses
        // of a node before the node itself.
        for id in (0..nodes.len()).rev() {
            if uses[id] > 0 {
                for operand in nodes[id].op.operands() {
                    uses[operand] += 1;
                }
            }
        }
        uses
    }

    /// What one evaluation costs; constants cost nothing.
    pub fn cost(&self) -> Cost {
        let uses = self.uses();
        let mut cost = Cost::default();
        for (node, &used) in self.graph.nodes().iter().zip(&uses) {
            if used == 0 || node.constant.is_some() {
                continue;
            }
            match node.op {
                Op::Sin(_) | Op::Cos(_) => cost.trig += 1,
                Op::Mul(..) => cost.mul += 1,
                Op::Add(..) | Op::Sub(..) | Op::Max(..) | Op::Min(..) => cost.add += 1,
                Op::Neg(_) => cost.neg += 1,
                Op::Sqrt(_) | Op::Recip(_) => cost.root += 1,
                Op::Scaled(..) | Op::Product(..) => cost.mul += 4,
                Op::PlusScaled(..) | Op::PlusProduct(..) => {
                    cost.mul += 4;
                    cost.add += 4;
                }
                Op::Number(_)
                | Op::NamedNumber(_)
                | Op::Coordinate(_)
                | Op::Wrench(_)
                | Op::Play(..)
                | Op::Column(_)
                | Op::Cycled(_)
                | Op::Direction(_)
                | Op::Entry(..) => {}
            }
        }
        // An angle of two joints takes additions, a multiple a multiplication.
        for (index, angle) in self.graph.angles().iter().enumerate() {
            let live = self
                .graph
                .nodes()
                .iter()
                .zip(&uses)
                .any(|(node, &used)| used > 0 && (node.op == Op::Sin(index) || node.op == Op::Cos(index)));
            if live {
                cost.add += angle.terms().len() - 1 + usize::from(angle.offset() != 0.0);
                cost.mul += angle.terms().iter().filter(|(_, factor)| factor.abs() > 1).count();
            }
        }
        cost
    }

    /// What one evaluation costs where a column is computed with as one number:
    /// an operation, and one more for a number that goes into all or into one of
    /// its entries. Results are stored as whole or as single numbers alike.
    pub fn cost_in_columns(&self) -> usize {
        let nodes = self.graph.nodes();
        let is_there = |id: Id| usize::from(nodes[id].constant.is_none());
        let cost = |node: &Node| match node.op {
            _ if node.constant.is_some() => 0,
            Op::Mul(..) | Op::Add(..) | Op::Sub(..) | Op::Max(..) | Op::Min(..) => 1,
            Op::Neg(_) | Op::Sqrt(_) | Op::Recip(_) => 1,
            Op::Product(..) | Op::PlusProduct(..) | Op::Cycled(_) | Op::Direction(_) => 1,
            Op::Column(entries) => entries.into_iter().map(is_there).sum(),
            Op::Scaled(_, by) | Op::PlusScaled(_, _, by) => 1 + is_there(by),
            _ => 0,
        };
        nodes.iter().zip(self.uses()).filter(|(_, used)| *used > 0).map(|(node, _)| cost(node)).sum()
    }

    /// The values of the outputs in SI units, columns entry by entry: the graph
    /// interpreted, node by node, at joint coordinates (rad or m) and under a
    /// wrench (N, then Nm), on a robot that was never loaded.
    ///
    /// # Panics
    /// If there are fewer coordinates than joints, or fewer than six components
    /// of a wrench that the function depends on.
    pub fn evaluate(&self, coordinates: &[f64], wrench: &[f64]) -> Vec<f64> {
        self.evaluate_with(coordinates, wrench, &vec![[0.0; PLAYS]; coordinates.len()])
    }

    /// The same after the loads that left the play operators of each joint in
    /// this state (Nm).
    ///
    /// # Panics
    /// As [`evaluate`](Self::evaluate), and if there are fewer states than joints.
    pub fn evaluate_with(&self, coordinates: &[f64], wrench: &[f64], plays: &[[f64; PLAYS]]) -> Vec<f64> {
        let nodes = self.graph.nodes();
        let angle = |index: usize| {
            let angle = &self.graph.angles()[index];
            let terms = angle.terms().iter().map(|&(joint, factor)| f64::from(factor) * coordinates[joint]);
            terms.sum::<f64>() + angle.offset()
        };
        let mut values: Vec<f64> = Vec::with_capacity(nodes.len());
        let mut columns: HashMap<Id, [f64; 4]> = HashMap::new();
        for (id, node) in nodes.iter().enumerate() {
            values.push(match node.op {
                Op::Number(bits) => f64::from_bits(bits),
                Op::NamedNumber(index) => self.graph.named_numbers()[index].value,
                Op::Coordinate(index) => coordinates[index],
                Op::Wrench(index) => wrench[index],
                Op::Play(joint, index) => plays[joint][index],
                Op::Sin(index) => self.graph.factors(index)[0] * angle(index).sin(),
                Op::Cos(index) => self.graph.factors(index)[1] * angle(index).cos(),
                Op::Add(a, b) => values[a] + values[b],
                Op::Sub(a, b) => values[a] - values[b],
                Op::Mul(a, b) => values[a] * values[b],
                Op::Neg(a) => -values[a],
                Op::Sqrt(a) => values[a].sqrt(),
                Op::Recip(a) => values[a].recip(),
                Op::Max(a, b) => values[a].max(values[b]),
                Op::Min(a, b) => values[a].min(values[b]),
                Op::Entry(column, entry) => columns[&column][entry],
                op => {
                    columns.insert(id, column(op, &columns, &values));
                    f64::NAN
                }
            });
        }
        let entries = |id: &Id| columns.get(id).map_or(vec![values[*id]], |column| column.to_vec());
        self.outputs.iter().flat_map(entries).collect()
    }
}

/// What an operation on columns gives.
fn column(op: Op, columns: &HashMap<Id, [f64; 4]>, values: &[f64]) -> [f64; 4] {
    let each = |entry: &dyn Fn(usize) -> f64| std::array::from_fn(entry);
    match op {
        Op::Column(entries) => entries.map(|entry| values[entry]),
        Op::Scaled(a, by) => columns[&a].map(|entry| entry * values[by]),
        Op::PlusScaled(a, b, by) => each(&|k| columns[&a][k] + columns[&b][k] * values[by]),
        Op::Product(a, b) => each(&|k| columns[&a][k] * columns[&b][k]),
        Op::PlusProduct(a, b, c) => each(&|k| columns[&a][k] + columns[&b][k] * columns[&c][k]),
        Op::Cycled(a) => each(&|k| columns[&a][CYCLED[k]]),
        Op::Direction(a) => each(&|k| if k < 3 { columns[&a][k] } else { 0.0 }),
        op => unreachable!("{op:?} gives a number"),
    }
}

/// Operations of one evaluation.
///
/// Generated code has the same fields in the runtime's type of this name, which it finds,
/// as all that it names, at a path of the runtime: this crate is built before that one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Sines and cosines, counted singly.
    pub trig: usize,
    /// Multiplications.
    pub mul: usize,
    /// Additions, subtractions, and choices of the larger or smaller of two.
    pub add: usize,
    /// Changes of sign that no addition absorbed.
    pub neg: usize,
    /// Square roots and reciprocals.
    pub root: usize,
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} trig, {} mul, {} add", self.trig, self.mul, self.add)?;
        if self.neg > 0 {
            write!(f, ", {} neg", self.neg)?;
        }
        if self.root > 0 {
            write!(f, ", {} root", self.root)?;
        }
        Ok(())
    }
}
