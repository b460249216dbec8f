//! Angles as sums of joint coordinates and a constant.
//!
//! Turns about parallel axes add up to one angle, and one angle needs one sine
//! and cosine: `q2 + q3` instead of products of four.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, Neg};

use robstiff_robots::angle::quarter_turns;

/// `sum of factor * q_joint + offset`, with joints from 0 in ascending order,
/// and the deviations of joints that stand aside of their coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Angle {
    terms: Vec<(usize, i32)>,
    offset: f64,
    deviations: Vec<(usize, i32)>,
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
        Self { offset: within_half_a_turn(offset), ..Self::default() }
    }

    /// The coordinate of a joint (from 0) plus a constant (rad).
    pub fn of_joint(joint: usize, offset: f64) -> Self {
        Self { terms: vec![(joint, 1)], offset: within_half_a_turn(offset), ..Self::default() }
    }

    /// A multiple of the coordinate of a joint (from 0).
    pub fn multiple(joint: usize, factor: i32) -> Self {
        Self { terms: vec![(joint, factor)], ..Self::default() }
    }

    /// With the angle by which a joint (from 0) stands aside of its coordinate,
    /// which the graph knows.
    pub fn with_deviation(mut self, joint: usize) -> Self {
        self.deviations.push((joint, 1));
        self
    }

    /// The joints (from 0) whose deviations are in it, with their signs.
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

    /// Whether it is exactly 0 for every pose.
    pub fn is_zero(&self) -> bool {
        self.terms.is_empty() && self.deviations.is_empty() && quarter_turns(self.offset) == Some(0)
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
        let turns = quarter_turns(self.offset);
        let offset = if turns.is_some() { 0.0 } else { self.offset };
        let mut rest = Self { terms: self.terms.clone(), offset, ..Self::default() };
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
        self.offset += other.offset;
        // Sums of quarter turns stay exact.
        self.offset = match quarter_turns(self.offset) {
            Some(turns) => f64::from(turns) * FRAC_PI_2,
            None => within_half_a_turn(self.offset),
        };
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
        self
    }
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
        for offset in [-PI, -3.1, 0.1 + 0.2, 3.0, PI] {
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
