//! The verdicts on a set of levels, and the episodes played on them.

use crate::reported::{PlayerRate, in_order, obstacles};
use crate::survey::{FOR_NOTHING, SurveyedLevel};
use engine::Game;
use report::{Mean, Quantiles, Section, Share, Table, TableCell};
use serde::Serialize;
use validators::{Criterion, Ladder, Line, PlayerResult, Verdict, is_guard};

/// The unit over which means are taken.
const LEVEL: &str = "level";

/// A measure compared with the same measure of the game's own levels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// `columns`, `rows`, or a measure of the layout.
    pub measure: String,
    /// The minimum and maximum over the game's own levels.
    pub examples: [f64; 2],
    /// The minimum and maximum over the set.
    pub levels: [f64; 2],
    /// The fraction of levels within the range of the game's own levels.
    pub within: Share,
}

pub(super) fn validity(levels: &[SurveyedLevel], fits: &[Fit]) -> Section {
    let asked = |level: &SurveyedLevel| {
        level.report.finding(Criterion::WellFormed).map(|found| found.verdict.is_pass())
    };
    let first = levels.iter().filter_map(|level| level.report.first_obstacle());
    let note = "`arcade docs validate` explains each criterion.";
    let section = Section::new("validity", "Are the levels valid?", note)
        .share("well_formed", "well-formed", Share::yes(levels.iter().filter_map(asked)))
        .share(
            "clean",
            "without warnings",
            Share::yes(levels.iter().map(|level| level.level.warnings().is_empty())),
        )
        .share("passes", "every criterion met", Share::yes(levels.iter().map(|level| level.report.passes())))
        .tally("obstacles", "first failure", &obstacles(first), Some(levels.len() as u64))
        .data("fit", fits);
    if fits.is_empty() { section } else { section.table(beside(fits)) }
}

pub(super) fn fits(levels: &[SurveyedLevel], examples: &[SurveyedLevel]) -> Vec<Fit> {
    let layout = examples.first().map_or(&[][..], |level| &level.layout);
    let names = ["columns", "rows"].into_iter().chain(layout.iter().map(|(name, _)| name.as_str()));
    let values = |of: &[SurveyedLevel], name: &str| -> Vec<f64> {
        let value = |level: &SurveyedLevel| match name {
            "columns" => Some(level.level.columns() as f64),
            "rows" => Some(level.level.rows() as f64),
            _ => level.measure(name),
        };
        of.iter().filter_map(value).collect()
    };
    let fit = |measure: &str| {
        let (ours, own) = (values(levels, measure), values(examples, measure));
        let (levels, [low, high]) = (span(&ours)?, span(&own)?);
        let within = Share::yes(ours.iter().map(|value| (low..=high).contains(value)));
        Some(Fit { measure: measure.to_owned(), examples: [low, high], levels, within })
    };
    names.filter_map(fit).collect()
}

fn span(values: &[f64]) -> Option<[f64; 2]> {
    let found = Quantiles::of(values)?;
    Some([found.min, found.max])
}

/// Returns a table that compares the ranges of each measure in the set and in the game's own levels.
fn beside(fits: &[Fit]) -> Table {
    let mut table = Table::new("fit", "", "", &["", "these levels", "the game's own", "within them"]);
    let span = |[low, high]: [f64; 2]| {
        let [low, high] = [low, high].map(|end| TableCell::short(end).plain());
        TableCell::Figure(if low == high { low } else { format!("{low} to {high}") })
    };
    for fit in fits {
        let within = TableCell::Figure(format!("{} of {}", fit.within.count, fit.within.of));
        table.push(vec![TableCell::text(&*fit.measure), span(fit.levels), span(fit.examples), within]);
    }
    table
}

pub(super) fn solvability(levels: &[SurveyedLevel]) -> Section {
    let solved = |level: &SurveyedLevel| level.report.witness.is_some();
    let impossible = |level: &SurveyedLevel| {
        level
            .report
            .finding(Criterion::Winnable)
            .is_some_and(|found| matches!(found.verdict, Verdict::Fail { .. }))
    };
    let unknown = |level: &SurveyedLevel| !solved(level) && !impossible(level);
    let share = |test: &dyn Fn(&SurveyedLevel) -> bool| Share::yes(levels.iter().map(test));
    Section::new("solvability", "Can the levels be won?", "")
        .share(
            "solved",
            "solved: a winning episode was found, and a replay confirmed the win",
            share(&solved),
        )
        .share("impossible", "impossible: proven", share(&impossible))
        .share("unknown", "unknown: the budget was spent", share(&unknown))
}

pub(super) fn triviality(levels: &[SurveyedLevel]) -> Section {
    let rate = |level: &SurveyedLevel, criterion: Criterion| {
        let measured = level.report.finding(criterion)?.measured.as_ref()?;
        Some((measured.wins, measured.plays))
    };
    let pooled = |criterion: Criterion| {
        let rates = levels.iter().filter_map(|level| rate(level, criterion));
        let (wins, plays) = rates.fold((0, 0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
        Share::new(wins, plays)
    };
    let few = |(wins, plays): (u64, u64)| wins as f64 <= FOR_NOTHING * plays as f64;
    let of_few = |level: &SurveyedLevel, criterion: Criterion| rate(level, criterion).map(few);
    let of_levels =
        |criterion: Criterion| Share::yes(levels.iter().filter_map(|level| of_few(level, criterion)));
    let both = |level: &SurveyedLevel| {
        Some(of_few(level, Criterion::NotIdle)? && of_few(level, Criterion::NotRandom)?)
    };
    let at_most = |who: &str| format!("levels where {who} at most 10% of episodes");
    Section::new("triviality", "Can the levels be won without effort?", "")
        .share("idle", "episodes won by doing nothing", pooled(Criterion::NotIdle))
        .share("random", "episodes won by random keys", pooled(Criterion::NotRandom))
        .share("idle_levels", at_most("doing nothing wins"), of_levels(Criterion::NotIdle))
        .share("random_levels", at_most("random keys win"), of_levels(Criterion::NotRandom))
        .share("both_levels", "both", Share::yes(levels.iter().filter_map(both)))
}

pub(super) fn lengths(levels: &[SurveyedLevel]) -> Section {
    let measures = || levels.iter().filter_map(|level| level.measures.as_ref());
    let ticks: Vec<f64> = measures().map(|measures| measures.ticks as f64).collect();
    let shortest: Vec<f64> =
        measures().filter_map(|measures| measures.shortest).map(|ticks| ticks as f64).collect();
    let mut pushes: Vec<f64> = measures().map(|measures| measures.pushes as f64).collect();
    if pushes.iter().all(|pushes| *pushes == 0.0) {
        pushes.clear();
    }
    Section::new("lengths", "How long is a win?", "The length of the shortest win found.")
        .share("proved", "proven minimal", Share::new(shortest.len() as u64, ticks.len() as u64))
        .quantiles("ticks", "ticks of the witness", &ticks)
        .quantiles("shortest", "ticks, if proven minimal", &shortest)
        .quantiles("pushes", "pushes of the witness", &pushes)
}

/// Describes the skill required by the levels; `None` if no ladder (reference players of increasing strength) played.
pub(super) fn skill(levels: &[SurveyedLevel]) -> Option<Section> {
    let gaps = || levels.iter().filter_map(|level| level.measures.as_ref()?.skill);
    let wins: Vec<f64> = gaps().map(|gap| gap.wins).collect();
    let reward: Vec<f64> = gaps().filter_map(|gap| gap.reward).collect();
    let ladders: Vec<&Ladder> = levels.iter().filter_map(|level| level.ladder.as_ref()).collect();
    let fares = |fared: &PlayerResult| {
        (fared.rate.wins as f64 / fared.rate.plays.max(1) as f64, fared.rate.mean_score)
    };
    let order = |ladder: &&Ladder| in_order(&ladder.rungs.iter().map(fares).collect::<Vec<_>>());
    let order: Vec<f64> = ladders.iter().filter_map(order).collect();
    let wins = Mean::over(LEVEL, &wins)?;
    let section =
        Section::new("skill", "Does skill pay?", "Means over levels; then each player over all levels.")
            .gain("wins", "more wins by looking ahead", Some(wins))
            .gain("reward", "more score by looking ahead", Mean::over(LEVEL, &reward))
            .gain("order", "players rank in ladder order (rank correlation)", Mean::over(LEVEL, &order));
    Some(PlayerRate::add_all(section, ladders))
}

/// An interaction, and the levels that use it.
#[derive(Serialize)]
struct LineUse {
    /// The line, in canonical spelling.
    rule: String,
    /// `true` if the interaction is with the edge of the screen.
    guard: bool,
    /// The fraction of levels with a witness on which the witness executes the interaction.
    levels: Share,
}

pub(super) fn rules(game: &Game, levels: &[SurveyedLevel]) -> Section {
    let measures = || levels.iter().filter_map(|level| level.measures.as_ref());
    let each: Vec<f64> = measures().map(|measures| measures.mechanics).collect();
    let line = |line: usize| LineUse {
        rule: Line::interaction(game, line).text,
        guard: is_guard(game, line),
        levels: Share::yes(measures().map(|measures| measures.rules.contains(&line))),
    };
    let lines: Vec<LineUse> = (0..game.description().interactions.len()).map(line).collect();
    let used = Share::yes(lines.iter().filter(|line| !line.guard).map(|line| line.levels.count > 0));
    let note = "Each interaction is listed below, with the levels whose witness executes it.";
    let section = Section::new("rules", "Which rules do they use?", note)
        .share("used", "interactions that some witness executes", used)
        .mean("each", "fraction of these interactions that one witness executes", Mean::over(LEVEL, &each))
        .data("lines", &lines);
    lines.iter().fold(section, |section, line| {
        let edge = if line.guard { " (edge: not counted)" } else { "" };
        section.shown(format!("{}{edge}", line.rule), line.levels.into())
    })
}
