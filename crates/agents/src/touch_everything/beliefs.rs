//! The effects of touches so far, by kind of sprite.

use engine::Observation;
use std::collections::{BTreeMap, BTreeSet};

/// The circumstances of a touch: what the avatar is, and what it holds. A lock is worth another try with a key.
pub(super) type Circumstances = (String, Vec<String>);

/// The experience with one kind of sprite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Experience {
    /// Ticks in contact with it that were survived.
    pub survived: u32,
    /// Ticks in which the avatar was lost in contact with it.
    pub deaths: u32,
    /// Contacts after which the score was higher, less those after which it or the avatar's health was lower.
    pub gain: i32,
    /// Contacts after which there was one fewer of it, or after which the avatar held more or was another.
    pub taken: u32,
    /// Contacts that moved it along.
    pub pushed: u32,
    /// The circumstances in which it stopped the avatar.
    pub(super) blocked: BTreeSet<Circumstances>,
    /// The circumstances in which it was touched.
    pub(super) touched: BTreeSet<Circumstances>,
    /// The cell of the sprite was entered.
    pub entered: bool,
}

impl Experience {
    /// Returns `true` if contact is believed to end the game.
    pub fn is_deadly(&self) -> bool {
        self.deaths > 0 && self.deaths >= self.survived
    }

    /// Returns `true` if contact is believed to pay.
    pub fn is_good(&self) -> bool {
        !self.is_deadly() && self.gain >= 0 && (self.gain > 0 || self.taken > 0)
    }

    /// Returns `true` if it has stopped the avatar whenever it was touched.
    pub fn is_blocking(&self) -> bool {
        !self.blocked.is_empty() && !self.entered
    }
}

/// The experience with all kinds.
#[derive(Clone, Debug, Default)]
pub(super) struct Beliefs {
    kinds: BTreeMap<String, Experience>,
}

/// A tick, or several, as the player has seen them.
pub(super) struct Passed<'a> {
    pub(super) before: &'a Observation,
    pub(super) now: &'a Observation,
    /// The kinds that were touched, and those that may have come from beside.
    pub(super) touched: &'a [String],
    pub(super) beside: &'a [String],
    /// The kinds that stood in the way, if the avatar did not move although it faced them.
    pub(super) in_the_way: &'a [String],
    /// The kinds whose cell was entered, and those that are now in the cell beyond it.
    pub(super) entered: &'a [String],
    pub(super) pushed: &'a [String],
}

impl Beliefs {
    pub(super) fn of(&self, kind: &str) -> Option<&Experience> {
        self.kinds.get(kind)
    }

    pub(super) fn is_deadly(&self, kind: &str) -> bool {
        self.of(kind).is_some_and(Experience::is_deadly)
    }

    /// Marks a kind as touched without an effect that could be seen.
    pub(super) fn give_up(&mut self, kind: &str, circumstances: &Circumstances) {
        self.kinds.entry(kind.to_owned()).or_default().touched.insert(circumstances.clone());
    }

    /// Learns from what has passed.
    pub(super) fn learn(&mut self, passed: &Passed<'_>) {
        let Passed { before, now, .. } = passed;
        let circumstances = circumstances(before);
        let is_lost = before.avatar.is_some() && now.avatar.is_none();
        if is_lost && now.outcome != engine::Outcome::Won {
            return self.blame(passed, &circumstances);
        }
        let health = |seen: &Observation| seen.avatar.as_ref().map_or(0, |avatar| avatar.health);
        let held = |seen: &Observation| seen.resources.iter().map(|(_, amount)| amount).sum::<i32>();
        let is_hurt = now.score < before.score || health(now) < health(before);
        let change = i32::from(now.score > before.score) - i32::from(is_hurt);
        let is_other = before.avatar.as_ref().map(|avatar| &avatar.name)
            != now.avatar.as_ref().map(|avatar| &avatar.name);
        let is_richer = held(now) > held(before) || is_other;
        let is_fewer = |kind: &String| count(now, kind) < count(before, kind);
        // Where something has gone, it is what the change comes from.
        let anything_gone = passed.touched.iter().any(is_fewer);
        for kind in passed.touched {
            let is_cause = is_fewer(kind) || !anything_gone;
            let known = self.kinds.entry(kind.clone()).or_default();
            known.survived += 1;
            known.gain += if is_cause { change } else { 0 };
            known.taken += u32::from(is_fewer(kind) || (is_cause && is_richer && !known.entered));
            known.touched.insert(circumstances.clone());
        }
        for kind in passed.in_the_way {
            self.kinds.entry(kind.clone()).or_default().blocked.insert(circumstances.clone());
        }
        for kind in passed.entered {
            self.kinds.entry(kind.clone()).or_default().entered = true;
        }
        for kind in passed.pushed {
            self.kinds.entry(kind.clone()).or_default().pushed += 1;
        }
    }

    /// Finds the likely killers: kinds that were touched and are not known to be harmless, else those that were beside.
    fn blame(&mut self, passed: &Passed<'_>, circumstances: &Circumstances) {
        let is_suspect = |kind: &&String| self.of(kind).is_none_or(|known| known.deaths >= known.survived);
        let touched: Vec<String> = passed.touched.iter().filter(is_suspect).cloned().collect();
        let beside = || passed.beside.iter().filter(is_suspect).cloned().collect();
        let suspects: Vec<String> = if touched.is_empty() { beside() } else { touched };
        for kind in suspects {
            let known = self.kinds.entry(kind).or_default();
            known.deaths += 1;
            known.touched.insert(circumstances.clone());
        }
    }
}

/// Returns the circumstances of touches from here.
pub(super) fn circumstances(seen: &Observation) -> Circumstances {
    let held = seen.resources.iter().filter(|(_, amount)| *amount > 0).map(|(name, _)| name.clone());
    (seen.avatar.as_ref().map(|avatar| avatar.name.clone()).unwrap_or_default(), held.collect())
}

/// Returns the number of cells in which a kind is seen.
fn count(seen: &Observation, kind: &str) -> usize {
    seen.cells.iter().flatten().filter(|name| *name == kind).count()
}
