//! From merged ports to rules: the clauses of the mechanics under the names of types, and what follows from bodies.

use super::genome::Invention;
use super::mechanic::{Body, Mechanic, Origin, OwnType, Port, Tag};
use super::merge::{Merged, PortId};
use crate::GenerateError;
use crate::games::english;
use engine::syntax::{self, InteractionLine, MappingLine, Param, SpriteLine, TerminationLine, Word};
use engine::{Description, Diagnostic, Game};
use std::collections::{BTreeMap, BTreeSet};

/// The rules of an invention, under internal names.
pub(super) struct Written {
    pub(super) description: Description,
    /// The mechanic of each interaction, by its index; `None` for what follows from bodies.
    pub(super) owners: Vec<Option<usize>>,
}

impl Written {
    /// Leaves out of a rule that follows from bodies what the compiler warns about; returns `false` if the rule is of a mechanic.
    pub(super) fn leave_out(
        &mut self,
        dressed: &mut Description,
        rules: &Game,
        warning: &Diagnostic,
    ) -> bool {
        let lines = rules.description().interactions.iter();
        let place = lines.enumerate().rfind(|(_, line)| line.first.span.start <= warning.span.start);
        let Some((at, line)) = place else { return false };
        let is_named =
            |word: &&Word| word.span == warning.span || warning.message.contains(&format!("`{}`", word.text));
        let idle = line.second.iter().position(|word| is_named(&word)).filter(|_| self.owners[at].is_none());
        let Some(idle) = idle.filter(|_| at < dressed.interactions.len()) else { return false };
        for lines in [&mut dressed.interactions, &mut self.description.interactions] {
            lines[at].second.remove(idle);
            if lines[at].second.is_empty() {
                lines.remove(at);
            }
        }
        if line.second.len() == 1 {
            self.owners.remove(at);
        }
        true
    }
}

/// The internal name of a type that fills ports.
pub(super) fn name(class: usize) -> String {
    format!("type{class}")
}

/// The internal name of a mechanic's own type.
pub(super) fn own_name(mechanic: usize, own: &str) -> String {
    format!("own{mechanic}{}", english::capital(own))
}

/// The internal name of what is left of a goal that was lost.
pub(super) fn lost_name(class: usize) -> String {
    format!("lost{class}")
}

/// The clauses of one mechanic under internal names.
struct Clauses {
    sprites: Vec<SpriteLine>,
    before: Vec<InteractionLine>,
    rules: Vec<InteractionLine>,
    hero: Option<SpriteLine>,
    terminations: Vec<TerminationLine>,
}

/// The effects that take the first sprite away whenever the two meet.
const REMOVING: [&str; 3] = ["killSprite", "transformTo", "killBoth"];

/// Writes the rules.
///
/// # Errors
/// Two mechanics give one type a class.
pub(super) fn write(invention: &Invention, types: &[Merged]) -> Result<Written, GenerateError> {
    let mut clauses: Vec<Clauses> =
        (0..invention.mechanics.len()).map(|at| clauses(invention, types, at)).collect::<Result<_, _>>()?;
    extend_to_states(invention, types, &mut clauses);
    let losses = lose_with_goals(invention, types, &mut clauses);
    let mut bodies = Bodies::of(invention, types);
    let mut description = syntax::parse("BasicGame\n").0;
    description.has = [true; 4];
    description.sprites = sprites(types, &bodies, &mut clauses)?;
    description.sprites.extend(losses.iter().map(|class| sprite(&lost_name(*class), "Immovable")));
    move_hero_last(&mut description.sprites);
    bodies.marching = of_class(&description.sprites, "Missile");
    bodies.still = of_class(&description.sprites, "Immovable");
    description.mapping = mapping(types, &description.sprites);
    let mut before: Vec<InteractionLine> =
        clauses.iter().flat_map(|own| own.before.iter().cloned()).collect();
    let mut rules: Vec<InteractionLine> = clauses.iter().flat_map(|own| own.rules.iter().cloned()).collect();
    let items: BTreeSet<&str> = bodies.with(Body::Item).collect();
    before.iter_mut().chain(&mut rules).for_each(|line| collect_instead(line, &items));
    let all: Vec<InteractionLine> = before.iter().chain(&rules).cloned().collect();
    if is_contradictory(&bodies, types, &all) {
        return Err(GenerateError::Unlucky("a touch that harms is wanted".to_owned()));
    }
    let loses = |line: &TerminationLine| {
        line.params.iter().any(|param| param.key.text == "win" && param.value.text == "False")
    };
    let is_losable = clauses.iter().any(|own| own.terminations.iter().any(loses));
    if losses.is_empty() && !is_losable && !is_deadly(&description.sprites, &all) {
        return Err(GenerateError::Unlucky("nothing can be lost".to_owned()));
    }
    let taken: BTreeSet<String> = all
        .iter()
        .filter(|line| line.effect.text == "collectResource")
        .map(|line| line.first.text.clone())
        .collect();
    let of_bodies = |lines: Vec<InteractionLine>| lines.into_iter().map(|line| (line, None));
    let owned = |lines: Vec<InteractionLine>, count: fn(&Clauses) -> usize| {
        let owners = clauses.iter().enumerate().flat_map(move |(at, own)| vec![Some(at); count(own)]);
        lines.into_iter().zip(owners).collect::<Vec<_>>()
    };
    let all: Vec<(InteractionLine, Option<usize>)> = of_bodies(bodies.pushes(&before))
        .chain(owned(before.clone(), |own| own.before.len()))
        .chain(of_bodies(bodies.stops(&before)))
        .chain(of_bodies(bodies.picks_up(&taken)))
        .chain(owned(rules, |own| own.rules.len()))
        .collect();
    let (interactions, owners) = all.into_iter().unzip();
    description.interactions = interactions;
    description
        .terminations
        .push(termination("SpriteCounter", &[("stype", "hero"), ("limit", "0"), ("win", "False")]));
    for class in losses {
        let lost = lost_name(class);
        let params = [("stype", lost.as_str()), ("limit", "1"), ("win", "False")];
        description.terminations.push(termination("SpriteCounterMore", &params));
    }
    for mut line in clauses.into_iter().flat_map(|own| own.terminations) {
        count_states(invention, types, &mut line);
        description.terminations.push(line);
    }
    if let Some(time) = invention.time {
        let time = time.to_string();
        description.terminations.push(termination("Timeout", &[("limit", &time), ("win", "False")]));
    }
    Ok(Written { description, owners })
}

/// Reads the clauses of a mechanic and gives its ports the names of their types.
fn clauses(invention: &Invention, types: &[Merged], at: usize) -> Result<Clauses, GenerateError> {
    let mechanic = invention.mechanics[at];
    let values = &invention.values[at];
    let names = names_of(mechanic, types, at);
    let filled = |template: &crate::kernels::file::template::Template| template.fill(values);
    let read = |sprites: &str, interactions: &str, terminations: &str| {
        let text = format!(
            "BasicGame\n{}{}{}{}",
            section("SpriteSet", sprites),
            section("LevelMapping", ". > floor"),
            section("InteractionSet", interactions),
            section("TerminationSet", terminations)
        );
        let (description, problems) = syntax::parse(&text);
        match problems.first() {
            Some(problem) => {
                Err(GenerateError::Unsuitable(format!("mechanic {}: {}", mechanic.name, problem.message)))
            }
            None => Ok(description.renamed(&names)),
        }
    };
    let first = read(&filled(&mechanic.sprites), &filled(&mechanic.before), &filled(&mechanic.terminations))?;
    let second = read("", &filled(&mechanic.rules), "")?;
    let class = mechanic.hero.as_ref().map(filled);
    let heroes = mechanic.heroes.as_ref().map(filled).unwrap_or_default();
    let hero = match class {
        None if heroes.is_empty() => None,
        class => {
            let children: String = heroes.lines().map(|line| format!("    {line}\n")).collect();
            let line = format!("hero > {}\n{children}", class.as_deref().unwrap_or("MovingAvatar"));
            let mut hero = read(&line, "", "")?.sprites.pop();
            // A state has the class of the group anyway.
            for line in hero.iter_mut() {
                let text = |line: &SpriteLine| line.class.as_ref().map(|class| class.text.clone());
                let class = text(line);
                line.children
                    .iter_mut()
                    .filter(|state| text(state) == class)
                    .for_each(|state| state.class = None);
            }
            hero
        }
    };
    Ok(Clauses {
        sprites: first.sprites,
        before: first.interactions,
        rules: second.interactions,
        hero,
        terminations: first.terminations,
    })
}

fn section(name: &str, lines: &str) -> String {
    let lines = lines.lines().filter(|line| !line.trim().is_empty());
    format!("    {name}\n{}", lines.map(|line| format!("        {line}\n")).collect::<String>())
}

/// The internal names of the ports and types of a mechanic.
pub(super) fn names_of(mechanic: &Mechanic, types: &[Merged], at: usize) -> BTreeMap<String, String> {
    let class_of = |port: usize| {
        types
            .iter()
            .position(|merged| merged.ports.iter().any(|(id, _)| *id == (at, port)))
            .unwrap_or_default()
    };
    let ports =
        mechanic.ports.iter().enumerate().map(|(port, value)| (value.name.clone(), name(class_of(port))));
    let own = mechanic.types.iter().map(|own| (own.name.clone(), own_name(at, &own.name)));
    ports.chain(own).collect()
}

/// Lets the rules of other mechanics hold for states that stay what the port's type is.
fn extend_to_states(invention: &Invention, types: &[Merged], clauses: &mut [Clauses]) {
    for (at, mechanic) in invention.mechanics.iter().enumerate() {
        let names = names_of(mechanic, types, at);
        for own in &mechanic.types {
            let Origin::State { port, is_still: true, .. } = &own.origin else { continue };
            let Some(thing) = names.get(port) else { continue };
            let state = own_name(at, &own.name);
            for (_, other) in clauses.iter_mut().enumerate().filter(|(other, _)| *other != at) {
                extend(&mut other.before, thing, &state);
                extend(&mut other.rules, thing, &state);
            }
        }
    }
}

fn extend(lines: &mut Vec<InteractionLine>, thing: &str, state: &str) {
    let mut extended = Vec::new();
    for mut line in lines.drain(..) {
        if line.second.iter().any(|word| word.text == thing) {
            line.second.push(Word::from(state));
        }
        let again =
            (line.first.text == thing).then(|| InteractionLine { first: Word::from(state), ..line.clone() });
        extended.push(line);
        extended.extend(again);
    }
    *lines = extended;
}

/// Makes every loss of a goal the end of the game, unless the ending only wants it gone; returns the types that can be lost so.
fn lose_with_goals(invention: &Invention, types: &[Merged], clauses: &mut [Clauses]) -> Vec<usize> {
    let ending = invention.mechanics.len() - 1;
    let mut losses = Vec::new();
    for (class, merged) in types.iter().enumerate() {
        if !merged.is_kept_for(ending) {
            continue;
        }
        let lost = lost_name(class);
        let things = [vec![name(class)], lasting_states(invention, types, class)].concat();
        let losing =
            merged.ports.iter().filter(|((mechanic, _), port)| *mechanic != ending && merged.loses(port));
        let mut is_lost = false;
        for ((mechanic, _), _) in losing {
            let own = &mut clauses[*mechanic];
            for (lines, thing) in things.iter().flat_map(|thing| [(0, thing), (1, thing)]) {
                let lines = if lines == 0 { &mut own.before } else { &mut own.rules };
                is_lost |= mark_losses(lines, thing, &lost);
            }
        }
        if is_lost {
            losses.push(class);
        }
    }
    losses
}

/// Returns the states of a type that are still that type for an ending: their mechanic neither removes nor spends it.
fn lasting_states(invention: &Invention, types: &[Merged], class: usize) -> Vec<String> {
    let merged = &types[class];
    let of_port = |((at, _), port): &(PortId, &'static Port)| {
        let is_gone = port.tags.contains(&Tag::Removed) || port.tags.contains(&Tag::Spent);
        let is_state = |own: &&OwnType| {
            matches!(&own.origin, Origin::State { port: of, .. } if *of == port.name) && !is_gone
        };
        let types = invention.mechanics[*at].types.iter().filter(is_state);
        types.map(|own| own_name(*at, &own.name)).collect::<Vec<_>>()
    };
    merged.ports.iter().flat_map(of_port).collect()
}

/// Lets an ending that counts a type count its lasting states as well.
fn count_states(invention: &Invention, types: &[Merged], line: &mut TerminationLine) {
    let value = |line: &TerminationLine, key: &str| {
        line.params.iter().find(|param| param.key.text == key).map(|param| param.value.text.clone())
    };
    let counted = (line.class.text == "SpriteCounter").then(|| value(line, "stype")).flatten();
    let class = counted.and_then(|counted| (0..types.len()).find(|class| name(*class) == counted));
    let Some(class) = class else { return };
    let states = lasting_states(invention, types, class);
    if states.is_empty() {
        return;
    }
    line.class = Word::from("MultiSpriteCounter");
    line.params.retain(|param| param.key.text != "stype");
    let all = [vec![name(class)], states].concat();
    let counted = (1..).zip(all).map(|(at, stype)| Param::new(&format!("stype{at}"), stype));
    line.params.splice(0..0, counted);
}

/// Lets every rule that takes a thing away leave a mark; returns `true` if there is such a rule.
fn mark_losses(lines: &mut Vec<InteractionLine>, thing: &str, lost: &str) -> bool {
    let mut marked = Vec::new();
    let mut is_lost = false;
    for mut line in lines.drain(..) {
        let is_removing = REMOVING.contains(&line.effect.text.as_str());
        let is_second = line.second.iter().any(|word| word.text == thing);
        let takes_second = line.effect.text == "killBoth"
            || line.params.iter().any(|param| param.key.text == "killSecond" && param.value.text == "True");
        if is_removing && line.first.text == thing && line.effect.text == "killSprite" {
            line.effect = Word::from("transformTo");
            line.params.push(Param::new("stype", lost));
            is_lost = true;
        } else if is_removing && (line.first.text == thing || (is_second && takes_second)) {
            marked.push(InteractionLine {
                effect: Word::from("spawn"),
                params: vec![Param::new("stype", lost)],
                ..line.clone()
            });
            is_lost = true;
        }
        marked.push(line);
    }
    *lines = marked;
    is_lost
}

/// Lets the player hold an item that a rule takes off the board at a touch of the player.
fn collect_instead(line: &mut InteractionLine, items: &BTreeSet<&str>) {
    let is_taken = line.effect.text == "killSprite" && line.second.iter().all(|word| word.text == "hero");
    if is_taken && items.contains(line.first.text.as_str()) {
        line.effect = Word::from("collectResource");
    }
}

/// Tests whether some rule kills the player.
fn is_deadly(sprites: &[SpriteLine], rules: &[InteractionLine]) -> bool {
    let heroes = sprites.last().map_or(&[][..], |hero| &hero.children);
    let is_hero =
        |word: &Word| word.text == "hero" || heroes.iter().any(|state| state.name.text == word.text);
    let kills = ["killSprite", "killIfAlive", "killIfHasLess", "subtractHealthPoints"];
    rules.iter().any(|line| is_hero(&line.first) && kills.contains(&line.effect.text.as_str()))
}

/// Tests whether touching a type both harms the player and is what the player wants of it.
fn is_contradictory(bodies: &Bodies, types: &[Merged], rules: &[InteractionLine]) -> bool {
    let meets = |line: &InteractionLine, first: &str, second: &str| {
        line.first.text == first && line.second.iter().any(|word| word.text == second)
    };
    (0..types.len()).map(name).any(|stype| {
        let harms = rules.iter().any(|line| {
            meets(line, "hero", &stype) && ["killSprite", "killIfAlive"].contains(&line.effect.text.as_str())
        });
        let is_taken =
            rules.iter().any(|line| meets(line, &stype, "hero") && line.effect.text == "killSprite");
        harms && (is_taken || bodies.with(Body::Item).any(|item| item == stype))
    })
}

/// The types of a game by their bodies.
struct Bodies {
    of: Vec<(String, Body)>,
    /// Movers that turn round where they are stopped.
    marching: BTreeSet<String>,
    /// Types that stand still until they become another.
    still: BTreeSet<String>,
}

impl Bodies {
    fn of(invention: &Invention, types: &[Merged]) -> Bodies {
        let merged = types.iter().enumerate().map(|(class, merged)| (name(class), merged.body));
        let own = invention.mechanics.iter().enumerate().flat_map(|(at, mechanic)| {
            let types = mechanic.types.iter().filter(|own| !is_hero(&own.origin));
            types.map(move |own| (own_name(at, &own.name), own.body))
        });
        Bodies { of: merged.chain(own).collect(), marching: BTreeSet::new(), still: BTreeSet::new() }
    }

    fn with(&self, body: Body) -> impl Iterator<Item = &str> {
        self.of.iter().filter(move |(_, other)| *other == body).map(|(name, _)| name.as_str())
    }

    /// The rules of pushing.
    fn pushes(&self, before: &[InteractionLine]) -> Vec<InteractionLine> {
        let moving: Vec<&str> = self.with(Body::Mover).chain(self.with(Body::Flash)).collect();
        let push = |name: &str| {
            let stops: Vec<&str> = ["wall"]
                .into_iter()
                .chain(self.with(Body::Solid))
                .chain(self.with(Body::Crate))
                .chain(self.with(Body::Mover))
                .filter(|other| !is_settled(before, name, other))
                .collect();
            let mut undo = interaction(name, &stops, "undoAll");
            if !moving.is_empty() {
                undo.params.push(Param::new("notStype", moving.join(",")));
            }
            [interaction(name, &["hero"], "bounceForward"), undo]
        };
        let lines = self.with(Body::Crate).flat_map(push);
        lines.filter(|line| !line.second.is_empty()).collect()
    }

    /// The rules of standing in the way.
    fn stops(&self, before: &[InteractionLine]) -> Vec<InteractionLine> {
        let solid = |mover: &str| -> Vec<&str> {
            let all = ["wall"].into_iter().chain(self.with(Body::Solid));
            all.filter(|other| !is_settled(before, mover, other)).collect()
        };
        let mut lines = vec![interaction("hero", &solid("hero"), "stepBack")];
        for mover in self.with(Body::Mover).filter(|mover| !self.still.contains(*mover)) {
            let crates = self.with(Body::Crate).filter(|other| !is_settled(before, mover, other));
            let stops: Vec<&str> = solid(mover).into_iter().chain(crates).collect();
            if stops.is_empty() {
                continue;
            }
            if self.marching.contains(mover) {
                lines.push(interaction(mover, &stops, "reverseDirection"));
            }
            lines.push(interaction(mover, &stops, "stepBack"));
        }
        lines
    }

    /// The rules of picking up, for what the hero does not take by a rule of a mechanic.
    fn picks_up(&self, taken: &BTreeSet<String>) -> Vec<InteractionLine> {
        let items = self.with(Body::Item).filter(|item| !taken.contains(*item));
        let pick = |item| {
            let mut line = interaction(item, &["hero"], "collectResource");
            line.params.push(Param::new("scoreChange", "1"));
            line
        };
        items.map(pick).collect()
    }
}

/// Tests whether a rule takes one of two away whenever they meet.
fn is_settled(before: &[InteractionLine], one: &str, other: &str) -> bool {
    let meet = |line: &InteractionLine, first: &str, second: &str| {
        line.first.text == first && line.second.iter().any(|word| word.text == second)
    };
    before.iter().any(|line| {
        REMOVING.contains(&line.effect.text.as_str()) && (meet(line, one, other) || meet(line, other, one))
    })
}

fn is_hero(origin: &Origin) -> bool {
    matches!(origin, Origin::State { port, .. } if port == "hero")
}

/// Writes the SpriteSet: what lies below comes first, the hero last.
fn sprites(
    types: &[Merged],
    bodies: &Bodies,
    clauses: &mut [Clauses],
) -> Result<Vec<SpriteLine>, GenerateError> {
    let mut lines = vec![sprite("floor", "Immovable"), sprite("wall", "Immovable")];
    let mut own: BTreeMap<String, Vec<(usize, SpriteLine)>> = BTreeMap::new();
    for (at, clauses) in clauses.iter_mut().enumerate() {
        for line in clauses.sprites.drain(..) {
            own.entry(line.name.text.clone()).or_default().push((at, line));
        }
    }
    let order = [Body::Ground, Body::Solid, Body::Item, Body::Crate, Body::Mover, Body::Flash];
    for body in order {
        for name in bodies.with(body) {
            let given = own.remove(name).unwrap_or_default();
            let given: Vec<SpriteLine> =
                given.into_iter().filter(|(at, _)| is_of(types, *at, name)).map(|(_, line)| line).collect();
            match <[SpriteLine; 1]>::try_from(given) {
                Ok([line]) => lines.push(line),
                Err(none) if none.is_empty() => lines.push(default(name, body)),
                Err(_) => return Err(GenerateError::Unlucky("a type of two classes".to_owned())),
            }
        }
    }
    let hero = clauses.iter_mut().find_map(|clauses| clauses.hero.take());
    lines.push(hero.unwrap_or_else(|| sprite("hero", "MovingAvatar")));
    Ok(lines)
}

/// Tests whether the line that a mechanic writes for a type counts: of a mover, only that of the mechanic that moves it.
fn is_of(types: &[Merged], mechanic: usize, own: &str) -> bool {
    let merged = types.iter().enumerate().find(|(class, _)| name(*class) == own);
    merged.is_none_or(|(_, merged)| {
        merged.body != Body::Mover
            || merged.ports.iter().any(|((at, _), port)| *at == mechanic && port.tags.contains(&Tag::Moves))
    })
}

fn move_hero_last(lines: &mut Vec<SpriteLine>) {
    if let Some(at) = lines.iter().position(|line| line.name.text == "hero") {
        let hero = lines.remove(at);
        lines.push(hero);
    }
}

fn default(name: &str, body: Body) -> SpriteLine {
    match body {
        Body::Item => SpriteLine { params: vec![Param::new("limit", 9)], ..sprite(name, "Resource") },
        Body::Crate => sprite(name, "Passive"),
        Body::Flash => SpriteLine { params: vec![Param::new("limit", 0)], ..sprite(name, "Flicker") },
        _ => sprite(name, "Immovable"),
    }
}

fn sprite(name: &str, class: &str) -> SpriteLine {
    SpriteLine { name: Word::from(name), class: Some(Word::from(class)), ..SpriteLine::default() }
}

fn interaction(first: &str, second: &[&str], effect: &str) -> InteractionLine {
    InteractionLine {
        first: Word::from(first),
        second: second.iter().map(|name| Word::from(*name)).collect(),
        effect: Word::from(effect),
        ..InteractionLine::default()
    }
}

fn termination(class: &str, params: &[(&str, &str)]) -> TerminationLine {
    let params = params.iter().map(|(key, value)| Param::new(key, value)).collect();
    TerminationLine { class: Word::from(class), params, ..TerminationLine::default() }
}

/// Returns the names of the types whose line has this class.
fn of_class(lines: &[SpriteLine], class: &str) -> BTreeSet<String> {
    let has = |line: &&SpriteLine| line.class.as_ref().is_some_and(|word| word.text == class);
    lines.iter().filter(has).map(|line| line.name.text.clone()).collect()
}

/// The LevelMapping under internal names; the fiction gives each line its character.
fn mapping(types: &[Merged], sprites: &[SpriteLine]) -> Vec<MappingLine> {
    let line = |names: &[&str]| MappingLine {
        names: names.iter().map(|name| Word::from(*name)).collect(),
        ..MappingLine::default()
    };
    let states = sprites.last().and_then(|hero| hero.children.first());
    let hero = states.map_or("hero", |line| line.name.text.as_str());
    let mut lines = vec![line(&["floor"]), line(&["wall"]), line(&["floor", hero])];
    lines.extend((0..types.len()).map(|class| line(&["floor", &name(class)])));
    lines
}
