//! How far the tool gives way: ten lines to a deflection.
//!
//!     cargo run -p robstiff --example deflection

use robstiff::Robot;
use robstiff::nalgebra::{SVector, Vector6};

robstiff::robot!("rv130hsc.yaml");

fn main() {
    let q = SVector::from([0.3, -0.4, 0.5, 0.0, 1.2]); // rad
    let wrench = Vector6::new(0.0, 400.0, -200.0, 0.0, 0.0, 0.0); // N, Nm, in the base frame
    let displacement = Rv130hsc.deflection(&q, &wrench); // m, rad
    let [x, y, z] = [0, 1, 2].map(|axis| displacement[axis] * 1e6);
    println!("the tool moves by ({x:.1}, {y:.1}, {z:.1}) um");
}
