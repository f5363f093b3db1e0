//! The `skill-overall` criterion: checks that skilled play pays off across all levels together.

use crate::allowance::Setting;
use crate::evidence::Evidence;
use crate::measures::ladder::{Ladder, PlayerResult};
use crate::validator::{GameCase, GameValidator};
use crate::verdict::{Finding, Verdict};
use engine::{Episode, Outcome};
use statistics::{Interval, Z95, wilson};

/// Passes if two players both win more often, across all levels together, than the best player that does not look
/// ahead. The two are the strongest player on the ladder of reference players, and the strongest held-out player. Even
/// the lower end of Newcombe's 95% interval of the difference must reach the margin. The episodes on a single level are
/// too few for such a test, but those on five levels are enough.
///
/// If all levels are deterministic and have a known win, a player that knows the solutions counts both as a player on
/// the ladder and as a held-out player. The criterion has no extra cost, because its episodes come from the criterion
/// `skill`.
#[derive(Clone, Copy, Debug)]
pub struct SkillOverall {
    /// The margin, as a difference between win rates.
    pub wins: f64,
}

/// One player's wins and episodes on all levels.
#[derive(Clone)]
struct Total {
    player: String,
    looks_ahead: bool,
    wins: u64,
    plays: u64,
}

impl Total {
    /// Returns the fraction of episodes that the player won.
    fn share(&self) -> f64 {
        self.wins as f64 / self.plays.max(1) as f64
    }

    /// Extrapolates the total by `times` times as many further episodes, which the player wins at the rate `share`.
    fn extrapolated(&self, times: f64, share: f64) -> Total {
        let plays = (self.plays as f64 * times).round();
        let wins = self.wins + (plays * share).round() as u64;
        Total { wins, plays: self.plays + plays as u64, ..self.clone() }
    }

    /// Returns the interval of the difference between the player's win rate and that of `baseline`.
    fn difference_to(&self, baseline: &Total) -> Interval {
        statistics::difference([self.wins, baseline.wins], [self.plays, baseline.plays], Z95)
    }
}

pub(crate) const QUESTION: &str = "do planners that look ahead win more over all levels together?";

pub(crate) fn judge(setting: &Setting<'_>) -> SkillOverall {
    SkillOverall { wins: setting.criteria.skill_overall }
}

impl GameValidator for SkillOverall {
    fn validate(&self, case: GameCase<'_>) -> Finding {
        let ladders: Option<Vec<&Ladder>> = case.ladders.iter().copied().collect();
        let Some(ladders) = ladders.filter(|ladders| !ladders.is_empty()) else {
            return Verdict::Unknown { spent: 0 }.into();
        };
        let won = |episodes: &[Episode]| episodes.iter().any(|played| played.outcome == Outcome::Won);
        let planned = case
            .recording
            .iter()
            .all(|recorded| won(recorded.episodes) && case.analysis.is_deterministic_in(recorded.level));
        let Some((baseline, sides)) = sides(&ladders, planned) else {
            return Verdict::Unknown { spent: 0 }.into();
        };
        let evidence = sides.iter().map(|total| {
            let interval = total.difference_to(&baseline);
            Evidence::new(format!(
                "over all levels, {} wins {} of {}, {} {} of {} (95%: {:+.0} to {:+.0} points)",
                total.player,
                total.wins,
                total.plays,
                baseline.player,
                baseline.wins,
                baseline.plays,
                100.0 * interval.low,
                100.0 * interval.high,
            ))
        });
        let evidence: Vec<Evidence> = evidence.collect();
        let least =
            sides.iter().map(|total| total.difference_to(&baseline).low).fold(f64::INFINITY, f64::min);
        let verdict = if least >= self.wins {
            Verdict::pass()
        } else {
            Verdict::fail(format!(
                "playing well pays too little over all levels: {:+.0} points at the lower end of the \
                 interval (at least {:.0} required)",
                100.0 * least,
                100.0 * self.wins
            ))
        };
        Finding::from(verdict).seen(evidence)
    }
}

impl SkillOverall {
    /// Returns `true` if the first of the game's `levels` levels show that it is unlikely to meet the margin. Such a
    /// game would miss the margin even if, on the remaining levels, the strong players won at the upper end of Wilson's
    /// 95% interval of their win rate so far. `planned` means that all levels are deterministic and have a known win.
    /// If all levels are given, the answer equals the criterion's.
    pub fn is_hopeless(&self, ladders: &[&Ladder], planned: bool, levels: usize) -> bool {
        let ahead = levels.saturating_sub(ladders.len()) as f64 / ladders.len().max(1) as f64;
        sides(ladders, planned).is_some_and(|(baseline, sides)| {
            let baseline = baseline.extrapolated(ahead, baseline.share());
            let hoped = |total: &Total| total.extrapolated(ahead, wilson(total.wins, total.plays, Z95).high);
            sides.iter().any(|total| hoped(total).difference_to(&baseline).low < self.wins)
        })
    }
}

/// Returns the best player that does not look ahead, the strongest player on the ladder of reference players, and the
/// strongest held-out player. Returns `None` if any of the three is missing.
fn sides(ladders: &[&Ladder], planned: bool) -> Option<(Total, [Total; 2])> {
    let rungs = totals(ladders, |ladder| &ladder.rungs);
    let held_out = totals(ladders, |ladder| &ladder.held_out);
    let baseline = strongest(rungs.iter().filter(|total| !total.looks_ahead))?.clone();
    let solver = planned.then(|| Total {
        player: "a player that knows the solutions".to_owned(),
        looks_ahead: true,
        wins: baseline.plays,
        plays: baseline.plays,
    });
    let climbing = rungs.iter().filter(|total| total.looks_ahead);
    let sides =
        [strongest(climbing.chain(&solver))?.clone(), strongest(held_out.iter().chain(&solver))?.clone()];
    Some((baseline, sides))
}

/// Sums each reference player's results over all levels. All levels must have been played by the same players.
fn totals(ladders: &[&Ladder], of: impl Fn(&Ladder) -> &Vec<PlayerResult>) -> Vec<Total> {
    let first = ladders.first().map_or(&[][..], |ladder| of(ladder));
    let total = |(at, result): (usize, &PlayerResult)| {
        let rates = || ladders.iter().filter_map(|ladder| of(ladder).get(at)).map(|result| &result.rate);
        Total {
            player: result.player.clone(),
            looks_ahead: result.looks_ahead,
            wins: rates().map(|rate| rate.wins).sum(),
            plays: rates().map(|rate| rate.plays).sum(),
        }
    };
    first.iter().enumerate().map(total).collect()
}

/// Returns the player with the highest win rate; `None` without players. Ties go to the earlier player.
fn strongest<'a>(totals: impl Iterator<Item = &'a Total>) -> Option<&'a Total> {
    totals.fold(None, |best: Option<&Total>, total| match best {
        Some(best) if best.share() >= total.share() => Some(best),
        _ => Some(total),
    })
}

#[cfg(test)]
mod tests {
    use crate::{Criteria, Criterion, CriterionSet, Effort, Judging, Panel};
    use base::Seed;
    use engine::Game;

    /// A game in which the player collects the gem. In the stochastic variant, a player that stands still is
    /// eventually caught.
    const GAME: &str = "BasicGame
    SpriteSet
        wall > Immovable
        gem > Immovable
        ghost > RandomNPC cooldown=4
        avatar > MovingAvatar
    LevelMapping
        g > gem
        r > ghost
    InteractionSet
        avatar wall > stepBack
        ghost wall > stepBack
        avatar ghost > killSprite
        gem avatar > killSprite scoreChange=1
    TerminationSet
        SpriteCounter stype=gem win=True
        SpriteCounter stype=avatar win=False
        Timeout limit=12 win=False
";

    /// A level of six steps that requires a detour from the direct path.
    const FAR: &str = "wwwwwww\nwA   ww\nww w  w\nwr w gw\nwwwwwww\n";

    #[track_caller]
    fn check(game: &str, level: &str, players: [&str; 2], passes: bool, words: &str) {
        let game = Game::from_source(game).unwrap();
        let level = game.level(level).unwrap();
        let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
        let criteria = Criteria {
            ask: CriterionSet::of(&[Criterion::Winnable, Criterion::Skill, Criterion::SkillOverall]),
            budget: 20_000,
            ladder: names(&["do-nothing", "random", players[0]]),
            held_out: names(&[players[1]]),
            ..Criteria::default()
        };
        let panel = Panel::new(criteria.check().unwrap(), Effort::Full);
        let report = panel.judge(Judging::game(&game, &[level], Seed::from_text("overall")));
        let finding = &report.judgements[0].finding;
        assert_eq!(finding.verdict.is_pass(), passes, "{finding:?}");
        assert!(finding.evidence.iter().any(|seen| seen.text.contains(words)), "{finding:?}");
    }

    #[test]
    fn skill_pays_only_if_plans_are_needed() {
        check(GAME, FAR, ["olets:200", "olets:300"], true, "olets:300 wins");
        check(GAME, "wwwwww\nwAg rw\nwwwwww\n", ["olets:200", "olets:300"], false, "olets:200 wins");
    }

    #[test]
    fn deterministic_solutions_count_as_a_player() {
        let plain = GAME.replace("RandomNPC cooldown=4", "Immovable");
        check(&plain, FAR, ["mcts:5", "mcts:6"], true, "that knows the solutions");
    }
}
