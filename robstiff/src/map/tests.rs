use std::vec::Vec;

use nalgebra::{SVector, Vector6};

use super::{Axis, JointSpace, Measure, Space, stream};
use crate::analysis::principal_directions;
use crate::robots::{Description, catalogue};
use crate::{Generic, Robot};

crate::robot!("rv130hsc.yaml");

fn description(file: &str) -> Description {
    Description::parse(file, catalogue::find(file).unwrap()).unwrap()
}

fn axes() -> [Axis; 5] {
    // More than a chunk, and no multiple of it.
    [
        Axis::angles("q1", -1.0, 2.0, 41),
        Axis::angles("q2", -0.9, 0.1, 37),
        Axis::angles("q3", 0.1, 0.8, 29),
        Axis::angles("q4", 0.3, 0.3, 1),
        Axis::angles("q5", 0.9, 1.3, 2),
    ]
}

fn all<const N: usize>(robot: &(impl Robot<N> + Sync), space: &impl Space<N>, measure: &Measure) -> Vec<Vec<f64>> {
    let mut columns = std::vec![Vec::new(); measure.columns().len()];
    let summary = stream(
        robot,
        space,
        measure,
        |chunk| chunk.clone(),
        |chunk| {
            assert_eq!(chunk.cells.start, columns[0].len());
            for (all, column) in columns.iter_mut().zip(chunk.columns) {
                all.extend(column);
            }
            Ok::<(), ()>(())
        },
    );
    let (summary, figures) = (summary.unwrap(), &columns[0]);
    assert_eq!((summary.cells, summary.unreachable), (space.cells(), 0));
    let (low, high) = figures.iter().fold((f64::MAX, 0.0_f64), |(low, high), &x| (low.min(x), high.max(x)));
    let (best, worst) = (summary.best.unwrap(), summary.worst.unwrap());
    assert_eq!([best.values[0], worst.values[0]], if measure.worse_is_larger() { [low, high] } else { [high, low] });
    assert_eq!([figures[best.cell], figures[worst.cell]], [best.values[0], worst.values[0]]);
    let mean = figures.iter().sum::<f64>() / figures.len() as f64;
    assert!((summary.mean - mean).abs() < 1e-12 * mean);
    columns
}

#[test]
fn cells_are_what_the_reference_says_there() {
    let generic = Generic::<5>::new(&description("rv130hsc.yaml")).unwrap();
    let (axes, mut tables) = (axes(), Vec::new());
    let space = JointSpace::new(&axes, &mut tables);
    let wrench = Vector6::new(300.0, -500.0, 700.0, 4.0, -6.0, 8.0);
    let deviation = all(&Rv130hsc, &space, &Measure::Deviation(wrench));
    let any = all(&Rv130hsc, &space, &Measure::AnyDirection(500.0));
    let compliance = all(&Rv130hsc, &space, &Measure::Compliance);
    for cell in (0..space.cells()).step_by(997) {
        let indices = space.indices(cell);
        let q = SVector::<f64, 5>::from_fn(|joint, _| axes[joint].values[indices[joint]]);
        let d = generic.deflection(&q, &wrench);
        let close = |one: f64, other: f64, size: f64| assert!((one - other).abs() < 1e-12 * size, "{one} {other}");
        close(deviation[0][cell], d.fixed_rows::<3>(0).norm(), d.norm());
        close(deviation[3][cell], d[2], d.norm());
        let h = generic.compliance(&q);
        let principal = principal_directions(&h).unwrap();
        close(any[0][cell], 500.0 * principal.compliances[0], any[0][cell]);
        close(compliance[0][cell] * principal.compliances[0], 1.0, 1.0);
        let weak = SVector::<f64, 3>::new(any[1][cell], any[2][cell], any[3][cell]);
        let along = weak.dot(&(h.fixed_view::<3, 3>(0, 0) * weak));
        close(along, principal.compliances[0], along);
        close(compliance[4 + 3][cell], h[(0, 3)], h.amax());
        close(compliance[4 + 20][cell], h[(5, 5)], h.amax());
    }
}

#[test]
fn ends_of_axes_are_met() {
    let axis = Axis::angles("q1", -0.1, 0.7, 29);
    assert_eq!((axis.values[0], axis.values[28], axis.values.len()), (-0.1, 0.7, 29));
    assert_eq!(Axis::lengths("x", 0.3, 0.9, 1).values, [0.3]);
    assert_eq!(Axis::lengths("x", 0.0, 0.3, 4).for_people(1), 100.0);
}
