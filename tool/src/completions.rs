//! `sun2xp completions`: the script with which a shell completes the commands and options of the tool.

use crate::failure::Failure;
use clap::Command;
use clap_complete::{Shell, generate};
use std::io::{self, Write};

/// Prints the script with which a shell completes commands, options and files.
///
/// bash: sun2xp completions bash > ~/.local/share/bash-completion/completions/sun2xp
///
/// zsh: sun2xp completions zsh > DIR/_sun2xp, where DIR is a folder of $fpath
///
/// fish: sun2xp completions fish > ~/.config/fish/completions/sun2xp.fish
#[derive(clap::Args)]
pub struct Arguments {
    /// The shell.
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

pub fn run(arguments: &Arguments, mut command: Command) -> Result<(), Failure> {
    let name = command.get_name().to_owned();
    // The generator panics if its output cannot be written, for example because the reader has ended.
    let mut script = Vec::new();
    generate(arguments.shell, &mut command, name, &mut script);
    Ok(io::stdout().write_all(&script)?)
}
