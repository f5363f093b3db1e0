//! Composition of a game's rules and texts from three sources: a kernel (a hand-written game design), the kernel's
//! numbers, and a scene, which supplies the nouns.

use super::course::{self, Board, Space, Traits};
use super::habits::{Edge, Habits};
use super::ways;
use crate::GenerateError;
use crate::games::{english, palette};
use crate::kernels::file::kernel::{Casting, Kernel, Slot};
use crate::kernels::file::template;
use crate::kernels::words::dressing::{Palette, picture_lines};
use crate::kernels::words::naming;
use crate::kernels::words::phrase;
use crate::kernels::words::phrase::Nouns;
use crate::kernels::words::scene::Scene;
use base::{Sampler, Seed};
use engine::Description;
use engine::syntax::{self, MappingLine, Param, SpriteLine};
use std::collections::{BTreeMap, BTreeSet};

/// The choices that turn a kernel (a hand-written game design) into a game.
#[derive(Clone, Debug)]
pub(crate) struct Choices<'a> {
    pub(crate) kernel: &'static Kernel,
    /// The indices of the game's variants.
    pub(crate) variants: &'a [usize],
    pub(crate) values: &'a [u32],
    pub(crate) scene: &'static Scene,
    pub(crate) nouns: Seed,
    pub(crate) habits: Habits,
    /// The number of ticks after which the game is lost; `None` if there is no limit, or if survival is the goal.
    pub(crate) time: Option<u32>,
}

/// A game without levels: its rules, nouns and texts, and the building blocks for its levels.
#[derive(Clone, Debug)]
pub(crate) struct Composed {
    pub(crate) description: Description,
    pub(crate) title: String,
    pub(crate) summary: String,
    pub(crate) goal: String,
    pub(crate) course: Course,
}

/// The maps for a game's levels, and the level characters to use.
#[derive(Clone, Debug)]
pub struct Course {
    kernel: &'static Kernel,
    values: Vec<u32>,
    traits: Traits,
    space: Space,
    edge: Edge,
    nouns: Nouns,
    /// The types' characters, by type name in the kernel.
    symbols: BTreeMap<String, char>,
}

/// A level of a course (a game's levels in order of difficulty), before anyone has played it.
#[derive(Clone, Debug, PartialEq)]
pub struct CourseLevel {
    /// The level, in the game's characters.
    pub text: String,
    /// The level's purpose in the course, such as introducing the rules.
    pub slot: Slot,
    /// A sentence about the problem that the level poses to the player.
    pub asks: String,
}

impl Course {
    /// Builds a level for a position in the course: draws one of the position's maps, lays it out and places the
    /// sprites. Cost: about a millisecond.
    ///
    /// # Errors
    /// Returns an error if no layout of the map has room for everything.
    pub fn level(&self, slot: Slot, seed: Seed) -> Result<CourseLevel, GenerateError> {
        let plans: Vec<_> = self.kernel.levels.iter().filter(|level| level.slot == slot).collect();
        let plan = *seed.child("plan", 0).sampler().choose(&plans);
        let is_present = |stype: &str| stype == "wall" || self.traits.present.contains(stype);
        let map = plan.map(&self.values).map_err(GenerateError::Unsuitable)?.without_bare_ends(is_present);
        let board = course::lay_out(&map, self.kernel, &self.traits, self.space, seed).ok_or_else(|| {
            GenerateError::Unlucky(format!("no layout has room for a map of slot {slot:?}"))
        })?;
        let board = match self.edge {
            Edge::Walls => board,
            Edge::Screen => board.without_ring(),
        };
        let asks = phrase::fill(&plan.asks, &self.nouns).map_err(GenerateError::Unsuitable)?;
        Ok(CourseLevel { text: self.text(&board), slot, asks: phrase::sentence(&asks) })
    }

    fn text(&self, board: &Board) -> String {
        let row = |y: usize| -> String {
            let symbol = |x: usize| board.at((x, y)).map_or('.', |stype| self.symbols[stype]);
            (0..board.columns).map(symbol).collect()
        };
        (0..board.rows).map(|y| row(y) + "\n").collect()
    }
}

impl Choices<'_> {
    /// Composes the game from the choices.
    ///
    /// # Errors
    /// Returns an error if the rules cannot be parsed with these numbers, or if the texts mention unknown types. Both
    /// indicate a bug in a kernel or a scene.
    pub(crate) fn compose(&self) -> Result<Composed, GenerateError> {
        let (description, problems) = syntax::parse(&self.rules());
        if let Some(problem) = problems.first() {
            let message = format!("kernel {}: {}", self.kernel.name, problem.message);
            return Err(GenerateError::Unsuitable(message));
        }
        let mut description = without_lone_groups(description);
        let edge = self.habits.apply(&mut description);
        ways::set_obstacles(&mut description);
        let mut sampler = self.nouns.sampler();
        let nouns = self.cast(&mut sampler)?;
        let traits = traits(&description);
        self.color(&mut description.sprites, &nouns);
        self.picture(&mut description.sprites, &nouns);
        let declared = description.sprite_lines().iter().map(|(_, line)| line.name.text.clone()).collect();
        let sampler_of_names = &mut self.nouns.child("names", 0).sampler();
        let names = naming::names(&nouns, self.roles(), declared, sampler_of_names);
        let symbols = self.map_symbols(&mut description, &names);
        if let Some(line) = description.sprites.iter_mut().find(|line| line.name.text == "wall") {
            line.params.push(Param::new("img", format!("wall/{}", nouns["wall"])));
            line.params.push(Param::new("color", &self.scene.wall_color));
        }
        let description = description.renamed(&names);
        let fill = |text: &str| phrase::fill(text, &nouns).map_err(GenerateError::Unsuitable);
        let sentence = |text: &str| Ok::<String, GenerateError>(phrase::sentence(&fill(text)?));
        let can_be_said = |title: &&String| phrase::title(&self.fill_numbers(title), &nouns).is_ok();
        let titles = self.kernel.titles.iter().chain(&self.scene.titles);
        let titles: Vec<&String> = titles.filter(can_be_said).collect();
        let title = self.fill_numbers(titles[sampler.below(titles.len())]);
        let title = phrase::title(&title, &nouns).map_err(GenerateError::Unsuitable)?;
        let variants = self.variants.iter().map(|&variant| &self.kernel.variants[variant].fact);
        let facts = self.kernel.facts.iter().chain(variants);
        let sentences = [&self.scene.story, &self.kernel.dilemma].into_iter().chain(facts);
        let summary =
            sentences.map(|text| sentence(&self.fill_numbers(text))).collect::<Result<Vec<_>, _>>()?;
        Ok(Composed {
            title,
            summary: summary.join(" "),
            goal: sentence(&self.fill_numbers(&self.kernel.goal))?,
            course: Course {
                kernel: self.kernel,
                values: self.values.to_vec(),
                traits,
                space: self.habits.space,
                edge,
                nouns: nouns.clone(),
                symbols,
            },
            description,
        })
    }

    /// Inserts the kernel's numbers into a text.
    fn fill_numbers(&self, text: &str) -> String {
        template::filled(text, &self.kernel.numbers, self.values)
    }

    /// Returns the rules as text, with the type names of the kernel.
    fn rules(&self) -> String {
        let mut text = self.kernel.text(self.variants, self.values);
        match self.time {
            Some(time) if !text.contains("Timeout") => {
                text.push_str(&format!("        Timeout limit={time} win=False\n"));
            }
            Some(_) => {}
            None => text = text.split_inclusive('\n').filter(|line| !is_limit(line)).collect(),
        }
        text
    }

    /// Returns all types in the game, each with the source of its noun.
    fn roles(&self) -> impl Iterator<Item = (&String, &Casting)> {
        let variants = self.variants.iter().map(|&variant| &self.kernel.variants[variant].roles);
        self.kernel.roles.iter().chain(variants.flatten())
    }

    /// Assigns a unique noun to every type.
    fn cast(&self, sampler: &mut Sampler) -> Result<Nouns, GenerateError> {
        let mut nouns = Nouns::new();
        // The nouns of roles that only states refer to, and that no type has by itself.
        let mut shared = Nouns::new();
        let mut draw = |role: &str, taken: &Nouns| {
            let mut free = self.scene.nouns(role, &self.kernel.name).unwrap_or_default();
            free.retain(|noun| !taken.values().any(|taken| taken == noun));
            let missing =
                || format!("scene {} has no noun left for {role} of {}", self.scene.name, self.kernel.name);
            if free.is_empty() {
                return Err(GenerateError::Unsuitable(missing()));
            }
            // Prefer nouns of one word, as authors of small games do: `tarpaulin` rather than `canvas sheet`.
            let is_word = |noun: &&str| !noun.contains(|letter: char| letter.is_ascii_uppercase());
            if free.iter().any(is_word) {
                free.retain(is_word);
            }
            Ok((*sampler.choose(&free)).to_owned())
        };
        for role in ["floor", "wall"] {
            nouns.insert(role.to_owned(), draw(role, &nouns)?);
        }
        for (stype, casting) in self.roles() {
            if let Casting::Role(role) = casting {
                nouns.insert(stype.clone(), draw(role, &nouns)?);
            }
        }
        for (stype, casting) in self.roles() {
            if let Casting::State { of, adjective } = casting {
                if !nouns.contains_key(of) && !shared.contains_key(of) {
                    shared.insert(of.clone(), draw(of, &nouns)?);
                }
                let noun = nouns.get(of).unwrap_or_else(|| &shared[of]);
                let name = format!("{adjective}{}", english::capital(noun));
                nouns.insert(stype.clone(), name);
            }
        }
        Ok(nouns)
    }

    /// Assigns a colour to every type.
    fn color(&self, lines: &mut [SpriteLine], nouns: &Nouns) {
        let roles: BTreeMap<&str, &Casting> =
            self.roles().map(|(stype, role)| (stype.as_str(), role)).collect();
        let ground = [self.scene.floor_color.as_str(), self.scene.wall_color.as_str()];
        Palette::new(ground, nouns, self.habits.hero).color_all(lines, &roles);
    }

    /// Sets an image for every type: `img=role/noun` or, for a state of another type, `img=role/adjective/noun`.
    fn picture(&self, lines: &mut [SpriteLine], nouns: &Nouns) {
        let roles: BTreeMap<&str, &Casting> =
            self.roles().map(|(stype, role)| (stype.as_str(), role)).collect();
        picture_lines(lines, &roles, nouns);
    }

    /// Writes the LevelMapping: floor, walls and the avatar, followed by all other types that levels place.
    fn map_symbols(
        &self,
        description: &mut Description,
        names: &BTreeMap<String, String>,
    ) -> BTreeMap<String, char> {
        let maps = self.kernel.levels.iter().filter_map(|level| level.map(self.values).ok());
        let placed: BTreeSet<String> = maps
            .flat_map(|map| map.types().map(str::to_owned).collect::<Vec<_>>())
            .chain(self.kernel.legend.values().cloned())
            .chain(self.kernel.divider.clone())
            .collect();
        let own: Vec<String> =
            description.sprite_lines().into_iter().map(|(_, line)| line.name.text.clone()).collect();
        let interactions = description.interactions.clone();
        let mentioned: BTreeSet<&str> = interactions
            .iter()
            .flat_map(|line| line.second.iter().chain([&line.first]))
            .map(|word| word.text.as_str())
            .collect();
        // The language maps a type called `avatar` to `A`. In some kernels, a group of avatar types has that name.
        let hero = match names["hero"].as_str() {
            name if name != "avatar" && own.iter().all(|own| own != "avatar") => palette::symbol(name, &[]),
            _ => 'A',
        };
        let mut symbols = BTreeMap::from([("wall".to_owned(), 'w'), ("hero".to_owned(), hero)]);
        let mut taken = vec!['.', 'w', hero];
        description.mapping.clear();
        let mut line = |symbol, names: &[&str]| {
            let names = names.iter().map(|&name| name.into()).collect();
            description.mapping.push(MappingLine { symbol, names, ..MappingLine::default() });
        };
        line('.', &["floor"]);
        line('w', &["wall"]);
        line(hero, &["floor", "hero"]);
        for stype in own
            .iter()
            .filter(|stype| placed.contains(*stype) && !symbols.contains_key(*stype))
            .collect::<Vec<_>>()
        {
            let symbol = palette::symbol(&names[stype], &taken);
            taken.push(symbol);
            // A type that no rule moves or removes would always cover the floor below, so it is placed without floor.
            match mentioned.contains(stype.as_str()) {
                true => line(symbol, &["floor", stype]),
                false => line(symbol, &[stype]),
            }
            symbols.insert(stype.clone(), symbol);
        }
        symbols
    }
}

/// Returns the same rules with each single-type group replaced with its type. Such groups remain when a form removes
/// the other types. Groups with a class or parameters are preserved.
fn without_lone_groups(mut description: Description) -> Description {
    let lone = |line: &SpriteLine| line.class.is_none() && line.params.is_empty() && line.children.len() == 1;
    let groups: BTreeMap<String, String> = description
        .sprites
        .iter()
        .filter(|line| lone(line))
        .map(|line| (line.name.text.clone(), line.children[0].name.text.clone()))
        .filter(|(group, only)| {
            !description.interactions.iter().any(|line| {
                let tells =
                    |name: &String| line.second.iter().chain([&line.first]).any(|word| word.text == *name);
                tells(group) && tells(only)
            })
        })
        .collect();
    for line in &mut description.sprites {
        if groups.contains_key(&line.name.text) {
            *line = line.children.remove(0);
        }
    }
    description.renamed(&groups)
}

/// Returns `true` if a rule sets a tick limit after which the game is lost.
fn is_limit(line: &str) -> bool {
    line.contains("Timeout") && line.contains("win=False")
}

/// Extracts from the rules the traits that level builders need.
fn traits(description: &Description) -> Traits {
    let mut traits = Traits::default();
    for (_, line) in description.sprite_lines() {
        traits.present.insert(line.name.text.clone());
        let param = |key: &str| {
            line.params.iter().find(|param| param.key.text == key).map(|param| param.value.text.as_str())
        };
        if line.class.as_ref().is_some_and(|class| class.text == "Missile") {
            let upright = matches!(param("orientation"), Some("UP" | "DOWN"));
            traits.lanes.insert(line.name.text.clone(), upright);
        }
    }
    for line in &description.interactions {
        let hero = |name: &str| matches!(name, "hero" | "avatar");
        let partners = line.second.iter().map(|word| word.text.clone());
        match line.effect.text.as_str() {
            "stepBack" | "undoAll" if hero(&line.first.text) => traits.solid.extend(partners),
            "bounceForward" if line.second.iter().any(|word| hero(&word.text)) => {
                traits.solid.insert(line.first.text.clone());
            }
            "killSprite" | "killBoth" if hero(&line.first.text) => traits.deadly.extend(partners),
            _ => {}
        }
    }
    traits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_of_one_is_that_one_unless_a_line_has_both() {
        let game = |rule: &str| {
            format!(
                "BasicGame\n    SpriteSet\n        foe >\n            cat > Chaser stype=hero\n        hero > MovingAvatar\n    InteractionSet\n        {rule}\n    TerminationSet\n        SpriteCounter stype=foe win=True\n"
            )
        };
        let dissolved = |rule: &str| syntax::print_bare(&without_lone_groups(syntax::parse(&game(rule)).0));
        let text = dissolved("hero foe > killSprite");
        assert!(text.contains("hero cat > killSprite") && text.contains("stype=cat"), "{text}");
        assert!(!text.contains("foe"), "{text}");
        assert!(dissolved("foe cat > stepBack").contains("foe cat > stepBack"));
    }
}
