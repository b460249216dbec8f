//! Where the arm is and what acts on it, over time.

use core::fmt;

use nalgebra::{SVector, Vector6};

use crate::path::{SolvedPath, lines};

/// Postures and wrenches at times, evenly between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Timeline<const N: usize> {
    moments: Vec<Moment<N>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Moment<const N: usize> {
    time: f64,
    q: SVector<f64, N>,
    wrench: Vector6<f64>,
}

/// Lines of a path to which nobody says how fast the tool moves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoFeed {
    /// The lines, from 1.
    pub lines: Vec<usize>,
}

impl fmt::Display for NoFeed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the path has no feed to {}", lines(self.lines.iter().copied()))
    }
}

impl core::error::Error for NoFeed {}

impl<const N: usize> Timeline<N> {
    /// A path with a wrench (N, Nm) at the TCP in the base frame for each of its
    /// points. Each point is reached with its own feed, or this one (m/s) where
    /// it has none; the joints move evenly from one to the next.
    ///
    /// # Errors
    /// The lines that have neither.
    ///
    /// # Panics
    /// If there are not as many wrenches as points.
    pub fn of_path(path: &SolvedPath<N>, wrenches: &[Vector6<f64>], feed: Option<f64>) -> Result<Self, NoFeed> {
        assert_eq!(path.points.len(), wrenches.len(), "each point has a wrench");
        let (mut moments, mut lines): (Vec<Moment<N>>, _) = (Vec::new(), Vec::new());
        let mut last = path.points.first().map_or(0.0, |point| point.s);
        for (point, &wrench) in path.points.iter().zip(wrenches) {
            let chord = (point.s - last).abs();
            last = point.s;
            let feed = point.feed.or(feed).filter(|feed| *feed > 0.0);
            let took = match feed {
                _ if chord == 0.0 => 0.0,
                Some(feed) => chord / feed,
                None => {
                    lines.push(point.line);
                    continue;
                }
            };
            let time = moments.last().map_or(0.0, |before| before.time) + took;
            moments.push(Moment { time, q: point.q, wrench });
        }
        if lines.is_empty() { Ok(Self { moments }) } else { Err(NoFeed { lines }) }
    }

    /// One posture under a wrench (N, Nm) that changes over time (s); the times
    /// are put in order and begin at 0. `None` without any, or where one is not
    /// finite.
    pub fn at_pose(q: &SVector<f64, N>, samples: impl IntoIterator<Item = (f64, Vector6<f64>)>) -> Option<Self> {
        let moment = |(time, wrench)| Moment { time, q: *q, wrench };
        let mut moments: Vec<Moment<N>> = samples.into_iter().map(moment).collect();
        moments.sort_by(|one, other| one.time.total_cmp(&other.time));
        let begin = moments.first()?.time;
        moments.iter_mut().for_each(|moment| moment.time -= begin);
        moments.iter().all(|moment| moment.time.is_finite()).then_some(Self { moments })
    }

    /// From the first moment to the last (s).
    pub fn duration(&self) -> f64 {
        self.moments.last().map_or(0.0, |moment| moment.time)
    }

    /// The times (s), from 0 on.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.moments.iter().map(|moment| moment.time)
    }

    /// The joint coordinates at a time (rad or m); before and after as at the
    /// ends.
    pub fn posture(&self, time: f64) -> SVector<f64, N> {
        self.between(time, |moment| moment.q)
    }

    /// The wrench at a time (N, Nm), in the same way.
    pub fn wrench(&self, time: f64) -> Vector6<f64> {
        self.between(time, |moment| moment.wrench)
    }

    fn between<const M: usize>(&self, time: f64, of: impl Fn(&Moment<N>) -> SVector<f64, M>) -> SVector<f64, M> {
        let next = self.moments.partition_point(|moment| moment.time <= time);
        match (next.checked_sub(1).map(|last| &self.moments[last]), self.moments.get(next)) {
            (Some(last), Some(next)) => of(last).lerp(&of(next), (time - last.time) / (next.time - last.time)),
            (Some(end), None) | (None, Some(end)) => of(end),
            (None, None) => SVector::zeros(),
        }
    }
}
