//! Rules of lock puzzles. Doors use up keys, and planks carry the avatar only once, so the order of moves matters.

use engine::Game;
use std::fmt::Write;

/// A lock puzzle's rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LockRules {
    /// The number of kinds of keys, each with its own doors. The maximum is [`LockRules::KINDS`].
    kinds: usize,
    /// `true` if there are planks: floor that carries the avatar only once.
    has_planks: bool,
    /// `true` if the player wins by collecting all gems; `false` if the player wins by reaching the exit.
    has_gems: bool,
}

const fn rules(kinds: usize, has_planks: bool, has_gems: bool) -> LockRules {
    LockRules { kinds, has_planks, has_gems }
}

impl LockRules {
    /// The maximum number of kinds of keys.
    pub const KINDS: usize = 2;

    /// All rule sets for lock puzzles, without near-duplicates.
    pub const ALL: [LockRules; 3] = [rules(2, true, true), rules(2, false, false), rules(1, false, true)];

    /// The characters used in the game's levels.
    pub const SYMBOLS: &str = ".wpbgklde";

    /// The floor character in levels of [`LockRules::game`].
    pub(crate) const FLOOR: char = '.';
    /// The wall character.
    pub(crate) const WALL: char = 'w';
    /// The avatar character.
    pub(crate) const AVATAR: char = 'p';
    /// The plank character.
    pub(crate) const PLANK: char = 'b';
    /// The character of the goal: a gem or the exit.
    pub(crate) const GOAL: char = 'g';
    /// The key characters, by kind.
    pub(crate) const KEYS: [char; LockRules::KINDS] = ['k', 'l'];
    /// The door characters, by kind.
    pub(crate) const DOORS: [char; LockRules::KINDS] = ['d', 'e'];

    /// Returns the number of kinds of keys.
    pub fn kinds(self) -> usize {
        self.kinds
    }

    /// Returns `true` if there are planks: floor that carries the avatar only once.
    pub fn has_planks(self) -> bool {
        self.has_planks
    }

    /// Returns `true` if the player wins by collecting all gems.
    pub fn has_gems(self) -> bool {
        self.has_gems
    }

    /// Returns the rule set's name, such as `locks-2-planks-gems`.
    pub fn name(self) -> String {
        let mut name = format!("locks-{}", self.kinds);
        if self.has_planks {
            name.push_str("-planks");
        }
        name.push_str(if self.has_gems { "-gems" } else { "-exit" });
        name
    }

    /// Returns the game with plain names.
    pub fn game(self) -> Game {
        Game::from_source(&self.source()).expect("all rules compile, as a test verifies")
    }

    fn source(self) -> String {
        let (mut sprites, mut mapping, mut rules) = (String::new(), String::new(), String::new());
        for kind in 0..self.kinds {
            let (key, door) = (["key", "seal"][kind], ["door", "gate"][kind]);
            let color = ["YELLOW", "LIGHTBLUE"][kind];
            let _ = writeln!(sprites, "    {key} > Resource color={color} limit=24");
            let _ = writeln!(sprites, "    {door} > Immovable color={}", ["ORANGE", "BLUE"][kind]);
            let _ = writeln!(mapping, "    {} > floor {key}", LockRules::KEYS[kind]);
            let _ = writeln!(mapping, "    {} > floor {door}", LockRules::DOORS[kind]);
            let _ = writeln!(rules, "    {key} opener > collectResource scoreChange=1");
            let _ = writeln!(
                rules,
                "    {door} opener > killIfOtherHasMore resource={key} limit=1 subtract=True scoreChange=1"
            );
            let _ = writeln!(rules, "    opener {door} > stepBack");
        }
        if self.has_planks {
            sprites.push_str("    pit > Immovable color=BLACK\n    plank > Immovable color=BROWN\n");
            let _ = writeln!(mapping, "    {} > floor plank", LockRules::PLANK);
            rules.insert_str(0, "    opener pit > stepBack\n    plank opener > transformTo stype=pit\n");
        }
        let goal = if self.has_gems { "gem" } else { "exit" };
        let class = if self.has_gems { "Immovable color=PINK" } else { "Door color=GREEN" };
        format!(
            "BasicGame\n  SpriteSet\n    floor > Immovable hidden=True\n    wall > Immovable color=GRAY\n{sprites}    \
             {goal} > {class}\n    opener > MovingAvatar color=WHITE\n  LevelMapping\n    {} > floor\n    {} > wall\n{mapping}    \
             {} > floor {goal}\n    {} > floor opener\n  InteractionSet\n    opener wall > stepBack\n{rules}    \
             {goal} opener > killSprite scoreChange=5\n  TerminationSet\n    SpriteCounter stype={goal} limit=0 win=True\n    \
             Timeout limit=1000 win=False\n",
            LockRules::FLOOR,
            LockRules::WALL,
            LockRules::GOAL,
            LockRules::AVATAR,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;
    use engine::{Action, Outcome};

    /// A key opens one door, one tick before the avatar enters the door. A plank carries the avatar once.
    #[test]
    fn doors_use_up_keys_and_planks_carry_once() {
        let game = LockRules { kinds: 1, has_planks: true, has_gems: false }.game();
        let play = |level: &str, actions: &[Action]| {
            let level = game.level(level).unwrap();
            let mut state = game.start(&level, Seed::from_text("locks"));
            for &action in actions {
                game.step(&mut state, action);
            }
            (state.outcome(), state.avatar_place().map(|(x, _)| x / state.block()))
        };
        use Action::{Left, Right};
        assert_eq!(play("wwwwww\nwpkdgw\nwwwwww\n", &[Right; 3]).1, Some(3));
        assert_eq!(play("wwwwww\nwpkdgw\nwwwwww\n", &[Right; 4]).0, Outcome::Won);
        assert_eq!(play("wwwwwww\nwpkddgw\nwwwwwww\n", &[Right; 9]), (Outcome::Ongoing, Some(3)));
        assert_eq!(play("wwwwww\nwpdkgw\nwwwwww\n", &[Right; 3]), (Outcome::Ongoing, Some(1)));
        assert_eq!(
            play("wwwwww\nwpb.gw\nwwwwww\n", &[Right, Right, Left, Left]),
            (Outcome::Ongoing, Some(3))
        );
        assert_eq!(play("wwwwww\nwpb.gw\nwwwwww\n", &[Right; 3]).0, Outcome::Won);
    }

    #[test]
    fn all_rules_compile() {
        for rules in LockRules::ALL {
            assert!(rules.game().is_deterministic(), "{}", rules.name());
        }
    }
}
