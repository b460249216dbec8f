//! `robstiff schema`: the JSON Schemas of the files that people write.

use std::path::{Path, PathBuf};

use robstiff_identify::{campaign, simulate};
use robstiff_machining::{cell, map, milling, stability};
use robstiff_robots::schema;

use crate::failure::Failure;
use crate::json;
use crate::output::{self, Files};

/// The JSON Schema of a kind of file, with which an editor completes and checks it
#[derive(clap::Args)]
pub struct Arguments {
    /// The kind of file
    kind: Kind,
    /// Write the schema to FILE instead of printing it
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// The kinds of files that have a schema.
#[derive(Clone, Copy, clap::ValueEnum)]
enum Kind {
    /// A robot's description
    Robot,
    /// A campaign: what was measured
    Campaign,
    /// A scenario, to simulate a campaign
    Scenario,
    /// A cut: the force of a tool
    Cut,
    /// Measured modes of the tool on the arm
    Modes,
    /// What to map
    Map,
    /// A cell: robot, spindle, tools and workpiece
    Cell,
}

/// Prints the schema; standard output is the schema, and nothing but the schema.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let schema = json::document(&match arguments.kind {
        Kind::Robot => schema::robot(),
        Kind::Campaign => campaign::schema::schema(),
        Kind::Scenario => simulate::schema::schema(),
        Kind::Cut => milling::schema::schema(),
        Kind::Modes => stability::schema::schema(),
        Kind::Map => map::schema::schema(),
        Kind::Cell => cell::schema::schema(),
    });
    let Some(path) = arguments.out.as_deref() else {
        return output::print(schema);
    };
    if path == Path::new("-") {
        return Err(Failure::Usage("without `--out` the schema goes to standard output; leave it out".to_owned()));
    }
    let mut files = Files::default();
    files.add(path, schema);
    output::print(files.write()?)
}
