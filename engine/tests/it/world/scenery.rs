//! Tests scenery, which consists of types without rules.

use base::Seed;
use engine::inspect::{is_scenery, stored_sprites};
use engine::{Action, Game};

const MEADOW: &str = "BasicGame square_size=10\n  SpriteSet\n    grass > Immovable\n    ground >\n      sand > Immovable\n      \
                      clay > Immovable\n    asleep > Immovable\n    bird > RandomNPC\n    nest > SpawnPoint stype=bird\n    \
                      cloud > Missile speed=0.5\n    tuft > Immovable wMult=0.5\n    hero > MovingAvatar\n  LevelMapping\n    \
                      . > grass\n    s > sand\n    z > asleep\n    n > nest\n    c > cloud\n    t > tuft\n    A > grass hero\n  \
                      InteractionSet\n    bird hero > transformTo stype=asleep\n    hero ground > stepBack\n  TerminationSet\n    \
                      Timeout limit=9 win=True\n";

#[test]
fn scenery_types_have_no_rules_and_never_move() {
    let game = Game::from_source(MEADOW).unwrap();
    let placed_only = |name: &&str| is_scenery(&game, game.sprite_type(name).unwrap());
    let all = ["grass", "sand", "clay", "asleep", "bird", "nest", "cloud", "tuft", "hero"];
    assert_eq!(all.iter().filter(|name| placed_only(name)).collect::<Vec<_>>(), [&"grass"]);
}

#[test]
fn scenery_is_seen_and_counted_as_any_sprite_and_has_no_slots() {
    let game = Game::from_source(MEADOW).unwrap();
    let state = game.start(&game.level("A..\n.sz\n").unwrap(), Seed::from_text("meadow"));
    let grass = game.sprite_type("grass").unwrap();
    // The sand is a fixture, because the hero meets it.
    assert_eq!((stored_sprites(&state), state.alive(grass)), ((2, 1), 4));
    assert_eq!(state.places(grass).collect::<Vec<_>>(), [(0, 0), (10, 0), (20, 0), (0, 10)]);
    assert_eq!(
        game.records(&state).iter().map(|record| record.id).collect::<Vec<_>>(),
        [0, 1, 2, 3, 4, 5, 6]
    );
    let seen = game.observe(&state);
    assert_eq!(seen.cells[..2], [vec!["grass".to_owned(), "hero".to_owned()], vec!["grass".to_owned()]]);
    state.recount(&game).unwrap();
}

#[test]
fn a_hash_knows_its_scenery() {
    let game = Game::from_source(MEADOW).unwrap();
    let start = |level: &str| game.start(&game.level(level).unwrap(), Seed::from_text("meadow"));
    let (mut one, mut other) = (start("A. .\n"), start("A .. \n"));
    for _ in 0..3 {
        assert_eq!(one.state_hash(), one.state_hash_from_scratch());
        assert_ne!(one.state_hash(), other.state_hash());
        game.step(&mut one, Action::Right);
        game.step(&mut other, Action::Right);
        one.settle_hash();
    }
}

#[test]
fn copied_states_take_over_the_scenery() {
    let game = Game::from_source(MEADOW).unwrap();
    let start = |level: &str| game.start(&game.level(level).unwrap(), Seed::from_text("meadow"));
    let (meadow, mut desert) = (start("A....\n"), start("Asss.\n"));
    let grass = game.sprite_type("grass").unwrap();
    desert.clone_from(&meadow);
    assert_eq!(desert.rects(grass).count(), 5);
    assert_eq!(desert.state_hash(), meadow.state_hash());
}
