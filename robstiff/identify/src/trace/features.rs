//! What a residual may depend on, as kernels: how alike two rows are.

use std::borrow::ToOwned;
use std::format;
use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use nalgebra::DMatrix;

use crate::campaign::Displacements;
use crate::identify::samples::Samples;

/// The name of a row's place in its visit.
pub const LOAD_ORDER: &str = "load order";

/// How alike rows are in one column of the table, in all joint angles, or in
/// being rows at all.
pub struct Feature {
    /// The column's name; empty where it is not a single column.
    pub name: String,
    /// One row a row of the table, standardised.
    coordinates: DMatrix<f64>,
    /// The scalar products of the forces of every two rows, over their mean square, where
    /// an elastic residual turns with the force.
    forces: Option<Rc<DMatrix<f64>>>,
}

impl Feature {
    /// How alike every two rows are: falls off over a standard deviation of
    /// the column. Of a single column the mean over all rows is taken out, so
    /// that what is common to all rows is not put down to every column. What
    /// depends on a joint angle is an elastic displacement, which changes sign
    /// with the force, so these kernels carry the forces' scalar product.
    pub fn kernel(&self) -> DMatrix<f64> {
        let (rows, columns) = self.coordinates.shape();
        let points = self.coordinates.transpose();
        let point = |i: usize| &points.as_slice()[i * columns..(i + 1) * columns];
        // For all joint angles together, per angle: otherwise no two poses
        // would be alike.
        let near = |i: usize, j: usize| {
            let square: f64 = point(i).iter().zip(point(j)).map(|(a, b)| (a - b) * (a - b)).sum();
            (-0.5 * square / columns.max(1) as f64).exp()
        };
        let mut kernel = DMatrix::zeros(rows, rows);
        for j in 0..rows {
            for i in 0..=j {
                let near = near(i, j);
                kernel[(i, j)] = near;
                kernel[(j, i)] = near;
            }
        }
        if !self.name.is_empty() {
            centre(&mut kernel);
        }
        if let Some(forces) = &self.forces {
            kernel.component_mul_assign(forces);
        }
        kernel
    }
}

/// Takes the means of rows and columns out of a symmetric matrix.
fn centre(kernel: &mut DMatrix<f64>) {
    let means = kernel.column_mean();
    let mean = means.mean();
    for j in 0..kernel.ncols() {
        for i in 0..kernel.nrows() {
            kernel[(i, j)] += mean - means[i] - means[j];
        }
    }
}

/// The features of some rows of a campaign; columns that do not vary have
/// none.
pub fn features(samples: &Samples, data: &Displacements, rows: &[usize]) -> Vec<Feature> {
    let column = |of: &dyn Fn(usize) -> f64| -> Vec<f64> { rows.iter().map(|&row| of(row)).collect() };
    let force = |row: usize| samples.rows[row].wrench.fixed_rows::<3>(0).into_owned();
    let size = column(&|row| force(row).norm());
    let mean_square = size.iter().map(|size| size * size).sum::<f64>() / rows.len() as f64;
    let scale = mean_square.sqrt().max(f64::MIN_POSITIVE);
    let forces = DMatrix::from_fn(rows.len(), 3, |i, k| force(rows[i])[k] / scale);
    let forces = Rc::new(&forces * forces.transpose());

    let mut found: Vec<Feature> = Vec::new();
    let mut angles: Vec<Vec<f64>> = Vec::new();
    let mut add = |name: String, values: Vec<f64>, forces: Option<&Rc<DMatrix<f64>>>| -> Option<Vec<f64>> {
        let values = standardised(values)?;
        let coordinates = DMatrix::from_column_slice(rows.len(), 1, &values);
        found.push(Feature { name, coordinates, forces: forces.cloned() });
        Some(values)
    };
    for joint in 0..samples.joints() {
        let values = column(&|row| samples.rows[row].q[joint]);
        angles.extend(add(format!("q{}", joint + 1), values, Some(&forces)));
    }
    for (k, name) in ["Fx", "Fy", "Fz"].into_iter().enumerate() {
        add(name.to_owned(), column(&|row| force(row)[k]), None);
    }
    add("|F|".to_owned(), size, Some(&forces));
    let known = |of: &dyn Fn(usize) -> Option<f64>| -> Option<Vec<f64>> { rows.iter().map(|&row| of(row)).collect() };
    if let Some(time) = known(&|row| data.rows[row].time) {
        add("time".to_owned(), time, None);
    }
    if let Some(temperature) = known(&|row| data.rows[row].temperature) {
        add("temperature".to_owned(), temperature, None);
    }
    add("row order".to_owned(), column(&|row| row as f64), None);
    let places = places_in_visit(samples);
    add(LOAD_ORDER.to_owned(), column(&|row| places[row]), Some(&forces));
    if !angles.is_empty() {
        let coordinates = DMatrix::from_fn(rows.len(), angles.len(), |i, k| angles[k][i]);
        found.push(Feature { name: String::new(), coordinates, forces: Some(forces) });
    }
    // What is common to all rows: a bias of the readings.
    found.push(Feature { name: String::new(), coordinates: DMatrix::zeros(rows.len(), 0), forces: None });
    found
}

/// How far each row is through its visit, from 0 to below 1: loading and unloading.
fn places_in_visit(samples: &Samples) -> Vec<f64> {
    let visits = samples.rows.iter().map(|row| row.visit).max().map_or(0, |last| last + 1);
    let (mut sizes, mut places) = (std::vec![0_usize; visits], Vec::new());
    for row in &samples.rows {
        places.push(sizes[row.visit]);
        sizes[row.visit] += 1;
    }
    let place = |(row, place): (usize, &usize)| *place as f64 / sizes[samples.rows[row].visit] as f64;
    places.iter().enumerate().map(place).collect()
}

/// Mean 0 and standard deviation 1; `None` where nothing varies.
fn standardised(values: Vec<f64>) -> Option<Vec<f64>> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
    let spread = variance.sqrt();
    (spread > 1e-9 * mean.abs().max(f64::MIN_POSITIVE)).then(|| values.iter().map(|v| (v - mean) / spread).collect())
}
