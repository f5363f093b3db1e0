//! Colours and images for types, according to their nouns and roles.

use super::hues;
use super::phrase::Nouns;
use super::vocabulary;
use crate::games::palette;
use crate::kernels::file::kernel::Casting;
use engine::syntax::{Param, SpriteLine};
use std::collections::BTreeMap;

/// The colours assigned so far.
pub(crate) struct Palette<'a> {
    /// The colours of floor and walls.
    ground: [&'a str; 2],
    nouns: &'a Nouns,
    hero: &'static str,
    taken: Vec<String>,
    /// The colours assigned so far, by type. For a state, the key is the type or role to which the state belongs.
    given: BTreeMap<String, String>,
}

impl<'a> Palette<'a> {
    /// Creates a palette for types with the given nouns, on floor and walls with the given colours.
    pub(crate) fn new(ground: [&'a str; 2], nouns: &'a Nouns, hero: &'static str) -> Palette<'a> {
        let taken = ground.iter().chain([&hero]).map(|color| (*color).to_owned()).collect();
        Palette { ground, nouns, hero, taken, given: BTreeMap::new() }
    }

    /// Assigns a colour to every type.
    pub(crate) fn color_all(&mut self, lines: &mut [SpriteLine], roles: &BTreeMap<&str, &Casting>) {
        // A state takes the colour of the type to which it belongs, whose line may come later.
        self.color(lines, roles, false);
        self.color(lines, roles, true);
    }

    fn color(&mut self, lines: &mut [SpriteLine], roles: &BTreeMap<&str, &Casting>, states: bool) {
        for line in lines {
            let name = line.name.text.as_str();
            let color = match (name, roles.get(name)) {
                ("floor", _) => (!states).then(|| self.ground[0].to_owned()),
                ("wall", _) | (_, None) => None,
                (_, Some(Casting::Role(role))) => (!states).then(|| self.draw(name, role)),
                (_, Some(Casting::State { of, adjective })) => states.then(|| {
                    let own = adjective.to_uppercase();
                    match self.given.get(of) {
                        _ if palette::COLORS.contains(&own.as_str()) => own,
                        Some(color) => color.clone(),
                        None => self.draw(of, of),
                    }
                }),
            };
            line.params.extend(color.map(|color| Param::new("color", color)));
            self.color(&mut line.children, roles, states);
        }
    }

    /// Draws a colour for a type. The avatar gets the palette's avatar colour, a noun with a natural colour gets that
    /// colour, and any other type gets a colour that suits its role.
    fn draw(&mut self, name: &str, role: &str) -> String {
        let mut natural = self.nouns.get(name).into_iter().flat_map(|noun| hues::natural(noun));
        let free = |color: &&str| !self.taken.iter().any(|taken| taken == color);
        let color = match role {
            "hero" if !self.ground.contains(&self.hero) => self.hero,
            _ => natural.find(free).unwrap_or_else(|| vocabulary::color(role, &self.taken)),
        };
        let color = color.to_owned();
        self.taken.push(color.clone());
        self.given.insert(name.to_owned(), color.clone());
        color
    }
}

/// Sets an image for every type: `img=role/noun` or, for a state of another type, `img=role/adjective/noun`.
pub(crate) fn picture_lines(lines: &mut [SpriteLine], roles: &BTreeMap<&str, &Casting>, nouns: &Nouns) {
    for line in lines {
        let name = line.name.text.as_str();
        let noun = nouns.get(name);
        let picture = match (roles.get(name), noun) {
            (None, Some(noun)) if name == "floor" => Some(format!("floor/{noun}")),
            (Some(Casting::Role(role)), Some(noun)) => Some(format!("{role}/{noun}")),
            (Some(Casting::State { of, adjective }), Some(noun)) => {
                let role = match roles.get(of.as_str()) {
                    Some(Casting::Role(role)) => role,
                    _ => of,
                };
                // A state's noun consists of an adjective and the object's noun.
                let thing = noun.strip_prefix(adjective.as_str()).unwrap_or(noun);
                let mut letters = thing.chars();
                let first = letters.next().map(|letter| letter.to_ascii_lowercase());
                let thing: String = first.into_iter().chain(letters).collect();
                Some(format!("{role}/{adjective}/{thing}"))
            }
            _ => None,
        };
        line.params.extend(picture.map(|picture| Param::new("img", picture)));
        picture_lines(&mut line.children, roles, nouns);
    }
}
