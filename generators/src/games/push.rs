//! Rules of puzzles that are won only by pushing. There are one or two kinds of objects, each with its own destination.

use crate::levels::FuseSymbols;
use engine::Game;
use std::fmt::Write;

/// The destination for a kind of pushed object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// A drain: the object disappears, and the drain remains.
    Drain,
    /// A pit: the object and the pit disappear. Until then, the avatar cannot cross the pit.
    Pit,
    /// A mat: the object stays on the mat, and can be pushed off the mat again.
    Mat,
}

/// A push puzzle's rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PushRules {
    /// The destination for each kind of object.
    ends: [Option<End>; 2],
    /// `true` if objects of one kind cannot be pushed over the drains of the other kind. A drain is a target into which
    /// objects disappear. Objects can never be pushed over the other kind's pits and mats.
    exclusive: bool,
    /// `true` if there are sills: cells that the avatar can enter and objects cannot.
    has_sills: bool,
    /// `true` if deadly sprites wander at random over the board.
    has_strays: bool,
}

use End::{Drain, Mat, Pit};

const fn rules(one: End, other: Option<End>, exclusive: bool, has_sills: bool) -> PushRules {
    PushRules { ends: [Some(one), other], exclusive, has_sills, has_strays: false }
}

const fn among_strays(one: End, other: Option<End>, exclusive: bool, has_sills: bool) -> PushRules {
    PushRules { has_strays: true, ..rules(one, other, exclusive, has_sills) }
}

/// Returns the name for a kind of object.
fn name_of(kind: usize) -> &'static str {
    ["crate", "barrel"][kind]
}

/// Returns the name for objects resting on their mats.
fn settled(kind: usize) -> &'static str {
    ["settledCrate", "settledBarrel"][kind]
}

impl PushRules {
    /// All rule sets, without near-duplicates. The sets with two kinds of objects come first.
    pub const ALL: [PushRules; 15] = [
        rules(Drain, Some(Mat), false, true),
        rules(Drain, Some(Pit), true, true),
        rules(Mat, Some(Mat), false, false),
        rules(Pit, Some(Mat), false, true),
        rules(Drain, Some(Drain), true, false),
        rules(Mat, None, false, true),
        rules(Pit, Some(Pit), false, true),
        rules(Drain, Some(Pit), false, false),
        rules(Drain, Some(Mat), true, false),
        rules(Drain, Some(Drain), false, true),
        rules(Pit, None, false, true),
        rules(Drain, None, false, true),
        rules(Mat, None, false, false),
        rules(Pit, None, false, false),
        rules(Drain, None, false, false),
    ];

    /// All rule sets with deadly sprites that wander at random. No set is a near-duplicate of another in this list or
    /// in [`PushRules::ALL`].
    pub const AMONG_STRAYS: [PushRules; 10] = [
        among_strays(Drain, Some(Mat), false, true),
        among_strays(Drain, Some(Pit), true, true),
        among_strays(Mat, Some(Mat), false, false),
        among_strays(Pit, Some(Mat), false, true),
        among_strays(Drain, Some(Drain), true, false),
        among_strays(Mat, None, false, true),
        among_strays(Drain, Some(Drain), false, true),
        among_strays(Pit, None, false, true),
        among_strays(Pit, Some(Pit), false, false),
        among_strays(Drain, None, false, false),
    ];

    /// The characters used in the game's levels.
    pub const SYMBOLS: &str = ".wAcbousyznk";

    /// The number of ticks that a randomly wandering sprite takes to move one cell.
    pub(crate) const COOLDOWN: usize = 3;
    /// The number of ticks that the spark takes to burn one cell of the fuse. The fuse is the level's time limit.
    pub(crate) const BURN: usize = 25;

    /// The floor character in levels of [`PushRules::game`].
    pub const FLOOR: char = '.';
    /// The level character of the deadly sprites that wander at random.
    pub const STRAY: char = 'y';
    /// The characters of the spark, the fuse and the keg, which limit the time. They occur only together with wandering
    /// deadly sprites.
    pub(crate) const FUSE_SYMBOLS: FuseSymbols =
        FuseSymbols { spark: 'z', fuse: 'n', keg: 'k', wall: PushRules::WALL };
    /// The wall character.
    pub(crate) const WALL: char = 'w';
    /// The avatar character.
    pub(crate) const AVATAR: char = 'A';
    /// The level character of sills, which the avatar can enter and objects cannot.
    pub(crate) const SILL: char = 's';
    /// The characters of pushable objects, by kind.
    pub(crate) const THINGS: [char; 2] = ['c', 'b'];
    /// The characters of the objects' targets, by kind.
    pub(crate) const TARGETS: [char; 2] = ['o', 'u'];

    /// Returns `true` if deadly sprites wander at random, which makes the game stochastic.
    pub fn has_strays(self) -> bool {
        self.has_strays
    }

    /// Returns the same rules without wandering deadly sprites.
    pub(crate) fn without_strays(self) -> PushRules {
        PushRules { has_strays: false, ..self }
    }

    /// Returns `true` if sprites of the named type are pushed.
    pub(crate) fn is_pushed(name: &str) -> bool {
        (0..2).any(|kind| [name_of(kind), settled(kind)].contains(&name))
    }

    /// Returns `true` if sprites of the named type block the avatar and cannot be pushed.
    pub(crate) fn is_barrier(name: &str) -> bool {
        name == "wall" || (0..2).any(|kind| name.strip_prefix(name_of(kind)) == Some("pit"))
    }

    /// Returns the rule set's name, such as `drain-pit-sills`.
    pub fn name(self) -> String {
        let mut words: Vec<&str> = Vec::new();
        for end in self.ends.into_iter().flatten() {
            words.push(match end {
                Drain => "drain",
                Pit => "pit",
                Mat => "mat",
            });
        }
        words.extend(self.exclusive.then_some("exclusive"));
        words.extend(self.has_sills.then_some("sills"));
        words.extend(self.has_strays.then_some("strays"));
        words.join("-")
    }

    /// Returns the game with plain names.
    pub fn game(self) -> Game {
        Game::from_source(&self.source()).expect("all rules compile, as a test verifies")
    }

    fn source(self) -> String {
        let (mut sprites, mut mapping, mut rules) = (String::new(), String::new(), String::new());
        let kinds = self.ends.iter().flatten().count();
        // If sprites other than the avatar and the things move, `undoAll` would also undo their moves after a failed
        // push.
        let stop = if self.has_strays { "stepBack" } else { "undoAll" };

        for kind in 0..kinds {
            let (thing, mark) = (name_of(kind), PushRules::THINGS[kind]);
            if self.ends[kind] == Some(Mat) {
                let _ =
                    writeln!(sprites, "      {thing} > color=BROWN\n      {} > color=GREEN", settled(kind));
            } else {
                let _ = writeln!(sprites, "      {thing} > color=BROWN");
            }
            let _ = writeln!(mapping, "    {mark} > floor {thing}");
        }
        let mut marks = String::new();
        for (kind, end) in self.ends.iter().enumerate().filter_map(|(kind, end)| Some((kind, (*end)?))) {
            let (thing, mark) = (name_of(kind), PushRules::TARGETS[kind]);
            let target = match end {
                Drain => format!("{thing}drain"),
                Pit => format!("{thing}pit"),
                Mat => format!("{thing}mat"),
            };
            let _ = writeln!(marks, "    {target} > Immovable color=BLUE");
            match end {
                Drain => {
                    let _ = writeln!(mapping, "    {mark} > floor {target}");
                    let _ = writeln!(rules, "    {thing} {target} > killSprite scoreChange=2");
                }
                Pit => {
                    let _ = writeln!(mapping, "    {mark} > floor {target}");
                    let _ = writeln!(rules, "    {thing} {target} > killBoth scoreChange=1");
                    let _ = writeln!(rules, "    pusher {target} > stepBack");
                }
                Mat => {
                    let _ = writeln!(mapping, "    {mark} > {target}");
                    let settled = settled(kind);
                    let _ =
                        writeln!(rules, "    {thing} {target} > transformTo stype={settled} scoreChange=1");
                    let _ = writeln!(rules, "    {settled} floor > transformTo stype={thing} scoreChange=-1");
                }
            }
            if (self.exclusive || end != Drain) && kinds == 2 {
                let other = 1 - kind;
                let _ = writeln!(rules, "    {} {target} > {stop}", name_of(other));
                if self.ends[other] == Some(Mat) {
                    let _ = writeln!(rules, "    {} {target} > {stop}", settled(other));
                }
            }
        }
        rules.insert_str(0, &format!("    load load > {stop}\n"));
        if self.has_sills {
            marks.push_str("    sill > Immovable color=ORANGE\n");
            let _ = writeln!(mapping, "    {} > floor sill", PushRules::SILL);
            rules.insert_str(0, &format!("    load sill > {stop}\n"));
        }
        let mut loss = "";
        if self.has_strays {
            // Wandering sprites are drawn above the pushable objects.
            let _ =
                writeln!(sprites, "    stray > RandomNPC cooldown={} color=DARKGREEN", PushRules::COOLDOWN);
            marks.push_str("    fuse > Immovable color=BROWN\n    keg > Immovable color=BLACK\n");
            let _ = writeln!(
                sprites,
                "    spark > Missile orientation=RIGHT cooldown={} color=ORANGE",
                PushRules::BURN
            );
            let _ = writeln!(mapping, "    {} > floor stray", PushRules::STRAY);
            let FuseSymbols { spark, fuse, keg, .. } = PushRules::FUSE_SYMBOLS;
            let _ = writeln!(mapping, "    {spark} > spark\n    {fuse} > fuse\n    {keg} > keg");
            rules.push_str("    stray wall > stepBack\n    pusher stray > killSprite\n");
            rules.push_str(
                "    fuse spark > killSprite\n    keg spark > killSprite\n    pusher load > stepBack\n",
            );
            loss = "SpriteCounter stype=pusher limit=0 win=False\n    SpriteCounter stype=keg limit=0 win=False\n    ";
        }
        // The floor is visible if things can be pushed off their mats and onto it.
        let hidden = if self.ends.contains(&Some(Mat)) { "" } else { " hidden=True" };
        let ending = match kinds {
            1 => "SpriteCounter stype=crate limit=0 win=True",
            _ => "MultiSpriteCounter stype1=crate stype2=barrel limit=0 win=True",
        };
        format!(
            "BasicGame\n  SpriteSet\n    floor > Immovable{hidden}\n    wall > Immovable color=GRAY\n{marks}    \
             load > Passive\n{sprites}    pusher > MovingAvatar color=YELLOW\n  LevelMapping\n    {} > floor\n    {} > wall\n\
             {mapping}    {} > floor pusher\n  InteractionSet\n    pusher wall > stepBack\n    load pusher > bounceForward\n    \
             load wall > {stop}\n{rules}  TerminationSet\n    {loss}{ending}\n    Timeout limit=1000 win=False\n",
            PushRules::FLOOR,
            PushRules::WALL,
            PushRules::AVATAR,
        )
    }
}
