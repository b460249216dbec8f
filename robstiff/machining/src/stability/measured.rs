//! The modes of the tool as a modal test finds them.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::Modes;

/// A mode of the tool on the arm, as measured in one pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredMode {
    /// The natural frequency (rad/s).
    pub frequency: f64,
    /// The damping ratio.
    pub damping: f64,
    /// The stiffness of this mode at the tool, along its direction (N/m).
    pub stiffness: f64,
    /// Where it moves the tool; the length does not count.
    pub direction: Vector3<f64>,
}

/// What gives way at once, without mass, along a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Its stiffness along the direction (N/m).
    pub stiffness: f64,
    /// Where it gives way; the length does not count.
    pub direction: Vector3<f64>,
}

impl Spring {
    /// Its compliance (m/N); not finite where the direction has no length.
    pub fn compliance(&self) -> Matrix3<f64> {
        let along = self.direction / self.direction.norm();
        along * along.transpose() / self.stiffness
    }
}

impl Modes {
    /// The modes of a modal test, in any order: each is a spring `k` with a mass `k / w^2` and a
    /// damper of its own, which moves the tool along a direction `d` (a unit vector). The shape
    /// of a mode is `w / sqrt(k) d`, and the compliance the sum of `d d^T / k`: what no mode has
    /// is rigid. Two modes may move the tool along the same direction.
    ///
    /// `None` where there is no mode, where a frequency, a stiffness or a damping ratio is not
    /// finite and above zero, and where a direction has no length.
    pub fn measured(modes: &[MeasuredMode]) -> Option<Self> {
        let is_real = |value: f64| value > 0.0 && value.is_finite();
        let mut ordered = modes.to_vec();
        ordered.sort_by(|one, other| one.frequency.total_cmp(&other.frequency));
        let (mut compliance, mut shapes) = (Matrix3::zeros(), Vec::with_capacity(ordered.len()));
        for MeasuredMode { frequency, damping, stiffness, direction } in &ordered {
            if ![*frequency, *damping, *stiffness].into_iter().all(is_real) {
                return None;
            }
            let direction = direction.try_normalize(0.0).filter(|unit| unit.iter().all(|part| part.is_finite()))?;
            compliance += direction * direction.transpose() / *stiffness;
            shapes.push(direction * (frequency / stiffness.sqrt()));
        }
        let finite = shapes
            .iter()
            .flat_map(|shape: &Vector3<f64>| shape.iter())
            .chain(compliance.iter())
            .all(|entry| entry.is_finite());
        (finite && !shapes.is_empty()).then(|| Self {
            compliance,
            frequencies: DVector::from_iterator(ordered.len(), ordered.iter().map(|mode| mode.frequency)),
            shapes: DMatrix::from_fn(3, ordered.len(), |row, mode| shapes[mode][row]),
            massless: Matrix3::zeros(),
            damping: DVector::from_iterator(ordered.len(), ordered.iter().map(|mode| mode.damping)),
        })
    }

    /// The same on springs without mass, which stand for the modes that are quicker. `None` where one has no
    /// stiffness above zero, or no direction.
    #[must_use]
    pub fn with_massless(mut self, springs: &[Spring]) -> Option<Self> {
        for spring in springs {
            let compliance = spring.compliance();
            if !(spring.stiffness > 0.0 && compliance.iter().all(|entry| entry.is_finite())) {
                return None;
            }
            self.compliance += compliance;
            self.massless += compliance;
        }
        Some(self)
    }
}
