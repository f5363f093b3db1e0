//! Structurally valid games from arbitrary decisions: sprite types of every class, rules with every effect and all their
//! parameters, terminations, and a small level in which the sprites meet.

use crate::choices::Choices;
use crate::vocabulary::{self, ValueKind};
use engine::syntax::{
    self, Description, Header, InteractionLine, MappingLine, Param, ParameterLine, SpriteLine,
    TerminationLine, Word,
};
use engine::{EFFECTS, ParameterKind, SPRITE_PARAMETERS, SpriteClass, TERMINATIONS, effect_parameters};

/// A game and one of its levels, as texts. Most such games load strictly, and the others load as in the
/// reference.
#[derive(Clone, Debug)]
pub struct AnyGame {
    /// The game's text.
    pub source: String,
    /// The level's text.
    pub level: String,
}

/// Creates the game that the decisions describe.
pub fn any_game(choices: &mut Choices<'_>) -> AnyGame {
    let leaves = vec![("wall".to_owned(), SpriteClass::Immovable)];
    let has_ground = choices.once_in(6);
    let counters = if choices.once_in(6) { 1 + choices.below(3) } else { 0 };
    let mut author = Author { choices, leaves, groups: Vec::new(), has_ground, counters };
    let mut sprites = author.forest(None, 0);
    let avatar = author.avatar();
    sprites.insert(author.choices.below(sprites.len() + 1), avatar);
    author.parameters(&mut sprites, None);
    author.weight(&mut sprites);
    let (mapping, symbols) = author.mapping();
    let mut description = Description {
        header: author.header(),
        interactions: author.interactions(),
        terminations: author.terminations(),
        mapping,
        sprites,
        has: [true; 4],
        ..Description::default()
    };
    author.space(&mut description);
    AnyGame { source: syntax::print(&description), level: author.level(&symbols) }
}

/// The maximum depth of the sprite type tree.
const DEPTH: usize = 3;
/// The maximum number of childless sprite types with the same parent.
const SIBLINGS: usize = 5;

struct Author<'c, 'b> {
    choices: &'c mut Choices<'b>,
    /// The types with sprites, each with its effective class.
    leaves: Vec<(String, SpriteClass)>,
    /// The types with subtypes.
    groups: Vec<String>,
    /// `true` if the lowest row is ground on which avatars and walkers can stand.
    has_ground: bool,
    /// The number of counters in the game.
    counters: usize,
}

impl Author<'_, '_> {
    /// Creates names and classes. Inherited classes are not written again.
    fn forest(&mut self, inherited: Option<SpriteClass>, depth: usize) -> Vec<SpriteLine> {
        let count = 1 + self.choices.below(SIBLINGS);
        let mut lines = Vec::new();
        for _ in 0..count {
            if depth + 1 < DEPTH && self.choices.once_in(5) {
                let name = format!("group{}", self.groups.len());
                self.groups.push(name.clone());
                let own = self.choices.once_in(2).then(|| self.class()).filter(|_| inherited.is_none());
                let children = self.forest(inherited.or(own), depth + 1);
                lines.push(line(name, own, children));
            } else {
                let name = format!("s{}", self.leaves.len());
                let own = if inherited.is_none() { Some(self.class()) } else { None };
                let class = inherited.or(own).expect("written or inherited");
                self.leaves.push((name.clone(), class));
                lines.push(line(name, own, Vec::new()));
            }
        }
        lines
    }

    /// Chooses a class. Avatar classes are rare.
    fn class(&mut self) -> SpriteClass {
        let avatars = self.choices.once_in(8);
        self.class_where(|class| class.is_avatar() == avatars)
    }

    fn class_where(&mut self, fits: impl Fn(SpriteClass) -> bool) -> SpriteClass {
        let fitting: Vec<SpriteClass> =
            SpriteClass::ALL.iter().copied().filter(|&class| fits(class)).collect();
        self.choices.pick(&fitting)
    }

    fn avatar(&mut self) -> SpriteLine {
        let jumps = |class: SpriteClass| class.is_a(SpriteClass::PlatformerAvatar);
        let has_ground = self.has_ground;
        let class = self.class_where(|class| class.is_avatar() && (!has_ground || jumps(class)));
        let name = if self.choices.once_in(4) { "hero" } else { "avatar" };
        self.leaves.push((name.to_owned(), class));
        line(name.to_owned(), Some(class), Vec::new())
    }

    /// Fills in the parameters, now that all names are known.
    fn parameters(&mut self, lines: &mut [SpriteLine], inherited: Option<SpriteClass>) {
        for line in lines {
            let written = line.class.as_ref().and_then(|word| SpriteClass::from_name(&word.text));
            let class = inherited.or(written);
            if line.children.is_empty() {
                line.params = self.references(class.expect("leaves have a class"), &line.name.text);
            }
            for _ in 0..self.choices.below(4) {
                let own = class.map_or(Vec::new(), SpriteClass::parameters);
                // A class has few parameters of its own, but they matter more.
                let key = if own.is_empty() || self.choices.once_in(2) {
                    self.choices.pick(SPRITE_PARAMETERS)
                } else {
                    self.choices.pick(&own)
                };
                if line.params.iter().any(|param| param.key.text == key) {
                    continue;
                }
                let kind = vocabulary::sprite_parameter(key).expect("every parameter has a kind");
                if let Some(value) = vocabulary::value(kind, self.choices) {
                    line.params.push(Param::new(key, value));
                    // Tiling chooses among images, so it needs an image.
                    let tiles = ["autotiling", "randomtiling"].contains(&key);
                    if tiles && !line.params.iter().any(|param| param.key.text == "img") {
                        line.params.push(Param::new("img", "dot"));
                    }
                } else if kind == ValueKind::Fixed {
                    let resource = matches!(class, Some(SpriteClass::Resource | SpriteClass::ResourcePack));
                    let avatar = class.is_some_and(SpriteClass::is_avatar);
                    let value = if key == "is_avatar" { avatar } else { resource };
                    line.params.extend(class.map(|_| Param::new(key, if value { "True" } else { "False" })));
                }
            }
            self.parameters(&mut line.children, class);
        }
    }

    /// Adds gravity to sprites that can stand, provided that there is ground.
    fn weight(&mut self, lines: &mut [SpriteLine]) {
        if !self.has_ground {
            return;
        }
        for line in lines {
            let found = self.leaves.iter().find(|(name, _)| *name == line.name.text);
            if found.is_some_and(|(_, class)| stands(*class)) {
                line.params
                    .retain(|param| !["physicstype", "gravity", "mass"].contains(&param.key.text.as_str()));
                let gravity = self.choices.pick(&["1", "3", "0.5"]);
                line.params.extend([Param::new("physicstype", "CONT"), Param::new("gravity", gravity)]);
            }
            self.weight(&mut line.children);
        }
    }

    /// Returns the parameters that refer to sprites and that a class requires or accepts.
    fn references(&mut self, class: SpriteClass, own: &str) -> Vec<Param> {
        use SpriteClass as C;
        let mut params = Vec::new();
        for key in class.parameters() {
            let kind = vocabulary::sprite_parameter(key).expect("every parameter has a kind");
            let optional = match key {
                "ammo" | "spawnBehind" | "stype2" => true,
                "stype" => class == C::BomberRandomMissile,
                "resource_name" => class != C::ResourcePack,
                _ => false,
            };
            if !matches!(kind, ValueKind::Sprite | ValueKind::Sprites) || optional && !self.choices.once_in(2)
            {
                continue;
            }
            let follows =
                class.is_a(C::Chaser) || class.is_a(C::PathChaser) || class.is_a(C::AlternateChaser);
            let shoots = class.is_a(C::ShootAvatar) || class == C::WizardAvatar;
            let many = kind == ValueKind::Sprites && class != C::FlakAvatar || key == "stype" && shoots;
            let count = if many { 1 + self.choices.below(3) } else { 1 };
            let names: Vec<String> =
                (0..count).map(|_| if follows { self.family() } else { self.leaf_but(own) }).collect();
            params.push(Param::new(key, names.join(",")));
        }
        params
    }

    /// Chooses a type with sprites.
    fn leaf(&mut self) -> String {
        self.leaves[self.choices.below(self.leaves.len())].0.clone()
    }

    fn leaf_but(&mut self, own: &str) -> String {
        let others: Vec<&String> =
            self.leaves.iter().map(|(name, _)| name).filter(|name| *name != own).collect();
        (self.choices.pick(&others)).clone()
    }

    /// Chooses any type, with or without subtypes.
    fn family(&mut self) -> String {
        let at = self.choices.below(self.leaves.len() + self.groups.len());
        match self.leaves.get(at) {
            Some((name, _)) => name.clone(),
            None => self.groups[at - self.leaves.len()].clone(),
        }
    }

    /// Chooses a resource, if there is one.
    fn resource(&mut self) -> String {
        let is_resource = |leaf: &&(String, SpriteClass)| leaf.1 == SpriteClass::Resource;
        let found: Vec<&String> = self.leaves.iter().filter(is_resource).map(|(name, _)| name).collect();
        if found.is_empty() { self.family() } else { self.choices.pick(&found).clone() }
    }

    fn header(&mut self) -> Header {
        let mut params = Vec::new();
        if self.choices.once_in(3) {
            params.push(Param::new("square_size", self.choices.pick(&[10, 1, 25, 2, 10_000])));
        }
        let seeks = |class: SpriteClass| {
            class.is_a(SpriteClass::PathChaser) || class.is_a(SpriteClass::PathAltChaser)
        };
        if self.leaves.iter().any(|(_, class)| seeks(*class)) && !self.choices.once_in(8) {
            params.push(Param::new("obs", self.family()));
        }
        if self.counters > 0 {
            params.push(Param::new("no_counters", self.counters));
        }
        Header { class: "BasicGame".into(), params, ..Header::default() }
    }

    /// Sometimes replaces numbers in the rules with a `GameSpace` parameter.
    fn space(&mut self, description: &mut Description) {
        if !self.choices.once_in(10) {
            return;
        }
        description.header.class = "GameSpace".into();
        let values = self.choices.pick(&["0:1:4", "-3:2:9", "2:0:2"]);
        let mut params = vec![Param::new("values", values), Param::new("value", self.choices.below(4))];
        params.truncate(if values == "2:0:2" { 1 } else { 2 });
        let name: Word = "NUMBER".into();
        description.parameters = vec![ParameterLine { name: name.clone(), params, ..Default::default() }];
        let lines = description.interactions.iter_mut().flat_map(|line| &mut line.params);
        for param in lines.filter(|param| param.value.text.parse::<i32>().is_ok()) {
            if self.choices.once_in(2) {
                param.value = name.clone();
            }
        }
    }

    /// Returns an amount for each counter, written as a list in any case.
    fn amounts(&mut self) -> String {
        let entries: Vec<String> = (0..2).map(|_| vocabulary::int(self.choices).to_string()).collect();
        entries.join(",")
    }

    /// Returns a character for each type with sprites, and the characters that do not place an avatar.
    fn mapping(&mut self) -> (Vec<MappingLine>, Vec<u8>) {
        let mut lines = Vec::new();
        let mut symbols = vec![b'w'];
        let (avatar, others) = self.leaves.split_last().expect("the avatar is the last one");
        for (at, (name, _)) in others.iter().enumerate().skip(1).take(22) {
            let symbol = char::from(b'a' + at as u8 - 1);
            let mut names: Vec<Word> = vec![name.as_str().into()];
            if self.choices.once_in(4) {
                names.push(others[self.choices.below(at)].0.as_str().into());
            }
            let is_avatar =
                |name: &Word| others.iter().any(|(other, class)| *other == name.text && class.is_avatar());
            if !names.iter().any(is_avatar) {
                symbols.push(symbol as u8);
            }
            lines.push(MappingLine { symbol, names, ..MappingLine::default() });
        }
        lines.push(MappingLine {
            symbol: 'A',
            names: vec![avatar.0.as_str().into()],
            ..MappingLine::default()
        });
        (lines, symbols)
    }

    fn interactions(&mut self) -> Vec<InteractionLine> {
        let mut lines = Vec::new();
        for (name, _) in self.leaves.iter().filter(|(_, class)| self.has_ground && stands(*class)) {
            let effect = self.choices.pick(&["wallStop", "stepBack"]);
            let params =
                if effect == "stepBack" { vec![Param::new("pixelPerfect", "True")] } else { Vec::new() };
            let (first, second) = (name.as_str().into(), vec!["wall".into()]);
            let effect = effect.into();
            lines.push(InteractionLine { first, second, effect, params, ..InteractionLine::default() });
        }
        lines.extend((0..1 + self.choices.below(12)).map(|_| self.interaction()).collect::<Vec<_>>());
        lines
    }

    fn interaction(&mut self) -> InteractionLine {
        let effect = self.choices.pick(EFFECTS);
        let mut params = self.effect_parameters(effect);
        let (first, mut second) = (self.family(), vec![self.family()]);
        let place = self.choices.below(12);
        match place {
            11 => second = vec!["TIME".to_owned()],
            9 | 10 => second = vec!["EOS".to_owned()],
            8 => second.extend([self.family(), "EOS".to_owned()]),
            _ => {}
        }
        if place == 11 || effect == "addTimer" {
            params.push(Param::new("timer", 1 + self.choices.below(4)));
            if self.choices.once_in(2) {
                params.push(Param::new("repeating", "True"));
            }
        }
        if self.choices.once_in(3) {
            params.push(Param::new("scoreChange", vocabulary::int(self.choices)));
        }
        if self.choices.once_in(12) {
            params.push(Param::new("applyScore", "False"));
        }
        if self.counters > 0 {
            params.push(Param::new("counter", self.amounts()));
            if self.choices.once_in(3) {
                params.push(Param::new("counterElse", self.amounts()));
                params.push(Param::new("count", self.choices.pick(&["True", "False"])));
            }
        }
        if self.choices.once_in(12) && place < 8 {
            params.push(Param::new("repeat", self.choices.below(4)));
        }
        if self.choices.once_in(8) && matches!(effect, "wallBounce" | "wallReverse") {
            params.push(Param::new("inBatch", "False"));
        }
        InteractionLine {
            first: first.into(),
            second: second.into_iter().map(Word::from).collect(),
            effect: effect.into(),
            params,
            ..InteractionLine::default()
        }
    }

    /// Returns all required parameters, and some optional parameters.
    fn effect_parameters(&mut self, effect: &str) -> Vec<Param> {
        let mut params: Vec<Param> = Vec::new();
        for (key, kind) in effect_parameters(effect) {
            let needed =
                matches!(kind, ParameterKind::Sprite | ParameterKind::Effect | ParameterKind::Planned);
            if !needed && !self.choices.once_in(2) {
                continue;
            }
            let value = match kind {
                ParameterKind::Int | ParameterKind::Scores => vocabulary::int(self.choices).to_string(),
                ParameterKind::Number if key == "prob" => vocabulary::probability(self.choices).to_owned(),
                ParameterKind::Number => vocabulary::number(self.choices).to_owned(),
                ParameterKind::Flag => "True".to_owned(),
                ParameterKind::Sprite | ParameterKind::OptionalSprite => self.effect_sprite(key),
                ParameterKind::Sprites => format!("{},{}", self.family(), self.family()),
                // Only the reference accepts this parameter.
                ParameterKind::TypeNumber if !self.choices.once_in(8) => continue,
                ParameterKind::TypeNumber => self.choices.below(self.leaves.len()).to_string(),
                ParameterKind::Effect => self.choices.pick(EFFECTS).to_owned(),
                ParameterKind::Planned => {
                    let others: Vec<&str> =
                        EFFECTS.iter().copied().filter(|name| *name != "addTimer").collect();
                    let planned = self.choices.pick(&others);
                    params.extend(self.effect_parameters(planned));
                    // A scheduled shield uses the same keyword for the effect that it blocks.
                    params.retain(|param| param.key.text != "ftype");
                    planned.to_owned()
                }
            };
            params.push(Param::new(key, value));
        }
        params
    }

    fn effect_sprite(&mut self, key: &str) -> String {
        match key {
            "resource" | "heldResource" => self.resource(),
            "stypeCount" | "spawnPoint" => self.family(),
            _ => self.leaf(),
        }
    }

    fn terminations(&mut self) -> Vec<TerminationLine> {
        (0..1 + self.choices.below(3)).map(|_| self.termination()).collect()
    }

    fn termination(&mut self) -> TerminationLine {
        let name = self.choices.pick(TERMINATIONS);
        let mut params = Vec::new();
        let limit = match name {
            "Timeout" => 20 + self.choices.below(200),
            _ => self.choices.below(5),
        };
        match name {
            "SpriteCounter" | "SpriteCounterMore" => params.push(Param::new("stype", self.family())),
            "Timeout" if self.counters == 0 => {}
            "Timeout" => {
                params.push(Param::new("use_counter", "True"));
                params.push(Param::new("compare", self.choices.pick(&["True", "False"])));
                params.push(Param::new("limits", self.amounts()));
            }
            _ => {
                params.push(Param::new("stype1", self.family()));
                if name == "MultiSpriteCounterSubTypes" {
                    params.push(Param::new("subTypesNum", self.choices.below(4)));
                } else if self.choices.once_in(2) {
                    params.push(Param::new("stype2", self.family()));
                    params.push(Param::new("min", self.choices.pick(&["True", "False"])));
                }
            }
        }
        if self.choices.once_in(12) {
            params.push(Param::new(self.choices.pick(&["count_score", "canEnd"]), "True"));
        }
        params.push(Param::new("limit", limit));
        params.push(Param::new("win", self.choices.pick(&["True", "False"])));
        TerminationLine { class: name.into(), params, ..TerminationLine::default() }
    }

    /// Creates a board of a few cells, so that sprites meet. One board in eight is larger.
    fn level(&mut self, symbols: &[u8]) -> String {
        let large = self.choices.once_in(8);
        let (most_columns, most_rows) = if large { (24, 12) } else { (7, 5) };
        let (columns, rows) = (1 + self.choices.below(most_columns), 1 + self.choices.below(most_rows));
        let place = self.choices.below(if self.has_ground { columns } else { columns * rows });
        let mut text = String::new();
        for cell in 0..columns * rows {
            // Half of the cells are empty.
            let symbol = match self.choices.below(2 * symbols.len()) {
                at if at > 0 => symbols.get(at - 1).copied().unwrap_or(b' '),
                _ => b' ',
            };
            let is_ground = self.has_ground && cell / columns + 1 == rows;
            text.push(match cell == place {
                true => 'A',
                false if is_ground => 'w',
                false => char::from(symbol),
            });
            if cell % columns == columns - 1 {
                text.push('\n');
            }
        }
        text
    }
}

/// Returns `true` if sprites of the class react to the ground below them.
fn stands(class: SpriteClass) -> bool {
    class.is_a(SpriteClass::PlatformerAvatar) || class.is_a(SpriteClass::Walker)
}

fn line(name: String, class: Option<SpriteClass>, children: Vec<SpriteLine>) -> SpriteLine {
    let class = class.map(|class| class.name().into());
    SpriteLine { name: name.into(), class, children, ..SpriteLine::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choices::random_bytes;
    use base::Seed;
    use engine::Game;

    #[test]
    fn no_decisions_make_the_simplest_game() {
        let made = any_game(&mut Choices::new(&[]));
        Game::from_source(&made.source).unwrap_or_else(|problems| panic!("{problems}\n{}", made.source));
        assert_eq!(made.level, "A\n");
    }

    #[test]
    fn most_games_load_and_use_every_class_and_effect() {
        let mut sampler = Seed::from_text("any game").sampler();
        let (mut loaded, mut sources) = (0, String::new());
        let mut refused = std::collections::BTreeMap::new();
        for _ in 0..1000 {
            let bytes = random_bytes(&mut sampler, 400);
            let made = any_game(&mut Choices::new(&bytes));
            match Game::from_source(&made.source) {
                Ok(game) if game.level(&made.level).is_ok() => {
                    loaded += 1;
                    sources.push_str(&made.source);
                }
                Ok(game) => {
                    panic!("{}\n{}\n{}", game.level(&made.level).unwrap_err(), made.source, made.level)
                }
                Err(problems) => *refused.entry(problems.0[0].code).or_insert(0) += 1,
            }
        }
        assert!(loaded > 850, "{loaded} of 1000 load; the others: {refused:?}");
        let words: std::collections::BTreeSet<&str> = sources.split([' ', '\n', '=']).collect();
        let all = SpriteClass::ALL.iter().map(|class| class.name()).chain(EFFECTS.iter().copied());
        let parameters = SpriteClass::ALL.iter().flat_map(|class| class.parameters());
        let parameters = parameters.chain(SPRITE_PARAMETERS.iter().copied()).chain(
            EFFECTS.iter().flat_map(|effect| effect_parameters(effect).into_iter().map(|(key, _)| key)),
        );
        let all = all.chain(["counter", "counterElse", "GameSpace", "use_counter", "count_score"]);
        let missing: Vec<&str> = all
            .chain(parameters)
            .chain(TERMINATIONS.iter().copied())
            .filter(|word| !words.contains(word) && *word != "itype")
            .collect();
        assert_eq!(missing, Vec::<&str>::new());
    }
}
