//! The maximum number of games that a recipe can have.

use super::{Job, Plan};
use crate::mint::error::MintError;
use crate::sections::puzzles::PuzzleKind;
use base::Seed;
use forge::games::RuleSets;
use forge::well::left;
use validators::novelty::GameForm;

/// The maximum number of games for which the rule sets need not be counted, because the first rule sets of all kernels
/// (hand-written designs) suffice.
const FEW: usize = 40;

/// The number of rule sets to draw per invented game. Nine in ten rule sets have no board that passes, and
/// near-duplicates among a month's candidates are dropped.
const SETS_OF_A_GAME: f64 = 16.0;

impl Plan<'_> {
    /// Checks that there are enough rule sets for the requested number of games, with any seed. If the recipe
    /// requests most of the new games that are possible, returns the maximum number of new games. Some candidates
    /// fail, so fewer games may pass than requested.
    ///
    /// Cost: a fraction of a second if the recipe requests more games than there are kernels.
    ///
    /// # Errors
    /// Returns an error if there are fewer rule sets than games.
    pub fn supply(&self) -> Result<Option<usize>, MintError> {
        if !self.before.is_empty() {
            PuzzleKind::ALL.into_iter().try_for_each(|kind| self.puzzle_supply(kind))?;
        }
        let invented = self.invented_supply()?;
        Ok(self.generated_supply()?.or(invented))
    }

    /// Checks that there are enough kernels (hand-written designs) for the new games.
    fn generated_supply(&self) -> Result<Option<usize>, MintError> {
        let part = &self.recipe.generated;
        let asked = part.games as usize;
        if asked == 0 || (asked <= FEW && part.kinds.is_empty() && self.before.is_empty()) {
            return Ok(None);
        }
        let most = RuleSets::supply(&self.order(1).kinds, &self.forms, &self.before);
        let most = most.min(self.generated().count());
        if most >= asked {
            return Ok((most < asked + asked / 4).then_some(most));
        }
        let kinds = part.kinds.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(", ");
        let (of, more) = match part.kinds.is_empty() {
            true => (String::new(), ""),
            false => (format!(" of the kinds {kinds}"), ", or list more kinds"),
        };
        let new = if self.before.is_empty() { "" } else { " that no earlier release has used" };
        Err(MintError::Unfillable {
            part: "generated",
            asked,
            most,
            why: format!(
                "no two games share their rules, and a recipe can count on only {most} sets of rules{of}{new}"
            ),
            advice: format!("lower `generated.games` to {most} or less{more}"),
        })
    }

    /// Checks that there are enough mechanics for the invented games, by estimating the number of rule sets that are
    /// not near a known game.
    fn invented_supply(&self) -> Result<Option<usize>, MintError> {
        let asked = self.recipe.invented.as_ref().map_or(0, |part| part.games as usize);
        if asked <= FEW && (asked == 0 || self.before.is_empty()) {
            return Ok(None);
        }
        // Without earlier releases, there are so few known games that they do not matter.
        let known: Vec<GameForm> = match self.before.is_empty() {
            true => Vec::new(),
            false => self.forms.iter().chain(&self.before).cloned().collect(),
        };
        // The estimate depends on the recipe, not on its seed.
        let sets = left(&self.recipe.known.census(), &known, Seed::from_text("supply of invented games"));
        invented_of(sets, asked, !self.before.is_empty())
    }

    /// Checks that earlier releases have left enough rules unused for one kind of puzzle.
    fn puzzle_supply(&self, kind: PuzzleKind) -> Result<(), MintError> {
        let asked = self.recipe.puzzles_of(kind).map_or(0, |part| part.games as usize);
        let is_open = |job: &&Job| match **job {
            Job::Puzzle(of, number) => {
                let form = || kind.form(number as usize % kind.rules());
                of == kind && !self.before.iter().any(|known| known.is_near(&form()))
            }
            _ => false,
        };
        let most = self.jobs().iter().filter(is_open).count();
        if most >= asked {
            return Ok(());
        }
        let part = kind.section();
        Err(MintError::Unfillable {
            part,
            asked,
            most,
            why: "earlier releases have used the other sets of rules".to_owned(),
            advice: format!(
                "lower `{part}.games`, leave the section out, or begin a new chain without --parent"
            ),
        })
    }
}

/// Checks that the given number of rule sets suffices for a recipe's invented games. Returns the maximum
/// number of invented games if the recipe requests most of them.
fn invented_of(sets: f64, asked: usize, is_later: bool) -> Result<Option<usize>, MintError> {
    let most = (sets / SETS_OF_A_GAME) as usize;
    if most >= asked {
        return Ok((most < asked + asked / 4).then_some(most));
    }
    let new = if is_later { " that no earlier release has used" } else { "" };
    Err(MintError::Unfillable {
        part: "invented",
        asked,
        most,
        why: format!(
            "the mechanics allow about {sets:.0} sets of rules{new}, of which one in {SETS_OF_A_GAME} may become a game"
        ),
        advice: format!("lower `invented.games` to {most} or less, or add mechanics"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invented_games_need_rules() {
        assert_eq!(invented_of(16_000.0, 100, false).unwrap(), None);
        assert_eq!(invented_of(16_000.0, 900, true).unwrap(), Some(1000));
        let error = invented_of(16_000.0, 1001, true).unwrap_err().to_string();
        assert!(error.contains("`invented.games` is 1001, but the limit is 1000"), "{error}");
        assert!(error.contains("about 16000 sets of rules that no earlier release has used"), "{error}");
    }
}
