//! `arcade completions`: shell completion scripts for arcade's commands.

use crate::console::Console;
use crate::failure::Answer;
use crate::usage;
use clap_complete::Shell;
use serde_json::json;

/// Prints a completion script for a shell: bash, zsh, fish, elvish or powershell.
///
/// Example: arcade completions bash > ~/.local/share/bash-completion/completions/arcade
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The shell
    #[arg(value_name = "SHELL", value_enum)]
    shell: Shell,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let script = script(args.shell);
    console.document(&json!({ "shell": args.shell.to_string(), "script": script }))?;
    console.file(&script);
    Ok(true)
}

fn script(shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut usage::command(), "arcade", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::ValueEnum;

    #[test]
    fn scripts_name_every_verb_and_every_flag() {
        for &shell in Shell::value_variants() {
            let script = script(shell);
            usage::tests::for_each_verb(&mut |path, verb| {
                // clap_complete's scripts for fish support two levels of commands, such as `arcade trust
                // log`, but no deeper levels.
                if shell == Shell::Fish && path.split(' ').count() > 3 {
                    return;
                }
                assert!(script.contains(verb.get_name()), "{shell}: {path}");
                for flag in verb.get_arguments().filter_map(clap::Arg::get_long) {
                    assert!(script.contains(flag), "{shell}: {path} --{flag}");
                }
            });
        }
    }
}
