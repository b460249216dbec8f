//! A crate that uses `robot!`, as far as it gets.
