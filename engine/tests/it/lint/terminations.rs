//! Tests terminations that hold at the wrong time, or never.

use super::{GAME, check};
use engine::Game;

#[test]
fn terminations_at_the_wrong_time() {
    check("stype=nest win", "stype=chick win", &[]);
    let immortal = [("never-there", 5), ("no-lose", 23)];
    check("nest > SpawnPoint stype=chick prob=0.5 total=9", "nest > Immovable", &immortal);
    check("Timeout limit=300", "Timeout limit=0", &[("ends-at-once", 24)]);
    check("Timeout limit=300", "Timeout limit=3000", &[("never-ends", 24)]);
    check(
        "SpriteCounter stype=nest win=False",
        "SpriteCounterMore stype=nest win=False",
        &[("ends-at-once", 23)],
    );
    check("stype=nest win=False", "stype=nest win=True", &[("no-lose", 23)]);
}

/// Checks the messages about the game with this TerminationSet and one more rule.
#[track_caller]
fn check_ends(rule: &str, terminations: &str, expect: &[&str]) {
    let (head, _) = GAME.split_once("        SpriteCounter").unwrap();
    let head = head.replace("TerminationSet", &format!("    {rule}\n    TerminationSet"));
    let game = Game::from_source(&format!("{head}        {terminations}\n")).unwrap();
    let reported: Vec<&str> = game.warnings().iter().map(|warning| warning.message.as_str()).collect();
    assert_eq!(reported, expect);
}

#[test]
fn ends_that_never_come() {
    let lost = "Timeout limit=300 win=False";
    let rule = "stone chick > killSprite";
    check_ends(rule, &format!("SpriteCounter stype=stone win=True\n        {lost}"), &[]);
    let reason = "the game cannot be won: nothing lowers the number of `fence`";
    check_ends(rule, &format!("SpriteCounter stype=fence win=True\n        {lost}"), &[reason]);
    let reason = "the game cannot be won: nothing raises the number of `stone`";
    check_ends(rule, &format!("SpriteCounterMore stype=stone limit=4 win=True\n        {lost}"), &[reason]);
    let sum = "MultiSpriteCounter stype1=stone stype2=fence limit=3 win=True";
    let turn = "stone chick > transformTo stype=fence";
    let reason = "the game cannot be won: nothing changes the number of `stone` and `fence`";
    check_ends(turn, &format!("{sum}\n        {lost}"), &[reason]);
    let reason = "the game cannot be won: the number of `stone` is never below 0";
    check_ends(rule, &format!("SpriteCounter stype=stone limit=-1 win=True\n        {lost}"), &[reason]);
    // A problem that already has a warning is reported only once.
    let never = "an episode has at most 2000 ticks, so this never happens";
    check_ends(rule, &format!("Timeout limit=9000 win=True\n        {lost}"), &[never]);
    let at_once = "this holds at the start of every level: the game is over in its first tick";
    check_ends(rule, "SpriteCounter stype=stone win=True\n        Timeout limit=0", &[at_once]);
    let free = "this rule never fires: it needs 2 `egg`, but no rule gives any";
    let game = GAME
        .replace("egg avatar > collectResource", "fence avatar > killIfOtherHasMore resource=egg limit=2");
    let game = game.replace("Timeout limit=300 win=True", "SpriteCounter stype=fence win=True");
    let game = game.replace(
        "chick avatar > killIfOtherHasMore resource=egg limit=2 scoreChange=1",
        "avatar egg > stepBack",
    );
    let game = Game::from_source(&game).unwrap();
    assert_eq!(game.warnings().iter().map(|warning| &warning.message).collect::<Vec<_>>(), [free]);
    // A score of 0 loses.
    check_ends(rule, "Timeout limit=100 count_score=True", &[]);
    check_ends(rule, "SpriteCounter stype=stone count_score=True win=False", &[]);
    // A count that no player changes may hold from the start of a level.
    let score =
        "SpriteCounter stype=stone limit=0 win=True\n        SpriteCounter stype=avatar limit=2 win=False";
    check_ends(rule, score, &[]);
    check_ends(rule, &format!("{score} count_score=True"), &[]);
    let reason = "the game cannot be lost before its last tick: nothing lowers the number of `fence`";
    let score = "SpriteCounter stype=stone win=True\n        SpriteCounter stype=fence count_score=True";
    check_ends(rule, score, &[reason]);
}

#[test]
fn a_rule_that_requires_more_than_any_sprite_can_hold_is_named() {
    let check = |replace: &str, with: &str, expect: &[&str]| {
        let game = GAME.replace("Timeout limit=300 win=True", "SpriteCounter stype=stone win=True");
        let rule = "stone avatar > killIfOtherHasMore resource=egg limit=3";
        let game = game.replace("egg avatar > collect", &format!("{rule}\n        egg avatar > collect"));
        let game = Game::from_source(&game.replace(replace, with)).unwrap();
        let reported = game.warnings().iter().filter(|warning| warning.code == "no-win");
        assert_eq!(reported.map(|warning| warning.message.as_str()).collect::<Vec<_>>(), expect);
    };
    check("", "", &[]);
    let asks =
        "the game cannot be won: `stone avatar > killIfOtherHasMore` needs 3 `egg`, but no sprite can hold";
    check("Resource limit=3", "Resource limit=1", &[&format!("{asks} more than 1")]);
    let kind = format!("{asks} any: `egg` is Immovable, not Resource");
    check("egg > Resource limit=3", "egg > Immovable", &[&kind]);
}

#[test]
fn conditions_that_hold_from_the_start_can_be_suspended() {
    // This termination holds from the start, but does not end the game.
    let ends = "SpriteCounterMore stype=stone win=True canEnd=False\n        Timeout limit=300 win=False";
    check_ends("stone chick > killSprite", ends, &[]);
}

#[test]
fn levels_that_are_over_at_once() {
    let game = Game::from_source(GAME).unwrap();
    assert!(game.level("A.n\n").unwrap().warnings().is_empty());
    let over = game.level("A..\n").unwrap();
    assert_eq!(over.warnings()[0].code, "ends-at-once");
    assert!(over.warnings()[0].message.contains("lost"), "{}", over.warnings()[0].message);
}
