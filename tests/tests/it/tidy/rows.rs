//! One row for each VGDL keyword. Few files mention an effect, and matches on effects, sprite classes or
//! conditions have no catch-all arm.

use std::collections::BTreeMap;

use tests::{read, rust_files};

use super::report;

/// The file that declares the effects.
const EFFECTS: &str = "engine/src/rules/effects/mod.rs";

/// The maximum number of files that may mention an effect: the files that execute, build, summarise and
/// describe it.
const FILES: usize = 4;

/// The enums whose matches must list every variant, with their short names.
const EXHAUSTIVE: [&str; 6] =
    ["Effect::", "EffectSummary::", "SpriteClass::", "C::", "Condition::", "Written::"];

/// Returns the lines of a file with their numbers, without test-only items.
fn code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut in_test = false;
    (1..).zip(text.lines()).filter(move |(_, line)| {
        in_test |= *line == "#[cfg(test)]";
        let is_code = !in_test;
        // The code is formatted, so an item ends in the first column.
        in_test &= *line != "}" && (line.starts_with(' ') || !line.ends_with(';'));
        is_code
    })
}

/// Returns the variants of the effect enum.
fn effects() -> Vec<String> {
    let text = read(EFFECTS);
    let body = text.lines().skip_while(|line| *line != "pub(crate) enum Effect {").skip(1);
    let body = body.take_while(|line| *line != "}");
    let variants =
        body.filter_map(|line| line.strip_prefix("    ").filter(|line| line.starts_with(char::is_uppercase)));
    let name = |line: &str| line.split(|letter: char| !letter.is_alphanumeric()).next().map(str::to_owned);
    variants.filter_map(name).collect()
}

#[test]
fn few_files_name_an_effect() {
    let variants = effects();
    assert!(variants.len() > 40, "{EFFECTS} declares the effects: {variants:?}");
    let mut naming: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (file, text) in rust_files() {
        let file = file.display().to_string();
        if !file.starts_with("engine/src/") || file.contains("/tests") {
            continue;
        }
        let code: String = code(&text).flat_map(|(_, line)| [line, "\n"]).collect();
        let words = code.split("Effect::").skip(1);
        let words: Vec<&str> =
            words.filter_map(|rest| rest.split(|letter: char| !letter.is_alphanumeric()).next()).collect();
        for variant in variants.iter().filter(|variant| words.contains(&variant.as_str())) {
            naming.entry(variant).or_default().push(file.clone());
        }
    }
    let crowded = naming.iter().filter(|(_, files)| files.len() > FILES);
    report(
        crowded
            .map(|(variant, files)| {
                format!(
                    "{}:1: `Effect::{variant}` is named in {} files, and at most {FILES} may; ask its summary instead: {}",
                    files[FILES],
                    files.len(),
                    files.join(", ")
                )
            })
            .collect(),
    );
}

/// Returns the lines with a catch-all arm in a match on one of the exhaustive enums. The code is formatted,
/// so the arms are indented one step deeper than the match.
fn fall_throughs(text: &str) -> Vec<usize> {
    let lines: Vec<(usize, &str)> = code(text).collect();
    let indent = |line: &str| line.len() - line.trim_start().len();
    let mut found = Vec::new();
    for (at, (_, line)) in lines.iter().enumerate() {
        let opens =
            line.trim_end().ends_with('{') && line.contains("match ") && !line.trim_start().starts_with("//");
        if !opens {
            continue;
        }
        let arms = lines[at + 1..].iter().take_while(|(_, arm)| arm.is_empty() || indent(arm) > indent(line));
        let arms: Vec<(usize, &str)> = arms
            .filter(|(_, arm)| indent(arm) == indent(line) + 4)
            .map(|(number, arm)| (*number, arm.trim_start().trim_start_matches("| ")))
            .collect();
        if !arms.iter().any(|(_, arm)| EXHAUSTIVE.iter().any(|name| arm.starts_with(name))) {
            continue;
        }
        let takes_all = |arm: &str| {
            let pattern = arm.split(" =>").next().unwrap_or(arm);
            arm.contains(" =>") && pattern.chars().all(|letter| letter.is_lowercase() || letter == '_')
        };
        found.extend(arms.iter().filter(|(_, arm)| takes_all(arm)).map(|(number, _)| *number));
    }
    found
}

#[test]
fn matches_over_the_words_of_vgdl_list_every_variant() {
    let mut problems = Vec::new();
    for (file, text) in rust_files() {
        if file.starts_with("engine/src") {
            problems.extend(fall_throughs(&text).into_iter().map(|line| {
                format!(
                    "{}:{line}: an arm for everything else, in a match over effects, sprite classes or conditions; list \
                     the variants, or match the family of the class as well",
                    file.display()
                )
            }));
        }
    }
    report(problems);
}

#[test]
fn arms_for_everything_else_are_found() {
    let check = |arms: &str, expected: &[usize]| {
        let text = format!("fn f() {{\n    match effect {{\n{arms}    }}\n}}\n");
        assert_eq!(fall_throughs(&text), expected, "{text}");
    };
    check("        Effect::KillSprite => 1,\n        _ => 2,\n", &[4]);
    check(
        "        C::Missile\n        | C::Walker => {\n            1\n        }\n        class => 2,\n",
        &[7],
    );
    check("        Effect::KillSprite => 1,\n        _ if free => 2,\n        Effect::KillBoth => 3,\n", &[]);
    check("        Some(stype) => 1,\n        _ => 2,\n", &[]);
    let after = "#[cfg(test)]\nmod tests;\n\n#[cfg(test)]\nmod more {\n    use a;\n}\nfn f() {\n    match effect {\n        \
                 Effect::KillBoth => 1,\n        _ => 2,\n    }\n}\n";
    assert_eq!(fall_throughs(after), [11]);
}
