//! The book page with the help of every command, generated from the command-line parser. This module also
//! checks the commands on all other pages.

use crate::usage::tests::for_each_verb;
use clap::Command;
use std::fmt::Write;
use std::fs;
use std::path::Path;

const PAGE: &str = "docs/reference/commands.md";

/// The width of the help on the page, in columns.
const COLUMNS: usize = 100;

const HEAD: &str = "# All commands and flags

This page is the short help of every command. `arcade COMMAND --help` prints more, with examples. Every command also takes `--json`, `-q`, `--jobs`
and `--memory` ([the command line](command-line.md)).

A test compares this page with the program. `BLESS=1 cargo test -p infinite-arcade command_page` regenerates it.
";

/// Returns the page with the help of every command.
fn page() -> String {
    let mut text = HEAD.to_owned();
    for_each_verb(&mut |path, verb| {
        if path == "arcade" {
            return;
        }
        // Flags accepted by every command are listed once, at the head of the page.
        let own = verb.clone().term_width(COLUMNS).mut_args(|argument| {
            let is_shared =
                argument.is_global_set() || ["help", "version"].contains(&argument.get_id().as_str());
            argument.hide(is_shared)
        });
        let help = own
            .disable_help_flag(true)
            .disable_version_flag(true)
            .disable_help_subcommand(true)
            .render_help()
            .to_string();
        let help: Vec<&str> = help.lines().map(str::trim_end).collect();
        let level = if path.matches(' ').count() == 1 { "##" } else { "###" };
        let _ = write!(text, "\n{level} `{path}`\n\n```text\n{}\n```\n", help.join("\n").trim_end());
    });
    text
}

#[test]
fn the_page_has_the_help_of_every_command() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(PAGE);
    let page = page();
    if std::env::var_os("BLESS").is_some() {
        fs::write(&file, &page).expect("writable");
    }
    let written = fs::read_to_string(&file).unwrap_or_default();
    let differing = page.lines().zip(written.lines()).find(|(new, old)| new != old);
    assert!(
        page == written,
        "{PAGE} is outdated: BLESS=1 cargo test -p infinite-arcade command_page regenerates it; {differing:?}"
    );
    let is_named = |command: &Command| page.contains(&format!("## `arcade {}`", command.get_name()));
    let mut count = 0;
    for_each_verb(&mut |path, verb| {
        count += usize::from(path != "arcade");
        assert!(path.matches(' ').count() != 1 || is_named(verb), "{path}");
    });
    assert!(count > 25, "{count}");
}

/// Returns the commands in a page's code blocks, without prompts and comments.
fn commands(page: &str) -> Vec<String> {
    let mut commands = Vec::new();
    let mut is_fenced = false;
    for line in page.lines().map(str::trim) {
        is_fenced ^= line.starts_with("```");
        let line = line.strip_prefix("$ ").unwrap_or(line);
        if is_fenced && line.starts_with("arcade ") {
            let line = line.split(" #").next().unwrap_or(line);
            commands.push(line.split([';', '|', '&']).next().unwrap_or(line).trim().to_owned());
        }
    }
    commands
}

/// Checks that every command in the book uses only existing subcommands and flags.
#[test]
fn the_commands_of_the_book_exist() {
    let mut root = crate::usage::command();
    root.build();
    let (mut count, mut problems) = (0, Vec::new());
    let readme = include_str!("../../../../README.md");
    let pages = crate::book::manual::pages();
    let texts = pages.iter().map(|page| (page.name.as_str(), page.text)).chain([("README.md", readme)]);
    for (name, text) in texts.filter(|(name, _)| *name != "commands") {
        for line in commands(text) {
            count += 1;
            let mut verb = &root;
            for word in line.split_whitespace().skip(1) {
                if let Some(inner) = verb.find_subcommand(word) {
                    verb = inner;
                } else if let Some(flag) = word.strip_prefix("--") {
                    let flag = flag.split('=').next().unwrap_or(flag);
                    let is_known = verb.get_arguments().any(|argument| argument.get_long() == Some(flag));
                    if !is_known && !["help", "version", "all", ""].contains(&flag) {
                        problems.push(format!("{name}: `{line}`: {} has no --{flag}", verb.get_name()));
                    }
                }
            }
            if std::ptr::eq(verb, &root) && !line.contains(" --") {
                problems.push(format!("{name}: `{line}`: no such verb"));
            }
        }
    }
    assert!(count > 120, "{count}");
    assert!(problems.is_empty(), "\n{}", problems.join("\n"));
}
