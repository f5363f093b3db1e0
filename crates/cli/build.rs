//! Records the commit of a release build for `arcade --version`. Other builds do not record their commit, so
//! a commit does not trigger a rebuild.

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
        // These are HEAD and the branch it points to. A commit or a checkout changes them.
        for file in ["HEAD", "logs/HEAD"] {
            if let Some(path) = git(&["rev-parse", "--git-path", file]) {
                println!("cargo::rerun-if-changed={path}");
            }
        }
    }
}

/// Returns `true` in the project's own clone, and `false` if the sources were unpacked inside a clone of a
/// different project.
fn is_own_clone() -> bool {
    git(&["rev-parse", "--show-prefix"]).is_some_and(|prefix| prefix == "cli/")
}

/// Returns the first line that git prints, or `None` without git or outside a clone (for example in an
/// unpacked archive).
fn git(arguments: &[&str]) -> Option<String> {
    let output =
        Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    let text = String::from_utf8(output.stdout).ok()?;
    Some(text.lines().next()?.to_owned()).filter(|line| !line.is_empty())
}
