//! Is there a game at all?

use crate::verdict::{Case, Finding, Validator, Verdict};
use engine::{Action, Analysis, Outcome};

/// The game can be won in principle, is not over in its first tick, and does nothing that the engine stops at.
///
/// That the text is VGDL and the level fits it is what `Game` and `Level` already say by existing.
#[derive(Clone, Copy, Debug, Default)]
pub struct WellFormed;

impl Validator for WellFormed {
    fn name(&self) -> &'static str {
        "well-formed"
    }

    fn validate(&self, case: Case<'_>) -> Finding {
        if !Analysis::of(case.game).can_win() {
            let told = case.game.warnings().iter().find(|warning| warning.code == "no-win");
            let reason = told.map_or("the game cannot be won", |warning| warning.message.as_str());
            return Verdict::fail(reason).into();
        }
        let mut state = case.game.start(case.level, case.seed);
        let verdict = match case.game.step(&mut state, Action::Nil) {
            Outcome::Ongoing => Verdict::pass(),
            Outcome::Won => {
                Verdict::fail("the game is won in its first tick: a termination holds at the start")
            }
            Outcome::Lost => Verdict::fail("the game is lost in its first tick"),
            Outcome::Ended => Verdict::fail("the game ends in its first tick, without a winner"),
            Outcome::Stopped(limit) => Verdict::fail(format!("the game stops in its first tick: {limit}")),
        };
        verdict.into()
    }
}
