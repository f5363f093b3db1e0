//! The kinds of games, distinguished by the way in which the player wins.

use base::Sampler;
use engine::Analysis;
use engine::analysis::Genre;
use serde::{Deserialize, Serialize};

/// Declares each kind once, with its variant, its configuration name and its title words.
macro_rules! kinds {
    ($($(#[doc = $doc:literal])+ $kind:ident $name:literal $title_words:literal;)*) => {
        /// A kind of game.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum Kind { $($(#[doc = $doc])+ $kind),* }

        impl Kind {
            /// All kinds, in a fixed order. Random draws depend on this order.
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
    /// Games in which the player reaches the exit.
    Escape "escape" "Escape Flight Exit";
    /// Games in which the player crosses lanes of traffic.
    Crossing "crossing" "Crossing Passage Traverse";
    /// Games in which the player collects items among dangers.
    CollectAndAvoid "collect-and-avoid" "Harvest Hoard Gathering";
    /// Games in which the player finds a key and opens the lock.
    KeyAndDoor "key-and-door" "Secret Lock Key";
    /// Games in which the player shoots or strikes all enemies.
    Shooter "shooter" "Hunt Stand Battle";
    /// Games in which the player pushes objects onto their targets.
    BoxPuzzle "box-puzzle" "Puzzle Labour Shift";
    /// Games in which the player saves friends from danger.
    Rescue "rescue" "Rescue Errand Vigil";
    /// Games in which the player drives fleeing or straying creatures to a target.
    Herding "herding" "Round Drive Muster";
    /// Games in which the player fetches, processes and delivers goods.
    Resource "resource" "Delivery Trade Errand";
    /// Games in which the player restores order faster than things fall into disorder.
    Tending "tending" "Rounds Watch Chore";
    /// Games in which the player stays alive until time is up.
    Survival "survival" "Ordeal Night Siege";
    /// Games in which the player protects something from harm.
    Defence "defence" "Guard Watch Defence";
    /// Games in which the player leads pursuers into traps.
    Lure "lure" "Trick Ruse Bait";
    /// Games in which the player catches falling objects.
    Catching "catching" "Catch Juggle Windfall";
    /// Games in which the player causes explosions.
    Demolition "demolition" "Demolition Blast Clearance";
}

impl Kind {
    /// Returns the kind that fits the genre of a game.
    pub(crate) fn of(analysis: &Analysis) -> Kind {
        match analysis.taxonomy().genres.first() {
            Some(Genre::Platformer | Genre::Escape) => Kind::Escape,
            Some(Genre::Race | Genre::Crossing) => Kind::Crossing,
            Some(Genre::Puzzle) => Kind::BoxPuzzle,
            Some(Genre::Shooter | Genre::Hunt) => Kind::Shooter,
            Some(Genre::Collect) => Kind::CollectAndAvoid,
            Some(Genre::Adventure) => Kind::KeyAndDoor,
            Some(Genre::Guide) => Kind::Herding,
            Some(Genre::Defence) => Kind::Defence,
            Some(Genre::Survive) => Kind::Survival,
            None => Kind::Tending,
        }
    }

    /// Draws a word for the avatar's task, for use in a title.
    pub(crate) fn title_word(self, sampler: &mut Sampler) -> &'static str {
        let title_words: Vec<&'static str> = self.title_words().split(' ').collect();
        title_words[sampler.below(title_words.len())]
    }
}
