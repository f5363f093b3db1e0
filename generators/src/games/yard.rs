//! Rules of yards, which are puzzles about carrying parcels. The avatar carries parcels to depots, one at a time, among
//! carts that follow signs, and before a fuse burns down.

use crate::levels::FuseSymbols;
use engine::Game;
use std::fmt::Write;

/// The rules of a yard, in which the avatar carries parcels past moving carts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct YardRules {
    /// The number of kinds of parcels, each with its own depot (destination). The maximum is [`YardRules::KINDS`].
    kinds: usize,
    /// `true` if there are points: signs that reverse their direction whenever a cart has followed them.
    has_points: bool,
    /// `true` if there are wagons: carts that take two ticks per cell.
    has_wagons: bool,
}

const fn rules(kinds: usize, has_points: bool, has_wagons: bool) -> YardRules {
    YardRules { kinds, has_points, has_wagons }
}

impl YardRules {
    /// The maximum number of kinds of parcels.
    pub const KINDS: usize = 2;

    /// All rule sets for yards, without near-duplicates.
    pub const ALL: [YardRules; 2] = [rules(1, false, false), rules(2, true, true)];

    /// The characters used in the game's levels.
    pub const SYMBOLS: &str = ".wAuldrvhcgpqoxsnk";

    /// The floor character in levels of [`YardRules::game`].
    pub(crate) const FLOOR: char = '.';
    /// The wall character.
    pub(crate) const WALL: char = 'w';
    /// The avatar character.
    pub(crate) const AVATAR: char = 'A';
    /// The sign characters, by direction: up, left, down and right.
    pub(crate) const SIGNS: [char; 4] = ['u', 'l', 'd', 'r'];
    /// The point characters: one that sends carts up and down alternately, and one that sends them right and left.
    pub(crate) const POINTS: [char; 2] = ['v', 'h'];
    /// The characters for a cart and a wagon, each placed on top of a sign that points right.
    pub(crate) const CARTS: [char; 2] = ['c', 'g'];
    /// The parcel characters, by kind.
    pub(crate) const PARCELS: [char; YardRules::KINDS] = ['p', 'q'];
    /// The characters of the depots (destinations of parcels), by kind.
    pub(crate) const DEPOTS: [char; YardRules::KINDS] = ['o', 'x'];
    /// The characters of the spark, the fuse and the keg, which limit the time.
    pub(crate) const FUSE_SYMBOLS: FuseSymbols =
        FuseSymbols { spark: 's', fuse: 'n', keg: 'k', wall: YardRules::WALL };
    /// The number of ticks that the spark takes to burn one cell of the fuse, which limits the time.
    pub(crate) const BURN: usize = 14;

    /// Returns the number of kinds of parcels.
    pub fn kinds(self) -> usize {
        self.kinds
    }

    /// Returns `true` if there are points, which are signs that reverse their direction.
    pub fn has_points(self) -> bool {
        self.has_points
    }

    /// Returns `true` if there are wagons, which are carts that take two ticks per cell.
    pub fn has_wagons(self) -> bool {
        self.has_wagons
    }

    /// Returns the rule set's name, such as `yards-2-points`.
    pub fn name(self) -> String {
        let mut name = format!("yards-{}", self.kinds);
        name.push_str(if self.has_points { "-points" } else { "" });
        name.push_str(if self.has_wagons { "-wagons" } else { "" });
        name
    }

    /// Returns the game with plain names.
    pub fn game(self) -> Game {
        Game::from_source(&self.source()).expect("all rules compile, as a test verifies")
    }

    fn source(self) -> String {
        let (mut sprites, mut mapping, mut rules) = (String::new(), String::new(), String::new());
        let (mut porters, mut goods) = (String::new(), String::new());
        if self.has_points {
            sprites.push_str(
                "    points > Missile speed=0 color=LIGHTORANGE\n      risingPoints > orientation=UP\n      crossPoints > orientation=RIGHT\n",
            );
            let _ = writeln!(mapping, "    {} > floor risingPoints", YardRules::POINTS[0]);
            let _ = writeln!(mapping, "    {} > floor crossPoints", YardRules::POINTS[1]);
            rules.push_str("    cart points > attractGaze\n    points cart > reverseDirection\n");
        }
        for kind in 0..self.kinds {
            let (parcel, depot) = (["parcel", "sack"][kind], ["depot", "shed"][kind]);
            let laden = ["parcelPorter", "sackPorter"][kind];
            let _ = writeln!(goods, "      {parcel} > color={}", ["PINK", "YELLOW"][kind]);
            let _ = writeln!(sprites, "    {depot} > Immovable color={}", ["GREEN", "ORANGE"][kind]);
            let _ = writeln!(porters, "        {laden} > color={}", ["LIGHTRED", "GOLD"][kind]);
            let _ = writeln!(mapping, "    {} > floor {parcel}", YardRules::PARCELS[kind]);
            let _ = writeln!(mapping, "    {} > floor {depot}", YardRules::DEPOTS[kind]);
            let _ = writeln!(rules, "    porter {parcel} > transformTo stype={laden} killSecond=True");
            let _ = writeln!(rules, "    {laden} {depot} > transformTo stype=porter scoreChange=1");
        }
        let mut carts = "      express >\n".to_owned();
        let _ = writeln!(mapping, "    {} > floor signRight express", YardRules::CARTS[0]);
        if self.has_wagons {
            carts.push_str("      wagon > cooldown=2 color=BLUE\n");
            let _ = writeln!(mapping, "    {} > floor signRight wagon", YardRules::CARTS[1]);
        }
        let mut signs = String::new();
        for (way, symbol) in ["Up", "Left", "Down", "Right"].into_iter().zip(YardRules::SIGNS) {
            let _ = writeln!(signs, "      sign{way} > orientation={}", way.to_uppercase());
            let _ = writeln!(mapping, "    {symbol} > floor sign{way}");
        }
        format!(
            "BasicGame\n  SpriteSet\n    floor > Immovable hidden=True\n    wall > Immovable color=GRAY\n    \
             sign > Immovable color=LIGHTBLUE\n{signs}    goods > Immovable\n{goods}{sprites}    fuse > Immovable color=BROWN\n    keg > Immovable color=BLACK\n    \
             spark > Missile orientation=RIGHT cooldown={burn} color=ORANGE\n    \
             cart > Missile orientation=RIGHT color=RED\n{carts}    worker > MovingAvatar color=WHITE\n      porter >\n      carrier >\n{porters}  \
             LevelMapping\n    {} > floor\n    {} > wall\n    {} > floor porter\n{mapping}    {} > spark\n    {} > fuse\n    {} > keg\n  \
             InteractionSet\n    worker wall > stepBack\n    cart sign > attractGaze\n{rules}    worker cart > killSprite\n    \
             fuse spark > killSprite\n    keg spark > killSprite\n  TerminationSet\n    SpriteCounter stype=keg limit=0 win=False\n    \
             SpriteCounter stype=worker limit=0 win=False\n    MultiSpriteCounter stype1=goods stype2=carrier limit=0 win=True\n    \
             Timeout limit=1000 win=False\n",
            YardRules::FLOOR,
            YardRules::WALL,
            YardRules::AVATAR,
            YardRules::FUSE_SYMBOLS.spark,
            YardRules::FUSE_SYMBOLS.fuse,
            YardRules::FUSE_SYMBOLS.keg,
            burn = YardRules::BURN,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_rules_compile() {
        for rules in YardRules::ALL {
            let game = rules.game();
            assert!(game.warnings().is_empty(), "{}: {:?}", rules.name(), game.warnings());
            assert!(!engine::Analysis::of(&game).is_stochastic(), "{}", rules.name());
        }
    }
}
