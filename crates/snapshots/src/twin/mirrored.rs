//! The mirrored twin of a game, in which the board and every direction in the rules are reflected left to right.
//!
//! A game without a mirror image is rejected with a reason. Possible reasons are sprites whose class prefers a side,
//! sprites that are not one cell wide, and an outcome that depends on the order in which the sprites in a row are
//! processed. In games without randomness, the last reason is detected by playing both worlds side by side.

use super::{Made, Original, Twin, TwinError, TwinGame, replayed};
use agents::{PortfolioConfig, Solution, solve};
use base::Seed;
use engine::analysis::Analysis;
use engine::syntax::{Param, SpriteLine, Word};
use engine::{
    Action, Description, Direction, Episode, Game, Level, Observation, Outcome, SpriteClass, SpriteType,
};
use std::collections::{BTreeMap, BTreeSet};

/// The number of ticks in a random episode during which the two worlds must agree.
const TICKS: usize = 150;
/// The number of random episodes on each level.
const PLAYS: u64 = 2;
/// The number of seeds with which a witness's mirrored actions are tried in a stochastic game.
const CHANCES: u64 = 16;
/// The budget for finding a new witness in a stochastic game, in forward-model calls.
const CALLS: u64 = 50_000;

/// The words that are swapped in the names of types that face a side.
const SIDES: [(&str, &str); 2] = [("left", "right"), ("west", "east")];

pub(super) fn twin(original: &Original<'_>) -> Result<TwinGame, TwinError> {
    let refused = TwinError::Unmirrorable;
    let analysis = Analysis::of(&original.game);
    refuse(&analysis).map_err(refused)?;
    let names = swapped_names(&original.game);
    let rules = rules(&original.game, &names).map_err(refused)?;
    let levels = original.levels.iter().map(|level| reflected(level)).collect();
    let mut made = Made::of(original, &rules, levels, mirrored)?;
    let worlds = Worlds { one: &original.game, two: &made.game, names: &names };
    let twin_analysis = Analysis::of(&made.game);
    for number in 0..original.levels.len() {
        let load = |game: &Game, text: &str| {
            game.level(text).map_err(|problems| TwinError::Level { number, problems })
        };
        let one = load(&original.game, &original.levels[number])?;
        let two = load(&made.game, &made.twin.levels[number])?;
        let seed = original.seed(Twin::Mirrored).child("level", number as u64);
        let known = original.witnesses[number];
        if !analysis.is_stochastic() {
            let mut plays: Vec<Vec<Action>> =
                known.map(|episode| episode.actions.clone()).into_iter().collect();
            plays.extend((0..PLAYS).map(|play| random_actions(seed.child("play", play))));
            for actions in &plays {
                worlds.agree(&one, &two, seed, actions).map_err(|tick| {
                    refused(format!(
                        "in level {number}, after tick {tick}, the two worlds differ: the order in which sprites of \
                         a row are processed matters"
                    ))
                })?;
            }
        } else if let (Some(known), None) = (known, &made.twin.witnesses[number]) {
            made.twin.witnesses[number] = another(&twin_analysis, &two, known, seed);
        }
    }
    let title = original.title().unwrap_or_else(|| made.plain_title());
    made.twin.title = title;
    Ok(made.headed(original))
}

/// Reflects a level by reversing the characters of each row.
fn reflected(level: &str) -> String {
    level.lines().map(|row| row.chars().rev().chain(['\n']).collect::<String>()).collect()
}

fn mirrored(action: Action) -> Action {
    match action {
        Action::Left => Action::Right,
        Action::Right => Action::Left,
        other => other,
    }
}

fn mirrored_direction(direction: Direction) -> Direction {
    match direction {
        Direction::LEFT => Direction::RIGHT,
        Direction::RIGHT => Direction::LEFT,
        other => other,
    }
}

/// Returns the constant for the opposite side, in the same spelling; `None` if there is no such constant.
fn mirrored_constant(text: &str) -> Option<&'static str> {
    match text {
        "LEFT" => Some("RIGHT"),
        "RIGHT" => Some("LEFT"),
        "DLEFT" => Some("DRIGHT"),
        "DRIGHT" => Some("DLEFT"),
        _ => None,
    }
}

/// Rejects games with sprites that prefer a side and cannot be turned around.
fn refuse(analysis: &Analysis) -> Result<(), String> {
    use SpriteClass as C;
    let game = analysis.game();
    if !game.description().parameters.is_empty() {
        return Err(
            "the rules have parameters (a GameSpace): replace the parameters with their values".to_owned()
        );
    }
    for stype in game.sprite_types().filter(|&stype| analysis.facts(stype).possible) {
        let Some(class) = game.class(stype) else { continue };
        let why = match class {
            C::PathChaser | C::PathAltChaser | C::RandomPathAltChaser => {
                "chooses among paths of equal length by a fixed order of directions"
            }
            C::BirdAvatar => "drifts to the right",
            C::ShootOnlyAvatar => "fires a different shot for each arrow key",
            C::AimedAvatar | C::SpaceshipAvatar | C::CarAvatar | C::LanderAvatar => "turns by angles",
            C::WizardAvatar => "faces right",
            _ => continue,
        };
        return Err(format!("`{}` ({}) {why}", game.name(stype), class.name()));
    }
    for (_, line) in game.description().sprite_lines() {
        if line.params.iter().any(|param| param.key.text == "wMult" && param.value.text.parse() != Ok(1.0)) {
            return Err(format!("`{}` is not one cell wide", line.name.text));
        }
    }
    Ok(())
}

/// Returns the new names of types that face a side and are named after it. For example, `westvane` and `eastvane` are
/// swapped.
fn swapped_names(game: &Game) -> BTreeMap<String, String> {
    let names: BTreeSet<&str> = game.sprite_types().map(|stype| game.name(stype)).collect();
    let swap = |stype: SpriteType| {
        let facing = game.orientation(stype);
        let name = game.name(stype);
        let other = other_side(name)?;
        (facing == Direction::LEFT || facing == Direction::RIGHT).then(|| (name.to_owned(), other))
    };
    let mut swaps: BTreeMap<String, String> = game.sprite_types().filter_map(swap).collect();
    // No two types may get the same name.
    let taken = |swaps: &BTreeMap<String, String>| -> Vec<String> {
        let clash = |(_, new): &(&String, &String)| names.contains(new.as_str()) && !swaps.contains_key(*new);
        swaps.iter().filter(clash).map(|(old, _)| old.clone()).collect()
    };
    loop {
        let clashes = taken(&swaps);
        if clashes.is_empty() {
            return swaps;
        }
        clashes.iter().for_each(|name| drop(swaps.remove(name)));
    }
}

/// Returns the name with its side swapped, if the name begins or ends with a side.
fn other_side(name: &str) -> Option<String> {
    let pairs = SIDES.into_iter().flat_map(|(one, two)| [(one, two), (two, one)]);
    for (from, to) in pairs {
        let capitals = |word: &str| format!("{}{}", word[..1].to_uppercase(), &word[1..]);
        for (from, to) in [(from.to_owned(), to.to_owned()), (capitals(from), capitals(to))] {
            if let Some(rest) = name.strip_prefix(&from) {
                return Some(format!("{to}{rest}"));
            }
            if let Some(rest) = name.strip_suffix(&from) {
                return Some(format!("{rest}{to}"));
            }
        }
    }
    None
}

/// Returns the rules with every direction mirrored.
fn rules(game: &Game, names: &BTreeMap<String, String>) -> Result<Description, String> {
    let mut rules = game.description().renamed(names);
    sprites(&mut rules.sprites);
    for line in &mut rules.interactions {
        let planned = line.params.iter_mut().filter(|param| param.key.text == "ftype");
        let keywords = std::iter::once(&mut line.effect).chain(planned.map(|param| &mut param.value));
        for keyword in keywords {
            keyword.text = match keyword.text.as_str() {
                "spawnLeft" => "spawnRight".to_owned(),
                "spawnRight" => "spawnLeft".to_owned(),
                other => other.to_owned(),
            };
        }
    }
    // Types that face a side because of their class or by inheritance must be given the opposite orientation
    // explicitly.
    for stype in misdirected(game, &rules)? {
        let facing = match mirrored_direction(game.orientation(stype)) {
            Direction::UP => "UP",
            Direction::DOWN => "DOWN",
            Direction::LEFT => "LEFT",
            Direction::RIGHT => "RIGHT",
            _ => "NONE",
        };
        let name = game.name(stype);
        let name = names.get(name).map_or(name, String::as_str);
        if let Some(line) = line_of(&mut rules.sprites, name) {
            line.params.push(Param::new("orientation", facing));
        }
    }
    match misdirected(game, &rules)?.first() {
        Some(&stype) => Err(format!("the orientation of `{}` cannot be changed", game.name(stype))),
        None => Ok(rules),
    }
}

fn sprites(lines: &mut [SpriteLine]) {
    let mirror = |word: &mut Word| {
        if let Some(other) = mirrored_constant(&word.text) {
            word.text = other.to_owned();
        }
    };
    for line in lines {
        let directed = ["orientation", "spawnorientation"];
        let params = line.params.iter_mut().filter(|param| directed.contains(&param.key.text.as_str()));
        params.for_each(|param| mirror(&mut param.value));
        sprites(&mut line.children);
    }
}

/// Returns the types that do not face the mirrored direction. Both games declare their types in the same order.
fn misdirected(game: &Game, rules: &Description) -> Result<Vec<SpriteType>, String> {
    let twin = Game::compile(rules).map_err(|problems| format!("the game does not compile: {problems}"))?;
    let wrong = |stype: &SpriteType| {
        game.class(*stype).is_some()
            && mirrored_direction(game.orientation(*stype)) != twin.orientation(*stype)
    };
    Ok(game.sprite_types().filter(wrong).collect())
}

fn line_of<'a>(lines: &'a mut [SpriteLine], name: &str) -> Option<&'a mut SpriteLine> {
    for line in lines {
        if line.name.text == name {
            return Some(line);
        }
        if let Some(found) = line_of(&mut line.children, name) {
            return Some(found);
        }
    }
    None
}

fn random_actions(seed: Seed) -> Vec<Action> {
    let mut sampler = seed.sampler();
    (0..TICKS).map(|_| *sampler.choose(&Action::ALL)).collect()
}

/// A game and its mirror image.
struct Worlds<'a> {
    one: &'a Game,
    two: &'a Game,
    names: &'a BTreeMap<String, String>,
}

impl Worlds<'_> {
    /// Plays actions in one world and the mirrored actions in the other, and compares the observations.
    ///
    /// # Errors
    /// Returns the number of the first tick, from 0, after which the two worlds differ.
    fn agree(&self, one: &Level, two: &Level, seed: Seed, actions: &[Action]) -> Result<(), usize> {
        let (mut left, mut right) = (self.one.start(one, seed), self.two.start(two, seed));
        for (tick, &action) in actions.iter().enumerate() {
            let allowed = self.one.actions(&left);
            let action = if allowed.contains(&action) { action } else { Action::Nil };
            let outcomes = (self.one.step(&mut left, action), self.two.step(&mut right, mirrored(action)));
            let seen = (self.one.observe(&left), self.two.observe(&right));
            if outcomes.0 != outcomes.1 || !self.is_image(&seen.0, &seen.1) {
                return Err(tick);
            }
            if outcomes.0 != Outcome::Ongoing {
                break;
            }
        }
        Ok(())
    }

    fn is_image(&self, one: &Observation, two: &Observation) -> bool {
        let rows = one.cells.chunks(one.columns).zip(two.cells.chunks(two.columns));
        let named = |name: &String| self.names.get(name).unwrap_or(name).clone();
        let same =
            |(cell, other): (&Vec<String>, &Vec<String>)| cell.iter().map(named).eq(other.iter().cloned());
        let cells = rows.into_iter().all(|(row, other)| row.iter().zip(other.iter().rev()).all(same));
        cells && one.score == two.score && one.resources.len() == two.resources.len()
    }
}

/// Searches for a winning episode on a level of a stochastic game. Tries the original's actions with other seeds
/// first, and then searches with a small budget.
fn another(analysis: &Analysis, level: &Level, known: &Episode, seed: Seed) -> Option<Episode> {
    let game = analysis.game();
    for chance in 0..CHANCES {
        let episode = replayed(game, level, seed.child("chance", chance), &known.actions, mirrored);
        if episode.is_some() {
            return episode;
        }
    }
    let config = PortfolioConfig { budget: CALLS, shortest: 0.0, ..PortfolioConfig::default() };
    match solve(analysis, level, &config, seed.child("search", 0)).solution {
        Solution::Won { episode, .. } => Some(*episode),
        Solution::Impossible { .. } | Solution::Unknown => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::of_game;
    use super::*;

    /// Mirrors a one-level game with the given sprites and rules.
    fn mirror(sprites: &str, rules: &str, level: &str) -> Result<TwinGame, TwinError> {
        let source = format!(
            "BasicGame\n  SpriteSet\n    gate > Door\n{sprites}  LevelMapping\n    g > gate\n    b > boat\n    \
             A > rower\n  InteractionSet\n    gate rower > killSprite\n{rules}  TerminationSet\n    SpriteCounter \
             stype=gate win=True\n    Timeout limit=60\n"
        );
        of_game(Twin::Mirrored, &source, &[level.to_owned()], &[])
    }

    #[track_caller]
    fn check(sprites: &str, rules: &str, expect: &[&str]) {
        let twin = mirror(sprites, rules, "A b g\n").unwrap();
        assert_eq!(twin.levels, ["g b A\n"]);
        for line in expect {
            assert!(twin.text.lines().any(|own| own.trim() == *line), "{line}\n{}", twin.text);
        }
    }

    #[test]
    fn directions_change_sides() {
        check(
            "    boat > Missile orientation=LEFT\n    rower > MovingAvatar\n",
            "    rower boat > spawnLeft stype=gate\n    boat EOS > addTimer timer=3 ftype=spawnRight stype=gate\n",
            &[
                "boat > Missile orientation=RIGHT",
                "rower boat > spawnRight stype=gate",
                "boat EOS > addTimer timer=3 ftype=spawnLeft stype=gate",
            ],
        );
    }

    #[test]
    fn default_orientations_are_mirrored_explicitly() {
        check(
            "    boat > Bomber stype=gate cooldown=50\n    rower > ShootAvatar stype=gate\n",
            "",
            &[
                "boat > Bomber stype=gate cooldown=50 orientation=LEFT",
                "rower > ShootAvatar stype=gate orientation=LEFT",
            ],
        );
        // Types that inherit a different direction are unaffected.
        check(
            "    hull > Missile orientation=UP\n      boat > speed=0.5\n      raft > orientation=DLEFT\n    rower > \
             MovingAvatar\n",
            "",
            &["hull > Missile orientation=UP", "boat > speed=0.5", "raft > orientation=DRIGHT"],
        );
    }

    #[test]
    fn names_with_a_side_are_swapped() {
        check(
            "    boat > Missile\n      westBoat > orientation=LEFT\n      eastBoat > orientation=RIGHT\n    eastern > \
             Immovable\n    rower > MovingAvatar\n",
            "    westBoat EOS > reverseDirection\n",
            &[
                "eastBoat > orientation=RIGHT",
                "westBoat > orientation=LEFT",
                "eastern > Immovable",
                "eastBoat EOS > reverseDirection",
            ],
        );
        assert_eq!(other_side("leftGate").as_deref(), Some("rightGate"));
        assert_eq!(other_side("gateRight").as_deref(), Some("gateLeft"));
        assert_eq!(other_side("feasts"), None);
    }

    #[track_caller]
    fn refuses(sprites: &str, rules: &str, level: &str, why: &str) {
        let problem = mirror(sprites, rules, level).unwrap_err().to_string();
        assert_eq!(problem, format!("the game cannot be mirrored: {why}"));
    }

    #[test]
    fn games_without_a_mirror_image_are_refused() {
        let rower = "    rower > MovingAvatar\n";
        let boat = |text: &str| format!("    boat > {text}\n{rower}");
        refuses(&boat("Immovable wMult=2"), "", "A b g\n", "`boat` is not one cell wide");
        refuses(
            "    boat > Immovable\n    rower > BirdAvatar\n",
            "",
            "A b g\n",
            "`rower` (BirdAvatar) drifts to the right",
        );
        refuses(
            &boat("PathChaser stype=rower"),
            "",
            "A b g\n",
            "`boat` (PathChaser) chooses among paths of equal length by a fixed order of directions",
        );
    }

    /// Only one raft can exist, and it is spawned by the first boat in the row. In the mirror image, the other boat
    /// is first.
    #[test]
    fn games_that_depend_on_the_order_in_a_row_are_refused() {
        let sprites = "    boat > SpawnPoint stype=raft cooldown=3\n    raft > Immovable singleton=True\n    rower > MovingAvatar\n";
        let problem = mirror(sprites, "", "Ab b g\n").unwrap_err().to_string();
        assert!(problem.starts_with("the game cannot be mirrored: in level 0, after tick "), "{problem}");
        assert!(mirror(sprites, "", "Ab g\n").is_ok());
    }
}
