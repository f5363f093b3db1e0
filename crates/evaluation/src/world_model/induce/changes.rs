//! The changes to a guess that a deviation suggests.

use super::clues::Clues;
use super::guess::{Guess, Rule};
use crate::world_model::task::Words;
use engine::{Outcome, ParameterKind, SpriteClass, effect_parameters};
use itertools::Itertools;

/// The directions that sprites can face.
const DIRECTIONS: [&str; 4] = ["UP", "DOWN", "LEFT", "RIGHT"];
/// The cooldowns to try, in ticks.
const COOLDOWNS: [u32; 8] = [2, 3, 4, 5, 6, 8, 10, 12];
/// The lifetimes of flickers to try, in ticks.
const LIFETIMES: [u32; 12] = [1, 2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 20];

/// The effects that many games use. They are preferred among equally good effects.
const COMMON: [&str; 6] =
    ["killSprite", "stepBack", "killBoth", "collectResource", "bounceForward", "transformTo"];

/// Returns the changed guesses, most plausible first.
pub(super) fn changes(
    guess: &Guess,
    words: &Words,
    clues: &Clues,
    is_avatar: &dyn Fn(&str) -> bool,
) -> Vec<Guess> {
    let mut changed = ends(guess, words, clues, &clues.absent);
    changed.extend(rules(guess, words, clues));
    // A rule that removes the last sprite of a type and a termination that counts the type take effect in the same
    // step.
    for ended in ends(guess, words, clues, &clues.vanishing) {
        changed.extend(rules(&ended, words, clues));
    }
    changed.extend(classes(guess, words, clues, is_avatar));
    changed.extend(removals(guess, clues));
    changed
}

fn removals(guess: &Guess, clues: &Clues) -> Vec<Guess> {
    let is_near = |rule: &Rule| clues.nearby.contains(&rule.first) || clues.nearby.contains(&rule.second);
    let rules = (0..guess.rules.len()).filter(|&at| is_near(&guess.rules[at])).map(|at| {
        let mut changed = guess.clone();
        changed.rules.remove(at);
        changed
    });
    let ends = (0..guess.ends.len()).filter(|_| clues.outcome.is_some()).map(|at| {
        let mut changed = guess.clone();
        changed.ends.remove(at);
        changed
    });
    rules.chain(ends).collect()
}

/// Returns guesses with an added termination that counts sprites of the given types. These types have no sprites after
/// the step.
fn ends(guess: &Guess, words: &Words, clues: &Clues, absent: &[String]) -> Vec<Guess> {
    let win = match clues.outcome {
        Some(Outcome::Won) => "True",
        Some(Outcome::Lost) => "False",
        _ => return Vec::new(),
    };
    let single = absent.iter().map(|name| format!("SpriteCounter stype={name} limit=0 win={win}"));
    let pairs = absent.iter().tuple_combinations();
    let pairs =
        pairs.map(|(one, two)| format!("MultiSpriteCounter stype1={one} stype2={two} limit=0 win={win}"));
    let lines = single
        .chain(pairs)
        .filter(|line| line.split(' ').next().is_some_and(|class| words.terminations.contains(class)));
    let with = |line: String| {
        let mut changed = guess.clone();
        changed.ends.push(line);
        changed
    };
    lines.map(with).collect()
}

/// Returns guesses with an added rule for a pair of types near the deviation, with or without the pair's other rules.
fn rules(guess: &Guess, words: &Words, clues: &Clues) -> Vec<Guess> {
    let partners = clues.nearby.iter().map(String::as_str).chain(["EOS"]);
    let pairs = clues.nearby.iter().cartesian_product(partners);
    let pairs: Vec<_> = pairs
        .filter(|(first, second)| {
            clues.suspects.contains(first) || clues.suspects.iter().any(|suspect| suspect == second)
        })
        .collect();
    let effects: Vec<String> = words
        .effects
        .iter()
        .sorted_by_key(|effect| COMMON.iter().position(|common| common == effect).unwrap_or(COMMON.len()))
        .flat_map(|effect| effects(effect, clues))
        .collect();
    let mut changed = Vec::new();
    for (effect, (first, second)) in effects.iter().cartesian_product(&pairs) {
        let rule = Rule { first: (*first).clone(), second: (*second).to_owned(), effect: effect.clone() };
        let is_same = |other: &&Rule| (&other.first, &other.second) == (&rule.first, &rule.second);
        let mut with = guess.clone();
        with.rules.push(rule.clone());
        if let Some(at) = guess.rules.iter().position(|other| is_same(&other)) {
            // After a rule that moves the first sprite away, later rules for the pair do not run.
            let mut before = guess.clone();
            before.rules.insert(at, rule.clone());
            changed.push(before);
            let mut instead = guess.clone();
            instead.rules.retain(|other| !is_same(&other));
            instead.rules.push(rule.clone());
            changed.push(instead);
        }
        changed.push(with);
    }
    changed
}

/// Returns the forms of an effect to try, each with different parameters.
fn effects(keyword: &str, clues: &Clues) -> Vec<String> {
    let mut forms = vec![keyword.to_owned()];
    for (key, kind) in effect_parameters(keyword) {
        forms = forms
            .iter()
            .cartesian_product(values(key, kind, clues))
            .map(|(form, value)| form.clone() + &value)
            .collect();
    }
    if clues.score != 0.0 {
        let scored = forms.iter().map(|form| format!("{form} scoreChange={}", clues.score));
        forms = scored.chain(forms.iter().cloned()).collect();
    }
    forms
}

/// Returns the values to try for a parameter, as text to append. An empty text stands for the default.
fn values(key: &str, kind: ParameterKind, clues: &Clues) -> Vec<String> {
    let given = |value: &dyn std::fmt::Display| format!(" {key}={value}");
    let default = || vec![String::new()];
    match (kind, key) {
        (ParameterKind::Sprite, _) => {
            clues.nearby.iter().chain(&clues.absent).unique().map(|name| given(name)).collect()
        }
        (ParameterKind::Flag, "killSecond" | "subtract") => vec![String::new(), given(&"True")],
        (ParameterKind::Int, "value") => {
            let amounts = clues.amounts.iter().map(|amount| given(&amount.abs()));
            default().into_iter().chain(amounts).unique().collect()
        }
        (ParameterKind::Int, "limit") => vec![String::new(), given(&1), given(&2), given(&3)],
        _ => default(),
    }
}

/// Returns guesses in which a suspicious type has a different class or position in the SpriteSet.
fn classes(guess: &Guess, words: &Words, clues: &Clues, is_avatar: &dyn Fn(&str) -> bool) -> Vec<Guess> {
    let mut changed = Vec::new();
    for (at, (name, old)) in guess.types.iter().enumerate() {
        // A sprite may appear too early because of the sprite that creates it.
        let makes = |suspect: &String| old.split(['=', ' ']).any(|word| word == suspect);
        let may_make = !clues.appearing.is_empty() && clues.nearby.contains(name);
        let is_suspect = clues.suspects.contains(name) || clues.suspects.iter().any(makes);
        if !is_suspect && !may_make && !is_avatar(name) {
            continue;
        }
        for end in [0, guess.types.len() - 1].into_iter().filter(|&end| end != at) {
            let mut moved = guess.clone();
            let line = moved.types.remove(at);
            moved.types.insert(end, line);
            changed.push(moved);
        }
        let kept: String = old
            .split(' ')
            .filter(|word| word.starts_with("healthPoints"))
            .map(|word| format!(" {word}"))
            .collect();
        for class in words.classes.iter().filter(|class| class.ends_with("Avatar") == is_avatar(name)) {
            for parameters in parameters(class, guess, clues) {
                let class = format!("{class}{parameters}{kept}");
                if class != *old {
                    let mut with = guess.clone();
                    with.types[at].1 = class;
                    changed.extend(moving(&with, &with.types[at].1, clues));
                    changed.push(with);
                }
            }
        }
    }
    changed
}

/// Returns guesses in which the sprites that a producer creates move immediately. A sprite can move in the step in
/// which it appears, so changing only its producer would not help.
fn moving(guess: &Guess, maker: &str, clues: &Clues) -> Vec<Guess> {
    let is_producer = ["SpawnPoint", "Bomber"].iter().any(|class| maker.starts_with(class));
    let is_made = |name: &str| maker.split(['=', ' ']).any(|word| word == name);
    let made = guess.types.iter().position(|(name, _)| clues.appearing.contains(name) && is_made(name));
    let Some(at) = made.filter(|_| is_producer && !maker.contains("cooldown")) else { return Vec::new() };
    let moved = DIRECTIONS.iter().map(|way| {
        let mut moved = guess.clone();
        let (name, _) = moved.types.remove(at);
        moved.types.insert(0, (name, format!("Missile orientation={way}")));
        moved
    });
    moved.collect()
}

/// Returns the parameters to try for a class, as texts to append.
fn parameters(class: &str, guess: &Guess, clues: &Clues) -> Vec<String> {
    let cooldowns =
        || std::iter::once(String::new()).chain(COOLDOWNS.iter().map(|ticks| format!(" cooldown={ticks}")));
    let types = || guess.types.iter().map(|line| line.0.clone()).collect_vec();
    let made = || if clues.appearing.is_empty() { types() } else { clues.appearing.clone() };
    let of_type =
        |key: &str, names: &[String]| names.iter().map(|name| format!(" {key}={name}")).collect_vec();
    let all = types();
    let found = SpriteClass::ALL.iter().find(|known| known.name() == class);
    let own = found.map_or(&[][..], |class| class.own_parameters());
    let joined = |one: Vec<String>, two: Vec<String>| {
        one.iter().cartesian_product(&two).map(|(one, two)| format!("{one}{two}")).collect_vec()
    };
    let directions = || DIRECTIONS.iter().map(|way| format!(" orientation={way}")).collect_vec();
    match class {
        "Missile" => joined(directions(), cooldowns().collect()),
        "Flicker" | "OrientedFlicker" => LIFETIMES.iter().map(|ticks| format!(" limit={ticks}")).collect(),
        "Chaser" | "Fleeing" | "PathChaser" | "LOSChaser" => {
            joined(of_type("stype", &all), cooldowns().collect())
        }
        "SpawnPoint" => joined(of_type("stype", &made()), cooldowns().collect()),
        "Bomber" => {
            let bombs = joined(of_type("stype", &made()), cooldowns().collect());
            joined(bombs, directions())
        }
        "Portal" => of_type("stype", &all),
        "OngoingTurningAvatar" => of_type("spawnBehind", &all),
        _ if class.ends_with("Avatar") && own.contains(&"stype") || class.contains("ShootAvatar") => {
            let ammo = [String::new()].into_iter().chain(of_type("ammo", &all)).collect();
            joined(
                joined(of_type("stype", &made()), ammo),
                vec![String::new(), " rotateInPlace=False".to_owned()],
            )
        }
        _ => vec![String::new()],
    }
}
