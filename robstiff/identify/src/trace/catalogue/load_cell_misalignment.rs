//! The load cell is turned against the frame that the file names: the force is
//! `R(theta) f`, the turn being constant in the base frame or in the tool's.
//!
//! Where all loads are along one line, as hung weights are, a turn about it changes
//! nothing: what such loads show of a turn are two of its components.

use std::format;
use std::vec;

use nalgebra::{Matrix3, Vector3};

use super::{Form, Kind, Number, Offers, Place, Scene, TURN, WRENCH_STEP, frame_words};

/// The kind.
pub static KIND: Kind = Kind {
    name: "load_cell_misalignment",
    of_rig: true,
    words: |found| {
        let shown = found.parameters.iter().filter(|number| TURN.contains(&number.name)).count();
        let across = if shown < TURN.len() { " across the line of the loads" } else { "" };
        format!("a turn of the load cell{across}, constant in the {}", frame_words(found))
    },
    explanation: "The load cell is mounted at another angle than the file says, its frame is named wrongly, or weights \
        hang on a base that is not level. Pull along a known line, a plumb line for one, and compare; forces and moments \
        in the file turned by this rotation vector are what acts.",
    offer,
    on_axes: None,
};

/// Beyond this the frame is another one (rad).
const MOST: f64 = 0.35;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let number = |k: usize| {
        Number::of_setup(
            TURN[k % 3],
            "rad",
            MOST,
            move |setup, turn| {
                let cell = if k < 3 { &mut setup.in_base } else { &mut setup.in_tool };
                cell.turn[k % 3] += turn;
            },
            |point, enters| point.of_wrench(&**enters, WRENCH_STEP),
        )
    };
    let mut forms = vec![Form::of(0..3), Form::of(3..6).in_tool()];
    let but = |axis: usize, first: usize| (first..first + 3).filter(move |&k| k != first + axis);
    if let Some(axis) = line(scene, |_| Matrix3::identity()) {
        // Where the tool only turns about that line, as a SCARA's does under weights, a turn
        // that goes with the tool would be a lever arm's double.
        forms.push(Form::of(but(axis, 0)));
    } else if let Some(axis) = line(scene, Matrix3::transpose) {
        forms.push(Form::of(but(axis, 3)).in_tool());
    }
    offers.add(Place::Rig, (0..6).map(number).collect(), forms);
}

/// Loads are along one line where what is across it is less than this share of them: a turn
/// about it is then known to some tenths of a radian at best.
const ALONG: f64 = 0.1;

/// The axis nearest to the line that all loads are along in a frame, which `to` brings them
/// to by the tool's turn; none where they are along several. A turn about the line being
/// nothing, the components about the two other axes say any other.
fn line(scene: &Scene<'_>, to: impl Fn(&Matrix3<f64>) -> Matrix3<f64>) -> Option<usize> {
    let at = Vector3::from(scene.data.wrench_at);
    let spread = |(row, tool): (&crate::identify::samples::Sample, Matrix3<f64>)| {
        let force = row.wrench.fixed_rows::<3>(0).into_owned();
        let moment = row.wrench.fixed_rows::<3>(3) - (tool * at).cross(&force);
        // A moment counts as its force at a lever of a metre.
        let [force, moment] = [force, moment].map(|load| to(&tool) * load);
        force * force.transpose() + moment * moment.transpose()
    };
    let spread: Matrix3<f64> = scene.samples.rows.iter().zip(scene.tools()).map(spread).sum();
    let parts = spread.symmetric_eigen();
    let along = parts.eigenvalues.imax();
    let across = parts.eigenvalues.sum() - parts.eigenvalues[along];
    (across < ALONG * ALONG * spread.trace()).then(|| parts.eigenvectors.column(along).iamax())
}
