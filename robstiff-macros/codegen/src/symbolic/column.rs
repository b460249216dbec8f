//! Four numbers side by side, which a scalar may compute with as one.
//!
//! A column of a homogeneous matrix: an axis, or a point. Where nothing needs
//! to be computed, nothing is, as with single numbers.

use super::vector::Vec3;
use crate::graph::{Graph, Sym};
use crate::op::{CYCLED, Id, Op};

/// A node that is four numbers.
#[derive(Clone, Copy)]
pub struct Column<'g> {
    g: &'g Graph,
    id: Id,
}

impl<'g> Column<'g> {
    /// From its entries.
    pub fn of(g: &'g Graph, entries: [Sym<'g>; 4]) -> Self {
        Self { g, id: g.intern(Op::Column(entries.map(Sym::id)), None).id() }
    }

    /// A node that is a column.
    pub fn of_node(g: &'g Graph, id: Id) -> Self {
        Self { g, id }
    }

    /// The unit vector along `axis`, from 0; 3 is the origin.
    pub fn unit(g: &'g Graph, axis: usize) -> Self {
        Self::of(g, std::array::from_fn(|i| g.number(f64::from(u8::from(i == axis)))))
    }

    /// The column of zeros.
    pub fn zero(g: &'g Graph) -> Self {
        Self::of(g, [g.number(0.0); 4])
    }

    /// Suggests a name for generated code.
    pub fn named(self, name: &str) -> Self {
        self.sym(self.id).named(name);
        self
    }

    fn sym(self, id: Id) -> Sym<'g> {
        Sym { graph: self.g, id }
    }

    fn op(self) -> Op {
        self.sym(self.id).op()
    }

    fn make(self, op: Op) -> Self {
        Self { g: self.g, id: self.g.intern(op, None).id() }
    }

    /// The entries, if they are nodes of their own.
    fn entries(self) -> Option<[Sym<'g>; 4]> {
        if let Op::Column(entries) = self.op() { Some(entries.map(|entry| self.sym(entry))) } else { None }
    }

    /// Entry `i`, from 0.
    pub fn at(self, i: usize) -> Sym<'g> {
        match self.entries() {
            Some(entries) => entries[i],
            None if self.is_zero_at(i) => self.g.number(0.0),
            None => self.g.intern(Op::Entry(self.id, i), None),
        }
    }

    /// The same with operations of its own, if these are products that do not wait for the
    /// column.
    pub fn early_at(self, i: usize) -> Sym<'g> {
        self.product_at(i).unwrap_or_else(|| self.at(i))
    }

    /// An entry as products of others, if it is one.
    pub fn product_at(self, i: usize) -> Option<Sym<'g>> {
        let column = |id| Self { g: self.g, id };
        let (other, factor) = match self.op() {
            Op::Column(entries) => return Some(self.sym(entries[i])),
            Op::Scaled(a, factor) => (column(a), self.sym(factor)),
            Op::PlusScaled(a, b, factor) if column(a).is_zero_at(i) => (column(b), self.sym(factor)),
            _ => return None,
        };
        other.product_at(i).map(|entry| entry * factor)
    }

    /// The first three entries.
    pub fn vector(self) -> Vec3<'g> {
        Vec3(std::array::from_fn(|i| self.at(i)))
    }

    /// With 0 for the last entry: turns may make -0 of it.
    pub fn direction(self) -> Self {
        match self.entries() {
            Some([x, y, z, _]) => Self::of(self.g, [x, y, z, self.g.number(0.0)]),
            None => self.make(Op::Direction(self.id)),
        }
    }

    /// The node of the whole column.
    pub fn whole(self) -> Sym<'g> {
        self.sym(self.id)
    }

    /// Whether entry `i` is known to be 0.
    pub fn is_zero_at(self, i: usize) -> bool {
        let column = |id| Self { g: self.g, id };
        match self.op() {
            Op::Direction(_) if i == 3 => true,
            Op::Scaled(a, _) | Op::Direction(a) => column(a).is_zero_at(i),
            Op::PlusScaled(a, b, _) => column(a).is_zero_at(i) && column(b).is_zero_at(i),
            Op::Product(a, b) => column(a).is_zero_at(i) || column(b).is_zero_at(i),
            Op::PlusProduct(a, b, c) => column(a).is_zero_at(i) && (column(b).is_zero_at(i) || column(c).is_zero_at(i)),
            Op::Cycled(a) => column(a).is_zero_at(CYCLED[i]),
            Op::Column(entries) => self.sym(entries[i]).is_zero(),
            _ => unreachable!("a column"),
        }
    }

    /// Whether it depends on no input.
    pub fn is_constant(self) -> bool {
        self.entries().is_some_and(|entries| entries.iter().all(|entry| entry.constant().is_some()))
    }

    /// The axis, from 0, and the sign of a constant unit vector along an axis.
    pub fn unit_axis(self) -> Option<(usize, f64)> {
        let axis = (0..3).find(|&i| !self.is_zero_at(i))?;
        let sign = self.at(axis).constant().filter(|sign| sign.abs() == 1.0)?;
        (0..4).all(|i| i == axis || self.is_zero_at(i)).then_some((axis, sign))
    }

    fn is_zero(self) -> bool {
        (0..4).all(|i| self.is_zero_at(i))
    }

    /// The vector with the same number in each of its three entries. Unlike a
    /// number that goes into all four lanes, it is one operand from memory.
    pub fn thrice(number: Sym<'g>) -> Self {
        let g = number.graph;
        Self::of(g, [number, number, number, g.number(0.0)])
    }

    /// Times a factor.
    pub fn scaled(self, factor: Sym<'g>) -> Self {
        if factor.constant() == Some(1.0) {
            return self;
        }
        if factor.is_zero() || self.is_zero() {
            return Self::zero(self.g);
        }
        if let Some(entries) = self.entries().filter(|entries| entries.iter().all(|&entry| is_free(entry, factor))) {
            return Self::of(self.g, entries.map(|entry| entry * factor));
        }
        self.make(Op::Scaled(self.id, factor.id()))
    }

    /// `self + other * factor`.
    pub fn plus_scaled(self, other: Self, factor: Sym<'g>) -> Self {
        if factor.is_zero() || other.is_zero() {
            return self;
        }
        if self.is_zero() {
            return other.scaled(factor);
        }
        if let (Some(own), Some(others)) = (self.entries(), other.entries()) {
            let is_free = |i: usize| {
                is_free(others[i], factor)
                    && (own[i].is_zero() || others[i].is_zero() || (own[i].constant().and(factor.constant())).is_some())
            };
            if (0..4).all(is_free) {
                return Self::of(self.g, std::array::from_fn(|i| own[i] + others[i] * factor));
            }
        }
        self.make(Op::PlusScaled(self.id, other.id, factor.id()))
    }

    /// The product, entry by entry.
    pub fn times(self, other: Self) -> Self {
        if self.is_zero_in_product(other) {
            return Self::zero(self.g);
        }
        let (own, other) = self.with_constants_met(other);
        if other.is_one() && own.is_zero_at(3) {
            return own;
        }
        if let (Some(own), Some(others)) = (own.entries(), other.entries())
            && (0..4).all(|i| is_free(own[i], others[i]) || is_free(others[i], own[i]))
        {
            return Self::of(self.g, std::array::from_fn(|i| own[i] * others[i]));
        }
        self.make(Op::Product(own.id, other.id))
    }

    /// The two factors of a product with a number for all directions, where that meets a
    /// constant factor of this column: they are one then.
    fn with_constants_met(self, other: Self) -> (Self, Self) {
        let as_they_are = (self, other);
        let Some([number, ..]) = other.entries().filter(|_| other.is_constant()) else { return as_they_are };
        let Op::Scaled(column, factor) = self.op() else { return as_they_are };
        match self.sym(factor).split_constant() {
            Some((constant, rest)) if other == Self::thrice(number) => {
                (Self { g: self.g, id: column }.scaled(rest), Self::thrice(constant * number))
            }
            _ => as_they_are,
        }
    }

    /// Whether it is 1 for all directions.
    pub fn is_one(self) -> bool {
        self == Self::thrice(self.g.number(1.0))
    }

    /// The sum, entry by entry.
    pub fn plus(self, other: Self) -> Self {
        match other.op() {
            Op::Scaled(column, factor) => self.plus_scaled(Self { g: self.g, id: column }, self.sym(factor)),
            _ => self.plus_scaled(other, self.g.number(1.0)),
        }
    }

    /// `self + other * by`, entry by entry.
    pub fn plus_product(self, other: Self, by: Self) -> Self {
        if other.is_zero_in_product(by) {
            return self;
        }
        if self.is_zero() {
            return other.times(by);
        }
        let (other, by) = other.with_constants_met(by);
        if by.is_one() && other.is_zero_at(3) {
            return self.plus(other);
        }
        self.make(Op::PlusProduct(self.id, other.id, by.id))
    }

    fn is_zero_in_product(self, other: Self) -> bool {
        (0..4).all(|i| self.is_zero_at(i) || other.is_zero_at(i))
    }

    /// With y, z, x for the first three entries.
    pub fn cycled(self) -> Self {
        match self.entries() {
            // Numbers are moved as a whole, constants not at all.
            Some(entries) if self.is_constant() => Self::of(self.g, CYCLED.map(|i| entries[i])),
            _ => self.make(Op::Cycled(self.id)),
        }
    }
}

impl PartialEq for Column<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.whole() == other.whole()
    }
}

/// Whether the product of the two is no operation.
fn is_free(entry: Sym<'_>, factor: Sym<'_>) -> bool {
    match (entry.constant(), factor.constant()) {
        (Some(entry), _) if entry == 0.0 || entry.abs() == 1.0 => true,
        (_, Some(factor)) if factor.abs() == 1.0 => true,
        (entry, factor) => entry.and(factor).is_some(),
    }
}

/// A column or its negative: a sign costs nothing until it is to be seen.
#[derive(Clone, Copy)]
pub struct Signed<'g> {
    column: Column<'g>,
    is_negative: bool,
}

impl<'g> Signed<'g> {
    /// The column itself.
    pub fn of(column: Column<'g>) -> Self {
        Self { column, is_negative: false }
    }

    /// Its negative, if so.
    pub fn negated_if(self, is_negated: bool) -> Self {
        Self { is_negative: self.is_negative ^ is_negated, ..self }
    }

    fn sign(self, factor: Sym<'g>) -> Sym<'g> {
        if self.is_negative { -factor } else { factor }
    }

    /// `a * s + b * t` with any sign.
    pub fn combined((a, s): (Self, Sym<'g>), (b, t): (Self, Sym<'g>)) -> Self {
        // A quarter turn is another name.
        for ((one, factor), other) in [((a, s), t), ((b, t), s)] {
            if other.is_zero() && factor.squared().constant() == Some(1.0) {
                return one.negated_if(factor.constant() == Some(-1.0));
            }
        }
        // Entries that are there take no product as the second of the two, and
        // what is known later goes in later.
        let is_there = |column: Self, factor| column.column.scaled(factor).entries().is_some();
        let ready = |column: Self, factor: Sym<'g>| column.column.whole().ready().max(factor.ready());
        let ((a, s), (b, t)) = match !is_there(b, t) && (is_there(a, s) || ready(a, s) > ready(b, t)) {
            true => ((b, t), (a, s)),
            false => ((a, s), (b, t)),
        };
        let t = if a.is_negative { -b.sign(t) } else { b.sign(t) };
        Self { column: a.column.scaled(s).plus_scaled(b.column, t), is_negative: a.is_negative }
    }

    /// `sum + self * factor`.
    pub fn added(self, sum: Column<'g>, factor: Sym<'g>) -> Column<'g> {
        sum.plus_scaled(self.column, self.sign(factor))
    }

    /// The column with its sign.
    pub fn column(self) -> Column<'g> {
        self.column.scaled(self.sign(self.column.g.number(1.0)))
    }
}
