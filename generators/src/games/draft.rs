//! A game under construction: sprite types, rules and endings as typed data, before it becomes a description.

use super::body::Body;
use super::effect::Effect;
use super::english;
use super::role::Role;
use super::theme::Theme;
pub(crate) use super::tree::{
    AVATAR, CLOCK, Claim, Clause, Ending, FLOOR, HERO, Harm, Part, Phase, Rule, Site, Sprite, Stamina, Value,
    WALL, Weapon,
};
use engine::{Sampler, Seed, SpriteClass};

/// Names and values of parameters.
type Params<'a> = &'a [(&'static str, Value)];

/// A game under construction.
pub(crate) struct Draft {
    pub(crate) sprites: Vec<Sprite>,
    pub(crate) rules: Vec<Rule>,
    /// In the order of the TerminationSet; `true` marks a win.
    pub(crate) endings: Vec<(Ending, bool)>,
    pub(crate) harms: Vec<(Part, Harm)>,
    /// Pairs whose meeting a pattern handles itself: no rule of movement is derived for them.
    pub(crate) handled: Vec<(Part, Part)>,
    pub(crate) weapon: Option<Weapon>,
    pub(crate) stamina: Stamina,
    /// The instructions for winning, in words.
    pub(crate) goal: String,
    /// The equipment of the hero, in words.
    pub(crate) outfit: String,
    /// The other facts about the game, in words.
    pub(crate) clauses: Vec<Clause>,
    /// The number of the pattern under construction.
    pub(crate) gene: Option<usize>,
    pub(crate) theme: &'static Theme,
    /// The draws of names.
    names: Sampler,
    /// The words of the theme that are in use.
    taken: Vec<&'static str>,
}

impl Draft {
    /// Creates a draft with floor, wall and hero.
    pub(crate) fn new(theme: &'static Theme, names: Seed) -> Draft {
        let mut draft = Draft {
            sprites: Vec::new(),
            rules: Vec::new(),
            endings: Vec::new(),
            harms: Vec::new(),
            handled: Vec::new(),
            weapon: None,
            stamina: Stamina::Fragile,
            goal: String::new(),
            outfit: String::new(),
            clauses: Vec::new(),
            gene: None,
            theme,
            names: names.sampler(),
            taken: Vec::new(),
        };
        let floor = draft.place(Role::Floor, SpriteClass::Immovable, Body::Floor, &[]);
        let wall = draft.add("wall".into(), Role::Wall, Some(SpriteClass::Immovable), Body::Wall, &[]);
        let avatar = draft.add("avatar".into(), Role::Hero, None, Body::Hero, &[]);
        let hero = draft.child(avatar, Role::Hero);
        draft.child(wall, Role::Wall);
        assert!((floor, wall, avatar, hero) == (FLOOR, WALL, AVATAR, HERO), "the constants say so");
        draft
    }

    /// Adds a sprite type that levels place.
    pub(crate) fn place(&mut self, role: Role, class: SpriteClass, body: Body, params: Params<'_>) -> Part {
        let part = self.spawn(role, class, body, params);
        self.show(part);
        part
    }

    /// Adds a sprite type that is created only during play.
    pub(crate) fn spawn(&mut self, role: Role, class: SpriteClass, body: Body, params: Params<'_>) -> Part {
        let name = self.word(role);
        self.add(name, role, Some(class), body, params)
    }

    /// Draws a word of the theme for the role that the game does not use yet.
    ///
    /// # Panics
    /// If all are in use: a game gives no role to more sprite types than a theme has words for it.
    fn word(&mut self, role: Role) -> String {
        let mut free = self.theme.words(role);
        free.retain(|word| !self.taken.contains(word));
        let word = *self.names.choose(&free);
        self.taken.push(word);
        word.to_owned()
    }

    /// Adds another state of a sprite type, created only during play: `lit` and a lamp make a `litLamp`.
    pub(crate) fn state(
        &mut self,
        of: Part,
        adjective: &str,
        class: SpriteClass,
        body: Body,
        params: Params<'_>,
    ) -> Part {
        let name = format!("{adjective}{}", english::capital(self.name(of)));
        self.add(name, self.sprites[of.0].role, Some(class), body, params)
    }

    /// Adds another state of the hero.
    pub(crate) fn hero_state(&mut self, adjective: &str) -> Part {
        let name = format!("{adjective}{}", english::capital(self.name(HERO)));
        let state = self.add(name, Role::Hero, None, Body::Hero, &[]);
        self.sprites[state.0].parent = Some(AVATAR);
        state
    }

    fn child(&mut self, parent: Part, role: Role) -> Part {
        let name = self.word(role);
        let child = self.add(name, role, None, self.sprites[parent.0].body, &[]);
        self.sprites[child.0].parent = Some(parent);
        self.show(child);
        child
    }

    fn add(
        &mut self,
        name: String,
        role: Role,
        class: Option<SpriteClass>,
        body: Body,
        params: Params<'_>,
    ) -> Part {
        let (params, gene) = (params.to_vec(), self.gene);
        self.sprites.push(Sprite {
            name,
            role,
            class,
            params,
            parent: None,
            body,
            placed: false,
            gene,
            removed: false,
        });
        Part(self.sprites.len() - 1)
    }

    /// Sets the class and adds parameters of the hero, for all its states.
    pub(crate) fn set_hero(&mut self, class: SpriteClass, params: Params<'_>) {
        let avatar = &mut self.sprites[AVATAR.0];
        avatar.class = Some(class);
        avatar.params.extend_from_slice(params);
    }

    /// Adds a parameter, for types that refer to each other.
    pub(crate) fn give(&mut self, part: Part, key: &'static str, value: Value) {
        self.sprites[part.0].params.push((key, value));
    }

    /// Lets levels place a part although it is a state of another.
    pub(crate) fn show(&mut self, part: Part) {
        self.sprites[part.0].placed = true;
    }

    /// Returns the site by which edits refer to a part.
    pub(crate) fn site(&self, part: Part) -> Site {
        if part == CLOCK {
            return Site { role: Role::Floor, nth: CLOCK.0 };
        }
        let role = self.sprite(part).role;
        let nth = self.sprites[..part.0].iter().filter(|sprite| sprite.role == role).count();
        Site { role, nth }
    }

    /// Returns the part that a site refers to, if it is there.
    pub(crate) fn at(&self, site: Site) -> Option<Part> {
        if site.nth == CLOCK.0 {
            return Some(CLOCK);
        }
        let mut of_role = self.parts().filter(|&part| self.sprite(part).role == site.role);
        of_role.nth(site.nth).filter(|&part| !self.sprite(part).removed)
    }

    /// All parts, in the order of creation.
    pub(crate) fn parts(&self) -> impl Iterator<Item = Part> + use<> {
        (0..self.sprites.len()).map(Part)
    }

    pub(crate) fn sprite(&self, part: Part) -> &Sprite {
        &self.sprites[part.0]
    }

    /// Returns the name used in VGDL.
    pub(crate) fn name(&self, part: Part) -> &str {
        if part == CLOCK { "TIME" } else { &self.sprites[part.0].name }
    }

    /// Adds a rule without a score.
    pub(crate) fn rule(&mut self, phase: Phase, first: Part, second: &[Part], effect: Effect) {
        self.scored(phase, first, second, effect, 0);
    }

    /// Adds a rule with a score.
    pub(crate) fn scored(&mut self, phase: Phase, first: Part, second: &[Part], effect: Effect, score: i32) {
        let rule = Rule { phase, first, second: second.to_vec(), effect, score, gene: self.gene };
        self.rules.push(rule);
    }

    /// Gives the hero this many health points, and a limit to them.
    pub(crate) fn hearts(&mut self, health: u32, limit: u32) {
        self.stamina = Stamina::Hearts(health);
        self.give(AVATAR, "healthPoints", Value::Count(health));
        self.give(AVATAR, "limitHealthPoints", Value::Count(limit));
    }

    /// Makes touching the part harm the hero.
    pub(crate) fn harm(&mut self, part: Part, harm: Harm) {
        self.harms.push((part, harm));
    }

    /// Records that a pattern handles the meeting of these two itself.
    pub(crate) fn mark_handled(&mut self, first: Part, second: Part) {
        self.handled.push((first, second));
    }

    /// Lets the hero's weapon, if there is one, kill the part.
    pub(crate) fn prey(&mut self, part: Part, score: i32) {
        match self.weapon {
            None => {}
            Some(Weapon::Bolt(bolt)) => {
                self.mark_handled(bolt, part);
                self.scored(Phase::Strike, part, &[bolt], Effect::KillBoth, score);
            }
            Some(Weapon::Blade(hit) | Weapon::Blast(hit)) => {
                self.mark_handled(hit, part);
                self.scored(Phase::Strike, part, &[hit], Effect::KillSprite, score);
            }
        }
    }

    /// Lets the hero's weapon, if there is one, turn the part into another.
    pub(crate) fn prey_leaves(&mut self, part: Part, stype: Part, score: i32) {
        let (hit, kill_second) = match self.weapon {
            None => return,
            Some(Weapon::Bolt(bolt)) => (bolt, true),
            Some(Weapon::Blade(hit) | Weapon::Blast(hit)) => (hit, false),
        };
        self.mark_handled(hit, part);
        self.scored(Phase::Strike, part, &[hit], Effect::TransformTo { stype, kill_second }, score);
    }

    /// Adds a win for when none of these is left.
    pub(crate) fn win_without(&mut self, parts: &[Part]) {
        self.endings.push((Ending::NoneLeft(parts.to_vec()), true));
    }

    /// Adds a loss for when none of these is left.
    pub(crate) fn lose_without(&mut self, part: Part) {
        self.endings.push((Ending::NoneLeft(vec![part]), false));
    }

    /// Adds a loss for when `count` of these exist.
    pub(crate) fn lose_with(&mut self, part: Part, count: u32) {
        self.endings.push((Ending::Many(part, count), false));
    }

    /// Returns the name in English: "sea glass".
    pub(crate) fn spaced_name(&self, part: Part) -> String {
        english::spaced(self.name(part))
    }

    /// Returns the plural: "sea glasses".
    pub(crate) fn plural(&self, part: Part) -> String {
        english::plural(&self.spaced_name(part))
    }

    /// Returns the name with its article: "a sea glass".
    pub(crate) fn with_article(&self, part: Part) -> String {
        english::one(&self.spaced_name(part))
    }

    /// Fills the names of the parts into a text, in their order: `<name>`, `<a name>` with its article, `<names>` in the
    /// plural.
    pub(crate) fn phrase(&self, text: &str, parts: &[Part]) -> String {
        let mut parts = parts.iter();
        let mut next = || *parts.next().expect("a part for every name");
        let pieces = text.split(['<', '>']).map(|piece| match piece {
            "name" => self.spaced_name(next()),
            "a name" => self.with_article(next()),
            "names" => self.plural(next()),
            words => words.to_owned(),
        });
        pieces.collect()
    }

    /// Adds a fact to the summary, a [phrase](Draft::phrase) about these parts.
    pub(crate) fn add_fact(&mut self, text: &str, parts: &[Part]) {
        self.claim(Claim::Fact, text, parts);
    }

    /// Adds a clause about the movement of a sprite type.
    pub(crate) fn add_motion_clause(&mut self, part: Part, text: &str, parts: &[Part]) {
        self.claim(Claim::Way(part), text, parts);
    }

    /// Adds a clause about the points that something is worth.
    pub(crate) fn add_points_clause(&mut self, text: &str, parts: &[Part]) {
        self.claim(Claim::Points, text, parts);
    }

    fn claim(&mut self, claim: Claim, text: &str, parts: &[Part]) {
        self.clauses.push(Clause { text: self.phrase(text, parts), gene: self.gene, claim });
    }

    /// Makes the title. Called after all other names of the theme are drawn, since it continues the same draws.
    pub(crate) fn title(&mut self, title_word: &str) -> String {
        let hero = english::headline(&self.spaced_name(HERO));
        self.theme.title(&hero, title_word, &mut self.names)
    }
}

/// Draws a number from a range, for parameters.
pub(crate) fn draw(sampler: &mut Sampler, low: u32, high: u32) -> u32 {
    sampler.between(low as usize, high as usize) as u32
}
