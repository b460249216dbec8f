//! The units that a quantity can be written in.

use std::f64::consts::PI;

use crate::dimension::Dimension;

/// A unit: `value * times / per` is the value in SI, or one over it for a
/// stiffness where compliances are meant. Both factors are exact where they
/// can be, so that `865 mm` is the double nearest to 0.865 m.
pub struct Unit {
    pub name: &'static str,
    pub dimension: Dimension,
    pub times: f64,
    pub per: f64,
    pub inverse: bool,
}

const fn unit(name: &'static str, dimension: Dimension, times: f64, per: f64) -> Unit {
    Unit { name, dimension, times, per, inverse: false }
}

const fn stiffness(name: &'static str, dimension: Dimension, times: f64, per: f64) -> Unit {
    Unit { name, dimension, times, per, inverse: true }
}

/// Every unit there is; the first of each dimension is SI.
#[rustfmt::skip]
pub const UNITS: &[Unit] = {
    use Dimension::*;
    &[
        unit("m", Length, 1.0, 1.0),
        unit("mm", Length, 1.0, 1e3),
        unit("um", Length, 1.0, 1e6),
        unit("rad", Angle, 1.0, 1.0),
        unit("mrad", Angle, 1.0, 1e3),
        unit("urad", Angle, 1.0, 1e6),
        unit("deg", Angle, PI, 180.0),
        unit("arcmin", Angle, PI, 10_800.0),
        unit("arcsec", Angle, PI, 648_000.0),
        unit("rad/Nm", Compliance, 1.0, 1.0),
        unit("mrad/Nm", Compliance, 1.0, 1e3),
        unit("urad/Nm", Compliance, 1.0, 1e6),
        unit("urad/kNm", Compliance, 1.0, 1e9),
        unit("arcmin/Nm", Compliance, PI, 10_800.0),
        stiffness("Nm/rad", Compliance, 1.0, 1.0),
        stiffness("kNm/rad", Compliance, 1e3, 1.0),
        stiffness("MNm/rad", Compliance, 1e6, 1.0),
        stiffness("Nm/deg", Compliance, 180.0, PI),
        stiffness("Nm/arcmin", Compliance, 10_800.0, PI),
        unit("m/N", LinearCompliance, 1.0, 1.0),
        unit("mm/N", LinearCompliance, 1.0, 1e3),
        unit("um/N", LinearCompliance, 1.0, 1e6),
        stiffness("N/m", LinearCompliance, 1.0, 1.0),
        stiffness("N/mm", LinearCompliance, 1e3, 1.0),
        stiffness("N/um", LinearCompliance, 1e6, 1.0),
        unit("kg", Mass, 1.0, 1.0),
        unit("N", Force, 1.0, 1.0),
        unit("kN", Force, 1e3, 1.0),
        unit("Nm", Torque, 1.0, 1.0),
        unit("kNm", Torque, 1e3, 1.0),
        unit("s", Time, 1.0, 1.0),
        unit("ms", Time, 1.0, 1e3),
        unit("min", Time, 60.0, 1.0),
        unit("h", Time, 3600.0, 1.0),
        unit("m/s", Speed, 1.0, 1.0),
        unit("m/min", Speed, 1.0, 60.0),
        unit("mm/s", Speed, 1.0, 1e3),
        unit("mm/min", Speed, 1.0, 6e4),
        unit("rad/s", RotationalSpeed, 1.0, 1.0),
        unit("mrad/s", RotationalSpeed, 1.0, 1e3),
        unit("deg/s", RotationalSpeed, PI, 180.0),
        unit("rpm", RotationalSpeed, PI, 30.0),
        unit("Hz", Frequency, 1.0, 1.0),
        unit("m/s/N", Mobility, 1.0, 1.0),
        unit("mm/s/N", Mobility, 1.0, 1e3),
        unit("m/s2/N", Accelerance, 1.0, 1.0),
        unit("mm/s2/N", Accelerance, 1.0, 1e3),
        unit("g/N", Accelerance, 9.80665, 1.0),
        unit("1/kg", Accelerance, 1.0, 1.0),
        unit("m/tooth", FeedPerTooth, 1.0, 1.0),
        unit("mm/tooth", FeedPerTooth, 1.0, 1e3),
        unit("mm", FeedPerTooth, 1.0, 1e3),
        unit("um", FeedPerTooth, 1.0, 1e6),
        unit("Pa", Pressure, 1.0, 1.0),
        unit("MPa", Pressure, 1e6, 1.0),
        unit("N/mm2", Pressure, 1e6, 1.0),
        unit("kN/mm2", Pressure, 1e9, 1.0),
        unit("N/m", LineForce, 1.0, 1.0),
        unit("N/mm", LineForce, 1e3, 1.0),
        unit("C", Temperature, 1.0, 1.0),
        unit("K", Temperature, 1.0, 1.0),
    ]
};
