//! VGDL type names as authors of small games write them: one short word, or two in `camelCase`.
//!
//! Titles and stories use the scene's nouns, while rules use these names. A `curtainCord` is a `cord`, a `coalLump`
//! is `coal`, an `oilCan` remains an `oilCan`, a lit `lamp` is a `litLamp`, and an open `boathouse` is an `exit`.

use super::phrase::Nouns;
use super::vocabulary;
use crate::games::english;
use crate::kernels::file::kernel::Casting;
use base::Sampler;
use std::collections::{BTreeMap, BTreeSet};

/// Last words that are too vague to stand for their noun.
const VAGUE: &[&str] = &[
    "bar", "bay", "block", "board", "butt", "can", "car", "case", "circle", "corner", "cutting", "flag",
    "flat", "head", "hill", "hold", "hole", "hook", "house", "in", "jet", "light", "litter", "machine",
    "maker", "master", "mouth", "note", "office", "pad", "pan", "patch", "plug", "press", "pull", "race",
    "rind", "ring", "room", "score", "sheet", "shoot", "side", "sprite", "step", "stick", "strip", "stroke",
    "stub", "tile", "tip", "waste",
];

/// Last words that denote an amount of a material. Authors name the material instead.
const AMOUNTS: &[&str] = &["bale", "bunch", "bundle", "heap", "lump", "pile", "puff", "sheaf"];

/// The maximum length of a state's full name, in characters. If the full name would be longer, the state is named by
/// its adjective alone.
const LONGEST: usize = 20;

/// Draws names for a game's types, by their names in the kernel. `wall` and types without a noun keep their names.
pub(crate) fn names<'a>(
    nouns: &Nouns,
    castings: impl Iterator<Item = (&'a String, &'a Casting)>,
    declared: BTreeSet<String>,
    sampler: &mut Sampler,
) -> BTreeMap<String, String> {
    let castings: BTreeMap<_, _> = castings.collect();
    let without_noun = |name: &String| !nouns.contains_key(name);
    let taken = declared.into_iter().filter(without_noun).chain(["wall".to_owned()]).collect();
    let mut names = Names { nouns, given: BTreeMap::new(), taken };
    let habit = sampler.below(3);
    names.give("floor", &[["floor", "floor", "ground"][habit]]);
    // Most authors name the player after its part in the story, and some call it `avatar`.
    if sampler.below(4) == 0 && !names.taken.contains("avatar") {
        names.give("hero", &["avatar"]);
    }
    for (stype, casting) in &castings {
        if matches!(casting, Casting::Role(_)) {
            let noun = &nouns[stype.as_str()];
            names.give(stype, &[&short(noun), noun]);
        }
    }
    for (stype, casting) in &castings {
        if let Casting::State { of, adjective } = casting {
            names.state(stype, of, adjective);
        }
    }
    names.given
}

struct Names<'a> {
    nouns: &'a Nouns,
    given: BTreeMap<String, String>,
    taken: BTreeSet<String>,
}

impl Names<'_> {
    /// Names an unnamed type with the first free candidate or, if none is free, with the last candidate and a number.
    fn give(&mut self, stype: &str, candidates: &[&str]) {
        if self.given.contains_key(stype) {
            return;
        }
        let last = candidates.last().expect("a type has a name");
        let numbered = (2..).map(|number| format!("{last}{number}"));
        let mut names = candidates.iter().map(|&name| name.to_owned()).chain(numbered);
        let name = names.find(|name| !self.taken.contains(name)).expect("numbers do not end");
        self.taken.insert(name.clone());
        self.given.insert(stype.to_owned(), name);
    }

    fn state(&mut self, stype: &str, of: &str, adjective: &str) {
        let noun = &self.nouns[stype];
        // A state's noun consists of an adjective and the object's noun.
        let thing = noun.strip_prefix(adjective).unwrap_or(noun);
        let thing = self.given.get(of).cloned().unwrap_or_else(|| short(thing));
        let both = format!("{adjective}{}", english::capital(&thing));
        // Some kernels have their own word for a state, such as a follower, ashes or `dazed`.
        let is_word = !stype.contains(|c: char| c.is_ascii_uppercase());
        let tells_more = is_word && !vocabulary::is_role(stype);
        let first = match (of, adjective) {
            ("exit", "open") => "exit",
            ("hero", _) => adjective,
            _ if tells_more => stype,
            _ if both.len() <= LONGEST => &both,
            _ => adjective,
        };
        self.give(stype, &[first, &both]);
    }
}

/// Returns a noun's last word if that word is clear on its own. If the noun denotes an amount of a material, returns
/// the material. Otherwise returns the whole noun.
fn short(noun: &str) -> String {
    let spaced = english::spaced(noun);
    match spaced.rsplit_once(' ') {
        Some((stuff, last)) if AMOUNTS.contains(&last) && !stuff.contains(' ') => stuff.to_owned(),
        Some((_, last)) if !VAGUE.contains(&last) => last.to_owned(),
        _ => noun.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;

    #[test]
    fn names_are_short_and_differ() {
        let role = |role: &str| Casting::Role(role.to_owned());
        let state = |of: &str, adjective: &str| Casting::State { of: of.into(), adjective: adjective.into() };
        let cast = [
            ("bear", role("sleeper"), "iceBear"),
            ("dazed", state("bear", "dazed"), "dazedIceBear"),
            ("exit", role("exit"), "boathouse"),
            ("fuel", role("fuel"), "oilCan"),
            ("globe", role("lamp"), "chandelier"),
            ("hunter", role("hunter"), "polarBear"),
            ("lever", role("lever"), "curtainCord"),
            ("other", role("beast"), "polarBear"),
            ("litLamp", state("lamp", "lit"), "litFairLamp"),
            ("litGlobe", state("globe", "lit"), "litChandelier"),
            ("openExit", state("exit", "open"), "openBoathouse"),
            ("wokenBear", state("bear", "woken"), "wokenIceBear"),
        ];
        let nouns: Nouns = cast.iter().map(|(stype, _, noun)| ((*stype).into(), (*noun).into())).collect();
        let castings: Vec<_> =
            cast.into_iter().map(|(stype, casting, _)| (stype.to_owned(), casting)).collect();
        let castings = castings.iter().map(|(stype, casting)| (stype, casting));
        let names = names(&nouns, castings, BTreeSet::new(), &mut Seed::from_text("names").sampler());
        let expect = [
            ("bear", "bear"),
            ("dazed", "dazed"),
            ("exit", "boathouse"),
            ("fuel", "oilCan"),
            ("hunter", "polarBear"),
            ("lever", "cord"),
            ("other", "polarBear2"),
            ("litLamp", "litLamp"),
            ("litGlobe", "litChandelier"),
            ("openExit", "exit"),
            ("wokenBear", "wokenBear"),
        ];
        for (stype, name) in expect {
            assert_eq!(names[stype], name, "{stype}");
        }
    }
}
