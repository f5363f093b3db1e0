//! The observed effects of contact with each kind of sprite.

use engine::Observation;
use std::collections::{BTreeMap, BTreeSet};

/// The context of a contact: the avatar's type and the resources that the avatar holds. For example, a lock is worth
/// another try once the avatar holds a key.
pub(super) type Circumstances = (String, Vec<String>);

/// The experience with one kind of sprite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Experience {
    /// The number of ticks that the avatar has survived in contact with this kind of sprite.
    pub survived: u32,
    /// The number of ticks in which the avatar was lost during contact with this kind of sprite.
    pub deaths: u32,
    /// The number of contacts after which the score was higher, minus the number of contacts after which the score or
    /// the avatar's health was lower.
    pub gain: i32,
    /// The number of contacts after which there was one sprite fewer of this kind, the avatar held more resources, or
    /// the avatar had a different type.
    pub taken: u32,
    /// The number of contacts that pushed a sprite of this kind.
    pub pushed: u32,
    /// The contexts in which this kind of sprite stopped the avatar.
    pub(super) blocked: BTreeSet<Circumstances>,
    /// The contexts of contacts with this kind of sprite.
    pub(super) touched: BTreeSet<Circumstances>,
    /// `true` if the avatar has entered a cell with a sprite of this kind.
    pub entered: bool,
}

impl Experience {
    /// Returns `true` if contact is believed to end the game.
    pub fn is_deadly(&self) -> bool {
        self.deaths > 0 && self.deaths >= self.survived
    }

    /// Returns `true` if contact is believed to be rewarding.
    pub fn is_good(&self) -> bool {
        !self.is_deadly() && self.gain >= 0 && (self.gain > 0 || self.taken > 0)
    }

    /// Returns `true` if every contact with this kind of sprite has stopped the avatar.
    pub fn is_blocking(&self) -> bool {
        !self.blocked.is_empty() && !self.entered
    }
}

/// The experience with all kinds of sprites.
#[derive(Clone, Debug, Default)]
pub(super) struct Beliefs {
    kinds: BTreeMap<String, Experience>,
}

/// The observed changes in one or more ticks.
pub(super) struct Passed<'a> {
    pub(super) before: &'a Observation,
    pub(super) now: &'a Observation,
    /// The kinds of sprites that the avatar has touched.
    pub(super) touched: &'a [String],
    /// The kinds beside the avatar that may have touched it.
    pub(super) beside: &'a [String],
    /// The kinds in front of the avatar that blocked it: the avatar faced them but did not move.
    pub(super) in_the_way: &'a [String],
    /// The kinds of sprites in the cell that the avatar has entered.
    pub(super) entered: &'a [String],
    /// The kinds of sprites that are now in the cell behind the one that the avatar has entered.
    pub(super) pushed: &'a [String],
}

impl Beliefs {
    pub(super) fn of(&self, kind: &str) -> Option<&Experience> {
        self.kinds.get(kind)
    }

    pub(super) fn is_deadly(&self, kind: &str) -> bool {
        self.of(kind).is_some_and(Experience::is_deadly)
    }

    /// Records that contact with a kind had no visible effect.
    pub(super) fn give_up(&mut self, kind: &str, circumstances: &Circumstances) {
        self.kinds.entry(kind.to_owned()).or_default().touched.insert(circumstances.clone());
    }

    /// Updates what the player believes about the board after one or more ticks.
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
        // If a sprite has disappeared, the change is attributed to the kind of that sprite.
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

    /// Attributes a death to the likely killers. These are the touched kinds that are not known to be harmless or, if
    /// there are none, the kinds beside the avatar.
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

/// Returns the context for contacts in this observation.
pub(super) fn circumstances(seen: &Observation) -> Circumstances {
    let held = seen.resources.iter().filter(|(_, amount)| *amount > 0).map(|(name, _)| name.clone());
    (seen.avatar.as_ref().map(|avatar| avatar.name.clone()).unwrap_or_default(), held.collect())
}

/// Returns the number of cells in which a kind is visible.
fn count(seen: &Observation, kind: &str) -> usize {
    seen.cells.iter().flatten().filter(|name| *name == kind).count()
}
