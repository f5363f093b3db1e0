//! Tests of twins of corpus games, which have the same mechanics but different names, characters or orientation.

use agents::{PortfolioConfig, Solution, solve};
use base::Seed;
use engine::{Analysis, Episode, Game, Outcome};
use rayon::prelude::*;
use snapshots::released::{ReleasedGame, ReleasedLevel};
use snapshots::twin::{self, Twin, TwinError, TwinGame};
use std::fs;
use std::path::Path;
use validators::GameForm;

/// A corpus game with witnesses. It includes only those of its first levels that are won quickly.
struct Sample {
    name: String,
    source: String,
    levels: Vec<String>,
    witnesses: Vec<Episode>,
    /// `true` if the game is stochastic.
    chance: bool,
}

fn sample(folder: &Path) -> Option<Sample> {
    let source = fs::read_to_string(folder.join("game.vgdl")).ok()?;
    let game = Game::from_source(&source).unwrap();
    let analysis = Analysis::of(&game);
    let config = PortfolioConfig { budget: 20_000, shortest: 0.0, ..PortfolioConfig::default() };
    let (mut levels, mut witnesses) = (Vec::new(), Vec::new());
    for number in 0..3 {
        let text = fs::read_to_string(folder.join(format!("lvl{number}.txt"))).unwrap();
        let level = game.level(&text).unwrap();
        let solved = solve(&analysis, &level, &config, Seed::from_text("sample"));
        if let Solution::Won { episode, .. } = solved.solution {
            levels.push(text);
            witnesses.push(*episode);
        }
    }
    let name = folder.file_name()?.to_string_lossy().into_owned();
    Some(Sample { name, source, levels, witnesses, chance: analysis.is_stochastic() })
}

fn samples() -> Vec<Sample> {
    let corpora = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpora");
    let mut folders: Vec<_> = fs::read_dir(corpora).unwrap().flatten().map(|entry| entry.path()).collect();
    folders.sort();
    let samples: Vec<Sample> = folders.par_iter().filter_map(|folder| sample(folder)).collect();
    let won = samples.iter().filter(|sample| !sample.witnesses.is_empty()).count();
    assert!(samples.len() >= 20 && won >= 15, "{won} of {} games", samples.len());
    samples
}

fn of(sample: &Sample, kind: Twin) -> Result<TwinGame, TwinError> {
    twin::of_game(kind, &sample.source, &sample.levels, &sample.witnesses)
}

/// Loads a twin (a copy of a game with a different surface), and replays its witnesses.
fn check(sample: &Sample, twin: &TwinGame) -> Game {
    let name = &sample.name;
    let game = Game::from_source(&twin.text).unwrap_or_else(|problems| panic!("{name}: {problems}"));
    assert_eq!(twin.levels.len(), sample.levels.len(), "{name}");
    assert_eq!(twin.witnesses.len(), sample.levels.len(), "{name}");
    for (level, witness) in twin.levels.iter().zip(&twin.witnesses) {
        let level = game.level(level).unwrap_or_else(|problems| panic!("{name}: {problems}"));
        if let Some(witness) = witness {
            let end = witness.replay(&game, &level).unwrap_or_else(|problem| panic!("{name}: {problem}"));
            assert_eq!(end.outcome(), Outcome::Won, "{name}");
        }
    }
    assert!(!twin.title.is_empty() && twin.description.ends_with('.') && twin.goal.ends_with('.'), "{name}");
    game
}

#[test]
fn twins_have_the_mechanics_of_their_originals() {
    let samples = samples();
    samples.par_iter().for_each(|sample| {
        let form = GameForm::of(&Game::from_source(&sample.source).unwrap()).digest();
        for kind in [Twin::Masked, Twin::Renamed] {
            let twin = of(sample, kind).unwrap();
            assert_eq!(twin, of(sample, kind).unwrap(), "{}", sample.name);
            assert_eq!(GameForm::of(&check(sample, &twin)).digest(), form, "{} {kind}", sample.name);
            for (own, known) in twin.witnesses.iter().zip(&sample.witnesses) {
                let own = own.as_ref().unwrap_or_else(|| panic!("{} {kind}: no witness", sample.name));
                assert_eq!((&own.hashes, own.score), (&known.hashes, known.score), "{} {kind}", sample.name);
            }
        }
    });
    samples.par_iter().for_each(mirrored);
}

/// Checks that a corpus game has a mirror image that is equally winnable.
fn mirrored(sample: &Sample) {
    let name = &sample.name;
    let twin = of(sample, Twin::Mirrored).unwrap_or_else(|problem| panic!("{name}: {problem}"));
    check(sample, &twin);
    let without = twin.witnesses.iter().filter(|witness| witness.is_none()).count();
    // In a stochastic game, the win may be a different one. In a deterministic game, the mirrored actions win
    // with the same score.
    assert!(without == 0 || sample.chance, "{name}");
    for (own, known) in twin.witnesses.iter().zip(&sample.witnesses).filter(|_| !sample.chance) {
        let own = own.as_ref().unwrap_or_else(|| panic!("{name}: no witness"));
        assert_eq!((own.actions.len(), own.score), (known.actions.len(), known.score), "{name}");
    }
    // The mirror image of the mirror image is the original.
    let again = twin::of_game(Twin::Mirrored, &twin.text, &twin.levels, &[]);
    let again = again.unwrap_or_else(|problem| panic!("{name}: {problem}"));
    let clauses = |source: &str| Game::from_source(source).unwrap().clauses();
    assert_eq!(clauses(&again.text), clauses(&sample.source), "{name}");
}

/// The example in `docs/how-to/twins.md` has exactly these twins.
#[test]
fn the_page_shows_real_twins() {
    let page = include_str!("../../../../docs/how-to/twins.md");
    let blocks: Vec<&str> =
        page.split("```").skip(1).step_by(2).filter(|block| !block.starts_with("sh")).collect();
    let block = |number: usize| blocks[number].split_once('\n').unwrap().1;
    let levels = vec![block(1).to_owned()];
    for (number, kind) in [Twin::Masked, Twin::Mirrored, Twin::Renamed].into_iter().enumerate() {
        let twin = twin::of_game(kind, block(0), &levels, &[]).unwrap();
        assert_eq!(block(2 * number + 2), twin.text, "{kind}");
        assert_eq!(block(2 * number + 3), twin.levels[0], "{kind}");
        assert_eq!(twin.witnesses, [None]);
    }
}

#[test]
fn invalid_games_and_levels_are_reported() {
    let game = Game::from_source(FLAT).unwrap();
    assert!(game.level("A e\n").is_ok());
    let of = |source: &str, level: &str| {
        twin::of_game(Twin::Masked, source, &["A e\n".to_owned(), level.to_owned()], &[])
    };
    let told = |problem: TwinError| problem.to_string();
    assert!(told(of("BasicGame\n", "A e\n").unwrap_err()).starts_with("not a valid game: "));
    assert!(told(of(FLAT, "A?e\n").unwrap_err()).starts_with("lvl1.txt is not a level of this game: "));
}

const FLAT: &str = "BasicGame
  SpriteSet
    exit > Door
    avatar > MovingAvatar
  LevelMapping
    e > exit
  InteractionSet
    exit avatar > killSprite
  TerminationSet
    SpriteCounter stype=exit win=True
";

/// A mirrored twin keeps the card's texts unless they mention a side.
#[test]
fn cards_are_mirrored_with_their_games() {
    let told = |description: &str| {
        let game = Game::from_source(FLAT).unwrap();
        let card = serde_json::json!({
            "canary": "c", "id": "flat", "title": "Flat", "description": description, "goal": "Leave.",
            "kind": "escape", "real_time": false, "deterministic": true, "digest": game.digest(),
            "origin": { "from": "corpus", "name": "flat" }, "rules": "", "levels": [],
        });
        let text = "A  e\n".to_owned();
        let level = ReleasedLevel { level: game.level(&text).unwrap(), text, witness: None, second: None };
        let card = serde_json::from_value(card).unwrap();
        let source = format!("# Flat\n# canary c\n{FLAT}");
        let released = ReleasedGame { card, source, game, levels: vec![level], sibling: None };
        twin::of_released(Twin::Mirrored, &released).unwrap()
    };
    let twin = told("A way out.");
    assert_eq!((twin.description.as_str(), twin.goal.as_str()), ("A way out.", "Leave."));
    assert_eq!((twin.title.as_str(), twin.levels[0].as_str()), ("Flat", "e  A\n"));
    assert!(twin.text.starts_with("# Flat\n# canary c\nBasicGame\n"), "{}", twin.text);
    assert_eq!(
        told("The way out is on the right.").description,
        "You are the avatar: the arrow keys move you up, left, down and right."
    );
}
