//! The `skill` criterion: playing well pays on a level.

use crate::evidence::Evidence;
use crate::ladder::{Ladder, LadderConfig, LadderPlays, PlayerResult};
use crate::verdict::{Case, Finding, Validator, Verdict};
use agents::Play;
use engine::Outcome;
use statistics::{Interval, Z95};

/// Stronger players win more, or score more, than players that do not look ahead: by a margin, and significantly (the
/// 95 % interval of the difference is above 0). One player of the ladder and one held-out player must show it: a
/// level must not be fitted to the players that found it.
///
/// In a deterministic game a witness counts as a player that always wins and was held out; so a puzzle that is too
/// deep for every player of the ladder still shows skill, if players that do not look ahead lose it.
#[derive(Clone, Debug)]
pub struct SkillPays {
    /// The players and the limits of their plays.
    pub players: LadderConfig,
    /// The difference that win rates must reach.
    pub wins: f64,
    /// Or the difference that mean scores must reach, as a share of the range of all scores.
    pub scores: f64,
    /// Forward-model calls of one play, after which it is broken off; then a failure becomes unknown.
    pub play_calls: u64,
}

/// Resamples for an interval of scores.
const RESAMPLES: usize = 1000;

/// The advantage of one player over another.
struct Advantage {
    text: String,
    /// `true` if it is large enough and significant.
    pays: bool,
    /// `true` if it is large enough, but not significant.
    unsure: bool,
}

impl Validator for SkillPays {
    fn name(&self) -> &'static str {
        "skill"
    }

    fn validate(&self, case: Case<'_>) -> Finding {
        let played = self.players.play_within(case, self.play_calls);
        let cut = played.broken_off(self.play_calls);
        let ladder = self.players.measure(&played);
        let spent = played.plays.iter().flatten().map(|play| play.calls).sum();
        let range = range(&played);
        // The baseline is the best of the players that do not look ahead.
        let is_baseline = |&at: &usize| !ladder.rungs[at].looks_ahead;
        let Some(weak) = (0..ladder.rungs.len()).filter(is_baseline).max_by(|&a, &b| better(&ladder, a, b))
        else {
            return Verdict::Unknown { spent }.into();
        };
        let strong = (0..ladder.rungs.len()).filter(|at| !is_baseline(at));
        let advantages: Vec<Advantage> = strong
            .map(|at| self.advantage(&ladder.rungs[at], &played.plays[at], (&ladder, &played), weak, range))
            .collect();
        let first = ladder.rungs.len();
        let mut held: Vec<Advantage> = ladder
            .held_out
            .iter()
            .enumerate()
            .map(|(at, result)| {
                self.advantage(result, &played.plays[first + at], (&ladder, &played), weak, range)
            })
            .collect();
        // In a deterministic game any win is a plan that wins every time.
        let won = case.witness.is_some() || played.plays.iter().flatten().any(is_won);
        let planned = won && case.game.is_deterministic();
        let by_search = planned.then(|| self.against_search(&ladder.rungs[weak]));
        let searched = by_search.as_ref().is_some_and(|advantage| advantage.pays);
        let shown = advantages.iter().any(|advantage| advantage.pays) || searched;
        held.extend(by_search);
        let accepted = held.iter().any(|advantage| advantage.pays);
        let unsure = advantages.iter().chain(&held).any(|advantage| advantage.unsure);
        let verdict = if shown && accepted {
            Verdict::pass()
        } else if unsure || !won || (shown && !accepted) || cut > 0 {
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
                "let choices matter: dangers that foresight avoids, points that a plan earns, less luck"
                    .to_owned(),
            );
        }
        if cut > 0 {
            let text = format!("{cut} plays were stopped by the budget");
            evidence.insert(0, Evidence::new(text));
        }
        let episodes = played.plays.into_iter().flatten().map(|play| play.episode);
        Finding { ladder: Some(ladder), ..Finding::from(verdict).seen(evidence).played(episodes) }
    }
}

impl SkillPays {
    fn advantage(
        &self,
        result: &PlayerResult,
        plays: &[Play],
        (ladder, played): (&Ladder, &LadderPlays),
        weak: usize,
        range: f64,
    ) -> Advantage {
        let weaker = &ladder.rungs[weak];
        let ([won, lost], [of, out_of]) =
            ([result.rate.wins, weaker.rate.wins], [result.rate.plays, weaker.rate.plays]);
        let interval = statistics::difference([won, lost], [of, out_of], Z95);
        let more = won as f64 / of.max(1) as f64 - lost as f64 / out_of.max(1) as f64;
        let (points, least, most) = (100.0 * more, 100.0 * interval.low, 100.0 * interval.high);
        let mut text = format!(
            "{} wins {won} of {of}, {} {lost} of {out_of} ({points:+.0} points; 95 %: {least:+.0} to {most:+.0})",
            result.player, weaker.player,
        );
        let (mut pays, mut unsure) = (interval.low > 0.0 && more >= self.wins, more >= self.wins);
        if range <= 0.0 {
            text.push_str(", and all score alike");
        } else {
            let gains: Vec<f64> = plays
                .iter()
                .zip(&played.plays[weak])
                .map(|(strong, weak)| strong.episode.score - weak.episode.score)
                .collect();
            let mean = |sample: &[f64]| sample.iter().sum::<f64>() / sample.len() as f64;
            let sure = statistics::bootstrap(&gains, mean, RESAMPLES, 0.95, [0; 32]);
            if let (Some(Interval { low, high }), false) = (sure, gains.is_empty()) {
                let gain = mean(&gains);
                text.push_str(&format!(", and scores {gain:+.2} (95 %: {low:+.2} to {high:+.2})"));
                pays |= low > 0.0 && gain >= self.scores * range;
                unsure |= gain >= self.scores * range;
            }
        }
        Advantage { text, pays, unsure: unsure && !pays }
    }

    /// Compares the witness, which wins every time, with the weaker player.
    fn against_search(&self, weaker: &PlayerResult) -> Advantage {
        let (wins, plays) = (weaker.rate.wins, weaker.rate.plays);
        let text =
            format!("a player that knows the solution wins every time, {} {wins} of {plays}", weaker.player);
        let high = weaker.rate.interval[1];
        let pays = 1.0 - wins as f64 / plays.max(1) as f64 >= self.wins && high < 1.0;
        Advantage { text, pays, unsure: false }
    }
}

/// Compares two rungs by wins, then by mean score.
fn better(ladder: &Ladder, a: usize, b: usize) -> std::cmp::Ordering {
    let (a, b) = (&ladder.rungs[a].rate, &ladder.rungs[b].rate);
    a.wins.cmp(&b.wins).then(a.mean_score.total_cmp(&b.mean_score))
}

/// The greatest score of all plays minus the least.
fn range(played: &LadderPlays) -> f64 {
    let scores = || played.plays.iter().flatten().map(|play| play.episode.score);
    scores().fold(f64::NEG_INFINITY, f64::max) - scores().fold(f64::INFINITY, f64::min)
}

fn is_won(play: &Play) -> bool {
    play.episode.outcome == Outcome::Won
}
