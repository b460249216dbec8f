//! The target `descriptions`.
#![no_main]

robstiff_fuzz::target!("descriptions");
