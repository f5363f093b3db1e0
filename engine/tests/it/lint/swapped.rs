//! Tests rules whose sprites are swapped.

use super::GAME;
use engine::{Analysis, Game, swapped_rule};

/// Returns a game that is won when the chick is removed, which costs two eggs.
fn game(replace: &str, with: &str) -> Game {
    let source = GAME
        .replace(
            "Timeout limit=300 win=True",
            "SpriteCounter stype=chick win=True\n        Timeout limit=300",
        )
        .replace("prob=0.5 total=9", "prob=0.5 total=9\n        post > Immovable");
    let source = source.replace("f > grass fence", "f > grass fence\n        p > post");
    assert!(source.contains(replace), "{replace}");
    Game::from_source(&source.replace(replace, with)).unwrap_or_else(|problems| panic!("{problems}"))
}

#[track_caller]
fn check(game: &Game, expect: &[(&str, &str)]) {
    let reported: Vec<(&str, &str)> = game
        .warnings()
        .iter()
        .map(|warning| (warning.code, warning.help.as_deref().unwrap_or_default()))
        .collect();
    assert_eq!(reported, expect, "{:?}", game.warnings());
}

#[test]
fn swapped_rules_are_reported_with_their_repair() {
    check(&game("", ""), &[]);
    let meant = "did you mean `egg avatar > collectResource`?";
    check(&game("egg avatar > collect", "avatar egg > collect"), &[("swapped-rule", meant)]);
    let rule = "chick avatar > killIfOtherHasMore resource=egg limit=2 scoreChange=1";
    let meant = format!("did you mean `{rule}`?");
    let swapped = game(rule, &rule.replace("chick avatar", "avatar chick"));
    check(&swapped, &[("swapped-rule", &meant)]);
}

#[test]
fn a_rule_that_is_only_in_the_way_is_not_reported_as_swapped() {
    // Nothing removes posts, even with swapped rules, and without the fences no game would be won either.
    let immortal = game("stype=chick win", "stype=post win");
    check(&immortal, &[("no-win", "add a rule that lowers it, or a different termination")]);
    let found = swapped_rule(&immortal, |game| {
        // Models a level in which a fence stands in front of the post.
        !Analysis::of(game).encounters().iter().any(|encounter| encounter.blocks())
    });
    assert_eq!(found, None);
}
