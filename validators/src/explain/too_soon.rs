//! Explanations for levels that are unwinnable only because time runs out too soon.

use crate::case::Case;
use crate::evidence::{Evidence, Line};
use crate::explain::board::Board;
use crate::verdict::{Finding, Verdict};
use agents::{PortfolioConfig, Solution, solve};
use engine::analysis::Condition;
use engine::{Analysis, Description, Game};

/// Repeats the search of a level that is proven unwinnable, without the Timeouts that lose the game. If a win is found,
/// rewrites the finding to name these Timeouts as the cause, and returns `true`. Other findings stay unchanged. Costs
/// the rest of the first search's budget.
pub(crate) fn explain(case: Case<'_>, finding: &mut Finding, search: &PortfolioConfig) -> bool {
    let Case { game, level, analysis, seed, .. } = case;
    let Some(spent) = finding.searched.filter(|_| matches!(finding.verdict, Verdict::Fail { .. })) else {
        return false;
    };
    let left = search.budget.saturating_sub(spent);
    let mut timeouts: Vec<(i32, usize)> = Vec::new();
    for goal in analysis.goals().iter().filter(|goal| !goal.win) {
        if let Condition::Tick(limit) = goal.condition {
            timeouts.push((limit, goal.line));
        }
    }
    let Some(&(_, line)) = timeouts.iter().min().filter(|_| left > 0) else { return false };
    let lines = game.description().terminations.iter().enumerate();
    let kept = lines.filter(|(at, _)| timeouts.iter().all(|(_, timeout)| timeout != at));
    let terminations = kept.map(|(_, line)| line.clone()).collect();
    let endless = Description { terminations, ..game.description().clone() };
    let Ok(endless) = Game::compile(&endless) else { return false };
    let Ok(again) = endless.level(&level.to_string()) else { return false };
    let config = PortfolioConfig { budget: left, ..search.clone() };
    let solved = solve(&Analysis::of(&endless), &again, &config, seed.child("endless", 0));
    finding.searched = Some(spent + solved.calls);
    let Solution::Won { episode, shortest } = solved.solution else { return false };
    let ticks = episode.actions.len();
    let fewest = if shortest { " at the earliest" } else { "" };
    let rule = Line::termination(game, line);
    let reason = format!(
        "the level cannot be won before `{}` ends the game; without that termination, the level is won in \
         {}{fewest}",
        rule.text,
        base::count(ticks, "tick")
    );
    finding.verdict = Verdict::fail(reason);
    // The board that the win has reached at the time limit.
    let mut state = game.start(level, episode.seed);
    let mut until = 0;
    for &action in &episode.actions {
        if state.is_over() {
            break;
        }
        game.step(&mut state, action);
        until += 1;
    }
    let seen = Evidence {
        text: format!("this termination ends the game in tick {until}, before that win"),
        rule: Some(rule),
        board: Some(Board::of(game, &state)),
        ..Evidence::default()
    };
    finding.evidence = vec![seen.advise(format!("raise its `limit=` beyond {ticks}, or shorten the path"))];
    true
}

#[cfg(test)]
mod tests {
    use crate::{Criteria, Criterion, Effort, Judging, Panel, Verdict};
    use base::Seed;
    use engine::Game;

    const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    goal > Door\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n  InteractionSet\n    avatar wall > stepBack\n    goal avatar > killSprite scoreChange=1\n  TerminationSet\n    Timeout limit=4 win=False\n    Timeout limit=90 win=False\n    SpriteCounter stype=goal win=True\n";

    #[test]
    fn a_timeout_before_the_first_win_is_named_as_the_cause() {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level("wwwwwwwwww\nwA.....g.w\nwwwwwwwwww\n".replace('.', " ").as_str()).unwrap();
        let panel = Panel::new(Criteria::default().check().unwrap(), Effort::Full);
        let report = panel.judge(Judging::level(&game, &level, Seed::from_text("soon")));
        let finding = report.finding(Criterion::Winnable).unwrap();
        let Verdict::Fail { reason, .. } = &finding.verdict else { panic!("{finding:?}") };
        let meant = "the level cannot be won before `Timeout limit=4 win=False` ends the game; without that termination, the level is won in 6 ticks";
        assert!(reason.0.starts_with(meant), "{reason:?}");
        let advice = finding.evidence[0].advice.as_deref();
        assert_eq!(advice, Some("raise its `limit=` beyond 6, or shorten the path"));
        // With enough time, the same level can be won.
        let game = Game::from_source(&GAME.replace("limit=4", "limit=40")).unwrap();
        let level = game.level(&level.to_string()).unwrap();
        let panel = Panel::new(Criteria::default().check().unwrap(), Effort::Full);
        let report = panel.judge(Judging::level(&game, &level, Seed::from_text("soon")));
        assert!(report.finding(Criterion::Winnable).unwrap().verdict.is_pass());
    }
}
