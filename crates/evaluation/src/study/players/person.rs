//! Distinguishes players with the same name. A person is a model together with its prompts, its decoding
//! settings and its served version. Results that differ in any of these get separate rows in a report.

use crate::metrics::EpisodeMetrics;
use crate::run::Entrant;
use crate::study::Player;
use itertools::Itertools;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The episodes of one person (a player with its settings) in a results folder.
pub(crate) struct PersonResults {
    player: Player,
    /// All settings that determine requests and answers, by their JSON path (for example,
    /// `model.decoding.temperature`).
    facts: BTreeMap<String, String>,
    episodes: Vec<EpisodeMetrics>,
}

/// The path to the model's served version in the facts.
const SERVED: &str = "served by";
/// The path to the games' surface in the facts. The surface (names, characters or orientation) distinguishes the games
/// from the games with the same rules in an earlier folder.
const TWIN: &str = "games";

impl PersonResults {
    /// Splits the episodes in a results folder by the model versions that answered. If the games have the same rules as
    /// games in an earlier folder but a different surface, `surface` states the difference.
    pub(crate) fn of(
        entrant: &Entrant,
        surface: Option<&str>,
        episodes: Vec<EpisodeMetrics>,
    ) -> Vec<PersonResults> {
        let mut facts = BTreeMap::new();
        flatten("", &entrant.details, &mut facts);
        // The same model on a different server counts as the same person (player).
        facts.retain(|path, _| path != "model.server" && !path.starts_with("model.server."));
        if let Some(surface) = surface {
            facts.insert(TWIN.to_owned(), surface.to_owned());
        }
        let mut parts: BTreeMap<BTreeSet<String>, Vec<EpisodeMetrics>> = BTreeMap::new();
        for episode in episodes {
            parts.entry(episode.served_by.clone()).or_default().push(episode);
        }
        // An episode without an answer does not reveal a version, so it is assigned to the first version.
        if parts.len() > 1
            && let Some(unserved) = parts.remove(&BTreeSet::new())
            && let Some(first) = parts.values_mut().next()
        {
            first.extend(unserved);
        }
        let with = |(served, episodes): (BTreeSet<String>, Vec<EpisodeMetrics>)| {
            let mut facts = facts.clone();
            if !served.is_empty() {
                facts.insert(SERVED.to_owned(), served.iter().join(" and "));
            }
            PersonResults { player: Player::from(entrant), facts, episodes }
        };
        if parts.is_empty() {
            vec![with((BTreeSet::new(), Vec::new()))]
        } else {
            parts.into_iter().map(with).collect()
        }
    }
}

/// Assigns distinct players to results with different facts. Each player's conditions state the differences.
pub(crate) fn told_apart(results: Vec<PersonResults>) -> Vec<(Player, Vec<EpisodeMetrics>)> {
    let mut differing: BTreeMap<Player, BTreeMap<String, BTreeSet<Option<String>>>> = BTreeMap::new();
    let unserved = |person: &PersonResults| person.episodes.is_empty() && !person.facts.contains_key(SERVED);
    for person in &results {
        let paths: BTreeSet<&String> = results
            .iter()
            .filter(|other| other.player == person.player)
            .flat_map(|other| other.facts.keys())
            .collect();
        for path in paths.into_iter().filter(|path| *path != SERVED || !unserved(person)) {
            let values = differing.entry(person.player.clone()).or_default().entry(path.clone()).or_default();
            values.insert(person.facts.get(path).cloned());
        }
    }
    let named = |person: PersonResults| {
        let paths = differing.get(&person.player).into_iter().flatten();
        let differing = paths.filter(|(_, values)| values.len() > 1).map(|(path, _)| path);
        let conditions =
            differing.filter(|path| *path != TWIN || person.facts.contains_key(TWIN)).map(|path| {
                let value = person.facts.get(path).map_or("none", String::as_str);
                match path.rsplit('.').next() {
                    Some("prompt_digest") => format!("prompt {}", value.chars().take(8).collect::<String>()),
                    Some(name) => format!("{} {value}", name.replace('_', " ")),
                    None => value.to_owned(),
                }
            });
        let conditions = conditions.sorted().collect();
        (Player { conditions, ..person.player }, person.episodes)
    };
    results.into_iter().map(named).collect()
}

/// Adds the leaves of a JSON value to a map, by path.
fn flatten(path: &str, value: &Value, into: &mut BTreeMap<String, String>) {
    let inner = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    match value {
        Value::Object(fields) => fields.iter().for_each(|(name, value)| flatten(&inner(name), value, into)),
        Value::Null => {}
        Value::String(text) => drop(into.insert(path.to_owned(), text.clone())),
        other => drop(into.insert(path.to_owned(), other.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Outcome;
    use serde_json::json;

    fn episode(run: u64, served: &[&str]) -> EpisodeMetrics {
        let served_by = served.iter().map(|name| (*name).to_owned()).collect();
        EpisodeMetrics { served_by, ..EpisodeMetrics::ended("maze", 0, run, Outcome::Lost) }
    }

    #[track_caller]
    fn check(folders: &[(Value, Vec<EpisodeMetrics>)], expect: &[(&str, usize)]) {
        let of = |(details, episodes): &(Value, Vec<EpisodeMetrics>)| {
            let (name, mode) = ("m".to_owned(), Some("zero-shot".to_owned()));
            let entrant = Entrant { name, mode, aids: Vec::new(), details: details.clone() };
            PersonResults::of(&entrant, None, episodes.clone())
        };
        let found = told_apart(folders.iter().flat_map(of).collect());
        let labels: Vec<(String, usize)> =
            found.into_iter().map(|(player, episodes)| (player.label(), episodes.len())).collect();
        let labels: Vec<(&str, usize)> =
            labels.iter().map(|(label, count)| (label.as_str(), *count)).collect();
        assert_eq!(labels, expect);
    }

    #[test]
    fn equal_persons_are_one() {
        let details = json!({ "model": { "decoding": { "temperature": 0 }, "server": { "url": "a" } } });
        let other = json!({ "model": { "decoding": { "temperature": 0 }, "server": { "url": "b" } } });
        let folders = [(details, vec![episode(0, &["v1"])]), (other, vec![episode(1, &["v1"])])];
        check(&folders, &[("m (zero-shot)", 1), ("m (zero-shot)", 1)]);
    }

    /// The provider changes the model in the middle of an evaluation.
    #[test]
    fn versions_served_are_persons() {
        let episodes =
            vec![episode(0, &["v1"]), episode(1, &[]), episode(2, &["v2"]), episode(3, &["v1", "v2"])];
        let expect = [
            ("m (zero-shot, served by v1)", 2),
            ("m (zero-shot, served by v1 and v2)", 1),
            ("m (zero-shot, served by v2)", 1),
        ];
        check(&[(json!(null), episodes)], &expect);
    }

    #[test]
    fn a_missing_setting_differs_from_a_given_one() {
        let folders = [
            (json!({ "model": { "decoding": {} } }), vec![episode(0, &[])]),
            (json!({ "model": { "decoding": { "max_output_tokens": 50 } } }), vec![episode(1, &[])]),
        ];
        let expect =
            [("m (zero-shot, max output tokens none)", 1), ("m (zero-shot, max output tokens 50)", 1)];
        check(&folders, &expect);
    }
}
