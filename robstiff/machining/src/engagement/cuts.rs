//! The force of what a cutter meets.

use nalgebra::Vector3;

use super::bite::{Bite, Sector};
use crate::milling::{Coefficients, Cut, Engagement};

impl Sector {
    /// The cut that its teeth are in, of a tool, material and feed. On a corner the normal force is partly axial
    /// and the edge longer than it is high (Lee and Altintas, Prediction of ball-end milling forces from
    /// orthogonal cutting data, 1996).
    pub fn cut(&self, of: &Cut) -> Cut {
        let (sine, cosine) = self.lead.sin_cos();
        let Coefficients { ktc, kte, krc, kre, kac, kae } = of.coefficients;
        // A left-handed helix turns the forces along the edge, and the model those along the axis.
        let hand = if of.mill.helix < 0.0 { -1.0 } else { 1.0 };
        let coefficients = Coefficients {
            ktc,
            kte: kte / sine,
            krc: krc * sine + hand * kac * cosine,
            kre: kre + hand * kae * cosine / sine,
            kac: kac * sine - hand * krc * cosine,
            kae: kae - hand * kre * cosine / sine,
        };
        Cut { coefficients, engagement: self.engagement, depth: self.depth, ..of.clone() }
    }

    /// The same after the tool has moved along the normal (m): walls beside the tool stay beside it. `None` where nothing
    /// remains.
    fn shifted(&self, by: f64) -> Option<Self> {
        let [at_entry, at_exit] = self.engagement.meets();
        let moved = |angle: f64| (angle.cos() - by / self.radius).clamp(-1.0, 1.0).acos();
        let Engagement { entry, exit } = self.engagement;
        let (entry, exit) = (if at_entry { entry } else { moved(entry) }, if at_exit { exit } else { moved(exit) });
        Engagement::between(entry, exit).map(|engagement| Self { engagement, ..*self })
    }
}

impl Bite {
    /// What a cut with an engagement and an axial depth (m) meets, of a tool with a diameter (m).
    pub fn of_engagement(engagement: Engagement, depth: f64, diameter: f64) -> Self {
        let (radius, lead) = (0.5 * diameter, core::f64::consts::FRAC_PI_2);
        let width = radius * (engagement.entry.cos() - engagement.exit.cos());
        Self { sectors: vec![Sector { engagement, depth, above: 0.0, radius, lead }], width, depth }
    }

    /// The mean force on the tool (N), along feed, normal and axis, of a tool, material and feed.
    pub fn mean_force(&self, of: &Cut) -> Vector3<f64> {
        self.sectors.iter().map(|sector| sector.cut(of).mean_force()).sum()
    }

    /// The forces (N) at so many angles of a revolution, and beside those at which an arc begins or ends.
    pub fn extremes(&self, of: &Cut, count: usize) -> Vec<Vector3<f64>> {
        // What is higher up lags behind.
        let lag = |sector: &Sector| 2.0 * of.mill.helix.tan() / of.mill.diameter * sector.above;
        let cuts: Vec<(Cut, f64)> = self.sectors.iter().map(|sector| (sector.cut(of), lag(sector))).collect();
        let angles = cuts.iter().flat_map(|(cut, lag)| {
            let samples = cut.extremes(count).samples;
            samples.into_iter().map(move |(angle, _)| angle + lag).collect::<Vec<_>>()
        });
        angles.map(|angle| cuts.iter().map(|(cut, lag)| cut.force_at(angle - lag)).sum()).collect()
    }

    /// What displacements along feed, normal and axis (m) add to the mean force along these (N/m, columns), by
    /// central differences over so much (m).
    pub fn response(&self, of: &Cut, step: f64) -> [Vector3<f64>; 3] {
        let force = |sectors: &mut dyn Iterator<Item = Sector>| -> Vector3<f64> {
            sectors.map(|sector| sector.cut(of).mean_force()).sum()
        };
        let aside = |by: f64| force(&mut self.sectors.iter().filter_map(|sector| sector.shifted(by)));
        let highest = self.sectors.iter().map(|sector| sector.above).fold(0.0, f64::max);
        let deeper = |by: f64| {
            force(&mut self.sectors.iter().map(|sector| {
                // The tool goes deeper, and more of it is met at the top.
                let more = if sector.above == highest { by } else { 0.0 };
                Sector { depth: sector.depth + more, ..*sector }
            }))
        };
        let slope = |at: &dyn Fn(f64) -> Vector3<f64>| (at(step) - at(-step)) / (2.0 * step);
        [Vector3::zeros(), slope(&aside), slope(&deeper)]
    }

    /// Where walls are beside the tool: 1 at +normal, -1 at -normal; `None` where there are both or none.
    pub fn wall(&self) -> Option<f64> {
        let meets = self.sectors.iter().map(|sector| sector.engagement.meets());
        match meets.fold([false; 2], |all, one| [all[0] || one[0], all[1] || one[1]]) {
            [true, false] => Some(1.0),
            [false, true] => Some(-1.0),
            _ => None,
        }
    }
}
