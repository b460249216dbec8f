//! The loop on simulated arms: the simulator, which has none of the library's
//! formulas, puts an effect into a campaign that the description does not
//! declare, and tracing has to find it, or to say that it cannot.
//!
//! Everything goes through files, as with a user. The seeds were fixed before
//! any outcome was seen: 100.. where nothing is hidden, 200.. for one effect,
//! 300.. for faults outside the catalogue, 400.. for two effects, 500.. for
//! other plans of campaigns, 600.. for aliases, 700.. for what looks like
//! outliers. Traces err at a stated level, hence counts: three of four, not all.

mod aliases;
mod bench;
mod encoders;
mod nothing;
mod one_effect;
mod outliers;
mod outside;
mod plans;
mod preload;
mod two_effects;
