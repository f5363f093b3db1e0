//! Counts the instructions per tick in corpus games, to test whether steps have become slower.

use std::path::Path;
use std::process::Command;

/// `CARGO_INCREMENTAL=0 BLESS=1 cargo test --workspace --test instructions` records the counts again. Review
/// the resulting diff like code.
///
/// The test counts a fifth of the games, or all games in a sweep (`cargo xtask sweep`). Without valgrind, the
/// test is skipped with a message. It is also skipped in incremental builds, because their code is divided
/// into different units. `.ci/run` does not build incrementally.
#[test]
#[allow(clippy::print_stderr, reason = "a skipped test says so")]
fn no_tick_costs_more_instructions_than_recorded() {
    if option_env!("CARGO_INCREMENTAL") != Some("0") {
        eprintln!("SKIPPED: instructions are counted in builds with CARGO_INCREMENTAL=0");
        return;
    }
    let is_set = |name| std::env::var_os(name).is_some();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let output = Command::new(env!("CARGO_BIN_EXE_xtask"))
        .arg("instructions")
        .args(if is_set("BLESS") { &["--bless"][..] } else { &[] })
        .args(if is_set("BLESS") || is_set("ARCADE_SWEEP") { &[][..] } else { &["--every", "5"] })
        .current_dir(root)
        .output()
        .expect("the binary starts");
    let text =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
    assert!(output.status.success(), "{text}");
    eprintln!("{text}");
}
