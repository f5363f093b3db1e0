//! The rules that a log's entries must obey as a whole. For example, commitments must come before releases.

use super::entry::{Entry, Revealed, Round};
use crate::beacon::{Drawn, check_source};
use base::Digest;
use std::collections::{BTreeMap, BTreeSet};

/// A function that computes the commitment for a revealed secret.
pub type CommitmentOf<'a> = &'a dyn Fn(&Revealed) -> Digest;

/// The facts established by the previous entries.
#[derive(Default)]
struct History {
    keys: Option<(u32, Digest)>,
    commitments: BTreeMap<String, Commitment>,
    beacons: BTreeMap<Round, Digest>,
    roots: BTreeMap<String, Root>,
    revealed: BTreeSet<String>,
    results: BTreeSet<Digest>,
}

struct Commitment {
    commitment: Digest,
    recipe: Digest,
    parent: Option<Digest>,
    beacon: Option<Round>,
}

struct Root {
    root: Digest,
    commitment: Option<Digest>,
}

/// Returns the rule violations, each with the violating entry's number and the reason.
pub fn problems(entries: &[Entry], commitment_of: CommitmentOf<'_>) -> Vec<String> {
    let mut history = History::default();
    let mut problems = Vec::new();
    for (number, entry) in entries.iter().enumerate() {
        let found = history.take(entry, commitment_of);
        problems.extend(found.into_iter().map(|problem| format!("entry {number}: {problem}")));
    }
    problems
}

impl History {
    /// Adds an entry to the history, and returns the entry's faults.
    fn take(&mut self, entry: &Entry, commitment_of: CommitmentOf<'_>) -> Vec<String> {
        match entry {
            Entry::Keys { version, digest, previous } => self.keys(*version, *digest, *previous),
            Entry::Commitment { release, commitment, recipe, parent, beacon } => {
                let new = Commitment {
                    commitment: *commitment,
                    recipe: *recipe,
                    parent: *parent,
                    beacon: beacon.clone(),
                };
                self.commitment(release, new)
            }
            Entry::Beacon { round, value, proof } => {
                let drawn = Drawn { round: round.clone(), value: *value, proof: proof.clone() };
                self.beacon(&drawn)
            }
            Entry::Root { release, root, parent, commitment, beacon, .. } => {
                self.root(release, *root, *parent, *commitment, *beacon)
            }
            Entry::Reveal(revealed) => self.reveal(revealed, commitment_of),
            Entry::Calibration { release, root, .. } => self.known(release, root).into_iter().collect(),
            Entry::Result(row) => {
                let twice = (!self.results.insert(row.results))
                    .then(|| format!("the results {} are already in the log", row.results));
                self.known(&row.release, &row.root).into_iter().chain(twice).collect()
            }
        }
    }

    fn beacon(&mut self, drawn: &Drawn) -> Vec<String> {
        let (round, value) = (&drawn.round, drawn.value);
        let mut problems = Vec::new();
        if let Err(fault) = drawn.check() {
            problems.push(format!("the value of round {} of {}: {fault}", round.round, round.source));
        }
        if let Some(before) = self.beacons.insert(round.clone(), value).filter(|before| *before != value) {
            problems.push(format!(
                "round {} of {} has two values: {before} earlier, and now {value}",
                round.round, round.source
            ));
        }
        problems
    }

    fn keys(&mut self, version: u32, digest: Digest, previous: Option<Digest>) -> Vec<String> {
        let expect =
            self.keys.map_or((1, None), |(version, digest)| (version.saturating_add(1), Some(digest)));
        self.keys = Some((version, digest));
        match (version, previous) == expect {
            true => Vec::new(),
            false => vec![format!("the set of keys {version} does not follow the previous set in the log")],
        }
    }

    fn commitment(&mut self, release: &str, new: Commitment) -> Vec<String> {
        let mut problems = Vec::new();
        if let Some(before) = self.commitments.get(release) {
            problems.push(format!(
                "a second commitment for `{release}`: {} came first, and a publisher may commit only once",
                before.commitment
            ));
            return problems;
        }
        if self.roots.contains_key(release) {
            problems.push(format!(
                "the commitment for `{release}` comes too late: the root of the release is already in the log"
            ));
        }
        if let Some(Err(fault)) = new.beacon.as_ref().map(|round| check_source(&round.source)) {
            problems.push(format!("the commitment for `{release}`: {fault}"));
        }
        if let Some(round) = new.beacon.as_ref().filter(|round| self.beacons.contains_key(*round)) {
            problems.push(format!(
                "the commitment for `{release}` specifies round {} of {}, which was known before it",
                round.round, round.source
            ));
        }
        let same = |other: &&Commitment| other.beacon.is_some() && other.beacon == new.beacon;
        if let (Some(_), Some(round)) = (self.commitments.values().find(same), &new.beacon) {
            problems.push(format!(
                "the commitment for `{release}` specifies round {} of {}, as another commitment does, so the \
                 publisher could choose between the two",
                round.round, round.source
            ));
        }
        self.commitments.insert(release.to_owned(), new);
        problems
    }

    fn root(
        &mut self,
        release: &str,
        root: Digest,
        parent: Option<Digest>,
        commitment: Option<Digest>,
        beacon: Option<Digest>,
    ) -> Vec<String> {
        if let Some(before) = self.roots.get(release).filter(|before| before.root == root) {
            return vec![format!("the root of `{release}` is already in the log: {}", before.root)];
        }
        if let Some(before) = self.roots.get(release) {
            return vec![format!(
                "a second root for `{release}`: {} came first; two releases with the same name are two \
                 histories",
                before.root
            )];
        }
        let mut problems = Vec::new();
        if let Some(parent) = parent.filter(|parent| !self.roots.values().any(|root| root.root == *parent)) {
            problems
                .push(format!("`{release}` follows a release with root {parent}, which is not in the log"));
        }
        if self.roots.values().any(|other| other.root == root) {
            problems.push(format!("the root {root} is in the log under a different name than `{release}`"));
        }
        match (commitment, self.commitments.get(release)) {
            (None, None) => {}
            (None, Some(_)) => problems.push(format!(
                "the log has a commitment for `{release}`, but the release itself has no commitment"
            )),
            (Some(_), None) => {
                problems.push(format!("`{release}` is sealed, but no commitment came before its root"))
            }
            (Some(stated), Some(before)) => {
                if stated != before.commitment {
                    problems.push(format!(
                        "`{release}` has the commitment {stated}, but the log has the commitment {}",
                        before.commitment
                    ));
                }
                if parent != before.parent {
                    problems.push(format!("`{release}` has a different parent than its commitment states"));
                }
                let awaited = before.beacon.as_ref().map(|round| (round, self.beacons.get(round)));
                match (awaited, beacon) {
                    (None, None) => {}
                    (None, Some(_)) => {
                        problems.push(format!("`{release}` has a beacon, but its commitment has no beacon"))
                    }
                    (Some((round, None)), _) => problems.push(format!(
                        "`{release}` uses round {} of {}, whose value is not in the log",
                        round.round, round.source
                    )),
                    (Some((round, Some(value))), stated) if stated != Some(*value) => problems.push(format!(
                        "`{release}` was minted with a value other than that of round {} of {}: {value}",
                        round.round, round.source
                    )),
                    (Some(_), _) => {}
                }
            }
        }
        self.roots.insert(release.to_owned(), Root { root, commitment });
        problems
    }

    /// Returns the fault if an entry refers to a release that the log does not contain.
    fn known(&self, release: &str, root: &Digest) -> Option<String> {
        match self.roots.get(release) {
            Some(found) if found.root == *root => None,
            Some(found) => Some(format!(
                "the entry is about `{release}` with root {root}, but the log has {}",
                found.root
            )),
            None => Some(format!("the entry is about `{release}`, which is not in the log")),
        }
    }

    fn reveal(&mut self, revealed: &Revealed, commitment_of: CommitmentOf<'_>) -> Vec<String> {
        let release = &revealed.release;
        let mut problems: Vec<String> = self.known(release, &revealed.root).into_iter().collect();
        if !self.revealed.insert(release.clone()) {
            problems.push(format!("`{release}` is revealed a second time"));
        }
        let committed = self.roots.get(release).and_then(|root| root.commitment);
        if committed != Some(commitment_of(revealed)) {
            problems.push(format!("the secret of `{release}` does not match the commitment"));
        }
        if self.commitments.get(release).is_some_and(|before| before.recipe != revealed.recipe) {
            problems.push(format!(
                "the secret of `{release}` was drawn for a different recipe than the commitment's"
            ));
        }
        problems
    }
}

/// Returns the releases with a commitment but no root in the log. Such releases have not been minted yet, or
/// were dropped.
pub fn unkept(entries: &[Entry]) -> Vec<String> {
    let is_minted =
        |name: &str| entries.iter().any(|e| matches!(e, Entry::Root { release, .. } if release == name));
    let committed = entries.iter().filter_map(|entry| match entry {
        Entry::Commitment { release, .. } => Some(release),
        _ => None,
    });
    committed.filter(|name| !is_minted(name)).cloned().collect()
}

/// Returns `true` if a release name is a month, such as `2027-03`.
pub fn is_month(name: &str) -> bool {
    let is_number = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    name.split_once('-').is_some_and(|(year, month)| {
        year.len() == 4
            && is_number(year)
            && month.len() == 2
            && ("01"..="12").contains(&month)
            && is_number(month)
    })
}

/// Checks that a log contains a release of the given month, such as `2027-03`, or of a later month. Returns
/// the fault if it does not, because the log may then be outdated. Releases whose names are not months are
/// ignored.
pub fn frozen(entries: &[Entry], month: &str) -> Option<String> {
    let roots = entries.iter().filter_map(|entry| match entry {
        Entry::Root { release, .. } => Some(release.as_str()).filter(|name| is_month(name)),
        _ => None,
    });
    match roots.max() {
        Some(newest) if newest >= month => None,
        Some(newest) => Some(format!(
            "the log has no release of {month} or later: its newest release is {newest}, so the log may \
             be frozen; get the log from a different source"
        )),
        None => Some(format!(
            "the log has no monthly release, but {month} was expected; get the log from a different source"
        )),
    }
}
