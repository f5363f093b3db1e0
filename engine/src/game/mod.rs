//! A compiled game: immutable, valid and cheap to clone.

pub(crate) mod ablation;

use crate::compile::{self, Clauses};
use crate::diagnostic::Diagnostics;
use crate::diagnostic::causes;
use crate::dialect;
use crate::limits::MAX_TICKS;
use crate::numbers::geometry::Direction;
use crate::rules::class::SpriteClass;
use crate::rules::{Action, Rules, SpriteType};
use crate::schedule::Plan;
use crate::state::State;
use crate::syntax::Description;
use crate::world::Models;
use base::Digest;
use std::collections::BTreeMap;
use std::ops::Deref;
use std::sync::Arc;

/// A game, ready to play.
#[derive(Clone, Debug)]
pub struct Game(pub(crate) Arc<Compiled>);

/// The rules of a game, and what is derived from them once.
#[derive(Clone, Debug)]
pub(crate) struct Compiled {
    pub(crate) rules: Rules,
    pub(crate) models: Models,
    pub(crate) plan: Plan,
}

impl Deref for Compiled {
    type Target = Rules;

    fn deref(&self) -> &Rules {
        &self.rules
    }
}

impl Game {
    /// The game with these rules.
    pub(crate) fn of(rules: Rules) -> Game {
        let models = Models::of(&rules);
        let plan = Plan::of(&rules, &models);
        Game(Arc::new(Compiled { rules, models, plan }))
    }

    /// Resolves and checks a description.
    ///
    /// # Errors
    /// All problems of the description, sorted by place.
    pub fn compile(description: &Description) -> Result<Game, Diagnostics> {
        compile::compile(description).map(Game::of)
    }

    /// Parses and compiles.
    ///
    /// # Errors
    /// All problems of the text, sorted by place.
    pub fn from_source(source: &str) -> Result<Game, Diagnostics> {
        let (description, Diagnostics(read)) = crate::syntax::parse_all(source);
        match compile::compile(&description) {
            Ok(mut rules) if !Diagnostics::has_errors(&read) => {
                rules.warnings = causes::reported(read, rules.warnings, source).0;
                Ok(Game::of(rules))
            }
            // A description that compiles may have problems too; one run should show all problems.
            compiled => {
                let compiled = compiled.err().map_or(Vec::new(), |problems| problems.0);
                let Diagnostics(reported) = causes::reported(read, compiled, source);
                Err(Diagnostics(dialect::told(source, &description, reported)))
            }
        }
    }

    /// BLAKE3 of the canonical print without comments.
    pub fn digest(&self) -> Digest {
        self.0.digest
    }

    /// The syntax tree that the game was compiled from.
    pub fn description(&self) -> &Description {
        &self.0.description
    }

    /// Parses and compiles as the reference does: it drops, ignores or overlooks faults where it can, and counts messages
    /// (`spec/01` §1). For comparisons with the reference; everywhere else an error is an error.
    ///
    /// # Errors
    /// The fault on which the reference crashes.
    pub fn from_source_as_reference(source: &str) -> Result<Game, Diagnostics> {
        let (description, problems) = crate::syntax::parse_as_reference(source);
        if Diagnostics::has_errors(&problems) {
            return Err(Diagnostics(problems));
        }
        compile::compile_as_reference(&description).map(Game::of)
    }

    /// The available actions besides [`Action::Nil`], sorted; [`Action::Nil`] alone if there is no avatar.
    pub fn actions(&self, state: &State) -> &'static [Action] {
        state.avatar_type().map_or(&[Action::Nil], |stype| self.0.types[stype.index()].actions)
    }

    /// Tests whether an action is among [`Game::actions`].
    pub(crate) fn allows(&self, state: &State, action: Action) -> bool {
        state.avatar_type().is_some_and(|stype| self.0.types[stype.index()].keys >> action as u8 & 1 != 0)
    }

    /// The actions besides [`Action::Nil`] of an avatar of that type, sorted.
    pub fn actions_of(&self, avatar: SpriteType) -> &'static [Action] {
        self.0.types[avatar.index()].actions
    }

    /// The rules as clauses. Games with equal clauses play alike; the converse does not hold. Cost: O(types +
    /// interactions).
    pub fn clauses(&self) -> Clauses {
        compile::clauses(&self.0)
    }

    /// All sprite types, in registry order.
    pub fn sprite_types(&self) -> impl Iterator<Item = SpriteType> + use<> {
        (0..self.0.types.len() as u16).map(SpriteType)
    }

    /// The name of a type; `#-1` for an undeclared type, which games loaded as the reference does may count.
    pub fn name(&self, stype: SpriteType) -> &str {
        self.0.types.get(stype.index()).map_or("#-1", |info| &info.name)
    }

    /// The same game with other names in observations and texts; types without another name keep theirs. Its
    /// [`description`](Game::description) and digest stay as they are. Cost: a copy of the rules.
    pub fn under_names(&self, names: &BTreeMap<String, String>) -> Game {
        let mut compiled = (*self.0).clone();
        for info in &mut compiled.rules.types {
            if let Some(name) = names.get(&info.name) {
                info.name.clone_from(name);
            }
        }
        Game(Arc::new(compiled))
    }

    /// The type of that name.
    pub fn sprite_type(&self, name: &str) -> Option<SpriteType> {
        self.sprite_types().find(|&stype| self.name(stype) == name)
    }

    /// The class of a type; `None` for bare grouping nodes.
    pub fn class(&self, stype: SpriteType) -> Option<SpriteClass> {
        self.0.types[stype.index()].class
    }

    /// The initial orientation of a type's sprites, written, inherited or set by their class; [`Direction::NONE`] for
    /// none, [`Direction::NIL`] for sprites that draw it.
    pub fn orientation(&self, stype: SpriteType) -> Direction {
        self.0.types[stype.index()].traits.orientation
    }

    /// The maximum number of steps of an episode, by the lowest `limit=` of a Timeout or by that of the reference. A Timeout
    /// ends the step after that many, because the reference counts the first one as tick 0.
    pub fn time_limit(&self) -> u64 {
        // The first step is tick 0 of the reference.
        self.0.first_timeout.saturating_add(1).clamp(1, MAX_TICKS + 1).unsigned_abs().into()
    }

    /// Returns `true` if the game draws no random numbers: the same actions always give the same episode.
    pub fn is_deterministic(&self) -> bool {
        !self.0.draws
    }
}
