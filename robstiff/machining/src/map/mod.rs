//! Maps: how far the tool gives way, or how stiff it is, all over a space.
//!
//! A [`Space`] is a grid of cells: joint coordinates ([`JointSpace`]), or positions of
//! the tool centre point (TCP), where inverse kinematics finds the joint coordinates
//! ([`CartesianSpace`]). At each cell a [`Measure`] is computed: the deviation under a force, or the stiffness
//! in the weakest direction. [`stream`] does it in chunks, on all cores with the
//! feature `rayon`, and hands them over in order, so that a map of any size
//! needs little memory:
//!
//! ```
//! use robstiff_machining::map::{Axis, JointSpace, Measure, stream};
//! use robstiff::nalgebra::Vector6;
//!
//! robstiff::robot!("rv130hsc.yaml");
//!
//! let degrees = |name: &str, from: f64, to: f64, count| Axis::angles(name, from.to_radians(), to.to_radians(), count);
//! let axes = [
//!     degrees("q1", -90.0, 90.0, 50), degrees("q2", -60.0, 0.0, 40), degrees("q3", 0.0, 60.0, 30),
//!     degrees("q4", 0.0, 0.0, 1), degrees("q5", 60.0, 60.0, 1),
//! ];
//! let mut tables = Vec::new();
//! let space = JointSpace::new(&axes, &mut tables);
//! let measure = Measure::Deviation(Vector6::new(0.0, 400.0, -200.0, 0.0, 0.0, 0.0));
//! let mut cells = 0;
//! let summary = stream(&Rv130hsc, &space, &measure, |chunk| chunk.cells.len(), |count| {
//!     cells += count;
//!     Ok::<(), ()>(())
//! });
//! assert_eq!(cells, 60_000);
//! let worst = summary.unwrap().worst.unwrap();
//! assert!(worst.values[0] > 100e-6 && worst.cell < cells);
//! ```

mod axis;
mod cartesian;
mod chunk;
mod evaluate;
mod largest;
mod measure;
mod place;
pub mod read;
#[cfg(feature = "schema")]
pub mod schema;
mod space;
mod stream;
mod summary;
#[cfg(test)]
mod tests;

pub use axis::{Axis, people};
pub use cartesian::{CartesianSpace, Tool};
pub use chunk::{CHUNK, Chunk};
pub use evaluate::{Evaluate, Poses};
pub use measure::{Column, Measure};
pub use place::{WorkpiecePlace, best_placement};
pub use space::{JointSpace, Space};
pub use stream::{Survey, stream};
pub use summary::{Extreme, Summary};
