//! Tests on small releases with known differences.

use super::*;
use crate::card::rungs::tests::card;
use crate::format::manifest::tests::example;
use crate::released::ReleasedLevel;
use engine::Game;
use forge::card::Card;

/// Returns a game about collecting gems. `names` contains the names of the gem and the enemy, and the ground's
/// character.
fn source(names: [&str; 3], foe: &str) -> String {
    let [gem, imp, ground] = names;
    format!(
        "BasicGame\n  SpriteSet\n    {gem} > Immovable\n    {imp} > {foe}\n    avatar > MovingAvatar\n  LevelMapping\n    g > {gem}\n    {ground} > {imp}\n  InteractionSet\n    avatar wall > stepBack\n    avatar {imp} > killSprite\n    {gem} avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype={gem} win=True\n    SpriteCounter stype=avatar win=False\n"
    )
}

fn game(id: &str, source: &str, levels: &[&str], generated: bool) -> ReleasedGame {
    let game = Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}\n{source}"));
    let level = |text: &&str| {
        let level = game.level(text).unwrap_or_else(|problems| panic!("{problems}\n{text}"));
        ReleasedLevel { text: level.to_string(), level, witness: None, second: None }
    };
    let levels: Vec<ReleasedLevel> = levels.iter().map(level).collect();
    let mut card: Card = card(id, &vec![[5, 5]; levels.len()]);
    if generated {
        let patterns = vec!["goal/gather".to_owned()];
        card.origin = Origin::Generated { generator: "g".to_owned(), patterns, candidate: 0 };
    }
    ReleasedGame { card, source: source.to_owned(), levels, game, sibling: None }
}

fn release(games: Vec<ReleasedGame>) -> Released {
    Released { manifest: example(&[]), games, marks: None }
}

const LEVEL: &str = "wwwww\nwA gw\nw f w\nwwwww\n";
const OTHER: &str = "wwwww\nwAg w\nw  fw\nwwwww\n";

#[test]
fn equal_items_are_found_under_any_theme() {
    let plain = source(["gem", "imp", "f"], "RandomNPC");
    // The same game with different names, a different character, and a board that is rotated by a quarter
    // turn and mirrored.
    let dressed = source(["orb", "elf", "e"], "RandomNPC");
    let turned = "wwww\nwA w\nw ew\nwg w\nwwww\n";
    let before = release(vec![
        game("a", &plain, &[LEVEL, OTHER], true),
        game("b", &source(["gem", "imp", "f"], "Chaser stype=avatar"), &[LEVEL], true),
    ]);
    let after = release(vec![
        game("c", &dressed, &[turned], false),
        game("d", &source(["gem", "imp", "f"], "Fleeing stype=avatar"), &[LEVEL], true),
    ]);
    let diff = Diff::of(&before, &after, 2);
    let told = |changes: &Changes| {
        let each = changes.each.iter().map(|change| (change.status, change.id.clone(), change.was.clone()));
        each.collect::<Vec<_>>()
    };
    let line = |status, id: &str, was: Option<&str>| (status, id.to_owned(), was.map(str::to_owned));
    let games =
        [line(Status::Changed, "c", Some("a")), line(Status::New, "d", None), line(Status::Gone, "b", None)];
    assert_eq!(told(&diff.games), games);
    let items = [
        line(Status::Changed, "c/lvl0", Some("a/lvl0")),
        line(Status::New, "d/lvl0", None),
        line(Status::Gone, "a/lvl1", None),
        line(Status::Gone, "b/lvl0", None),
    ];
    assert_eq!(told(&diff.items), items);
    assert_eq!((diff.items.new, diff.items.changed, diff.items.gone, diff.items.kept), (1, 1, 2, 0));
    assert_eq!(diff.games.returned_generated, 0, "the one that returned is of the corpus now");
    let nearest = &diff.neighbours.closest[0];
    assert_eq!((nearest.after.as_str(), nearest.before.as_str(), nearest.distance), ("c", "a", 0.0));
    // Changing one class does not make a new game: `d` is near `b`, and both are generated.
    assert_eq!((diff.neighbours.near, diff.neighbours.near_generated), (2, 1));
    assert!(diff.neighbours.across_generated.unwrap().min > 0.0);
}

#[test]
fn a_release_is_the_same_as_itself() {
    let plain = source(["gem", "imp", "f"], "RandomNPC");
    // The second level occurs twice, and each copy is paired separately.
    let release = release(vec![game("a", &plain, &[LEVEL, OTHER, OTHER], true)]);
    let diff = Diff::of(&release, &release, 9);
    assert_eq!((diff.games.kept, diff.games.each.len()), (1, 1));
    assert_eq!((diff.items.kept, diff.items.each.len(), diff.items.returned_generated), (3, 3, 3));
    let was: Vec<Option<&str>> = diff.items.each.iter().map(|change| change.was.as_deref()).collect();
    assert_eq!(was, [Some("a/lvl0"), Some("a/lvl1"), Some("a/lvl2")]);
    assert!(diff.shifts.iter().all(|shift| shift.distance == Some(0.0) && shift.p == Some(1.0)));
    assert!(diff.numbers.iter().all(|shift| shift.distance == Some(0.0) && shift.p == Some(1.0)));
    assert!(diff.rungs.iter().all(|rung| rung.difference == 0.0 && rung.includes_zero()));
    assert_eq!(diff.neighbours.within, None, "there is no other game");
}

/// An unmeasured value has neither a distance nor a p-value, and the verdict states so.
#[test]
fn unmeasured_difficulty_is_not_equal_difficulty() {
    let plain = source(["gem", "imp", "f"], "RandomNPC");
    let side = |id: &str, level: &str, measured: bool| {
        let mut game = game(id, &plain, &[level], true);
        if !measured {
            game.card.levels.iter_mut().for_each(|level| level.ladder = None);
        }
        release(vec![game])
    };
    let turned = "wwwww\nwA gw\nw  fw\nwwwww\n";
    for (before, after, words) in [
        (
            false,
            false,
            "Difficulty was not measured (no `skill`); 0 levels recur; distance of the nearest pair of games: 0.00",
        ),
        (false, true, "Difficulty was measured in the later release only"),
        (true, false, "Difficulty was measured in the earlier release only"),
    ] {
        let mut later = side("b", turned, after);
        later.manifest.root = Digest::of(b"later");
        let diff = Diff::of(&side("a", LEVEL, before), &later, 1);
        assert!(diff.verdict.starts_with(words), "{}", diff.verdict);
        let shift = &diff.shifts[0];
        assert_eq!((shift.name, shift.distance, shift.p), ("difficulty of levels", None, None));
        assert_eq!(
            (shift.unmeasured.before, shift.unmeasured.after),
            (usize::from(!before), usize::from(!after))
        );
        assert!(shift.shares.iter().all(|share| share.value != "not measured"), "{shift:?}");
        let ease = diff.numbers.last().unwrap();
        assert_eq!((ease.name, ease.distance, ease.p), ("ease of a level", None, None));
    }
}

#[test]
fn the_order_follows_from_the_parents() {
    let plain = source(["gem", "imp", "f"], "RandomNPC");
    let mut later = release(vec![game("a", &plain, &[LEVEL], true)]);
    let earlier = later.clone();
    later.manifest.root = Digest::of(b"later");
    assert_eq!(Diff::of(&earlier, &later, 1).order, Order::Unrelated);
    later.manifest.parent = Some(earlier.manifest.root);
    assert_eq!(Diff::of(&earlier, &later, 1).order, Order::Follows);
    assert_eq!(Diff::of(&later, &earlier, 1).order, Order::Reversed);
}

#[test]
fn one_cell_makes_a_level_new() {
    let plain = source(["gem", "imp", "f"], "RandomNPC");
    let before = release(vec![game("a", &plain, &[LEVEL], true)]);
    let after = release(vec![game("a", &plain, &["wwwww\nwA gw\nw  fw\nwwwww\n"], true)]);
    let diff = Diff::of(&before, &after, 1);
    assert_eq!((diff.games.kept, diff.items.kept, diff.items.new, diff.items.gone), (1, 0, 1, 1));
}

fn texts(values: &[&str], games: usize) -> Vec<Vec<String>> {
    (0..games).map(|_| values.iter().map(|&value| value.to_owned()).collect()).collect()
}

#[test]
fn shifts_are_tested_by_permuting_games() {
    let found = Shift::of("t", &texts(&["a", "a", "b"], 20), &texts(&["a", "b", "b"], 20));
    assert!((found.distance.unwrap() - 1.0 / 3.0).abs() < 1e-12, "{found:?}");
    assert_eq!(found.p, Some(0.001));
    assert_eq!(found.shares[1], Share { value: "b".to_owned(), before: 20, after: 40 });
    // With three games per side, only 1 of 10 deals differs as much, however many levels each game has.
    let few = Shift::of("t", &texts(&["a"; 50], 3), &texts(&["b"; 50], 3));
    assert_eq!(few.distance, Some(1.0));
    assert!((0.07..0.13).contains(&few.p.unwrap()), "{few:?}");
    assert_eq!(Shift::of("t", &texts(&["a"], 3), &[]).p, None);
}

#[test]
fn distributions_are_compared_by_cumulative_shares() {
    let found = NumberShift::of("t", &vec![vec![1.0, 2.0]; 10], &vec![vec![2.0, 3.0]; 10]);
    assert_eq!((found.distance, found.p), (Some(0.5), Some(0.001)));
    assert_eq!((found.before.unwrap().median, found.after.unwrap().max), (1.5, 3.0));
    let same = NumberShift::of("t", &[vec![1.0], vec![2.0]], &[vec![2.0], vec![1.0]]);
    assert_eq!((same.distance, same.p), (Some(0.0), Some(1.0)));
    assert_eq!(NumberShift::of("t", &[vec![]], &[vec![1.0]]).distance, None);
}
