//! Compiled games: immutable, valid and cheap to clone.

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

/// A compiled game, ready to be played.
#[derive(Clone, Debug)]
pub struct Game(pub(crate) Arc<Compiled>);

/// A game's rules, and data derived once from the rules.
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
    /// Creates a game from its rules.
    pub(crate) fn of(rules: Rules) -> Game {
        let models = Models::of(&rules);
        let plan = Plan::of(&rules, &models);
        Game(Arc::new(Compiled { rules, models, plan }))
    }

    /// Compiles a description: resolves its names and checks it.
    ///
    /// # Errors
    /// Returns all problems in the description, sorted by position.
    pub fn compile(description: &Description) -> Result<Game, Diagnostics> {
        compile::compile(description).map(Game::of)
    }

    /// Parses and compiles a game's text.
    ///
    /// # Errors
    /// Returns all problems in the text, sorted by position.
    pub fn from_source(source: &str) -> Result<Game, Diagnostics> {
        let (description, Diagnostics(read)) = crate::syntax::parse_all(source);
        match compile::compile(&description) {
            Ok(mut rules) if !Diagnostics::has_errors(&read) => {
                rules.warnings = causes::reported(read, rules.warnings, source).0;
                Ok(Game::of(rules))
            }
            // The text may have problems even if its description compiles. All problems should be reported in
            // one run.
            compiled => {
                let compiled = compiled.err().map_or(Vec::new(), |problems| problems.0);
                let Diagnostics(reported) = causes::reported(read, compiled, source);
                Err(Diagnostics(dialect::told(source, &description, reported)))
            }
        }
    }

    /// Returns the BLAKE3 digest of the canonical text without comments.
    pub fn digest(&self) -> Digest {
        self.0.digest
    }

    /// Returns the syntax tree from which the game was compiled.
    pub fn description(&self) -> &Description {
        &self.0.description
    }

    /// Parses and compiles a game's text in reference mode: faults are dropped or ignored if the reference
    /// engine does so, and the reference's messages are counted (`spec/01` §1). Use this mode only for
    /// comparisons with the reference; in strict mode, every fault is an error.
    ///
    /// # Errors
    /// Returns the fault on which the reference crashes.
    pub fn from_source_as_reference(source: &str) -> Result<Game, Diagnostics> {
        let (description, problems) = crate::syntax::parse_as_reference(source);
        if Diagnostics::has_errors(&problems) {
            return Err(Diagnostics(problems));
        }
        compile::compile_as_reference(&description).map(Game::of)
    }

    /// Returns the actions available to the avatar, sorted, without [`Action::Nil`]. Returns only [`Action::Nil`]
    /// if there is no avatar.
    pub fn actions(&self, state: &State) -> &'static [Action] {
        state.avatar_type().map_or(&[Action::Nil], |stype| self.0.types[stype.index()].actions)
    }

    /// Returns `true` if an action is among [`Game::actions`].
    pub(crate) fn allows(&self, state: &State, action: Action) -> bool {
        state.avatar_type().is_some_and(|stype| self.0.types[stype.index()].keys >> action as u8 & 1 != 0)
    }

    /// Returns the actions available to an avatar of the given type, sorted, without [`Action::Nil`]. Returns only
    /// [`Action::Nil`] if there are no others.
    pub fn actions_of(&self, avatar: SpriteType) -> &'static [Action] {
        self.0.types[avatar.index()].actions
    }

    /// Returns the rules as clauses. Games with equal clauses behave alike, but games that behave alike may
    /// have different clauses. Cost: O(types + interactions).
    pub fn clauses(&self) -> Clauses {
        compile::clauses(&self.0)
    }

    /// Returns all sprite types, in registry order.
    pub fn sprite_types(&self) -> impl Iterator<Item = SpriteType> + use<> {
        (0..self.0.types.len() as u16).map(SpriteType)
    }

    /// Returns a type's name, or `#-1` for an undeclared type. Only games loaded in reference mode can count
    /// undeclared types.
    pub fn name(&self, stype: SpriteType) -> &str {
        self.0.types.get(stype.index()).map_or("#-1", |info| &info.name)
    }

    /// Returns the same game with different names for its types in observations and texts. Types not in
    /// `names` keep their names. The [`description`](Game::description) and the digest do not change. Cost:
    /// one copy of the rules.
    pub fn under_names(&self, names: &BTreeMap<String, String>) -> Game {
        let mut compiled = (*self.0).clone();
        for info in &mut compiled.rules.types {
            if let Some(name) = names.get(&info.name) {
                info.name.clone_from(name);
            }
        }
        Game(Arc::new(compiled))
    }

    /// Returns the type with this name; `None` if there is no such type.
    pub fn sprite_type(&self, name: &str) -> Option<SpriteType> {
        self.sprite_types().find(|&stype| self.name(stype) == name)
    }

    /// Returns a type's class, or `None` for grouping nodes without a class.
    pub fn class(&self, stype: SpriteType) -> Option<SpriteClass> {
        self.0.types[stype.index()].class
    }

    /// Returns the initial orientation of a type's sprites, whether it is set by the type's line, inherited
    /// or set by the class. [`Direction::NONE`] means no orientation, and [`Direction::NIL`] means a random
    /// orientation.
    pub fn orientation(&self, stype: SpriteType) -> Direction {
        self.0.types[stype.index()].traits.orientation
    }

    /// Returns the maximum number of steps in an episode: one more than the lowest limit, because the
    /// reference counts the first step as tick 0. The limits are the `limit=` of each Timeout, and the
    /// reference's own limit.
    pub fn time_limit(&self) -> u64 {
        // The first step is the reference's tick 0.
        self.0.first_timeout.saturating_add(1).clamp(1, MAX_TICKS + 1).unsigned_abs().into()
    }

    /// Returns `true` if the game draws no random numbers, so that the same actions always produce the same
    /// episode.
    pub fn is_deterministic(&self) -> bool {
        !self.0.draws
    }
}
