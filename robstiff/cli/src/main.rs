//! The command `robstiff`.
fn main() {}
