//! A game's rules as plain clauses, for comparing games. Names are resolved, inherited values are included,
//! and default values are omitted.

use super::Names;
use super::interactions::{NO_KEYWORD, Partner, number_of, partner};
use super::params::{Value, convert};
use crate::keywords;
use crate::numbers::geometry::Direction;
use crate::rules::class::SpriteClass;
use crate::rules::effects::{self, Arguments, Effect, Undeclared};
use crate::rules::terminations::{Condition, Decision};
use crate::rules::traits::Traits;
use crate::rules::{Rules, SpriteType, TypeInfo};
use crate::syntax::{InteractionLine, Param, Word};

/// A parameter's value.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// `True` or `False`.
    Flag(bool),
    /// A number, which may be an integer or a float.
    Number(f64),
    /// A list with one number per counter in the game.
    Numbers(Vec<f64>),
    /// A direction.
    Direction(Direction),
    /// An effect keyword.
    Effect(&'static str),
    /// Sprite types, in file order.
    Types(Vec<SpriteType>),
}

/// The parameters that differ from their defaults.
pub type Terms = Vec<(&'static str, Term)>;

/// A sprite type as a clause.
#[derive(Clone, Debug, PartialEq)]
pub struct TypeClause {
    /// The type.
    pub stype: SpriteType,
    /// The class, inherited or not, or `None` for grouping nodes without a class.
    pub class: Option<SpriteClass>,
    /// The parent type in the SpriteSet; `None` for a type without a parent.
    pub parent: Option<SpriteType>,
    /// `true` if the type has no subtypes.
    pub leaf: bool,
    /// `true` if the file declares the type. `wall` and `avatar` exist even if the file does not declare
    /// them.
    pub declared: bool,
    /// The parameters, inherited or not, that differ from the class's defaults. Parameters that only affect
    /// drawing are omitted.
    pub terms: Terms,
}

/// One side of an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Party {
    /// The sprites of a type and of related types in the SpriteSet.
    Type(SpriteType),
    /// The edge of the screen.
    Edge,
    /// The clock: the interaction is a timed effect.
    Clock,
    /// No sprite, as the clock's partner on a line without a target.
    Nobody,
}

/// An interaction between two parties. A line with several partners becomes several clauses.
#[derive(Clone, Debug, PartialEq)]
pub struct InteractionClause {
    /// The party affected by the effect, which is never the edge.
    pub first: Party,
    /// The partner of the first party.
    pub second: Party,
    /// The effect keyword.
    pub effect: &'static str,
    /// The parameters that differ from their defaults.
    pub terms: Terms,
    /// The index of the interaction's line in [`Description::interactions`](crate::Description).
    pub line: usize,
}

/// A termination as a clause.
#[derive(Clone, Debug, PartialEq)]
pub struct TerminationClause {
    /// The termination's class.
    pub class: &'static str,
    /// `true` if the termination wins the game, or may win it.
    pub win: bool,
    /// The other parameters that differ from their defaults.
    pub terms: Terms,
}

/// All rules in a game.
#[derive(Clone, Debug, PartialEq)]
pub struct Clauses {
    /// The parameters of the whole game. The cell size in pixels is included only for games with continuous
    /// physics, which measures distances in pixels.
    pub header: Terms,
    /// The sprite types' clauses, by type.
    pub types: Vec<TypeClause>,
    /// The sprites that each mapped level character places, excluding built-in mappings that the game does
    /// not declare.
    pub mapping: Vec<(char, Vec<SpriteType>)>,
    /// The enabled interactions, in file order.
    pub interactions: Vec<InteractionClause>,
    /// The terminations, in file order.
    pub terminations: Vec<TerminationClause>,
}

/// Returns the rules as clauses.
pub(crate) fn clauses(rules: &Rules) -> Clauses {
    let of_type = |(at, info): (usize, &TypeInfo)| type_clause(rules, SpriteType(at as u16), info);
    Clauses {
        header: header(rules),
        types: rules.types.iter().enumerate().map(of_type).collect(),
        mapping: mapping(rules),
        interactions: interactions(rules),
        terminations: terminations(rules),
    }
}

/// A field type that converts to a [`Term`].
trait IntoTerm: Copy + PartialEq {
    fn term(self) -> Term;
}

impl IntoTerm for bool {
    fn term(self) -> Term {
        Term::Flag(self)
    }
}

impl IntoTerm for i32 {
    fn term(self) -> Term {
        Term::Number(f64::from(self))
    }
}

impl IntoTerm for f64 {
    fn term(self) -> Term {
        Term::Number(self)
    }
}

impl IntoTerm for Direction {
    fn term(self) -> Term {
        Term::Direction(self)
    }
}

fn note<T: IntoTerm>(terms: &mut Terms, key: &'static str, value: T, default: T) {
    if value != default {
        terms.push((key, value.term()));
    }
}

fn note_types(terms: &mut Terms, key: &'static str, types: impl IntoIterator<Item = SpriteType>) {
    let types: Vec<SpriteType> = types.into_iter().filter(|&stype| stype != SpriteType::NONE).collect();
    if !types.is_empty() {
        terms.push((key, Term::Types(types)));
    }
}

fn declared(rules: &Rules, name: &str) -> bool {
    rules.description.sprite_lines().iter().any(|(_, line)| line.name.text == name)
}

fn type_clause(rules: &Rules, stype: SpriteType, info: &TypeInfo) -> TypeClause {
    let mut terms = Terms::new();
    if let Some(class) = info.class {
        let mut default = Traits::of_class(class);
        default.settle();
        let own = &info.traits;
        macro_rules! fields {
            ($($field:ident)*) => { $(note(&mut terms, stringify!($field), own.$field, default.$field);)* };
        }
        // These are all fields except those for images and those that the class determines.
        fields! {
            speed cooldown orientation is_oriented rotate_in_place is_static only_active stationary solid width_factor
            height_factor health max_health limit_health time_to_live portal is_npc is_from_avatar last_move is_first_tick
            on_ground hidden invisible limit value age spread_probability cons fleeing max_distance prob total
            spawn_orientation min_ammo ammo_cost continuous off_grid mass gravity friction max_speed jump_strength
            angle_diff rotation facing facing_dir last_block_time ground_speedup air_slowdown air_steering probability
            epsilon random_target
        }
        note(&mut terms, "singleton", info.singleton, false);
        note_types(&mut terms, "stype", own.stypes.iter().copied());
        note_types(&mut terms, "ammo", own.ammo.iter().copied());
        // Without `spawnBehind`, this avatar leaves walls behind.
        let walls = (class == SpriteClass::OngoingTurningAvatar).then_some(SpriteType(0));
        note_types(&mut terms, "spawnBehind", own.spawn_behind.or(walls));
        note_types(&mut terms, "resource", Some(own.resource).filter(|&resource| resource != stype));
    }
    let declared = declared(rules, &info.name);
    let parent = info.path.iter().rev().nth(1).copied();
    TypeClause { stype, class: info.class, parent, leaf: info.leaf, declared, terms }
}

fn header(rules: &Rules) -> Terms {
    let mut terms = Terms::new();
    note(&mut terms, "no_counters", rules.counters as i32, 0);
    note(&mut terms, "canEnd", rules.can_end, true);
    note(&mut terms, "obs", rules.finds_paths, false);
    if rules.types.iter().any(|info| info.traits.continuous) {
        note(&mut terms, "square_size", rules.square_size.unwrap_or(0), 0);
    }
    note_types(&mut terms, "obs", rules.obstacles.iter().copied());
    terms
}

fn mapping(rules: &Rules) -> Vec<(char, Vec<SpriteType>)> {
    let written = |symbol: char| rules.description.mapping.iter().any(|line| line.symbol == symbol);
    let all = (0u8..).map(char::from).zip(&rules.mapping).filter(|(_, types)| !types.is_empty());
    let meant = all.filter(|(symbol, types)| {
        let info = |stype: &SpriteType| &rules.types[stype.index()];
        let placeable = |stype| info(stype).class.is_some() && declared(rules, &info(stype).name);
        written(*symbol) || types.iter().all(placeable)
    });
    meant.map(|(symbol, types)| (symbol, types.to_vec())).collect()
}

fn interactions(rules: &Rules) -> Vec<InteractionClause> {
    let names = Names { types: &rules.types };
    let mut clauses = Vec::new();
    for (at, line) in rules.description.interactions.iter().enumerate() {
        let mut written = Written { line, names, terms: Terms::new(), planned: None };
        let keyword = keywords::EFFECTS.iter().find(|known| **known == line.effect.text).copied();
        let built = keyword.and_then(|keyword| effects::build(keyword, &mut written));
        let (Some(effect), Some(built)) = (keyword, built) else { continue };
        written.common(&built);
        if !written.truth("enabled", true) {
            continue;
        }
        if let Some(counting) =
            rules.effects.iter().find(|info| info.line == at).and_then(|info| info.counting.as_ref())
        {
            let numbers = |list: &[Option<i32>]| {
                Term::Numbers(list.iter().map(|by| f64::from(by.unwrap_or(0))).collect())
            };
            written.terms.push(("counter", numbers(&counting.counter)));
            written.terms.push(("counterElse", numbers(&counting.counter_else)));
            written.flag("count", true);
            written.flag("countElse", true);
        }
        let party = |word: &Word| match partner(word, names, &mut Vec::new()) {
            Partner::Sprite(stype) => Party::Type(stype),
            Partner::Edge => Party::Edge,
            Partner::Clock => Party::Clock,
            Partner::Unknown => Party::Nobody,
        };
        let (first, seconds) = (party(&line.first), line.second.iter().map(party).collect::<Vec<Party>>());
        let acted_upon = match (first, &seconds[..]) {
            (Party::Clock, [other, ..]) => Some(*other),
            (_, [Party::Clock, ..]) => Some(first),
            _ => None,
        };
        let pairs: Vec<(Party, Party)> = match acted_upon {
            Some(target) => {
                written.clock();
                let target = if let Party::Type(_) = target { target } else { Party::Nobody };
                vec![(target, Party::Clock)]
            }
            None => seconds.into_iter().map(|second| (first, second)).collect(),
        };
        for (first, second) in pairs {
            let (first, second) = if first == Party::Edge { (second, first) } else { (first, second) };
            let terms = written.terms.clone();
            clauses.push(InteractionClause { first, second, effect, terms, line: at });
        }
    }
    clauses
}

fn terminations(rules: &Rules) -> Vec<TerminationClause> {
    let clause = |end: &crate::rules::terminations::Termination| {
        let mut terms = Terms::new();
        let (class, limit) = match end.condition {
            Condition::SpriteCounter { limit, .. } => ("SpriteCounter", limit),
            Condition::SpriteCounterMore { limit, .. } => ("SpriteCounterMore", limit),
            Condition::MultiSpriteCounter { limit, min, .. } => {
                note(&mut terms, "min", min, false);
                ("MultiSpriteCounter", limit)
            }
            Condition::MultiSpriteCounterSubTypes { limit, kinds, .. } => {
                note(&mut terms, "subTypesNum", kinds, -1);
                ("MultiSpriteCounterSubTypes", limit)
            }
            Condition::StopCounter { limit, min, .. } => {
                note(&mut terms, "min", min, false);
                ("StopCounter", limit)
            }
            Condition::Timeout { limit } => ("Timeout", limit),
        };
        note(&mut terms, "limit", limit, 0);
        match end.decided_by {
            Decision::Line => {}
            Decision::Score => note(&mut terms, "count_score", true, false),
            Decision::Difference => note(&mut terms, "compare", true, false),
            Decision::Value(value) => terms.push(("use_counter", value.term())),
        }
        note_types(&mut terms, "stype", end.counts().iter().copied());
        TerminationClause { class, win: end.win, terms }
    };
    rules.terminations.iter().map(clause).collect()
}

/// A second parse of a compiled line, which records the parameters that differ from their defaults.
struct Written<'a> {
    line: &'a InteractionLine,
    names: Names<'a>,
    terms: Terms,
    planned: Option<&'static str>,
}

impl<'a> Written<'a> {
    /// Returns the parameter with this name; `None` if the line does not contain it. If the name is duplicated, returns
    /// the last parameter.
    fn param(&self, key: &str) -> Option<&'a Param> {
        self.line.params.iter().rev().find(|param| param.key.text == key)
    }

    fn whole(&self, key: &str, default: i32) -> i32 {
        match self.param(key).map(|param| convert(key, &param.value.text)) {
            Some(Value::Int(int)) => int,
            _ => default,
        }
    }

    fn truth(&self, key: &str, default: bool) -> bool {
        match self.param(key).map(|param| convert(key, &param.value.text)) {
            Some(Value::Bool(bool)) => bool,
            _ => default,
        }
    }

    /// Records the parameters that every effect accepts.
    fn common(&mut self, effect: &Effect) {
        self.score("scoreChange");
        self.flag("applyScore", true);
        self.int("repeat", 1);
        self.flag("inBatch", effect.summary().batch.is_some());
        if self.planned.is_some() {
            self.clock();
        }
    }

    /// Records the timing parameters of a timed line.
    fn clock(&mut self) {
        self.int("timer", -1);
        self.flag("repeating", false);
        // All values other than −1 have the same meaning.
        let put_off = self.whole("nextExecution", -1) != -1;
        note(&mut self.terms, "nextExecution", put_off, false);
    }

    fn types(&self, key: &str) -> Vec<SpriteType> {
        let text = self.param(key).map_or("", |param| param.value.text.as_str());
        text.split(',').filter_map(|name| self.names.find(name)).collect()
    }
}

impl Arguments for Written<'_> {
    fn int(&mut self, key: &'static str, default: i32) -> i32 {
        let value = self.whole(key, default);
        note(&mut self.terms, key, value, default);
        value
    }

    fn number(&mut self, key: &'static str, default: f64) -> f64 {
        let value = match self.param(key).map(|param| convert(key, &param.value.text)) {
            Some(Value::Int(int)) => f64::from(int),
            Some(Value::Double(double)) => double,
            _ => default,
        };
        note(&mut self.terms, key, value, default);
        value
    }

    fn flag(&mut self, key: &'static str, default: bool) -> bool {
        let value = self.truth(key, default);
        note(&mut self.terms, key, value, default);
        value
    }

    fn score(&mut self, key: &'static str) -> i32 {
        let text = self.param(key).map_or("", |param| param.value.text.as_str());
        let value = text.split(',').next().unwrap_or_default().parse().unwrap_or(0);
        note(&mut self.terms, key, value, 0);
        value
    }

    fn sprite(&mut self, key: &'static str) -> SpriteType {
        self.optional_sprite(key, Undeclared::Void).unwrap_or(SpriteType::NONE)
    }

    fn sprite_or_none(&mut self, key: &'static str) -> SpriteType {
        self.sprite(key)
    }

    fn optional_sprite(&mut self, key: &'static str, _: Undeclared) -> Option<SpriteType> {
        let found = self.types(key).first().copied();
        note_types(&mut self.terms, key, found);
        found
    }

    fn numbered(&mut self, _: &'static str) -> Option<SpriteType> {
        None
    }

    fn sprites(&mut self, key: &'static str) -> Vec<SpriteType> {
        let found = self.types(key);
        note_types(&mut self.terms, key, found.iter().copied());
        found
    }

    fn keyword(&mut self, key: &'static str) -> u16 {
        let text = self.param(key).map_or("", |param| param.value.text.as_str());
        let number = number_of(text);
        self.terms.extend(number.map(|number| (key, Term::Effect(keywords::EFFECTS[usize::from(number)]))));
        number.unwrap_or(NO_KEYWORD)
    }

    fn timed(&mut self) -> u16 {
        let at = self.keyword("ftype");
        self.planned = keywords::EFFECTS.get(usize::from(at)).copied();
        // The parameters of the scheduled effect are on the same line.
        if let Some(planned) = self.planned.filter(|&planned| planned != "addTimer") {
            effects::build(planned, self);
        }
        0
    }

    fn relatives(&self, _: SpriteType) -> Box<[SpriteType]> {
        Box::default()
    }
}
