//! The target `maps`.
#![no_main]

robstiff_fuzz::target!("maps");
