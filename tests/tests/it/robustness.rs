//! Short runs of the checks that `tools/fuzz/` runs for longer, on any text, any level and any actions. The
//! inputs are the same in every run.

use base::Sampler;
use engine::syntax::Section;
use engine::{EFFECTS, SPRITE_PARAMETERS, SpriteClass, TERMINATIONS, effect_parameters};
use proptest::prelude::*;
use tests::any_game::any_game;
use tests::choices::{Choices, random_bytes};
use tests::mutation::mutated;
use tests::robustness::{self, Seen};
use tests::{read, sweep, workspace_files, workspace_root};

fn sampler(purpose: &str) -> Sampler {
    sweep::seed("robustness").child(purpose, 0).sampler()
}

/// Returns the contents of the files below a repository folder, sorted by path.
fn files_below(folder: &str) -> Vec<Vec<u8>> {
    let files = workspace_files().into_iter().filter(|file| file.starts_with(folder));
    files.map(|file| std::fs::read(workspace_root().join(file)).expect("a file of the repository")).collect()
}

/// Tests every game in the repository, intact and damaged, and generated games.
#[test]
fn any_text_parses_compiles_and_prints() {
    let mut sampler = sampler("text");
    let games = files_below("corpora").into_iter().chain(files_below("tests/suite/hostile"));
    let seeds = games.chain(files_below("tools/fuzz/seeds/text"));
    for bytes in seeds.filter(|bytes| bytes.len() < 1 << 14) {
        robustness::text(&bytes);
        for _ in 0..6 {
            robustness::text(&mutated(&bytes, &mut sampler));
        }
    }
    for _ in 0..150 {
        let made = any_game(&mut Choices::new(&random_bytes(&mut sampler, 400)));
        robustness::text(made.source.as_bytes());
        robustness::text(&mutated(made.source.as_bytes(), &mut sampler));
    }
}

/// Tests corpus levels, intact and damaged, in their own game and in different games.
#[test]
fn any_bytes_are_a_level_or_are_refused() {
    let mut sampler = sampler("level");
    let mut seen = Seen::default();
    let levels = workspace_files().into_iter().filter(|file| {
        file.starts_with("corpora") && file.extension().is_some_and(|extension| extension == "txt")
    });
    for level in levels {
        let text = read(&level);
        for which in 0..16 {
            let bytes = [&[which], text.as_bytes()].concat();
            let damaged = mutated(&bytes, &mut sampler);
            seen = seen.and(robustness::level(if which < 8 { &bytes } else { &damaged }));
        }
    }
    for bytes in files_below("tools/fuzz/seeds/level") {
        seen = seen.and(robustness::level(&bytes));
    }
    assert!(seen.ticks > 1000, "{seen:?}");
}

/// Every effect is executed, sprites of every class occur, and many pairs of states share a search key.
#[test]
fn any_actions_leave_a_sound_state() {
    let mut sampler = sampler("play");
    let mut seen = Seen::default();
    for bytes in files_below("tools/fuzz/seeds/play") {
        seen = seen.and(robustness::play(&bytes));
        seen = seen.and(robustness::play(&mutated(&bytes, &mut sampler)));
    }
    for _ in 0..800 {
        let length = sampler.between(0, 600);
        seen = seen.and(robustness::play(&random_bytes(&mut sampler, length)));
    }
    let effects = EFFECTS.iter().enumerate().filter(|(at, _)| seen.effects & 1 << at == 0);
    let missing: Vec<&str> = effects.map(|(_, name)| *name).collect();
    assert_eq!(missing, Vec::<&str>::new(), "effects that never ran");
    let classes = SpriteClass::ALL.iter().enumerate().filter(|(at, _)| seen.classes & 1 << at == 0);
    let missing: Vec<&str> = classes.map(|(_, class)| class.name()).collect();
    assert_eq!(missing, Vec::<&str>::new(), "classes of which there was no sprite");
    assert!(seen.merged > 1000, "{seen:?}");
}

/// Checks the words that the fuzzer inserts into texts. `BLESS=1` rewrites the file.
#[test]
fn the_dictionary_has_every_word() {
    let words = SpriteClass::ALL.iter().map(|class| class.name());
    let words =
        words.chain(Section::ALL.map(Section::name)).chain(["BasicGame", "EOS", "TIME", "wall", "avatar"]);
    let words = words.chain(EFFECTS.iter().chain(TERMINATIONS).copied());
    let own = SpriteClass::ALL.iter().flat_map(|class| class.parameters());
    let effects = EFFECTS.iter().flat_map(|effect| effect_parameters(effect)).map(|(key, _)| key);
    let common =
        ["scoreChange", "repeat", "timer", "repeating", "win", "min", "stype3", "square_size", "obs"];
    let keys = SPRITE_PARAMETERS.iter().copied().chain(own).chain(effects).chain(common);
    let values = [
        "True",
        "False",
        "UP",
        "NONE",
        "CONT",
        "GRID",
        "1e999",
        "-1",
        "2147483647",
        "0.5",
        " > ",
        "#",
        "\\x0A",
    ];
    let words = words.chain(values).map(str::to_owned).chain(keys.map(|key| format!("{key}=")));
    let mut lines: Vec<String> = words.map(|word| format!("\"{word}\"\n")).collect();
    lines.sort();
    lines.dedup();
    let expected = format!(
        "# The words of VGDL, for libFuzzer: cargo fuzz run text -- -dict=vgdl.dict\n{}",
        lines.concat()
    );
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(workspace_root().join("tools/fuzz/vgdl.dict"), &expected)
            .expect("the dictionary can be written");
    }
    assert_eq!(read("tools/fuzz/vgdl.dict"), expected, "BLESS=1 writes the dictionary anew");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// Tests structurally valid games, and shrinks a failing game to the simplest one that fails.
    #[test]
    fn any_game_plays(bytes in prop::collection::vec(any::<u8>(), 0..500)) {
        robustness::play(&bytes);
    }

    /// Tests lines of VGDL keywords in any order.
    #[test]
    fn any_careless_lines_are_read(lines in prop::collection::vec(careless_line(), 0..30)) {
        robustness::text(format!("BasicGame\n{}", lines.join("\n")).as_bytes());
    }

    #[test]
    fn any_text_is_read(text in "(?s).{0,300}") {
        robustness::text(text.as_bytes());
    }

    #[test]
    fn any_characters_are_a_level_or_are_refused(which in any::<u8>(), text in "[ -~\n]{0,60}") {
        robustness::level(&[&[which], text.as_bytes()].concat());
    }
}

/// Generates a line such as a careless author might write.
fn careless_line() -> impl Strategy<Value = String> {
    const WORDS: [&str; 43] = [
        "SpriteSet",
        "InteractionSet",
        "LevelMapping",
        "TerminationSet",
        "avatar",
        "wall",
        "a",
        "b",
        ">",
        "EOS",
        "Missile",
        "MovingAvatar",
        "Chaser",
        "stype=a",
        "stype=b",
        "stype=",
        "=",
        "orientation=UP",
        "speed=0.5",
        "wMult=0",
        "wMult=-3.5",
        "hMult=1e300",
        "cooldown=-2147483648",
        "killSprite",
        "stepBack",
        "transformTo",
        "transformToAll",
        "stypeTo=b",
        "spawn",
        "SpriteCounter",
        "Timeout",
        "limit=0",
        "win=True",
        "A",
        "w",
        "#",
        "Spreader",
        "SpawnPoint",
        "total=1",
        "prob=2",
        "healthPoints=99999999999",
        "undoAll",
        "repeat=100000",
    ];
    let words = prop::collection::vec(prop::sample::select(&WORDS[..]), 1..7);
    (0usize..10, words).prop_map(|(indent, words)| format!("{}{}", " ".repeat(indent), words.join(" ")))
}
