//! `robstiff completions` and `robstiff man`: what shells and their manual know
//! of the command, made of the arguments that it reads.

use std::path::PathBuf;

use clap::Command;
use clap_complete::Shell;
use clap_mangen::Man;

use crate::failure::Failure;
use crate::output::{self, Files};

/// A script that completes the command's arguments, for a shell
///
/// For bash: `robstiff completions bash > ~/.local/share/bash-completion/completions/robstiff`.
#[derive(clap::Args)]
pub struct Completions {
    /// The shell
    shell: Shell,
}

/// The manual page of the command, or a folder of pages, one for each command
#[derive(clap::Args)]
pub struct Manual {
    /// Write a page for every command to DIR, as `robstiff.1`, `robstiff-show.1` ..
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Prints the script; standard output is the script, and nothing but the script.
pub fn completions(arguments: &Completions, mut command: Command) -> Result<(), Failure> {
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, name, &mut script);
    output::print(String::from_utf8_lossy(&script))
}

/// Prints the page, or writes all of them.
pub fn manual(arguments: &Manual, mut command: Command) -> Result<(), Failure> {
    // The commands learn their full names.
    command.build();
    let Some(folder) = &arguments.out else {
        return output::print(page(command)?);
    };
    let mut files = Files::default();
    let commands: Vec<Command> = command.get_subcommands().filter(|command| is_ours(command)).cloned().collect();
    for command in commands.into_iter().chain([command]) {
        let man = Man::new(command.clone());
        files.add(folder.join(man.get_filename()), page(command)?);
    }
    output::print(files.write()?)
}

/// Whether a command is one of the program, and not clap's command `help`.
fn is_ours(command: &Command) -> bool {
    command.get_name() != "help"
}

fn page(command: Command) -> Result<String, Failure> {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name()).to_owned();
    let mut page = Vec::new();
    Man::new(command)
        .render(&mut page)
        .map_err(|error| Failure::new(format_args!("cannot write the page of {name}: {error}")))?;
    Ok(String::from_utf8_lossy(&page).into_owned())
}
