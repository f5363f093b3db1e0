//! A proof from the analysis, before any search.

use crate::causes::lower;
use crate::evidence::{Evidence, Line};
use crate::verdict::{Case, Finding, Validator, Verdict};
use agents::Stopped;
use engine::analysis::Cause;
use engine::describe;

/// Consults the analysis of the level before a search: if a win is out of reach (`engine::analysis::Reach`), that is
/// a failure, and the inner validator does not run. Its name is that of the inner validator. (For designers, the
/// panel adds the chain of causes.)
#[derive(Clone, Debug)]
pub struct Reachable<V>(pub V);

impl<V: Validator> Validator for Reachable<V> {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn validate(&self, case: Case<'_>) -> Finding {
        self.validate_until(case, &|| false)
    }

    fn validate_until(&self, case: Case<'_>, stopped: Stopped<'_>) -> Finding {
        let Case { game, level, analysis, .. } = case;
        let reach = analysis.reach(level);
        if reach.can_win() {
            return self.0.validate_until(case, stopped);
        }
        let wins = reach
            .impossible_goals()
            .iter()
            .filter(|impossible_goal| analysis.goals()[impossible_goal.goal].win);
        let told = describe::hindered_wins(analysis, level, &reach);
        let columns = level.columns();
        let evidence = wins.zip(&told).map(|(impossible_goal, sentence)| {
            let (cell, advice) = match &impossible_goal.cause {
                Cause::Permanent(sprites) => {
                    let advice = "open a path to it, or remove it";
                    let first = sprites.first();
                    (first.map(|(_, cell)| (cell % columns + 1, cell / columns + 1)), advice)
                }
                Cause::AtMost(_) => (None, "place more of the counted sprites, or lower the limit"),
                Cause::Unpaid(_) => (None, "place more of the resource, or fewer of what must go"),
            };
            let rule = Some(Line::termination(game, analysis.goals()[impossible_goal.goal].line));
            Evidence { text: sentence.clone(), cell, rule, ..Evidence::default() }.advise(advice)
        });
        let evidence: Vec<Evidence> = evidence.collect();
        let why = told.first().map_or("no termination that wins can ever hold in it", String::as_str);
        Finding::from(Verdict::fail(format!("the level cannot be won: {}", lower(why)))).seen(evidence)
    }
}
