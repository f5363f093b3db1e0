//! Gates: criteria of a game with its levels in order that measure what people see in play. `docs/gates.md` explains each,
//! with the evidence for its thresholds.
//!
//! A gate looks at the shortest known win of each level; levels without a known win are left out. Figures of a finding are for
//! tables: [`Finding::figure`].

mod actors_matter;
mod careless;
mod drama;
mod elements;
mod necessity;
mod no_dead_time;
mod not_instant;
mod open_ground;
mod progression;
mod thresholds;
mod tight;

pub(crate) use careless::CarelessPlays;

pub use actors_matter::ActorsMatter;
pub use careless::ended_share;
pub use drama::Drama;
pub use necessity::Necessity;
pub use no_dead_time::NoDeadTime;
pub use not_instant::NotInstant;
pub use open_ground::OpenGround;
pub use progression::Progression;
pub use thresholds::Gates;
pub use tight::Tight;

use crate::evidence::Evidence;
use crate::game_report::{GameCase, GameValidator};
use crate::rule_use::with_count;
use crate::verdict::{Finding, Verdict};
use engine::{Episode, Level, Outcome};

/// The names of the gates, in the order of checking: the cheapest first.
pub const GATES: &[&str] = &[
    "open-ground",
    "progression",
    "drama",
    "no-dead-time",
    "not-instant",
    "actors-matter",
    "tight",
    "necessity",
];

/// Returns all gates with these thresholds, in the order of [`GATES`].
pub(crate) fn all(gates: &Gates) -> [Box<dyn GameValidator + Send>; 8] {
    [
        Box::new(OpenGround(gates.clone())),
        Box::new(Progression(gates.clone())),
        Box::new(Drama(gates.clone())),
        Box::new(NoDeadTime(gates.clone())),
        Box::new(NotInstant(gates.clone())),
        Box::new(ActorsMatter(gates.clone())),
        Box::new(Tight(gates.clone())),
        Box::new(Necessity(gates.clone())),
    ]
}

/// A level with the shortest win that is known.
#[derive(Clone, Copy)]
struct WonLevel<'a> {
    /// Its number in the game, from 0.
    number: usize,
    level: &'a Level,
    win: &'a Episode,
}

impl WonLevel<'_> {
    /// Ticks of the win.
    fn ticks(&self) -> usize {
        self.win.actions.len()
    }
}

/// Returns the levels of which a win is known, in order; none if there are none.
fn won_levels<'a>(case: GameCase<'a>) -> Option<Vec<WonLevel<'a>>> {
    let won = |(number, recorded): (usize, &crate::Recorded<'a>)| {
        let wins = recorded.episodes.iter().filter(|episode| episode.outcome == Outcome::Won);
        let win = wins.min_by_key(|episode| episode.actions.len())?;
        Some(WonLevel { number, level: recorded.level, win })
    };
    let won: Vec<WonLevel<'a>> = case.recording.iter().enumerate().filter_map(won).collect();
    (!won.is_empty()).then_some(won)
}

/// Returns the finding of a gate that has nothing to judge.
fn without_subject(why: &str) -> Finding {
    Finding::from(Verdict::Unknown { spent: 0 }).seen([Evidence::new(why)])
}

/// The message of a gate for games without a known win.
const NO_WIN: &str = "skipped: no win of any level is known";

/// Returns the finding of a gate: it fails if there are problems, the most important first.
fn finding(problems: Vec<Evidence>, notes: Vec<Evidence>, figure: Option<f64>) -> Finding {
    let verdict = match problems.first() {
        None => Verdict::pass(),
        Some(first) => Verdict::fail(with_count(&first.text, problems.len() - 1)),
    };
    Finding { figure, ..Finding::from(verdict).seen(problems).seen(notes) }
}

/// Returns the finding of a gate that says one thing, which is a problem unless the game passes.
fn measured(passes: bool, seen: Evidence, figure: f64) -> Finding {
    match passes {
        true => finding(Vec::new(), vec![seen], Some(figure)),
        false => finding(vec![seen], Vec::new(), Some(figure)),
    }
}

#[cfg(test)]
mod tests {
    use crate::{Criteria, Finding, Gates, Panel};
    use base::Seed;
    use engine::Game;

    /// Judges a game by one gate, with wins from the search of `winnable`.
    pub(super) fn judged(gate: &str, source: &str, levels: &[&str], alter: impl Fn(&mut Gates)) -> Finding {
        let game = Game::from_source(source).unwrap();
        let levels: Vec<_> = levels.iter().map(|level| game.level(level).unwrap()).collect();
        let mut criteria = Criteria {
            ask: ["winnable", gate].map(str::to_owned).to_vec(),
            budget: 30_000,
            foresight: 0.4,
            ..Criteria::default()
        };
        alter(&mut criteria.gates);
        let report = Panel::new(&criteria).unwrap().judge_game(&game, &levels, Seed::from_text("gates"));
        report.judgements.into_iter().next().unwrap().finding
    }

    /// Checks that a gate passes, or fails with these words.
    #[track_caller]
    pub(super) fn check(gate: &str, source: &str, levels: &[&str], fails: Option<&str>) {
        let finding = judged(gate, source, levels, |_| ());
        match (&finding.verdict, fails) {
            (crate::Verdict::Pass { .. }, None) => {}
            (crate::Verdict::Fail { reason, .. }, Some(words)) if reason.0.contains(words) => {}
            _ => panic!("{finding:#?}"),
        }
    }
}
