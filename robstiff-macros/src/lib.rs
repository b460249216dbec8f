//! The procedural macro `robot!`.
