//! A controller's view of robstiff: no standard library, no allocator.
#![no_std]

use robstiff::nalgebra::{SVector, Vector6};
use robstiff::{Robot, State};

robstiff::robot!("rv130hsc.yaml");
robstiff::robot!("../robots/every-law.yaml");

/// How far the tool gives way (m, rad) under a measured wrench (N, Nm), in
/// single precision as on a microcontroller.
pub fn deflection(q: [f32; 5], wrench: [f32; 6]) -> [f32; 6] {
    let deflection = Rv130hsc.deflection(&SVector::from(q), &Vector6::from(wrench));
    deflection.into()
}

/// The same of a robot that remembers its loads.
pub fn deflection_with(q: [f32; 7], wrench: [f32; 6], state: &mut State<7, f32>) -> [f32; 6] {
    let deflection = EveryLaw.deflection_with(&SVector::from(q), &Vector6::from(wrench), state);
    deflection.into()
}
