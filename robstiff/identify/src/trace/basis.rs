//! Where a trace ended: what planning goes on from.

use crate::effects::Shapes;
use crate::regression::Scales;
use crate::regression::noise::Noise;
use crate::select::engine::{Engine, Point};
use crate::select::passes::Found;

/// The best set at its optimum, and the noise that it leaves.
#[derive(Clone, Debug)]
pub struct Basis {
    /// The linearisation point.
    pub point: Point,
    /// The shapes that were looked at beside the grids.
    shapes: Shapes,
    /// The likely compliance of each joint (rad/Nm or m/N).
    compliance: Vec<f64>,
    /// The noise of the rows.
    noise: Noise,
    /// The discrepancy, by its index.
    pub kappa: usize,
    /// The variance of one reading, and the scales of learned priors.
    start: (f64, Scales),
    /// The forms of the best set: the full name of each candidate, and the name of its form.
    pub best: Vec<(String, String)>,
}

impl Basis {
    /// Of what was found.
    pub fn of(engine: &Engine<'_>, found: &Found) -> Self {
        Self {
            point: found.own.point.clone(),
            shapes: engine.scene.shapes.clone(),
            compliance: engine.scene.compliance.clone(),
            noise: engine.noise.clone(),
            kappa: found.own.kappa,
            start: (found.own.fit.variance, found.own.fit.scales.clone()),
            best: found.best.iter().map(|&form| found.layout.names(form)).collect(),
        }
    }

    /// Takes a campaign as declared to where its trace ended. False if it has other rows.
    pub fn resume(&self, engine: &mut Engine<'_>) -> bool {
        if self.noise.weights.len() != engine.observation.readings().rows() {
            return false;
        }
        engine.scene.shapes = self.shapes.clone();
        engine.scene.compliance.clone_from(&self.compliance);
        engine.scene.learn_middle();
        engine.point = self.point.clone();
        engine.noise = self.noise.clone();
        engine.start = self.start.clone();
        true
    }
}
