//! The target `tables`.
#![no_main]

robstiff_fuzz::target!("tables");
