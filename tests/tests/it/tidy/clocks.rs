//! The few files that read a clock. None of them produces a game, a level, a verdict or a move.

use tests::rust_files;

use super::report;

/// The files that read a clock, each with the purpose of reading it.
const READERS: &[(&str, &str)] = &[
    ("crates/agents/benches/batch.rs", "a benchmark"),
    ("crates/cli/src/console.rs", "seconds in remarks"),
    ("crates/cli/src/verbs/program/clean/leftover.rs", "the age of leftover files"),
    ("crates/cli/src/verbs/releases/release/probe.rs", "the estimate of a dry run"),
    ("crates/evaluation/src/client/clock.rs", "waits between requests, and their latency"),
    ("crates/evaluation/src/run/clock.rs", "times in logs, and the time limits of programs that play"),
    ("crates/terminal/src/screen.rs", "the pace of play in a terminal"),
    ("tools/xtask/src/bench.rs", "benchmarks"),
    ("tools/xtask/src/episode_run.rs", "benchmarks"),
    ("tools/xtask/src/survey/levels.rs", "the time that a generator takes"),
    ("tools/xtask/src/sweep.rs", "fresh seeds of tests"),
];

/// The calls that read a clock. The names are split so that this file does not match.
const READS: [&str; 4] = [
    concat!("Instant", "::now"),
    concat!("SystemTime", "::now"),
    concat!("ProcessTime", "::now"),
    concat!("ThreadTime", "::now"),
];

#[test]
fn clocks_are_read_in_listed_files_only() {
    let mut problems = Vec::new();
    let mut found = Vec::new();
    for (file, text) in rust_files() {
        for (line, number) in text.lines().zip(1..) {
            let comment = line.trim_start().starts_with("//");
            let Some(read) = READS.iter().find(|read| !comment && line.contains(**read)) else { continue };
            match READERS.iter().find(|(reader, _)| file.as_path() == *reader) {
                Some((reader, _)) => found.push(*reader),
                None => problems.push(format!(
                    "{}:{number}: reads a clock (`{read}`); take the time from one of the readers, or give the \
                     file a row in READERS in {}",
                    file.display(),
                    file!()
                )),
            }
        }
    }
    for (reader, purpose) in READERS {
        if !found.contains(reader) {
            problems.push(format!("{}: {reader} reads no clock ({purpose}); remove its row", file!()));
        }
    }
    report(problems);
}
