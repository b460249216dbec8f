//! A controller's view of robstiff: no standard library, no allocator.
#![no_std]

use robstiff::Robot;
use robstiff::nalgebra::{SVector, Vector6};

robstiff::robot!("rv130hsc.yaml");

/// How far the tool gives way (m, rad) under a measured wrench (N, Nm), in
/// single precision as on a microcontroller.
pub fn deflection(q: [f32; 5], wrench: [f32; 6]) -> [f32; 6] {
    let deflection = Rv130hsc.deflection(&SVector::from(q), &Vector6::from(wrench));
    deflection.into()
}
