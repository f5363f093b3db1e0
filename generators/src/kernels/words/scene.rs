//! Scenes, which are themes for games. A scene has a character, an aim and a setting, and nouns for the roles of sprite
//! types.

use crate::kernels::file::kernel::{Casting, Kernel};
use base::Sampler;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// A scene, which is a theme for games: a file in `generators/scenes/`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Scene {
    #[serde(skip)]
    pub(crate) name: String,
    /// The story in one sentence: a character, a setting and an aim.
    #[serde(default)]
    pub(crate) story: String,
    /// The colours of floor and walls.
    pub(crate) floor_color: String,
    pub(crate) wall_color: String,
    /// Title patterns for games in this scene.
    #[serde(default)]
    pub(crate) titles: Vec<String>,
    /// The nouns for the roles. Alternatives for different games are separated by commas.
    pub(crate) cast: BTreeMap<String, String>,
    /// The texts that surround the nouns in games with arbitrary rules; `None` if the scene lacks a noun for a role
    /// that types can play in such games.
    retelling: Option<Retelling>,
    /// The kernels that suit this scene, each with the nouns that differ for that kernel.
    #[serde(default)]
    pub(crate) kernels: BTreeMap<String, BTreeMap<String, String>>,
}

/// The setting and the title words for a rethemed game.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Retelling {
    /// The game's setting, including a preposition.
    pub(crate) place: String,
    /// Adjectives for titles, separated by commas.
    adjectives: String,
    /// Nouns for titles, separated by commas.
    nouns: String,
}

impl Retelling {
    /// Draws a title about the setting, the task or the avatar.
    pub(crate) fn title(&self, hero: &str, title_word: &str, sampler: &mut Sampler) -> String {
        let adjectives: Vec<&str> = separated(&self.adjectives).collect();
        let nouns: Vec<&str> = separated(&self.nouns).collect();
        let (adjective, noun) = (sampler.choose(&adjectives), sampler.choose(&nouns));
        match sampler.below(4) {
            0 | 1 => format!("The {adjective} {noun}"),
            2 => format!("{title_word} at the {adjective} {noun}"),
            _ => format!("The {hero}'s {title_word}"),
        }
    }
}

/// The scenes with a [`Retelling`], in a fixed order. Random draws depend on this order.
const OF_ANY_GAME: [&str; 12] = [
    "tidepool",
    "library",
    "beehive",
    "harbour",
    "cellar",
    "railyard",
    "observatory",
    "bakery",
    "glacier",
    "swamp",
    "theatre",
    "caravan",
];

impl Scene {
    /// Returns the built-in scenes, sorted by name.
    pub(crate) fn all() -> &'static [Scene] {
        static ALL: OnceLock<Vec<Scene>> = OnceLock::new();
        ALL.get_or_init(|| {
            let files = crate::kernels::file::content::files(&crate::kernels::file::content::SCENES);
            files
                .map(|(name, text)| Scene::read(name, text).unwrap_or_else(|fault| panic!("{fault}")))
                .collect()
        })
    }

    fn read(name: &str, text: &str) -> Result<Scene, String> {
        let scene: Scene = toml::from_str(text).map_err(|error| format!("scene {name}: {error}"))?;
        Ok(Scene { name: name.to_owned(), ..scene })
    }

    /// Returns a scene whose nouns are the kernel's type names.
    pub(crate) fn plain(kernel: &Kernel) -> Scene {
        let variants = kernel.variants.iter().flat_map(|variant| &variant.roles);
        let mut cast = BTreeMap::from([
            ("floor".to_owned(), "ground".to_owned()),
            ("wall".to_owned(), "rock".to_owned()),
        ]);
        for (stype, casting) in kernel.roles.iter().chain(variants) {
            let (role, noun) = match casting {
                Casting::Role(role) => (role, stype),
                Casting::State { of, .. } => (of, of),
            };
            let nouns = cast.entry(role.clone()).or_default();
            *nouns = if nouns.is_empty() { noun.clone() } else { format!("{nouns},{noun}") };
        }
        Scene {
            name: "plain".to_owned(),
            story: "A kernel without a scene".to_owned(),
            floor_color: "LIGHTGRAY".to_owned(),
            wall_color: "DARKGRAY".to_owned(),
            titles: Vec::new(),
            cast,
            retelling: None,
            kernels: BTreeMap::from([(kernel.name.clone(), BTreeMap::new())]),
        }
    }

    /// Returns the scenes that fit a kernel.
    pub(crate) fn of(kernel: &Kernel) -> impl Iterator<Item = &'static Scene> {
        Scene::all().iter().filter(|scene| scene.fits(kernel))
    }

    /// Returns `true` if the scene lists the kernel and has a noun for each of the kernel's roles.
    pub(crate) fn fits(&self, kernel: &Kernel) -> bool {
        let roles =
            kernel.roles.values().chain(kernel.variants.iter().flat_map(|variant| variant.roles.values()));
        let has_noun = |casting: &Casting| match casting {
            Casting::Role(role) => self.nouns(role, &kernel.name).is_some(),
            Casting::State { .. } => true,
        };
        self.kernels.contains_key(&kernel.name) && roles.into_iter().all(has_noun)
    }

    /// Returns the nouns for a role in a kernel's games.
    pub(crate) fn nouns(&self, role: &str, kernel: &str) -> Option<Vec<&str>> {
        let own = self.kernels.get(kernel).and_then(|own| own.get(role));
        let nouns = own.or_else(|| self.cast.get(role))?;
        Some(separated(nouns).collect())
    }

    /// Returns the scenes that fit any game, with the texts needed for a retelling.
    pub(crate) fn of_any_game() -> impl Iterator<Item = (&'static Scene, &'static Retelling)> {
        let scene = |name: &str| Scene::all().iter().find(|scene| scene.name == name);
        OF_ANY_GAME
            .iter()
            .filter_map(move |name| scene(name).and_then(|scene| Some((scene, scene.retelling.as_ref()?))))
    }

    /// Returns the nouns for a role, regardless of the kernel.
    pub(crate) fn nouns_of(&'static self, role: &str) -> Vec<&'static str> {
        let nouns = self.cast.get(role);
        debug_assert!(nouns.is_some(), "{} has no noun for {role}", self.name);
        nouns.map_or_else(Vec::new, |nouns| separated(nouns).collect())
    }

    /// Returns the nouns for all roles, regardless of the kernel.
    pub(crate) fn all_nouns(&self) -> impl Iterator<Item = &str> {
        self.cast.values().flat_map(|nouns| separated(nouns))
    }
}

/// Splits a comma-separated list.
fn separated(list: &str) -> impl Iterator<Item = &str> {
    list.split(',').map(str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn scenes_of_any_game_are_those_with_a_retelling() {
        let named = Scene::of_any_game().map(|(scene, _)| scene.name.as_str()).collect::<BTreeSet<_>>();
        let retelling = Scene::all().iter().filter(|scene| scene.retelling.is_some());
        assert_eq!(named, retelling.map(|scene| scene.name.as_str()).collect());
        assert_eq!(named.len(), OF_ANY_GAME.len());
    }

    /// A game can have types in any combination of roles. Each role therefore has its own nouns, all of which are valid
    /// names for sprite types in VGDL.
    #[test]
    fn no_noun_of_any_game_serves_two_roles() {
        let reserved = ["wall", "avatar", "eos", "time", "up", "down", "left", "right", "none", "nil"];
        let roles: BTreeSet<&String> =
            Scene::of_any_game().flat_map(|(scene, _)| scene.cast.keys()).collect();
        for (scene, _) in Scene::of_any_game() {
            assert!(scene.cast.keys().eq(roles.iter().copied()), "{}: other roles", scene.name);
            let nouns: Vec<&str> = scene.all_nouns().collect();
            let distinct: BTreeSet<&str> = nouns.iter().copied().collect();
            assert_eq!(distinct.len(), nouns.len(), "{}", scene.name);
            for noun in nouns {
                assert!(noun.chars().all(|c| c.is_ascii_alphabetic()), "{}: {noun}", scene.name);
                assert!(noun.starts_with(|c: char| c.is_ascii_lowercase()), "{}: {noun}", scene.name);
                assert!(!reserved.contains(&noun), "{}: {noun}", scene.name);
            }
        }
    }

    /// Sentences add an article to a noun or form its plural ("bear traps lie in wait"), so a plural noun would be
    /// ungrammatical. Only the nouns for floor, walls and rubble are used unchanged.
    #[test]
    fn nouns_of_any_game_are_singular() {
        let singular = |noun: &str| {
            !noun.ends_with('s')
                || noun == "lens"
                || ["ss", "us", "is", "as"].iter().any(|ending| noun.ends_with(ending))
        };
        for (scene, _) in Scene::of_any_game() {
            let nouns =
                scene.cast.iter().filter(|(role, _)| !["floor", "wall", "rubble"].contains(&role.as_str()));
            for (role, nouns) in nouns {
                assert!(separated(nouns).all(singular), "{}: {role} {nouns}", scene.name);
            }
        }
    }
}
