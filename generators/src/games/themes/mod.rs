//! The themes: one file each, data only.
//!
//! Within a theme no word serves two roles, so that any patterns can be combined in one game.

pub(crate) mod bakery;
pub(crate) mod beehive;
pub(crate) mod caravan;
pub(crate) mod cellar;
pub(crate) mod glacier;
pub(crate) mod harbour;
pub(crate) mod library;
pub(crate) mod observatory;
pub(crate) mod railyard;
pub(crate) mod swamp;
pub(crate) mod theatre;
pub(crate) mod tidepool;
