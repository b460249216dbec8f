//! What absolute positions that are read next show: the regression that tracing uses, as
//! planning asks for it.

mod adapter;
mod source;

pub use adapter::Adapter;
