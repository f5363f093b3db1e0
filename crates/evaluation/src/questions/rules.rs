//! Questions about rules, each answered by recordings under different rules.

use super::draft::{Draft, Form};
use super::place::Place;
use super::question::{Evidence, OptionSource};
use super::variants::{Variant, variants};
use super::view::{View, recording};
use base::Sampler;
use engine::describe::{Guide, interaction};
use engine::{Action, Analysis};

/// The minimum and the maximum number of actions in a recording.
const LENGTH: (usize, usize) = (6, 20);

/// Draws a question about the rule that is switched off in the second of two recordings. Switching off any of the four
/// rules would change the recording in a different way. The right rule is drawn from them.
pub(super) fn changed_rule(place: Place<'_>, sampler: &mut Sampler) -> Option<Vec<Draft>> {
    let actions = place.walk(sampler.between(LENGTH.0, LENGTH.1), sampler);
    let (first, fired) = place.record(place.rules(), &actions);
    let mut lines: Vec<usize> = fired.into_iter().collect();
    sampler.shuffle(&mut lines);
    let mut found: Vec<(usize, String, Vec<View>)> = Vec::new();
    for line in lines {
        let told = interaction(&place.game.subject.analysis, line).join(" ");
        let is_new = |views: &Vec<View>| {
            *views != first && found.iter().all(|(_, other, known)| known != views && *other != told)
        };
        let variant = place.rules().without(line);
        let (views, _) = place.record(&variant, &actions);
        if !told.is_empty() && is_new(&views) && place.is_exact(&variant) {
            found.push((line, told, views));
        }
        if found.len() == 4 {
            break;
        }
    }
    let found: [(usize, String, Vec<View>); 4] = found.try_into().ok()?;
    let second = recording(&found[0].2, &actions);
    let source =
        |line| OptionSource { actions: actions.clone(), without: Some(line), ..OptionSource::default() };
    let options = found.map(|(line, told, _)| (told, source(line)));
    let parts = [
        format!("## First recording\n{}", recording(&first, &actions)),
        format!("## Second recording\nIn this recording, one of the rules has no effect.\n{second}"),
        "## Question\nWhich rule has no effect in the second recording?".to_owned(),
    ];
    let how = "Play `actions` from the start of the level without each option's interaction: only the answer's gives the second recording.";
    let evidence = Evidence { how: how.to_owned(), actions, ..Evidence::default() };
    Some(vec![Draft::new(
        place,
        &place.game.section("Rules"),
        &parts,
        Form::Options(Box::new(options)),
        evidence,
    )])
}

/// Draws a question about the behaviour of a sprite in a recording. The game is drawn from four variants of a released
/// game. The variants differ in one rule, and produce four distinct recordings.
pub(super) fn sprite_behaviour(place: Place<'_>, sampler: &mut Sampler) -> Option<Vec<Draft>> {
    let actions = place.walk(sampler.between(LENGTH.0, LENGTH.1), sampler);
    let (about, candidates) = variants(place, &actions, sampler)?;
    let mut found: Vec<(Variant, Vec<View>)> = Vec::new();
    for variant in candidates {
        let (views, _) = place.record(&variant.game, &actions);
        let is_new = found.iter().all(|(other, known)| *known != views && other.told != variant.told);
        if is_new && place.is_exact(&variant.game) {
            found.push((variant, views));
        }
        if found.len() == 4 {
            break;
        }
    }
    let found: [(Variant, Vec<View>); 4] = found.try_into().ok()?;
    let rules = common_rules(
        &found.each_ref().map(|(variant, _)| Guide::from_analysis(&Analysis::of(&variant.game))),
    );
    let shown = recording(&found[0].1, &actions);
    let options = found.map(|(variant, _)| (variant.told, source(&actions, &variant.vgdl)));
    let parts = [format!("## Recording\n{shown}"), format!("## Question\n{about}")];
    let how = "Play `actions` from the start of the level in each option's game: only the answer's gives the recording.";
    let evidence = Evidence { how: how.to_owned(), actions, ..Evidence::default() };
    Some(vec![Draft::new(place, &rules, &parts, Form::Options(Box::new(options)), evidence)])
}

fn source(actions: &[Action], vgdl: &str) -> OptionSource {
    OptionSource { actions: actions.to_vec(), without: None, vgdl: vgdl.to_owned() }
}

/// Returns the rules that the variants of a game share, as a section of a prompt. Sentences about the remaining sprites
/// are omitted, because the sprite in question may not be one of them.
fn common_rules(guides: &[Guide; 4]) -> String {
    let shared = |of: fn(&Guide) -> &Vec<String>| {
        let is_shared = |line: &&String| guides.iter().all(|guide| of(guide).contains(line));
        of(&guides[0]).iter().filter(is_shared).cloned().collect::<Vec<String>>()
    };
    let guide = Guide {
        controls: Vec::new(),
        winning: shared(|guide| &guide.winning),
        losing: shared(|guide| &guide.losing),
        order: shared(|guide| &guide.order),
        sprites: shared(|guide| &guide.sprites).into_iter().filter(|line| line.starts_with("The ")).collect(),
        groups: shared(|guide| &guide.groups),
        timed_effects: shared(|guide| &guide.timed_effects),
        meetings: shared(|guide| &guide.meetings),
        legend: Vec::new(),
        kind: Vec::new(),
    };
    format!("## Rules\n{}", guide.to_string().trim_end())
}
