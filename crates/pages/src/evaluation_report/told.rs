//! The report's introduction, which states the number of episodes that are included, and the reasons why the
//! others are not.

use super::Results;
use crate::page::words;
use evaluation::Evaluation;
use evaluation::metrics::{Choices, EpisodeStatus};
use evaluation::study::Study;
use itertools::Itertools;
use report::{Table, in_markdown};
use std::collections::{BTreeMap, BTreeSet};

/// The introductory text for the page and the Markdown file.
pub(super) struct Told {
    pub(super) title: String,
    /// A line stating the source of the results.
    pub(super) subtitle: String,
    /// A summary of the results, followed by a paragraph about the failures of each player.
    pub(super) verdict: Vec<String>,
    /// Sentences about the numbers of included episodes, players and levels.
    pub(super) counted: Vec<String>,
    /// Warnings about limitations of the comparisons.
    pub(super) warnings: Vec<String>,
}

impl Told {
    pub(super) fn of(results: &Results<'_>) -> Told {
        let Results { study, evaluations, .. } = results;
        let (games, levels) = (study.games.len() as u64, levels(study));
        let title = format!(
            "{} on {}, {}",
            words::many(study.players.len() as u64, "player"),
            words::many(games, "game"),
            words::many(levels, "level")
        );
        let mut counted = vec![episodes(study), common(study, levels)];
        counted.extend(citation(evaluations));
        counted.extend(answers(study));
        counted.push(
            "Intervals are 95% intervals. A dash marks an unknown value, never 0. `arcade docs report` \
             explains each section, and `arcade docs metrics` explains each number."
                .to_owned(),
        );
        Told {
            title,
            subtitle: subtitle(evaluations),
            verdict: study.verdict(),
            counted,
            warnings: study.notes.clone(),
        }
    }

    pub(super) fn markdown(&self, tables: &[Table]) -> String {
        let mut text = format!("# {}\n\n{}\n", in_markdown(&self.title), in_markdown(&self.subtitle));
        for (at, sentence) in self.verdict.iter().enumerate() {
            let [gap, mark] = if at == 0 {
                ["\n", ""]
            } else if at == 1 {
                ["\n", "- "]
            } else {
                ["", "- "]
            };
            text += &format!("{gap}{mark}{}\n", in_markdown(sentence));
        }
        for sentence in &self.counted {
            text += &format!("\n{}\n", in_markdown(sentence));
        }
        for warning in &self.warnings {
            text += &format!("\n> {}\n", in_markdown(warning));
        }
        for table in tables.iter().filter(|table| !table.rows.is_empty()) {
            text += &format!("\n{}", table.to_markdown());
        }
        text
    }
}

fn levels(study: &Study) -> u64 {
    study.games.iter().map(|game| game.levels.len() as u64).sum()
}

/// Returns a sentence for citing the result, if all results come from releases.
fn citation(evaluations: &[Evaluation]) -> Option<String> {
    let one = |evaluation: &Evaluation| {
        let root = evaluation.settings.snapshot?;
        let release = evaluation.subjects.iter().find_map(|subject| subject.facts.release.clone());
        let name = release.map_or_else(|| "release".to_owned(), |name| format!("release {name}"));
        let suite = &evaluation.settings.suite;
        Some(format!("Infinite Arcade, {name}, root {root}, evaluated with arcade {suite}"))
    };
    let cited: Option<BTreeSet<String>> = evaluations.iter().map(one).collect();
    let cited = cited?.into_iter().join("; ");
    (!cited.is_empty()).then(|| format!("Cite this result as: {cited}."))
}

/// Returns a line stating the source, such as `snapshot 3f2a…, seed “evaluate”, at most 1 000 steps an
/// episode, semantics 2, arcade 0.1.0`.
fn subtitle(evaluations: &[Evaluation]) -> String {
    let all = |said: &dyn Fn(&Evaluation) -> String| {
        let different: BTreeSet<String> = evaluations.iter().map(said).collect();
        different.into_iter().collect::<Vec<String>>().join(" and ")
    };
    let snapshot = all(&|evaluation| {
        evaluation
            .settings
            .snapshot
            .map_or("no snapshot".to_owned(), |root| format!("snapshot {}", root.short()))
    });
    let seed = all(&|evaluation| format!("“{}”", evaluation.settings.seed));
    let limits: BTreeSet<u64> = evaluations.iter().map(|evaluation| evaluation.settings.max_steps).collect();
    let limit = limits.into_iter().map(words::grouped).collect::<Vec<_>>().join(" and ");
    let semantics = all(&|evaluation| evaluation.settings.semantics.to_string());
    let suite = all(&|evaluation| evaluation.settings.suite.clone());
    format!(
        "{snapshot} · seed {seed} · at most {limit} steps per episode · semantics {semantics} · arcade \
         {suite}"
    )
}

/// Returns a sentence stating the number of episodes that are included, and the reasons why the others are
/// not.
fn episodes(study: &Study) -> String {
    let ended = study.episodes.iter().filter(|episode| episode.metrics.counts()).count();
    let mut excluded: BTreeMap<String, u64> = BTreeMap::new();
    for episode in &study.episodes {
        let why = match &episode.metrics.status {
            EpisodeStatus::Over | EpisodeStatus::StepLimit => continue,
            EpisodeStatus::Halted(reason) => match reason.as_str() {
                "infrastructure" => "aborted by network, server or process".to_owned(),
                "budget" => "aborted by a cap on cost, tokens or requests".to_owned(),
                "rejected" => "aborted because the server rejected the request".to_owned(),
                other => format!("aborted ({other})"),
            },
            EpisodeStatus::Interrupted => "interrupted and not finished".to_owned(),
        };
        *excluded.entry(why).or_default() += 1;
    }
    let all = words::many(study.episodes.len() as u64, "episode");
    if excluded.is_empty() {
        return format!("{all}: all of them ended, and none was excluded.");
    }
    let why: Vec<String> =
        excluded.iter().map(|(why, count)| format!("{} {why}", words::grouped(*count))).collect();
    let ended = words::grouped(ended as u64);
    format!("{all}: {ended} ended and are counted. Excluded from all figures: {}.", why.join(", "))
}

/// Returns a sentence about the levels on which the players can be compared.
fn common(study: &Study, levels: u64) -> String {
    let played = |player: usize| -> BTreeSet<(usize, usize)> {
        let ended = study.on(player, None, None).iter().filter(|episode| episode.metrics.counts());
        ended.map(|episode| (episode.game, episode.metrics.level)).collect()
    };
    let all =
        (0..study.players.len()).map(played).reduce(|all, one| all.intersection(&one).copied().collect());
    let common = all.map_or(0, |all| all.len() as u64);
    match (study.players.len(), common) {
        (1, _) => format!("One player on {}.", words::many(levels, "level")),
        (_, all) if all == levels => format!("All players have played all {}.", words::many(levels, "level")),
        (_, 0) => "No level was played by all players: rates over all levels are not comparable. Pairs are \
                   compared on levels that both played."
            .to_owned(),
        (_, some) => format!(
            "{} of {} were played by all players; rates over all levels are comparable only to that extent. \
             Pairs are compared on levels that both played.",
            words::grouped(some),
            words::many(levels, "level")
        ),
    }
}

/// Returns a sentence with statistics about the models' answers, if any.
fn answers(study: &Study) -> Option<String> {
    let models = study.leaderboard.iter().filter(|row| !study.players[row.player].is_reference());
    let mut all = Choices::default();
    models.for_each(|row| all.add(&row.choices));
    (all.total() > 0).then(|| {
        let useless = [
            (all.invalid, "because no answer could be read"),
            (all.refused, "because the model refused to answer"),
            (all.truncated, "because the answer was cut off"),
        ];
        let useless = useless.into_iter().filter(|(count, _)| *count > 0);
        let useless = useless.map(|(count, why)| format!("in {} {why}", words::grouped(count))).join(", ");
        let steps = words::grouped(all.total());
        let useless = match useless.as_str() {
            "" => format!("All {steps} decisions (excluding baselines) had a usable answer"),
            some => format!("In {steps} decisions (excluding baselines), no action was taken {some}"),
        };
        match all.tolerant {
            0 => format!("{useless}."),
            some => {
                let some = words::grouped(some);
                format!("{useless}; {some} were read from answers that are not in the requested format.")
            }
        }
    })
}
