//! The `length` criterion: a level is neither over at once nor endless.

use crate::ending::Ending;
use crate::verdict::{Case, Finding, Validator, Verdict};

/// The witness takes a number of ticks within bounds.
#[derive(Clone, Copy, Debug)]
pub struct LengthWithin {
    /// Ticks at least.
    pub least: usize,
    /// Ticks at most.
    pub most: usize,
}

impl Validator for LengthWithin {
    fn name(&self) -> &'static str {
        "length"
    }

    fn validate(&self, case: Case<'_>) -> Finding {
        let Some(witness) = case.witness else { return Verdict::Unknown { spent: 0 }.into() };
        let ticks = witness.actions.len();
        let ending = Ending::of(case.analysis, case.level, witness);
        let seen = |advice: &str| {
            let evidence = ending.evidence(case.game).into_iter().next();
            evidence.map(|seen| seen.advise(advice))
        };
        if ticks < self.least {
            let reason = format!("won in {ticks} ticks, fewer than {}", self.least);
            Finding::from(Verdict::fail(reason)).seen(seen("move the goal farther away"))
        } else if ticks > self.most {
            let reason = format!("the shortest win found takes {ticks} ticks, more than {}", self.most);
            Finding::from(Verdict::fail(reason)).seen(seen("make the level smaller, or raise `most_ticks`"))
        } else {
            Verdict::pass().into()
        }
    }
}
