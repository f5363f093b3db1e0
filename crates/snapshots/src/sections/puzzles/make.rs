//! The generation of puzzles of every kind.

use super::PuzzleKind;
use crate::recipe::Recipe;
use base::{Seed, SeedPath};
use engine::{Game, syntax};
use forge::Tally;
use forge::card::Origin;
use forge::games::{Candidate, Levels, MadeGame, PuzzleLevels, PuzzleRules};
use generators::games::{LockRules, PushRules, Rethemed, YardRules};
use generators::levels::LevelConfig;
use validators::{CheckedCriteria, Effort, Panel};

/// The maximum number of renamings to draw in search of one that uses the puzzle's scene (theme).
const FICTIONS: u64 = 400;

/// A request for one puzzle.
pub(crate) struct Request {
    pub(crate) kind: PuzzleKind,
    /// The job's number among the jobs of its kind.
    pub(crate) number: u32,
    /// The job's number among all puzzle jobs.
    pub(crate) place: usize,
}

/// Generates a puzzle in its own scene (theme), with levels from the lowest to the highest requested tier (difficulty
/// class). `root` is the release's seed, and `seed` is the job's seed.
pub(crate) fn make(
    recipe: &Recipe,
    criteria: &CheckedCriteria,
    &Request { kind, number, place }: &Request,
    root: Seed,
    seed: &SeedPath,
) -> (Vec<MadeGame>, Tally) {
    let mut tally = Tally::default();
    let Some(part) = recipe.puzzles_of(kind) else { return (Vec::new(), tally) };
    let at = number as usize % kind.rules();
    let (plain, name) = kind.plain(at);
    let mut scenes: Vec<&str> = Rethemed::scenes().collect();
    root.child("themes", 0).sampler().shuffle(&mut scenes);
    let scene = scenes[place % scenes.len()];
    let fictions =
        (0..FICTIONS).map(|draw| Rethemed::of_compounds(&plain, seed.seed().child("fiction", draw)));
    let retold = fictions.filter_map(Result::ok).find(|retold| retold.scene == scene);
    let Some(retold) = retold else {
        tally.game_rejected("no fiction fits");
        return (Vec::new(), tally);
    };
    let Ok(game) = Game::from_source(&syntax::print(&retold.description)) else {
        tally.game_rejected("the rules do not compile");
        return (Vec::new(), tally);
    };
    let rules = match kind {
        PuzzleKind::Pushing => PuzzleRules::Pushing,
        PuzzleKind::Locks => PuzzleRules::locks(LockRules::ALL[at], &retold),
        PuzzleKind::Yards => PuzzleRules::yards(YardRules::ALL[at], &retold),
        PuzzleKind::Strays => PuzzleRules::strays(PushRules::AMONG_STRAYS[at], &retold),
    };
    let candidate = Candidate {
        title: retold.title,
        description: retold.summary,
        goal: retold.goal,
        kind: "puzzle".to_owned(),
        real_time: false,
        origin: Origin::Generated {
            generator: "puzzle".to_owned(),
            patterns: vec![format!("puzzle/{name}")],
            candidate: 0,
        },
        game,
    };
    let of_tiers = recipe.tiers.levels(part.levels);
    let tiers = of_tiers.flat_map(|(tier, levels)| std::iter::repeat_n(tier, levels as usize)).collect();
    let config = LevelConfig { columns: part.columns, rows: part.rows, ..LevelConfig::default() };
    let puzzles = PuzzleLevels { config, tiers, rules, things: part.things as usize };
    let panel = Panel::new(criteria.clone(), Effort::Sequential);
    let levels = Levels {
        count: part.levels,
        tries: part.level_tries,
        source: &puzzles,
        criteria,
        panel: &panel,
        seed: &seed.child("levels", 0),
    };
    let made = levels.make(candidate, &mut tally);
    (made.into_iter().collect(), tally)
}
