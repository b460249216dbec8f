//! The target `campaigns`.
#![no_main]

robstiff_fuzz::target!("campaigns");
