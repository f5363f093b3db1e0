//! The stage that sets a game's time limit.

use super::game::Trial;
use super::stage::{Passage, Refusal, Stage, walk};
use crate::games::{Candidate, Drawn, FoundLevel, Levels};
use crate::tally::Tally;
use engine::{Episode, Game, Level, Outcome};
use validators::{Cost, Criterion, CriterionSet, Effort, Judgement, Panel, Verdict, ended_share};

/// The numbers of ticks at which games are lost. All are round numbers, as an author would choose.
const TIME_LIMITS: [u32; 9] = [150, 200, 250, 300, 400, 500, 600, 800, 1000];
/// The minimum time limit, as a multiple of the length of the longest known win.
const TIME_PER_WIN: f64 = 2.5;
/// In a game without a time limit, the rules must end at least this fraction of the careless players' episodes,
/// averaged over the levels. Careless players press a random key in some ticks.
const ENDED_PLAYS: f64 = 0.5;
/// The reason counted for a failed attempt to omit the time limit.
const NO_CLOCK: &str = "no time limit";

impl<'a> Trial<'a> {
    pub(super) const TIME_LIMIT: Stage<Self> = Stage {
        name: "time limit",
        purpose: "judges the levels again without a time limit if the rules end careless episodes, \
                  then with the first round limit beyond 2.5 times the longest win; each version goes \
                  through the later stages until a version passes",
        cost: "a second, because wins are replayed, not searched for",
        reasons: &["time limit"],
        ..Stage::versions(Self::limit_time)
    };

    fn limit_time(&mut self, later: &[Stage<Self>], tally: &mut Tally) -> Passage {
        if self.demands.has_clock {
            return self.pass_under_own_limit(later, tally);
        }
        let mut spent = Tally::default();
        if let Some(candidate) = (self.demands.with_limit)(None)
            && self.ends_without_limit(&candidate)
            && let Ok(version) = self.pass_with(candidate, later, &mut spent)
        {
            tally.add(&spent);
            *self = version;
            return Ok(());
        }
        tally.judge(NO_CLOCK, false, spent.calls);
        self.pass_under_own_limit(later, tally)
    }

    /// Takes the game through the later stages with a time limit derived from its longest win.
    fn pass_under_own_limit(&mut self, later: &[Stage<Self>], tally: &mut Tally) -> Passage {
        let wins = self.found.iter().filter_map(|found| found.report.witness.as_ref());
        let longest = wins.map(|win| win.actions.len()).max().ok_or("time limit")?;
        let candidate = (self.demands.with_limit)(Some(time_limit(longest))).ok_or("time limit")?;
        *self = self.pass_with(candidate, later, tally)?;
        Ok(())
    }

    /// Takes a version of the game through the later stages, after rejudging the levels found so far.
    fn pass_with(
        &self,
        candidate: Candidate,
        later: &[Stage<Self>],
        tally: &mut Tally,
    ) -> Result<Trial<'a>, Refusal> {
        let again = self.found.iter().map(|found| self.levels.rejudge(&candidate.game, found, tally));
        let found = again.collect::<Option<Vec<_>>>().ok_or("time limit")?;
        let mut version = Trial { found, ..Trial::new(candidate, self.levels, self.demands) };
        walk(later, &mut version, tally)?;
        Ok(version)
    }

    /// Returns `true` if the rules of a game without a time limit end the episodes of careless players, which press a
    /// random key in some ticks.
    fn ends_without_limit(&self, candidate: &Candidate) -> bool {
        let Levels { criteria, seed, .. } = self.levels;
        let share = |(number, found): (u64, &FoundLevel)| {
            let win = found.report.witness.as_ref()?;
            let seed = seed.seed().child("ends", number);
            Some(ended_share(&candidate.game, &found.level, win, &criteria.gates, seed))
        };
        let shares: Option<Vec<f64>> = (0..).zip(&self.found).map(share).collect();
        shares.is_some_and(|shares| shares.iter().sum::<f64>() >= ENDED_PLAYS * shares.len() as f64)
    }
}

/// Returns the time limit of a game whose longest known win takes `longest` ticks. The limit is one less than a round
/// number, because the game is lost one tick after the limit.
pub(super) fn time_limit(longest: usize) -> u32 {
    let least = longest as f64 * TIME_PER_WIN;
    let round = TIME_LIMITS.into_iter().find(|&limit| f64::from(limit) > least);
    round.unwrap_or_else(|| ((least / 1000.0).floor() as u32 + 1) * 1000) - 1
}

impl Levels<'_> {
    /// Judges a level that was found under a different time limit, using all judges except the ladder of reference
    /// players. Reuses the result of the win search if that win is still valid. The seeds are unchanged, so a replay
    /// ends as before.
    fn rejudge(&self, game: &Game, found: &FoundLevel, tally: &mut Tally) -> Option<FoundLevel> {
        let level = game.level(&found.level.to_string()).ok()?;
        let witness = replayed(game, &level, found.report.witness.as_ref()?);
        let is_won = witness.outcome == Outcome::Won;
        let carried = if is_won { CriterionSet::of(&[Criterion::Winnable]) } else { CriterionSet::default() };
        let criteria = self.criteria.without(carried.with(CriterionSet::costing(Cost::Ladder)));
        let panel = Panel::new(criteria, Effort::Sequential);
        let FoundLevel { difficulty, candidate, .. } = *found;
        let (seed, win) = (found.seed.clone(), is_won.then_some(witness));
        let drawn = Drawn { level, difficulty, candidate, seed, win };
        let mut again = self.judge_drawn(&panel, game, drawn, tally)?;
        let carried =
            found.report.judgements.iter().filter(|judgement| carried.contains(judgement.criterion));
        for mut judgement in carried.cloned() {
            for episode in &mut judgement.finding.episodes {
                *episode = replayed(game, &again.level, episode);
            }
            if let Verdict::Pass { witness: Some(won) } = &mut judgement.finding.verdict {
                *won = replayed(game, &again.level, won);
            }
            again.report.judgements.push(judgement);
        }
        let place_of = |judgement: &Judgement| {
            found.report.judgements.iter().position(|before| before.criterion == judgement.criterion)
        };
        again.report.judgements.sort_by_key(place_of);
        again.asks.clone_from(&found.asks);
        Some(again)
    }
}

/// Replays the actions of an episode in a different game.
fn replayed(game: &Game, level: &Level, played: &Episode) -> Episode {
    let (mut episode, mut state) = Episode::begin(game, level, played.seed);
    for &action in &played.actions {
        episode.play(game, &mut state, action);
    }
    episode.path.clone_from(&played.path);
    episode
}

#[cfg(test)]
mod tests {
    use super::time_limit;

    #[test]
    fn time_limits_are_round_and_generous() {
        for (longest, expect) in [(25, 149), (59, 149), (60, 199), (99, 249), (159, 399), (500, 1999)] {
            assert_eq!(time_limit(longest), expect, "{longest}");
        }
    }
}
