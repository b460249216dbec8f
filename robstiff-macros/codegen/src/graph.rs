//! The expression graph: every expression exists once.
//!
//! A [`Graph`] owns the nodes of one function. [`Sym`] is a handle to a node
//! that computes like a number; the rules by which operations are simplified
//! as they are written down are in the module `fold`. Because equal
//! expressions are the same node, common subexpressions need no search, and
//! because a node is only ever made after its operands, the order of creation
//! is an order of evaluation.

use std::cell::{Ref, RefCell};
use std::collections::{BTreeMap, HashMap};

use crate::angle::{Angle, Part};
use crate::op::{Id, Op};

/// A number of the description under the name that generated code gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedNumber {
    /// The name in generated code, e.g. `A2`.
    pub name: String,
    /// Its value in SI units.
    pub value: f64,
    /// What it is, with its unit, for generated docs.
    pub doc: String,
}

/// One node: what it computes and, if that is independent of every input,
/// its value.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// What it computes.
    pub op: Op,
    /// The value of a constant.
    pub constant: Option<f64>,
    /// When the result is known, if everything begins as soon as it can
    /// (cycles after the sines and cosines; see [`Op::latency`]).
    pub ready: usize,
}

/// A turn about z of all four blocks of a compliance, which are nodes like
/// any others; a scalar that knows how performs them as one operation.
///
/// A row of four: displacement per force, rotation per moment, displacement
/// per moment, the same transposed. Rows: xx, xy, yy, xz, yz.
#[derive(Clone, Debug)]
pub struct BlockTurn {
    /// Sine and cosine.
    pub sin_cos: (Id, Id),
    /// The entries before.
    pub before: [[Id; 4]; 5],
    /// The entries afterwards.
    pub after: [[Id; 4]; 5],
}

/// The expressions of one function.
#[derive(Debug, Default)]
pub struct Graph {
    nodes: RefCell<Vec<Node>>,
    known: RefCell<HashMap<Op, Id>>,
    named_numbers: RefCell<Vec<NamedNumber>>,
    angles: RefCell<Vec<Angle>>,
    /// What the sine and the cosine of each angle are multiplied by; of none, if they are
    /// as they are.
    factors: Vec<[f64; 2]>,
    /// Sine and cosine each.
    deviations: RefCell<Vec<(Id, Id)>>,
    hints: RefCell<BTreeMap<Id, String>>,
    remarks: RefCell<Vec<(Id, String)>>,
    block_turns: RefCell<Vec<BlockTurn>>,
}

impl Graph {
    /// A graph without nodes.
    pub fn new() -> Self {
        Self::default()
    }

    /// The nodes in order of creation, operands before their users.
    pub fn nodes(&self) -> Ref<'_, [Node]> {
        Ref::map(self.nodes.borrow(), Vec::as_slice)
    }

    /// The named numbers, used or not, which [`Op::NamedNumber`] indexes.
    pub fn named_numbers(&self) -> Ref<'_, [NamedNumber]> {
        Ref::map(self.named_numbers.borrow(), Vec::as_slice)
    }

    /// The angles, which [`Op::Sin`] and [`Op::Cos`] index.
    pub fn angles(&self) -> Ref<'_, [Angle]> {
        Ref::map(self.angles.borrow(), Vec::as_slice)
    }

    /// A graph without nodes of the same angles, whose sines and cosines are multiplied by
    /// these factors, and with the same named numbers.
    pub(crate) fn with_factors(&self, factors: Vec<[f64; 2]>) -> Self {
        Self { angles: self.angles.clone(), named_numbers: self.named_numbers.clone(), factors, ..Self::default() }
    }

    /// What the sine and the cosine of an angle are multiplied by, which costs nothing: the
    /// constants that they are computed with are.
    pub fn factors(&self, angle: usize) -> [f64; 2] {
        self.factors.get(angle).copied().unwrap_or([1.0; 2])
    }

    /// Names that the algorithms gave to nodes.
    pub fn hints(&self) -> Ref<'_, BTreeMap<Id, String>> {
        self.hints.borrow()
    }

    /// Remarks for the reader of generated code, each with the first node
    /// that it speaks of.
    pub fn remarks(&self) -> Ref<'_, [(Id, String)]> {
        Ref::map(self.remarks.borrow(), Vec::as_slice)
    }

    /// A number.
    pub fn number(&self, value: f64) -> Sym<'_> {
        // -0 and 0 are one constant: nothing that is generated divides by it.
        let value = if value == 0.0 { 0.0 } else { value };
        self.intern(Op::Number(value.to_bits()), Some(value))
    }

    /// A number of the description. 0 and +-1 are written without their name, so that
    /// they fold. The same name always stands for the same value.
    pub fn named_number(&self, name: &str, value: f64, doc: &str) -> Sym<'_> {
        let mut named_numbers = self.named_numbers.borrow_mut();
        let index = named_numbers.iter().position(|p| p.name == name).unwrap_or_else(|| {
            named_numbers.push(NamedNumber { name: name.to_owned(), value, doc: doc.to_owned() });
            named_numbers.len() - 1
        });
        debug_assert_eq!(named_numbers[index].value.to_bits(), value.to_bits(), "two values for {name}");
        if value == 0.0 || value.abs() == 1.0 {
            return self.number(value);
        }
        self.intern(Op::NamedNumber(index), Some(value))
    }

    /// Joint coordinate `index`, from 0.
    pub fn coordinate(&self, index: usize) -> Sym<'_> {
        self.intern(Op::Coordinate(index), None)
    }

    /// Component `index` of the wrench, from 0, forces first.
    pub fn wrench(&self, index: usize) -> Sym<'_> {
        self.intern(Op::Wrench(index), None)
    }

    /// A joint's play operator before the load, both from 0.
    pub fn play(&self, joint: usize, index: usize) -> Sym<'_> {
        self.intern(Op::Play(joint, index), None)
    }

    /// Notes sine and cosine of an angle by which a joint stands aside of its coordinate:
    /// the index of it, for angles that [contain](Angle::with_deviation) it. One joint has
    /// two where its arm hangs in one chain and not in another.
    pub fn add_deviation(&self, (sin, cos): (Sym<'_>, Sym<'_>)) -> usize {
        let mut deviations = self.deviations.borrow_mut();
        deviations.push((sin.id, cos.id));
        deviations.len() - 1
    }

    /// Sine and cosine of an angle. A constant part that is a multiple of 90
    /// degrees is exact, any other is left in the angle; of an angle and its
    /// negative only one is computed. Deviations are added by the rule for
    /// sines and cosines of sums.
    pub fn sin_cos(&self, angle: &Angle) -> (Sym<'_>, Sym<'_>) {
        let plain = self.sin_cos_of_coordinates(angle);
        angle.deviations().iter().fold(plain, |(s, c), &(index, sign)| {
            let (sin, cos) = self.deviations.borrow()[index];
            let (sin, cos) = (Sym { graph: self, id: sin }, Sym { graph: self, id: cos });
            let sin = if sign < 0 { -sin } else { sin };
            (s * cos + c * sin, c * cos - s * sin)
        })
    }

    fn sin_cos_of_coordinates(&self, angle: &Angle) -> (Sym<'_>, Sym<'_>) {
        let reduced = angle.reduced();
        let (s, c) = match reduced.rest {
            None => (self.number(0.0), self.number(1.0)),
            Some(rest) if rest.terms().is_empty() => self.sin_cos_of_constant(&rest),
            Some(rest) => {
                for Part { name, what, value, .. } in rest.parts().unwrap_or_default() {
                    self.named_number(name, *value, &format!("{} (rad).", capitalised(what)));
                }
                let mut angles = self.angles.borrow_mut();
                let index = angles.iter().position(|known| *known == rest).unwrap_or_else(|| {
                    angles.push(rest);
                    angles.len() - 1
                });
                (self.intern(Op::Sin(index), None), self.intern(Op::Cos(index), None))
            }
        };
        let s = if reduced.negated { -s } else { s };
        match reduced.quarter_turns {
            0 => (s, c),
            1 => (c, -s),
            2 => (-s, -c),
            _ => (-c, s),
        }
    }

    fn sin_cos_of_constant(&self, angle: &Angle) -> (Sym<'_>, Sym<'_>) {
        let Some([Part { name, what, value, is_negative }]) = angle.parts() else {
            return (self.number(angle.offset().sin()), self.number(angle.offset().cos()));
        };
        let sin = self.named_number(&format!("SIN_{name}"), value.sin(), &format!("Sine of {what}."));
        let cos = self.named_number(&format!("COS_{name}"), value.cos(), &format!("Cosine of {what}."));
        (if *is_negative { -sin } else { sin }, cos)
    }

    /// The turns of whole compliances.
    pub fn block_turns(&self) -> Ref<'_, [BlockTurn]> {
        Ref::map(self.block_turns.borrow(), Vec::as_slice)
    }

    /// Remembers what a turn of a whole compliance made of what.
    pub fn block_turn(&self, turn: BlockTurn) {
        self.block_turns.borrow_mut().push(turn);
    }

    /// Adds a remark that precedes whatever is computed from here on.
    pub fn remark(&self, text: impl Into<String>) {
        self.remarks.borrow_mut().push((self.nodes.borrow().len(), text.into()));
    }

    pub(crate) fn intern(&self, op: Op, constant: Option<f64>) -> Sym<'_> {
        let id = *self.known.borrow_mut().entry(op).or_insert_with(|| {
            let mut nodes = self.nodes.borrow_mut();
            let begin = op.operands().map(|id| nodes[id].ready).max().unwrap_or(0);
            let ready = if constant.is_some() { 0 } else { begin + op.latency() };
            nodes.push(Node { op, constant, ready });
            nodes.len() - 1
        });
        Sym { graph: self, id }
    }
}

/// A noun as a sentence begins with it, without its article.
fn capitalised(what: &str) -> String {
    let noun = what.strip_prefix("the ").unwrap_or(what);
    let mut letters = noun.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

/// An expression: a node of a graph that computes like a number.
#[derive(Clone, Copy)]
pub struct Sym<'g> {
    pub(crate) graph: &'g Graph,
    pub(crate) id: Id,
}

impl<'g> Sym<'g> {
    /// The node's index.
    pub fn id(self) -> Id {
        self.id
    }

    /// When it is known (cycles), see [`Node`].
    pub fn ready(self) -> usize {
        self.graph.nodes.borrow()[self.id].ready
    }

    /// The value, if it is a constant.
    pub fn constant(self) -> Option<f64> {
        self.graph.nodes.borrow()[self.id].constant
    }

    /// What the node computes.
    pub fn op(self) -> Op {
        self.graph.nodes.borrow()[self.id].op
    }

    /// Whether this is known to be 0.
    pub fn is_zero(self) -> bool {
        self.constant() == Some(0.0)
    }

    /// Suggests a name for generated code. The first suggestion stays; a
    /// negated expression passes it on, so that a sign does not cost a line.
    pub fn named(self, name: impl Into<String>) -> Self {
        if let Op::Neg(_) = self.op() {
            return self;
        }
        self.graph.hints.borrow_mut().entry(self.id).or_insert_with(|| name.into());
        self
    }
}

impl std::fmt::Debug for Sym<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{}", self.id)
    }
}

impl PartialEq for Sym<'_> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.graph, other.graph) && self.id == other.id
    }
}
