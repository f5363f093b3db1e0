//! What sort of game it is, by what wins it.

use engine::Sampler;
use serde::{Deserialize, Serialize};

/// Declares the kinds once: variant, name as written, words for titles.
macro_rules! kinds {
    ($($(#[doc = $doc:literal])+ $kind:ident $name:literal $deeds:literal;)*) => {
        /// A sort of game.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum Kind { $($(#[doc = $doc])+ $kind),* }

        impl Kind {
            /// All kinds, in a fixed order: draws depend on it.
            pub const ALL: &[Kind] = &[$(Kind::$kind),*];

            /// As written in configurations and cards.
            pub fn name(self) -> &'static str {
                match self { $(Kind::$kind => $name),* }
            }

            fn deeds(self) -> &'static str {
                match self { $(Kind::$kind => $deeds),* }
            }
        }
    };
}

kinds! {
    /// Get out.
    Escape "escape" "Escape Flight Exit";
    /// Get across lanes of traffic.
    Crossing "crossing" "Crossing Passage Traverse";
    /// Gather things among dangers.
    CollectAndAvoid "collect-and-avoid" "Harvest Hoard Gathering";
    /// Find what opens, and open it.
    KeyAndDoor "key-and-door" "Secret Lock Key";
    /// Shoot or strike them all.
    Shooter "shooter" "Hunt Stand Battle";
    /// Push things where they belong.
    BoxPuzzle "box-puzzle" "Puzzle Labour Shift";
    /// Get friends out of danger.
    Rescue "rescue" "Rescue Errand Vigil";
    /// Drive the shy where they belong.
    Herding "herding" "Round Drive Muster";
    /// Fetch, make, deliver.
    Resource "resource" "Delivery Trade Errand";
    /// Set everything right faster than it goes wrong.
    Tending "tending" "Rounds Watch Chore";
    /// Stay alive until time is up.
    Survival "survival" "Ordeal Night Siege";
    /// Keep what is in one's care from harm.
    Defence "defence" "Guard Watch Defence";
    /// Lead pursuers into traps.
    Lure "lure" "Trick Ruse Bait";
    /// Catch what falls.
    Catching "catching" "Catch Juggle Windfall";
    /// Blow things up.
    Demolition "demolition" "Demolition Blast Clearance";
}

impl Kind {
    /// What one does in such games, for titles.
    pub(crate) fn deed(self, sampler: &mut Sampler) -> &'static str {
        let deeds: Vec<&'static str> = self.deeds().split(' ').collect();
        deeds[sampler.below(deeds.len())]
    }
}
