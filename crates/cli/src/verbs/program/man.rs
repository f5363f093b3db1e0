//! `arcade man`: manual pages for `man`.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::{paths, usage, whole_file};
use base::MessagePath;
use clap::Command;
use clap_mangen::Man;
use serde_json::json;
use std::path::PathBuf;

/// Prints the manual page of arcade, or writes a page for it and for each of its commands into a folder.
///
/// Example: arcade man --out ~/.local/share/man/man1
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Write arcade.1, arcade-release.1 and so on to this folder; existing pages with these names are replaced
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let pages = pages()?;
    let Some(out) = &args.out else {
        let (name, page) = &pages[0];
        console.document(&json!({ "name": name, "text": page }))?;
        console.file(page);
        return Ok(true);
    };
    std::fs::create_dir_all(out).map_err(|error| Failure::write(out, error))?;
    for (name, page) in &pages {
        whole_file::write(&out.join(name), page.as_bytes())?;
    }
    let names: Vec<&String> = pages.iter().map(|(name, _)| name).collect();
    console.document(&json!({ "out": paths::in_json(out), "files": names }))?;
    console.say(format_args!("{} pages in {}", pages.len(), out.in_message()));
    Ok(true)
}

/// Returns the manual pages with their file names, starting with the page for `arcade` itself.
fn pages() -> Result<Vec<(String, String)>, Failure> {
    let mut command = usage::command().disable_help_subcommand(true);
    command.build();
    let mut pages = Vec::new();
    add(&command, &mut pages)?;
    Ok(pages)
}

fn add(command: &Command, pages: &mut Vec<(String, String)>) -> Result<(), Failure> {
    // The name of a built subcommand is its whole path, such as `arcade-recipes-show`.
    let name = command.get_display_name().unwrap_or(command.get_name()).to_owned();
    let mut page = Vec::new();
    let man = Man::new(command.clone()).date("").manual("Infinite Arcade");
    man.render(&mut page).map_err(|error| Failure::environment(error, "the page cannot be written"))?;
    pages.push((format!("{name}.1"), String::from_utf8_lossy(&page).into_owned()));
    command.get_subcommands().try_for_each(|verb| add(verb, pages))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_verb_has_a_manual_page() {
        let pages = pages().expect("pages");
        assert_eq!(pages[0].0, "arcade.1");
        usage::tests::for_each_verb(&mut |path, verb| {
            let name = format!("{}.1", path.replace(' ', "-"));
            let page = pages.iter().find(|(known, _)| *known == name);
            let page = &page.unwrap_or_else(|| panic!("no {name}")).1;
            for flag in
                verb.get_arguments().filter(|flag| !flag.is_hide_set()).filter_map(clap::Arg::get_long)
            {
                assert!(page.contains(&format!("\\-\\-{}", flag.replace('-', "\\-"))), "{name} --{flag}");
            }
        });
    }
}
