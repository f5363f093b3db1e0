//! Tests of countdowns.

use base::Seed;
use engine::{Action, Event, Game};

const GAME: &str = "BasicGame\n    SpriteSet\n        den > SpawnPoint stype=log cooldown=4 total=2\n        \
    log > Immovable\n        ember > Flicker limit=5\n        hen > MovingAvatar\n    LevelMapping\n        d > den\n        \
    e > ember\n        A > hen\n    InteractionSet\n        hen log > stepBack\n    TerminationSet\n        \
    Timeout limit=90\n";

#[test]
fn countdowns_foretell_what_happens() {
    let game = Game::from_source(GAME).unwrap();
    let mut state = game.start(&game.level("A d e").unwrap(), Seed::from_text("countdown"));
    let count = |state: &engine::State, name: &str| state.alive(game.sprite_type(name).unwrap());
    let (mut made, mut ended) = (0, 0);
    for _ in 0..20 {
        let (logs, embers) = (count(&state, "log"), count(&state, "ember"));
        let foretold = game.countdowns(&state);
        let now =
            |event| foretold.iter().filter(|known| known.event == event && known.ticks == Some(1)).count();
        game.step(&mut state, Action::Nil);
        assert_eq!(count(&state, "log") - logs, now(Event::Makes), "{foretold:?}");
        assert_eq!(embers - count(&state, "ember"), now(Event::Ends), "{foretold:?}");
        made += now(Event::Makes);
        ended += now(Event::Ends);
        let left = game.countdowns(&state).iter().find_map(|known| known.left);
        assert_eq!(left.unwrap_or(0), 2 - made as i32);
    }
    assert_eq!((made, ended), (2, 1));
}

/// A spreader counts down to the tick in which it spreads, and then to its end.
#[test]
fn spreaders_foretell_both() {
    let game = "BasicGame\n    SpriteSet\n        dough > Spreader stype=loaf age=-4 limit=4\n        loaf > Immovable\n        \
        cook > MovingAvatar\n    LevelMapping\n        d > dough\n        A > cook\n    InteractionSet\n    TerminationSet\n        \
        Timeout limit=90\n";
    let game = Game::from_source(game).unwrap();
    let mut state = game.start(&game.level("A    \n  d  \n     \n").unwrap(), Seed::from_text("dough"));
    let count = |state: &engine::State, name: &str| state.alive(game.sprite_type(name).unwrap());
    let mut seen = Vec::new();
    while let [known] = game.countdowns(&state)[..] {
        let loaves = count(&state, "loaf");
        game.step(&mut state, Action::Nil);
        let spreads = count(&state, "loaf") > loaves;
        assert_eq!(spreads, known.event == Event::Makes && known.ticks == Some(1), "{known:?}");
        seen.push((known.event, known.ticks.unwrap()));
    }
    let makes = (1..=6).rev().map(|ticks| (Event::Makes, ticks));
    let ends = (1..=4).rev().map(|ticks| (Event::Ends, ticks));
    assert_eq!(seen, makes.chain(ends).collect::<Vec<_>>());
    assert_eq!((count(&state, "dough"), count(&state, "loaf")), (0, 4));
}

/// Timed effects count down on the types that they change, also when a touch schedules them.
#[test]
fn timed_effects_are_foretold() {
    let game = "BasicGame\n    SpriteSet\n        egg > Immovable\n        chick > Immovable\n        vent > Immovable\n        \
        smoke > Immovable\n        bell > Immovable\n        lamp > Immovable\n        cook > MovingAvatar\n    LevelMapping\n        \
        e > egg\n        v > vent\n        b > bell\n        l > lamp\n        A > cook\n    InteractionSet\n        \
        cook TIME > transformToAll stype=egg stypeTo=chick timer=7 nextExecution=0\n        \
        vent TIME > spawn stype=smoke timer=5 repeating=True nextExecution=0\n        \
        bell cook > addTimer timer=4 ftype=killAll stype=lamp\n        bell cook > killSprite\n    TerminationSet\n        \
        Timeout limit=90\n";
    let game = Game::from_source(game).unwrap();
    let mut state = game.start(&game.level("Ab e v l").unwrap(), Seed::from_text("clock"));
    let count = |state: &engine::State, name: &str| state.alive(game.sprite_type(name).unwrap());
    let mut events = Vec::new();
    for tick in 0..14 {
        let before = ["egg", "smoke", "lamp"].map(|name| count(&state, name));
        let foretold = game.countdowns(&state);
        game.step(&mut state, if tick == 0 { Action::Right } else { Action::Nil });
        let now = ["egg", "vent", "lamp"].map(|name| {
            let stype = game.sprite_type(name).unwrap();
            foretold.iter().any(|known| known.stype == stype && known.ticks == Some(1))
        });
        let after = ["egg", "smoke", "lamp"].map(|name| count(&state, name));
        assert_eq!(now, [0, 1, 2].map(|at| before[at] != after[at]), "tick {tick}: {foretold:?}");
        events.extend(foretold.iter().filter(|known| known.ticks == Some(1)).map(|known| known.event));
    }
    assert_eq!(events.len(), 4, "{events:?}");
    assert!(events.contains(&Event::Turns) && events.contains(&Event::Ends));
}

/// A countdown to a move reaches 1 exactly before the ticks in which the sprite moves, and the observed direction
/// is that of the next step. The hunters' ways around the rock are equally short.
#[test]
fn next_steps_are_foretold() {
    let game = "BasicGame obs=rock\n    SpriteSet\n        rock > Immovable\n        wolf > PathChaser stype=hen cooldown=2\n        \
        slug > Missile orientation=RIGHT cooldown=3\n        bear > PathChaser stype=hen\n        hen > MovingAvatar\n    \
        LevelMapping\n        o > rock\n        w > wolf\n        s > slug\n        b > bear\n        A > hen\n    \
        InteractionSet\n    TerminationSet\n        Timeout limit=90\n";
    let game = Game::from_source(game).unwrap();
    let level = game.level("w     b\n o ooo \n o   o \n oo Ao \n       \ns      \n").unwrap();
    let mut state = game.start(&level, Seed::from_text("hunters"));
    let mut moves = [0; 3];
    for tick in 0..14 {
        let before = game.observe(&state);
        let keys = [Action::Nil, Action::Right, Action::Nil, Action::Left, Action::Up];
        game.step(&mut state, keys[tick % keys.len()]);
        let after = game.observe(&state);
        for (moves, name) in moves.iter_mut().zip(["wolf", "slug", "bear"]) {
            let seen = |of: &engine::Observation| of.movers.iter().find(|mover| mover.name == name).cloned();
            let (Some(old), Some(new)) = (seen(&before), seen(&after)) else { continue };
            let foretold =
                before.countdowns.iter().find(|view| view.name == name).map(|view| &view.countdown);
            assert_eq!(foretold.is_some(), name != "bear");
            let moved = (new.column - old.column, new.row - old.row);
            let is_due = foretold.is_none_or(|known| known.event == Event::Moves && known.ticks == Some(1));
            let way = (old.facing.x as i32, old.facing.y as i32);
            let stayed = before.avatar == after.avatar;
            assert!(is_due || moved == (0, 0), "{name} in tick {tick}");
            assert!(!is_due || !stayed || moved == way, "{name} in tick {tick}: {moved:?}, not {way:?}");
            *moves += u32::from(moved != (0, 0));
        }
    }
    assert!(moves.iter().all(|&moves| moves >= 3), "{moves:?}");
}
