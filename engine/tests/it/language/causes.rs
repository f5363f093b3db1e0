//! Tests that each fault causes one problem.

use engine::{Game, Severity};

const GAME: &str = "BasicGame\n    SpriteSet\n        den > SpawnPoint stype=fox\n        fox > RandomNPC\n        egg > Resource limit=3\n        hen > MovingAvatar\n    LevelMapping\n        d > den\n        e > egg\n        A > hen\n    InteractionSet\n        egg hen > collectResource\n        hen fox > killSprite\n    TerminationSet\n        SpriteCounter stype=egg win=True\n        Timeout limit=90\n";

/// Checks the problems after a part of the game is replaced. Each problem is given as code and line, with the
/// codes of errors in upper case.
#[track_caller]
fn check(part: &str, other: &str, expect: &[&str]) {
    assert!(GAME.contains(part), "{part}");
    let source = GAME.replace(part, other);
    let game = Game::from_source(&source);
    let problems = game.as_ref().map_or_else(|problems| problems.0.as_slice(), Game::warnings);
    let shown = problems.iter().map(|problem| {
        let line = engine::line_and_column(&source, problem.span.start).0;
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
    check("        egg hen > collectResource", "        // egg hen > collectResource", &["BAD-COMMENT 12"]);
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
    // The parent has a different class, and is now a parent.
    check("        egg > ", "            egg > ", &["IGNORED-CLASS 5"]);
    check("        egg > ", "          egg > ", &["UNEVEN-INDENT 5"]);
    check("        hen > ", "         hen > ", &["UNEVEN-INDENT 6"]);
}
