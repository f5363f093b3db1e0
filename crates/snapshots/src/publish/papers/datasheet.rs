//! A release's datasheet: the facts on its card, under the headings of *Datasheets for Datasets* (Gebru et al.,
//! 2021).

use crate::card::{self, Rung};
use crate::format::manifest::item::ReleaseKind;
use crate::format::manifest::withheld::Reveal;
use crate::mint::Minted;
use crate::recipe::Recipe;
use forge::card::Origin;
use itertools::Itertools;
use report::Quantiles;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The description of a sealed release before its reveal.
const SEALED: &str = "sealed: seed and winning episodes are held back until it is revealed";
/// The limitation of a sealed release before its reveal.
const UNCHECKED: &str = "- That games come from the seed that was committed to can be checked only \
                         after the release is revealed, and wholly only by minting it again.\n";

/// The description of a sealed release after the early publication of one win per level. For each level, a secret
/// random choice selected the win.
const SOLVED: &str = "sealed: a winning episode of each level is public, seed and second episodes are held \
                      back until it is revealed";

/// Returns the datasheet after the reveal, preserving the publisher's own changes.
pub(super) fn revealed(datasheet: &str, what: Reveal) -> String {
    if what == Reveal::Solutions {
        return datasheet.replace(SEALED, SOLVED);
    }
    datasheet
        .replace(SOLVED, SEALED)
        .replace(SEALED, "sealed and revealed: the seed and the winning episodes are now public")
        .replace(
            UNCHECKED,
            "- Only minting the release again proves that the games come from the committed seed.\n",
        )
}

/// Returns the complete datasheet as Markdown.
pub(super) fn datasheet(minted: &Minted) -> String {
    let Minted { manifest, card, cards } = minted;
    let description = manifest.recipe.get("description").and_then(|text| text.as_str()).unwrap_or_default();
    let parent = manifest
        .parent
        .map_or("none; the release was not compared with earlier releases".to_owned(), |root| {
            format!("`{root}`")
        });
    let kind = match manifest.kind {
        ReleaseKind::Open => "open: its seed is public",
        ReleaseKind::Sealed => SEALED,
    };
    let mut text = format!(
        "# Datasheet of `{}`\n\n{}\n\n| | |\n|---|---|\n| root | `{}` |\n| kind | {kind} |\n| previous release | {parent} |\n\
         | minted by | {} |\n| canary | `{}` |\n\n",
        manifest.name,
        description.trim(),
        manifest.root,
        manifest.minted_by(),
        manifest.canary,
    );
    text += "## Contents\n\n\
        The release contains games in VGDL with their levels. Each level has an episode that wins it, found by a program and replayed by \
        `arcade verify`.\n\n";
    let _ = writeln!(
        text,
        "| | |\n|---|---|\n| games | {} |\n| with new rules | {} |\n| with hand-written rules in a new guise | {} |\n| levels | {} |",
        card.games,
        card.new_games,
        card.games - card.new_games,
        card.levels,
    );
    let kinds = card::counted(cards.iter().map(|card| card.kind.clone()));
    for (what, counts) in [
        ("levels by difficulty", &card.difficulty),
        ("games by kind", &kinds),
        ("games by goal", &card.goals),
        ("games by avatar", &card.avatars),
        ("games by generator", &card.generators),
    ] {
        if !counts.is_empty() {
            let _ = writeln!(text, "| {what} | {} |", counted(counts));
        }
    }
    for (what, figures) in
        [("rules of a game", &card.rules), ("ticks of a winning episode", &card.witness_ticks)]
    {
        if let Some(Quantiles { min, median, max, .. }) = figures {
            let _ = writeln!(text, "| {what} | {min:.0} to {max:.0} (median {median:.0}) |");
        }
    }
    text.push('\n');
    ladder(&mut text, &card.ladder);
    made(&mut text, minted);
    text += "## Intended use\n\n\
        The release measures how well players, above all language models, understand and win unseen games. Do not train on \
        the release: a model's score on a release from its training data is meaningless.\n\n\
        ## Known limits\n\n\
        - All games belong to one family: single-player grid games in VGDL, with a few dozen kinds of rules.\n\
        - Games and levels were selected by programs.";
    if !card.ladder.is_empty() {
        text += " Difficulty was measured with planners, not with people, and with few episodes per planner, \
                 so labels have errors and depend on how well planners play a game.";
    }
    // The recipe was checked, unless a different version minted it.
    let recipe: Option<Recipe> = serde_json::from_value(manifest.recipe.clone()).ok();
    for caveat in recipe.iter().flat_map(Recipe::caveats) {
        let _ = write!(text, "\n- {caveat}");
    }
    text += "\n- Published content may be in the training data of later models. Search for the canary, \
             and compare with a release that is newer than the model.\n";
    text += match manifest.kind {
        ReleaseKind::Open => "- The seed and the winning episodes are public from the start.\n",
        ReleaseKind::Sealed => UNCHECKED,
    };
    text += "\n## People\n\n\
        The release contains no personal data, and nobody was asked to play, write or label anything for it.\n\n\
        ## Licence, citation, errata\n\n\
        [LICENSE](LICENSE), [CITATION.cff](CITATION.cff), [CHANGELOG.md](CHANGELOG.md). The root does not \
        cover the papers.\n";
    text
}

/// Formats counts, such as `jumps 3, walks 12`.
fn counted(counts: &BTreeMap<String, u64>) -> String {
    counts.iter().map(|(name, count)| format!("{} {count}", name.replace('_', " "))).join(", ")
}

fn ladder(text: &mut String, rungs: &[Rung]) {
    if rungs.is_empty() {
        *text += "Difficulty was not measured: the recipe does not request `skill`.\n\n";
        return;
    }
    *text += "| player | wins | 95 % (games resampled) |\n|---|---|---|\n";
    for rung in rungs {
        let _ = writeln!(text, "{}", rung.row());
    }
    text.push('\n');
}

fn made(text: &mut String, minted: &Minted) {
    let tally = &minted.card.tally;
    let from = minted.cards.iter().filter_map(|card| match &card.origin {
        Origin::Corpus { name } => Some(name.as_str()),
        Origin::Generated { .. } => None,
    });
    let corpus: Vec<&str> = from.collect();
    *text += "## How it was made\n\n";
    let _ = writeln!(
        text,
        "The generators of Infinite Arcade made the release from the recipe in `MANIFEST.json`, which gives the same bytes on \
         any machine (check with `arcade regenerate`). {} games and {} levels were tried, with {:.1} million calls to \
         the game engine.",
        tally.games_tried,
        tally.levels_tried,
        tally.calls as f64 / 1e6,
    );
    if !tally.rejections.is_empty() {
        let _ = writeln!(text, "Rejected: {}.", tally.reasons());
    }
    if !tally.judges.is_empty() {
        let _ = writeln!(text, "\n{}", tally.judges_table(minted.card.games).to_markdown());
    }
    if !corpus.is_empty() {
        let _ = writeln!(text, "Hand-written games in the release: {}.", corpus.join(", "));
    }
    text.push('\n');
}
