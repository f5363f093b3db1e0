//! The judging of designs.

use super::pool::Design;
use base::SeedPath;
use engine::{Game, Level};
use forge::Tally;
use forge::games::{Candidate, FinishedLevels, Levels, MadeGame};
use generators::games::GeneratedGame;
use validators::novelty::GameForm;
use validators::{CheckedCriteria, Effort, Panel};

/// Judges a design again, with the criteria of a recipe. A design near a known game is rejected.
pub(crate) fn make(
    design: Option<&Design>,
    criteria: &CheckedCriteria,
    known: &[&Vec<GameForm>],
    seed: &SeedPath,
) -> (Vec<MadeGame>, Tally) {
    let mut tally = Tally::default();
    let Some(design) = design else { return (Vec::new(), tally) };
    let finished = Game::from_source(&design.source)
        .ok()
        .and_then(|game| GeneratedGame::finished(&game, &design.name, design.patterns()).ok());
    let Some(game) = finished else {
        tally.game_rejected("the rules do not compile");
        return (Vec::new(), tally);
    };
    let form = GameForm::of(&game.rules);
    if known.iter().any(|forms| forms.iter().any(|other| form.is_near(other))) {
        tally.game_rejected("near a known game");
        return (Vec::new(), tally);
    }
    let levels = design.levels.iter().map(|text| game.rules.level(text).ok());
    let Some(levels) = levels.collect::<Option<Vec<Level>>>() else {
        tally.game_rejected("a level does not load");
        return (Vec::new(), tally);
    };
    let source = FinishedLevels(levels);
    let panel = Panel::new(criteria.clone(), Effort::Sequential);
    let levels = Levels {
        count: source.0.len() as u32,
        tries: 1,
        source: &source,
        criteria,
        panel: &panel,
        seed: &seed.child("levels", 0),
    };
    let made = levels.make(Candidate::generated(game, "design", 0), &mut tally);
    (made.into_iter().collect(), tally)
}
