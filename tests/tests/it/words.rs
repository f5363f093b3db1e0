//! The language of the repository. Doc comments open with a noun phrase or a verb, and use standard terms
//! instead of earlier coinages.

use tests::{read, rust_files, workspace_files};

/// Words that must not open a doc comment, because they begin a subordinate clause.
const OPENERS: &[&str] = &[
    "What", "Whatever", "Whether", "Who", "Whoever", "Whose", "Whom", "How", "Where", "Wherever", "Which",
    "Why", "So",
];

/// Earlier coinages in lower case, each with its replacement. Comments, texts and pages must not contain
/// them.
const COINAGES: &[(&str, &str)] = &[
    ("what processors fetch at once", "a cache line"),
    ("hangs on", "depends on"),
    ("hang on game", "depend on game"),
    ("in the mean", "on average"),
    ("comes about", "arises, or is made"),
    ("come about", "arise, or are made"),
    ("surroundings failed", "environment failure (I/O, network, disk full)"),
    ("in another dress", "under another theme, or isomorphic"),
    ("another dress", "another theme"),
    ("nobody would miss", "redundant"),
    ("games of chance", "stochastic games"),
    ("game of chance", "stochastic game"),
    ("where chance decides", "in stochastic games"),
    ("leads elsewhere", "differs"),
    ("begin anew", "start over"),
    ("taken up again", "resumed"),
    ("takes up again", "resumes"),
    ("played again", "replayed"),
    ("so many of so many", "a count out of a total"),
    ("as it were", "nothing, or a plain statement"),
    ("dies of it", "crashes on it"),
    ("dies of that", "crashes on that"),
    ("linear tide", "linear hash class"),
    ("held up", "blocked"),
    ("put away", "stored"),
    ("off the clock", "outside the measurement"),
    ("is told of", "is reported"),
    ("are told of", "are reported"),
    ("no one can tell the difference", "the result is the same"),
];

/// Earlier identifiers, each with the name that replaced its concept.
const RETIRED: &[(&str, &str)] = &[
    ("Tide", "HashClass"),
    ("Deed", "EffectSummary"),
    ("deeds", "effects"),
    ("Belongings", "a side table"),
    ("belongings", "a side table"),
    ("Lot", "Job"),
    ("LotResult", "JobResult"),
    ("Shelf", "JobStore"),
];

#[test]
fn doc_comments_open_with_a_noun_phrase_or_a_verb() {
    let (mut all, mut problems) = (0, Vec::new());
    for (file, text) in rust_files() {
        let mut inside = false;
        for (number, line) in text.lines().enumerate() {
            let comment = doc_comment(line);
            if let (Some(comment), false) = (comment, inside) {
                all += 1;
                if let Some(opener) = opener(comment) {
                    problems.push(format!("{}:{}: opens with `{opener}`", file.display(), number + 1));
                }
            }
            inside = comment.is_some();
        }
    }
    assert!(all > 5000, "{all} doc comments");
    assert!(
        problems.is_empty(),
        "{} of {all} doc comments open with a relative clause; open them with a noun phrase or a verb:\n{}",
        problems.len(),
        problems.join("\n")
    );
}

#[test]
fn no_coinage_is_left() {
    let mut problems = Vec::new();
    for file in workspace_files() {
        let name = file.to_string_lossy().into_owned();
        let is_prose = name.ends_with(".md") && name != "CHANGELOG.md";
        if (!is_prose && !name.ends_with(".rs")) || name.ends_with("it/words.rs") || is_data(&name) {
            continue;
        }
        for (number, line) in read(&file).lines().enumerate() {
            for (old, new) in found(line) {
                problems.push(format!("{name}:{}: `{old}`: write {new}", number + 1));
            }
        }
    }
    assert!(problems.is_empty(), "\n{}", problems.join("\n"));
}

/// Returns `true` if a file contains minted or recorded data, which must not be edited.
fn is_data(name: &str) -> bool {
    name.starts_with("tests/suite/snapshots") || name.starts_with("crates/evaluation/tests/golden")
}

/// Returns the text of a line that belongs to a doc comment; `None` for any other line.
fn doc_comment(line: &str) -> Option<&str> {
    let line = line.trim_start();
    line.strip_prefix("/// ").or_else(|| line.strip_prefix("//! "))
}

fn opener(comment: &str) -> Option<&'static str> {
    let first = comment.split(|character: char| !character.is_alphanumeric()).next()?;
    OPENERS.iter().copied().find(|opener| *opener == first)
}

/// Returns the coinages and retired identifiers in a line, each with its replacement.
fn found(line: &str) -> Vec<(&'static str, &'static str)> {
    let lower = line.to_lowercase();
    let phrases = COINAGES.iter().filter(|(old, _)| has_word(&lower, old));
    phrases.chain(RETIRED.iter().filter(|(old, _)| has_word(line, old))).copied().collect()
}

/// Returns `true` if a line contains a word or phrase that is not part of a longer word.
fn has_word(line: &str, word: &str) -> bool {
    let part_of_word = |character: char| character.is_alphanumeric() || character == '_';
    line.match_indices(word).any(|(at, _)| {
        !line[..at].ends_with(part_of_word) && !line[at + word.len()..].starts_with(part_of_word)
    })
}

#[test]
fn openers_and_coinages_are_found() {
    assert_eq!(opener("Whether it is over."), Some("Whether"));
    assert_eq!(opener("What's left."), Some("What"));
    assert_eq!(opener("Whereabouts of sprites."), None);
    assert_eq!(doc_comment("    /// The cells."), Some("The cells."));
    assert_eq!(doc_comment("    // The cells."), None);
    assert_eq!(found("// It Hangs on luck."), [("hangs on", "depends on")]);
    assert_eq!(found("struct Deed;"), [("Deed", "EffectSummary")]);
    assert_eq!(found("struct Deedless; // rehangs on"), []);
}
