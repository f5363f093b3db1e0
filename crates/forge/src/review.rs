//! Judgements on a game in words: first the verdict, then the reasons. `arcade validate` prints them, and models that
//! design games read them.

use engine::line_and_column;
use std::fmt::Write;
use validators::{
    Criterion, Difficulty, Evidence, Finding, Judgement, Ladder, PlayerResult, Rate, Report, Verdict,
};

/// The maximum width of a board to show, in columns.
const MAX_WIDTH: usize = 100;
/// The maximum number of boards to show per level.
const MOST_BOARDS: usize = 1;
/// The maximum number of pieces of evidence to show per criterion.
const MOST_SEEN: usize = 6;
/// The maximum number of causes to show per chain of causes.
const MOST_LINKS: usize = 16;

/// A judged game, to be put into words.
pub struct Review<'a> {
    /// The name of the game's file in messages, such as `game.vgdl`.
    pub source: &'a str,
    /// `true` if every level and the game meet every criterion.
    pub passes: bool,
    /// The levels, in the game's order.
    pub levels: Vec<ReviewedLevel<'a>>,
    /// The judgements on the game across all its levels.
    pub judgements: &'a [Judgement],
    /// The warnings about the files, as text.
    pub warnings: &'a [String],
}

/// A level of a judged game.
pub struct ReviewedLevel<'a> {
    /// The name of the level's file in messages, such as `lvl0.txt`.
    pub name: &'a str,
    /// `true` if the level meets every criterion.
    pub passes: bool,
    /// The level's characters, from top to bottom.
    pub board: &'a [String],
    /// The findings, or `None` if the text is not a level of the game.
    pub report: Option<&'a Report>,
}

/// Fills in the line numbers of the rules in a finding's evidence. `source` is the game's text.
pub fn locate(finding: &mut Finding, source: &str) {
    for rule in finding.evidence.iter_mut().filter_map(|seen| seen.rule.as_mut()) {
        rule.line = Some(line_and_column(source, rule.span.start).0);
    }
}

impl Review<'_> {
    /// Returns the review as text: the verdicts, the warnings about the files, and the criteria. A quiet review omits
    /// everything that passes, so it is empty if everything passes.
    pub fn text(&self, quiet: bool) -> String {
        review(self, quiet)
    }
}

fn review(document: &Review<'_>, quiet: bool) -> String {
    let (source, warnings) = (document.source, document.warnings);
    if quiet && document.passes {
        return String::new();
    }
    let shown: Vec<&ReviewedLevel<'_>> =
        document.levels.iter().filter(|level| !quiet || !level.passes).collect();
    let mut text = String::new();
    let names = document.levels.iter().map(|level| level.name.len());
    let width = names.chain([source.len()]).max().unwrap_or_default();
    for level in &shown {
        let _ = writeln!(text, "{:<width$}  {}", level.name, headline(level, source));
    }
    let passed = document.levels.iter().filter(|level| level.passes).count();
    let count = document.levels.len();
    let together = document
        .judgements
        .iter()
        .find(|judgement| !judgement.finding.verdict.is_pass() && !judgement.is_skipped());
    let of_game = match together {
        Some(judgement) => format!("; {}", obstacle(judgement, source)),
        None => String::new(),
    };
    let word = if document.passes { "passes" } else { "does not pass" };
    let _ =
        writeln!(text, "{source:<width$}  {word}: {passed} of {count} levels meet every criterion{of_game}");
    for warning in warnings {
        let _ = writeln!(text, "\n{}", warning.trim_end());
    }
    for level in &shown {
        if let Some(report) = level.report {
            let _ = writeln!(text, "\n{}", level.name);
            // Evidence with a board of its own shows more than the plain board.
            let seen = |judgement: &Judgement| {
                !judgement.finding.verdict.is_pass()
                    && judgement.finding.evidence.iter().any(|seen| seen.board.is_some())
            };
            if !report.passes() && !report.judgements.iter().any(seen) {
                board(&mut text, level.board);
            }
            let mut boards = 0;
            for judgement in &report.judgements {
                criterion(&mut text, judgement, source, &mut boards);
                if let Some(ladder) = &judgement.finding.ladder {
                    ladder_results(&mut text, ladder);
                }
            }
        }
    }
    if !document.judgements.is_empty() && (!quiet || together.is_some()) {
        let _ = writeln!(text, "\n{source}, all levels together");
        let mut boards = 0;
        for judgement in document.judgements {
            criterion(&mut text, judgement, source, &mut boards);
        }
    }
    text
}

/// Returns a one-line verdict on a level.
fn headline(level: &ReviewedLevel<'_>, source: &str) -> String {
    let Some(report) = level.report else { return "is not a level of this game".to_owned() };
    if let Some(judgement) = report.first_obstacle() {
        return obstacle(judgement, source);
    }
    let won = report
        .witness
        .as_ref()
        .map_or(String::new(), |won| format!(": won in {}", base::count(won.actions.len(), "tick")));
    let hard = report.ladder().map_or(String::new(), |ladder| match ladder.difficulty {
        Difficulty::Unbeaten => "; no planner on the ladder wins it".to_owned(),
        difficulty => format!(", {} for the planners", in_words(difficulty)),
    });
    format!("passes{won}{hard}")
}

/// Returns a difficulty label in words, such as `very hard`.
fn in_words(difficulty: Difficulty) -> String {
    difficulty.to_string().replace('_', " ")
}

/// Returns one line with the reason why a criterion does not pass, and the position of the rule that the reason quotes.
fn obstacle(judgement: &Judgement, source: &str) -> String {
    let Judgement { criterion, finding } = judgement;
    match &finding.verdict {
        Verdict::Fail { reason, .. } => {
            let rules = finding.evidence.iter().filter_map(|seen| seen.rule.as_ref());
            let line = rules
                .filter(|rule| reason.0.contains(&format!("`{}`", rule.text)))
                .find_map(|rule| rule.line);
            let place = line.map_or(String::new(), |line| format!(" ({}:{line})", source));
            format!("FAILS {criterion}: {}{place}", reason.0)
        }
        _ => format!("not shown to pass {criterion}: {}", judgement.answer()),
    }
}

/// Writes one criterion, with its answer and its evidence.
fn criterion(text: &mut String, judgement: &Judgement, source: &str, boards: &mut usize) {
    let Judgement { criterion, finding } = judgement;
    let mark = match &finding.verdict {
        Verdict::Pass { .. } => "pass",
        Verdict::Fail { .. } => "FAIL",
        Verdict::Unknown { .. } if judgement.is_skipped() => "-",
        Verdict::Unknown { .. } => "?",
    };
    let words = judgement.answer();
    let measured = finding.measured.as_ref().filter(|rate| rate.plays > 0).map_or(String::new(), rate);
    let comma = if words.is_empty() || measured.is_empty() { "" } else { "; " };
    let optimal = match (&finding.verdict, finding.optimal) {
        (_, Some(_)) => "; proven minimal",
        (Verdict::Pass { witness: Some(_) }, None) => "; a shorter win may exist",
        _ => "",
    };
    let line = format!("  {mark:<5}{criterion:<12} {words}{optimal}{comma}{measured}");
    let _ = writeln!(text, "{}", line.trim_end());
    // A criterion's name alone says little, so its question is added if the answer matters.
    let is_asked = mark == "FAIL" || mark == "?" && !words.starts_with("needs a win");
    if is_asked {
        let _ = writeln!(text, "       asks: {}", criterion.question());
    }
    // Evidence already contained in the reason is not repeated.
    let is_new = |seen: &&Evidence| {
        seen.rule.is_some() || *criterion == Criterion::Winnable || !words.contains(seen.text.as_str())
    };
    // The table of the reference players' results contains the same information as the evidence.
    let is_shown =
        |seen: &&Evidence| is_new(seen) && mark != "-" && !(finding.ladder.is_some() && mark == "pass");
    let shown: Vec<&Evidence> = finding.evidence.iter().filter(is_shown).collect();
    let most = if *criterion == Criterion::Winnable { MOST_LINKS } else { MOST_SEEN };
    for seen in shown.iter().take(most) {
        // A chain of causes has one line per cause, each with its position.
        let said = if *criterion == Criterion::Winnable { "" } else { &words };
        evidence(text, seen, said, source);
        if let Some(seen) = seen.board.as_ref().filter(|_| *boards < MOST_BOARDS && mark != "pass") {
            *boards += 1;
            board(text, &seen.rows);
            let _ = writeln!(text, "       ({})", seen.key());
        }
    }
    if shown.len() > most {
        let _ = writeln!(text, "       and {} more (all with --json)", shown.len() - most);
    }
    let mut advice: Vec<&str> = finding.evidence.iter().filter_map(|seen| seen.advice.as_deref()).collect();
    advice.dedup();
    for advice in advice.iter().take(2) {
        let _ = writeln!(text, "       try: {advice}");
    }
}

/// Writes a piece of evidence: its text, followed by its tick, cell and line.
fn evidence(text: &mut String, seen: &Evidence, said: &str, source: &str) {
    let mut parts = Vec::new();
    if !said.contains(seen.text.as_str()) {
        parts.push(seen.text.clone());
    }
    if let Some(tick) = seen.tick {
        parts.push(format!("tick {tick}"));
    }
    if let Some((column, row)) = seen.cell {
        parts.push(format!("column {column}, row {row}"));
    }
    if let Some(rule) = &seen.rule {
        let quoted = format!("`{}`", rule.text);
        let place = rule.line.map_or(String::new(), |line| format!("{}:{line}", source));
        let said = said.contains(&quoted) || seen.text.contains(&quoted);
        parts.push(if said { place } else { format!("{place} {quoted}") });
    }
    if !parts.is_empty() {
        let _ = writeln!(text, "       - {}", parts.join("; "));
    }
}

fn board(text: &mut String, rows: &[String]) {
    if rows.iter().all(|row| row.chars().count() <= MAX_WIDTH) {
        for row in rows {
            let _ = writeln!(text, "       {}", row.trim_end());
        }
    }
}

fn ladder_results(text: &mut String, ladder: &Ladder) {
    let ease = ladder.ease.map_or(String::new(), |ease| format!(" (ease {ease:.2})"));
    let _ = match ladder.difficulty {
        Difficulty::Unbeaten => writeln!(text, "       difficulty: no planner on the ladder wins it{ease}"),
        difficulty => writeln!(text, "       difficulty: {} for the planners{ease}", in_words(difficulty)),
    };
    let _ = writeln!(
        text,
        "       (the planners below search only a little; people may find the level much easier or harder)"
    );
    let players = ladder.rungs.iter().chain(&ladder.held_out);
    let width = players.clone().map(|result| result.player.len()).max().unwrap_or_default();
    for result in players {
        let PlayerResult { player, rate, win_ticks, .. } = result;
        let [low, high] = rate.interval.map(|end| 100.0 * end);
        let ticks =
            win_ticks.map_or(String::new(), |ticks| format!(", its wins take {ticks:.0} ticks on average"));
        let _ = writeln!(
            text,
            "         {player:<width$} {:>3} of {} won (95%: {low:>2.0} to {high:>3.0}%), score {:.1}{ticks}",
            rate.wins, rate.plays, rate.mean_score,
        );
    }
}

fn rate(rate: &Rate) -> String {
    let Rate { wins, plays, interval: [low, high], .. } = rate;
    format!("{wins} of {plays} episodes won (95%: {:.0} to {:.0}%)", 100.0 * low, 100.0 * high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The name fills its column.
    #[test]
    fn a_long_name_is_separated_from_its_answer() {
        let finding = Verdict::fail("won by luck").into();
        let (mut text, mut boards) = (String::new(), 0);
        criterion(
            &mut text,
            &Judgement { criterion: Criterion::SkillOverall, finding },
            "game.txt",
            &mut boards,
        );
        assert!(text.starts_with("  FAIL skill-overall won by luck"), "{text}");
    }
}
