//! Renames a game's sprite types wherever their names are used.

use crate::rules::effects::{ParameterKind, effect_parameters};
use crate::syntax::{Description, Param, SpriteLine, Word};
use std::collections::BTreeMap;

impl Description {
    /// Returns the same game with renamed sprite types: each name that is a key in `names` becomes its value,
    /// in all sections. The names `wall` and `avatar` should not be renamed, because they have a built-in
    /// meaning. The lines keep their order, so the two games behave alike, including their state hashes.
    #[must_use]
    pub fn renamed(&self, names: &BTreeMap<String, String>) -> Description {
        let names = Names(names);
        let mut renamed = self.clone();
        for param in renamed.header.params.iter_mut().filter(|param| param.key.text == "obs") {
            names.rename(&mut param.value);
        }
        names.sprites(&mut renamed.sprites);
        for line in &mut renamed.mapping {
            line.names.iter_mut().for_each(|name| names.rename(name));
        }
        for line in &mut renamed.interactions {
            names.rename(&mut line.first);
            line.second.iter_mut().for_each(|word| names.rename(word));
            let planned = line.params.iter().filter(|param| param.key.text == "ftype");
            let keywords: Vec<&str> = std::iter::once(line.effect.text.as_str())
                .chain(planned.map(|param| param.value.text.as_str()))
                .collect();
            let kinds: Vec<_> = keywords.into_iter().flat_map(effect_parameters).collect();
            use ParameterKind as K;
            let is_named = |key: &str| {
                let is_name = |kind: &K| matches!(kind, K::Sprite | K::OptionalSprite | K::Sprites);
                key == "itype" || kinds.iter().any(|(name, kind)| *name == key && is_name(kind))
            };
            let named = line.params.iter_mut().filter(|param| is_named(&param.key.text));
            named.for_each(|param| names.rename(&mut param.value));
        }
        renamed.terminations.iter_mut().for_each(|line| names.params(&mut line.params));
        renamed
    }
}

/// The new names, by old name.
struct Names<'a>(&'a BTreeMap<String, String>);

impl Names<'_> {
    /// Renames each name in a comma-separated list.
    fn rename(&self, word: &mut Word) {
        let parts = word.text.split(',').map(|part| self.0.get(part).map_or(part, String::as_str));
        word.text = parts.collect::<Vec<_>>().join(",");
    }

    /// Renames sprite types in the parameters of sprites and terminations.
    fn params(&self, params: &mut [Param]) {
        for param in params {
            let key = param.key.text.as_str();
            if key.starts_with("stype") || ["ammo", "spawnBehind", "resource_name"].contains(&key) {
                self.rename(&mut param.value);
            }
        }
    }

    fn sprites(&self, lines: &mut [SpriteLine]) {
        for line in lines {
            self.rename(&mut line.name);
            self.params(&mut line.params);
            self.sprites(&mut line.children);
        }
    }
}
