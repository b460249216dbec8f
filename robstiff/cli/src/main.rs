//! The command `robstiff`: what a robot's description says about its
//! stiffness, and what measurements say about the description.

mod effect;
mod emit;
mod failure;
mod identify;
mod input;
mod json;
mod map;
mod output;
mod plan;
mod predict;
mod report;
mod show;
mod simulate;
mod text;
mod trace;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use failure::Failure;

/// Elastostatics of robot arms: stiffness from a description, and the measurements that keep it honest
#[derive(Parser)]
#[command(name = "robstiff", version, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Show(show::Arguments),
    Identify(identify::Arguments),
    Trace(trace::Arguments),
    Predict(predict::Arguments),
    Emit(emit::Arguments),
    Plan(plan::Arguments),
    Simulate(simulate::Arguments),
    Map(map::Arguments),
}

impl Command {
    fn run(&self) -> Result<(), Failure> {
        match self {
            Self::Show(arguments) => show::run(arguments),
            Self::Identify(arguments) => identify::run(arguments),
            Self::Trace(arguments) => trace::run(arguments),
            Self::Predict(arguments) => predict::run(arguments),
            Self::Emit(arguments) => emit::run(arguments),
            Self::Plan(arguments) => plan::run(arguments),
            Self::Simulate(arguments) => simulate::run(arguments),
            Self::Map(arguments) => map::run(arguments),
        }
    }
}

/// 0 on success, 1 on a failure that was explained, 2 on wrong usage, which
/// clap also answers with.
fn main() -> ExitCode {
    match Arguments::parse().command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            output::complain(&failure);
            failure.code()
        }
    }
}
