//! `robstiff emit`: the generated code as a person would read it.

use std::path::{Path, PathBuf};

use quote::quote;
use robstiff_codegen::Origin;

use crate::failure::Failure;
use crate::output::{self, Files};
use crate::{input, json};

/// The generated Rust, formatted, as a person would read it
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue
    #[arg(value_name = "ROBOT.yaml")]
    robot: PathBuf,
    /// Write the code to FILE instead of printing it
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Write the code and what it was made from to FILE as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Generates the code.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (robot, file) = input::robot(&arguments.robot)?;
    let origin = Origin { file, runtime: quote!(::robstiff), visibility: quote!(pub) };
    let source = robstiff_codegen::source(&robot, &origin);
    if arguments.out.as_deref() == Some(Path::new("-")) {
        return Err(Failure::Usage("without `--out` the code goes to standard output; leave it out".to_owned()));
    }

    let mut files = Files::default();
    files.protect(&arguments.robot);
    if let Some(path) = &arguments.json {
        let document = serde_json::json!({ "robot": robot.name, "file": origin.file, "source": source });
        files.add(path, json::document(&document));
    }
    match &arguments.out {
        Some(path) => {
            files.add(path, source);
            output::print(files.write()?)
        }
        // Standard output is the code, and nothing but the code.
        None => {
            files.write()?;
            output::print(source)
        }
    }
}
