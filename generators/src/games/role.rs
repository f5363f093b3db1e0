//! The parts that sprite types play in the patterns, and the words that a fiction has for them.

/// Declares the roles once: the variant and the field of [`Words`] that names it.
macro_rules! roles {
    ($($(#[doc = $doc:literal])+ $role:ident $field:ident;)*) => {
        /// What a sprite type is in the game, whatever the fiction calls it.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub(crate) enum Role { $($(#[doc = $doc])+ $role),* }

        impl Role {
            /// All of them.
            pub(crate) const ALL: &[Role] = &[$(Role::$role),*];
        }

        /// The words that one fiction has for every role: two or more each, separated by blanks.
        ///
        /// A word is an ASCII name as VGDL takes it, `camelCase` where English writes two words.
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
    /// What lies under everything; a mass noun.
    Floor floor;
    /// What stops everything; a mass noun or a thing.
    Wall wall;
    /// Where the hero leaves, or what it is after.
    Exit exit;
    /// What opens something.
    Key key;
    /// What a key opens on the way.
    Door door;
    /// What is gathered.
    Gem gem;
    /// What is gathered too, and worth more.
    Charm charm;
    /// The one precious thing.
    Relic relic;
    /// What stands still until the relic is taken, then gives chase.
    Statue statue;
    /// What opens something elsewhere.
    Lever lever;
    /// What a crate must be pushed onto.
    Plate plate;
    /// What is pushed.
    Crate pushed;
    /// Where crates belong.
    Socket socket;
    /// What stops all until something pushed fills it.
    Pool pool;
    /// What is carried, one at a time.
    Parcel parcel;
    /// Where loads are due.
    Address address;
    /// What only a key opens.
    Chest chest;
    /// What lies ready in the raw, and never runs out.
    Ore ore;
    /// Where the raw becomes the finished.
    Forge forge;
    /// The finished.
    Ingot ingot;
    /// What is lit by touch.
    Lamp lamp;
    /// What puts lamps out.
    Snuffer snuffer;
    /// Where seed is fetched; it never runs out.
    Seed seed;
    /// Where seed is sown.
    Plot plot;
    /// What grows there.
    Sprout sprout;
    /// What eats what grows.
    Pest pest;
    /// What is to be guarded.
    Crop crop;
    /// What a beaten foe leaves.
    Trophy trophy;
    /// Who is in need of help.
    Friend friend;
    /// Where friends are safe.
    Haven haven;
    /// What lets things fall.
    Tree tree;
    /// What falls, and should be caught.
    Fruit fruit;
    /// What shelters from above.
    Cover cover;
    /// What is to be blown up.
    Idol idol;
    /// What is laid, and goes off.
    Charge charge;
    /// What it goes off in; a mass noun.
    Blast blast;
    /// What lies in wait.
    Trap trap;
    /// What goes to and fro.
    Patroller patroller;
    /// What goes to and fro another way.
    Rover rover;
    /// What strays about.
    Wanderer wanderer;
    /// What comes after the hero.
    Chaser chaser;
    /// What flies above and lets fall.
    Bomber bomber;
    /// What it lets fall.
    Drop drop;
    /// What strays about and leaves a trail.
    Slug slug;
    /// The trail; a mass noun.
    Slime slime;
    /// What stands and shoots.
    Turret turret;
    /// What it shoots.
    Dart dart;
    /// Where foes come from.
    Nest nest;
    /// What bursts out now and then.
    Vent vent;
    /// What bursts out of it; a mass noun.
    Steam steam;
    /// What spreads; a mass noun.
    Creep creep;
    /// What can be dug away; a mass noun.
    Soil soil;
    /// What bars a way for good; a mass noun.
    Rubble rubble;
    /// What falls in behind whoever passes.
    Archway archway;
    /// Where one vanishes.
    PortalIn portal_in;
    /// Where one comes out.
    PortalOut portal_out;
    /// What carries along.
    Cart cart;
    /// What is used up to pass the dark.
    Torch torch;
    /// What stops whoever has no light; a mass noun.
    Dark dark;
    /// What a lever opens on the way.
    Gate gate;
    /// What is nice to have.
    Coin coin;
    /// What heals.
    Medicine medicine;
    /// What protects once.
    Ward ward;
    /// What bears berries.
    Bush bush;
    /// What it bears.
    Berry berry;
    /// What strikes close by.
    Blade blade;
    /// What flies at the foe.
    Bolt bolt;
    /// What is needed to shoot.
    Ammo ammo;
    /// Where ammunition is found again and again.
    Rack rack;
}
