//! Tests of the analysis during play: its proofs hold on the corpus, and on the reference's games if they are
//! available.

use base::{Sampler, Seed};
use engine::analysis::{Attainable, Reach};
use engine::{Action, Analysis, Game, Level, Outcome, Rect, SpriteType, State};
use generators::kernels::{KernelGame, KernelGenome, Slot};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use tests::any_game::any_game;
use tests::choices::{Choices, random_bytes};
use tests::{generated, sweep, workspace_root};

/// The number of generated games in a sweep.
const GAMES: usize = 4000;
/// The number of ticks to play each generated game in a sweep.
const TICKS: usize = 40;
/// The number of generated games to play. Most of them compile.
const INVENTED: u64 = 400;

/// A game and its levels.
struct Case {
    name: String,
    game: Game,
    levels: Vec<Level>,
}

/// Returns the games in a folder's subfolders that load. If the folder is missing, prints a message and
/// returns no games.
#[allow(clippy::print_stderr, reason = "a skipped test says so")]
fn games(folder: &Path) -> Vec<Case> {
    let Ok(entries) = fs::read_dir(folder) else {
        eprintln!("skipped: there is no folder {}", folder.display());
        return Vec::new();
    };
    let mut folders: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    folders.sort();
    let load = |folder: &PathBuf| {
        let read = |file: &str| fs::read_to_string(folder.join(file)).ok();
        let source = ["game.vgdl", "game.txt"].iter().find_map(|file| read(file))?;
        let game = Game::from_source(&source).or_else(|_| Game::from_source_as_reference(&source)).ok()?;
        let texts = (0..5).map_while(|number| read(&format!("lvl{number}.txt")));
        let levels = texts.filter_map(|text| game.level(&text).ok()).collect();
        Some(Case { name: folder.file_name()?.to_string_lossy().into_owned(), game, levels })
    };
    folders.iter().filter_map(load).collect()
}

fn all_games() -> Vec<Case> {
    let mut cases = games(&workspace_root().join("corpora"));
    assert!(cases.len() >= 8, "the corpus");
    cases.extend(games(&workspace_root().join("../shared/gvgai/games")));
    cases.extend(kernels());
    cases
}

/// Returns a game for each form of each kernel, with one level per slot.
fn kernels() -> impl Iterator<Item = Case> {
    let genomes = KernelGenome::kernels().flat_map(KernelGenome::all_of);
    let mut seen = BTreeSet::new();
    let forms = genomes.filter(move |genome| {
        seen.insert((genome.kernel().to_owned(), genome.form().map(ToOwned::to_owned)))
    });
    forms.filter_map(|genome| {
        let KernelGame { game, course } = genome.build().ok()?;
        let name = format!("kernel {} {}", genome.kernel(), genome.form().unwrap_or_default());
        let seed = Seed::from_text(&name);
        let level = |slot: &Slot| game.rules.level(&course.level(*slot, seed).ok()?.text).ok();
        let levels = Slot::ALL.iter().filter_map(level).collect();
        Some(Case { name, game: game.rules, levels })
    })
}

/// Plays some levels of every game at random. Calls `visit` with every state, including the initial one.
fn wander(
    levels: usize,
    ticks: usize,
    mut visit: impl FnMut(&Case, &Analysis, &Level, &State, &mut Sampler),
) {
    for case in all_games() {
        let analysis = Analysis::of(&case.game);
        for (number, level) in case.levels.iter().enumerate().take(levels) {
            let seed = Seed::from_text(&case.name).child("level", number as u64);
            let mut sampler = seed.child("actions", 0).sampler();
            let mut state = case.game.start(level, seed.child("chance", 0));
            visit(&case, &analysis, level, &state, &mut sampler);
            for _ in 0..ticks {
                // Keys are sometimes held down, as by players.
                let action = *sampler.choose(case.game.actions(&state));
                for _ in 0..sampler.between(1, 4) {
                    case.game.step(&mut state, action);
                }
                visit(&case, &analysis, level, &state, &mut sampler);
                if state.is_over() {
                    break;
                }
            }
        }
    }
}

/// With the same actions, different seeds give the same sprites once randomness no longer matters.
#[test]
fn deterministic_states_have_one_future() {
    let (mut certain, mut turned) = (0, 0);
    wander(2, 40, |Case { name, game, .. }, analysis, _, state, sampler| {
        if state.is_over() || !analysis.is_deterministic_from(state) {
            return;
        }
        certain += 1;
        turned += u32::from(analysis.is_stochastic());
        let seed = Seed::from_text(name).child("futures", certain);
        let (mut one, mut two) = (state.fork(seed.child("one", 0)), state.fork(seed.child("two", 0)));
        for _ in 0..12 {
            let action = *sampler.choose(&Action::ALL);
            assert_eq!(game.step(&mut one, action), game.step(&mut two, action), "{name}");
            assert_eq!(game.records(&one), game.records(&two), "{name} tick {}", one.tick());
            assert_eq!(one.score(), two.score(), "{name}");
        }
        if !analysis.is_stochastic() && game.is_deterministic() {
            assert_eq!(one.search_key(game), two.search_key(game), "{name}");
        }
    });
    assert!(certain > 100 && turned > 0, "{certain} states, {turned} of them in stochastic games");
}

/// In generated games too, different seeds with the same actions give the same sprites once randomness no
/// longer matters.
#[test]
fn deterministic_generated_games_have_one_future() {
    let mut sampler = sweep::seed("one future").sampler();
    let (mut certain, mut drawn) = (0, 0);
    for number in 0..sweep::cases(GAMES) as u64 {
        let (source, text) = generated::game(&mut sampler);
        let Ok(game) = Game::from_source(&source) else { continue };
        let Ok(level) = game.level(&text) else { continue };
        let analysis = Analysis::of(&game);
        let seed = Seed::from_text("one future").child("game", number);
        let mut one = game.start(&level, seed.child("one", 0));
        for part in 0..4 {
            if one.is_over() {
                break;
            }
            let is_certain = analysis.is_deterministic_from(&one);
            assert!(is_certain || !analysis.is_deterministic(), "{source}");
            let mut two = one.fork(seed.child("two", part));
            for _ in 0..10 {
                let action = *sampler.choose(&Action::ALL);
                game.step(&mut one, action);
                if is_certain {
                    game.step(&mut two, action);
                    assert_eq!(
                        game.records(&one),
                        game.records(&two),
                        "tick {}\n{source}\n{text}",
                        one.tick()
                    );
                    assert_eq!((one.score(), one.outcome()), (two.score(), two.outcome()), "{source}");
                }
            }
            certain += u32::from(is_certain);
            drawn += u32::from(is_certain && !game.is_deterministic());
        }
    }
    assert!(certain > 100 && drawn > 20, "{certain} states, {drawn} of them with draws");
}

/// Goals that can hold only from the start are not reached later, and goals that cannot hold at the start do
/// not hold then.
#[test]
fn goals_are_attained_as_proved() {
    let mut holds: Vec<bool> = Vec::new();
    wander(5, 60, |Case { name, .. }, analysis, _, state, _| {
        if matches!(state.outcome(), Outcome::Stopped(_) | Outcome::Ended) {
            return;
        }
        if state.tick() < 0 {
            holds = analysis.goals().iter().map(|goal| analysis.missing(goal, state) == 0).collect();
        }
        for (goal, &held) in analysis.goals().iter().zip(&holds) {
            let met = analysis.missing(goal, state) == 0;
            let fits = match goal.attainable {
                Attainable::AtOnce => met || state.tick() < 0,
                Attainable::InPlay => true,
                Attainable::FromStart => held || !met,
                Attainable::Never => !met,
            };
            assert!(fits, "{name} tick {}: {goal:?}", state.tick());
        }
        if state.outcome() == Outcome::Won {
            assert!(analysis.can_win(), "{name}");
        }
        if state.outcome() == Outcome::Lost && state.tick() < engine::MAX_TICKS {
            assert!(analysis.can_lose(), "{name}");
        }
    });
}

/// Generated games are not won or lost after their first tick if that is proved impossible, and their sprites
/// stay within their reach.
#[test]
fn any_game_ends_as_proved() {
    let mut sampler = sweep::seed("ends").sampler();
    let (mut proofs, mut ends, games) = (0, 0, sweep::cases(GAMES) as u32);
    for _ in 0..games {
        let length = sampler.between(0, 500);
        let made = any_game(&mut Choices::new(&random_bytes(&mut sampler, length)));
        let Ok(game) = Game::from_source_as_reference(&made.source) else { continue };
        let Ok(level) = game.level(&made.level) else { continue };
        let analysis = Analysis::of(&game);
        proofs += u32::from(!analysis.can_win()) + u32::from(!analysis.can_lose());
        let mut state = game.start(&level, Seed::from_text("ends"));
        let (reach, case) =
            (analysis.reach(&level), Case { name: made.source.clone(), game, levels: Vec::new() });
        for _ in 0..TICKS {
            case.game.step(&mut state, *sampler.choose(&Action::ALL));
            look(&case, &reach, &level, &state);
        }
        if state.tick() > 0 {
            let possible = match state.outcome() {
                Outcome::Won => analysis.can_win(),
                Outcome::Lost => analysis.can_lose(),
                _ => continue,
            };
            assert!(
                possible,
                "{:?} at tick {}\n{}\n{}",
                state.outcome(),
                state.tick(),
                made.source,
                made.level
            );
            ends += 1;
        }
    }
    assert!(proofs > games / 4 && ends > games / 80, "{proofs} proofs, {ends} ends of {games}");
}

/// In hand-written games, every sprite stays where its type can be, whatever the actions.
#[test]
fn sprites_are_where_they_can_be() {
    let mut reach = None;
    let mut looked = 0;
    wander(5, 250, |case, analysis, level, state, _| {
        if state.tick() < 0 {
            reach = Some(analysis.reach(level));
        }
        looked += look(case, reach.as_ref().expect("the start comes first"), level, state);
    });
    assert!(looked > 100_000, "{looked} cells");
}

/// The corpus levels can be won, and no proof denies it.
#[test]
fn the_goals_of_the_corpus_are_in_reach() {
    for Case { name, game, levels } in games(&workspace_root().join("corpora")) {
        let analysis = Analysis::of(&game);
        for level in &levels {
            let reach = analysis.reach(level);
            assert!(!reach.is_coarse() && reach.can_win(), "{name}: {:?}\n{level}", reach.impossible_goals());
        }
    }
}

/// In generated games too, every sprite stays where its type can be.
#[test]
fn sprites_of_generated_games_are_where_they_can_be() {
    let (mut played, mut narrow) = (0, 0);
    for number in 0..INVENTED {
        let seed = sweep::seed("invented").child("game", number);
        let (source, text) = generated::game(&mut seed.child("text", 0).sampler());
        let Ok(game) = Game::from_source(&source) else { continue };
        let Ok(level) = game.level(&text) else { continue };
        let reach = Analysis::of(&game).reach(&level);
        let area = level.columns() * level.rows();
        let is_narrow = |stype: &SpriteType| (1..area / 2).contains(&reach.cells(*stype).count());
        (played, narrow) = (played + 1, narrow + game.sprite_types().filter(is_narrow).count());
        let case = Case { name: format!("game {number}\n{source}"), game, levels: Vec::new() };
        let mut sampler = seed.child("actions", 0).sampler();
        for run in 0..3 {
            let mut state = case.game.start(&level, seed.child("chance", run));
            for _ in 0..60 {
                look(&case, &reach, &level, &state);
                let action = *sampler.choose(case.game.actions(&state));
                case.game.step(&mut state, action);
            }
            look(&case, &reach, &level, &state);
        }
    }
    assert!(
        played > INVENTED / 2 && narrow > played as usize,
        "{played} games, {narrow} types kept in bounds"
    );
}

/// Checks that all sprites in a state are where their types can be, and that the game ends only in ways in
/// which it can end. Returns the number of cells that the sprites cover.
fn look(Case { name, game, .. }: &Case, reach: &Reach, level: &Level, state: &State) -> u64 {
    let lost = state.outcome() == Outcome::Lost && state.tick() < engine::MAX_TICKS;
    assert!(reach.can_win() || state.outcome() != Outcome::Won, "{name} is won\n{level}");
    assert!(reach.can_lose() || !lost, "{name} is lost\n{level}");
    if matches!(state.outcome(), Outcome::Stopped(_)) {
        // The tick was stopped before its end.
        return 0;
    }
    let (columns, rows) = state.size();
    let mut looked = 0;
    for record in game.records(state) {
        let Rect { x, y, w, h } = record.rect;
        let span = |from: i32, size: i32, limit: i32| {
            let last = (from.saturating_add(size) - 1).div_euclid(state.block());
            from.div_euclid(state.block()).max(0)..=last.min(limit - 1)
        };
        for row in span(y, h, rows) {
            for column in span(x, w, columns) {
                looked += 1;
                let cell = (row * columns + column) as usize;
                assert!(
                    reach.can_be(SpriteType(record.stype), cell),
                    "{name} tick {}: {} at column {column}, row {row}\n{level}",
                    state.tick(),
                    game.name(SpriteType(record.stype))
                );
            }
        }
    }
    looked
}
