//! The sprite types that a type's parameters refer to. These are the types that its sprites create, follow,
//! spend, are collected as, or lead to.

use super::Names;
use super::params::{Expected, Value, convert, missing_name, wrong_type};
use crate::diagnostic::{Diagnostic, Span};
use crate::limits::MAX_LIST;
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;
use crate::syntax::{Param, Word};
use smallvec::SmallVec;

/// The sprite types that a type's parameters refer to. [`SpriteType::NONE`] stands for an undeclared name.
pub(super) struct References {
    pub(super) stypes: SmallVec<[SpriteType; 2]>,
    pub(super) ammo: SmallVec<[SpriteType; 2]>,
    pub(super) behind: Option<SpriteType>,
    pub(super) resource: Option<SpriteType>,
    /// `true` if the type lacks a parameter without which the reference cannot create its sprites.
    pub(super) incomplete: bool,
}

/// A type with its parameters, including inherited ones.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    pub(super) name: &'a str,
    pub(super) span: Span,
    pub(super) class: SpriteClass,
    pub(super) params: &'a [&'a Param],
    pub(super) leaf: bool,
}

pub(super) fn references(
    sprite: Subject<'_>,
    names: Names<'_>,
    problems: &mut Vec<Diagnostic>,
) -> References {
    use SpriteClass as C;
    let class = sprite.class;
    let shoots = class.is_a(C::ShootAvatar) || class == C::WizardAvatar;
    // The parameter that names the types that a class creates or follows.
    let (key, many) = if class == C::SpawnPointMultiSprite {
        ("stypes", true)
    } else if class == C::BomberRandomMissile {
        ("stypeMissile", true)
    } else if class.is_a(C::AlternateChaser) {
        ("stype1", true)
    } else {
        ("stype", shoots)
    };
    let stypes = sprite.named(key, many, names, problems);
    if key == "stype1" {
        sprite.named("stype2", true, names, problems);
    }
    let ammo = sprite.named("ammo", class.is_a(C::ShootAvatar), names, problems);
    let behind = sprite.named("spawnBehind", false, names, problems).first().copied();
    let resource = sprite.named("resource_name", false, names, problems).first().copied();

    let produces = class.is_a(C::SpawnPoint) || class == C::SpawnPointMultiSprite;
    let follows = class.is_a(C::Chaser) || class.is_a(C::AlternateChaser) || class == C::PathChaser;
    let needs = shoots || produces || follows || matches!(class, C::FlakAvatar | C::Portal);
    let missing = needs && stypes.is_empty();
    let nameless = class == C::ResourcePack && resource.is_none();
    for (key, missing) in [(key, missing), ("resource_name", nameless)] {
        if missing && sprite.leaf && sprite.given(key).is_none() {
            let subject = format!("{} `{}`", class.name(), sprite.name);
            problems.push(missing_name(&subject, sprite.span, key, "a sprite"));
        }
    }
    if shoots || produces || matches!(class, C::FlakAvatar | C::Spreader) {
        sprite.makes(key, &stypes, names, problems);
    }
    // A spawn point that lacks a type fails only when it spawns.
    let incomplete = nameless || missing && (many || !produces);
    References { stypes, ammo, behind, resource, incomplete }
}

impl Subject<'_> {
    fn given(&self, key: &str) -> Option<&Param> {
        self.params.iter().copied().find(|param| param.key.text == key)
    }

    /// Returns the types that a parameter refers to: one type or, if `many` is `true`, a comma-separated
    /// list.
    fn named(
        &self,
        key: &str,
        many: bool,
        names: Names<'_>,
        problems: &mut Vec<Diagnostic>,
    ) -> SmallVec<[SpriteType; 2]> {
        let mut found = SmallVec::new();
        let Some(param) = self.given(key).filter(|_| self.class.parameters().contains(&key)) else {
            return found;
        };
        let text = param.value.text.as_str();
        if !matches!(convert(key, text), Value::Text(_)) {
            let problem = wrong_type(param, Expected::Text);
            let help =
                format!("`{text}` is read as a constant or a number: give the sprite a different name");
            problems.push(if names.find(text).is_some() { problem.help(help) } else { problem });
            return found;
        }
        if !many && text.contains(',') {
            let message =
                format!("`{key}` of {} takes the name of one sprite, not `{text}`", self.class.name());
            let problem = Diagnostic::error("wrong-type", param.value.span, message);
            problems.push(problem.help(format!("write `{key}=` and one of the names")));
            found.push(SpriteType::NONE);
            return found;
        }
        // Trailing commas do not separate entries.
        let list = text.trim_end_matches(',');
        let count = list.split(',').count();
        if count > MAX_LIST {
            let message = format!("`{key}` lists {count} sprites; the limit is {MAX_LIST}");
            problems
                .push(Diagnostic::error("too-large", param.value.span, message).help("list fewer sprites"));
            return found;
        }
        if list != text {
            let message = format!("`{key}` ends with a comma");
            let problem = Diagnostic::error("wrong-type", param.value.span, message).help("remove the comma");
            problems.push(problem.replace(param.value.span, list));
        }
        let mut start = param.value.span.start;
        for text in list.split(',').filter(|_| !list.is_empty()) {
            let span = Span::new(start, start + text.len());
            start += text.len() + 1;
            let word = Word { text: text.to_owned(), span };
            found.push(names.resolve_value(param, &word, problems).unwrap_or(SpriteType::NONE));
        }
        found
    }

    /// Checks the types that sprites of the type create.
    fn makes(&self, key: &str, stypes: &[SpriteType], names: Names<'_>, problems: &mut Vec<Diagnostic>) {
        use SpriteClass as C;
        let dies = "the reference engine crashes on that";
        let Some(param) = self.given(key) else {
            if self.class == C::Spreader && self.leaf {
                let message = format!("without `stype=`, `{}` would spread into its own type", self.name);
                let problem = Diagnostic::error("spawns-itself", self.span, message);
                problems.push(problem.help(format!("{dies}; choose a different type with `stype=`")));
            }
            return;
        };
        for &stype in stypes.iter().filter(|stype| **stype != SpriteType::NONE) {
            let word = Word { text: names.types[stype.index()].name.clone(), span: param.value.span };
            names.instantiable(stype, &word, problems);
            let iterates = self.class.is_a(C::SpawnPoint)
                || matches!(self.class, C::Spreader | C::SpawnPointMultiSprite);
            if word.text == self.name && iterates {
                let message = format!("`{}` would make sprites of its own type", self.name);
                let problem = Diagnostic::error("spawns-itself", param.value.span, message);
                problems.push(problem.help(format!("{dies}; have it make a different type")));
            }
        }
    }
}
