//! Language models as designers of games.
//!
//! A [`Designer`] writes [`Draft`]s in three stages: the idea, the rules and the levels. Each stage comes with a
//! [`manual`]. After each answer, the designer receives the diagnostics, the verdicts and the gates as text, and may
//! repair its answer up to [`MAX_REPAIRS`] times. A [`DesignFolder`] stores the settings, one log per draft, the
//! finished drafts, and the accepted games. [`Reference`] designers are programs whose scores can be compared with a
//! model's [`DesignerScore`]. Everything except the answers can be reproduced exactly from the logs, without the model.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

mod answer;
mod brief;
mod designer;
mod dialogue;
mod draft;
mod error;
mod folder;
mod known;
pub mod manual;
mod references;
mod run;
mod score;
mod settings;
mod stages;
mod work;

pub use brief::{Brief, MAX_LEVELS, MAX_THEME};
pub use designer::Designer;
pub use draft::{Draft, DraftMeasures, MAX_REPAIRS, Spending, Status};
pub use error::DesignError;
pub use folder::{DesignFolder, GAMES_FOLDER, RESULTS_FILE};
pub use known::{Known, KnownGame, Nearest};
pub use references::Reference;
pub use run::{Outcome, Results, replay, run};
pub use score::{CostPerGame, DesignerScore, Rate, table};
pub use settings::{DesignSettings, FORMAT};
pub use stages::Stage;
