//! A sealed release's commitments to its withheld files.

use crate::format::layout::{HELD, is_solution};
use crate::format::manifest::item::Item;
use base::Digest;
use serde::{Deserialize, Serialize};

/// A sealed release's commitments to its withheld files, and the withheld files disclosed so far.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Withheld {
    /// The digest of the list of wins that can be revealed before all other withheld files.
    pub solutions: Digest,
    /// The digest of the list of all other withheld files.
    pub rest: Digest,
    /// The lists of withheld files that have been disclosed so far and the files listed in them, sorted by the bytes of
    /// their paths. Not part of the manifest's text.
    #[serde(skip)]
    pub(crate) disclosed: Vec<Item>,
}

/// A part of the withheld files. Each part is revealed as a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum HeldPart {
    /// The wins selected for early publication. For each level, a secret random choice selects one of two wins.
    Solutions,
    /// All other withheld files.
    Rest,
}

impl HeldPart {
    /// Both parts, sorted by the paths of their lists.
    pub(crate) const ALL: [HeldPart; 2] = [HeldPart::Rest, HeldPart::Solutions];

    /// Returns the path of the part's list.
    pub(crate) fn list(self) -> &'static str {
        match self {
            HeldPart::Solutions => "held/SOLUTIONS.json",
            HeldPart::Rest => "held/REST.json",
        }
    }

    /// Returns the part whose list is at the given path; `None` for any other path.
    pub(crate) fn of_list(path: &str) -> Option<HeldPart> {
        HeldPart::ALL.into_iter().find(|part| part.list() == path)
    }

    /// Returns `true` if a withheld file belongs to the part.
    pub(crate) fn has(self, path: &str) -> bool {
        path.starts_with(HELD)
            && HeldPart::of_list(path).is_none()
            && is_solution(path) == (self == HeldPart::Solutions)
    }
}

impl Withheld {
    /// Returns the digest of a part's list.
    pub(crate) fn digest(&self, part: HeldPart) -> Digest {
        match part {
            HeldPart::Solutions => self.solutions,
            HeldPart::Rest => self.rest,
        }
    }

    /// Returns `true` if a part's list is available.
    pub(crate) fn knows(&self, part: HeldPart) -> bool {
        self.disclosed.iter().any(|item| item.path == part.list())
    }
}

/// The part of the withheld files to reveal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reveal {
    /// All withheld files are revealed.
    All,
    /// Reveals only the wins that were selected at random for early publication. The other wins, the withheld copies of
    /// games, the reference results and the secret stay withheld.
    Solutions,
}
