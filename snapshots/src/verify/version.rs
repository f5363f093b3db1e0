//! The versions that a manifest states: the pairs of semantics and generation that an arcade can have had.

use generators::GENERATION;

/// For each semantics of the engine, from 1 on, the first generation of the generators that had it. A new semantics is a
/// new line here. Semantics 2 began with generation 2; a release
/// that is kept as a test states 1.
const FIRST_GENERATION: [u32; 3] = [1, 1, 9];

/// The first generation whose releases have a `CARD.json`, a canary of their recipe, and what the releases before hold.
pub(crate) const COMPLETE: u32 = 7;

/// The reason that no arcade ever had this pair of versions; none if one may have had it, be it a later one.
pub(super) fn impossible(semantics: u32, generation: u32) -> Option<String> {
    let known = engine::SEMANTICS;
    if semantics == 0 || generation == 0 {
        return Some(format!(
            "semantics {semantics} and generation {generation} never existed: both are counted from 1"
        ));
    }
    if semantics > known {
        return (generation <= GENERATION).then(|| {
            format!(
                "semantics {semantics} never existed in generation {generation}: the newest that this arcade knows, \
                 of generation {GENERATION}, is {known}"
            )
        });
    }
    let index = semantics as usize - 1;
    let first = FIRST_GENERATION[index];
    let last = FIRST_GENERATION.get(index + 1).copied().unwrap_or(u32::MAX);
    (!(first..=last).contains(&generation)).then(|| match generation < first {
        true => format!(
            "semantics {semantics} never existed in generation {generation}: it began with generation {first}"
        ),
        false => format!(
            "semantics {semantics} never existed in generation {generation}: it ended with generation {last}"
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A raise of `SEMANTICS` adds a line.
    #[test]
    fn every_semantics_has_a_line() {
        assert_eq!(FIRST_GENERATION.len(), engine::SEMANTICS as usize);
        assert!(FIRST_GENERATION.is_sorted());
        assert_eq!(impossible(engine::SEMANTICS, GENERATION), None);
    }

    #[track_caller]
    fn check(semantics: u32, generation: u32, expect: Option<&str>) {
        match (impossible(semantics, generation), expect) {
            (None, None) => {}
            (Some(found), Some(words)) => assert!(found.contains(words), "{found}"),
            (found, expect) => panic!("{found:?}, not {expect:?}"),
        }
    }

    #[test]
    fn pairs() {
        check(0, GENERATION, Some("semantics 0 and generation"));
        check(1, 0, Some("never existed"));
        check(1, 1, None);
        check(2, 6, None);
        check(2, 1, None);
        check(2, 11, Some("it ended with generation 9"));
        check(3, 8, Some("it began with generation 9"));
        check(engine::SEMANTICS + 1, GENERATION, Some("the newest that this arcade knows"));
        check(u32::MAX, GENERATION, Some("the newest that this arcade knows"));
        check(engine::SEMANTICS, GENERATION + 1, None);
        check(engine::SEMANTICS + 1, GENERATION + 1, None);
    }
}
