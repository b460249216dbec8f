//! Simplification, at the moment an operation is written down.
//!
//! Zeros and ones vanish, signs move outwards until a sum absorbs them, and
//! constants meet, so that the compiler computes them once. Nothing here
//! reorders a sum of more than two terms: rounding stays that of the formula.

use std::ops::{Add, Mul, Neg, Sub};

use robstiff_robots::effect::Scalar;

use crate::graph::Sym;
use crate::op::Op;

impl<'g> Sym<'g> {
    fn at(self, id: usize) -> Self {
        Self { graph: self.graph, id }
    }

    fn make(self, op: Op, value: Option<f64>) -> Self {
        match value {
            // A constant that came out as 0 or +-1 must fold further.
            Some(value) if value == 0.0 || value.abs() == 1.0 => self.graph.number(value),
            _ => self.graph.intern(op, value),
        }
    }

    fn both_constant(self, other: Self, apply: fn(f64, f64) -> f64) -> Option<f64> {
        Some(apply(self.constant()?, other.constant()?))
    }

    /// The operand, if this is a negation. Of a constant it is one beside another constant only:
    /// beside anything else the compiler computes it with its sign, which then costs nothing.
    fn negated(self, beside: Self) -> Option<Self> {
        match self.op() {
            Op::Neg(a) if self.constant().is_none() || beside.constant().is_some() => Some(self.at(a)),
            _ => None,
        }
    }

    /// The constant factor of a product, with its sign, and the rest.
    pub fn split_constant(self) -> Option<(Self, Self)> {
        if self.constant().is_some() {
            return Some((self, self.graph.number(1.0)));
        }
        match self.op() {
            Op::Neg(a) => self.at(a).split_constant().map(|(constant, rest)| (-constant, rest)),
            Op::Mul(a, b) => {
                let (a, b) = (self.at(a), self.at(b));
                [(a, b), (b, a)].into_iter().find(|(a, _)| a.constant().is_some())
            }
            _ => None,
        }
    }

    /// `self * self`.
    pub fn squared(self) -> Self {
        self * self
    }

    /// The square root.
    pub fn sqrt(self) -> Self {
        self.make(Op::Sqrt(self.id), self.constant().map(f64::sqrt))
    }

    /// `1 / self`.
    pub fn recip(self) -> Self {
        self.make(Op::Recip(self.id), self.constant().map(f64::recip))
    }

    /// The larger of the two.
    pub fn max(self, other: Self) -> Self {
        self.either(other, Op::Max, f64::max)
    }

    /// The smaller of the two.
    pub fn min(self, other: Self) -> Self {
        self.either(other, Op::Min, f64::min)
    }

    fn either(self, other: Self, op: fn(usize, usize) -> Op, apply: fn(f64, f64) -> f64) -> Self {
        if self == other {
            return self;
        }
        match self.both_constant(other, apply) {
            // Which of the two it is, is known: no operation.
            Some(value) => {
                if self.constant() == Some(value) {
                    self
                } else {
                    other
                }
            }
            None => self.make(op(self.id, other.id), None),
        }
    }
}

/// The catalogue's formulas, on symbols.
impl Scalar for Sym<'_> {
    fn times(self, factor: f64) -> Self {
        self * self.graph.number(factor)
    }

    fn plus(self, summand: f64) -> Self {
        self + self.graph.number(summand)
    }

    fn sqrt(self) -> Self {
        Sym::sqrt(self)
    }

    fn recip(self) -> Self {
        Sym::recip(self)
    }

    fn max(self, other: Self) -> Self {
        Sym::max(self, other)
    }

    fn min(self, other: Self) -> Self {
        Sym::min(self, other)
    }

    fn signum(self) -> Self {
        match self.constant() {
            Some(value) => self.graph.number(value.signum()),
            None => self * Sym::sqrt(self.squared()).recip(),
        }
    }
}

impl<'g> Add for Sym<'g> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        match (self.negated(other), other.negated(self)) {
            (Some(a), Some(b)) => return -(a + b),
            (Some(a), None) => return other - a,
            (None, Some(b)) => return self - b,
            (None, None) => {}
        }
        let (a, b) = (self.id.min(other.id), self.id.max(other.id));
        self.make(Op::Add(a, b), self.both_constant(other, |x, y| x + y))
    }
}

impl<'g> Sub for Sym<'g> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        if self == other {
            return self.graph.number(0.0);
        }
        if other.is_zero() {
            return self;
        }
        if self.is_zero() {
            return -other;
        }
        match (self.negated(other), other.negated(self)) {
            (Some(a), Some(b)) => return b - a,
            (Some(a), None) => return -(a + other),
            (None, Some(b)) => return self + b,
            (None, None) => {}
        }
        self.make(Op::Sub(self.id, other.id), self.both_constant(other, |x, y| x - y))
    }
}

impl<'g> Mul for Sym<'g> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        match (self.constant(), other.constant()) {
            (Some(0.0), _) | (_, Some(0.0)) => return self.graph.number(0.0),
            (Some(1.0), _) => return other,
            (_, Some(1.0)) => return self,
            (Some(-1.0), _) => return -other,
            (_, Some(-1.0)) => return -self,
            // 2 x is one addition.
            (Some(2.0), None) => return other + other,
            (None, Some(2.0)) => return self + self,
            (None, Some(_)) => return other * self,
            _ => {}
        }
        match (self.negated(other), other.negated(self)) {
            (Some(a), Some(b)) => return a * b,
            (Some(a), None) => return -(a * other),
            (None, Some(b)) => return -(self * b),
            (None, None) => {}
        }
        // A constant times a constant multiple: the constants meet.
        if let (Some(_), None, Op::Mul(a, b)) = (self.constant(), other.constant(), other.op())
            && self.at(a).constant().is_some()
        {
            return (self * self.at(a)) * self.at(b);
        }
        let (a, b) = match (self.constant(), other.constant()) {
            (Some(_), None) => (self.id, other.id),
            _ => (self.id.min(other.id), self.id.max(other.id)),
        };
        self.make(Op::Mul(a, b), self.both_constant(other, |x, y| x * y))
    }
}

impl<'g> Neg for Sym<'g> {
    type Output = Self;

    fn neg(self) -> Self {
        match self.op() {
            Op::Number(bits) => self.graph.number(-f64::from_bits(bits)),
            Op::Neg(a) => self.at(a),
            Op::Sub(a, b) => self.at(b) - self.at(a),
            _ => self.make(Op::Neg(self.id), self.constant().map(|value| -value)),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::graph::Graph;
    use crate::op::Op;

    #[test]
    fn zeros_and_ones_vanish() {
        let g = Graph::new();
        let (x, zero, one) = (g.coordinate(0), g.number(0.0), g.number(1.0));
        assert_eq!(x + zero, x);
        assert_eq!(zero - x, -x);
        assert_eq!(x * one, x);
        assert!((x * zero).is_zero() && (x - x).is_zero());
        assert_eq!(g.number(-1.0) * x, -x);
        assert_eq!(g.named_number("A1", 1.0, ""), one);
    }

    #[test]
    fn signs_move_outwards_until_a_sum_absorbs_them() {
        let g = Graph::new();
        let (x, y) = (g.coordinate(0), g.coordinate(1));
        assert_eq!((-x) * (-y), x * y);
        assert_eq!((-x) * y, -(x * y));
        assert_eq!((-x) + y, y - x);
        assert_eq!(-(x - y), y - x);
        assert_eq!((-x) - y, -(x + y));
        assert_eq!(-(-x), x);
    }

    #[test]
    fn equal_expressions_are_one_node() {
        let g = Graph::new();
        let (x, y) = (g.coordinate(0), g.coordinate(1));
        let before = (x * y + x).id();
        assert_eq!((x + y * x).id(), before);
    }

    /// A person reads them, too; beside what is no constant a sign stays where it costs nothing.
    #[test]
    fn signs_of_constants_cancel() {
        let g = Graph::new();
        let (x, a, h) = (g.coordinate(0), g.named_number("A1", 0.41, ""), g.named_number("H1", 3e-7, ""));
        assert_eq!((-a) * (-h), a * h);
        assert_eq!((-a) * h, -(a * h));
        assert_eq!((-a) + h, h - a);
        assert_eq!((-a) - h, -(a + h));
        assert_eq!(h - (-a), h + a);
        assert!(matches!(((-a) * x).op(), Op::Mul(..)), "no negative of a product");
    }

    #[test]
    fn constants_meet_and_keep_their_names() {
        let g = Graph::new();
        let x = g.coordinate(0);
        let (a, h) = (g.named_number("A1", 0.41, ""), g.named_number("H1", 3e-7, ""));
        let product = h * (a * x);
        assert_eq!(product, (h * a) * x);
        let Op::Mul(constant, _) = product.op() else { panic!("a product") };
        assert_eq!(g.nodes()[constant].constant, Some(3e-7 * 0.41));
        assert!(matches!(g.nodes()[constant].op, Op::Mul(..)), "not a bare number");
    }
}
