//! The target `urdf`.
#![no_main]

robstiff_fuzz::target!("urdf");
