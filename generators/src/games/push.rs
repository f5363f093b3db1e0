//! Rules of puzzles that are won by pushing alone: kinds of things, each with its own destination.

use engine::Game;
use std::fmt::Write;

/// The destination of a kind of things.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// A drain: the thing goes, the drain stays.
    Drain,
    /// A pit: both go. The avatar cannot cross it before.
    Pit,
    /// A mat: the thing stays on it, and can be pushed off again.
    Mat,
}

/// The rules of a push puzzle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PushRules {
    /// By kind.
    ends: [Option<End>; 2],
    /// A kind cannot be pushed over the drains of the other, as it never can over pits and mats.
    exclusive: bool,
    /// The avatar can walk where things cannot be pushed.
    has_sills: bool,
}

use End::{Drain, Mat, Pit};

const fn rules(one: End, other: Option<End>, exclusive: bool, has_sills: bool) -> PushRules {
    PushRules { ends: [Some(one), other], exclusive, has_sills }
}

/// The name of a kind.
fn name_of(kind: usize) -> &'static str {
    ["crate", "barrel"][kind]
}

impl PushRules {
    /// All rules, no two of which are near to each other; those with two kinds of things first.
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

    /// A name, such as `drain-pit-sills`.
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
        words.join("-")
    }

    /// The game, under plain names.
    ///
    /// # Panics
    /// Never: all rules compile, as a test checks.
    pub fn game(self) -> Game {
        Game::from_source(&self.source()).expect("the rules compile")
    }

    fn source(self) -> String {
        let (mut sprites, mut mapping, mut rules) = (String::new(), String::new(), String::new());
        let kinds = self.ends.iter().flatten().count();

        for kind in 0..kinds {
            let (thing, mark) = (name_of(kind), ["c", "b"][kind]);
            if self.ends[kind] == Some(Mat) {
                let _ = writeln!(sprites, "      set{thing} > color=GREEN\n      {thing} > color=BROWN");
            } else {
                let _ = writeln!(sprites, "      {thing} > color=BROWN");
            }
            let _ = writeln!(mapping, "    {mark} > floor {thing}");
        }
        let mut marks = String::new();
        for (kind, end) in self.ends.iter().enumerate().filter_map(|(kind, end)| Some((kind, (*end)?))) {
            let (thing, mark) = (name_of(kind), ["o", "u"][kind]);
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
                    let _ = writeln!(rules, "    avatar {target} > stepBack");
                }
                Mat => {
                    let _ = writeln!(mapping, "    {mark} > {target}");
                    let _ =
                        writeln!(rules, "    {thing} {target} > transformTo stype=set{thing} scoreChange=1");
                    let _ =
                        writeln!(rules, "    set{thing} floor > transformTo stype={thing} scoreChange=-1");
                }
            }
            if (self.exclusive || end != Drain) && kinds == 2 {
                let other = 1 - kind;
                let _ = writeln!(rules, "    {} {target} > undoAll", name_of(other));
                if self.ends[other] == Some(Mat) {
                    let _ = writeln!(rules, "    set{} {target} > undoAll", name_of(other));
                }
            }
        }
        rules.insert_str(0, "    load load > undoAll\n");
        if self.has_sills {
            marks.push_str("    sill > Immovable color=ORANGE\n");
            mapping.push_str("    s > floor sill\n");
            rules.insert_str(0, "    load sill > undoAll\n");
        }
        // What a thing pushed off its mat lands on is seen.
        let hidden = if self.ends.contains(&Some(Mat)) { "" } else { " hidden=True" };
        let ending = match kinds {
            1 => "SpriteCounter stype=crate limit=0 win=True",
            _ => "MultiSpriteCounter stype1=crate stype2=barrel limit=0 win=True",
        };
        format!(
            "BasicGame\n  SpriteSet\n    floor > Immovable{hidden}\n    wall > Immovable color=GRAY\n{marks}    \
             load > Passive\n{sprites}    avatar > MovingAvatar color=YELLOW\n  LevelMapping\n    . > floor\n    w > wall\n\
             {mapping}    A > floor avatar\n  InteractionSet\n    avatar wall > stepBack\n    load avatar > bounceForward\n    \
             load wall > undoAll\n{rules}  TerminationSet\n    {ending}\n    Timeout limit=1000 win=False\n"
        )
    }
}
