//! The target `cuts`.
#![no_main]

robstiff_fuzz::target!("cuts");
