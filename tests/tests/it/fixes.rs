//! Tests of automatic fixes. Each fix removes its problem and introduces no new error. The tests use the
//! single faults of `faults.rs` and the examples in `docs/reference/diagnostics/`.

use crate::faults;
use crate::pages::examples;
use editor::{Edit, Fix, Problem, Severity, applied, level_problems, problems};
use std::collections::BTreeMap;
use std::fmt::Write;

/// The number of problems with a fix, and the number of problems fixed.
#[derive(Default)]
struct Tally {
    faults: usize,
    repaired: usize,
    failures: String,
}

/// Counts the problems by code and message. Positions are ignored, because fixes change them.
fn counted(problems: &[Problem]) -> BTreeMap<(&str, &str), usize> {
    let mut counts = BTreeMap::new();
    for problem in problems {
        *counts.entry((problem.code, problem.message.as_str())).or_default() += 1;
    }
    counts
}

impl Tally {
    /// Applies every fix for a text's problems, one at a time.
    fn check(&mut self, name: &str, text: &str, problems: impl Fn(&str) -> Vec<Problem>) {
        let found = problems(text);
        self.faults += usize::from(!found.is_empty());
        self.repaired += usize::from(found.iter().any(|problem| !problem.fixes.is_empty()));
        let before = counted(&found);
        for (problem, fix) in
            found.iter().flat_map(|problem| problem.fixes.iter().map(move |fix| (problem, fix)))
        {
            let Fix { title, edits } = fix;
            assert!(!edits.is_empty() && !title.is_empty(), "{problem:?}");
            assert!(edits.is_sorted_by(|one, other| one.span.end <= other.span.start), "{problem:?}");
            let sound = |edit: &Edit| text.get(edit.span.start..edit.span.end).is_some();
            assert!(edits.iter().all(sound), "{problem:?}");
            let repaired = applied(text, edits);
            let left = problems(&repaired);
            let after = counted(&left);
            let own = (problem.code, problem.message.as_str());
            let stays = after.get(&own).copied().unwrap_or(0) >= before[&own];
            let known = |problem: &&Problem| before.contains_key(&(problem.code, problem.message.as_str()));
            let new = left.iter().filter(|problem| problem.severity == Severity::Error);
            let new: Vec<&str> =
                new.filter(|problem| !known(problem)).map(|problem| problem.message.as_str()).collect();
            if stays || !new.is_empty() {
                let told = if stays { "stays" } else { "is repaired" };
                writeln!(
                    self.failures,
                    "{name}: {title} for {}: {}: it {told}; new: {new:?}\n{repaired}",
                    problem.code, problem.message
                )
                .unwrap();
            }
        }
    }
}

#[test]
fn repairs_of_single_faults_remove_them() {
    let mut tally = Tally::default();
    faults::each(|name, fault| {
        if fault.in_level {
            tally.check(name, &fault.level, |text| level_problems(&fault.game, text));
        } else {
            tally.check(name, &fault.game, problems);
        }
    });
    assert!(tally.failures.is_empty(), "\n{}", tally.failures);
    assert!(
        tally.repaired * 100 >= tally.faults * 60,
        "{} of {} have a repair",
        tally.repaired,
        tally.faults
    );
}

#[test]
fn repairs_of_the_examples_of_the_manual_remove_them() {
    let mut tally = Tally::default();
    for (page, game, level) in examples("docs/reference/diagnostics") {
        match level {
            Some(level) => tally.check(&page, &level, |text| level_problems(&game, text)),
            None => tally.check(&page, &game, problems),
        }
    }
    assert!(tally.failures.is_empty(), "\n{}", tally.failures);
    assert!(tally.repaired > 20, "{} of {} have a repair", tally.repaired, tally.faults);
}
