//! How fast a force a control keeps up with.

use std::fmt;

use crate::text::significant;

/// Frequencies between which is looked (Hz), from lower ones on where a correction lags by long.
const RANGE: [f64; 2] = [0.1, 1000.0];

/// Periods in a lag from which on is looked: far fewer than the half up to which more is left
/// the faster the force. Beyond that there is less again where whole periods are in a lag.
const SLOW: f64 = 0.05;

/// So many of them at most.
const RISING: f64 = 0.25;

/// How near the ends of the last interval are, the higher over the lower.
const NEAR: f64 = 1.002;

/// The frequency (Hz) up to which less than some part of the deviation is left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// That frequency.
    To(f64),
    /// At this one, the lowest that was looked at, it is more already.
    Below(f64),
    /// At this one, the highest that was looked at, it is less still.
    Above(f64),
}

impl Reach {
    /// The frequency (Hz), if it was found.
    pub fn found(self) -> Option<f64> {
        match self {
            Self::To(frequency) => Some(frequency),
            Self::Below(_) | Self::Above(_) => None,
        }
    }

    /// Looks for it, by doubling and halving from a first frequency (Hz), or from a lower one at
    /// which a correction that lags by so long (s) is in time. `left` is the part that is left at a
    /// frequency, `affordable` whether anybody would wait for that.
    pub fn of(
        part: f64,
        (first, lag): (f64, f64),
        affordable: impl Fn(f64) -> bool,
        left: impl Fn(f64) -> f64,
    ) -> Self {
        let [lowest, highest] = [RANGE[0].min(SLOW / lag), RANGE[1]];
        let mut slow = first.min(SLOW / lag);
        while slow < first && !affordable(slow) {
            slow = (2.0 * slow).min(first);
        }
        if slow * lag > RISING {
            return Self::Below(slow);
        }
        let (mut low, mut high) = (slow, slow);
        if left(slow) < part {
            loop {
                if high >= highest {
                    return Self::Above(high);
                }
                low = high;
                high = (2.0 * high).min(highest);
                if left(high) >= part {
                    break;
                }
            }
        } else {
            loop {
                let next = (0.5 * low).max(lowest);
                if low <= lowest || !affordable(next) {
                    return Self::Below(low);
                }
                high = low;
                low = next;
                if left(low) < part {
                    break;
                }
            }
        }
        while high > NEAR * low {
            let middle = (low * high).sqrt();
            if left(middle) < part { low = middle } else { high = middle }
        }
        Self::To((low * high).sqrt())
    }
}

impl fmt::Display for Reach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (sign, frequency) = match *self {
            Self::To(frequency) => ("", frequency),
            Self::Below(frequency) => ("< ", frequency),
            Self::Above(frequency) => ("> ", frequency),
        };
        write!(f, "{sign}{} Hz", significant(frequency, 3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More is left the faster the force, in proportion up to a corner (Hz).
    fn reach(corner: f64, first: f64, affordable: impl Fn(f64) -> bool) -> Reach {
        Reach::of(0.5, (first, 1e-6), affordable, |frequency| frequency / corner)
    }

    /// What a correction leaves that is late by so much (s) and else right.
    fn late(lag: f64) -> impl Fn(f64) -> f64 {
        move |frequency| 2.0 * (std::f64::consts::PI * frequency * lag).sin().abs()
    }

    #[test]
    fn a_lag_of_whole_periods_is_no_lag() {
        // At 1 Hz a second is a period, and nothing is left.
        for lag in [0.02, 0.3, 1.0, 1.02, 3.0, 20.0] {
            for first in [0.2, 1.0, 10.0] {
                // Half is left at an angle of 2 asin(1 / 4), all of it at pi / 3.
                for (part, periods) in [(0.5, 2.0 * 0.25_f64.asin() / std::f64::consts::TAU), (1.0, 1.0 / 6.0)] {
                    let found = Reach::of(part, (first, lag), |_| true, late(lag));
                    let error = found.found().expect("it is found") * lag / periods - 1.0;
                    assert!(error.abs() < 0.001, "{lag} {first} {part}: {found}");
                }
            }
        }
        // Where nobody would wait for a slow force, a fast one says nothing.
        assert_eq!(Reach::of(0.5, (1.0, 3.0), |frequency| frequency >= 1.0, late(3.0)), Reach::Below(1.0));
    }

    #[test]
    fn it_is_found_from_either_side() {
        for (corner, first) in [(24.0, 1.0), (24.0, 100.0), (0.5, 1.0), (1500.0, 1.0)] {
            let found = reach(corner, first, |_| true).found().expect("within the range");
            assert!((found / (0.5 * corner) - 1.0).abs() < 0.01, "{corner} from {first}: {found}");
        }
    }

    #[test]
    fn the_best_and_the_worst_are_told_apart() {
        assert_eq!(reach(1e6, 1.0, |_| true), Reach::Above(1000.0));
        assert_eq!(reach(1e6, 3000.0, |_| true), Reach::Above(3000.0));
        assert_eq!(reach(1e-6, 1.0, |_| true), Reach::Below(0.1));
        assert_eq!(reach(1e-6, 0.05, |_| true), Reach::Below(0.05));
        assert_eq!(reach(1e-6, 100.0, |frequency| frequency > 20.0), Reach::Below(25.0));
        assert_eq!([Reach::Above(1000.0), Reach::Below(0.1)].map(|reach| reach.to_string()), ["> 1000 Hz", "< 0.1 Hz"]);
    }
}
