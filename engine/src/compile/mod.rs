//! From a syntax tree to rules: names resolved, parameters typed, interactions laid out as a flat program.

mod interactions;
mod params;
mod references;
mod sprites;
mod terminations;

use crate::Digest;
use crate::contacts::Contacts;
use crate::diagnostic::{Diagnostic, Diagnostics, nearest};
use crate::game::{NOT_IN_TREE, Rules, SpriteType, TypeInfo};
use crate::ontology::class::SpriteClass;
use crate::ontology::sprites as behaviour;
use crate::ontology::terminations::Condition;
use crate::rest::may_rest;
use crate::syntax::{Description, Literal, Param, Section, Word, literal, print_bare};
use smallvec::SmallVec;
use std::sync::OnceLock;

/// Sprite types at most.
const MAX_TYPES: usize = 512;
/// Interaction lines at most, and passes that they make.
const MAX_PASSES: usize = 20_000;
/// Cells that the largest sprite may cover along one side.
const MAX_REACH: i32 = 64;

/// What to do about faults.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Policy {
    /// Errors are errors.
    Strict,
    /// Drops, ignores and overlooks as the reference does.
    Reference,
}

pub(crate) fn compile(description: &Description) -> Result<Rules, Diagnostics> {
    compile_with(description, Policy::Strict, 0)
}

/// Faults that end the reference's reading of the file: the rest is missing.
const FATAL: [&str; 6] = [
    "unknown-effect",
    "unknown-sprite",
    "missing-parameter",
    "bad-interaction",
    "unknown-termination",
    "no-class",
];

/// What is read of the file is what comes before the first fault that ends the reading.
pub(crate) fn compile_as_reference(description: &Description) -> Result<Rules, Diagnostics> {
    let mut read = Description {
        mapping: Vec::new(),
        interactions: Vec::new(),
        terminations: Vec::new(),
        ..description.clone()
    };
    let mut messages = description.messages;
    let (types, _) = sprites::types(description, Policy::Reference, &mut Vec::new());
    let names = Names { types: &types };
    let is_fatal = |problems: &[Diagnostic]| problems.iter().any(|problem| FATAL.contains(&problem.code));
    for section in &description.order {
        let mut aborted = false;
        match section {
            Section::SpriteSet => {}
            Section::LevelMapping => read.mapping.clone_from(&description.mapping),
            Section::InteractionSet => {
                for line in &description.interactions {
                    let (usable, logged) = interactions::usable(line, names);
                    messages += logged;
                    aborted = usable.as_ref() != Some(line);
                    read.interactions.extend(usable);
                    if aborted {
                        break;
                    }
                }
            }
            Section::TerminationSet => {
                for line in &description.terminations {
                    let mut problems = Vec::new();
                    let alone = Description { terminations: vec![line.clone()], ..Description::default() };
                    terminations::terminations(&alone, names, &mut problems);
                    aborted = is_fatal(&problems);
                    messages +=
                        problems.iter().filter(|problem| problem.code == "unknown-parameter").count() as u32;
                    if aborted {
                        break;
                    }
                    read.terminations.push(line.clone());
                }
            }
        }
        if aborted {
            messages += 1;
            break;
        }
    }
    compile_with(&read, Policy::Reference, messages)
}

fn compile_with(description: &Description, policy: Policy, messages: u32) -> Result<Rules, Diagnostics> {
    let mut problems = Vec::new();
    let square_size = header(description, &mut problems);
    let (types, order) = sprites::types(description, policy, &mut problems);
    if types.len() > MAX_TYPES {
        let message = format!("the game has {} sprite types; the limit is {MAX_TYPES}", types.len());
        problems.push(Diagnostic::error("too-large", description.header.class.span, message));
        return Err(Diagnostics::sorted(problems));
    }
    let names = Names { types: &types };
    let mapping = mapping(description, names, &mut problems);
    let program = interactions::program(description, names, &mut problems);
    let terminations = terminations::terminations(description, names, &mut problems);
    let obstacles = obstacles(description, names, &mut problems);
    if program.passes.len() > MAX_PASSES {
        let message =
            format!("the game has {} interactions; the limit is {MAX_PASSES}", program.passes.len());
        problems.push(Diagnostic::error("too-large", description.header.class.span, message));
    }
    if policy == Policy::Strict {
        misspelt_declarations(description, &mut problems);
    }
    if !Diagnostics::has_errors(&problems) {
        never_there(description, &types, &mapping, &program, &mut problems);
    }
    if policy == Policy::Reference {
        // What is left is what the reference overlooks.
        problems.retain(|problem| problem.code == "too-large");
    }
    let problems = Diagnostics::sorted(problems);
    if Diagnostics::has_errors(&problems.0) {
        return Err(problems);
    }

    let speeds_change = program.effects.iter().any(|info| info.effect.gives_speed());
    let moves = |stype: &SpriteType| {
        let info = &types[stype.index()];
        info.class.is_some_and(|class| !behaviour::is_idle(class, &info.traits, speeds_change))
    };
    let factors = types.iter().flat_map(|info| [info.traits.width_factor, info.traits.height_factor]);
    let classes = || types.iter().filter_map(|info| info.class);
    let rests = may_rest(&types, program.effects.iter().map(|info| &info.effect), !program.timed.is_empty());
    // The reference makes one of each resource to learn its limit, and complains of its parameters then, too.
    let resources = types.iter().filter(|info| info.class == Some(SpriteClass::Resource));
    let messages = messages + resources.map(|info| info.unknown_parameters).sum::<u32>();
    Ok(Rules {
        digest: Digest::of(print_bare(description).as_bytes()),
        description: description.clone(),
        warnings: problems.0,
        all_warnings: OnceLock::new(),
        as_reference: policy == Policy::Reference,
        messages,
        square_size,
        movers: order.iter().rev().copied().filter(moves).collect(),
        order,
        mapping,
        draws: classes().any(behaviour::draws) || program.effects.iter().any(|info| info.effect.draws()),
        effects: program.effects,
        edge: program.edge,
        any_rests: rests.contains(&true),
        rests,
        contacts: Contacts::of(&types, &program.passes),
        passes: program.passes,
        timed: program.timed,
        finds_paths: path_obstacles(description).is_some(),
        obstacles,
        reads_tick: terminations.iter().any(|end| matches!(end.condition, Condition::Timeout { .. })),
        terminations,
        reach: factors.clone().fold(1, |reach, factor| reach.max(factor.ceil() as i32)),
        first_differs: types.iter().any(first_differs),
        types,
    })
}

fn header(description: &Description, problems: &mut Vec<Diagnostic>) -> Option<i32> {
    let mut square_size = None;
    for param in &description.header.params {
        let value = literal(&param.value.text);
        match (param.key.text.as_str(), value) {
            ("square_size", Literal::Int(-1)) => square_size = None,
            ("square_size", Literal::Int(size @ 1..=10_000)) => square_size = Some(size),
            ("square_size", _) => {
                let message = "`square_size` takes a number of pixels between 1 and 10000";
                problems.push(Diagnostic::error("wrong-type", param.value.span, message));
            }
            ("no_players", Literal::Int(1)) | ("no_counters", Literal::Int(0)) | ("key_handler", _) => {}
            ("obs", _) => {}
            ("no_players" | "no_counters", _) => {
                let message = format!("`{}` is not supported yet", param.key.text);
                problems.push(Diagnostic::error("unsupported", param.span(), message).help("remove it"));
            }
            (key, _) => {
                let known = ["square_size", "key_handler", "no_players", "no_counters", "obs"];
                let message = format!("a game has no parameter `{key}`");
                let problem = Diagnostic::error("unknown-parameter", param.key.span, message);
                problems.push(problem.suggest(key, known));
            }
        }
    }
    square_size
}

/// Names that nothing declares, next to a declared one that nothing uses: the declaration is what is misspelt, if the name is
/// used more than once, or may be.
fn misspelt_declarations(description: &Description, problems: &mut Vec<Diagnostic>) {
    let lines = || description.sprite_lines().into_iter().map(|(_, line)| line);
    let params = lines().flat_map(|line| &line.params);
    let params = params.chain(description.interactions.iter().flat_map(|line| &line.params));
    let params = params.chain(description.terminations.iter().flat_map(|line| &line.params));
    let mut used: Vec<&Word> = description.mapping.iter().flat_map(|line| &line.names).collect();
    used.extend(description.interactions.iter().flat_map(|line| line.second.iter().chain([&line.first])));
    used.extend(params.map(|param| &param.value));
    let unknown = |word: &&&Word| {
        problems.iter().any(|problem| problem.code == "unknown-sprite" && problem.span == word.span)
    };
    let mut names: Vec<&str> = used.iter().filter(unknown).map(|word| word.text.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let is_used = |name: &str| used.iter().any(|word| word.text.split(',').any(|entry| entry == name));
    for name in names {
        let idle = lines().filter(|line| !is_used(&line.name.text));
        let Some(near) = nearest(name, idle.clone().map(|line| line.name.text.as_str())) else { continue };
        let Some(line) = idle.clone().find(|line| line.name.text == near) else { continue };
        let places: Vec<&Word> = used.iter().filter(|word| word.text == name).copied().collect();
        let problem = if places.len() > 1 {
            problems.retain(|problem| {
                problem.code != "unknown-sprite" || !places.iter().any(|word| word.span == problem.span)
            });
            let message = format!(
                "no sprite named `{name}`, which {} places name; nothing names `{near}`",
                places.len()
            );
            Diagnostic::error("unknown-sprite", line.name.span, message)
        } else {
            let message = format!("nothing names `{near}`, and `{name}` is not declared");
            Diagnostic::warning("unused-sprite", line.name.span, message)
        };
        problems.push(problem.help(format!("did you mean `{name}`?")));
    }
}

/// Sprite types that no level can place and nothing makes: legal, but surely not meant.
fn never_there(
    description: &Description,
    types: &[TypeInfo],
    mapping: &[SmallVec<[SpriteType; 4]>],
    program: &interactions::Program,
    problems: &mut Vec<Diagnostic>,
) {
    let mut there: Vec<SpriteType> = mapping.iter().flatten().copied().collect();
    for traits in types.iter().map(|info| &info.traits) {
        there.extend(traits.stypes.iter().chain(&traits.ammo).chain(&traits.spawn_behind));
    }
    for effect in program.effects.iter().map(|info| &info.effect) {
        there.extend(effect.makes().into_iter().chain(effect.resource()));
    }
    for (_, line) in description.sprite_lines() {
        let name = &line.name.text;
        let found = types.iter().position(|info| info.name == *name).map(|at| SpriteType(at as u16));
        let Some(stype) = found.filter(|stype| types[stype.index()].leaf && !there.contains(stype)) else {
            continue;
        };
        if types[stype.index()].class.is_some() {
            let message =
                format!("there is never a `{name}`: no level character places it and nothing makes it");
            let problem = Diagnostic::warning("never-there", line.name.span, message);
            problems
                .push(problem.help(format!("add it to the LevelMapping, or remove `{name}` and its rules")));
        }
    }
}

/// A later sprite is a copy of the first: it has its size from the start, its parameters have been complained of, and if
/// it leaves something behind it is wall.
fn first_differs(info: &TypeInfo) -> bool {
    let scales = [info.traits.width_factor, info.traits.height_factor] != [1.0, 1.0];
    scales || info.unknown_parameters > 0 || info.class == Some(SpriteClass::OngoingTurningAvatar)
}

/// `obs=`, if its value reads as a text.
fn path_obstacles(description: &Description) -> Option<&Param> {
    let given = description.header.params.iter().rev().find(|param| param.key.text == "obs");
    given.filter(|param| matches!(params::convert("obs", &param.value.text), params::Value::Text(_)))
}

/// The types that path finding goes around.
fn obstacles(description: &Description, names: Names<'_>, problems: &mut Vec<Diagnostic>) -> Vec<SpriteType> {
    let Some(param) = path_obstacles(description) else { return Vec::new() };
    let word = |text: &str| Word { text: text.to_owned(), span: param.value.span };
    param.value.text.split(',').filter_map(|name| names.resolve(&word(name), problems)).collect()
}

fn mapping(
    description: &Description,
    names: Names<'_>,
    problems: &mut Vec<Diagnostic>,
) -> Vec<SmallVec<[SpriteType; 4]>> {
    let mut mapping = vec![SmallVec::new(); 128];
    // Present in every game unless it maps these characters itself (`spec/01` §1.7).
    mapping[usize::from(b'w')] = SmallVec::from_slice(&[SpriteType(0)]);
    mapping[usize::from(b'A')] = SmallVec::from_slice(&[SpriteType(1)]);
    let mut seen = Vec::new();
    for line in &description.mapping {
        if seen.contains(&line.symbol) {
            let message = format!("`{}` is mapped twice; the last line counts", line.symbol);
            let problem = Diagnostic::error("duplicate-mapping", line.span, message);
            problems.push(problem.help("remove one of the two lines"));
        }
        seen.push(line.symbol);
        let types = line.names.iter().filter_map(|name| {
            let stype = names.resolve(name, problems)?;
            // The reference dies of a type without a class when it makes the sprite.
            names.instantiable(stype, name, problems);
            Some(stype)
        });
        let types = types.collect();
        if let Some(entry) =
            u8::try_from(line.symbol).ok().and_then(|code| mapping.get_mut(usize::from(code)))
        {
            *entry = types;
        }
    }
    mapping
}

/// Looks names up, with a problem for those that do not exist.
#[derive(Clone, Copy)]
struct Names<'a> {
    types: &'a [TypeInfo],
}

impl Names<'_> {
    fn find(self, name: &str) -> Option<SpriteType> {
        self.types.iter().position(|info| info.name == name).map(|at| SpriteType(at as u16))
    }

    fn resolve(self, name: &Word, problems: &mut Vec<Diagnostic>) -> Option<SpriteType> {
        let found = self.find(&name.text);
        if found.is_none() {
            problems.push(self.unknown(name, &[]));
        }
        found
    }

    /// The sprite that the value of a parameter, or an entry of it, names.
    fn resolve_value(self, param: &Param, name: &Word, problems: &mut Vec<Diagnostic>) -> Option<SpriteType> {
        let found = self.find(&name.text);
        if found.is_none() {
            let problem = self.unknown(name, &[]);
            problems.push(match params::is_name(&name.text) {
                true => problem,
                false => problem.help(format!("write `{}=` and the name of a sprite", param.key.text)),
            });
        }
        found
    }

    /// The problem of a name that no sprite has, and that is none of `others` either.
    fn unknown(self, name: &Word, others: &[&str]) -> Diagnostic {
        let message = format!("no sprite named `{}`", name.text);
        let problem = Diagnostic::error("unknown-sprite", name.span, message).label("not in the SpriteSet");
        let known = || self.types.iter().map(|info| info.name.as_str()).chain(others.iter().copied());
        match nearest(&name.text, known()) {
            Some(near) => problem.help(format!("did you mean `{near}`?")),
            None if known().count() <= 12 => {
                let all: Vec<&str> = known().collect();
                problem.help(format!("declare it in the SpriteSet, or name one of {}", all.join(", ")))
            }
            None => problem.help("declare it in the SpriteSet"),
        }
    }

    /// Whether sprites of the type can be made; a problem if not.
    fn instantiable(self, stype: SpriteType, name: &Word, problems: &mut Vec<Diagnostic>) -> bool {
        let info = &self.types[stype.index()];
        if info.class.is_none() {
            let of_it =
                self.types.iter().filter(|other| other.path.contains(&stype) && other.class.is_some());
            let below: Vec<&str> = of_it.map(|other| other.name.as_str()).collect();
            // Without any class below, its own line has been told of.
            if !below.is_empty() {
                let message = format!("`{}` has no class, so there can be no such sprite", name.text);
                let problem = Diagnostic::error("no-class", name.span, message);
                problems.push(problem.help(format!("name one of its subtypes: {}", below.join(", "))));
            }
        } else if !info.leaf {
            let message = format!("`{}` is a parent type: its sprites are never updated", name.text);
            problems.push(
                Diagnostic::warning("parent-sprite", name.span, message).help("name one of its subtypes"),
            );
        }
        info.class.is_some()
    }
}

/// The place of every type in `tree`.
fn ranks(tree: &[SpriteType], types: usize) -> Box<[u16]> {
    let mut rank = vec![NOT_IN_TREE; types];
    for (at, stype) in tree.iter().enumerate().rev() {
        rank[stype.index()] = at as u16;
    }
    rank.into()
}

#[cfg(test)]
mod tests {
    use crate::Game;

    const GAME: &str = "BasicGame\n  SpriteSet\n    egg > Immovable\n    chick > RandomNPC\n    coop > SpawnPoint stype=chick\n    purse > Resource\n    avatar > MovingAvatar\n  LevelMapping\n    e > egg\n    c > coop\n  InteractionSet\n    egg avatar > killSprite\n    avatar chick > changeResource resource=purse\n  TerminationSet\n    SpriteCounter stype=egg win=True\n    Timeout limit=99\n";

    #[track_caller]
    fn warnings(source: &str, expect: &[&str]) {
        let game = Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}"));
        let told = game.warnings().iter().filter(|warning| warning.code == "never-there");
        assert_eq!(told.map(|warning| warning.message.as_str()).collect::<Vec<_>>(), expect);
    }

    #[test]
    fn sprites_that_are_never_there() {
        warnings(GAME, &[]);
        let egg = "there is never a `egg`: no level character places it and nothing makes it";
        warnings(&GAME.replace("    e > egg\n", ""), &[egg]);
        let chick = "there is never a `chick`: no level character places it and nothing makes it";
        warnings(&GAME.replace("coop > SpawnPoint stype=chick", "coop > SpawnPoint stype=egg"), &[chick]);
    }
}
