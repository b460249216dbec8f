//! A job as its page shows it: plain numbers, in SI units.

/// What is known of a job.
pub struct Job<'a> {
    /// The robot's name.
    pub robot: String,
    /// The file of the path.
    pub file: String,
    /// The file of the forces, and the surface that they machine: `wall`, `floor`.
    pub forces: Option<(String, &'static str)>,
    /// Whether errors are those of the worst force of a revolution.
    pub is_peak: bool,
    /// The points, in the order of the path.
    pub points: Vec<Point<'a>>,
    /// The joints, in order.
    pub joints: Vec<Joint>,
    /// The stock, in the frame of the path.
    pub stock: Option<Block>,
    /// How large the error of the surface may be, either way (m).
    pub tolerance: Option<f64>,
    /// Whether the path is corrected; what is left of the deviation then.
    pub corrected: Option<Left>,
    /// Which share of the error comes from which joint or effect, the largest first.
    pub shares: Vec<(String, f64)>,
    /// Where the arm chatters, in a sentence without its full stop, and of the worst places line, speed (rpm), margin and
    /// the speed that mends it (rpm); where that is asked.
    pub chatter: Option<(String, Vec<[String; 4]>)>,
    /// Rows of mean, root of the mean square and worst (m), each with what it is of.
    pub summary: Vec<(String, [f64; 3])>,
    /// The program's files.
    pub files: Vec<String>,
}

/// A stock.
pub struct Block {
    /// Its corners in x and y (m), in order.
    pub outline: Vec<[f64; 2]>,
    /// The heights of its underside and its top (m).
    pub heights: [f64; 2],
}

/// What a correction leaves of the worst deviation (m) if the true compliance differs by a part either way.
pub struct Left {
    /// The part.
    pub by: f64,
    /// The worst deviation then (m).
    pub worst: f64,
}

/// One point.
pub struct Point<'a> {
    /// The line of the path's file, from 1.
    pub line: usize,
    /// What stands there.
    pub text: &'a str,
    /// The arc length (m).
    pub s: f64,
    /// Where it is (m), in the frame of the path.
    pub at: [f64; 3],
    /// Whether it is reached by a rapid.
    pub rapid: bool,
    /// The feed (m/s), where it is known.
    pub feed: Option<f64>,
    /// The joint coordinates that are commanded (rad or m).
    pub q: &'a [f64],
    /// The size of the force (N), where there are forces.
    pub force: Option<f64>,
    /// Radial width and axial depth of the cut (m), where they are known.
    pub section: Option<[f64; 2]>,
    /// The distance from the path (m), without a correction; where something pushes.
    pub distance: Option<f64>,
    /// The error of the surface (m), the same way; where there is a surface.
    pub error: Option<f64>,
    /// What is left of it, or else of the distance, with the correction, if the model is true (m).
    pub after: Option<f64>,
}

/// A joint.
pub struct Joint {
    /// The unit of its coordinate for people, and how many of them a rad or a m is.
    pub unit: (&'static str, f64),
    /// Its limits (rad or m).
    pub limits: Option<[f64; 2]>,
    /// How fast it can move (rad/s or m/s), where it is known.
    pub fastest: Option<f64>,
}

/// What a joint does along a job; each with the index of its point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travel {
    /// From where to where (rad or m).
    pub range: [f64; 2],
    /// How near it comes to a limit (rad or m).
    pub margin: Option<(usize, f64)>,
    /// How fast it moves (rad/s or m/s), where the feed is known.
    pub speed: Option<(usize, f64)>,
}

/// How many places are named.
const MOST_PLACES: usize = 10;

/// A joint that is slower stands (rad/s or m/s): what it moves by is rounding.
const STANDS: f64 = 1e-9;

/// Places that are nearer to each other than this part of the job are one.
const APART: f64 = 0.01;

impl Job<'_> {
    /// Whether there is a surface whose error is known, and not the distance from the path alone.
    pub fn has_surface(&self) -> bool {
        self.points.iter().any(|point| point.error.is_some())
    }

    /// What colours the path and what a tolerance is compared with, point by point and without a correction (m).
    pub fn sizes(&self) -> impl Iterator<Item = Option<f64>> {
        let has_surface = self.has_surface();
        self.points.iter().map(move |point| if has_surface { point.error.map(f64::abs) } else { point.distance })
    }

    /// The same as the path is commanded.
    pub fn commanded(&self) -> Vec<Option<f64>> {
        match self.corrected {
            Some(_) => self.sizes().zip(&self.points).map(|(size, point)| size.and(point.after)).collect(),
            None => self.sizes().collect(),
        }
    }

    /// The worst places, each with its size (m), by their points; neighbours are one place.
    pub fn worst(&self) -> Vec<(usize, f64)> {
        let mut all: Vec<(usize, f64)> =
            self.sizes().enumerate().filter_map(|(i, size)| Some((i, size.filter(|size| *size > 0.0)?))).collect();
        all.sort_by(|(_, one), (_, other)| other.total_cmp(one));
        let apart = APART * self.length();
        let mut worst: Vec<(usize, f64)> = Vec::new();
        for (i, size) in all {
            let of = |i: usize| &self.points[i];
            let is_new =
                |&(known, _): &(usize, f64)| of(known).line != of(i).line && (of(known).s - of(i).s).abs() > apart;
            if worst.iter().all(is_new) {
                worst.push((i, size));
            }
            if worst.len() == MOST_PLACES {
                break;
            }
        }
        worst
    }

    /// The length of the path (m).
    pub fn length(&self) -> f64 {
        let [first, .., last] = &self.points[..] else { return 0.0 };
        last.s - first.s
    }

    /// How fast a joint moves on the way to a point (rad/s or m/s): between two points all joints move evenly.
    /// Rapids, and points without a feed, say nothing.
    pub fn speed(&self, i: usize, joint: usize) -> Option<f64> {
        let (before, point) = (self.points.get(i.checked_sub(1)?)?, &self.points[i]);
        let feed = point.feed.filter(|feed| *feed > 0.0 && !point.rapid)?;
        let time = (point.s - before.s).abs() / feed;
        let speed = (point.q[joint] - before.q[joint]).abs() / time;
        (time > 0.0).then_some(if speed < STANDS { 0.0 } else { speed })
    }

    /// What a joint does.
    pub fn travel(&self, joint: usize) -> Travel {
        let mut travel = Travel { range: [f64::INFINITY, f64::NEG_INFINITY], margin: None, speed: None };
        for (i, point) in self.points.iter().enumerate() {
            let q = point.q[joint];
            travel.range = [travel.range[0].min(q), travel.range[1].max(q)];
            if let Some([low, high]) = self.joints[joint].limits {
                let margin = (q - low).min(high - q);
                if travel.margin.is_none_or(|(_, least)| margin < least) {
                    travel.margin = Some((i, margin));
                }
            }
            if let Some(speed) = self.speed(i, joint)
                && travel.speed.is_none_or(|(_, most)| speed > most)
            {
                travel.speed = Some((i, speed));
            }
        }
        travel
    }
}
