//! The target `paths`.
#![no_main]

robstiff_fuzz::target!("paths");
