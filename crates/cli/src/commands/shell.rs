//! `completions` and `man`: what a shell and `man` need to know about the command line, made from its definition.

use crate::args::Cli;
use crate::args::shell::{CompletionsArgs, ManArgs};
use crate::commands::print_text;
use crate::error::CliError;
use crate::files::Staging;
use clap::CommandFactory;

/// The name under which shells know the program.
const PROGRAM: &str = "tigereye";

/// Prints the completion script of a shell to standard output.
pub(crate) fn completions(args: &CompletionsArgs) -> Result<u8, CliError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), PROGRAM, &mut script);
    print_text(&String::from_utf8_lossy(&script))?;
    Ok(0)
}

/// Writes one manual page per command into a folder.
pub(crate) fn man(args: &ManArgs) -> Result<u8, CliError> {
    let mut staging = Staging::new(&args.out)?;
    let mut program = Cli::command().disable_help_subcommand(true);
    program.build();
    add_pages(&program, &mut staging)?;
    let pages = staging.len();
    staging.finish()?;
    println!("{}: {pages} manual pages; `man -l {0}/tigereye.1` shows the first", args.out.display());
    Ok(0)
}

/// The page of a command and those of the commands inside it, named by clap: `tigereye-field-show.1`.
fn add_pages(command: &clap::Command, staging: &mut Staging) -> Result<(), CliError> {
    let page = clap_mangen::Man::new(command.clone());
    let name = page.get_filename();
    let mut bytes = Vec::new();
    page.render(&mut bytes).map_err(|source| CliError::File {
        path: name.clone(),
        action: "writing",
        source,
    })?;
    staging.add(&name, &bytes)?;
    command.get_subcommands().try_for_each(|inner| add_pages(inner, staging))
}
