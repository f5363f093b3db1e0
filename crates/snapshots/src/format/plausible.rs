//! Plausibility checks for the versions stated in a manifest.

use crate::format::version::{CURRENT, MintedBy, VERSIONS, Version};

/// The first generation whose releases have a `CARD.json`, a canary (identifier in text corpora) derived from the
/// recipe, and a record of the previous releases' content in the recipe.
pub(crate) const CARD_AND_CANARY_SINCE: u32 = 7;

/// Returns the reason why no version of `arcade` can have minted a release with the given numbers; `None` if
/// some version, possibly a later one, can have minted it.
pub(crate) fn impossible(minted_by: &MintedBy) -> Option<String> {
    let &MintedBy { ref version, generation, semantics } = minted_by;
    let never = format!("GENERATION {generation} never had SEMANTICS {semantics}");
    if semantics == 0 || generation == 0 {
        return Some(format!("{never}: both are counted from 1"));
    }
    if generation > CURRENT.generation {
        return (semantics < CURRENT.semantics)
            .then(|| format!("{never}: {CURRENT} came before, and SEMANTICS never decreases"));
    }
    match (Version::that_mints(generation, semantics), version) {
        (None, _) => {
            let had = VERSIONS.iter().filter(|version| version.generation == generation);
            let had: Vec<String> = had.map(|version| version.semantics.to_string()).collect();
            Some(format!("{never}: the generation had {}", had.join(" and ")))
        }
        (Some(known), Some(stated)) if stated != known.number => {
            Some(format!("GENERATION {generation} is minted by version {}, not {stated}", known.number))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(generation: u32, semantics: u32, version: Option<&str>, expect: Option<&str>) {
        let minted_by = MintedBy { version: version.map(str::to_owned), generation, semantics };
        match (impossible(&minted_by), expect) {
            (None, None) => {}
            (Some(found), Some(words)) => assert!(found.contains(words), "{found}"),
            (found, expect) => panic!("{found:?}, not {expect:?}"),
        }
    }

    #[test]
    fn only_past_and_future_versions_are_possible() {
        let Version { number, generation, semantics, .. } = CURRENT;
        check(generation, semantics, Some(number), None);
        check(
            generation,
            semantics,
            Some("0.1.0"),
            Some(&format!("is minted by version {number}, not 0.1.0")),
        );
        check(generation, 0, None, Some("counted from 1"));
        check(0, 1, None, Some("counted from 1"));
        check(1, 1, None, None);
        check(6, 2, None, None);
        check(9, 3, None, None);
        check(9, 1, None, Some("GENERATION 9 never had SEMANTICS 1: the generation had 2 and 3"));
        check(11, 2, None, Some("GENERATION 11 never had SEMANTICS 2: the generation had 3"));
        check(generation, semantics + 1, None, Some("never had"));
        check(generation, u32::MAX, None, Some("never had"));
        check(generation + 1, semantics, Some("0.99.0"), None);
        check(generation + 1, semantics + 1, Some("1.0.0"), None);
        check(generation + 1, semantics - 1, None, Some("SEMANTICS never decreases"));
    }
}
