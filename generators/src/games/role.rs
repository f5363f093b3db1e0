//! The roles that sprite types play in games, and the words that a theme has for them.

/// Declares the roles once: the variant and the field of [`Words`] that names it.
macro_rules! roles {
    ($($(#[doc = $doc:literal])+ $role:ident $field:ident;)*) => {
        /// The role of a sprite type in the game, independent of its name in the theme.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub(crate) enum Role { $($(#[doc = $doc])+ $role),* }

        impl Role {
            /// All roles.
            pub(crate) const ALL: &[Role] = &[$(Role::$role),*];
        }

        /// The words that one theme has for every role: two or more each, separated by blanks.
        ///
        /// A word is an ASCII name that is valid in VGDL, `camelCase` where English writes two words.
        pub(crate) struct Words { $($(#[doc = $doc])+ pub(crate) $field: &'static str),* }

        impl Words {
            /// The words for one role.
            pub(crate) fn of(&self, role: Role) -> &'static str {
                match role { $(Role::$role => self.$field),* }
            }
        }
    };
}

roles! {
    /// The player's character.
    Hero hero;
    /// The ground under everything; a mass noun.
    Floor floor;
    /// An obstacle to everything; a mass noun or a thing.
    Wall wall;
    /// A place where the hero leaves, or a destination.
    Exit exit;
    /// A thing that opens something.
    Key key;
    /// An obstacle that a key opens.
    Door door;
    /// A thing to gather.
    Gem gem;
    /// Another thing to gather, worth more.
    Charm charm;
    /// A unique, precious thing.
    Relic relic;
    /// A figure that stands still until the relic is taken, then chases the hero.
    Statue statue;
    /// A thing that opens something elsewhere.
    Lever lever;
    /// A target that a crate must be pushed onto.
    Plate plate;
    /// A thing to push.
    Crate pushed;
    /// A target for crates.
    Socket socket;
    /// An obstacle to everything until something pushed fills it.
    Pool pool;
    /// A load that is carried, one at a time.
    Parcel parcel;
    /// A destination for loads.
    Address address;
    /// A container that only a key opens.
    Chest chest;
    /// A source of raw material that never runs out.
    Ore ore;
    /// A place where raw material is processed.
    Forge forge;
    /// The processed material.
    Ingot ingot;
    /// A thing that is lit by touch.
    Lamp lamp;
    /// A creature that puts lamps out.
    Snuffer snuffer;
    /// A source of seed that never runs out.
    Seed seed;
    /// A place to sow seed.
    Plot plot;
    /// A plant that grows from seed.
    Sprout sprout;
    /// A creature that eats plants.
    Pest pest;
    /// A thing to guard.
    Crop crop;
    /// A thing that a beaten foe leaves.
    Trophy trophy;
    /// A creature in need of help.
    Friend friend;
    /// A place where friends are safe.
    Haven haven;
    /// A source of falling things.
    Tree tree;
    /// A falling thing that should be caught.
    Fruit fruit;
    /// A shelter from above.
    Cover cover;
    /// A thing to blow up.
    Idol idol;
    /// An explosive to lay.
    Charge charge;
    /// The explosion of a charge; a mass noun.
    Blast blast;
    /// A stationary danger.
    Trap trap;
    /// A foe that moves to and fro.
    Patroller patroller;
    /// A foe that moves to and fro another way.
    Rover rover;
    /// A foe that moves about at random.
    Wanderer wanderer;
    /// A foe that chases the hero.
    Chaser chaser;
    /// A foe that flies above and drops things.
    Bomber bomber;
    /// A thing that a bomber drops.
    Drop drop;
    /// A foe that moves about at random and leaves a trail.
    Slug slug;
    /// The trail; a mass noun.
    Slime slime;
    /// A foe that stands and shoots.
    Turret turret;
    /// A shot of a turret.
    Dart dart;
    /// A source of foes.
    Nest nest;
    /// A source of occasional bursts.
    Vent vent;
    /// A burst from a vent; a mass noun.
    Steam steam;
    /// A spreading hazard; a mass noun.
    Creep creep;
    /// An obstacle that can be dug away; a mass noun.
    Soil soil;
    /// A permanent obstacle; a mass noun.
    Rubble rubble;
    /// A passage that collapses behind the hero.
    Archway archway;
    /// An entrance of a portal.
    PortalIn portal_in;
    /// An exit of a portal.
    PortalOut portal_out;
    /// A vehicle.
    Cart cart;
    /// A thing that is used up to pass the dark.
    Torch torch;
    /// An obstacle for a hero without light; a mass noun.
    Dark dark;
    /// An obstacle that a lever opens.
    Gate gate;
    /// A thing that is useful or worth points.
    Coin coin;
    /// A thing that heals.
    Medicine medicine;
    /// A thing that protects once.
    Ward ward;
    /// A source of berries.
    Bush bush;
    /// A fruit of a bush.
    Berry berry;
    /// A weapon for close combat.
    Blade blade;
    /// A shot of the hero.
    Bolt bolt;
    /// Ammunition for shooting.
    Ammo ammo;
    /// A source of ammunition.
    Rack rack;
}
