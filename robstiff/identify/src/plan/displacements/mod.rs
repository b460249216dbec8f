//! What displacements that are measured next show: the regression that tracing uses, as
//! planning asks for it.

mod adapter;
mod source;
#[cfg(test)]
mod tests;

pub use adapter::Adapter;
