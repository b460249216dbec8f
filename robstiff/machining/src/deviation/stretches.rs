//! Where a tolerance holds.

use super::{Deviation, DeviationPoint};

/// Neighbouring points of a path that all keep a tolerance, or all break it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// The first and the last point, from 0.
    pub points: [usize; 2],
    /// Their lines in the path's file.
    pub lines: [usize; 2],
    /// Their arc lengths (m).
    pub s: [f64; 2],
    /// Whether the tolerance holds.
    pub holds: bool,
    /// The largest error in the cut, either way, with its sign (m); `None` where no point
    /// has one.
    pub worst: Option<f64>,
}

/// Errors along a path in three numbers (m), mean and rms by length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// The mean.
    pub mean: f64,
    /// The root of the mean square.
    pub rms: f64,
    /// The largest, either way, with its sign.
    pub worst: f64,
}

impl Summary {
    /// Of numbers, each with the length that it stands for; `None` of none. Where no number has a length, all count
    /// alike.
    pub fn of(values: impl IntoIterator<Item = (f64, f64)>) -> Option<Self> {
        let mut sums = [[0.0; 3]; 2];
        let (mut count, mut worst) = (0_usize, 0.0_f64);
        for (value, length) in values {
            count += 1;
            for (sum, weight) in sums.iter_mut().zip([length, 1.0]) {
                [weight, weight * value, weight * value * value].iter().zip(sum).for_each(|(part, sum)| *sum += part);
            }
            worst = larger(worst, value);
        }
        let [of, sum, squares] = if sums[0][0] > 0.0 { sums[0] } else { sums[1] };
        (count > 0).then(|| Self { mean: sum / of, rms: (squares / of).sqrt(), worst })
    }
}

fn larger(one: f64, other: f64) -> f64 {
    if other.abs() > one.abs() { other } else { one }
}

impl Deviation {
    /// Where the error of the surface is within a tolerance either way (m), and
    /// where it is not, in the order of the path. Where there is no surface, or no
    /// force that makes one, there is nothing to break: [`judged`](Self::judged) tells
    /// whether it holds anywhere because of that alone.
    pub fn stretches(&self, tolerance: f64) -> Vec<Stretch> {
        let mut stretches: Vec<Stretch> = Vec::new();
        for (i, point) in self.points.iter().enumerate() {
            let error = point.judged();
            let holds = error.is_none_or(|error| error.abs() <= tolerance);
            match stretches.last_mut().filter(|stretch| stretch.holds == holds) {
                Some(stretch) => {
                    (stretch.points[1], stretch.lines[1], stretch.s[1]) = (i, point.line, point.s);
                    stretch.worst = match (stretch.worst, error) {
                        (Some(one), Some(other)) => Some(larger(one, other)),
                        (one, other) => one.or(other),
                    };
                }
                None => stretches.push(Stretch {
                    points: [i; 2],
                    lines: [point.line; 2],
                    s: [point.s; 2],
                    holds,
                    worst: error,
                }),
            }
        }
        stretches
    }

    /// The points at which something pushes the tool. Approaches and retracts have no
    /// part in the errors of a path: they would make their mean as small as they are long.
    pub fn in_cut(&self) -> impl Iterator<Item = &DeviationPoint> {
        self.points.iter().filter(|point| point.in_cut())
    }

    /// The errors that a tolerance is compared with, of the points in the cut that have one.
    pub fn judged(&self) -> impl Iterator<Item = f64> {
        self.points.iter().filter_map(DeviationPoint::judged)
    }

    /// The error of the surface over the points in the cut that have one; `None` where
    /// none has, as of a tool that plunges.
    pub fn errors(&self) -> Option<Summary> {
        self.summary(DeviationPoint::judged)
    }

    /// The distance from the path over the points in the cut; `None` where nothing pushes.
    pub fn distances(&self) -> Option<Summary> {
        self.summary(|point| Some(point.distance()))
    }

    /// What the points in the cut have of something, each by the length of the path that it stands for; `None` where none
    /// has it.
    pub fn summary(&self, of: impl Fn(&DeviationPoint) -> Option<f64>) -> Option<Summary> {
        Summary::of(self.in_cut().filter_map(|point| Some((of(point)?, point.length))))
    }
}
