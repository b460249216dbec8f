//! What a compliance matrix leaves out at large loads: the arm has moved when
//! it carries the load, so levers and directions are those of the moved arm.
//!
//! At 800 N this is some 0.1-0.2 % of the displacement, a few micrometres: too
//! little to model, enough to look like noise in a good campaign. Readings are
//! therefore asked for their noise without the part due to the joints, which
//! carry most of the compliance, and without what declared laws of joints do.

use nalgebra::{Vector3, Vector6};
use robstiff_robots::{Description, Joint};

use super::samples::Samples;
use crate::campaign::Displacements;
use crate::model::described::declared;
use crate::model::{Parameter, Term};
use crate::observe::Observation;
use crate::observe::displacement::Displacement;
use crate::probability::median;

/// Compliances that make displacements so many times as large as they are, or more, are not
/// of the right size: forces in kilograms, or stiffness per arcmin, make them so.
const TOO_LARGE: f64 = 2.0;

/// The rows of a campaign on a robot with the second order, and what declared laws of joints do,
/// taken from their readings, so that these are linear in the load as far as the
/// description accounts for them. Where its compliances are [too large](TOO_LARGE), the second order is that
/// of such as are not.
pub fn straightened(description: &Description, data: &Displacements) -> Samples {
    let observation = Displacement::new(description, data);
    let samples = Samples::of(&observation, description, data);
    let compliance: Vec<f64> = description.joints.iter().map(Joint::compliance).collect();
    let size = size(&samples, &compliance);
    let share = if size * TOO_LARGE < 1.0 { size } else { 1.0 };
    let own = declared(description);
    let of = |is_one: &dyn Fn(&Term) -> bool, share: f64| -> (Vec<Parameter>, Vec<f64>) {
        let own = own.iter().filter(|own| is_one(&own.parameter.term));
        own.map(|own| (own.parameter.clone(), share * own.parameter.mean)).unzip()
    };
    let (laws, values) = of(&|term| matches!(term, Term::Law(..)), 1.0);
    let (springs, compliances) = of(&|term| matches!(term, Term::Spring(_)), share);
    let world = observation.world();
    let beyond = observation.yielded(world, &laws, &values) + observation.second_order(world, &springs, &compliances);
    samples.less(&observation, &beyond)
}

/// The linear displacement of the marker by joints of such compliances (m).
fn linear(samples: &Samples, row: usize, compliance: &[f64]) -> Vector3<f64> {
    let (twists, sample) = (samples.twists(row), &samples.rows[row]);
    let twist: Vector6<f64> = twists.iter().zip(compliance).map(|(s, h)| s * (h * s.dot(&sample.wrench))).sum();
    sample.read(&twist).fixed_rows::<3>(0).into_owned()
}

/// How many times as large displacements are as joints of such compliances make them: the
/// median of the rows, which an outlying one does not move; 0 where they go the other way.
fn size(samples: &Samples, compliance: &[f64]) -> f64 {
    let of_row = |row: usize| {
        let moved = linear(samples, row, compliance);
        let length = moved.norm();
        (length > 0.0).then(|| samples.rows[row].displacement.dot(&(moved / length)) / length)
    };
    let sizes: Vec<f64> = (0..samples.rows.len()).filter_map(of_row).collect();
    if sizes.is_empty() { 1.0 } else { median(sizes).max(0.0) }
}
