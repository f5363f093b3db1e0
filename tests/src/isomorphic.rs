//! Isomorphic games under a different theme, and nearly identical games.

use base::Sampler;
use engine::Description;
use engine::syntax::{InteractionLine, Param, SpriteLine, Word};
use std::collections::BTreeMap;

/// Returns an isomorphic game with different names, characters, colours and order. Inherited and default
/// parameters are written out.
pub fn rethemed(description: &Description, sampler: &mut Sampler) -> Description {
    let mut tree = description.clone();
    rename(&mut tree, sampler);
    redraw(&mut tree.sprites, sampler);
    spell_out(&mut tree, sampler);
    reorder_sprites(&mut tree.sprites, sampler);
    tree.interactions = split(std::mem::take(&mut tree.interactions), sampler);
    sampler.shuffle(&mut tree.interactions);
    sampler.shuffle(&mut tree.terminations);
    other_characters(&mut tree, sampler);
    sampler.shuffle(&mut tree.mapping);
    tree
}

/// Changes all numbers that are sizes, preserving signs and zeros. Returns `None` if there are none.
pub fn renumbered(description: &Description) -> Option<Description> {
    let mut tree = description.clone();
    let mut changed = false;
    let mut change = |param: &mut Param| {
        let text = param.value.text.as_str();
        let other = match (text.parse::<i32>(), text.parse::<f64>()) {
            (Ok(number), _) if number != 0 => (number * 2 + number.signum()).to_string(),
            (Err(_), Ok(number)) if number > 0.0 => format!("{}", number * 0.75),
            _ => return,
        };
        let fixed = ["physicstype", "img", "orientation", "singleton", "subTypesNum"];
        if !fixed.contains(&param.key.text.as_str()) {
            param.value = other.into();
            changed = true;
        }
    };
    walk(&mut tree.sprites, &mut |line| line.params.iter_mut().for_each(&mut change));
    tree.interactions.iter_mut().flat_map(|line| &mut line.params).for_each(&mut change);
    tree.terminations.iter_mut().flat_map(|line| &mut line.params).for_each(&mut change);
    changed.then_some(tree)
}

/// Changes one effect, class or ending. Returns `None` if the randomly chosen item cannot be changed in this
/// way.
pub fn altered(description: &Description, sampler: &mut Sampler) -> Option<Description> {
    let mut tree = description.clone();
    let own = ["scoreChange", "repeat", "applyScore"];
    match sampler.below(4) {
        0 if !tree.interactions.is_empty() => {
            let at = sampler.below(tree.interactions.len());
            let line = &mut tree.interactions[at];
            let effects = ["killSprite", "stepBack", "reverseDirection", "bounceForward", "cloneSprite"];
            let others: Vec<&str> =
                effects.into_iter().filter(|effect| *effect != line.effect.text).collect();
            line.effect = (*sampler.choose(&others)).into();
            line.params.retain(|param| own.contains(&param.key.text.as_str()));
        }
        1 => {
            let mut leaves = Vec::new();
            walk(&mut tree.sprites, &mut |line| {
                if line.children.is_empty() && line.class.is_some() {
                    leaves.push(line.name.text.clone());
                }
            });
            let chosen = leaves.get(sampler.below(leaves.len().max(1)))?.clone();
            let classes = ["Immovable", "Passive", "RandomNPC", "Missile", "Flicker"];
            let to = *sampler.choose(&classes);
            walk(&mut tree.sprites, &mut |line| {
                if line.name.text == chosen {
                    line.class = Some(to.into());
                    line.params.clear();
                }
            });
        }
        2 if !tree.terminations.is_empty() => {
            let at = sampler.below(tree.terminations.len());
            let line = tree.terminations.get_mut(at)?;
            let win = line.params.iter_mut().find(|param| param.key.text == "win")?;
            let other = if win.value.text.eq_ignore_ascii_case("true") { "False" } else { "True" };
            win.value = other.into();
        }
        _ if !tree.interactions.is_empty() => {
            tree.interactions.remove(sampler.below(tree.interactions.len()));
        }
        _ => return None,
    }
    Some(tree)
}

fn walk(lines: &mut [SpriteLine], visit: &mut impl FnMut(&mut SpriteLine)) {
    for line in lines {
        visit(line);
        walk(&mut line.children, visit);
    }
}

fn rename(tree: &mut Description, sampler: &mut Sampler) {
    // The types that `w` and `A` place by default keep their names.
    let mapped = |symbol: char| tree.mapping.iter().any(|line| line.symbol == symbol);
    let kept = |name: &str| (name == "wall" && !mapped('w')) || (name == "avatar" && !mapped('A'));
    let mut numbers: Vec<usize> = (0..tree.sprite_lines().len()).collect();
    sampler.shuffle(&mut numbers);
    let lines = tree.sprite_lines();
    let names: BTreeMap<String, String> = lines
        .iter()
        .zip(numbers)
        .filter(|((_, line), _)| !kept(&line.name.text))
        .map(|((_, line), number)| (line.name.text.clone(), format!("kind{number}")))
        .collect();
    let other = |word: &mut Word| {
        let parts = word.text.split(',').map(|part| names.get(part).map_or(part, String::as_str));
        word.text = parts.collect::<Vec<_>>().join(",");
    };
    walk(&mut tree.sprites, &mut |line| {
        other(&mut line.name);
        line.params.iter_mut().for_each(|param| other(&mut param.value));
    });
    tree.header.params.iter_mut().for_each(|param| other(&mut param.value));
    tree.mapping.iter_mut().flat_map(|line| &mut line.names).for_each(other);
    for line in &mut tree.interactions {
        other(&mut line.first);
        line.second.iter_mut().for_each(other);
        line.params.iter_mut().for_each(|param| other(&mut param.value));
    }
    tree.terminations.iter_mut().flat_map(|line| &mut line.params).for_each(|param| other(&mut param.value));
}

fn redraw(lines: &mut [SpriteLine], sampler: &mut Sampler) {
    walk(lines, &mut |line| {
        let pictures = ["color", "img", "autotiling", "randomtiling"];
        line.params.retain(|param| !pictures.contains(&param.key.text.as_str()));
        if sampler.ratio(1, 2) {
            line.params.push(Param::new("color", *sampler.choose(&["RED", "PINK", "BLUE"])));
        }
    });
}

fn spell_out(tree: &mut Description, sampler: &mut Sampler) {
    fn pass_on(line: &mut SpriteLine, sampler: &mut Sampler) {
        for child in &mut line.children {
            for param in &line.params {
                let own = child.params.iter().any(|other| other.key.text == param.key.text);
                if !own && param.key.text != "singleton" && sampler.ratio(1, 2) {
                    child.params.push(param.clone());
                }
            }
            pass_on(child, sampler);
        }
    }
    tree.sprites.iter_mut().for_each(|line| pass_on(line, sampler));
    for line in &mut tree.interactions {
        if !line.params.iter().any(|param| param.key.text == "scoreChange") && sampler.ratio(1, 2) {
            line.params.push(Param::new("scoreChange", 0));
        }
        sampler.shuffle(&mut line.params);
    }
    for line in tree.sprites.iter_mut().filter(|line| line.children.is_empty()) {
        let has = |key: &str| line.params.iter().any(|param| param.key.text == key);
        if !has("mass") && sampler.ratio(1, 2) {
            line.params.push(Param::new("mass", 1));
        }
    }
}

fn reorder_sprites(lines: &mut [SpriteLine], sampler: &mut Sampler) {
    sampler.shuffle(lines);
    lines.iter_mut().for_each(|line| reorder_sprites(&mut line.children, sampler));
}

/// Reorders partners, and sometimes moves them to lines of their own.
fn split(lines: Vec<InteractionLine>, sampler: &mut Sampler) -> Vec<InteractionLine> {
    let mut all = Vec::new();
    for mut line in lines {
        // The clock accepts only the first partner.
        let by_clock = line.second.iter().chain([&line.first]).any(|word| word.text == "TIME");
        if !by_clock {
            sampler.shuffle(&mut line.second);
        }
        if !by_clock && line.second.len() > 1 && sampler.ratio(1, 2) {
            let rest = line.second.split_off(1);
            all.push(InteractionLine { second: rest, ..line.clone() });
        }
        all.push(line);
    }
    all
}

fn other_characters(tree: &mut Description, sampler: &mut Sampler) {
    let mut free: Vec<char> = ('!'..='~').filter(|c| !['w', 'A', '#', '<', '>'].contains(c)).collect();
    sampler.shuffle(&mut free);
    for (line, other) in tree.mapping.iter_mut().zip(free) {
        sampler.shuffle(&mut line.names);
        if !['w', 'A'].contains(&line.symbol) {
            line.symbol = other;
        }
    }
}
