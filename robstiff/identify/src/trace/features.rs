//! What the residuals depend on, by simple quantities of each row.

use nalgebra::DVector;
use robstiff::JointKind;

use crate::fit::case::Case;

/// A dependence with a larger probability by chance is none, all quantities counted.
const LEVEL: f64 = 0.01;

/// So many are reported at most.
const MOST: usize = 4;

/// The names of the quantities that the residual depends on, the strongest first: a correlation of a
/// component, or of its size, with it that chance hardly has.
pub fn depends_on(case: &Case<'_>, left: &DVector<f64>) -> Vec<String> {
    let readings = case.observation.readings();
    let rows = case.rows(true);
    let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
    let kinds = case.scene.kinds.clone();
    let names: Vec<String> = kinds.iter().enumerate().map(|(i, _)| format!("q{}", i + 1)).collect();
    let mut angles: Vec<Vec<f64>> = vec![Vec::new(); kinds.len()];
    let (mut time, mut warmer) = (Vec::new(), Vec::new());
    case.observation.each(&mut |at| {
        at.q.iter().zip(&mut angles).for_each(|(q, of)| of.push(*q));
        time.push(at.time);
        warmer.push(at.warmer);
    });
    for (name, (of, kind)) in names.into_iter().zip(angles.into_iter().zip(&kinds)) {
        if *kind == JointKind::Revolute {
            columns.push((name.clone(), of.iter().map(|q| q.sin()).collect()));
            columns.push((name, of.iter().map(|q| q.cos()).collect()));
        } else {
            columns.push((name, of));
        }
    }
    columns.push(("time".into(), time));
    columns.push(("temperature".into(), warmer));
    for (k, name) in ["Fx", "Fy", "Fz"].into_iter().enumerate() {
        columns.push((name.into(), readings.force.iter().map(|force| force[k]).collect()));
    }
    let reported: Vec<Vec<f64>> =
        (0..readings.reported).map(|k| rows.iter().map(|row| left[row * readings.width + k]).collect()).collect();
    let size: Vec<f64> = rows.iter().map(|&row| readings.square(left, row).sqrt()).collect();
    let tests = columns.len() * (reported.len() + 1);
    let mut found: Vec<(f64, String)> = Vec::new();
    for (name, column) in columns {
        let column: Vec<f64> = rows.iter().map(|&row| column[row]).collect();
        let strongest = reported.iter().chain([&size]).map(|of| correlation(of, &column).abs()).fold(0.0, f64::max);
        // Fisher: artanh(r) has a standard deviation of 1 / sqrt(n - 3).
        let z = strongest.min(1.0 - 1e-12).atanh() * (rows.len().saturating_sub(3) as f64).sqrt();
        let by_chance = tests as f64 * statrs::function::erf::erfc(z / core::f64::consts::SQRT_2);
        if by_chance < LEVEL && found.iter().all(|(_, known)| *known != name) {
            found.push((z, name));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().take(MOST).map(|(_, name)| name).collect()
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len().max(1) as f64;
    let (of_a, of_b) = (mean(a), mean(b));
    let sum = |f: &dyn Fn(f64, f64) -> f64| a.iter().zip(b).map(|(a, b)| f(a - of_a, b - of_b)).sum::<f64>();
    let both = sum(&|a, b| a * b);
    let size = (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt();
    if size > 0.0 { both / size } else { 0.0 }
}
