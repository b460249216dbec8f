//! The command `robstiff`: what a robot's description says about its
//! stiffness, and what measurements say about the description.

/// Evaluates an expression with the arm of a description, as [`robstiff::with_robot!`] does: it is compiled for each
/// number of joints. What is built for the unit tests has arms of five and six joints only, for else all would be
/// compiled twice.
macro_rules! with_arm {
    ($description:expr, |$robot:ident| $body:expr) => {{
        #[cfg(not(test))]
        let value = robstiff::with_robot!($description, |$robot| $body);
        #[cfg(test)]
        let value = robstiff::with_robot!($description, |$robot| $body, 5 6);
        value
    }};
}

mod agreement;
mod correct;
mod effect;
mod emit;
mod export;
mod failure;
mod forces;
mod identify;
mod import;
mod input;
mod json;
mod map;
mod modes;
mod online;
mod output;
mod path;
mod plan;
mod predict;
mod report;
mod scene;
mod schema;
mod shell;
mod show;
mod simulate;
mod stability;
mod start;
mod text;
mod trace;

use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

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
    Start(start::Arguments),
    Show(show::Arguments),
    Identify(identify::Arguments),
    Trace(trace::Arguments),
    Predict(predict::Arguments),
    Emit(emit::Arguments),
    Plan(plan::Arguments),
    Simulate(simulate::Arguments),
    Forces(forces::Arguments),
    Stability(stability::Arguments),
    Path(Box<path::Arguments>),
    Correct(Box<correct::Arguments>),
    Import(import::Arguments),
    Export(export::Arguments),
    View(scene::Arguments),
    Map(map::Arguments),
    Online(Box<online::Arguments>),
    Schema(schema::Arguments),
    Completions(shell::Completions),
    Man(shell::Manual),
}

impl Command {
    fn run(&self) -> Result<(), Failure> {
        match self {
            Self::Start(arguments) => start::run(arguments),
            Self::Show(arguments) => show::run(arguments),
            Self::Identify(arguments) => identify::run(arguments),
            Self::Trace(arguments) => trace::run(arguments),
            Self::Predict(arguments) => predict::run(arguments),
            Self::Emit(arguments) => emit::run(arguments),
            Self::Plan(arguments) => plan::run(arguments),
            Self::Simulate(arguments) => simulate::run(arguments),
            Self::Forces(arguments) => forces::run(arguments),
            Self::Stability(arguments) => stability::run(arguments),
            Self::Path(arguments) => path::run(arguments),
            Self::Correct(arguments) => correct::run(arguments),
            Self::Import(arguments) => import::run(arguments),
            Self::Export(arguments) => export::run(arguments),
            Self::View(arguments) => scene::run(arguments),
            Self::Map(arguments) => map::run(arguments),
            Self::Online(arguments) => online::run(arguments),
            Self::Schema(arguments) => schema::run(arguments),
            Self::Completions(arguments) => shell::completions(arguments, Arguments::command()),
            Self::Man(arguments) => shell::manual(arguments, Arguments::command()),
        }
    }
}

/// 0 on success, 1 on a failure that was explained, 2 on wrong usage, which
/// clap also answers with.
fn main() -> ExitCode {
    let arguments = Arguments::parse();
    output::goes_when_interrupted();
    match arguments.command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            output::complain(&failure);
            failure.code()
        }
    }
}
