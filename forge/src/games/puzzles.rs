//! Puzzles of pushed things for one game, made to a tier.

use agents::search::{Answer, Pushes, SearchLimits, a_star};
use engine::{Action, Analysis, Episode, Level, Outcome, Seed};
use generators::GenerateError;
use generators::levels::{LevelConfig, PuzzleConfig, PuzzleTarget, PuzzleVariation};
use validators::Tier;

/// The request for the puzzles of a game.
#[derive(Clone, Debug)]
pub struct PuzzleLevels {
    /// The sizes of the boards.
    pub config: LevelConfig,
    /// The tier of each level.
    pub tiers: Vec<Tier>,
}

/// The maximum number of floor plans to examine for a level.
const FLOOR_PLANS: usize = 20_000;

impl PuzzleLevels {
    /// The tier of a place.
    pub(super) fn tier(&self, number: u32) -> Tier {
        self.tiers.get(number as usize).copied().unwrap_or(Tier::Four)
    }

    /// The generator for a place.
    pub(super) fn generator<'a>(
        &self,
        game: &'a engine::Game,
        number: u32,
    ) -> Result<PuzzleVariation<'a>, GenerateError> {
        let puzzle = PuzzleConfig {
            floor_plans: FLOOR_PLANS,
            target: Some(target(self.tier(number))),
            ..PuzzleConfig::default()
        };
        PuzzleVariation::new(game, self.config.clone(), puzzle)
    }
}

/// The target for a tier. The generator counts the actions of a win with the fewest pushes; the shortest win has fewer, so
/// there is a margin.
fn target(tier: Tier) -> PuzzleTarget {
    let pushes = match tier {
        Tier::One => 4,
        Tier::Two => 12,
        Tier::Three => 30,
        Tier::Four => 60,
    };
    let decisions = tier.bounds().decisions;
    PuzzleTarget { pushes, decisions: decisions + decisions / 8 }
}

/// The win of a puzzle: the shortest, if `calls` forward-model calls suffice to prove it, or else the one that the generator
/// knows. Also returns whether it is proved to be the shortest, and the calls. `None` if the known actions do not win.
pub(super) fn win(
    analysis: &Analysis,
    level: &Level,
    known: Vec<Action>,
    calls: u64,
    seed: Seed,
) -> Option<(Episode, bool, u64)> {
    let game = analysis.game();
    let start = game.start(level, seed);
    let searched = a_star(analysis, &Pushes::of(analysis, level), &start, SearchLimits::calls(calls));
    let (actions, shortest) = match searched.answer {
        Answer::Won { actions, shortest } => (actions, shortest),
        _ => (known, false),
    };
    let (mut episode, mut state) = Episode::begin(game, level, seed);
    for action in actions {
        episode.play(game, &mut state, action);
    }
    (episode.outcome == Outcome::Won).then_some((episode, shortest, searched.calls))
}

#[cfg(test)]
mod tests {
    use generators::games::PushRules;
    use validators::GameForm;

    /// No two games of a release are duplicates.
    #[test]
    fn rules_of_pushing_differ() {
        let forms: Vec<GameForm> = PushRules::ALL.iter().map(|rules| GameForm::of(&rules.game())).collect();
        for (at, form) in forms.iter().enumerate() {
            let near = forms[..at].iter().position(|other| form.is_near(other));
            let name = PushRules::ALL[at].name();
            assert_eq!(near.map(|other| PushRules::ALL[other].name()), None, "{name}");
        }
    }
}
