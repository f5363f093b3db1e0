//! Tells `arcade --version` the commit that a release build was made from. Other builds know none, so that a commit rebuilds nothing.

use std::env;
use std::process::Command;

#[expect(
    clippy::disallowed_methods,
    reason = "the variable is Cargo's, and no recorded output depends on it"
)]
fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if env::var("PROFILE").is_ok_and(|profile| profile == "release")
        && is_own_clone()
        && let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"])
    {
        println!("cargo::rustc-env=ARCADE_COMMIT={commit}");
        // Where HEAD points, and where that branch is: what a commit or a checkout changes.
        for file in ["HEAD", "logs/HEAD"] {
            if let Some(path) = git(&["rev-parse", "--git-path", file]) {
                println!("cargo::rerun-if-changed={path}");
            }
        }
    }
}

/// Tells the project's own clone from one that the sources were unpacked into.
fn is_own_clone() -> bool {
    git(&["rev-parse", "--show-prefix"]).is_some_and(|prefix| prefix == "cli/")
}

/// The first line that git prints; none without git or outside a clone, as in an unpacked archive.
fn git(arguments: &[&str]) -> Option<String> {
    let output =
        Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    let text = String::from_utf8(output.stdout).ok()?;
    Some(text.lines().next()?.to_owned()).filter(|line| !line.is_empty())
}
