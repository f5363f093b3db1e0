//! Kernels. A kernel is a hand-written game design: a small set of coupled rules around one dilemma, with the maps of
//! its levels.
//!
//! A kernel is a file in `generators/kernels/`. The file contains VGDL rules whose names do not depend on a theme, and
//! the role of every type. For each of five positions in the sequence of levels, it also contains the maps that pose
//! the dilemma. `docs/reference/kernels.md` is the manual.

use super::form::Form;
use super::map::Map;
use super::template::{Numbers, Template};
use crate::games::Kind;
use itertools::Itertools;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::iter;
use std::sync::OnceLock;

/// A kernel (a hand-written game design) whose numbers and nouns have not been drawn yet.
#[derive(Debug)]
pub(crate) struct Kernel {
    pub(crate) name: String,
    /// The name of the kernel's form; `None` for the unmodified kernel.
    pub(crate) form: Option<String>,
    pub(crate) kind: Kind,
    /// The name of a similar kernel. Games from the two kernels count as games from the same kernel when a set is
    /// balanced.
    pub(crate) like: Option<String>,
    /// A sentence that describes the whole game, with placeholders such as `<type>` for nouns.
    pub(crate) dilemma: String,
    pub(crate) goal: String,
    pub(crate) facts: Vec<String>,
    pub(crate) titles: Vec<String>,
    /// The type that divides rooms in place of walls.
    pub(crate) divider: Option<String>,
    pub(crate) rules: Sections,
    pub(crate) roles: BTreeMap<String, Casting>,
    pub(crate) pieces: BTreeMap<String, Vec<String>>,
    pub(crate) legend: BTreeMap<char, String>,
    pub(crate) levels: Vec<LevelPlan>,
    pub(crate) variants: Vec<Variant>,
    pub(crate) numbers: Numbers,
    /// The types that maps may name although they are missing from this form.
    absent: Vec<String>,
    /// The kernel's modified forms, each as a separate kernel.
    forms: Vec<Kernel>,
}

/// A game's sections without the LevelMapping, as lines indented as in the kernel's file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sections {
    pub(crate) sprites: Template,
    pub(crate) interactions: Template,
    pub(crate) terminations: Template,
}

/// The source of a type's noun.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
pub(crate) enum Casting {
    /// The noun for the given role in a scene, which is the theme's list of nouns.
    Role(String),
    /// A different state of another type.
    State {
        /// The other type, or a role that no type has by itself.
        of: String,
        /// The adjective that precedes the noun of `of`.
        adjective: String,
    },
}

impl Casting {
    /// Returns the role, or the type of which this type is a state.
    pub(crate) fn role(&self) -> &str {
        match self {
            Casting::Role(role) | Casting::State { of: role, .. } => role,
        }
    }
}

base::named_enum! {
    /// A level's purpose in a course, which is a game's sequence of five levels.
    pub enum Slot {
        /// The level introduces the game's trick in a small and safe setting.
        Introduce = "introduce",
        /// The level repeats the game's trick in a setting where mistakes are costly.
        Confirm = "confirm",
        /// The level combines the game's trick with a second mechanic.
        Combine = "combine",
        /// The level puts a twist on the familiar trick.
        Twist = "twist",
        /// The level requires everything, with little slack.
        Exam = "exam",
    }
}

/// The map of a level, and a sentence about the problem that the level poses to the player.
#[derive(Debug)]
pub(crate) struct LevelPlan {
    pub(crate) slot: Slot,
    pub(crate) asks: String,
    map: Template,
}

/// Additional rules that deepen the dilemma in some games.
#[derive(Debug)]
pub(crate) struct Variant {
    pub(crate) name: String,
    pub(crate) fact: String,
    /// Interactions to insert before the kernel's interactions.
    pub(crate) first: Template,
    pub(crate) rules: Sections,
    pub(crate) roles: BTreeMap<String, Casting>,
}

/// An error in a kernel file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("kernel {kernel}: {message}")]
pub(crate) struct KernelError {
    kernel: String,
    message: String,
}

/// A kernel file as written.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct File {
    pub(crate) kind: Kind,
    pub(crate) like: Option<String>,
    pub(crate) dilemma: String,
    pub(crate) goal: String,
    #[serde(default)]
    pub(crate) facts: Vec<String>,
    pub(crate) titles: Vec<String>,
    pub(crate) divider: Option<String>,
    pub(crate) rules: String,
    /// The rules of the unmodified kernel, if the file describes one of its forms. Maps use the numbers introduced in
    /// these rules.
    #[serde(skip)]
    pub(crate) whole_rules: String,
    pub(crate) roles: BTreeMap<String, Casting>,
    #[serde(default)]
    pub(crate) pieces: BTreeMap<String, String>,
    #[serde(default)]
    pub(crate) legend: BTreeMap<char, String>,
    pub(crate) level: Vec<LevelFile>,
    #[serde(default)]
    pub(crate) variant: Vec<VariantFile>,
    #[serde(default)]
    pub(crate) form: Vec<Form>,
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LevelFile {
    slot: Slot,
    pub(crate) asks: String,
    /// The only form that has this level; `None` if all forms have it.
    pub(crate) form: Option<String>,
    map: String,
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct VariantFile {
    name: String,
    pub(crate) fact: String,
    #[serde(default)]
    sprites: String,
    #[serde(default)]
    first: String,
    #[serde(default)]
    interactions: String,
    #[serde(default)]
    terminations: String,
    #[serde(default)]
    pub(crate) roles: BTreeMap<String, Casting>,
}

impl VariantFile {
    /// Returns the variant's rule texts.
    pub(crate) fn parts(&self) -> [&str; 4] {
        [&self.sprites, &self.first, &self.interactions, &self.terminations]
    }
}

impl Kernel {
    /// Returns the built-in kernels, sorted by name.
    pub(crate) fn all() -> &'static [Kernel] {
        static ALL: OnceLock<Vec<Kernel>> = OnceLock::new();
        ALL.get_or_init(|| {
            let files = super::content::files(&super::content::KERNELS);
            files
                .map(|(name, text)| Kernel::read(name, text).unwrap_or_else(|fault| panic!("{fault}")))
                .collect()
        })
    }

    /// Reads a kernel file.
    ///
    /// # Errors
    /// Returns the first error. Examples are errors in the format, in a number or in a map, and a slot (position in the
    /// sequence of levels) without a level.
    pub(crate) fn read(name: &str, text: &str) -> Result<Kernel, KernelError> {
        let file: File = toml::from_str(text)
            .map_err(|error| KernelError { kernel: name.to_owned(), message: error.to_string() })?;
        if let Some(twice) = file.form.iter().map(|form| &form.name).duplicates().next() {
            return Err(KernelError {
                kernel: name.to_owned(),
                message: format!("two forms are called `{twice}`"),
            });
        }
        let forms = file.form.iter().map(|form| Kernel::of_file(name, form.applied(&file), Some(form)));
        let forms = forms.collect::<Result<_, _>>()?;
        let of_no_form = |level: &LevelFile| level.form.is_none();
        if let Some(stray) = file
            .level
            .iter()
            .filter_map(|level| level.form.as_ref())
            .find(|name| file.form.iter().all(|form| form.name != **name))
        {
            return Err(KernelError {
                kernel: name.to_owned(),
                message: format!("a level is for the form `{stray}`, which does not exist"),
            });
        }
        let mut own = file;
        own.level.retain(of_no_form);
        Ok(Kernel { forms, ..Kernel::of_file(name, own, None)? })
    }

    /// Reads a kernel or, if `form` is given, one of its forms from the texts in its file.
    fn of_file(name: &str, file: File, form: Option<&Form>) -> Result<Kernel, KernelError> {
        let form_name = form.map(|form| form.name.clone());
        let shown = form_name.as_ref().map_or_else(|| name.to_owned(), |form| format!("{name}, form {form}"));
        let fail = |message: String| KernelError { kernel: shown.clone(), message };
        let mut numbers = Numbers::default();
        let mut template = |text: &str| Template::read(text, &mut numbers).map_err(fail);
        let [sprites, interactions, terminations] = split(&file.rules).map_err(fail)?;
        let rules = Sections {
            sprites: template(&sprites)?,
            interactions: template(&interactions)?,
            terminations: template(&terminations)?,
        };
        numbers.complete(&file.whole_rules);
        let mut template = |text: &str| Template::read(text, &mut numbers).map_err(fail);
        let variants = file.variant.into_iter().map(|variant| {
            Ok(Variant {
                name: variant.name,
                fact: variant.fact,
                first: template(&variant.first)?,
                rules: Sections {
                    sprites: template(&variant.sprites)?,
                    interactions: template(&variant.interactions)?,
                    terminations: template(&variant.terminations)?,
                },
                roles: variant.roles,
            })
        });
        let variants = variants.collect::<Result<_, _>>()?;
        let levels = file
            .level
            .into_iter()
            .map(|level| Ok(LevelPlan { slot: level.slot, asks: level.asks, map: template(&level.map)? }));
        let levels: Vec<LevelPlan> = levels.collect::<Result<_, _>>()?;
        let mut roles = file.roles;
        roles.remove("avatar");
        roles.entry("hero".to_owned()).or_insert_with(|| Casting::Role("hero".to_owned()));
        let rows = |(name, piece): (String, String)| {
            let rows: Vec<String> =
                piece.lines().filter(|row| !row.trim().is_empty()).map(str::to_owned).collect();
            (name, rows)
        };
        let kernel = Kernel {
            name: name.to_owned(),
            form: form_name,
            kind: file.kind,
            like: file.like,
            dilemma: file.dilemma,
            goal: file.goal,
            facts: file.facts,
            titles: file.titles,
            divider: file.divider,
            rules,
            roles,
            pieces: file.pieces.into_iter().map(rows).collect(),
            legend: file.legend,
            levels,
            variants,
            numbers,
            absent: form.map_or_else(Vec::new, |form| form.absent().to_vec()),
            forms: Vec::new(),
        };
        kernel.check().map_err(fail)?;
        Ok(kernel)
    }

    /// Checks that every slot (position in the sequence of levels) has a level, and that maps and pieces can be drawn.
    fn check(&self) -> Result<(), String> {
        for slot in Slot::ALL {
            if !self.levels.iter().any(|level| level.slot == slot) {
                return Err(format!("no level of slot {slot:?}"));
            }
        }
        for (name, rows) in &self.pieces {
            let width = rows.first().map_or(0, |row| row.chars().count());
            if width == 0 || rows.iter().any(|row| row.chars().count() != width) {
                return Err(format!("the rows of piece `{name}` differ in length"));
            }
            let unknown = rows
                .iter()
                .flat_map(|row| row.chars())
                .find(|&symbol| symbol != '.' && symbol != '#' && !self.legend.contains_key(&symbol));
            if let Some(symbol) = unknown {
                return Err(format!("`{symbol}` of piece `{name}` is not in the legend"));
            }
        }
        let least: Vec<u32> = self.numbers.0.iter().map(|number| number.least).collect();
        for level in &self.levels {
            let map = level.map(&least)?;
            for room in &map.rooms {
                if let Some(piece) =
                    room.piece.as_ref().filter(|piece| !self.pieces.contains_key(&piece.name))
                {
                    return Err(format!("there is no piece `{}`", piece.name));
                }
            }
            if let Some(stype) = map.types().find(|stype| !self.knows(stype)) {
                return Err(format!("a map of slot {:?} places `{stype}`, which is not a type", level.slot));
            }
        }
        if let Some(stype) = self.legend.values().find(|stype| !self.knows(stype)) {
            return Err(format!("the legend uses `{stype}`, which is not a type"));
        }
        Ok(())
    }

    /// Returns the unmodified kernel, followed by its other forms.
    pub(crate) fn in_all_forms(&self) -> impl Iterator<Item = &Kernel> {
        iter::once(self).chain(&self.forms)
    }

    /// Returns the rules as VGDL, including the given variants. The types have the names used in the kernel.
    pub(crate) fn text(&self, variants: &[usize], values: &[u32]) -> String {
        let variants: Vec<&Variant> = variants.iter().map(|&variant| &self.variants[variant]).collect();
        let mut text =
            "BasicGame\n    SpriteSet\n        floor > Immovable\n        wall > Immovable\n".to_owned();
        let mut add = |lines: &str| text.push_str(&indented(lines));
        add(&self.rules.sprites.fill(values));
        variants.iter().for_each(|variant| add(&variant.rules.sprites.fill(values)));
        // The characters for levels are chosen later, after the nouns.
        add("LevelMapping\n");
        add(". > floor\n");
        add("InteractionSet\n");
        variants.iter().for_each(|variant| add(&variant.first.fill(values)));
        add(&self.rules.interactions.fill(values));
        variants.iter().for_each(|variant| add(&variant.rules.interactions.fill(values)));
        add("TerminationSet\n");
        add(&self.rules.terminations.fill(values));
        variants.iter().for_each(|variant| add(&variant.rules.terminations.fill(values)));
        text
    }

    /// Returns `true` if the kernel or one of its variants declares the type, or if maps may name it although this form
    /// lacks it.
    pub(crate) fn knows(&self, stype: &str) -> bool {
        stype == "wall"
            || self.absent.iter().any(|absent| absent == stype)
            || self.roles.contains_key(stype)
            || self.variants.iter().any(|variant| variant.roles.contains_key(stype))
    }
}

impl LevelPlan {
    /// Returns the map, with the given values for its numbers.
    pub(crate) fn map(&self, values: &[u32]) -> Result<Map, String> {
        Map::read(&self.map.fill(values)).map_err(|fault| format!("slot {:?}: {fault}", self.slot))
    }
}

/// Indents the lines of a section below its name, whatever their indentation in the file.
fn indented(lines: &str) -> String {
    let depth = |line: &str| line.len() - line.trim_start().len();
    let least = lines.lines().filter(|line| !line.trim().is_empty()).map(depth).min().unwrap_or(0);
    let is_name = |line: &str| line.ends_with("Set") || line == "LevelMapping";
    let line = |line: &str| {
        let margin = if is_name(line) { 4 } else { 8 };
        format!("{}{}\n", " ".repeat(margin), &line[least..])
    };
    lines.lines().filter(|line| !line.trim().is_empty()).map(line).collect()
}

/// Splits rules at the section names.
fn split(rules: &str) -> Result<[String; 3], String> {
    const NAMES: [&str; 3] = ["SpriteSet", "InteractionSet", "TerminationSet"];
    let mut sections = [const { String::new() }; 3];
    let mut current = None;
    for line in rules.lines().filter(|line| !line.trim().is_empty() && !line.trim().starts_with('#')) {
        match NAMES.iter().position(|name| line.trim_end() == *name) {
            Some(section) => current = Some(section),
            None => {
                let section =
                    current.ok_or_else(|| format!("`{}` comes before the first section", line.trim()))?;
                sections[section].push_str(line.trim_end());
                sections[section].push('\n');
            }
        }
    }
    match sections.iter().position(String::is_empty) {
        Some(empty) => Err(format!("the rules have no {}", NAMES[empty])),
        None => Ok(sections),
    }
}
