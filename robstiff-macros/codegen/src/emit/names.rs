//! Names for the nodes of a function.

use std::collections::{BTreeMap, BTreeSet};

use crate::function::Function;
use crate::graph::{Id, Op};

/// The components of a wrench.
pub(super) const WRENCH: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];

/// Which nodes get a line of their own, and under which name.
pub(super) struct Names {
    of: BTreeMap<Id, String>,
}

/// How many operands a line may have before an inner expression gets a line of
/// its own.
const OPERANDS_PER_LINE: usize = 6;

impl Names {
    /// Chooses the names: hints of the algorithms, names of parameters, and
    /// numbers for the rest; never one name twice.
    pub fn of(function: &Function) -> Self {
        let needed = lines(function);
        let graph = function.graph();
        let mut taken: BTreeSet<String> = ["q", "wrench"].iter().chain(&WRENCH).map(|name| name.to_string()).collect();
        for angle in graph.angles().iter() {
            taken.extend([format!("s{}", angle.label()), format!("c{}", angle.label())]);
        }
        let mut of = BTreeMap::new();
        // Hints first, so that a number never takes the name of a thing.
        for &id in &needed {
            let wish = match graph.nodes()[id].constant {
                Some(_) => constant_name(function, id),
                None => graph.hints().get(&id).cloned(),
            };
            if let Some(name) = wish {
                let name = (1..).map(|k| if k == 1 { name.clone() } else { format!("{name}_{k}") });
                let name = name.into_iter().find(|name| !taken.contains(name)).expect("endless");
                taken.insert(name.clone());
                of.insert(id, name);
            }
        }
        let mut number = 0;
        for &id in &needed {
            of.entry(id).or_insert_with(|| {
                loop {
                    number += 1;
                    let letter = if graph.nodes()[id].constant.is_some() { 'k' } else { 't' };
                    let name = format!("{letter}{number}");
                    if taken.insert(name.clone()) {
                        break name;
                    }
                }
            });
        }
        Self { of }
    }

    /// The name, if the node has a line.
    pub fn get(&self, id: Id) -> Option<&str> {
        self.of.get(&id).map(String::as_str)
    }

    /// The nodes with a line, in order of evaluation.
    pub fn lines(&self) -> impl Iterator<Item = (Id, &str)> {
        self.of.iter().map(|(id, name)| (*id, name.as_str()))
    }
}

/// The live nodes that need a line.
fn lines(function: &Function) -> BTreeSet<Id> {
    let graph = function.graph();
    let (nodes, uses, hints) = (graph.nodes(), function.uses(), graph.hints());
    // How often a node is used by something that is computed at run time.
    let mut needed = BTreeSet::new();
    let mut operands = vec![1_usize; nodes.len()];
    for (id, node) in nodes.iter().enumerate() {
        if uses[id] == 0 {
            continue;
        }
        if node.constant.is_some() {
            continue;
        }
        for operand in node.op.operands() {
            if needs_constant(nodes[operand].op, nodes[operand].constant) {
                needed.insert(operand);
            }
        }
        match node.op {
            Op::Neg(a) => {
                // A sign is written where it is used.
                operands[id] = operands[a];
                if uses[id] > 1 && !is_leaf(nodes[a].op) {
                    needed.insert(a);
                }
            }
            Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) => {
                let width = |x: Id| if needed.contains(&x) { 1 } else { operands[x] };
                let (mut left, right) = (width(a), width(b));
                if left + right > OPERANDS_PER_LINE {
                    let wider = if left > right { a } else { b };
                    needed.insert(unsigned(nodes[wider].op, wider));
                    left = 1.min(left);
                    operands[id] = left + right.min(OPERANDS_PER_LINE - 1);
                } else {
                    operands[id] = left + right;
                }
                if uses[id] > 1 || hints.contains_key(&id) {
                    needed.insert(id);
                }
            }
            Op::Sqrt(_) | Op::Recip(_) if uses[id] > 1 || hints.contains_key(&id) => {
                needed.insert(id);
            }
            _ => {}
        }
    }
    for &output in function.outputs() {
        if needs_constant(nodes[output].op, nodes[output].constant) {
            needed.insert(output);
        }
    }
    needed
}

fn unsigned(op: Op, id: Id) -> Id {
    if let Op::Neg(a) = op { a } else { id }
}

fn is_leaf(op: Op) -> bool {
    matches!(op, Op::Sin(_) | Op::Cos(_) | Op::Coordinate(_) | Op::Wrench(_) | Op::Number(_) | Op::Parameter(_))
}

/// 0 and +-1 are written in place, other constants have a line.
fn needs_constant(op: Op, constant: Option<f64>) -> bool {
    match (op, constant) {
        (Op::Number(bits), Some(_)) => {
            let value = f64::from_bits(bits);
            value != 0.0 && value.abs() != 1.0
        }
        (_, constant) => constant.is_some(),
    }
}

/// `a2` for a parameter, `h5_a5` for a product of parameters.
fn constant_name(function: &Function, id: Id) -> Option<String> {
    let graph = function.graph();
    match graph.nodes()[id].op {
        Op::Parameter(index) => Some(graph.parameters()[index].name.to_lowercase()),
        Op::Mul(a, b) => {
            let name = format!("{}_{}", constant_name(function, a)?, constant_name(function, b)?);
            (name.len() <= 16).then_some(name)
        }
        _ => None,
    }
}
