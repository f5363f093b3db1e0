//! A description of one level in plain English.

use super::rules;
use super::words::{list, plural};
use crate::analysis::{Analysis, Cause, ImpossibleGoal, Reach, Unpaid};
use crate::level::Level;
use crate::rules::SpriteType;

/// The maximum number of sprites listed in a sentence.
const MAX_NAMED: usize = 3;

/// Returns the facts that are known about a level before play, as sentences: how much of the level the player
/// can reach, and which terminations can never hold.
pub fn level(analysis: &Analysis, level: &Level, reach: &Reach) -> Vec<String> {
    if reach.is_coarse() {
        return vec!["There is too much in it to tell where everything can be.".to_owned()];
    }
    let all = level.cells().len();
    let reached = (0..all).filter(|&cell| reach.avatar_reaches(cell)).count();
    let mut lines = vec![format!("You can get to {reached} of its {all} cells, at most.")];
    lines.extend(impossible_goals(analysis, level, reach, |_| true));
    lines
}

/// Returns the winning terminations that can never hold in a level, with the reasons: one sentence per
/// termination.
pub fn hindered_wins(analysis: &Analysis, level: &Level, reach: &Reach) -> Vec<String> {
    impossible_goals(analysis, level, reach, |goal| analysis.goals()[goal].win)
}

fn impossible_goals(
    analysis: &Analysis,
    level: &Level,
    reach: &Reach,
    about: impl Fn(usize) -> bool,
) -> Vec<String> {
    let impossible_goals =
        reach.impossible_goals().iter().filter(|impossible_goal| about(impossible_goal.goal));
    let sentence = |ImpossibleGoal { goal, cause }: &ImpossibleGoal| {
        let goal = &analysis.goals()[*goal];
        let ending = rules::goal(analysis, goal, goal.win);
        let but = match cause {
            Cause::Permanent(sprites) => format!("nothing can ever end {}", placed(analysis, level, sprites)),
            Cause::AtMost(0) => "there can never be any".to_owned(),
            Cause::AtMost(most) => format!("there can never be more than {most}"),
            Cause::Unpaid(Unpaid { target, removals, resource, each, most, .. }) => {
                let name = |stype: SpriteType, number: i64| match number {
                    1 => analysis.game().name(stype).to_owned(),
                    _ => plural(analysis.game().name(stype)),
                };
                let (target, takes) = (name(*target, *removals), name(*resource, *each));
                let must = if *removals == 1 { "takes" } else { "must go, each takes" };
                let there = if *most == 1 { "is" } else { "are" };
                let left = if *most == 0 { "none".to_owned() } else { format!("only {most}") };
                format!("{removals} {target} {must} {each} {takes}, and there {there} {left}")
            }
        };
        format!("{ending}, but here {but}.")
    };
    impossible_goals.map(sentence).collect()
}

/// Returns the first [`MAX_NAMED`] sprites, by name and position.
fn placed(analysis: &Analysis, level: &Level, sprites: &[(SpriteType, usize)]) -> String {
    let columns = level.columns();
    let named = sprites.iter().take(MAX_NAMED).map(|&(stype, cell)| {
        let (column, row) = (cell % columns + 1, cell / columns + 1);
        format!("the {} in column {column}, row {row}", analysis.game().name(stype))
    });
    let mut named: Vec<String> = named.collect();
    if sprites.len() > MAX_NAMED {
        named.push(format!("{} more", sprites.len() - MAX_NAMED));
    }
    list(&named, "and")
}
