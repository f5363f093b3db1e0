//! A cache of compiled games, indexed by their text, because a page sends the same text many times.

use engine::{Analysis, Diagnostics, Game, Level};
use render::Looks;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use crate::positions;
use crate::refusal::Refusal;
use axum::http::StatusCode;

/// The maximum number of games in the cache.
const KEPT: usize = 16;

/// A compiled game, with all data derived from its rules.
pub(crate) struct Compiled {
    pub(crate) source: String,
    pub(crate) game: Game,
    pub(crate) analysis: Analysis,
    pub(crate) looks: Looks,
}

impl Compiled {
    fn of(source: &str) -> Result<Compiled, Diagnostics> {
        let game = Game::from_source(source)?;
        let analysis = Analysis::of(&game);
        let looks = Looks::of(&analysis);
        Ok(Compiled { source: source.to_owned(), game, analysis, looks })
    }

    /// Parses a level of the game.
    pub(crate) fn level(&self, text: &str) -> Result<Level, Refusal> {
        self.game.level(text).map_err(|problems| refused("the level", text, &problems))
    }
}

/// The most recently compiled games.
#[derive(Default)]
pub(crate) struct Cache(Mutex<VecDeque<Arc<Compiled>>>);

impl Cache {
    /// Returns the compiled game for a text, or the problems in the text.
    pub(crate) fn find(&self, source: &str) -> Result<Arc<Compiled>, Diagnostics> {
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let found = lock().iter().find(|known| known.source == source).cloned();
        if let Some(found) = found {
            return Ok(found);
        }
        let fresh = Arc::new(Compiled::of(source)?);
        let mut kept = lock();
        if kept.len() == KEPT {
            kept.pop_front();
        }
        kept.push_back(fresh.clone());
        Ok(fresh)
    }

    /// Returns the compiled game like [`Cache::find`], but returns an error response instead of problems, for requests
    /// that need a game without problems.
    pub(crate) fn need(&self, source: &str) -> Result<Arc<Compiled>, Refusal> {
        self.find(source).map_err(|problems| refused("the game", source, &problems))
    }
}

/// Returns an error response that lists the problems in a text.
fn refused(what: &str, text: &str, Diagnostics(problems): &Diagnostics) -> Refusal {
    let first = problems.first().map_or("", |problem| problem.message.as_str());
    let listed: Vec<_> = problems.iter().map(|problem| positions::problem(text, problem)).collect();
    Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, format_args!("{what} has problems: {first}"))
        .help("fix them first")
        .with("problems", listed)
}
