//! Games that challenge proofs: generated games and corpus games, each with several changes. Most of them
//! break an assumption.

use crate::any_game::any_game;
use crate::choices::{Choices, random_bytes};
use crate::{generated, read, workspace_root};
use base::{Sampler, Seed};
use engine::SpriteClass;
use engine::syntax;
use std::sync::LazyLock;

/// The corpus games that are small enough, each with its levels.
static CORPUS: LazyLock<Vec<(String, Vec<String>)>> = LazyLock::new(|| {
    let folders = workspace_root().join("corpora").read_dir().expect("the corpus can be read");
    let mut folders: Vec<_> = folders.map(|entry| entry.expect("the corpus can be read").path()).collect();
    folders.sort();
    let load = |folder: &std::path::PathBuf| {
        let levels = (0..).map(|number| folder.join(format!("lvl{number}.txt")));
        let levels: Vec<String> = levels.take_while(|file| file.exists()).map(read).collect();
        (read(folder.join("game.vgdl")), levels)
    };
    folders.iter().map(load).collect()
});

/// Returns the game and the level for a seed. They do not necessarily load.
pub fn game(seed: Seed) -> (String, String) {
    let mut sampler = seed.child("game", 0).sampler();
    let (source, level, changes) = match sampler.below(10) {
        0..=2 => {
            let length = sampler.between(0, 600);
            let made = any_game(&mut Choices::new(&random_bytes(&mut sampler, length)));
            (made.source, made.level, sampler.below(2))
        }
        3 => {
            let (source, level) = generated::game(&mut sampler);
            (source, level, sampler.below(3))
        }
        4 => {
            let (source, levels) = &CORPUS[sampler.below(CORPUS.len())];
            let level = levels[sampler.below(levels.len())].clone();
            let level = cropped(&level, &mut sampler);
            (source.clone(), level, sampler.between(1, 4))
        }
        _ => {
            let (source, level) = plain(&mut sampler);
            (source, level, sampler.below(4))
        }
    };
    let mut text = Text::of(&source, &level);
    for _ in 0..changes {
        text.change(&mut sampler);
    }
    (text.source(), text.level())
}

/// Returns a part of a level, small enough that short episodes cover much of it.
fn cropped(level: &str, sampler: &mut Sampler) -> String {
    let rows: Vec<&str> = level.lines().collect();
    let width = rows.first().map_or(0, |row| row.len());
    if width <= 12 && rows.len() <= 8 || sampler.ratio(1, 4) {
        return level.to_owned();
    }
    let (columns, height) = (sampler.between(4, 12).min(width), sampler.between(3, 8).min(rows.len()));
    let (left, top) = (sampler.below(width - columns + 1), sampler.below(rows.len() - height + 1));
    rows[top..top + height]
        .iter()
        .map(|row| row.get(left..left + columns).unwrap_or(row).to_owned() + "\n")
        .collect()
}

/// The sprite types' names.
const THINGS: [&str; 6] = ["gem", "pit", "owl", "box", "key", "gate"];

/// Returns a small, ordinary game that often ends under random play.
fn plain(sampler: &mut Sampler) -> (String, String) {
    // Some games have gates that consume keys, with fewer or more keys than gates.
    let pays = sampler.ratio(1, 5);
    let things = if pays { &THINGS[..] } else { &THINGS[..sampler.between(2, 6)] };
    let mut names: Vec<String> = things.iter().map(|&name| name.to_owned()).collect();
    let mut sprites = String::new();
    let grouped = sampler.ratio(1, 4);
    if grouped {
        let class = *sampler.choose(&["", "", "Immovable", "Passive", "Missile speed=0.5"]);
        sprites += &format!("        thing > {class}\n");
    }
    for (at, name) in things.iter().enumerate() {
        let class = *sampler.choose(&[
            "Immovable",
            "Immovable",
            "Immovable",
            "Passive",
            "Resource limit=2",
            "Resource limit=1 value=2",
            "RandomNPC",
            "RandomNPC cooldown=2",
            "Missile orientation=LEFT",
            "Missile orientation=DOWN speed=0.5",
            "Flicker limit=4",
            "Chaser stype=hero",
            "Fleeing stype=hero",
            "Portal stype=N",
            "Door",
            "SpawnPoint stype=N cooldown=3 total=2",
            "SpawnPoint stype=N cooldown=2",
            "Bomber stype=N cooldown=3",
            "Spreader stype=N spreadprob=0.5",
            "OrientedFlicker limit=3",
        ]);
        let class = match *name {
            "key" if pays => "Resource limit=3",
            "gate" if pays => "Immovable",
            _ => class,
        };
        let other = things[sampler.below(things.len())];
        let class = class.replace("stype=N", &format!("stype={other}"));
        let indent = if grouped && at < 2 { "            " } else { "        " };
        sprites += &format!("{indent}{name} > {class}\n");
    }
    let other = things[sampler.below(things.len())];
    let avatar = *sampler.choose(&[
        "MovingAvatar",
        "MovingAvatar",
        "MovingAvatar",
        "MovingAvatar",
        "ShootAvatar stype=N",
        "FlakAvatar stype=N",
        "HorizontalAvatar",
        "VerticalAvatar",
        "OngoingAvatar",
        "MissileAvatar",
        "NullAvatar",
        "OrientedAvatar",
    ]);
    sprites += &match sampler.below(6) {
        0 => {
            names.extend(["hero", "young", "old"].map(str::to_owned));
            format!(
                "        hero > {}\n            young >\n            old >\n",
                avatar.replace("=N", &format!("={other}"))
            )
        }
        1 => {
            names.extend(["hero", "ghost"].map(str::to_owned));
            format!(
                "        hero > {}\n        ghost > MovingAvatar\n",
                avatar.replace("=N", &format!("={other}"))
            )
        }
        _ => {
            names.push("hero".to_owned());
            format!("        hero > {}\n", avatar.replace("=N", &format!("={other}")))
        }
    };
    if grouped {
        names.push("thing".to_owned());
    }
    let start =
        if names.iter().any(|name| name == "young") && sampler.ratio(4, 5) { "young" } else { "hero" };
    let mut mapping = format!("        A > {start}\n        w > wall\n");
    for name in things {
        if sampler.ratio(1, 10) {
            continue;
        }
        let other = if sampler.ratio(1, 8) { format!(" {}", sampler.choose(&names)) } else { String::new() };
        mapping += &format!("        {} > {name}{other}\n", &name[..1]);
    }
    let some = |sampler: &mut Sampler| names[sampler.below(names.len())].clone();
    let mut rules = String::new();
    if pays {
        rules += "        key hero > collectResource\n";
        rules += match sampler.below(3) {
            0 => "        gate hero > killIfOtherHasMore resource=key limit=1 subtract=True\n",
            1 => {
                "        gate hero > killIfOtherHasMore resource=key limit=1\n        hero gate > changeResource resource=key value=-1\n"
            }
            _ => {
                "        hero gate > changeResource resource=key value=-1\n        gate hero > killIfOtherHasMore resource=key limit=1\n"
            }
        };
    }
    for _ in 0..sampler.between(if pays { 0 } else { 1 }, if pays { 3 } else { 6 }) {
        let rule = *sampler.choose(&[
            "N hero > killSprite scoreChange=1",
            "N hero > killSprite",
            "hero N > killSprite",
            "hero N > stepBack",
            "N hero > collectResource",
            "N hero > bounceForward",
            "N N wall > undoAll",
            "N N > stepBack",
            "N N > killSprite",
            "N N > transformTo stype=N",
            "hero N > transformTo stype=N",
            "hero N > teleportToExit",
            "N hero > killIfOtherHasMore resource=N limit=1",
            "hero N > killIfHasLess resource=N limit=0",
            "N EOS > wrapAround",
            "N EOS > killSprite",
            "N wall > reverseDirection",
            "N N > killBoth",
            "N N > cloneSprite",
            "N N > spawn stype=N",
            "N N > pullWithIt",
            "N N > changeResource resource=N value=2",
        ]);
        let words: Vec<String> = rule
            .split(' ')
            .map(|word| match word.strip_suffix('N') {
                Some(start) if start.is_empty() || start.ends_with('=') => {
                    format!("{start}{}", some(sampler))
                }
                _ => word.to_owned(),
            })
            .collect();
        rules += &format!("        {}\n", words.join(" "));
    }
    if sampler.ratio(2, 3) {
        rules += "        hero wall EOS > stepBack\n";
    }
    let first = if pays { "        SpriteCounter stype=gate win=True\n" } else { "" };
    let ends: String =
        (0..sampler.between(usize::from(!pays), 3)).map(|_| termination(sampler, &names)).collect();
    let header = *sampler.choose(&["", "", "", " square_size=10"]);
    let source = format!(
        "BasicGame{header}\n    SpriteSet\n{sprites}    LevelMapping\n{mapping}    InteractionSet\n{rules}    TerminationSet\n{first}{ends}"
    );
    let (columns, rows) = (sampler.between(2, 7), sampler.between(1, 5));
    let mut cells: Vec<char> = (0..columns * rows)
        .map(|_| match sampler.below(12) {
            0 => 'w',
            1..=4 => char::from(things[sampler.below(things.len())].as_bytes()[0]),
            _ => ' ',
        })
        .collect();
    let at = sampler.below(cells.len());
    cells[at] = 'A';
    (source, cells.chunks(columns).map(|row| row.iter().collect::<String>() + "\n").collect())
}

fn termination(sampler: &mut Sampler, names: &[String]) -> String {
    let (one, two) = (sampler.choose(names), sampler.choose(names));
    let limit = *sampler.choose(&["", "", " limit=0", " limit=1", " limit=2", " limit=-1", " limit=3"]);
    let win = *sampler.choose(&["True", "False"]);
    let extra = match sampler.below(12) {
        0 => " count_score=True",
        1 => " canEnd=False",
        _ => "",
    };
    match sampler.below(12) {
        0..=4 => format!("        SpriteCounter stype={one}{limit} win={win}{extra}\n"),
        5 => format!("        SpriteCounterMore stype={one}{limit} win={win}{extra}\n"),
        6 => format!("        MultiSpriteCounter stype1={one} stype2={two}{limit} win={win}{extra}\n"),
        7 => format!("        MultiSpriteCounter stype1={one}{limit} min=True win={win}{extra}\n"),
        8 => format!("        MultiSpriteCounterSubTypes stype1={one}{limit} subTypesNum=1 win={win}\n"),
        9 => format!("        StopCounter stype1={one}{limit}\n"),
        _ => format!("        Timeout limit={} win={win}{extra}\n", sampler.between(0, 30)),
    }
}

/// The lines of a game and of its level.
struct Text {
    lines: Vec<String>,
    level: Vec<Vec<char>>,
    names: Vec<String>,
    symbols: Vec<char>,
}

/// Parameters that affect the lifetime, movement and number of sprites.
const PARAMETERS: [&str; 24] = [
    "singleton=True",
    "timeToLive=3",
    "limit=1",
    "limit=0",
    "limit=-1",
    "value=-1",
    "total=1",
    "prob=0",
    "speed=0",
    "speed=2",
    "speed=0.3",
    "cooldown=2",
    "stationary=True",
    "only_active=True",
    "is_static=True",
    "is_oriented=True orientation=UP",
    "hidden=True",
    "invisible=True",
    "physicstype=CONT",
    "wMult=2",
    "hMult=0.5",
    "gravity=1",
    "healthPoints=2",
    "jump_strength=3",
];

impl Text {
    fn of(source: &str, level: &str) -> Text {
        let (description, _) = syntax::parse(source);
        let mut names: Vec<String> =
            description.sprite_lines().iter().map(|(_, line)| line.name.text.clone()).collect();
        names.extend(["wall", "avatar"].map(str::to_owned));
        let mut symbols: Vec<char> = description.mapping.iter().map(|line| line.symbol).collect();
        symbols.extend(['w', ' ', ' ']);
        let lines = syntax::print(&description).lines().map(str::to_owned).collect();
        Text { lines, level: level.lines().map(|row| row.chars().collect()).collect(), names, symbols }
    }

    fn source(&self) -> String {
        self.lines.join("\n") + "\n"
    }

    fn level(&self) -> String {
        self.level.iter().map(|row| row.iter().collect::<String>() + "\n").collect()
    }

    /// Returns the range of a section's lines.
    fn section(&self, name: &str) -> std::ops::Range<usize> {
        let Some(start) = self.lines.iter().position(|line| line.trim() == name) else { return 0..0 };
        let rest = &self.lines[start + 1..];
        let length =
            rest.iter().position(|line| line.trim().ends_with("Set") || line.trim() == "LevelMapping");
        start + 1..start + 1 + length.unwrap_or(rest.len())
    }

    /// Returns the index of a random line in a section.
    fn line(&self, section: &str, sampler: &mut Sampler) -> Option<usize> {
        let lines = self.section(section);
        (!lines.is_empty()).then(|| lines.start + sampler.below(lines.len()))
    }

    /// Inserts a line at a random position in a section.
    fn insert(&mut self, section: &str, line: &str, sampler: &mut Sampler) {
        let lines = self.section(section);
        if lines.start > 0 {
            let at = lines.start + sampler.below(lines.len() + 1);
            self.lines.insert(at, line.trim_end_matches('\n').to_owned());
        }
    }

    fn some(&self, sampler: &mut Sampler) -> String {
        sampler.choose(&self.names).clone()
    }

    /// Applies one random change.
    fn change(&mut self, sampler: &mut Sampler) {
        match sampler.below(20) {
            0 | 1 => {
                let line = generated::interaction(sampler, &self.names);
                self.insert("InteractionSet", &line, sampler);
            }
            2 | 3 => {
                let line = termination(sampler, &self.names);
                self.insert("TerminationSet", &line, sampler);
            }
            4 => {
                let section =
                    *sampler.choose(&["InteractionSet", "TerminationSet", "LevelMapping", "SpriteSet"]);
                self.line(section, sampler).into_iter().for_each(|at| drop(self.lines.remove(at)));
            }
            5 => {
                // Changes the order of lines.
                let section = *sampler.choose(&["InteractionSet", "TerminationSet", "SpriteSet"]);
                if let (Some(one), Some(two)) = (self.line(section, sampler), self.line(section, sampler)) {
                    self.lines.swap(one, two);
                }
            }
            6 => {
                // Swaps the sides of an interaction.
                let Some(at) = self.line("InteractionSet", sampler) else { return };
                let Some((sides, effect)) = self.lines[at].split_once(" > ") else { return };
                let mut sides: Vec<&str> = sides.split_whitespace().collect();
                sides.reverse();
                self.lines[at] = format!("        {} > {effect}", sides.join(" "));
            }
            7 | 8 => {
                // Replaces a name.
                let section =
                    *sampler.choose(&["InteractionSet", "TerminationSet", "LevelMapping", "SpriteSet"]);
                let (Some(at), name) = (self.line(section, sampler), self.some(sampler)) else { return };
                let other = self.some(sampler);
                let words: Vec<String> = self.lines[at]
                    .split(' ')
                    .map(|word| {
                        if word == name {
                            other.clone()
                        } else {
                            word.replace(&format!("={name}"), &format!("={other}"))
                        }
                    })
                    .collect();
                self.lines[at] = words.join(" ");
            }
            9 => {
                let Some(at) = self.line("SpriteSet", sampler) else { return };
                self.lines[at] += &format!(" {}", sampler.choose(&PARAMETERS));
            }
            10 => {
                // Turns the line's type into a parent by adding a child.
                let Some(at) = self.line("SpriteSet", sampler) else { return };
                let indent = self.lines[at].len() - self.lines[at].trim_start().len() + 4;
                let name = format!("kid{}", self.names.len());
                let class = *sampler.choose(&["", "", "speed=0.5", "cooldown=2"]);
                self.lines.insert(at + 1, format!("{}{name} > {class}", " ".repeat(indent)));
                self.names.push(name);
            }
            11 => {
                // Adds a different form of the avatar.
                let name = format!("form{}", self.names.len());
                let avatars: Vec<&SpriteClass> =
                    SpriteClass::ALL.iter().filter(|class| class.is_avatar()).collect();
                let class =
                    if sampler.ratio(1, 2) { "MovingAvatar" } else { sampler.choose(&avatars).name() };
                self.insert("SpriteSet", &format!("        {name} > {class}"), sampler);
                let avatar = self.names.iter().find(|name| ["hero", "avatar"].contains(&name.as_str()));
                let (avatar, thing) = (avatar.cloned().unwrap_or_default(), self.some(sampler));
                self.names.push(name.clone());
                let line = format!("        {avatar} {thing} > transformTo stype={name}");
                self.insert("InteractionSet", &line, sampler);
            }
            12 => {
                let (name, text) = (format!("new{}", self.names.len()), self.names.clone());
                let line = format!("        {name} > {}", generated::sprite(sampler, &text, false));
                self.insert("SpriteSet", &line, sampler);
                self.insert("LevelMapping", &format!("        * > {name}"), sampler);
                self.names.push(name);
                self.symbols.push('*');
            }
            13 => {
                let Some(at) = self.line("TerminationSet", sampler) else { return };
                self.lines[at] +=
                    *sampler.choose(&[" count_score=True", " canEnd=False", " limit=1", " limit=-1"]);
            }
            14 => {
                // Uses a `GameSpace` that keeps a number or varies it.
                let Some(at) = self.line("TerminationSet", sampler) else { return };
                let Some(limit) = self.lines[at].find("limit=") else { return };
                let end = self.lines[at][limit..].find(' ').map_or(self.lines[at].len(), |end| limit + end);
                self.lines[at].replace_range(limit..end, "limit=LEFT");
                if self.lines[0].starts_with("BasicGame") {
                    self.lines[0] = self.lines[0].replacen("BasicGame", "GameSpace", 1);
                    let values =
                        *sampler.choose(&["values=0:1:3 value=1", "values=0:0:0 value=0", "values=2:1:2"]);
                    self.lines.insert(1, "    ParameterSet".to_owned());
                    self.lines.insert(2, format!("        LEFT > {values}"));
                }
            }
            15 => {
                // Uses a character beyond ASCII.
                let Some(at) = self.line("LevelMapping", sampler) else { return };
                let Some(symbol) = self.lines[at].trim_start().chars().next() else { return };
                self.lines[at] = self.lines[at].replacen(symbol, "ö", 1);
                self.level.iter_mut().flatten().filter(|cell| **cell == symbol).for_each(|cell| *cell = 'ö');
            }
            16 => {
                let (Some(at), name) = (self.line("LevelMapping", sampler), self.some(sampler)) else {
                    return;
                };
                self.lines[at] += &format!(" {name}");
            }
            _ => {
                // Changes cells.
                for _ in 0..sampler.between(1, 4) {
                    let row = sampler.below(self.level.len().max(1));
                    let Some(row) = self.level.get_mut(row).filter(|row| !row.is_empty()) else { return };
                    let at = sampler.below(row.len());
                    row[at] = *sampler.choose(&self.symbols);
                }
            }
        }
    }
}
