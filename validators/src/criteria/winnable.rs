//! The `winnable` criterion: checks that a search finds a win.

use crate::allowance::Setting;
use crate::case::Case;
use crate::evidence::{Evidence, Line};
use crate::explain::board::Board;
use crate::explain::causes::lower;
use crate::measures::ladder::Rate;
use crate::validator::Validator;
use crate::verdict::{Finding, Verdict};
use agents::{PortfolioConfig, Solution, Stopped, solve_until};
use engine::Action;
use engine::analysis::{Cause, Condition, Reach};
use engine::describe::{self, plural};

/// Passes if the portfolio ([`agents::solve`]) finds a win, which becomes the witness. In a deterministic game, the
/// search may also prove that there is no win, or that the win found is the shortest.
///
/// The level is analysed before the search. If the analysis shows that a win is unreachable
/// ([`engine::analysis::Reach`]), the level fails without a search, and the panel explains the chain of causes to
/// designers.
///
/// If no win is found within the budget, the verdict is `Unknown`, never `Fail`, because an interrupted search proves
/// nothing.
#[derive(Clone, Debug)]
pub(crate) struct Winnable(PortfolioConfig);

pub(crate) const QUESTION: &str = "is there a win?";

pub(crate) fn judge(setting: &Setting<'_>) -> Winnable {
    Winnable(setting.search())
}

impl Validator for Winnable {
    fn validate(&self, case: Case<'_>) -> Finding {
        self.validate_until(case, &|| false)
    }

    fn validate_until(&self, case: Case<'_>, stopped: Stopped<'_>) -> Finding {
        let reach = case.analysis.reach(case.level);
        if !reach.can_win() {
            return out_of_reach(case, &reach);
        }
        let solved = solve_until(case.analysis, case.level, &self.0, case.seed, stopped);
        let mut finding = match solved.solution {
            Solution::Won { episode, shortest } => {
                let optimal = shortest.then_some(episode.actions.len());
                Finding { optimal, ..Finding::from(Verdict::Pass { witness: Some(*episode) }) }
            }
            Solution::Impossible { states, nearest } => {
                let reason = format!("the level cannot be won: all {states} reachable states were searched");
                let note = "the rules alone do not show the reason, but no sequence of actions wins";
                Finding::from(Verdict::fail(reason))
                    .seen([Evidence::new(note)])
                    .seen(nearest_to_a_win(case, &nearest))
            }
            Solution::Unknown => Verdict::Unknown { spent: solved.calls }.into(),
        };
        let played: u64 = solved.plays.iter().map(|play| play.calls).sum();
        finding.searched = Some(solved.calls - played).filter(|&calls| calls > 0);
        if !solved.plays.is_empty() {
            finding.measured = Some(Rate::of(&solved.plays));
        }
        finding.played(solved.plays.into_iter().map(|play| play.episode))
    }
}

/// Returns the finding for a level with an unreachable win.
fn out_of_reach(Case { game, level, analysis, .. }: Case<'_>, reach: &Reach) -> Finding {
    let wins =
        reach.impossible_goals().iter().filter(|impossible_goal| analysis.goals()[impossible_goal.goal].win);
    let told = describe::hindered_wins(analysis, level, reach);
    let columns = level.columns();
    let evidence = wins.zip(&told).map(|(impossible_goal, sentence)| {
        let (cell, advice) = match &impossible_goal.cause {
            Cause::Permanent(sprites) => {
                let advice = "open a path to this sprite, or remove it";
                let first = sprites.first();
                (first.map(|(_, cell)| (cell % columns + 1, cell / columns + 1)), advice)
            }
            Cause::AtMost(_) => (None, "place more of the counted sprites, or lower the limit"),
            Cause::Unpaid(_) => {
                (None, "place more of the resource, or fewer of the sprites that must be removed")
            }
        };
        let rule = Some(Line::termination(game, analysis.goals()[impossible_goal.goal].line));
        Evidence { text: sentence.clone(), cell, rule, ..Evidence::default() }.advise(advice)
    });
    let evidence: Vec<Evidence> = evidence.collect();
    let why = told.first().map_or("no winning termination can ever hold in this level", String::as_str);
    Finding::from(Verdict::fail(format!("the level cannot be won: {}", lower(why)))).seen(evidence)
}

/// The maximum number of types to list.
const MAX_NAMED: usize = 3;

/// Describes the state closest to a win among the reachable states.
fn nearest_to_a_win(
    Case { game, level, analysis, seed, .. }: Case<'_>,
    actions: &[Action],
) -> Option<Evidence> {
    let mut state = game.start(level, seed.seed());
    for &action in actions {
        game.step(&mut state, action);
    }
    let winning = analysis.goals().iter().filter(|goal| goal.win);
    let goal = winning.min_by_key(|goal| analysis.missing(goal, &state))?;
    let missing = analysis.missing(goal, &state);
    let types = goal.condition.types().iter().filter(|stype| analysis.facts(**stype).possible);
    let names: Vec<String> = types
        .map(|&stype| match missing {
            1 => game.name(stype).to_owned(),
            _ => plural(game.name(stype)),
        })
        .take(MAX_NAMED)
        .collect();
    let names = names.join(" or ");
    let text = match goal.condition {
        Condition::AtMost(_, ..=0) => format!("{missing} {names} left"),
        Condition::AtMost(..) => format!("{missing} {names} too many"),
        Condition::AtLeast(..) => format!("{missing} {names} missing"),
        Condition::Exactly(..) => format!("the number of {names} is off by {missing}"),
        Condition::Tick(_) => format!("{} left", base::count(missing as usize, "tick")),
    };
    let tick = Some(actions.len()).filter(|&tick| tick > 0);
    let rule = Some(Line::termination(game, goal.line));
    let board = Some(Board::of(game, &state));
    let text = format!("the reachable state closest to a win: {text}");
    Some(
        Evidence { text, tick, rule, board, ..Evidence::default() }
            .advise("make a win possible from this state, or place more of the required sprites"),
    )
}
