//! The SpriteSet: registry, inheritance and update order (`spec/01` §1.6).

use super::params::{Value, convert, set_trait, takes, unknown_parameter};
use super::references::{Subject, references};
use super::{Names, Policy, ranks};
use crate::diagnostic::{Diagnostic, Span};
use crate::limits::{MAX_PARAMETERS, MAX_REACH};
use crate::meanings::Place;
use crate::rules::class::SpriteClass;
use crate::rules::traits::Traits;
use crate::rules::{Action, SpriteType, TypeInfo};
use crate::syntax::{Description, Param, SpriteLine, Word};
use std::collections::BTreeSet;

/// A line with its inherited class and parameters.
struct Resolved<'a> {
    line: Option<&'a SpriteLine>,
    name: String,
    /// The names from the root to the type, inclusive.
    path: Vec<String>,
    /// The descendants in pre-order, without the type itself.
    descendants: Vec<String>,
    class: Option<Word>,
    params: Vec<&'a Param>,
}

/// Returns the compiled types, in registry order, and the drawing order.
pub(super) fn types(
    description: &Description,
    policy: Policy,
    problems: &mut Vec<Diagnostic>,
) -> (Vec<TypeInfo>, Vec<SpriteType>) {
    let mut resolved = Vec::new();
    inherit(&description.sprites, &None, &[], &[], &mut resolved, problems);
    duplicates(&resolved, problems);
    classes(&description.sprites, None, problems);
    let leaves: Vec<String> = resolved
        .iter()
        .filter(|sprite| sprite.descendants.is_empty())
        .map(|sprite| sprite.name.clone())
        .collect();

    // `wall` and `avatar` come first in every registry, declared or not. A name keeps its position, and if it
    // is defined several times, the last definition counts. Valid files define it once.
    let mut registry: Vec<Resolved<'_>> =
        vec![built_in("wall", "Immovable"), built_in("avatar", "MovingAvatar")];
    for sprite in resolved {
        match registry.iter_mut().find(|known| known.name == sprite.name) {
            Some(known) => *known = sprite,
            None => registry.push(sprite),
        }
    }

    let mut rejected = Rejected::default();
    let mut types: Vec<TypeInfo> =
        registry.iter().map(|sprite| type_info(sprite, &registry, policy, &mut rejected, problems)).collect();
    rejected.by_all(problems);
    let order = update_order(&leaves, &types);
    for (at, stype) in order.iter().enumerate() {
        types[stype.index()].order = Some(at as u16);
    }
    for at in 0..types.len() {
        if let Some(class) = types[at].class {
            let Resolved { line, name, params, descendants, .. } = &registry[at];
            let span = line.map(|line| line.name.span).unwrap_or_default();
            let subject = Subject { name, span, class, params, leaf: descendants.is_empty() };
            let found = references(subject, Names { types: &types }, problems);
            types[at].incomplete = found.incomplete;
            let traits = &mut types[at].traits;
            (traits.stypes, traits.ammo) = (found.stypes, found.ammo);
            traits.spawn_behind = found.behind;
            traits.resource = found.resource.unwrap_or(SpriteType(at as u16));
        }
    }
    (types, order)
}

/// Parameters that a class does not accept. A parent line passes its parameters on to children of several
/// classes, so a parameter is a mistake only if none of these classes accepts it.
#[derive(Default)]
struct Rejected<'a> {
    refused: Vec<(SpriteClass, &'a Param)>,
    taken: BTreeSet<Span>,
}

impl Rejected<'_> {
    fn by_all(self, problems: &mut Vec<Diagnostic>) {
        let mut reported = self.taken;
        for (class, param) in self.refused {
            if reported.insert(param.key.span) {
                problems.push(unknown_parameter(class, param, problems.len()));
            }
        }
    }
}

fn built_in(name: &str, class: &str) -> Resolved<'static> {
    Resolved {
        line: None,
        name: name.to_owned(),
        path: vec![name.to_owned()],
        descendants: Vec::new(),
        class: Some(class.into()),
        params: Vec::new(),
    }
}

/// Resolves the class. An inherited class overrides the written class, but the children inherit the written
/// class (`spec/01` §1.6.2).
fn inherit<'a>(
    lines: &'a [SpriteLine],
    class: &Option<Word>,
    params: &[&'a Param],
    path: &[String],
    out: &mut Vec<Resolved<'a>>,
    problems: &mut Vec<Diagnostic>,
) {
    for line in lines {
        let mut own_params: Vec<&Param> = params.to_vec();
        for param in &line.params {
            own_params.retain(|inherited| inherited.key.text != param.key.text);
            if own_params.len() == MAX_PARAMETERS {
                let message = format!(
                    "a sprite has at most {MAX_PARAMETERS} parameters, including inherited parameters"
                );
                let problem = Diagnostic::error("too-large", param.key.span, message);
                problems.push(
                    problem.help("no class has that many parameters: remove the unintended parameters"),
                );
                break;
            }
            own_params.push(param);
        }
        let mut own_path = path.to_vec();
        own_path.push(line.name.text.clone());
        let at = out.len();
        out.push(Resolved {
            line: Some(line),
            name: line.name.text.clone(),
            path: own_path.clone(),
            descendants: Vec::new(),
            class: class.clone().or_else(|| line.class.clone()),
            params: own_params.clone(),
        });
        let passed_on = line.class.clone().or_else(|| class.clone());
        inherit(&line.children, &passed_on, &own_params, &own_path, out, problems);
        out[at].descendants = out[at + 1..].iter().map(|sprite| sprite.name.clone()).collect();
    }
}

/// Reports sprites without a class, but only once for a parent and all its subtypes. Also reports classes
/// that an inherited class overrides.
fn classes(lines: &[SpriteLine], inherited: Option<(&Word, &str)>, problems: &mut Vec<Diagnostic>) {
    for line in lines {
        let name = line.name.text.as_str();
        match (&line.class, inherited) {
            (Some(own), Some((class, parent))) if line.children.is_empty() => {
                let message = match own.text == class.text {
                    true => format!("`{name}` is a subtype of `{parent}`, so it inherits that type's class"),
                    false => {
                        let (class, own) = (&class.text, &own.text);
                        format!("`{name}` is a subtype of `{parent}`: its class is {class}, not {own}")
                    }
                };
                let problem = match loses(line, class) {
                    true => Diagnostic::error("ignored-class", own.span, message),
                    false => Diagnostic::warning("ignored-class", own.span, message),
                };
                let help = "remove the class; to make it a separate type instead, indent the line less, like";
                let problem = problem.help(format!("{help} `{parent}`"));
                problems.push(match own.text == class.text {
                    true => problem.remove(own.span, &own.text),
                    false => problem,
                });
            }
            (None, None) if !has_class_below(line) => {
                let message = match line.children[..] {
                    [] => format!("`{name}` has no class"),
                    _ => format!("neither `{name}` nor its subtypes have a class"),
                };
                let problem = Diagnostic::error("no-class", line.name.span, message);
                let help = "write a class after the `>`, such as Immovable, Missile or MovingAvatar, or indent the line below a parent";
                problems.push(problem.help(help));
                continue;
            }
            _ => {}
        }
        let passed_on = line.class.as_ref().map(|class| (class, name));
        classes(&line.children, passed_on.or(inherited), problems);
    }
}

/// Returns `true` if a line needs its own class, but the inherited class overrides it.
fn loses(line: &SpriteLine, inherited: &Word) -> bool {
    let Some(inherited) = SpriteClass::from_name(&inherited.text) else { return false };
    let lost = |param: &Param| !takes(inherited, &param.key.text) && is_of_own_class(line, param);
    let own = line.class.as_ref().and_then(|own| SpriteClass::from_name(&own.text));
    own.is_some_and(|own| own.is_avatar() && !inherited.is_avatar()) || line.params.iter().any(lost)
}

/// Returns `true` if a parameter on a line without subtypes belongs to the line's own class, even if that
/// class is overridden.
fn is_of_own_class(line: &SpriteLine, param: &Param) -> bool {
    let own = line.class.as_ref().and_then(|own| SpriteClass::from_name(&own.text));
    line.children.is_empty() && own.is_some_and(|own| takes(own, &param.key.text))
}

fn has_class_below(line: &SpriteLine) -> bool {
    line.children.iter().any(|child| child.class.is_some() || has_class_below(child))
}

fn duplicates(resolved: &[Resolved<'_>], problems: &mut Vec<Diagnostic>) {
    for (at, sprite) in resolved.iter().enumerate() {
        let Some(line) = sprite.line else { continue };
        if resolved[..at].iter().any(|other| other.name == sprite.name) {
            let message = format!("`{}` is declared twice", sprite.name);
            let problem = Diagnostic::error("duplicate-sprite", line.name.span, message);
            problems.push(problem.help("remove one of the two lines, or choose a different name"));
        }
        if sprite.name.eq_ignore_ascii_case("EOS") || sprite.name.eq_ignore_ascii_case("TIME") {
            let message = format!("`{}` is a reserved word in interactions", sprite.name);
            problems.push(
                Diagnostic::error("reserved-name", line.name.span, message).help("choose another name"),
            );
        }
    }
}

fn type_info<'a>(
    sprite: &Resolved<'a>,
    registry: &[Resolved<'a>],
    policy: Policy,
    rejected: &mut Rejected<'a>,
    problems: &mut Vec<Diagnostic>,
) -> TypeInfo {
    let id = |name: &String| {
        let at = registry.iter().position(|other| other.name == *name);
        SpriteType(at.expect("every line is registered") as u16)
    };
    let path: Box<[SpriteType]> = sprite.path.iter().map(id).collect();
    let mut tree: Vec<SpriteType> = sprite.path.iter().map(id).collect();
    for descendant in sprite.descendants.iter().map(id) {
        if !tree.contains(&descendant) {
            tree.push(descendant);
        }
    }
    let tree: Box<[SpriteType]> = tree.into();
    let class = sprite.class.as_ref().and_then(|word| class_named(word, problems));
    let mut traits = Traits::of_class(class.unwrap_or(SpriteClass::Passive));
    if sprite.line.is_none() && sprite.name == "wall" {
        traits.solid = true;
    }
    let mut unknown_parameters = 0;
    if let Some(class) = class {
        for param in &sprite.params {
            if !takes(class, &param.key.text) {
                unknown_parameters += 1;
                // The overridden class has already been reported.
                if !sprite.line.is_some_and(|line| is_of_own_class(line, param)) {
                    rejected.refused.push((class, param));
                }
                continue;
            }
            match set_trait(class, &mut traits, param) {
                Err(problem) => problems.push(problem),
                Ok(()) => drop(rejected.taken.insert(param.key.span)),
            }
        }
    }
    for (key, factor) in [("wMult", traits.width_factor), ("hMult", traits.height_factor)] {
        if !(factor > 0.0 && factor <= f64::from(MAX_REACH)) {
            let given = sprite.params.iter().find(|param| param.key.text == key);
            let span = given.map(|param| param.value.span).unwrap_or_default();
            let message = format!("`{key}` must be a number of cells above 0 and at most {}", MAX_REACH);
            let problem = Diagnostic::error("bad-parameter", span, message);
            let problem = problem.help(format!("leave it out to get `{key}=1`"));
            problems.push(match given {
                Some(given) => problem.remove(given.span(), key),
                None => problem,
            });
        }
    }
    traits.settle();
    let singleton = |param: &Param| {
        (param.key.text == "singleton").then(|| param.value.text.eq_ignore_ascii_case("true"))
    };
    let scales = [traits.width_factor, traits.height_factor] != [1.0, 1.0];
    let unknown_parameters = if policy == Policy::Reference { unknown_parameters } else { 0 };
    let actions = match class.map(SpriteClass::actions) {
        None | Some([]) => &[Action::Nil],
        Some(actions) => actions,
    };
    TypeInfo {
        name: sprite.name.clone(),
        class,
        resource_limit: if class == Some(SpriteClass::Resource) { traits.limit } else { 0 },
        traits,
        rank: ranks(&tree, registry.len()),
        path,
        tree,
        order: None,
        singleton: sprite.line.and_then(|line| line.params.iter().rev().find_map(singleton)) == Some(true),
        leaf: sprite.descendants.is_empty(),
        counted: false,
        given_speed: false,
        lacks_image: lacks_image(&sprite.params),
        incomplete: false,
        unknown_parameters,
        first_differs: scales || unknown_parameters > 0 || class == Some(SpriteClass::OngoingTurningAvatar),
        keys: actions.iter().fold(0, |keys, &action| keys | 1 << action as u8),
        actions,
        ground_aware: class.is_some_and(SpriteClass::is_ground_aware),
    }
}

/// Returns the span of a parameter that selects an image, if the sprite has no images (`spec/02` §2.3).
fn lacks_image(params: &[&Param]) -> Option<Span> {
    let chooses = |param: &Param| match (param.key.text.as_str(), convert(&param.key.text, &param.value.text))
    {
        ("autotiling", Value::Bool(chooses)) => chooses,
        ("randomtiling", Value::Int(chance)) => chance >= 0,
        ("randomtiling", Value::Double(chance)) => chance >= 0.0,
        _ => false,
    };
    // A value that parses as anything other than text is dropped.
    let is_image = |param: &Param| {
        let names = ["img", "orientedImg"].contains(&param.key.text.as_str());
        names && matches!(convert(&param.key.text, &param.value.text), Value::Text(_))
    };
    let chooser = params.iter().find(|param| chooses(param))?;
    (!params.iter().any(|param| is_image(param))).then(|| chooser.span())
}

fn class_named(word: &Word, problems: &mut Vec<Diagnostic>) -> Option<SpriteClass> {
    let found = SpriteClass::from_name(&word.text);
    if found.is_none() {
        let message = format!("no sprite class named `{}`", word.text);
        let problem = Diagnostic::error("unknown-class", word.span, message);
        let problem = problem.help("see `arcade docs sprites` for all classes");
        let classes = SpriteClass::ALL.iter().map(|class| class.name());
        problems.push(problem.mean_after(problems.len(), Place::Class, &word.text, classes));
    }
    found
}

/// Returns the drawing order: `wall` first, then the leaves in file order, and `avatar` last. Updates run in
/// reverse drawing order (`spec/01` §1.6.5).
fn update_order(leaves: &[String], types: &[TypeInfo]) -> Vec<SpriteType> {
    let named =
        |name: &String| types.iter().position(|info| info.name == *name).map(|at| SpriteType(at as u16));
    let mut order = vec![SpriteType(0)];
    for leaf in leaves.iter().filter_map(named) {
        order.retain(|&other| other != leaf);
        order.push(leaf);
    }
    order.retain(|&other| other != SpriteType(1));
    order.push(SpriteType(1));
    order
}
