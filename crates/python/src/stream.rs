//! Endless sequences of verified levels.

use crate::corpus::corpus;
use crate::errors::{failed, invalid};
use crate::game::{Game, Level};
use crate::interrupt::interruptible;
use base::Seed;
use forge::stream::{StreamConfig, StreamGame};
use pyo3::prelude::*;
use snapshots::released::Released;
use std::path::PathBuf;
use std::sync::Arc;

/// A stream of verified levels.
#[pyclass(module = "infinite_arcade", frozen)]
pub(crate) struct Stream(Arc<forge::stream::Stream>);

/// A game with its name and its levels.
type NamedGame<'py> = (String, Bound<'py, Game>, Vec<Bound<'py, Level>>);

#[pymethods]
impl Stream {
    #[new]
    #[pyo3(signature = (games, *, seed, difficulty = None, size = None, avoid = Vec::new()))]
    fn new(
        py: Python<'_>,
        games: Vec<NamedGame<'_>>,
        seed: &str,
        difficulty: Option<f64>,
        size: Option<(usize, usize)>,
        avoid: Vec<PathBuf>,
    ) -> PyResult<Stream> {
        let game = |(name, game, levels): NamedGame<'_>| StreamGame {
            name,
            game: game.get().0.game.clone(),
            levels: levels.iter().map(|level| level.get().level.as_ref().clone()).collect(),
        };
        let games: Vec<StreamGame> = games.into_iter().map(game).collect();
        let (config, seed) =
            (StreamConfig { difficulty, size, ..StreamConfig::default() }, Seed::from_text(seed));
        interruptible(py, move |_| {
            let mut stream = forge::stream::Stream::new(games, config, seed).map_err(invalid)?;
            for (_, source, levels, _) in corpus() {
                let game = engine::Game::from_source(&source).map_err(|problems| failed(&problems))?;
                let levels: Vec<_> = levels.iter().filter_map(|text| game.level(text).ok()).collect();
                stream.avoid(&game, &levels);
            }
            for release in &avoid {
                for game in Released::read(release).map_err(failed)?.games {
                    let levels: Vec<_> = game.levels.iter().map(|released| released.level.clone()).collect();
                    stream.avoid(&game.game, &levels);
                }
            }
            Ok(Stream(Arc::new(stream)))
        })
    }

    /// Makes an item, and returns it as JSON.
    fn item(&self, py: Python<'_>, index: u64) -> PyResult<String> {
        let stream = self.0.clone();
        interruptible(py, move |interrupt| {
            let item = stream.item(index, interrupt).map_err(failed)?;
            serde_json::to_string(&item).map_err(failed)
        })
    }
}
