//! Tests of randomness and of hidden sprites, in a game and in a state.

use super::*;

fn state(analysis: &Analysis, level: &str) -> State {
    let game = analysis.game();
    game.start(&game.level(level).unwrap(), base::Seed::from_text("outlook"))
}

/// Returns the analysis of a game that is set at a fair. A bird flies at random and hatches from an egg that
/// only a nest lays. An invisible trap kills.
fn fair() -> Analysis {
    Analysis::of(&game(
        "bird > RandomNPC\negg > Immovable\nnest > SpawnPoint stype=egg cooldown=3\ntrap > Immovable hidden=True\n\
         mist > Immovable hidden=True\nlair > SpawnPoint stype=crow hidden=True cooldown=9\ncrow > Missile orientation=LEFT\n\
         hole > Portal stype=exit\nexit > Immovable\nfog > Immovable\ncoin > Resource limit=2\nhero > MovingAvatar",
        "b > bird\ne > egg\nn > nest\nt > trap\nm > mist\nl > lair\nh > hole\nx > exit\nf > fog\nc > coin\nA > hero",
        "egg hero > transformTo stype=bird\ntrap hero > killBoth\nbird EOS > stepBack\nhero hole > teleportToExit\n\
         fog hero > spawnIfHasMore resource=coin limit=2 stype=bird\ncoin hero > collectResource",
        "SpriteCounter stype=hero win=False\nSpriteCounter stype=exit win=True",
    ))
}

#[test]
fn chance_from_here() {
    let analysis = fair();
    assert!(analysis.is_stochastic() && !analysis.is_deterministic());
    for (level, certain) in [
        ("A..\n", true),
        ("Ab.\n", false),
        // The egg may hatch, and so may the eggs of the nest.
        ("Ae.\n", false),
        ("An.\n", false),
        // With one exit, there is no choice. With two exits, there is a choice.
        ("Ahx\n", true),
        ("Ahxx\n", false),
        // A bird costs two coins, but the analysis does not count coins.
        ("Af.\n", true),
        ("Afc\n", false),
    ] {
        let level = level.replace('.', " ");
        assert_eq!(analysis.is_deterministic_from(&state(&analysis, &level)), certain, "{level}");
    }
    // The egg is gone, and with it all randomness.
    let game = analysis.game();
    let mut after = state(&analysis, "A  t\n");
    assert!(analysis.is_deterministic_from(&after));
    game.step(&mut after, engine::Action::Right);
    assert!(analysis.is_deterministic_from(&after));
}

#[test]
fn unseen_sprites_and_observability() {
    let analysis = fair();
    // The mist is irrelevant, but the lair is not.
    assert_eq!(names(&analysis, analysis.unseen()), "trap lair");
    assert!(!analysis.is_fully_observable());
    for (level, shown) in [("Am\n", true), ("At\n", false), ("Al\n", false), ("Ax\n", true)] {
        assert_eq!(analysis.is_fully_observable_from(&state(&analysis, level)), shown, "{level}");
    }
}
