//! Tests that the proofs of the systematic search hold.
//!
//! Small levels are searched exhaustively in three ways. The three searches distinguish states by
//! [`State::search_key`], by the search's own key, and by the full data hashed into this key. All three must
//! find the same wins and, apart from data omitted from the key, the same states.

use agents::search::{Answer, Pushes, SearchLimits, Searched, a_star, best_first};
use base::Seed;
use engine::analysis::StateAbstraction;
use engine::{Action, Analysis, Game, Level, Outcome, State};
use std::collections::BTreeMap;

/// Returns a game with the given sprites, mapping, interactions and terminations, in addition to walls and
/// the player.
fn game(sprites: &str, mapping: &str, rules: &str, ends: &str) -> Game {
    let lines = |text: &str| text.lines().map(|line| format!("    {line}\n")).collect::<String>();
    let source = format!(
        "BasicGame\n  SpriteSet\n    wall > Immovable\n{}  LevelMapping\n{}  InteractionSet\n    hero wall > stepBack\n{}  TerminationSet\n{}",
        lines(sprites),
        lines(mapping),
        lines(rules),
        lines(ends)
    );
    Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}"))
}

/// Returns a game in which crates fall into drains.
fn drains() -> Game {
    game(
        "crate > Passive\ndrain > Immovable\nhero > MovingAvatar",
        "c > crate\no > drain\nH > hero",
        "crate hero > bounceForward\ncrate wall crate > undoAll\ncrate drain > killSprite scoreChange=1\nhero drain > stepBack",
        "SpriteCounter stype=crate win=True",
    )
}

/// Returns a game in which crates stay on plates and turn into a different type.
fn plates() -> Game {
    game(
        "tile > Immovable hidden=True\nplate > Immovable\nblock > Passive\n  crate >\n  stowed >\nhero > MovingAvatar",
        "c > crate tile\no > plate\nH > hero tile\nw > wall tile\n. > tile",
        "block hero > bounceForward\nblock wall block > undoAll\ncrate plate > transformTo stype=stowed\nstowed tile > transformTo stype=crate",
        "SpriteCounter stype=crate win=True",
    )
}

/// Returns a game with pits, and with a door that uses up a key.
fn keys() -> Game {
    game(
        "key > Resource limit=2\ndoor > Immovable\ngem > Immovable\npit > Immovable\nhero > MovingAvatar",
        "k > key\nd > door\ng > gem\np > pit\nH > hero",
        "key hero > collectResource killResource=True\ndoor hero > killIfOtherHasMore resource=key limit=1\nhero door > stepBack\nhero pit > killSprite\ngem hero > killSprite",
        "SpriteCounter stype=gem win=True\nSpriteCounter stype=hero win=False\nTimeout limit=40 win=False",
    )
}

/// Returns a game in which carts drive to and fro.
fn carts() -> Game {
    game(
        "cart > Missile orientation=RIGHT speed=1 cooldown=2\nflag > Immovable\nhero > MovingAvatar",
        "c > cart\nf > flag\nH > hero",
        "cart wall > reverseDirection\nhero cart > killSprite\nflag hero > killSprite",
        "SpriteCounter stype=flag win=True\nSpriteCounter stype=hero win=False",
    )
}

/// Returns a game in which hunters follow paths to the hero, and draw random numbers only if there is no
/// path.
fn hunters() -> Game {
    let plain = game(
        "hunter > PathChaser stype=hero cooldown=2\nflag > Immovable\nhero > MovingAvatar",
        "h > hunter\nf > flag\nH > hero",
        "hunter wall > stepBack\nhero hunter > killSprite\nflag hero > killSprite",
        "SpriteCounter stype=flag win=True\nSpriteCounter stype=hero win=False",
    );
    let source = engine::syntax::print(plain.description()).replacen("BasicGame", "BasicGame obs=wall", 1);
    Game::from_source(&source).unwrap()
}

/// Levels, each with `true` if it can be won.
type Levels = Vec<(&'static str, bool)>;

/// Returns all games with their levels.
fn cases() -> Vec<(&'static str, Game, Levels)> {
    vec![
        (
            "drains",
            drains(),
            vec![
                ("wwwwww\nwHc ow\nwwwwww\n", true),
                ("wwwwww\nwH  cw\nw   ow\nwwwwww\n", false),
                ("wwwwwww\nw  o  w\nw ccc w\nw  H  w\nwwwwwww\n", true),
                ("wwwwww\nwc   w\nw  H w\nw c ow\nwwwwww\n", false),
                ("wwwwww\nw c ow\nw  H w\nw c ow\nw    w\nwwwwww\n", true),
            ],
        ),
        (
            "plates",
            plates(),
            vec![
                ("wwwwww\nwHc.ow\nwwwwww\n", true),
                ("wwwwww\nw....w\nwocH.w\nw.c..w\nwo...w\nwwwwww\n", true),
                ("wwwwww\nw.c..w\nw.H.ow\nwwwwww\n", false),
                ("wwwwwww\nw..o..w\nw.cHc.w\nw..o..w\nwwwwwww\n", true),
            ],
        ),
        (
            "keys",
            keys(),
            vec![
                ("wwwwww\nwHkdgw\nwwwwww\n", true),
                ("wwwwwwww\nwHd g  w\nw wwwwww\nw    k w\nwwwwwwww\n", true),
                ("wwwwwww\nwH dkgw\nwwwwwww\n", false),
                ("wwwwwww\nwHp  gw\nw p   w\nw p   w\nwwwwwww\n", false),
                ("wwwwwwww\nwHkdkdgw\nwwwwwwww\n", true),
            ],
        ),
        (
            "carts",
            carts(),
            vec![
                ("wwwww\nwH cw\nw  fw\nwwwww\n", true),
                ("wwwww\nwHcfw\nwwwww\n", true),
                ("wwwwww\nwHcc w\nw   fw\nwwwwww\n", true),
                ("wwwww\nwH cw\nww ww\nwc fw\nwwwww\n", true),
                ("wwwwww\nwHwwfw\nwwwwww\n", false),
            ],
        ),
        (
            "hunters",
            hunters(),
            vec![
                ("wwwwwww\nwH   fw\nw www w\nw  h  w\nwwwwwww\n", true),
                ("wwwwwww\nwH  hfw\nwwwwwww\n", false),
                ("wwwwwww\nwH  hfw\nw w wwww\nw   w\nwwwww\n", true),
                ("wwwwwww\nwH hwfw\nwwwwwww\n", false),
            ],
        ),
    ]
}

struct Case<'a> {
    analysis: &'a Analysis,
    abstraction: StateAbstraction,
    start: State,
}

impl Case<'_> {
    /// Returns all reachable states of the ongoing game, as distinguished by `tell`, and the minimum number
    /// of actions to win. The search is breadth-first.
    fn reached<T: Ord>(&self, tell: impl Fn(&State) -> T) -> (BTreeMap<T, Vec<u64>>, Option<usize>) {
        let words = |state: &State| self.abstraction.words(self.analysis, state);
        let mut met = BTreeMap::from([(tell(&self.start), words(&self.start))]);
        let mut queue = std::collections::VecDeque::from([(0, self.start.clone())]);
        let mut fewest = None;
        while let Some((depth, state)) = queue.pop_front() {
            for action in Action::ALL {
                let mut next = state.clone();
                match self.analysis.game().step(&mut next, action) {
                    Outcome::Won => fewest = fewest.or(Some(depth + 1)),
                    Outcome::Ongoing => {
                        if let std::collections::btree_map::Entry::Vacant(place) = met.entry(tell(&next)) {
                            place.insert(words(&next));
                            queue.push_back((depth + 1, next));
                        }
                    }
                    _ => {}
                }
                assert!(met.len() < 200_000, "a small level");
            }
        }
        (met, fewest)
    }
}

fn distinct<T>(met: &BTreeMap<T, Vec<u64>>) -> Vec<&Vec<u64>> {
    let mut words: Vec<&Vec<u64>> = met.values().collect();
    words.sort_unstable();
    words.dedup();
    words
}

fn check(name: &str, analysis: &Analysis, level: &Level, winnable: bool) {
    let game = analysis.game();
    let start = game.start(level, Seed::from_text("search"));
    let case = Case { analysis, abstraction: analysis.abstraction(&start), start: start.clone() };
    let (by_key, _) = case.reached(|state| case.abstraction.key(analysis, state));
    let (by_words, _) = case.reached(|state| case.abstraction.words(analysis, state));
    assert_eq!(by_key.len(), by_words.len(), "{name}: no two states share a key by accident");
    let (in_full, fewest) = case.reached(|state| state.search_key(game));
    assert_eq!(fewest.is_some(), winnable, "{name}");
    assert!(in_full.len() >= by_key.len(), "{name}");
    assert_eq!(
        distinct(&in_full),
        distinct(&by_key),
        "{name}: the same states, up to what the key leaves out"
    );

    let pushes = Pushes::of(analysis, level);
    let limits = SearchLimits::calls(1_000_000);
    for (searched, is_shortest) in [
        (a_star(analysis, &pushes, &start, limits), true),
        (a_star(analysis, &Pushes::default(), &start, limits), true),
        (best_first(analysis, &pushes, &start, limits), false),
    ] {
        let Searched { answer, calls, states, .. } = searched;
        assert!(calls <= limits.calls && states <= by_key.len() as u64 + 1, "{name}");
        match (answer, fewest) {
            (Answer::Won { actions, shortest }, Some(fewest)) => {
                assert_eq!(shortest, is_shortest, "{name}");
                assert!(
                    actions.len() == fewest || !is_shortest && actions.len() > fewest,
                    "{name}: {actions:?}"
                );
                let mut state = start.clone();
                for &action in &actions {
                    assert_eq!(state.outcome(), Outcome::Ongoing, "{name}");
                    game.step(&mut state, action);
                }
                assert_eq!(state.outcome(), Outcome::Won, "{name}");
            }
            (Answer::Impossible, None) => {}
            (answer, _) => panic!("{name}: {answer:?}"),
        }
    }
}

#[test]
fn wins_are_the_shortest_and_proofs_are_right() {
    for (name, game, levels) in cases() {
        let analysis = Analysis::of(&game);
        for (number, (level, winnable)) in levels.into_iter().enumerate() {
            let level = game.level(level).unwrap_or_else(|problems| panic!("{problems}"));
            check(&format!("{name} {number}"), &analysis, &level, winnable);
        }
    }
}

/// Pruned states are lost: no win is reachable from a state that [`Pushes`] prunes. No state needs fewer
/// ticks than its bound.
#[test]
fn push_distances_are_lower_bounds() {
    for (name, game, levels) in cases().into_iter().take(2) {
        let analysis = Analysis::of(&game);
        for (number, (level, _)) in levels.into_iter().enumerate() {
            let level = game.level(level).unwrap();
            let pushes = Pushes::of(&analysis, &level);
            let mut states = vec![game.start(&level, Seed::from_text("pushes"))];
            let mut sampler = Seed::from_text(name).child("walk", number as u64).sampler();
            for _ in 0..40 {
                let mut state = states[sampler.below(states.len())].clone();
                for _ in 0..3 {
                    game.step(&mut state, *sampler.choose(&Action::ALL));
                }
                if !state.is_over() {
                    states.push(state);
                }
            }
            for state in &states {
                let searched = a_star(&analysis, &Pushes::default(), state, SearchLimits::calls(1_000_000));
                match (searched.answer, pushes.least(state)) {
                    (Answer::Won { actions, .. }, Some(least)) => {
                        assert!(least as usize <= actions.len(), "{name} {number}");
                    }
                    (Answer::Impossible, _) => {}
                    (answer, least) => panic!("{name} {number}: {answer:?} but {least:?}"),
                }
            }
        }
    }
}

#[test]
fn bounded_searches_keep_limits_and_are_unknown() {
    let game = drains();
    let analysis = Analysis::of(&game);
    let level = game.level("wwwwwww\nw  o  w\nw ccc w\nw  H  w\nwwwwwww\n").unwrap();
    let start = game.start(&level, Seed::from_text("limits"));
    let pushes = Pushes::of(&analysis, &level);
    let few = a_star(&analysis, &pushes, &start, SearchLimits::calls(50));
    assert_eq!((few.answer, few.calls), (Answer::OutOfCalls, 50));
    let small = a_star(&analysis, &pushes, &start, SearchLimits { calls: 1_000_000, bytes: 4_000 });
    assert_eq!(small.answer, Answer::OutOfMemory);
}

/// The characters `A` and `w` stand for `avatar` and `wall` in every game. A level that relies on these defaults is
/// searched like a level of a game that maps the characters explicitly.
#[test]
fn default_characters_are_searched_like_written_ones() {
    let ends = "SpriteCounter stype=pear win=True\nSpriteCounter stype=avatar win=False";
    let rules = "pear avatar > killSprite\navatar EOS wall > stepBack";
    for sprites in [
        "avatar > MovingAvatar\n  calm >\n  cross >\npear > Immovable\nhero > MovingAvatar",
        "pear > Immovable\nhero > MovingAvatar",
        "pear > Immovable\nhero > HorizontalAvatar\navatar > MovingAvatar",
    ] {
        let searched = [
            "p > pear",
            "p > pear\nA > avatar\nw > wall",
            "p > pear\nH > hero",
            "p > pear\nH > hero\nA > avatar",
        ]
        .map(|mapping| {
            let game = game(sprites, mapping, rules, ends);
            let analysis = Analysis::of(&game);
            let level = game.level("A  w\n   p\n").unwrap();
            let start = game.start(&level, Seed::from_text("default"));
            let searched =
                a_star(&analysis, &Pushes::of(&analysis, &level), &start, SearchLimits::calls(5000));
            assert!(
                analysis.reach(&level).can_win() && analysis.reach(&level).avatar_reaches(7),
                "{mapping}"
            );
            match searched.answer {
                Answer::Won { actions, shortest } => (actions.len(), shortest),
                answer => panic!("{answer:?}: {sprites}, {mapping}"),
            }
        });
        assert_eq!(searched, [(4, true); 4], "{sprites}");
    }
}

/// An avatar type that the game itself does not use can push crates, too.
#[test]
fn crates_are_pushed_by_any_avatar() {
    let game = game(
        "crate > Passive\ndrain > Immovable\nhero > HorizontalAvatar",
        "c > crate\no > drain\nH > hero",
        "crate hero avatar > bounceForward\ncrate wall crate > undoAll\ncrate drain > killSprite\navatar drain > stepBack",
        "SpriteCounter stype=crate win=True",
    );
    let analysis = Analysis::of(&game);
    let level = game.level("A  \n c \n   \n o \n").unwrap();
    let start = game.start(&level, Seed::from_text("default"));
    let pushes = Pushes::of(&analysis, &level);
    let searched = a_star(&analysis, &pushes, &start, SearchLimits::calls(50_000));
    assert!(matches!(searched.answer, Answer::Won { shortest: true, .. }), "{:?}", searched.answer);
}
