//! Scenes: who wants what, where, and the nouns for the roles of kernels.

use super::kernel::{Casting, Kernel};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// A scene: a file of `generators/scenes/`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Scene {
    #[serde(skip)]
    pub(crate) name: String,
    /// The story in one sentence: who is where and wants what.
    pub(crate) story: String,
    /// The colours of floor and walls.
    pub(crate) floor_color: String,
    pub(crate) wall_color: String,
    /// Titles of games that are set here.
    pub(crate) titles: Vec<String>,
    /// The nouns for the roles; several, separated by commas, where games may differ.
    pub(crate) cast: BTreeMap<String, String>,
    /// The kernels that this scene goes with, each with the nouns that are others there.
    pub(crate) kernels: BTreeMap<String, BTreeMap<String, String>>,
}

impl Scene {
    /// The scenes of this crate, by name.
    pub(crate) fn all() -> &'static [Scene] {
        static ALL: OnceLock<Vec<Scene>> = OnceLock::new();
        ALL.get_or_init(|| {
            let files = super::content::files(&super::content::SCENES);
            files
                .map(|(name, text)| Scene::read(name, text).unwrap_or_else(|fault| panic!("{fault}")))
                .collect()
        })
    }

    fn read(name: &str, text: &str) -> Result<Scene, String> {
        let scene: Scene = toml::from_str(text).map_err(|error| format!("scene {name}: {error}"))?;
        Ok(Scene { name: name.to_owned(), ..scene })
    }

    /// A scene whose nouns are the names of the kernel's types.
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
            kernels: BTreeMap::from([(kernel.name.clone(), BTreeMap::new())]),
        }
    }

    /// The scenes that a kernel can be set in.
    pub(crate) fn of(kernel: &Kernel) -> impl Iterator<Item = &'static Scene> {
        Scene::all().iter().filter(|scene| scene.fits(kernel))
    }

    /// Tests whether the scene names the kernel and has a noun for each of its roles.
    pub(crate) fn fits(&self, kernel: &Kernel) -> bool {
        let roles =
            kernel.roles.values().chain(kernel.variants.iter().flat_map(|variant| variant.roles.values()));
        let has_noun = |casting: &Casting| match casting {
            Casting::Role(role) => self.nouns(role, &kernel.name).is_some(),
            Casting::State { .. } => true,
        };
        self.kernels.contains_key(&kernel.name) && roles.into_iter().all(has_noun)
    }

    /// The nouns for a role in games of this kernel.
    pub(crate) fn nouns(&self, role: &str, kernel: &str) -> Option<Vec<&str>> {
        let own = self.kernels.get(kernel).and_then(|own| own.get(role));
        let nouns = own.or_else(|| self.cast.get(role))?;
        Some(nouns.split(',').map(str::trim).collect())
    }
}
