//! The table of nouns for invented games, with their predicates and settings. `fiction/mod.rs` chooses from it.

use super::predicates::Predicates;
use crate::invention::mechanic::Body;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

const NOUNS: &str = include_str!("../../../mechanics/nouns.txt");
const PLACES: &str = include_str!("../../../mechanics/places.toml");

/// The kind of object that a noun denotes. Each kind is a heading in the noun table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Form {
    Mover,
    Item,
    Crate,
    Solid,
    Ground,
    Flash,
}

impl Form {
    fn of_heading(heading: &str) -> Option<Form> {
        Some(match heading.split(' ').next()? {
            "Movers" | "Movers:" | "Movers," => Form::Mover,
            "Items" | "Items:" | "Items," => Form::Item,
            "Crates" | "Crates:" | "Crates," => Form::Crate,
            "Solid" => Form::Solid,
            "Ground" | "Ground:" | "Ground," => Form::Ground,
            "Flashes" | "Flashes:" => Form::Flash,
            _ => return None,
        })
    }

    fn fits(self, body: Body, needs: Predicates) -> bool {
        match body {
            Body::Mover => self == Form::Mover,
            Body::Item => self == Form::Item,
            Body::Crate => self == Form::Crate,
            Body::Solid => matches!(self, Form::Solid | Form::Ground),
            Body::Ground if needs.includes(Predicates::portable()) => self == Form::Item,
            Body::Ground => self == Form::Ground,
            Body::Flash => self == Form::Flash,
        }
    }
}

/// A noun in the table.
#[derive(Clone, Debug)]
pub(crate) struct Noun {
    pub(crate) word: &'static str,
    pub(crate) predicates: Predicates,
    form: Form,
    places: Vec<&'static str>,
}

impl Noun {
    /// Returns the noun table.
    pub(crate) fn all() -> &'static [Noun] {
        static ALL: OnceLock<Vec<Noun>> = OnceLock::new();
        ALL.get_or_init(|| {
            let mut form = Form::Mover;
            let mut nouns = Vec::new();
            for line in NOUNS.lines().map(str::trim).filter(|line| !line.is_empty()) {
                match line.strip_prefix("# ") {
                    Some(heading) => form = Form::of_heading(heading).unwrap_or(form),
                    None => {
                        nouns.push(Noun::read(line, form).unwrap_or_else(|fault| panic!("{line}: {fault}")))
                    }
                }
            }
            nouns
        })
    }

    fn read(line: &'static str, form: Form) -> Result<Noun, String> {
        let parts: Vec<&str> = line.split('|').map(str::trim).collect();
        let [word, predicates, places] = parts[..] else {
            return Err("not `noun | predicates | places`".to_owned());
        };
        let mut predicates: Predicates = predicates.parse()?;
        if form == Form::Item {
            predicates = predicates.with(Predicates::portable());
        }
        Ok(Noun { word, form, predicates, places: places.split_whitespace().collect() })
    }

    /// Returns `true` if the noun fits a type with the given body and required predicates. Water and holes can be
    /// solid. An object that can be carried only one at a time has the body of ground, but the noun of an item.
    pub(crate) fn fits(&self, body: Body, needs: Predicates) -> bool {
        self.predicates.includes(needs) && self.form.fits(body, needs)
    }

    /// Returns `true` if any noun [fits](Noun::fits).
    pub(crate) fn exists(body: Body, needs: Predicates) -> bool {
        static KINDS: OnceLock<Vec<(Form, Predicates)>> = OnceLock::new();
        let kinds = KINDS.get_or_init(|| {
            let kinds = Noun::all().iter().map(|noun| (noun.form, noun.predicates));
            kinds.collect::<BTreeSet<_>>().into_iter().collect()
        });
        kinds.iter().any(|(form, predicates)| predicates.includes(needs) && form.fits(body, needs))
    }

    /// Returns `true` if the noun's object occurs in the given setting.
    pub(crate) fn is_at(&self, place: &str) -> bool {
        self.places.iter().any(|other| *other == place || *other == "any")
    }
}

/// A kind of game setting.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Place {
    pub(crate) floor: String,
    pub(crate) walls: Vec<String>,
    pub(crate) floor_color: String,
    pub(crate) wall_color: String,
    pub(crate) heroes: Vec<String>,
    /// The proper names for settings of this kind.
    pub(crate) names: Vec<String>,
    /// The sentences that explain why the main character is in the setting, with the placeholders `<hero>` and
    /// `<name>`.
    pub(crate) reasons: Vec<String>,
}

/// The texts that surround the nouns.
#[derive(Debug, Deserialize)]
pub(crate) struct Words {
    titles: Titles,
    #[serde(flatten)]
    pub(crate) places: BTreeMap<String, Place>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Titles {
    patterns: Vec<String>,
}

impl Words {
    /// Returns the texts in the file.
    pub(crate) fn get() -> &'static Words {
        static ALL: OnceLock<Words> = OnceLock::new();
        ALL.get_or_init(|| toml::from_str(PLACES).unwrap_or_else(|fault| panic!("places.toml: {fault}")))
    }

    /// Returns the title patterns.
    pub(crate) fn titles(&self) -> &[String] {
        &self.titles.patterns
    }
}
