//! The statements of a generated function.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::fuse::{FusedSum, Fusion};
use super::lines::{Lines, inverse_of};
use super::operation::{Binding, arithmetic, call, column, sum};
use super::reader::{Reader, number};
use super::turns::{Lane, Turn, Turns};
use crate::angle::Angle;
use crate::function::Function;
use crate::op::{Id, Op};

/// The lines before a function's result, and the result's entries.
pub(super) struct Body {
    pub statements: TokenStream,
    pub outputs: Vec<TokenStream>,
}

/// Writes a function out.
pub(super) fn body(function: &Function, reader: Reader) -> Body {
    let writer = match reader {
        Reader::Compiler => Writer::fusing(function, Turns::of(function)),
        Reader::Person => Writer::of(function, reader, Turns::none(), Fusion::none(function)),
    };
    let statements = writer.statements(|_| None);
    let outputs = function.outputs().iter().map(|&id| writer.operand(id, Binding::Sum)).collect();
    Body { statements, outputs }
}

/// Writes a function out that hands each output over, with its number, as soon as it is
/// known: `put(3, tt_xy);`. Who stores them needs no registers for them meanwhile, of which
/// batches have too few. Gain: `benches/README.md`.
pub(super) fn handing_over(function: &Function) -> TokenStream {
    // Turns as one operation would know their results at once, and late.
    let writer = Writer::fusing(function, Turns::none());
    let mut due: BTreeMap<Option<Id>, TokenStream> = BTreeMap::new();
    for (k, &id) in function.outputs().iter().enumerate() {
        let (k, output) = (Literal::usize_unsuffixed(k), writer.operand(id, Binding::Sum));
        due.entry(writer.last_line(id)).or_default().extend(quote!(put(#k, #output);));
    }
    let statements = writer.statements(|id| due.get(&Some(id)).cloned());
    let known_before = due.get(&None);
    quote!(#statements #known_before)
}

struct Writer<'f> {
    function: &'f Function,
    reader: Reader,
    /// The operations that outputs depend on, and what else goes into turns.
    live: Vec<Op>,
    lines: Lines,
    fusion: Fusion,
    turns: Turns,
}

impl<'f> Writer<'f> {
    fn of(function: &'f Function, reader: Reader, turns: Turns, fusion: Fusion) -> Self {
        let nodes = function.graph().nodes();
        let (uses, besides) = (function.uses(), turns.besides(function));
        let is_live = |id: &usize| uses[*id] > 0 || besides.contains(id);
        let live = (0..nodes.len()).filter(is_live).map(|id| nodes[id].op).collect();
        let lines = Lines::of(function, &turns, &besides, &fusion);
        Self { function, reader, live, lines, fusion, turns }
    }

    /// For the compiler: with products and sums fused.
    fn fusing(function: &'f Function, turns: Turns) -> Self {
        let fusion = Fusion::of(function, &turns);
        Self::of(function, Reader::Compiler, turns, fusion)
    }

    /// All lines, and after each what belongs there.
    fn statements(&self, behind: impl Fn(Id) -> Option<TokenStream>) -> TokenStream {
        let graph = self.function.graph();
        let nodes = graph.nodes();
        let mut out = TokenStream::new();
        let (constants, others): (Vec<_>, Vec<_>) = self.lines.all().partition(|(id, _)| nodes[*id].constant.is_some());
        let (named, numbered): (Vec<_>, Vec<_>) =
            constants.into_iter().partition(|(id, _)| !self.lines.is_numbered(*id));
        let mut first_numbered = numbered.first().map(|(id, _)| *id);
        for (id, name) in named.into_iter().chain(numbered) {
            if self.reader == Reader::Person && first_numbered.take_if(|first| *first == id).is_some() {
                out.extend(quote!(__remark!("Constants without a short name.");));
            }
            let (name, mut value) = (format_ident!("{name}"), self.constant(id, Binding::Sum));
            if self.reader == Reader::Compiler && self.is_sum(id) {
                // Elsewhere Clippy asks for a `mul_add` that would be computed at run time.
                value = quote!(const { #value });
            }
            out.extend(quote!(let #name = T::of(#value);));
        }
        out.extend(self.wrench());
        out.extend(self.plays());
        out.extend(self.sin_cos());
        let mut turned = BTreeSet::new();
        let mut remarks = graph.remarks().to_vec().into_iter().peekable();
        for (id, name) in others {
            if let Some(turn) = self.turns.with(id) {
                // Where the first of its results is due.
                if turned.insert(turn.first()) {
                    out.extend(self.block_turn(turn));
                }
                continue;
            }
            let (name, value) = (format_ident!("{name}"), self.expression(id).0);
            // Of several remarks before a line, the last one speaks of it.
            let mut remark = None;
            while remarks.peek().is_some_and(|(first, _)| *first <= id) {
                remark = remarks.next();
            }
            if self.reader == Reader::Person
                && let Some((_, text)) = remark
            {
                out.extend(quote!(__remark!(#text);));
            }
            out.extend(quote!(let #name = #value;));
            out.extend(behind(id));
        }
        out
    }

    /// The last line that a node needs, if any but those of constants.
    fn last_line(&self, id: Id) -> Option<Id> {
        let node = self.function.graph().nodes()[id];
        if node.constant.is_some() {
            None
        } else if self.lines.name(id).is_some() {
            Some(id)
        } else {
            node.op.operands().filter_map(|operand| self.last_line(operand)).max()
        }
    }

    /// `let [fx, _, fz, ..] = wrench.data.0[0];`, if the wrench matters.
    fn wrench(&self) -> Option<TokenStream> {
        let matters = self.live.iter().any(|op| matches!(op, Op::Wrench(_)));
        let entries = (0..6).map(|index| self.pattern(Op::Wrench(index)));
        matters.then(|| quote!(let [#(#entries),*] = wrench.data.0[0];))
    }

    /// `let before2_1 = state.plays[1][0];` for each play operator that matters.
    fn plays(&self) -> TokenStream {
        let plays = self.live.iter().filter_map(|&op| {
            let Op::Play(joint, index) = op else { return None };
            let name = self.input(op);
            let (joint, index) = (Literal::usize_unsuffixed(joint), Literal::usize_unsuffixed(index));
            Some(quote!(let #name = state.plays[#joint][#index];))
        });
        plays.collect()
    }

    /// `let [(s1, c1), (s23, c23)] = T::sin_cos_of_sums(q, |q| [q[0], q[1] + q[2]]);`:
    /// all angles together, so that scalars may compute them side by side; with what they
    /// are multiplied by, if they are. How angles are added is handed over, since coordinates
    /// of many turns lose these before.
    fn sin_cos(&self) -> Option<TokenStream> {
        let angles = self.function.graph().angles();
        let is_needed = |&index: &usize| self.live.contains(&Op::Sin(index)) || self.live.contains(&Op::Cos(index));
        let mut order: Vec<usize> = (0..angles.len()).filter(is_needed).collect();
        arrange(&mut order, &angles, self.live.iter().any(|op| op.is_column()));
        let factors: Vec<[f64; 2]> = order.iter().map(|&index| self.function.graph().factors(index)).collect();
        let (mut patterns, mut sums) = (Vec::new(), Vec::new());
        for index in order {
            let [sin, cos] = [Op::Sin(index), Op::Cos(index)].map(|op| self.pattern(op));
            patterns.push(quote!((#sin, #cos)));
            sums.push(sum(&angles[index], self.reader));
        }
        if factors.iter().flatten().any(|&factor| factor != 1.0) {
            let of = |[sin, cos]: [f64; 2]| {
                let [sin, cos] = [sin, cos].map(|factor| number(factor, self.reader));
                quote!((T::of(#sin), T::of(#cos)))
            };
            let factors = factors.into_iter().map(of);
            let call = quote!(T::scaled_sin_cos_of_sums(q, |q| [#(#sums),*], [#(#factors),*]));
            return Some(quote!(let [#(#patterns),*] = #call;));
        }
        (!sums.is_empty()).then(|| quote!(let [#(#patterns),*] = T::sin_cos_of_sums(q, |q| [#(#sums),*]);))
    }

    /// The name of an input, or `_` if it does not matter.
    fn pattern(&self, op: Op) -> TokenStream {
        if !self.live.contains(&op) {
            return quote!(_);
        }
        let name = self.input(op);
        quote!(#name)
    }

    fn input(&self, op: Op) -> Ident {
        format_ident!("{}", self.lines.input(op))
    }

    /// `let [[tt_xx, rr_xx, tr_xx, _], ..] = T::turn_blocks([[..], ..], (s1, c1));`
    /// and the results that are negatives of what stands there.
    fn block_turn(&self, turn: &Turn) -> TokenStream {
        let mut after: [[Option<Ident>; 4]; 5] = Default::default();
        let mut negatives = TokenStream::new();
        let results = turn.results().filter_map(|(id, place)| Some((self.lines.name(id)?, place)));
        let (negated, plain): (Vec<_>, Vec<_>) = results.partition(|(_, place)| place.is_negated);
        for (name, Lane { row, lane, .. }) in plain {
            after[row][lane] = Some(format_ident!("{name}"));
        }
        for (name, Lane { row, lane, .. }) in negated {
            let opposite = after[row][lane].get_or_insert_with(|| format_ident!("minus_{name}"));
            let name = format_ident!("{name}");
            negatives.extend(quote!(let #name = -#opposite;));
        }
        let after = after.map(|row| {
            let row = row.map(|name| name.map_or(quote!(_), |name| quote!(#name)));
            quote!([#(#row),*])
        });
        let before = turn.nodes.before.map(|row| {
            let row = row.map(|id| self.operand(id, Binding::Sum));
            quote!([#(#row),*])
        });
        let (sin, cos) = turn.nodes.sin_cos;
        let (sin, cos) = (self.operand(sin, Binding::Sum), self.operand(cos, Binding::Sum));
        quote!(let [#(#after),*] = T::turn_blocks([#(#before),*], (#sin, #cos)); #negatives)
    }

    /// A node where it is used: its name if it has a line, else its expression.
    fn operand(&self, id: Id, context: Binding) -> TokenStream {
        if let Some(name) = self.lines.name(id) {
            let name = format_ident!("{name}");
            return quote!(#name);
        }
        let (expression, binding) = self.expression(id);
        if binding < context { quote!((#expression)) } else { expression }
    }

    /// What a node computes, from its operands.
    fn expression(&self, id: Id) -> (TokenStream, Binding) {
        if let Some(sum) = self.fusion.sum(self.function, id) {
            return (self.fused(&sum), Binding::Unit);
        }
        let graph = self.function.graph();
        let op = graph.nodes()[id].op;
        let operand = |id, context| self.operand(id, context);
        if let Some(arithmetic) = arithmetic(op, operand) {
            return arithmetic;
        }
        if let Some(code) = call(op, operand).or_else(|| column(op, |id| self.operand(id, Binding::Sum))) {
            return (code, Binding::Unit);
        }
        match op {
            Op::Number(bits) => match f64::from_bits(bits) {
                0.0 => (quote!(T::zero()), Binding::Unit),
                1.0 => (quote!(T::one()), Binding::Unit),
                -1.0 => (quote!(-T::one()), Binding::Sign),
                value => unreachable!("{value} has a line"),
            },
            Op::NamedNumber(_) => unreachable!("a named number has a line"),
            Op::Coordinate(index) => {
                let index = Literal::usize_unsuffixed(index);
                (quote!(q[#index]), Binding::Unit)
            }
            Op::Wrench(_) | Op::Sin(_) | Op::Cos(_) | Op::Play(..) => {
                let name = self.input(op);
                (quote!(#name), Binding::Unit)
            }
            Op::Entry(column, entry) => {
                let (column, entry) = (self.operand(column, Binding::Unit), Literal::usize_unsuffixed(entry));
                (quote!(#column[#entry]), Binding::Unit)
            }
            op => unreachable!("{op:?} is written above"),
        }
    }

    /// `x.mul_add(y, rest)`.
    fn fused(&self, sum: &FusedSum) -> TokenStream {
        let (x, y) = (self.operand(sum.factors.0, Binding::Unit), self.operand(sum.factors.1, Binding::Sum));
        let x = if sum.product_is_negative { quote!((-#x)) } else { x };
        if sum.rest_is_negative {
            let rest = self.operand(sum.rest, Binding::Sign);
            quote!(#x.mul_add(#y, -#rest))
        } else {
            let rest = self.operand(sum.rest, Binding::Sum);
            quote!(#x.mul_add(#y, #rest))
        }
    }

    /// Whether a constant has a sum in it.
    fn is_sum(&self, id: Id) -> bool {
        let op = self.function.graph().nodes()[id].op;
        matches!(op, Op::Add(..) | Op::Sub(..)) || op.operands().any(|operand| self.is_sum(operand))
    }

    /// A constant from the description's numbers, which the compiler computes.
    fn constant(&self, id: Id, context: Binding) -> TokenStream {
        let graph = self.function.graph();
        let op = graph.nodes()[id].op;
        let arithmetic = arithmetic(op, |id, context| self.constant(id, context));
        let (expression, binding) = arithmetic.unwrap_or_else(|| match op {
            Op::Number(bits) => {
                let value = f64::from_bits(bits);
                match inverse_of(value).filter(|_| self.reader == Reader::Person) {
                    // 0.5 and 0.125 say themselves what they are.
                    Some(inverse) if value.to_string().len() > 6 => {
                        let inverse = Literal::f64_unsuffixed(inverse.into());
                        (quote!(1.0 / #inverse), Binding::Product)
                    }
                    _ => (number(value, self.reader), if value < 0.0 { Binding::Sign } else { Binding::Unit }),
                }
            }
            Op::NamedNumber(index) => {
                let name = format_ident!("{}", graph.named_numbers()[index].name);
                (quote!(Self::#name), Binding::Unit)
            }
            Op::Recip(a) => {
                let a = self.constant(a, Binding::Sign);
                (quote!(1.0 / #a), Binding::Product)
            }
            op => unreachable!("{op:?} of constants: nothing takes the root of a named number"),
        });
        if binding < context { quote!((#expression)) } else { expression }
    }
}

/// The order in which angles go into vectors, by when they are there and when
/// they are waited for. Gain: `benches/README.md`.
fn arrange(order: &mut [usize], angles: &[Angle], is_in_columns: bool) {
    let last_joint = |angle: &Angle| angle.terms().last().map(|&(joint, _)| joint);
    if angles.first().map(last_joint) < angles.iter().map(last_joint).max() {
        // A sum is known last, and first in a vector it is there at once; the others as
        // they lie in memory; the first joint's own, which stands apart, last.
        order.sort_by_key(|&index| {
            let (is_sum, last) = (angles[index].terms().len() > 1, last_joint(&angles[index]));
            (!is_sum, !is_sum && last == Some(0), last)
        });
    } else if is_in_columns
        && let &mut [tip, second, sum, third, base] = order
        && angles[sum].terms().len() > 1
    {
        // Of five angles one is alone in its vector. Found by trying all orders.
        order.copy_from_slice(&[tip, sum, base, third, second]);
    }
}
