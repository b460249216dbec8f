//! Angles as sums of joint coordinates and a constant.
//!
//! Turns about parallel axes add up to one angle, and one angle needs one sine
//! and cosine: `q2 + q3` instead of products of four.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, Neg};

use robstiff_robots::angle::{quarter_turns, snapped};

/// `sum of factor * q_joint + offset`, with joints from 0 in ascending order,
/// and the deviations, by index, of joints that stand aside of their coordinates.
#[derive(Clone, Debug, Default)]
pub struct Angle {
    terms: Vec<(usize, i32)>,
    /// Within half a turn, and a multiple of 90 degrees exactly or not at all.
    offset: f64,
    deviations: Vec<(usize, i32)>,
    /// What the offset is made of, but for rounding and whole turns.
    parts: Vec<Part>,
}

/// A number of the description in the constant part of an angle.
#[derive(Clone, Debug)]
pub struct Part {
    /// The name in generated code, e.g. `THETA2`.
    pub name: String,
    /// What it is, for generated docs: "the yaw of the base".
    pub what: String,
    /// Its value (rad).
    pub value: f64,
    /// Whether it is subtracted.
    pub is_negative: bool,
}

/// What an angle is made of makes it no other.
impl PartialEq for Angle {
    fn eq(&self, other: &Self) -> bool {
        (&self.terms, self.offset, &self.deviations) == (&other.terms, other.offset, &other.deviations)
    }
}

/// An angle as `quarter_turns * 90 degrees +- rest`.
pub(crate) struct Reduced {
    /// 0 to 3.
    pub quarter_turns: u8,
    /// Whether the rest enters with a minus.
    pub negated: bool,
    /// What is left, without deviations: its first term is positive, and its offset is no multiple
    /// of 90 degrees. Nothing, if the angle is such a multiple.
    pub rest: Option<Angle>,
}

impl Angle {
    /// A constant angle (rad).
    pub fn constant(offset: f64) -> Self {
        Self { offset: stated(offset), ..Self::default() }
    }

    /// The coordinate of a joint (from 0) plus a constant (rad).
    pub fn of_joint(joint: usize, offset: f64) -> Self {
        Self { terms: vec![(joint, 1)], offset: stated(offset), ..Self::default() }
    }

    /// With a name for its constant part, which the description says is `value` (rad).
    pub fn named(mut self, name: &str, value: f64, what: &str) -> Self {
        if value != 0.0 {
            self.parts = vec![Part { name: name.to_owned(), what: what.to_owned(), value, is_negative: false }];
        }
        self
    }

    /// A multiple of the coordinate of a joint (from 0).
    pub fn multiple(joint: usize, factor: i32) -> Self {
        Self { terms: vec![(joint, factor)], ..Self::default() }
    }

    /// With an angle by which a joint stands aside of its coordinate, by its
    /// [index](crate::graph::Graph::add_deviation) in the graph.
    pub fn with_deviation(mut self, index: usize) -> Self {
        self.deviations.push((index, 1));
        self
    }

    /// The deviations that are in it, by their indices in the graph, with their signs.
    pub fn deviations(&self) -> &[(usize, i32)] {
        &self.deviations
    }

    /// The joints (from 0) with their factors.
    pub fn terms(&self) -> &[(usize, i32)] {
        &self.terms
    }

    /// The constant part (rad).
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// The numbers whose sum the constant part is, where it is just that: whole turns are
    /// left out of it, and rounding may depend on the order.
    pub fn parts(&self) -> Option<&[Part]> {
        let signed = |part: &Part| if part.is_negative { -part.value } else { part.value };
        let sum = self.parts.iter().map(signed).reduce(|sum, part| sum + part)?;
        (sum == self.offset).then_some(&self.parts)
    }

    /// Whether it is exactly 0 for every pose.
    pub fn is_zero(&self) -> bool {
        self.terms.is_empty() && self.deviations.is_empty() && whole_quarters(self.offset) == Some(0)
    }

    /// Digits that name it: `23` for q2 + q3, `2m3` for q2 - q3, with an `o`
    /// where an odd offset is in it.
    pub fn label(&self) -> String {
        let mut label = String::new();
        for &(joint, factor) in &self.terms {
            if factor < 0 {
                label.push('m');
            }
            if factor.abs() > 1 {
                label.push_str(&format!("{}x", factor.abs()));
            }
            label.push_str(&(joint + 1).to_string());
        }
        if self.offset != 0.0 {
            label.push('o');
        }
        label
    }

    pub(crate) fn reduced(&self) -> Reduced {
        let turns = whole_quarters(self.offset);
        let offset = if turns.is_some() { 0.0 } else { self.offset };
        let mut rest = Self { terms: self.terms.clone(), offset, parts: self.parts.clone(), ..Self::default() };
        let negated = rest.terms.first().is_some_and(|&(_, factor)| factor < 0);
        if negated {
            rest = -rest;
        }
        let rest = (!rest.terms.is_empty() || turns.is_none()).then_some(rest);
        Reduced { quarter_turns: turns.unwrap_or(0), negated, rest }
    }
}

impl Add<&Angle> for Angle {
    type Output = Self;

    fn add(mut self, other: &Self) -> Self {
        for (terms, others) in [(&mut self.terms, &other.terms), (&mut self.deviations, &other.deviations)] {
            for &(joint, factor) in others {
                match terms.binary_search_by_key(&joint, |term| term.0) {
                    Ok(at) => terms[at].1 += factor,
                    Err(at) => terms.insert(at, (joint, factor)),
                }
            }
            terms.retain(|term| term.1 != 0);
        }
        self.offset = sum(self.offset, other.offset);
        for part in &other.parts {
            let opposite = |own: &Part| own.name == part.name && own.is_negative != part.is_negative;
            match self.parts.iter().position(opposite) {
                Some(at) => drop(self.parts.remove(at)),
                None => self.parts.push(part.clone()),
            }
        }
        self
    }
}

impl Neg for Angle {
    type Output = Self;

    fn neg(mut self) -> Self {
        for term in self.terms.iter_mut().chain(&mut self.deviations) {
            term.1 = -term.1;
        }
        self.offset = -self.offset;
        self.parts.iter_mut().for_each(|part| part.is_negative = !part.is_negative);
        self
    }
}

/// A multiple of 90 degrees, within half a turn.
fn multiple(quarters: u8) -> f64 {
    [0.0, FRAC_PI_2, PI, -FRAC_PI_2][usize::from(quarters % 4)]
}

/// An angle of a description: a multiple of 90 degrees where it is near one.
fn stated(angle: f64) -> f64 {
    quarter_turns(angle).map_or_else(|| within_half_a_turn(angle), multiple)
}

/// The sum of two angles that [`sum`] or [`stated`] gave. What a description says is
/// a multiple of 90 degrees if it is near one, what comes of it only to rounding.
fn sum(one: f64, other: f64) -> f64 {
    if let (Some(one), Some(other)) = (whole_quarters(one), whole_quarters(other)) {
        return multiple(one + other);
    }
    let rounding = 1e-15 * (one.abs() + other.abs()).max(1.0);
    let sum = within_half_a_turn(one + other);
    let near = snapped(sum);
    if (sum - near).abs() > rounding { sum } else { stated(near) }
}

/// The number of quarter turns, reduced to `0..4`, of an angle that is exactly one.
fn whole_quarters(angle: f64) -> Option<u8> {
    quarter_turns(angle).filter(|_| snapped(angle) == angle)
}

/// An angle without its whole turns, to rounding, and as it is where it has none: a
/// coordinate that is added to a large one loses its last places.
fn within_half_a_turn(angle: f64) -> f64 {
    // A turn in parts of 33 and 20 bits and what a number has no room for. Up to 2^20
    // turns, which no description comes near, their multiples are exact, and so are
    // the first two differences: multiples of the smaller of both sides' last places.
    const HIGH: f64 = f64::from_bits(TAU.to_bits() >> 20 << 20);
    const LOW: f64 = TAU - HIGH;
    const BEYOND: f64 = 2.449_293_598_294_706_4e-16;
    if angle.abs() <= PI {
        return angle;
    }
    let turns = (angle / TAU).round();
    angle - turns * HIGH - turns * LOW - turns * BEYOND
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Graph;

    #[test]
    fn the_constant_part_says_what_it_is_made_of() {
        let theta = |joint: usize, value: f64| Angle::of_joint(joint, value).named(&format!("T{joint}"), value, "");
        let made_of = |angle: &Angle| -> Option<String> {
            let signed = |part: &Part| format!("{}{}", if part.is_negative { '-' } else { '+' }, part.name);
            Some(angle.parts()?.iter().map(signed).collect())
        };
        let sum = -theta(1, 0.25) + &theta(2, -0.125);
        assert_eq!(made_of(&sum).as_deref(), Some("-T1+T2"));
        assert_eq!(made_of(&(sum.clone() + &theta(1, 0.25))).as_deref(), Some("+T2"));
        assert_eq!(made_of(&theta(1, 0.0)), None);
        // Without whole turns it is no longer their sum.
        assert_eq!(made_of(&(theta(1, 3.0) + &theta(2, 2.0))), None);
        assert_eq!(sum, -Angle::of_joint(1, 0.25) + &Angle::of_joint(2, -0.125));
    }

    #[test]
    fn quarter_turns_swap_sine_and_cosine() {
        let g = Graph::new();
        let (s, c) = g.sin_cos(&Angle::of_joint(1, 0.0));
        assert_eq!(g.sin_cos(&Angle::of_joint(1, FRAC_PI_2)), (c, -s));
        assert_eq!(g.sin_cos(&Angle::of_joint(1, -FRAC_PI_2)), (-c, s));
        assert_eq!(g.sin_cos(&Angle::of_joint(1, 2.0 * FRAC_PI_2)), (-s, -c));
        assert_eq!(g.sin_cos(&-Angle::of_joint(1, FRAC_PI_2)), (-c, -s));
    }

    #[test]
    fn constants_are_exact() {
        let g = Graph::new();
        let (s, c) = g.sin_cos(&Angle::constant(2.0 * FRAC_PI_2));
        assert_eq!((s.constant(), c.constant()), (Some(0.0), Some(-1.0)));
    }

    #[test]
    fn offsets_have_no_whole_turns() {
        for offset in [-PI + 1e-6, -FRAC_PI_2, -0.1, 0.1 + 0.2, 3.0, PI] {
            assert_eq!(Angle::of_joint(0, offset).offset(), offset);
        }
        for step in 0..20_000_i32 {
            let stated = f64::from(step - 10_000).powi(3) * 1.1e-6;
            for reduced in [Angle::of_joint(0, stated), Angle::constant(stated)].map(|angle| angle.offset()) {
                assert!(reduced.abs() <= PI, "{stated}");
                // The platform reduces exactly.
                let (s, c) = stated.sin_cos();
                let (sine, cosine) = reduced.sin_cos();
                assert!((s - sine).abs() < 4e-16 && (c - cosine).abs() < 4e-16, "{stated}: {reduced}");
            }
        }
        let sum = Angle::of_joint(0, 3.0) + &Angle::constant(2.5);
        assert!((sum.offset() - (5.5 - TAU)).abs() < 1e-15);
    }

    /// A multiple of 90 degrees in a description may be rounded; a sum of two angles
    /// that are none is none.
    #[test]
    fn sums_are_right_angles_only_to_rounding() {
        let (stated, off) = (Angle::of_joint(0, FRAC_PI_2 + 5e-10), Angle::constant(0.7));
        assert_eq!(stated.offset(), FRAC_PI_2);
        assert_eq!((stated + &off).offset(), FRAC_PI_2 + 0.7);
        for quarters in -1..4 {
            let right = f64::from(quarters) * FRAC_PI_2;
            let near = off.clone() + &Angle::constant(right - 0.7 + 5e-10);
            assert!(near.reduced().rest.is_some() && (near.offset() - right - 5e-10).sin().abs() < 1e-15);
            let there = Angle::constant(0.4) + &(off.clone() + &Angle::constant(right - 1.1));
            assert!(there.reduced().rest.is_none());
        }
    }

    #[test]
    fn opposite_turns_cancel() {
        let there = Angle::of_joint(2, 0.25);
        assert!((there.clone() + &-there).is_zero());
    }

    #[test]
    fn labels_read_like_the_sum() {
        assert_eq!((Angle::of_joint(1, 0.0) + &Angle::of_joint(2, 0.0)).label(), "23");
        assert_eq!((Angle::of_joint(1, 0.0) + &-Angle::of_joint(2, 0.1)).label(), "2m3o");
    }
}
