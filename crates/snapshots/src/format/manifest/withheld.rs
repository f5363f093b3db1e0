//! The commitments of a sealed release to the files that it withholds.

use crate::format::layout::{HELD, is_solution};
use crate::format::manifest::item::Item;
use base::Digest;
use serde::{Deserialize, Serialize};

/// The commitments of a sealed release to what it withholds, and what was disclosed of it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Withheld {
    /// The digest of the list of the wins that can be revealed before the rest.
    pub solutions: Digest,
    /// The digest of the list of everything else.
    pub rest: Digest,
    /// The lists that are at hand and the files that they name, sorted by the bytes of the path. Not part of the manifest's
    /// text.
    #[serde(skip)]
    pub(crate) disclosed: Vec<Item>,
}

/// A part of what is withheld, revealed as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum HeldPart {
    /// The wins that coins published.
    Solutions,
    /// Everything else.
    Rest,
}

impl HeldPart {
    /// Both parts, sorted by the paths of their lists.
    pub(crate) const ALL: [HeldPart; 2] = [HeldPart::Rest, HeldPart::Solutions];

    /// The path of its list.
    pub(crate) fn list(self) -> &'static str {
        match self {
            HeldPart::Solutions => "held/SOLUTIONS.json",
            HeldPart::Rest => "held/REST.json",
        }
    }

    /// The part whose list is at a path.
    pub(crate) fn of_list(path: &str) -> Option<HeldPart> {
        HeldPart::ALL.into_iter().find(|part| part.list() == path)
    }

    /// Tests whether it has a withheld file.
    pub(crate) fn has(self, path: &str) -> bool {
        path.starts_with(HELD)
            && HeldPart::of_list(path).is_none()
            && is_solution(path) == (self == HeldPart::Solutions)
    }
}

impl Withheld {
    /// The digest of the list of a part.
    pub(crate) fn digest(&self, part: HeldPart) -> Digest {
        match part {
            HeldPart::Solutions => self.solutions,
            HeldPart::Rest => self.rest,
        }
    }

    /// Tests whether the list of a part is at hand.
    pub(crate) fn knows(&self, part: HeldPart) -> bool {
        self.disclosed.iter().any(|item| item.path == part.list())
    }
}

/// The part of what is withheld that is revealed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reveal {
    /// All of it.
    All,
    /// The wins that coins published; the other ones, siblings, marks and the secret stay withheld.
    Solutions,
}
