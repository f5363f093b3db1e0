//! Compiles a syntax tree into rules: resolves names, checks parameter types, and flattens interactions into
//! a program.

mod as_reference;
mod clauses;
mod header;
mod interactions;
mod outline;
mod params;
mod references;
mod rename;
mod scenery;
mod space;
mod sprites;
mod terminations;

pub(crate) use clauses::clauses;
pub use clauses::{Clauses, InteractionClause, Party, Term, TerminationClause, Terms, TypeClause};
pub use params::BASE as SPRITE_PARAMETERS;

use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Span, nearest};
use crate::limits::{MAX_INTERACTIONS, MAX_PROBLEMS, MAX_TYPES};
use crate::rules::class::SpriteClass;
use crate::rules::effects::Draws;
use crate::rules::terminations::{Condition, Decision, Termination};
use crate::rules::traits::BLOCK_PAUSE;
use crate::rules::{Alias, Aliases, NOT_IN_TREE, Rules, SpriteType, TypeInfo};
use crate::syntax::{Description, Param, Word, print_bare};
pub(crate) use as_reference::compile_as_reference;
use base::Digest;
use header::Header;
pub(crate) use outline::{Outline, outline};
use scenery::{fixtures, referenced, scenery};
use smallvec::SmallVec;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

/// The policy for handling faults.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Policy {
    /// Strict mode: faults are errors.
    Strict,
    /// Reference mode: faults are dropped or ignored, as in the reference engine.
    Reference,
}

/// The context for reading the lines after the first.
#[derive(Clone, Copy, Debug)]
struct Setting {
    policy: Policy,
    /// The number of counters in the game.
    counters: usize,
}

/// The reference's behaviour while reading a file.
#[derive(Clone, Copy, Debug, Default)]
struct Fate {
    /// The number of messages that the reference logs.
    messages: u32,
    /// `true` if the reference will crash on an undeclared sprite at the edge of the screen.
    dies_at_edge: bool,
}

pub(crate) fn compile(description: &Description) -> Result<Rules, Diagnostics> {
    refuse_large(description)?;
    let mut problems = Vec::new();
    let description = space::settled(description, Policy::Strict, &mut problems);
    compile_with(&description, Policy::Strict, Fate::default(), problems)
}

fn compile_with(
    description: &Description,
    policy: Policy,
    fate: Fate,
    mut problems: Vec<Diagnostic>,
) -> Result<Rules, Diagnostics> {
    let header = Header::of(description, &mut problems);
    let setting = Setting { policy, counters: header.counters };
    let (mut types, order) = sprites::types(description, policy, &mut problems);
    let names = Names { types: &types };
    let aliases =
        if policy == Policy::Reference { aliases(description, &mut problems) } else { Aliases::default() };
    let (mapping, unusable) = mapping(description, names, &aliases, &mut problems);
    report_missing_images(&types, &mapping, &mut problems);
    let program = interactions::program(description, names, setting, &mut problems);
    let (terminations, can_end) = terminations::terminations(description, names, setting, &mut problems);
    let obstacles = header.obstacles.iter().flatten();
    let obstacles = obstacles.filter_map(|name| names.resolve(name, &mut problems)).collect();
    if policy == Policy::Strict {
        repeated_parameters(description, &mut problems);
    }
    if policy == Policy::Strict && problems.len() < MAX_PROBLEMS {
        misspelt_declarations(description, &mut problems);
    }
    if !Diagnostics::has_errors(&problems) {
        report_sprites_that_never_exist(description, &types, &mapping, &program, &mut problems);
    }
    if policy == Policy::Reference {
        // The reference does not notice any other problems.
        problems.retain(|problem| ["too-large", "unsupported"].contains(&problem.code));
    }
    let problems = Diagnostics::sorted(problems);
    if Diagnostics::has_errors(&problems.0) {
        return Err(problems);
    }

    let counted: Vec<SpriteType> = terminations.iter().flat_map(Termination::counts).copied().collect();
    let counted = |info: &TypeInfo| info.tree.iter().any(|stype| counted.contains(stype));
    let counted: BTreeSet<SpriteType> =
        types.iter().filter(|info| counted(info)).flat_map(|info| info.tree.iter().copied()).collect();
    counted.iter().for_each(|stype| types[stype.index()].counted = true);
    for stype in program.given_speed(&types) {
        types[stype.index()].given_speed = true;
    }
    let factors = types.iter().flat_map(|info| [info.traits.width_factor, info.traits.height_factor]);
    let classes = || types.iter().filter_map(|info| info.class);
    let referenced = referenced(description, &types);
    // To read a resource's limit, the reference creates a sprite of the resource, which also logs the
    // messages about its parameters.
    let resources = types.iter().filter(|info| info.class == Some(SpriteClass::Resource));
    let messages = fate.messages + resources.map(|info| info.unknown_parameters).sum::<u32>();
    let of_class = |is: &'static dyn Fn(SpriteClass) -> bool| {
        types.iter().filter(move |info| info.class.is_some_and(is)).map(|info| &info.traits)
    };
    let spawners = || of_class(&SpriteClass::is_spawner);
    let wizards = of_class(&|class| class == SpriteClass::WizardAvatar);
    let distinct = |numbers: &mut dyn Iterator<Item = i32>| {
        let numbers: BTreeSet<i32> = numbers.collect();
        numbers.into_iter().collect::<Vec<i32>>()
    };
    Ok(Rules {
        digest: Digest::of(print_bare(description).as_bytes()),
        description: description.clone(),
        warnings: problems.0,
        all_warnings: OnceLock::new(),
        as_reference: policy == Policy::Reference,
        messages,
        square_size: header.square_size,
        counters: header.counters,
        can_end,
        scenery: scenery(&types, &referenced),
        fixtures: fixtures(description, &types, &program),
        referenced,
        order,
        mapping,
        aliases,
        unusable,
        draws: classes().any(SpriteClass::draws)
            || program.effects.iter().any(|info| info.summary.draws != Draws::Nothing),
        first_differs: types.iter().any(|info| info.first_differs),
        remembering: program.remembering(&types),
        effects: program.effects,
        undeclared_at_edge: fate.dies_at_edge,
        edge: program.edge,
        passes: program.passes,
        timed: program.timed,
        finds_paths: header.obstacles.is_some(),
        obstacles,
        reads_tick: terminations.iter().any(|end| matches!(end.condition, Condition::Timeout { .. })),
        first_timeout: terminations.iter().filter_map(Termination::timeout).min().unwrap_or(i32::MAX),
        reads_counters: terminations
            .iter()
            .any(|end| matches!(end.decided_by, Decision::Difference | Decision::Value(_))),
        reads_score: terminations.iter().any(|end| end.decided_by == Decision::Score),
        clocks: distinct(&mut spawners().map(|traits| traits.cooldown).filter(|&cooldown| cooldown > 1)),
        wizard_ticks: distinct(&mut wizards.map(|traits| traits.last_block_time.wrapping_add(BLOCK_PAUSE))),
        terminations,
        reach: factors.fold(1, |reach, factor| reach.max(factor.ceil() as i32)),
        types,
    })
}

/// Returns the number of parameters on a line that its class does not support. Repeated names count once.
fn unknown_parameters(problems: &[Diagnostic]) -> u32 {
    let mut unknown: Vec<&str> = problems
        .iter()
        .filter(|problem| problem.code == "unknown-parameter")
        .map(|problem| problem.message.as_str())
        .collect();
    unknown.sort_unstable();
    unknown.dedup();
    unknown.len() as u32
}

/// Reports parameters that occur twice on the same line.
fn repeated_parameters(description: &Description, problems: &mut Vec<Diagnostic>) {
    let lines = description.sprite_lines().into_iter().map(|(_, line)| &line.params);
    let lines = lines.chain(description.interactions.iter().map(|line| &line.params));
    let lines = lines.chain(description.terminations.iter().map(|line| &line.params));
    for params in lines.chain([&description.header.params]) {
        let mut seen: BTreeMap<&str, &Param> = BTreeMap::new();
        for param in params {
            let key = param.key.text.as_str();
            let Some(earlier) = seen.insert(key, param) else { continue };
            let span = earlier.span();
            let (earlier, last) = (&earlier.value.text, &param.value.text);
            let message = match earlier == last {
                true => format!("`{key}` is given twice on this line"),
                false => {
                    format!(
                        "`{key}` is given twice on this line: `{earlier}` and `{last}`; the last value is used"
                    )
                }
            };
            let problem = Diagnostic::warning("duplicate-parameter", param.span(), message);
            let problem = problem.help(format!("keep one: `{key}={last}`, if the game plays as intended"));
            problems.push(problem.fix(format!("Keep `{key}={last}`"), vec![Edit::new(span, "")]));
        }
    }
}

/// Rejects games that would be slow to process, before any name is resolved.
fn refuse_large(description: &Description) -> Result<(), Diagnostics> {
    let counts = [
        ("sprite types", description.sprite_lines().len(), MAX_TYPES),
        ("parameters", description.parameters.len(), MAX_TYPES),
        ("mappings of characters", description.mapping.len(), MAX_TYPES),
        ("interactions", description.interactions.len(), MAX_INTERACTIONS),
        ("terminations", description.terminations.len(), MAX_TYPES),
    ];
    let exceeded = counts.into_iter().filter(|(_, count, most)| count > most);
    let problems: Vec<Diagnostic> =
        exceeded.map(|(what, count, most)| too_many(description, what, count, most)).collect();
    if problems.is_empty() { Ok(()) } else { Err(Diagnostics(problems)) }
}

fn too_many(description: &Description, what: &str, count: usize, most: usize) -> Diagnostic {
    let message = format!("the game has {count} {what}; the limit is {most}");
    let problem = Diagnostic::error("too-large", description.header.class.span, message);
    problem.help("split the game into several games")
}

/// Reports undeclared names that are similar to a declared but unused name. If the undeclared name is used
/// more than once, the declaration counts as misspelt. If it is used only once, either the declaration or the
/// use may be misspelt.
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
    let entries: BTreeSet<&str> = used.iter().flat_map(|word| word.text.split(',')).collect();
    let idle = || lines().filter(|line| !entries.contains(line.name.text.as_str()));
    for name in names {
        let Some(near) = nearest(name, idle().map(|line| line.name.text.as_str())) else { continue };
        let Some(line) = idle().find(|line| line.name.text == near) else { continue };
        let places: Vec<&Word> = used.iter().filter(|word| word.text == name).copied().collect();
        let problem = if places.len() > 1 {
            problems.retain(|problem| {
                problem.code != "unknown-sprite" || !places.iter().any(|word| word.span == problem.span)
            });
            let message = format!(
                "no sprite named `{name}`, which is used in {} places; `{near}` is never used",
                places.len()
            );
            Diagnostic::error("unknown-sprite", line.name.span, message)
        } else {
            let message = format!("`{near}` is never used, and `{name}` is not declared");
            Diagnostic::warning("unused-sprite", line.name.span, message)
        };
        problems.push(problem.suggest(near, [name]));
    }
}

/// Reports sprite types that no level can place and nothing creates. Such types are valid, but almost
/// certainly unintended.
fn report_sprites_that_never_exist(
    description: &Description,
    types: &[TypeInfo],
    mapping: &[SmallVec<[SpriteType; 4]>],
    program: &interactions::Program,
    problems: &mut Vec<Diagnostic>,
) {
    let mut there: BTreeSet<SpriteType> = mapping.iter().flatten().copied().collect();
    for traits in types.iter().map(|info| &info.traits) {
        there.extend(traits.stypes.iter().chain(&traits.ammo).chain(&traits.spawn_behind));
    }
    for summary in program.effects.iter().map(|info| &info.summary) {
        there.extend(summary.makes().into_iter().chain(summary.resource()));
    }
    for (_, line) in description.sprite_lines() {
        let name = &line.name.text;
        let found = types.iter().position(|info| info.name == *name).map(|at| SpriteType(at as u16));
        let Some(stype) = found.filter(|stype| types[stype.index()].leaf && !there.contains(stype)) else {
            continue;
        };
        if types[stype.index()].class.is_some() {
            let message = format!("`{name}` never exists: no level character places it and nothing makes it");
            let problem = Diagnostic::warning("never-there", line.name.span, message);
            // `wall` and `avatar` exist even if nothing declares them.
            let undeclared = types[..2]
                .iter()
                .map(|info| info.name.as_str())
                .filter(|known| !description.sprite_lines().iter().any(|(_, line)| line.name.text == *known));
            let problem =
                problem.help(format!("add `{name}` to the LevelMapping, or remove it and its rules"));
            problems.push(problem.suggest(name, undeclared));
        }
    }
}

/// Reports types that levels can place and that have no image, although a parameter selects among their
/// images.
fn report_missing_images(
    types: &[TypeInfo],
    mapping: &[SmallVec<[SpriteType; 4]>],
    problems: &mut Vec<Diagnostic>,
) {
    let placed: BTreeSet<SpriteType> = mapping.iter().flatten().copied().collect();
    let mut reported = BTreeSet::new();
    for info in placed.iter().map(|stype| &types[stype.index()]) {
        let Some(span) = info.lacks_image.filter(|span| reported.insert(*span)) else { continue };
        problems.push(missing_image(&info.name, span));
    }
}

/// Returns the diagnostic for a sprite that has no image, although its `autotiling` or `randomtiling` selects
/// one.
pub(crate) fn missing_image(name: &str, span: Span) -> Diagnostic {
    let message =
        format!("`{name}` has no image that its tiling could choose, so the reference engine crashes");
    let problem = Diagnostic::error("missing-image", span, message);
    problem.help("add `img=` and the name of an image, or remove `autotiling` and `randomtiling`")
}

/// Returns the mapped non-ASCII characters, each with an ASCII code that the game does not use.
fn aliases(description: &Description, problems: &mut Vec<Diagnostic>) -> Aliases {
    let used: BTreeSet<char> = description.mapping.iter().map(|line| line.symbol).collect();
    let defaults = ['w', 'A'];
    let free = (1..b' ').chain([127]).chain(b'!'..=b'~').filter(|&code| {
        let character = char::from(code);
        !used.contains(&character) && !defaults.contains(&character)
    });
    let mut free = free.collect::<Vec<u8>>().into_iter();
    let mut found = Aliases::default();
    for line in description.mapping.iter().filter(|line| !line.symbol.is_ascii()) {
        let unit = line.symbol.encode_utf16(&mut [0; 2])[0];
        if found.of_unit(unit).is_some() {
            continue;
        }
        let Some(code) = free.next() else {
            let message = "the LevelMapping has more characters than can be distinguished";
            let problem = Diagnostic::error("too-large", line.span, message);
            problems.push(problem.help("use fewer characters, or split the game into several games"));
            break;
        };
        found.0.push(Alias { code, unit, character: line.symbol });
    }
    found
}

/// Returns the sprites that each level character places, by character code, and the characters mapped to an
/// undeclared sprite. A level that uses such a character does not load.
fn mapping(
    description: &Description,
    names: Names<'_>,
    aliases: &Aliases,
    problems: &mut Vec<Diagnostic>,
) -> (Vec<SmallVec<[SpriteType; 4]>>, BTreeSet<u8>) {
    let mut unusable = BTreeSet::new();
    let mut mapping = vec![SmallVec::new(); 128];
    // Every game that does not map these characters itself has these mappings (`spec/01` §1.7).
    mapping[usize::from(b'w')] = SmallVec::from_slice(&[SpriteType(0)]);
    mapping[usize::from(b'A')] = SmallVec::from_slice(&[SpriteType(1)]);
    let mut seen = BTreeSet::new();
    for line in &description.mapping {
        if !seen.insert(line.symbol) {
            let message = format!("`{}` is mapped twice", line.symbol);
            let problem = Diagnostic::error("duplicate-mapping", line.span, message);
            problems.push(problem.help("remove one of the two lines, or use a different character"));
        }
        let code = match u8::try_from(line.symbol) {
            Ok(code @ ..128) => Some(code),
            _ => aliases.of_unit(line.symbol.encode_utf16(&mut [0; 2])[0]),
        };
        if let Some(code) = code {
            unusable.remove(&code);
            if line.names.iter().any(|name| names.find(&name.text).is_none()) {
                unusable.insert(code);
            }
        }
        let types = line.names.iter().filter_map(|name| {
            let stype = names.resolve(name, problems)?;
            // The reference crashes when it creates a sprite of a type without a class.
            names.instantiable(stype, name, problems);
            Some(stype)
        });
        let types = types.collect();
        if let Some(code) = code {
            mapping[usize::from(code)] = types;
        }
    }
    (mapping, unusable)
}

/// A lookup of sprite types by name, which reports unknown names.
#[derive(Clone, Copy)]
struct Names<'a> {
    types: &'a [TypeInfo],
}

/// The maximum number of subtypes listed in a message.
const SUBTYPES_SHOWN: usize = 8;

impl<'a> Names<'a> {
    fn find(self, name: &str) -> Option<SpriteType> {
        self.types.iter().position(|info| info.name == name).map(|at| SpriteType(at as u16))
    }

    fn resolve(self, name: &Word, problems: &mut Vec<Diagnostic>) -> Option<SpriteType> {
        let found = self.find(&name.text);
        if found.is_none() {
            problems.push(self.unknown(name, &[], problems.len()));
        }
        found
    }

    /// Returns the sprite type named by a parameter's value or by one entry in that value. Reports an undeclared name,
    /// and returns `None` for it.
    fn resolve_value(self, param: &Param, name: &Word, problems: &mut Vec<Diagnostic>) -> Option<SpriteType> {
        let found = self.find(&name.text);
        if found.is_none() {
            let problem = self.unknown(name, &[], problems.len());
            problems.push(match params::is_name(&name.text) {
                true => problem,
                false => Diagnostic {
                    fix: None,
                    ..problem.help(format!("write `{}=` and the name of a sprite", param.key.text))
                },
            });
        }
        found
    }

    /// Returns the diagnostic for a name that is neither a sprite name nor in `others`. `found` is the number
    /// of earlier problems.
    fn unknown(self, name: &Word, others: &[&str], found: usize) -> Diagnostic {
        let message = format!("no sprite named `{}`", name.text);
        let problem = Diagnostic::error("unknown-sprite", name.span, message).label("not in the SpriteSet");
        if found >= MAX_PROBLEMS {
            return problem;
        }
        let known = || self.types.iter().map(|info| info.name.as_str()).chain(others.iter().copied());
        match nearest(&name.text, known()) {
            Some(near) => problem.suggest(&name.text, [near]),
            None if known().count() <= 12 => {
                let all: Vec<&str> = known().collect();
                problem.help(format!("declare it in the SpriteSet, or use one of {}", all.join(", ")))
            }
            None => problem.help("declare it in the SpriteSet"),
        }
    }

    /// Returns up to [`SUBTYPES_SHOWN`] of a type's leaf subtypes that have a class.
    fn subtypes(self, stype: SpriteType) -> Vec<&'a str> {
        let leaves = self.types.iter().filter(|info| info.leaf && info.class.is_some());
        let below = leaves.filter(|info| info.path.contains(&stype));
        below.map(|info| info.name.as_str()).take(SUBTYPES_SHOWN).collect()
    }

    /// Returns `true` if sprites of the type can be created. Otherwise, reports a problem.
    fn instantiable(self, stype: SpriteType, name: &Word, problems: &mut Vec<Diagnostic>) -> bool {
        let info = &self.types[stype.index()];
        if info.class.is_none() {
            let shown = if problems.len() < MAX_PROBLEMS { SUBTYPES_SHOWN } else { 1 };
            let of_it =
                self.types.iter().filter(|other| other.path.contains(&stype) && other.class.is_some());
            let below: Vec<&str> = of_it.map(|other| other.name.as_str()).take(shown).collect();
            // If no subtype has a class, the problem has already been reported for the type's own line.
            if !below.is_empty() {
                let message = format!("`{}` has no class, so no sprite of this type can exist", name.text);
                let problem = Diagnostic::error("no-class", name.span, message);
                problems.push(problem.help(format!("use one of its subtypes: {}", below.join(", "))));
            }
        } else if info.order.is_none() {
            let apart = if info.is_like_avatar() { ", apart from the player's avatar" } else { "" };
            let message = format!("`{}` is a parent type: its sprites are never updated{apart}", name.text);
            let problem = Diagnostic::warning("parent-sprite", name.span, message);
            let below = self.subtypes(stype).join(", ");
            problems.push(problem.help(format!("use one of its subtypes: {below}")));
        }
        info.class.is_some()
    }
}

/// Returns the position of every type in `tree`.
fn ranks(tree: &[SpriteType], types: usize) -> Box<[u16]> {
    let mut rank = vec![NOT_IN_TREE; types];
    for (at, stype) in tree.iter().enumerate().rev() {
        rank[stype.index()] = at as u16;
    }
    rank.into()
}
