//! From a robot description over symbolic expressions to unrolled Rust code.
