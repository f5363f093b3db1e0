//! The counts of candidates, rejections and calls, for levels and for games.

use report::{Table, TableCell};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use validators::Judgement;

/// The numbers of candidates tried for one position or for a whole release, and the reasons why candidates failed.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tally {
    /// The number of games tried.
    pub games_tried: u64,
    /// The number of games accepted.
    pub games_accepted: u64,
    /// The number of levels tried.
    pub levels_tried: u64,
    /// The number of levels accepted, including levels of games that failed later.
    pub levels_accepted: u64,
    /// The number of forward-model calls made by all judges.
    pub calls: u64,
    /// The number of levels that met all criteria except the requested difficulty and were not won by any player on the
    /// ladder of reference players.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub unbeaten: u64,
    /// The number of rejections by each criterion or generator.
    pub rejections: BTreeMap<String, u64>,
    /// The cost of each judge, under the name of its criterion or under a description.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub judges: BTreeMap<String, JudgeCost>,
}

/// The cost of requested levels, for documents. Time is not included, because it differs from run to run.
#[derive(Serialize)]
struct LevelCost<'a> {
    looks: u64,
    judged: u64,
    calls: u64,
    rejections: &'a BTreeMap<String, u64>,
    #[serde(skip_serializing_if = "is_zero")]
    unbeaten: u64,
}

/// Returns `true` if the count is 0, and can be omitted from a document.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// The cost of a judge, split by whether the candidate passed. Episodes played by gates do not count as calls, except
/// in searches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JudgeCost {
    /// The number of candidates that the judge examined.
    pub asked: u64,
    /// The number of candidates that the judge rejected.
    pub refused: u64,
    /// The forward-model calls spent on levels and games that were accepted.
    pub calls_accepted: u64,
    /// The forward-model calls spent on candidates rejected by this judge or a later one.
    pub calls_refused: u64,
    /// The forward-model calls spent on accepted levels of rejected games.
    pub calls_lost: u64,
}

impl JudgeCost {
    /// Returns the total number of forward-model calls.
    pub fn calls(&self) -> u64 {
        self.calls_accepted + self.calls_refused + self.calls_lost
    }

    fn add(&mut self, other: &JudgeCost) {
        self.asked += other.asked;
        self.refused += other.refused;
        self.calls_accepted += other.calls_accepted;
        self.calls_refused += other.calls_refused;
        self.calls_lost += other.calls_lost;
    }
}

/// The name of a quick evaluation in the list of judges.
const LOOK: &str = "look";

impl Tally {
    /// Counts an accepted game.
    pub fn game_accepted(&mut self) {
        self.games_tried += 1;
        self.games_accepted += 1;
    }

    /// Counts a rejected game, under its reason up to the first colon.
    pub fn game_rejected(&mut self, why: &str) {
        self.games_tried += 1;
        // The text after the colon differs with every seed.
        let kind = why.split(':').next().unwrap_or(why);
        self.reject(kind);
    }

    /// Counts a judged level.
    pub(crate) fn level(&mut self, judgements: &[Judgement], obstacle: Option<&str>) {
        self.levels_tried += 1;
        self.judgements(judgements);
        match obstacle {
            None => self.levels_accepted += 1,
            Some(criterion) => self.reject(criterion),
        }
    }

    /// Counts a rejection under its reason.
    pub(crate) fn reject(&mut self, why: &str) {
        *self.rejections.entry(why.to_owned()).or_default() += 1;
    }

    /// Counts a quick evaluation made by a search.
    pub(crate) fn look(&mut self, is_feasible: bool, calls: u64) {
        self.judge(LOOK, is_feasible, calls);
    }

    /// Returns the number of candidates that searches evaluated.
    pub fn looks(&self) -> u64 {
        self.judges.get(LOOK).map_or(0, |look| look.asked)
    }

    /// Returns the document on the cost of requested levels.
    pub fn level_cost(&self) -> impl Serialize + '_ {
        let Tally { levels_tried: judged, calls, unbeaten, ref rejections, .. } = *self;
        LevelCost { looks: self.looks(), judged, calls, rejections, unbeaten }
    }

    /// Counts a level that could not be generated.
    pub(crate) fn no_level(&mut self, why: &str) {
        self.level(&[], Some(why));
    }

    /// Counts the cost of judgements, each under its criterion.
    pub(crate) fn judgements(&mut self, judgements: &[Judgement]) {
        for judgement in judgements {
            let finding = &judgement.finding;
            self.judge(judgement.criterion.name(), finding.verdict.is_pass(), finding.calls());
        }
    }

    /// Counts the cost of one verdict.
    pub(crate) fn judge(&mut self, judge: &str, is_met: bool, calls: u64) {
        self.calls += calls;
        let cost = self.judges.entry(judge.to_owned()).or_default();
        cost.asked += 1;
        cost.refused += u64::from(!is_met);
        cost.calls_accepted += calls;
    }

    /// Runs `judge` and adds its cost. If `judge` accepts nothing, `refused` first converts the cost.
    pub(crate) fn spend<T>(
        &mut self,
        refused: fn(Tally) -> Tally,
        judge: impl FnOnce(&mut Tally) -> Option<T>,
    ) -> Option<T> {
        let mut spent = Tally::default();
        let let_in = judge(&mut spent);
        self.add(&if let_in.is_some() { spent } else { refused(spent) });
        let_in
    }

    /// Converts the counts for a level that was rejected in the end.
    #[must_use]
    pub(crate) fn of_refused(mut self) -> Tally {
        for cost in self.judges.values_mut() {
            cost.calls_refused += std::mem::take(&mut cost.calls_accepted);
        }
        self
    }

    /// Converts the counts for a game that was rejected in the end.
    #[must_use]
    pub(crate) fn of_lost(mut self) -> Tally {
        for cost in self.judges.values_mut() {
            cost.calls_lost += std::mem::take(&mut cost.calls_accepted);
        }
        self
    }

    /// Reclassifies an accepted level as rejected.
    pub(crate) fn level_taken_back(&mut self, why: &str) {
        self.levels_accepted -= 1;
        self.reject(why);
    }

    /// Reclassifies an accepted game as rejected.
    pub(crate) fn taken_back(&mut self, why: &str) {
        self.games_accepted -= 1;
        self.reject(why);
    }

    /// Adds the counts of another order or position.
    pub fn add(&mut self, other: &Tally) {
        self.games_tried += other.games_tried;
        self.games_accepted += other.games_accepted;
        self.levels_tried += other.levels_tried;
        self.levels_accepted += other.levels_accepted;
        self.calls += other.calls;
        self.unbeaten += other.unbeaten;
        for (why, count) in &other.rejections {
            *self.rejections.entry(why.clone()).or_default() += count;
        }
        for (judge, cost) in &other.judges {
            self.judges.entry(judge.clone()).or_default().add(cost);
        }
    }

    /// Returns the judges' cost per game, for `made` games, from most to least expensive.
    pub fn judges_table(&self, made: u64) -> Table {
        let columns = [
            "judge",
            "asked",
            "rejected",
            "simulator calls (millions)",
            "on accepted levels",
            "on rejected levels",
            "on levels of rejected games",
            "calls per game",
        ];
        let note = "Forward-model calls by the outcome for the judged candidates: accepted, rejected by this \
                    judge or a later judge, or accepted as a level of a rejected game. Gates count only \
                    the calls of their own searches.";
        let mut judges: Vec<(&String, &JudgeCost)> = self.judges.iter().collect();
        judges.sort_by_key(|(name, cost)| (std::cmp::Reverse(cost.calls()), *name));
        let mut table = Table::new("judges", "Judges", note, &columns);
        let millions = |calls: u64| TableCell::number(calls as f64 / 1e6, 2);
        for (name, cost) in judges {
            table.push(vec![
                TableCell::text(name.as_str()),
                TableCell::Count(cost.asked),
                TableCell::Count(cost.refused),
                millions(cost.calls()),
                millions(cost.calls_accepted),
                millions(cost.calls_refused),
                millions(cost.calls_lost),
                TableCell::count(cost.calls().checked_div(made)),
            ]);
        }
        table
    }

    /// Returns the rejections as text, from most to least frequent.
    pub fn reasons(&self) -> String {
        reasons(&self.rejections)
    }
}

/// Returns the text for a recorded reason, which is either a criterion name or a short phrase.
fn words(why: &str) -> String {
    match why {
        "less than an earlier level" => "easier than an earlier level".to_owned(),
        "second judges" | "further judges" => "failed the re-check".to_owned(),
        criterion if !criterion.contains(' ') => format!("failed `{criterion}`"),
        other => match other.strip_prefix("no level ") {
            Some(number) => format!("without level {number}"),
            None => format!("({other})"),
        },
    }
}

/// Returns rejections as text, from most to least frequent: `29 easier than an earlier level, 4 failed the re-check`.
pub fn reasons(rejections: &BTreeMap<String, u64>) -> String {
    let mut told: BTreeMap<String, u64> = BTreeMap::new();
    for (why, count) in rejections {
        *told.entry(words(why)).or_default() += count;
    }
    let mut reasons: Vec<(String, u64)> = told.into_iter().collect();
    reasons.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let words: Vec<String> = reasons.iter().map(|(why, count)| format!("{count} {why}")).collect();
    words.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number before a bare criterion name, such as `96 winnable`, would read as a number of successes.
    #[test]
    fn rejections_are_sentences() {
        let counts = [
            ("less than an earlier level", 29),
            ("second judges", 3),
            ("further judges", 1),
            ("winnable", 2),
            ("no level 0", 2),
        ];
        let rejections = counts.map(|(why, count)| (why.to_owned(), count)).into();
        let expect =
            "29 easier than an earlier level, 4 failed the re-check, 2 failed `winnable`, 2 without level 0";
        assert_eq!(reasons(&rejections), expect);
    }

    #[test]
    fn calls_are_told_by_the_fate_of_what_was_judged() {
        let spent = |calls, is_met| {
            let mut tally = Tally::default();
            tally.judge("winnable", is_met, calls);
            tally
        };
        let mut game = Tally::default();
        game.add(&spent(30, true));
        game.add(&spent(100, false).of_refused());
        let mut all = game.clone().of_lost();
        all.add(&game);
        let cost = all.judges["winnable"];
        let [accepted, refused, lost] = [cost.calls_accepted, cost.calls_refused, cost.calls_lost];
        assert_eq!(([accepted, refused, lost], cost.asked, cost.refused), ([30, 200, 30], 4, 2));
        assert_eq!((all.calls, cost.calls()), (260, 260));
        let table = all.judges_table(2).to_csv();
        assert!(table.contains("winnable,4,2,"), "{table}");
    }
}
