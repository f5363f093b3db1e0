//! The kinds of games, by how they are won.

use base::Sampler;
use serde::{Deserialize, Serialize};

/// Declares each kind once: its variant, its name in configurations, and its words for titles.
macro_rules! kinds {
    ($($(#[doc = $doc:literal])+ $kind:ident $name:literal $title_words:literal;)*) => {
        /// A kind of game.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum Kind { $($(#[doc = $doc])+ $kind),* }

        impl Kind {
            /// All kinds, in a fixed order that draws depend on.
            pub const ALL: &[Kind] = &[$(Kind::$kind),*];

            /// Returns the name used in configurations and cards.
            pub fn name(self) -> &'static str {
                match self { $(Kind::$kind => $name),* }
            }

            fn title_words(self) -> &'static str {
                match self { $(Kind::$kind => $title_words),* }
            }
        }
    };
}

kinds! {
    /// Reach the exit.
    Escape "escape" "Escape Flight Exit";
    /// Cross lanes of traffic.
    Crossing "crossing" "Crossing Passage Traverse";
    /// Collect things among dangers.
    CollectAndAvoid "collect-and-avoid" "Harvest Hoard Gathering";
    /// Find a key and open the lock.
    KeyAndDoor "key-and-door" "Secret Lock Key";
    /// Shoot or strike all foes.
    Shooter "shooter" "Hunt Stand Battle";
    /// Push things onto their targets.
    BoxPuzzle "box-puzzle" "Puzzle Labour Shift";
    /// Save friends from danger.
    Rescue "rescue" "Rescue Errand Vigil";
    /// Drive fleeing or straying creatures to a place.
    Herding "herding" "Round Drive Muster";
    /// Fetch, process and deliver goods.
    Resource "resource" "Delivery Trade Errand";
    /// Keep everything in order faster than it falls into disorder.
    Tending "tending" "Rounds Watch Chore";
    /// Stay alive until time is up.
    Survival "survival" "Ordeal Night Siege";
    /// Protect something from harm.
    Defence "defence" "Guard Watch Defence";
    /// Lead pursuers into traps.
    Lure "lure" "Trick Ruse Bait";
    /// Catch falling things.
    Catching "catching" "Catch Juggle Windfall";
    /// Blow things up.
    Demolition "demolition" "Demolition Blast Clearance";
}

impl Kind {
    /// Draws a title word for the hero's task.
    pub(crate) fn title_word(self, sampler: &mut Sampler) -> &'static str {
        let title_words: Vec<&'static str> = self.title_words().split(' ').collect();
        title_words[sampler.below(title_words.len())]
    }
}
