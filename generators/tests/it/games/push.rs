//! Tests of pushing games among strays, which are deadly sprites that wander at random.

use base::Seed;
use engine::{Action, Game, State, syntax};
use generators::games::PushRules;
use generators::levels::{StrayConfig, StrayLevels};

/// The names of the pushed types and of the avatar.
const MOVED: [&str; 5] = ["crate", "barrel", "settledCrate", "settledBarrel", "pusher"];

/// Returns the same rules without wandering sprites. If there are no such rules without sills, returns rules with
/// sills, which play the same in levels without sills.
fn without_strays(rules: PushRules) -> PushRules {
    let name = rules.name();
    let calm = name.strip_suffix("-strays").expect("rules with strays");
    let named = |name: &str| PushRules::ALL.into_iter().find(|rules| rules.name() == name);
    named(calm).or_else(|| named(&format!("{calm}-sills"))).expect("rules without strays")
}

/// Returns the number of ticks in which the spark burns one cell of fuse.
fn burn(game: &Game) -> u32 {
    let lines = game.description().sprite_lines();
    let (_, spark) = lines.into_iter().find(|(_, line)| line.name.text == "spark").expect("a spark");
    let cooldown = spark.params.iter().find(|param| param.key.text == "cooldown").expect("its cooldown");
    cooldown.value.text.parse().expect("a number")
}

/// If no wandering sprites are in the way, things move as in the rules without such sprites. A failed push moves
/// nothing.
#[test]
fn things_are_pushed_among_strays_as_without_them() {
    let config = StrayConfig { strays: (3, 3), fairness: 0.0, ..StrayConfig::default() };
    let mut pushed = 0;
    for rules in PushRules::AMONG_STRAYS {
        let seed = Seed::from_text("pushed").child(&rules.name(), 0);
        let made = StrayLevels::new(rules, config.clone()).level(seed).unwrap();
        let text = made.text.replace(PushRules::STRAY, ".");
        let (_, board) = text.split_once('\n').unwrap();
        let [game, calm] = [rules, without_strays(rules)].map(PushRules::game);
        let (level, calm_level) = (game.level(&text).unwrap(), calm.level(board).unwrap());
        let places = |game: &Game, state: &State, above: i32| {
            let named = game.sprite_types().filter(|&stype| MOVED.contains(&game.name(stype)));
            let of_type = |stype| {
                let mut cells: Vec<_> = state
                    .places(stype)
                    .map(|(x, y)| (x / state.block(), y / state.block() - above))
                    .collect();
                cells.sort_unstable();
                (game.name(stype).to_owned(), cells)
            };
            named.map(of_type).collect::<Vec<_>>()
        };
        let (mut state, mut calm_state) = (game.start(&level, seed), calm.start(&calm_level, seed));
        let mut sampler = seed.sampler();
        for tick in 0..burn(&game) {
            let ahead = *sampler.choose(&Action::ALL);
            for action in [ahead, ahead] {
                game.step(&mut state, action);
                calm.step(&mut calm_state, action);
                let (here, there) = (places(&game, &state, 1), places(&calm, &calm_state, 0));
                assert_eq!(here, there, "{} tick {tick}\n{text}", rules.name());
            }
        }
        pushed += usize::from(places(&game, &state, 1) != places(&game, &game.start(&level, seed), 1));
        // `undoAll` would undo the moves of the wandering sprites and the spark.
        assert!(!syntax::print(game.description()).contains("undoAll"), "{}", rules.name());
    }
    assert!(pushed > 4, "{pushed}");
}
