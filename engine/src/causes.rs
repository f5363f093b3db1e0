//! One cause, one problem: problems that only follow from another problem of the same file are not reported.

use crate::diagnostic::{Diagnostic, Diagnostics, Severity, line_start};
use crate::limits::MAX_PROBLEMS;
use std::collections::BTreeMap;

/// Problems that make it uncertain which sprites are declared.
const HIDES_DECLARATIONS: [&str; 4] = ["missing-section", "missing-arrow", "stray-line", "too-deep"];
/// Problems that make it uncertain which word a line starts with.
const HIDES_START: [&str; 4] = ["missing-arrow", "bad-mapping", "bad-interaction", "bad-termination"];
/// Problems of a name: reported once, however often the name is used.
const OF_A_NAME: [&str; 2] = ["unknown-sprite", "parent-sprite"];

/// All problems of a file whose text gave `read` and whose rules gave `compiled`, sorted by place, without those that
/// follow from others. The subject of a problem is the word that its message and its help quote.
pub(crate) fn reported(read: Vec<Diagnostic>, compiled: Vec<Diagnostic>, source: &str) -> Diagnostics {
    let unread = Diagnostics::has_errors(&read);
    let all = Diagnostics::sorted(read.into_iter().chain(once_each(compiled)).collect()).0;
    let faulty = Diagnostics::has_errors(&all);
    let roots: Vec<Diagnostic> =
        all.iter().filter(|problem| is_root(problem)).take(MAX_PROBLEMS).cloned().collect();
    let mut reported: Vec<Diagnostic> = Vec::new();
    for problem in all {
        let hidden = || match problem.code {
            "no-win" => unread,
            _ => roots.iter().any(|root| follows(&problem, root, source)),
        };
        // Problems beyond the limit are only counted.
        if reported.len() > MAX_PROBLEMS || !hidden() {
            reported.push(problem);
        }
    }
    if faulty && !Diagnostics::has_errors(&reported) {
        // All errors come from the indentation.
        let roots = reported.iter_mut().filter(|problem| is_uneven(problem));
        roots.for_each(|root| root.severity = Severity::Error);
    }
    Diagnostics(reported).shortened(source.len())
}

/// Tests whether other problems may follow from this one.
fn is_root(problem: &Diagnostic) -> bool {
    let warns = ["ignored-class", "empty-mapping"].contains(&problem.code);
    problem.severity == Severity::Error || warns || is_uneven(problem)
}

/// Tests whether the problem is the indent of a sprite, which makes parents and subtypes uncertain.
fn is_uneven(problem: &Diagnostic) -> bool {
    problem.code == "uneven-indent" && !problem.message.ends_with("sections")
}

fn follows(problem: &Diagnostic, root: &Diagnostic, source: &str) -> bool {
    let line = |problem: &Diagnostic| line_start(source, problem.span.start);
    let same_line = || line(problem) == line(root);
    match problem.code {
        "unknown-sprite" => HIDES_DECLARATIONS.contains(&root.code),
        // For a word that is not a character, the first character.
        "duplicate-mapping" => root.code == "bad-mapping" && quoted(root).starts_with(quoted(problem)),
        "no-class" => root.code != problem.code && same_line(),
        // The missing parameter is there, but misspelt; for subtypes it may be on the line of their parent.
        "missing-parameter" => {
            let key = problem.message.split('`').find_map(|quoted| quoted.strip_suffix('='));
            let (help, key) = (root.help.as_deref().unwrap_or_default(), key.unwrap_or_default());
            let names = help.contains(&format!("`{key}`")) || help.contains(&format!("`{key}="));
            root.code != problem.code && names && line(root) <= line(problem)
        }
        // The missing word has left its blanks behind.
        "uneven-indent" | "stray-indent" => HIDES_START.contains(&root.code) && same_line(),
        "ignored-class" => is_uneven(root),
        "parent-sprite" => {
            let subtypes = problem.help.as_deref().and_then(|help| help.split(": ").nth(1));
            let below = || subtypes.unwrap_or_default().split(", ").any(|subtype| subtype == quoted(root));
            is_uneven(root) || root.code == "ignored-class" && below()
        }
        "never-there" => match root.code {
            "ignored-class" => same_line(),
            code => is_uneven(root) || code == "empty-mapping",
        },
        _ => false,
    }
}

/// The subject of a problem: the first word that its message quotes.
fn quoted(problem: &Diagnostic) -> &str {
    problem.message.split('`').nth(1).unwrap_or_default()
}

/// Reports a name that is used wrongly in several places only at the first one.
fn once_each(problems: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let problems = Diagnostics::sorted(problems).0;
    let mut places: BTreeMap<(&str, String), usize> = BTreeMap::new();
    let mut reported: Vec<Diagnostic> = Vec::new();
    for problem in problems {
        let count = places.entry((problem.code, problem.message.clone())).or_default();
        *count += 1;
        if *count == 1 || !OF_A_NAME.contains(&problem.code) {
            reported.push(problem);
        }
    }
    for problem in reported.iter_mut().filter(|problem| OF_A_NAME.contains(&problem.code)) {
        let more = places[&(problem.code, problem.message.clone())] - 1;
        if more > 0 {
            let (places, name) = if more == 1 { ("place", "names") } else { ("places", "name") };
            problem.message += &format!("; {more} more {places} {name} it");
        }
    }
    reported
}

#[cfg(test)]
mod tests {
    use crate::{Game, Severity};

    const GAME: &str = "BasicGame\n    SpriteSet\n        den > SpawnPoint stype=fox\n        fox > RandomNPC\n        egg > Resource limit=3\n        hen > MovingAvatar\n    LevelMapping\n        d > den\n        e > egg\n        A > hen\n    InteractionSet\n        egg hen > collectResource\n        hen fox > killSprite\n    TerminationSet\n        SpriteCounter stype=egg win=True\n        Timeout limit=90\n";

    /// Checks the problems after a part of the game is replaced: code and line, errors in upper case.
    #[track_caller]
    fn check(part: &str, other: &str, expect: &[&str]) {
        assert!(GAME.contains(part), "{part}");
        let source = GAME.replace(part, other);
        let game = Game::from_source(&source);
        let problems = game.as_ref().map_or_else(|problems| problems.0.as_slice(), Game::warnings);
        let shown = problems.iter().map(|problem| {
            let line = crate::line_and_column(&source, problem.span.start).0;
            let is_error = problem.severity == Severity::Error;
            let code = if is_error { problem.code.to_uppercase() } else { problem.code.to_owned() };
            format!("{code} {line}")
        });
        assert_eq!(shown.collect::<Vec<_>>(), expect, "{problems:?}");
    }

    #[test]
    fn one_fault_is_one_problem() {
        check("", "", &[]);
        check("den > Spawn", "den - Spawn", &["MISSING-ARROW 3"]);
        check("den > Spawn", "> Spawn", &["MISSING-ARROW 3"]);
        check("stype=fox", "stype;fox", &["STRAY-WORD 3"]);
        check("stype=fox", "type=fox", &["UNKNOWN-PARAMETER 3"]);
        check("stype=egg", "stype:egg", &["STRAY-WORD 15"]);
        check("win=True", "win=yes", &["WRONG-TYPE 15"]);
        check("Timeout limit=90", "Timeout", &["ends-at-once 16"]);
        check("limit=90", "limits=90", &["WRONG-TYPE 16"]);
        check("limit=90", "ticks=90", &["UNKNOWN-PARAMETER 16"]);
        check("        fox > RandomNPC\n", "", &["UNKNOWN-SPRITE 3"]);
        check("d > den", "d >", &["empty-mapping 8"]);
        check("d > den", "ex > den", &["BAD-MAPPING 8"]);
        check("    SpriteSet", "    foxes\n    hens\n    SpriteSet", &["STRAY-LINE 2"]);
        check(
            "        egg hen > collectResource",
            "        // egg hen > collectResource",
            &["BAD-COMMENT 12"],
        );
    }

    #[test]
    fn lines_that_slipped_are_one_problem() {
        let shifted = "         d > den\n         e > egg\n         A > hen\n";
        check("        d > den\n        e > egg\n        A > hen\n", shifted, &[]);
        let shifted = "    d > den\n    e > egg\n    A > hen\n";
        check("        d > den\n        e > egg\n        A > hen\n", shifted, &["STRAY-LINE 8"]);
        check("    LevelMapping", "        LevelMapping", &["STRAY-INDENT 7"]);
        let unindented = GAME.replace("\n    ", "\n");
        check(GAME, &unindented, &["STRAY-INDENT 2"]);
        // The parent has another class, and is now a parent.
        check("        egg > ", "            egg > ", &["IGNORED-CLASS 5"]);
        check("        egg > ", "          egg > ", &["UNEVEN-INDENT 5"]);
        check("        hen > ", "         hen > ", &["UNEVEN-INDENT 6"]);
    }
}
