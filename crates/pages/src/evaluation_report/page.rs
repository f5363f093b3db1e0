//! The report page, a single self-contained HTML file.

use super::Results;
use super::replay::Replays;
use super::sections::{self, Section};
use super::told::Told;
use crate::PageError;
use crate::page::facts::Fact;
use crate::page::words;
use base::Digest;
use evaluation::study::{LeaderRow, Study};
use report::Table;
use serde::Serialize;

const TEMPLATE: &str = include_str!("page.html");
const PARTS: [(&str, &str); 2] =
    [("page.css", include_str!("page.css")), ("replay.js", include_str!("replay.js"))];

/// The approximate size of the page, in bytes. Replays may use the space that remains after the plots.
const BYTES: usize = 12_000_000;

#[derive(Serialize)]
struct Page<'a> {
    title: &'a str,
    subtitle: &'a str,
    headlines: Vec<Fact>,
    /// A paragraph that summarises the results.
    lead: Option<&'a String>,
    /// The sentences about failures, one per player.
    fails: &'a [String],
    counted: &'a [String],
    warnings: &'a [String],
    sections: Vec<Section>,
    /// The style rules that show the heat map selected by the reader.
    tab_rules: String,
    replays: Option<Replays>,
    /// The nonce of the page's script, which prevents all other scripts from running. The nonce is derived from the
    /// page's entire content, so the content cannot contain it.
    nonce: String,
}

/// Renders the page. The same results give identical bytes.
pub(super) fn render(results: &Results<'_>, told: &Told, tables: &[Table]) -> Result<String, PageError> {
    let (sections, tab_rules) = sections::all(results.study, tables);
    let room = BYTES.saturating_sub(sections.iter().map(Section::bytes).sum());
    let replays = Replays::of(results, room)?;
    let mut page = Page {
        title: &told.title,
        subtitle: &told.subtitle,
        headlines: headlines(results.study),
        lead: told.verdict.first(),
        fails: told.verdict.get(1..).unwrap_or(&[]),
        counted: &told.counted,
        warnings: &told.warnings,
        sections,
        tab_rules,
        replays: Some(replays).filter(Replays::is_some),
        nonce: String::new(),
    };
    let shown = serde_json::to_vec(&page);
    let shown = shown.map_err(PageError::failed("the page of the report"))?;
    page.nonce = Digest::of(&shown).to_string();
    crate::page::render(&PARTS, TEMPLATE, &page)
}

/// Returns the figures at the top of the page: the best models (or the best players if there are no models),
/// and the reference players to compare them with.
fn headlines(study: &Study) -> Vec<Fact> {
    let is_model = |row: &&LeaderRow| !study.players[row.player].is_reference();
    let models = study.leaderboard.iter().filter(is_model).take(3);
    let marks = study.leaderboard.iter().filter(|row| !is_model(row));
    let shown = models.chain(marks).take(5);
    let mut facts: Vec<Fact> = shown
        .map(|row| {
            let rate = row.scores.win_rate;
            let value = rate.map_or(words::NONE.to_owned(), |rate| words::whole_percent(rate.value));
            let band = rate.map_or(String::new(), |rate| {
                format!("{:.0} to {:.0}\u{a0}%", 100.0 * rate.low, 100.0 * rate.high)
            });
            let won = format!("{} of {} won", row.scores.wins, words::grouped(row.scores.episodes));
            Fact::plain(study.players[row.player].label(), value).of(won).within(band)
        })
        .collect();
    let horizon = study.horizons.iter().find(|row| !row.player.is_reference()).or(study.horizons.first());
    facts.extend(horizon.map(|row| {
        Fact::plain(format!("horizon of {}", row.title()), row.horizon.told_value())
            .of("ticks ahead".to_owned())
            .within(row.horizon.told_interval())
    }));
    let thinking = study.thinking.iter().find(|row| row.tier.is_none()).or(study.thinking.first());
    facts.extend(thinking.map(|row| {
        Fact::plain(format!("thinking horizon of {}", row.title()), row.horizon.told_value())
            .of("tokens per answer".to_owned())
            .within(row.horizon.told_interval())
    }));
    let ended = study.episodes.iter().filter(|episode| episode.metrics.counts()).count() as u64;
    facts.push(Fact::plain("episodes", words::grouped(ended)));
    facts
}
