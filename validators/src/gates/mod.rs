//! Gates: criteria that measure what people notice when they play a game's levels in order. `docs/reference/gates.md`
//! explains each gate, with the evidence for its thresholds.
//!
//! A gate examines the shortest known win of each level. Levels without a known win are skipped. The figure in a
//! finding is intended for tables; see [`Finding::figure`].

pub(crate) mod actors_matter;
mod careless;
pub(crate) mod drama;
mod elements;
pub(crate) mod necessity;
pub(crate) mod no_dead_time;
pub(crate) mod not_instant;
pub(crate) mod open_ground;
pub(crate) mod progression;
mod thresholds;
pub(crate) mod tight;

pub(crate) use careless::CarelessPlays;
use careless::WonLevel;

pub use careless::ended_share;
pub use not_instant::NotInstant;
pub use open_ground::OpenGround;
pub use thresholds::Gates;

use crate::criteria::with_count;
use crate::evidence::Evidence;
use crate::validator::GameCase;
use crate::verdict::{Finding, Verdict};
use engine::Outcome;

/// Returns the levels with a known win, in the game's order, or `None` if there are none.
fn won_levels<'a>(case: GameCase<'a>) -> Option<Vec<WonLevel<'a>>> {
    let won = |(number, recorded): (usize, &crate::Recorded<'a>)| {
        let wins = recorded.episodes.iter().filter(|episode| episode.outcome == Outcome::Won);
        let win = wins.min_by_key(|episode| episode.actions.len())?;
        Some(WonLevel { number, level: recorded.level, win })
    };
    let won: Vec<WonLevel<'a>> = case.recording.iter().enumerate().filter_map(won).collect();
    (!won.is_empty()).then_some(won)
}

/// Returns an unknown verdict, with the reason why the gate does not apply to the game.
fn without_subject(why: &str) -> Finding {
    Finding::from(Verdict::Unknown { spent: 0 }).seen([Evidence::new(why)])
}

/// A gate's message for games without a known win.
const NO_WIN: &str = "skipped: no win of any level is known";

/// Returns a gate's finding. The gate fails if there are problems, of which the most important comes first.
fn finding(problems: Vec<Evidence>, notes: Vec<Evidence>, figure: Option<f64>) -> Finding {
    let verdict = match problems.first() {
        None => Verdict::pass(),
        Some(first) => Verdict::fail(with_count(&first.text, problems.len() - 1)),
    };
    Finding { figure, ..Finding::from(verdict).seen(problems).seen(notes) }
}

/// Returns the finding for a gate that makes a single statement. If the game fails, the statement is the problem; if
/// the game passes, it is a note.
fn measured(passes: bool, seen: Evidence, figure: f64) -> Finding {
    match passes {
        true => finding(Vec::new(), vec![seen], Some(figure)),
        false => finding(vec![seen], Vec::new(), Some(figure)),
    }
}

#[cfg(test)]
mod tests {
    use crate::{Criteria, Criterion, CriterionSet, Effort, Finding, Gates, Judging, Panel};
    use base::Seed;
    use engine::Game;

    /// Judges a game by one gate, with wins found by the `winnable` search.
    pub(super) fn judged(
        gate: Criterion,
        source: &str,
        levels: &[&str],
        alter: impl Fn(&mut Gates),
    ) -> Finding {
        let game = Game::from_source(source).unwrap();
        let levels: Vec<_> = levels.iter().map(|level| game.level(level).unwrap()).collect();
        let mut criteria = Criteria {
            ask: CriterionSet::of(&[Criterion::Winnable, gate]),
            budget: 30_000,
            foresight: 0.4,
            ..Criteria::default()
        };
        alter(&mut criteria.gates);
        let panel = Panel::new(criteria.check().unwrap(), Effort::Full);
        let report = panel.judge(Judging::game(&game, &levels, Seed::from_text("gates")));
        report.judgements.into_iter().next().unwrap().finding
    }

    /// Checks that a gate passes, or that it fails with the words in `fails`.
    #[track_caller]
    pub(super) fn check(gate: Criterion, source: &str, levels: &[&str], fails: Option<&str>) {
        let finding = judged(gate, source, levels, |_| ());
        match (&finding.verdict, fails) {
            (crate::Verdict::Pass { .. }, None) => {}
            (crate::Verdict::Fail { reason, .. }, Some(words)) if reason.0.contains(words) => {}
            _ => panic!("{finding:#?}"),
        }
    }
}
