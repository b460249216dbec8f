//! Which nodes of a function get a line of their own in its code, and under which name.

use std::collections::{BTreeMap, BTreeSet};

use super::fuse::Fusion;
use super::turns::Turns;
use crate::function::Function;
use crate::op::{Id, Op};

/// The components of a wrench.
const WRENCH: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];

/// The lines of a function: a node that is not among them is written where it is used, if
/// at all.
pub(super) struct Lines {
    names: BTreeMap<Id, String>,
    /// Whose name is a number.
    numbered: BTreeSet<Id>,
    angles: Vec<String>,
}

/// How many operands a line may have before an inner expression gets a line of
/// its own.
const OPERANDS_PER_LINE: usize = 6;

impl Lines {
    /// Decides on the lines, and chooses their names: hints of the algorithms, names of
    /// named numbers, and numbers for the rest; never one name twice.
    ///
    /// `besides` are [those](Turns::besides) that only turns need.
    pub fn of(function: &Function, turns: &Turns, besides: &BTreeSet<Id>, fusion: &Fusion) -> Self {
        let mut needed = needed(function);
        needed.extend(turns.results());
        let nodes = function.graph().nodes();
        needed.extend(besides.iter().filter(|&&id| needs_constant(nodes[id].op, nodes[id].constant)));
        // Products that sums take up are not there any more.
        needed.retain(|&id| fusion.is_used(id));
        let graph = function.graph();
        let mut taken: BTreeSet<String> =
            ["q", "wrench", "state"].iter().chain(&WRENCH).map(|name| name.to_string()).collect();
        let mut angles: Vec<String> = Vec::new();
        for angle in graph.angles().iter() {
            // Two offsets of the same joints have one label.
            let label = numbered(angle.label(), |label| !angles.contains(label));
            taken.extend([format!("s{label}"), format!("c{label}")]);
            angles.push(label);
        }
        let mut names = BTreeMap::new();
        // Hints first, so that a number never takes the name of a thing.
        for &id in &needed {
            let wish = match graph.nodes()[id].constant {
                Some(_) => constant_name(function, id).or_else(|| graph.hints().get(&id).cloned()),
                None => graph.hints().get(&id).cloned(),
            };
            if let Some(name) = wish {
                let name = numbered(name, |name| !taken.contains(name));
                taken.insert(name.clone());
                names.insert(id, name);
            }
        }
        let numbered_ones = needed.iter().copied().filter(|id| !names.contains_key(id)).collect();
        let (mut constants, mut temporaries) = (1.., 1..);
        for &id in &needed {
            names.entry(id).or_insert_with(|| {
                let (letter, numbers) = match graph.nodes()[id].constant {
                    Some(_) => ('k', &mut constants),
                    None => ('t', &mut temporaries),
                };
                let mut names = numbers.map(|number: usize| format!("{letter}{number}"));
                names.find(|name| taken.insert(name.clone())).expect("endless")
            });
        }
        Self { names, numbered: numbered_ones, angles }
    }

    /// The name of a node's line, if it has one.
    pub fn name(&self, id: Id) -> Option<&str> {
        self.names.get(&id).map(String::as_str)
    }

    /// Whether a node's line is named by no more than a number: `t1`, `k1`.
    pub fn is_numbered(&self, id: Id) -> bool {
        self.numbered.contains(&id)
    }

    /// The nodes with a line, in order of evaluation, and its name.
    pub fn all(&self) -> impl Iterator<Item = (Id, &str)> {
        self.names.iter().map(|(id, name)| (*id, name.as_str()))
    }

    /// The name of what a function begins with: a component of the wrench, a play operator
    /// before the load, a sine, a cosine.
    pub fn input(&self, op: Op) -> String {
        match op {
            Op::Wrench(index) => WRENCH[index].to_owned(),
            Op::Play(joint, index) => format!("before{}_{}", joint + 1, index + 1),
            Op::Sin(index) => format!("s{}", self.angles[index]),
            Op::Cos(index) => format!("c{}", self.angles[index]),
            op => unreachable!("{op:?} is calculated"),
        }
    }
}

/// The name itself or, where it is not free, with the first number that is.
fn numbered(name: String, is_free: impl Fn(&String) -> bool) -> String {
    let all = (1..).map(|k| if k == 1 { name.clone() } else { format!("{name}_{k}") });
    all.into_iter().find(is_free).expect("endless")
}

/// The live nodes that need a line: what is used twice, what an algorithm
/// named, constants, and whatever would make a line too wide.
fn needed(function: &Function) -> BTreeSet<Id> {
    let graph = function.graph();
    let (nodes, uses, hints) = (graph.nodes(), function.uses(), graph.hints());
    let is_constant = |id: Id| needs_constant(nodes[id].op, nodes[id].constant);
    let mut needed: BTreeSet<Id> = function.outputs().iter().copied().filter(|&id| is_constant(id)).collect();
    // How many operands a node has where it is written out.
    let mut widths = vec![1; nodes.len()];
    for (id, node) in nodes.iter().enumerate().filter(|(id, node)| uses[*id] > 0 && node.constant.is_none()) {
        needed.extend(node.op.operands().filter(|&operand| is_constant(operand)));
        let width = |needed: &BTreeSet<Id>, id: Id| if needed.contains(&id) { 1 } else { widths[id] };
        match node.op {
            Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Max(a, b) | Op::Min(a, b) => {
                if width(&needed, a) + width(&needed, b) > OPERANDS_PER_LINE {
                    let wider = if width(&needed, a) > width(&needed, b) { a } else { b };
                    needed.insert(unsigned(nodes[wider].op, wider));
                }
                widths[id] = width(&needed, a) + width(&needed, b);
            }
            Op::Sqrt(a) | Op::Recip(a) => widths[id] = width(&needed, a),
            op if op.is_column() => {
                needed.insert(id);
                continue;
            }
            Op::Entry(..) => continue,
            // A sign is written where it is used; what it stands before is not
            // written twice.
            Op::Neg(a) => {
                widths[id] = width(&needed, a);
                if uses[id] > 1 && !is_leaf(nodes[a].op) {
                    needed.insert(a);
                }
                continue;
            }
            _ => continue,
        }
        if uses[id] > 1 || hints.contains_key(&id) {
            needed.insert(id);
        }
    }
    needed
}

fn unsigned(op: Op, id: Id) -> Id {
    if let Op::Neg(a) = op { a } else { id }
}

fn is_leaf(op: Op) -> bool {
    op.operands().next().is_none() || matches!(op, Op::Entry(..))
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

/// The longest name that is made of others'.
const LONGEST_NAME: usize = 24;

/// `a2` for a named number; from the names of its parts `h5_a5` for a product, `neg_h5` for a
/// negative, `d6_plus_tool_z` for a sum, `inv_6` for one by a whole number.
fn constant_name(function: &Function, id: Id) -> Option<String> {
    let graph = function.graph();
    let of = |id| constant_name(function, id);
    let name = match graph.nodes()[id].op {
        Op::NamedNumber(index) => return Some(graph.named_numbers()[index].name.to_lowercase()),
        Op::Number(bits) => match f64::from_bits(bits) {
            value if value < 0.0 => format!("neg_inv_{}", inverse_of(-value)?),
            value => format!("inv_{}", inverse_of(value)?),
        },
        Op::Mul(a, b) => format!("{}_{}", of(a)?, of(b)?),
        Op::Neg(a) => format!("neg_{}", of(a)?),
        Op::Add(a, b) => format!("{}_plus_{}", of(a)?, of(b)?),
        Op::Sub(a, b) => format!("{}_minus_{}", of(a)?, of(b)?),
        _ => return None,
    };
    (name.len() <= LONGEST_NAME).then_some(name)
}

/// The whole number that a value is one by: 6 for 0.1666..
pub(super) fn inverse_of(value: f64) -> Option<u32> {
    let inverse = value.recip().round();
    let is_it = (2.0..1e6).contains(&inverse) && inverse.recip() == value;
    is_it.then_some(inverse as u32)
}
