//! Reduces games that refute a claim.

use super::play::{Play, plays};
use super::{Case, Fault, Policy, faults, read};
use base::Seed;
use engine::Action;

/// Removes lines of the game, rows and columns of the level, and parameters, as long as a claim with the same
/// kind and code remains false.
pub fn shrunk(fault: Fault) -> Fault {
    let mut best = fault;
    loop {
        let size = best.source.len() + best.level.len();
        for (source, level) in smaller(&best.source, &best.level) {
            if source.len() + level.len() >= best.source.len() + best.level.len() {
                continue;
            }
            if let Some(found) = again(&source, &level, best.policy, best.claim.fact.kind(), &best.play) {
                best = found;
            }
        }
        if best.source.len() + best.level.len() == size {
            return best;
        }
    }
}

/// Returns the fault of the same kind in a changed game; `None` if the fault is gone.
pub fn again(
    source: &str,
    level: &str,
    policy: Policy,
    kind: &str,
    (seed, actions): &(Seed, Vec<Action>),
) -> Option<Fault> {
    let case = Case::load(source, level, policy)?;
    let (claims, _) = read::claims(&case);
    let claims: Vec<_> = claims.into_iter().filter(|claim| claim.fact.kind() == kind).collect();
    if claims.is_empty() {
        return None;
    }
    let found = faults(&case, &claims, &[Play::of(&case, *seed, actions)]);
    found.into_iter().next().or_else(|| faults(&case, &claims, &plays(&case, *seed)).into_iter().next())
}

fn smaller(source: &str, level: &str) -> Vec<(String, String)> {
    let lines: Vec<&str> = source.lines().collect();
    let rows: Vec<&str> = level.lines().collect();
    let join = |lines: &[&str]| lines.iter().map(|line| format!("{line}\n")).collect::<String>();
    let mut all = Vec::new();
    for at in (0..lines.len()).rev() {
        let mut fewer = lines.clone();
        let line = fewer.remove(at);
        all.push((join(&fewer), level.to_owned()));
        let words: Vec<&str> = line.split(' ').collect();
        for (word, _) in words.iter().enumerate().filter(|(_, word)| word.contains('=')) {
            let mut words = words.clone();
            words.remove(word);
            let words = words.join(" ");
            let mut changed = lines.clone();
            changed[at] = &words;
            all.push((join(&changed), level.to_owned()));
        }
    }
    for at in 0..rows.len() {
        let mut fewer = rows.clone();
        fewer.remove(at);
        all.push((source.to_owned(), join(&fewer)));
    }
    for column in 0..rows.first().map_or(0, |row| row.chars().count()) {
        let cut =
            |row: &&str| row.chars().enumerate().filter(|(at, _)| *at != column).map(|(_, c)| c).collect();
        let fewer: Vec<String> = rows.iter().map(cut).collect();
        all.push((source.to_owned(), join(&fewer.iter().map(String::as_str).collect::<Vec<_>>())));
    }
    all
}
