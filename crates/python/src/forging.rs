//! Judges and generates levels and games, and checks snapshots. Results are returned as JSON, in the format
//! of the command line.

use crate::corpus::corpus;
use crate::errors::{failed, invalid};
use crate::game::{Game, Level};
use crate::interrupt::interruptible;
use base::{Digest, Seed};
use engine::SpriteType;
use forge::games::{GameOrder, MadeGame, invent_games, make_games, slug};
use forge::levels::{LevelOrder, Method, make_levels};
use generators::games::Kind;
use generators::kernels;
use generators::levels::{Examples, LevelConfig};
use pyo3::prelude::*;
use serde_json::{Value, json};
use snapshots::{Bounds, check_integrity, verify_within};
use std::path::PathBuf;
use std::sync::Arc;
use validators::{Criteria, Effort, GameForm, Judging, Panel};

/// The ranges for a board's number of columns and number of rows.
type Size = ((usize, usize), (usize, usize));

/// Judges a level by a release's criteria, like `arcade validate`. Returns the report.
#[pyfunction]
#[pyo3(signature = (level, *, budget, seed))]
pub(crate) fn validate(py: Python<'_>, level: &Level, budget: u64, seed: &str) -> PyResult<String> {
    let (level, seed) = (level.clone(), Seed::from_text(seed));
    interruptible(py, move |_| {
        let (game, level) = (&level.game.0.game, &level.level);
        let criteria = Criteria { budget, ..Criteria::full() };
        let panel = Panel::new(criteria.check().map_err(invalid)?, Effort::Calls(budget));
        let seed = seed.child(&level.digest().to_string(), 0);
        let report = panel.judge(Judging::level(game, level, seed));
        let witness = report.witness.clone();
        let mut document = serde_json::to_value(&report).map_err(failed)?;
        document["passes"] = Value::Bool(report.passes());
        document["witness"] = json!(witness);
        serde_json::to_string(&document).map_err(failed)
    })
}

/// Generates levels for a game, like `arcade generate levels`. Returns the levels with their witnesses, and
/// the cost.
#[pyfunction]
#[pyo3(signature = (game, examples, *, method, count, seed, difficulty = None, size = None, min_solution = None, verified = false, sprites = Vec::new()))]
#[allow(clippy::too_many_arguments, reason = "each option of `arcade generate levels` is an argument")]
pub(crate) fn generate_levels(
    py: Python<'_>,
    game: &Game,
    examples: Vec<Bound<'_, Level>>,
    method: &str,
    count: u32,
    seed: &str,
    difficulty: Option<&str>,
    size: Option<Size>,
    min_solution: Option<usize>,
    verified: bool,
    sprites: Vec<(String, usize)>,
) -> PyResult<String> {
    let examples: Vec<engine::Level> =
        examples.iter().map(|level| level.get().level.as_ref().clone()).collect();
    let (game, seed) = (game.clone(), Seed::from_text(seed));
    let method: Method = method.parse().map_err(invalid)?;
    let difficulty = difficulty.map(str::parse).transpose().map_err(invalid)?;
    // A minimum length makes the generator judge every level. One tick excludes no level, because every win
    // lasts at least one tick.
    let min_solution = min_solution.or(verified.then_some(1));
    interruptible(py, move |interrupt| {
        let game = &game.0.game;
        let stype = |name: &String| -> PyResult<SpriteType> {
            let found = game.sprite_type(name);
            found.ok_or_else(|| invalid(format_args!("the game has no sprite type `{name}`")))
        };
        let config = Examples::of(game, &examples)
            .map_or_else(LevelConfig::default, |examples| LevelConfig::like(Arc::new(examples)));
        let config = match size {
            Some((columns, rows)) => LevelConfig { columns, rows, ..config },
            None => config,
        };
        let counts = sprites.iter().map(|(name, count)| Ok((stype(name)?, *count)));
        let counts = counts.collect::<PyResult<Vec<_>>>()?;
        let order = LevelOrder {
            difficulty,
            min_solution,
            ..LevelOrder::new(method, count, LevelConfig { counts, ..config })
        };
        let set = make_levels(game, &order, seed.child(method.name(), 0), interrupt).map_err(failed)?;
        let level = |made: &forge::levels::MadeLevel| {
            let witness = made.report.as_ref().and_then(|report| report.witness.as_ref());
            json!({
                "number": made.number,
                "text": made.level.to_string(),
                "digest": made.level.digest(),
                "witness": witness,
                "verified": made.report.is_some(),
                "difficulty": made.ladder.as_ref().map(|ladder| ladder.difficulty),
                "report": made.report,
            })
        };
        let levels: Vec<Value> = set.levels.iter().map(level).collect();
        let document = json!({ "game": game.digest(), "levels": levels, "cost": set.tally.level_cost() });
        serde_json::to_string(&document).map_err(failed)
    })
}

/// Generates games, like `arcade generate games`.
#[pyfunction]
#[pyo3(signature = (*, kinds, method, count, levels, seed))]
pub(crate) fn generate_games(
    py: Python<'_>,
    kinds: Vec<String>,
    method: &str,
    count: u32,
    levels: u32,
    seed: &str,
) -> PyResult<String> {
    let method: Method = method.parse().map_err(invalid)?;
    let kind = |name: &String| {
        let all = || kernels::kinds().map(Kind::name).collect::<Vec<_>>().join(", ");
        let found = kernels::kinds().find(|kind| kind.name() == name);
        found.ok_or_else(|| invalid(format!("unknown kind `{name}`; the kinds are {}", all())))
    };
    let kinds: Vec<Kind> = kinds.iter().map(kind).collect::<PyResult<_>>()?;
    if !kinds.is_empty() && method != Method::Constructive {
        return Err(invalid(format!(
            "kinds select hand-written kernels, which the method `{method}` does not use: omit the method \
             or the kinds"
        )));
    }
    let seed = Seed::from_text(seed).child(method.name(), 0);
    interruptible(py, move |interrupt| {
        let known = corpus().into_iter().map(|(_, source, ..)| engine::Game::from_source(&source));
        let known: Vec<GameForm> = known.flatten().map(|game| GameForm::of(&game)).collect();
        let canary = snapshots::canary(&Digest::of(seed.child("canary", 0).to_string().as_bytes()));
        let set = match kinds.is_empty() {
            true => {
                let order = GameOrder::of_inventions(method, count).with_levels(levels);
                invent_games(&order, &known, &canary, seed, interrupt)
            }
            false => {
                let order = GameOrder { kinds, ..GameOrder::new(count) }.with_levels(levels);
                make_games(&order, &known, &canary, seed, interrupt)
            }
        };
        let set = set.map_err(failed)?;
        let game = |made: &MadeGame| {
            let levels: Vec<String> = made.levels.iter().map(|found| found.level.to_string()).collect();
            let title = &made.card.title;
            let id = format!("{}-{}", slug(title), made.game.digest().short());
            json!({
                "id": id,
                "title": title,
                "source": made.text,
                "levels": levels,
                "card": made.card,
                "witnesses": made.witnesses,
            })
        };
        let games: Vec<Value> = set.games.iter().map(game).collect();
        serde_json::to_string(&json!({ "games": games })).map_err(failed)
    })
}

/// Verifies a release folder or archive, like `arcade verify`. Checks the digests, the games, the levels and
/// every witness.
#[pyfunction]
pub(crate) fn verify(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    let verification = interruptible(py, move |_| verify_within(&path, &Bounds::RELEASE).map_err(failed))?;
    serde_json::to_string(&verification).map_err(failed)
}

/// Checks the digests in a release folder. Returns the manifest and the problems found.
#[pyfunction]
pub(crate) fn integrity(py: Python<'_>, path: PathBuf) -> PyResult<(String, Vec<String>)> {
    let integrity = py.detach(|| check_integrity(&path)).map_err(failed)?;
    let manifest = serde_json::to_string(&integrity.manifest).map_err(failed)?;
    Ok((manifest, integrity.problems.iter().map(ToString::to_string).collect()))
}
