//! Paths in messages. Messages never write a path unescaped, because file names may contain line breaks.

use super::report;
use tests::rust_files;

/// The calls that write a path unescaped. Each name is split in two halves, so that this file does not
/// match.
const RAW: [&str; 2] = [concat!(".display", "()"), concat!("Path::", "display")];

/// The files that write a path unescaped, each with the reason.
const ALLOWED: &[(&str, &str)] = &[
    ("crates/cli/src/verbs/releases/release/sealed.rs", "the name of another file"),
    ("crates/cli/src/verbs/players/report.rs", "the name of another file"),
];

#[test]
fn messages_spell_out_paths() {
    let mut problems = Vec::new();
    for (file, text) in rust_files() {
        let place = file.to_string_lossy().into_owned();
        let is_product =
            place.contains("/src/") && !place.starts_with("tools") && !place.starts_with("tests");
        if !is_product || ALLOWED.iter().any(|(allowed, _)| place == *allowed) {
            continue;
        }
        let product = text.split("#[cfg(test)]").next().unwrap_or_default();
        let raw = product.lines().zip(1..).filter(|(line, _)| RAW.iter().any(|raw| line.contains(raw)));
        problems.extend(raw.map(|(_, number)| format!("{place}:{number}: use `MessagePath::in_message`")));
    }
    report(problems);
}
