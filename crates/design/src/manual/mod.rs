//! The manual for each stage, as text that a model reads. The lists of words come from the pages of the ontology.

use crate::answer::Idea;
use crate::brief::{Brief, keywords};
use crate::draft::Draft;
use engine::{EFFECTS, SpriteClass, TERMINATIONS};
use generators::invention::MechanicInWords;
use std::fmt::Write;
use validators::{Criteria, Criterion};

/// The instructions that precede every stage.
pub const SYSTEM: &str = include_str!("system.md");
/// The rules of the manual's example.
pub const EXAMPLE_GAME: &str = include_str!("example/game.vgdl");
/// A level of the manual's example.
pub const EXAMPLE_LEVEL: &str = include_str!("example/lvl0.txt");

/// The words whose parameters are listed in the manual for the rules.
const DETAILED: [&str; 18] = [
    "Resource",
    "Missile",
    "RandomNPC",
    "Chaser",
    "Fleeing",
    "SpawnPoint",
    "Bomber",
    "Portal",
    "ShootAvatar",
    "killIfHasLess",
    "killIfOtherHasMore",
    "changeResource",
    "subtractHealthPoints",
    "transformTo",
    "transformToAll",
    "teleportToExit",
    "spawn",
    "SpriteCounter",
];

/// The words that the manual omits, because they belong to continuous physics, or because other words serve the same
/// purpose better.
const OMITTED: [&str; 18] = [
    "Walker",
    "WalkerJumper",
    "SpaceshipAvatar",
    "CarAvatar",
    "LanderAvatar",
    "BirdAvatar",
    "PlatformerAvatar",
    "WizardAvatar",
    "ErraticMissile",
    "RandomInertial",
    "AlternateChaser",
    "SpriteProducer",
    "wallBounce",
    "wallReverse",
    "wallStop",
    "waterPhysics",
    "killIfNotUpright",
    "StopCounter",
];

/// Returns the message that opens the first stage. `earlier` contains the drafts from which the game must differ.
pub(crate) fn idea(brief: &Brief, criteria: &Criteria, earlier: &[Draft]) -> String {
    let mut text = filled(
        include_str!("idea.md"),
        &[
            ("classes", classes()),
            ("effects", words(EFFECTS.iter().copied())),
            ("terminations", words(TERMINATIONS.iter().copied())),
            ("questions", questions(criteria, |_| true)),
        ],
    );
    text += &assignment(brief);
    let ideas: String = earlier
        .iter()
        .filter_map(|draft| Some(format!("- {}: {}\n", draft.name.as_ref()?, draft.idea.as_ref()?)))
        .collect();
    if !ideas.is_empty() {
        let _ = write!(text, "\n## Your earlier games\n\nThe new game must have different rules.\n\n{ideas}");
    }
    text
}

/// Returns the message that opens the second stage.
pub(crate) fn rules(brief: &Brief, idea: &Idea) -> String {
    let required: Vec<String> = brief.required.iter().flat_map(|word| keywords(word)).collect();
    let mut detailed: Vec<&str> = Vec::new();
    for word in required.iter().map(String::as_str).chain(DETAILED) {
        if !detailed.contains(&word) {
            detailed.push(word);
        }
    }
    let details: Vec<String> = detailed.into_iter().filter_map(editor::introduction).collect();
    let text = filled(
        include_str!("rules.md"),
        &[
            ("classes", classes()),
            ("effects", words(EFFECTS.iter().copied())),
            ("terminations", words(TERMINATIONS.iter().copied())),
            ("colours", editor::COLORS.join(", ")),
            ("details", details.join("\n").trim_end().to_owned()),
            ("example_game", EXAMPLE_GAME.to_owned()),
            ("example_level", EXAMPLE_LEVEL.to_owned()),
            ("idea", told(idea)),
        ],
    );
    text + &assignment(brief)
}

/// Returns the message that opens the third stage.
pub(crate) fn levels(brief: &Brief, criteria: &Criteria, idea: &Idea, rules: &str) -> String {
    let gates = &criteria.gates;
    let percent = |share: f64| format!("{:.0}%", 100.0 * share);
    let tier = brief.tier.map(|tier| {
        let bounds = tier.bounds();
        format!(
            "- The last level belongs to tier {tier} or higher: its shortest win takes at least {} moves, and it contains \
             at least {} of these traps: planners with little foresight lose; mistakes near the win cannot be undone; \
             three sprites that move come next to the way; greedy players lose.\n",
            bounds.decisions, bounds.traps
        )
    });
    filled(
        include_str!("levels.md"),
        &[
            ("count", base::count(brief.levels, "level")),
            ("level_questions", questions(criteria, Criterion::of_level)),
            ("game_questions", questions(criteria, Criterion::of_game)),
            ("least_ticks", criteria.least_ticks.to_string()),
            ("most_ticks", criteria.most_ticks.to_string()),
            ("least_win", gates.least_win.to_string()),
            ("time_low", gates.time_limit.0.to_string()),
            ("time_high", gates.time_limit.1.to_string()),
            ("open", percent(1.0 - gates.narrow)),
            ("dead_ticks", gates.dead_ticks.to_string()),
            ("slips", percent(gates.careless_slips)),
            ("careless", percent(gates.careless_wins)),
            ("sweep", gates.sweep.to_string()),
            ("foes", percent(gates.foe_losses)),
            ("drama", gates.drama.to_string()),
            ("needed", percent(gates.needed_share)),
            ("tier", tier.unwrap_or_default()),
            ("idea", told(idea)),
            ("rules", rules.to_owned()),
        ],
    )
}

/// Replaces each `{key}` with its value. Values are not searched for keys.
fn filled(template: &str, values: &[(&str, String)]) -> String {
    let mut text = String::new();
    let mut rest = template;
    while let Some(open) = rest.find('{') {
        let key = rest[open + 1..].split('}').next().unwrap_or_default();
        let value = values.iter().find(|(known, _)| *known == key);
        let (_, value) = value.expect("every key of a template has a value");
        text += &rest[..open];
        text += value;
        rest = &rest[open + key.len() + 2..];
    }
    text + rest
}

fn told(idea: &Idea) -> String {
    format!("`{}`: {}", idea.name, idea.text)
}

/// Returns the user's requirements as a section, or an empty text if there are none.
fn assignment(brief: &Brief) -> String {
    let mut lines = Vec::new();
    if let Some(theme) = &brief.theme {
        lines.push(format!("- The theme of the game is: {}", theme.trim()));
    }
    if let Some(tier) = brief.tier {
        lines
            .push(format!("- The last level must be demanding: at least {} moves.", tier.bounds().decisions));
    }
    for word in &brief.required {
        lines.push(requirement(word));
    }
    for game in &brief.unlike {
        lines.push(format!("- The rules must differ from those of the game `{}`.", game.name));
    }
    if lines.is_empty() { String::new() } else { format!("\n## Requirements\n\n{}\n", lines.join("\n")) }
}

/// Describes a required word or mechanic.
fn requirement(word: &str) -> String {
    let Some(mechanic) = MechanicInWords::of(word) else { return format!("- The rules must use `{word}`.") };
    let keywords: Vec<String> = mechanic.keywords.iter().map(|key| format!("`{key}`")).collect();
    format!(
        "- The rules must contain the following mechanic, with other nouns, and must use {}. {}.",
        keywords.join(", "),
        mechanic.says.join(". ")
    )
}

/// Lists words, each with the first sentence of its page.
fn words<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let line = |word: &str| {
        let summary = editor::summary(word)?;
        let end = summary.find(". ").map_or(summary.len(), |end| end + 1);
        let start = format!("`{word}` is ");
        let sentence = &summary[..end];
        Some(format!("- `{word}`: {}", sentence.strip_prefix(&start).unwrap_or(sentence)))
    };
    let shown = words.into_iter().filter(|word| !OMITTED.contains(word));
    shown.filter_map(line).collect::<Vec<_>>().join("\n")
}

/// Lists the sprite classes.
fn classes() -> String {
    words(SpriteClass::ALL.iter().map(|class| class.name()))
}

/// Lists the questions of the checked criteria that `is_meant` selects.
fn questions(criteria: &Criteria, is_meant: impl Fn(Criterion) -> bool) -> String {
    let asked = criteria.ask.iter().filter(|&criterion| is_meant(criterion));
    asked.map(|criterion| format!("- {criterion}: {}", criterion.question())).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;
    use engine::Game;
    use validators::{CriterionSet, Effort, Judging, Panel};

    /// The manual's example must be complete, free of warnings and winnable.
    #[test]
    fn the_example_works() {
        let game = Game::from_source(EXAMPLE_GAME).unwrap();
        assert!(game.warnings().is_empty(), "{:?}", game.warnings());
        let level = game.level(EXAMPLE_LEVEL).unwrap();
        let ask = CriterionSet::LEVEL.without(CriterionSet::of(&[Criterion::Skill]));
        let criteria = Criteria { ask, budget: 100_000, ..Criteria::default() }.check().unwrap();
        let panel = Panel::new(criteria, Effort::Full);
        let report = panel.judge(Judging::level(&game, &level, Seed::from_text("validate")));
        assert!(report.passes(), "{:#?}", report.first_obstacle());
    }

    #[test]
    fn manuals_are_complete_and_short() {
        let brief = Brief {
            levels: 3,
            theme: Some("snow".to_owned()),
            tier: None,
            required: vec!["Spreader".to_owned(), "ignite".to_owned()],
            unlike: Vec::new(),
        };
        let criteria = crate::DesignSettings::criteria(1000);
        let first = idea(&brief, &criteria, &[]);
        let drawn = Idea { name: "snow-fall".to_owned(), text: "A {brace} of ideas.".to_owned() };
        let second = rules(&brief, &drawn);
        let third = levels(&brief, &criteria, &drawn, EXAMPLE_GAME);
        for (text, most) in [(&first, 4000), (&second, 9000), (&third, 2500)] {
            let tokens = evaluation::tokens::count(text);
            assert!(tokens < most, "{tokens} tokens\n{text}");
        }
        assert!(first.contains("The theme of the game is: snow"));
        assert!(first.contains("Walk against a hedge with a torch") && second.contains("**spawnIfHasMore**"));
        assert!(second.contains("**Spreader**") && second.contains("A {brace} of ideas."));
        assert!(third.contains("Draw 3 levels") && third.contains("at least 25 ticks"), "{third}");
    }
}
