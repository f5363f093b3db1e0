//! The `skill` criterion: checks that skilled play pays off on a level.

use crate::allowance::Setting;
use crate::case::Case;
use crate::evidence::Evidence;
use crate::measures::ladder::{Ladder, LadderConfig, LadderPlays, PlayerResult};
use crate::validator::Validator;
use crate::verdict::{Finding, Verdict};
use agents::{Play, Stopped};
use engine::Outcome;
use statistics::{Interval, Z95};

/// Passes if stronger players win more, or score more, than players that do not look ahead. The difference must reach a
/// margin and be significant, which means that its 95% interval is above 0. Two players must show the difference: one
/// on the ladder of reference players, and one held-out player. Otherwise, a level could be fitted to the players that
/// guided the search for it.
///
/// On a deterministic level, a witness counts as a held-out player that always wins. A puzzle that is too deep for
/// every player on the ladder can therefore still show skill, if players that do not look ahead lose it.
#[derive(Clone, Debug)]
pub(crate) struct SkillPays {
    /// The players, and the limits on their episodes.
    players: LadderConfig,
    /// The minimum difference in win rate.
    wins: f64,
    /// The minimum difference in mean score, as a fraction of the range of all scores. Reaching this difference is
    /// sufficient even if `wins` is not reached.
    scores: f64,
    /// The number of forward-model calls after which an episode is stopped. If any episode is stopped, a failure
    /// becomes unknown.
    play_calls: u64,
    /// `true` to allow stopping after each round of episodes, from the third round on. The judge stops if skill pays
    /// off even with a stricter boundary, or if no player is far ahead of the baseline. More episodes would then rarely
    /// change the answer; `cargo xtask judging` counts how often they do.
    sequential: bool,
}

/// A boundary that an advantage must exceed.
#[derive(Clone, Copy)]
struct Boundary {
    /// The normal quantile for win rates.
    z: f64,
    /// The confidence level of the score interval.
    confidence: f64,
    /// The minimum number of episodes per player before scores count.
    scored_plays: usize,
}

/// The boundary for stopping early, which is stricter to correct for repeated tests on growing data (O'Brien
/// and Fleming 1979).
const EARLY: Boundary = Boundary { z: 2.8, confidence: 0.995, scored_plays: 8 };
/// The boundary for the final answer.
const FINAL: Boundary = Boundary { z: Z95, confidence: 0.95, scored_plays: 0 };
/// The number of episodes per player after which the judge may decide early that skill is shown or missing.
const EARLY_PLAYS: usize = 6;

/// The number of resamples per score interval.
const RESAMPLES: usize = 1000;

/// One player's advantage over another.
struct Advantage {
    text: String,
    /// `true` if the advantage is large enough and significant.
    pays: bool,
    /// `true` if the advantage is large enough, but not significant.
    unsure: bool,
    /// `true` if more episodes might establish the advantage: the difference in wins is large enough, or the
    /// difference in scores is at least half the required difference.
    leads: bool,
}

/// The answer given by the episodes so far.
struct Answer {
    ladder: Ladder,
    /// The advantages of the reference players on the ladder, followed by the advantages of the held-out players.
    advantages: [Vec<Advantage>; 2],
    /// `true` if a win is known.
    won: bool,
    /// `true` if a reference player on the ladder shows skill.
    shown: bool,
    /// `true` if a held-out player shows skill.
    accepted: bool,
}

pub(crate) const QUESTION: &str =
    "do planners that look ahead win more, or score more, than planners that do not?";

pub(crate) fn judge(setting: &Setting<'_>) -> SkillPays {
    SkillPays {
        players: setting.players(),
        wins: setting.criteria.skill_wins,
        scores: setting.criteria.skill_scores,
        play_calls: setting.ladder_play_calls(),
        sequential: setting.is_sequential(),
    }
}

impl Validator for SkillPays {
    fn validate(&self, case: Case<'_>) -> Finding {
        self.validate_until(case, &|| false)
    }

    fn validate_until(&self, case: Case<'_>, stopped: Stopped<'_>) -> Finding {
        let enough = |played: &LadderPlays| self.sequential && self.is_sure(case, played);
        let played = self.players.play_within(case, self.play_calls, enough, stopped);
        let cut = played.broken_off(self.play_calls);
        let spent = played.plays.iter().flatten().map(|play| play.calls).sum();
        let Some(answer) = self.answer(case, &played, FINAL) else {
            return Verdict::Unknown { spent }.into();
        };
        let Answer { ladder, advantages: [advantages, held], won, shown, accepted } = answer;
        let unsure = advantages.iter().chain(&held).any(|advantage| advantage.unsure);
        // If no player ever wins and all players score the same, they are too weak to give an answer.
        let telling = played.plays.iter().flatten().any(is_won) || range(&played) > 0.0;
        let verdict = if shown && accepted {
            Verdict::pass()
        } else if unsure || !won || !telling || (shown && !accepted) || cut > 0 {
            Verdict::Unknown { spent }
        } else {
            let strongest = advantages.last().or(held.last()).map(|advantage| advantage.text.as_str());
            let strongest = strongest.unwrap_or("no player looks ahead");
            Verdict::fail(format!("playing well does not pay: {strongest}"))
        };
        let mut evidence: Vec<Evidence> =
            advantages.iter().chain(&held).map(|advantage| Evidence::new(advantage.text.clone())).collect();
        if let (Verdict::Fail { .. }, Some(last)) = (&verdict, evidence.last_mut()) {
            last.advice = Some(
                "make choices matter: add dangers that foresight avoids or points that a plan earns, or \
                 reduce luck"
                    .to_owned(),
            );
        }
        if cut > 0 {
            let text = format!("{cut} episodes were stopped by the budget");
            evidence.insert(0, Evidence::new(text));
        }
        let episodes = played.plays.into_iter().flatten().map(|play| play.episode);
        Finding { ladder: Some(ladder), ..Finding::from(verdict).seen(evidence).played(episodes) }
    }
}

impl SkillPays {
    /// Returns the answer given by the episodes so far, or `None` if there is no baseline.
    fn answer(&self, case: Case<'_>, played: &LadderPlays, boundary: Boundary) -> Option<Answer> {
        let ladder = self.players.measure(played);
        let range = range(played);
        // The baseline is the best player that does not look ahead.
        let is_baseline = |&at: &usize| !ladder.rungs[at].looks_ahead;
        let weak = (0..ladder.rungs.len()).filter(is_baseline).max_by(|&a, &b| better(&ladder, a, b))?;
        let against = |result: &PlayerResult, plays: &[Play]| {
            self.advantage(result, plays, (&ladder, played), weak, range, boundary)
        };
        let strong = (0..ladder.rungs.len()).filter(|at| !is_baseline(at));
        let advantages: Vec<Advantage> =
            strong.map(|at| against(&ladder.rungs[at], &played.plays[at])).collect();
        let held_out = ladder.held_out.iter().zip(&played.plays[ladder.rungs.len()..]);
        let mut held: Vec<Advantage> = held_out.map(|(result, plays)| against(result, plays)).collect();
        // On a deterministic level, any win is a plan that always wins.
        let won = case.witness.is_some() || played.plays.iter().flatten().any(is_won);
        let planned = won && case.analysis.is_deterministic_in(case.level);
        let by_search = planned.then(|| self.against_search(&ladder.rungs[weak]));
        let searched = by_search.as_ref().is_some_and(|advantage| advantage.pays);
        let shown = advantages.iter().any(|advantage| advantage.pays) || searched;
        held.extend(by_search);
        let accepted = held.iter().any(|advantage| advantage.pays);
        Some(Answer { ladder, advantages: [advantages, held], won, shown, accepted })
    }

    /// Returns `true` if further episodes would hardly change the answer.
    fn is_sure(&self, case: Case<'_>, played: &LadderPlays) -> bool {
        let plays = played.plays.first().map_or(0, Vec::len);
        if plays < EARLY_PLAYS {
            return false;
        }
        let Some(answer) = self.answer(case, played, EARLY) else { return false };
        let is_ahead = || answer.advantages.iter().flatten().any(|advantage| advantage.leads);
        answer.shown && answer.accepted || !is_ahead()
    }

    fn advantage(
        &self,
        result: &PlayerResult,
        plays: &[Play],
        (ladder, played): (&Ladder, &LadderPlays),
        weak: usize,
        range: f64,
        boundary: Boundary,
    ) -> Advantage {
        let weaker = &ladder.rungs[weak];
        let ([won, lost], [of, out_of]) =
            ([result.rate.wins, weaker.rate.wins], [result.rate.plays, weaker.rate.plays]);
        let interval = statistics::difference([won, lost], [of, out_of], boundary.z);
        let more = won as f64 / of.max(1) as f64 - lost as f64 / out_of.max(1) as f64;
        let (points, least, most) = (100.0 * more, 100.0 * interval.low, 100.0 * interval.high);
        let mut text = format!(
            "{} wins {won} of {of}, {} {lost} of {out_of} ({points:+.0} points; 95%: {least:+.0} to \
             {most:+.0})",
            result.player, weaker.player,
        );
        let (mut pays, mut unsure) = (interval.low > 0.0 && more >= self.wins, more >= self.wins);
        let mut leads = more >= self.wins;
        if range <= 0.0 {
            text.push_str(", and all players score the same");
        } else {
            let gains: Vec<f64> = plays
                .iter()
                .zip(&played.plays[weak])
                .map(|(strong, weak)| strong.episode.score - weak.episode.score)
                .collect();
            let mean = |sample: &[f64]| sample.iter().sum::<f64>() / sample.len() as f64;
            let sure = statistics::bootstrap(&gains, mean, RESAMPLES, boundary.confidence, [0; 32]);
            if let (Some(Interval { low, high }), false) = (sure, gains.is_empty()) {
                let gain = mean(&gains);
                text.push_str(&format!(", and scores {gain:+.2} (95%: {low:+.2} to {high:+.2})"));
                let is_large = gain >= self.scores * range;
                pays |= low > 0.0 && is_large && gains.len() >= boundary.scored_plays;
                unsure |= is_large;
                leads |= gain >= self.scores * range / 2.0;
            }
        }
        Advantage { text, pays, unsure: unsure && !pays, leads }
    }

    /// Compares the witness, which always wins, with the weaker player.
    fn against_search(&self, weaker: &PlayerResult) -> Advantage {
        let (wins, plays) = (weaker.rate.wins, weaker.rate.plays);
        let text =
            format!("a player that knows the solution wins every time, {} {wins} of {plays}", weaker.player);
        let high = weaker.rate.interval[1];
        let pays = 1.0 - wins as f64 / plays.max(1) as f64 >= self.wins && high < 1.0;
        Advantage { text, pays, unsure: false, leads: pays }
    }
}

/// Compares two reference players by wins, and then by mean score.
fn better(ladder: &Ladder, a: usize, b: usize) -> std::cmp::Ordering {
    let (a, b) = (&ladder.rungs[a].rate, &ladder.rungs[b].rate);
    a.wins.cmp(&b.wins).then(a.mean_score.total_cmp(&b.mean_score))
}

/// Returns the difference between the highest and the lowest score of all episodes.
fn range(played: &LadderPlays) -> f64 {
    let scores = || played.plays.iter().flatten().map(|play| play.episode.score);
    scores().fold(f64::NEG_INFINITY, f64::max) - scores().fold(f64::INFINITY, f64::min)
}

fn is_won(play: &Play) -> bool {
    play.episode.outcome == Outcome::Won
}

#[cfg(test)]
mod tests {
    use crate::{Criteria, Criterion, CriterionSet, Effort, Judging, Panel};
    use base::Seed;
    use engine::Game;

    /// A game with a path past a wandering, deadly sprite. A player that stands still is safe, but never
    /// wins.
    const GAME: &str = "\
BasicGame
    SpriteSet
        avatar > MovingAvatar
        goal > Immovable
        stray > RandomNPC cooldown=4
        wall > Immovable
    LevelMapping
        A > avatar
        g > goal
        r > stray
        w > wall
    InteractionSet
        goal avatar > killSprite
        avatar wall > stepBack
        stray wall > stepBack
        avatar stray > killSprite
    TerminationSet
        SpriteCounter stype=goal limit=0 win=True
        SpriteCounter stype=avatar limit=0 win=False
        Timeout limit=40 win=False
";

    /// Judges a level both in full and sequentially. The verdicts must agree, and the sequential judgement
    /// must use fewer episodes.
    #[track_caller]
    fn check(level: &str, strong: &str, passes: bool) {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level(level).unwrap();
        let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
        let criteria = Criteria {
            ask: CriterionSet::of(&[Criterion::Skill]),
            ladder: names(&["do-nothing", strong]),
            held_out: names(&[strong]),
            ..Criteria::default()
        };
        let judged = |effort| {
            let panel = Panel::new(criteria.check().unwrap(), effort);
            let report = panel.judge(Judging::level(&game, &level, Seed::from_text("sequential")));
            let plays = report.ladder().unwrap().rungs[0].rate.plays;
            (report.passes(), plays)
        };
        let [full, sequential] = [Effort::Full, Effort::Sequential].map(judged);
        assert_eq!(full, (passes, criteria.ladder_plays));
        assert_eq!(sequential.0, passes);
        assert!(sequential.1 < full.1, "{} plays", sequential.1);
    }

    #[test]
    fn plays_stop_when_the_answer_is_as_good_as_sure() {
        let open = "wwwwwwww\nwA    gw\nw      w\nw    r w\nwwwwwwww\n";
        check(open, "olets:100", true);
        check(open, "random", false);
    }
}
