//! The findings of a panel of judges.

use crate::criterion::Criterion;
use crate::measures::Ladder;
use crate::verdict::{Finding, Verdict};
use engine::{Episode, Outcome};
use serde::Serialize;

/// The message for criteria skipped because the game is won or lost in its first tick, regardless of the player's
/// actions.
pub(crate) const OVER: &str = "skipped: the game is over in its first tick";

/// The finding of one validator.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judgement {
    /// The judged criterion.
    pub criterion: Criterion,
    /// The finding by the criterion's validator.
    #[serde(flatten)]
    pub finding: Finding,
}

/// The findings of all validators on a level.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The judgements, in checking order.
    pub judgements: Vec<Judgement>,
    /// The shortest win found.
    #[serde(skip)]
    pub witness: Option<Episode>,
}

impl Report {
    /// Returns `true` if every criterion is met.
    pub fn passes(&self) -> bool {
        self.judgements.iter().all(|judgement| judgement.finding.verdict.is_pass())
    }

    /// Returns the first unmet criterion; `None` if all criteria are met.
    pub fn first_obstacle(&self) -> Option<&Judgement> {
        self.judgements.iter().find(|judgement| !judgement.finding.verdict.is_pass())
    }

    /// Returns the finding for a criterion, or `None` if the criterion was not checked.
    pub fn finding(&self, criterion: Criterion) -> Option<&Finding> {
        let judgement = self.judgements.iter().find(|judgement| judgement.criterion == criterion)?;
        Some(&judgement.finding)
    }

    /// Returns the results of the ladder (reference players of increasing strength), or `None` if no ladder was played.
    pub fn ladder(&self) -> Option<&Ladder> {
        self.judgements.iter().find_map(|judgement| judgement.finding.ladder.as_ref())
    }

    /// Returns `true` if the level is proven unwinnable.
    pub(crate) fn is_unwinnable(&self) -> bool {
        self.finding(Criterion::Winnable)
            .is_some_and(|finding| matches!(finding.verdict, Verdict::Fail { .. }))
    }

    /// Returns `true` if the engine stops the game in its first tick.
    pub(crate) fn is_stopped(&self) -> bool {
        let verdict = self.finding(Criterion::WellFormed).map(|finding| &finding.verdict);
        matches!(verdict, Some(Verdict::Fail { witness: Some(episode), .. })
            if matches!(episode.outcome, Outcome::Stopped(_)))
    }

    /// Returns `true` if criteria were skipped because the game is over in its first tick.
    pub(crate) fn is_over(&self) -> bool {
        let mut first = self.judgements.iter().filter_map(|judgement| judgement.finding.evidence.first());
        first.any(|seen| seen.text == OVER)
    }

    /// Adopts the witness of a judgement or, if the search found no win, the win of another player.
    pub(crate) fn accept(&mut self, judgement: &mut Judgement) {
        if let (Verdict::Unknown { .. }, Some(won)) = (&judgement.finding.verdict, self.shortest_win()) {
            judgement.finding.verdict = Verdict::Pass { witness: Some(won) };
        }
        if let Verdict::Pass { witness: Some(witness) } = &judgement.finding.verdict {
            self.witness = Some(witness.clone());
        }
    }

    pub(crate) fn shortest_win(&self) -> Option<Episode> {
        let played = self.judgements.iter().flat_map(|judgement| &judgement.finding.episodes);
        let won = played.filter(|episode| episode.outcome == Outcome::Won);
        won.min_by_key(|episode| episode.actions.len()).cloned()
    }

    /// Returns all episodes that the validators played, from most to least informative. The witness comes first,
    /// followed by the episodes of the last validators.
    pub fn episodes(&self) -> Vec<Episode> {
        let played = self.judgements.iter().rev().flat_map(|judgement| {
            let shown = match &judgement.finding.verdict {
                Verdict::Fail { witness, .. } => witness.as_ref(),
                _ => None,
            };
            shown.into_iter().chain(&judgement.finding.episodes)
        });
        self.witness.iter().chain(played).cloned().collect()
    }
}

/// The findings of all validators on a game: on each level, and on the game as a whole.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GameReport {
    /// The reports, in level order.
    pub levels: Vec<Report>,
    /// The judgements, in checking order.
    pub judgements: Vec<Judgement>,
}

impl GameReport {
    /// Returns `true` if every level and the game meet every criterion.
    pub fn passes(&self) -> bool {
        self.levels.iter().all(Report::passes) && self.game_passes()
    }

    /// Returns `true` if the game as a whole meets the criteria.
    pub fn game_passes(&self) -> bool {
        self.judgements.iter().all(|judgement| judgement.finding.verdict.is_pass())
    }
}
