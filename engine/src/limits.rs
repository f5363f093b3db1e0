//! Limits on the size of games, levels and states. A file that exceeds a limit is rejected with a diagnostic
//! (`too-large`, `too-long`, `too-deep`). An episode that exceeds a limit at run time ends with
//! [`Stopped`](crate::Outcome::Stopped). `docs/reference/limits.md` lists the limits for users.

/// The maximum length of a game's text in bytes. A typical game contains a few kilobytes.
pub const MAX_SOURCE: usize = 1 << 17;
/// The maximum length in bytes of one line in a game, excluding indentation and comment.
pub const MAX_LINE: usize = 2048;
/// The maximum length in bytes of a sprite type's name.
pub const MAX_NAME: usize = 128;
/// The maximum nesting depth in a SpriteSet. The reference's games have at most four levels.
pub const MAX_NESTING: usize = 32;
/// The maximum number of sprite types in a game.
pub const MAX_TYPES: usize = 512;
/// The maximum number of parameters of a sprite type, including inherited ones.
pub const MAX_PARAMETERS: usize = 256;
/// The maximum number of names in one parameter of a sprite type.
pub const MAX_LIST: usize = 64;
/// The maximum number of interactions in a game. An interaction counts once for each partner and each
/// repetition.
pub const MAX_INTERACTIONS: usize = 20_000;
/// The maximum number of cells that a sprite may cover along one side: the maximum of `wMult` and `hMult`.
pub const MAX_REACH: i32 = 16;
/// The maximum number of counters in a game.
pub const MAX_COUNTERS: i32 = 64;
/// The maximum side length of a cell in pixels.
pub const MAX_SQUARE: i32 = 10_000;
/// The maximum number of problems to report for a file. One additional problem summarises the rest.
pub const MAX_PROBLEMS: usize = 100;

/// The maximum length of a level's text in bytes.
pub const MAX_LEVEL_TEXT: usize = 1 << 18;
/// The maximum number of columns in a level, and the maximum number of rows.
pub const MAX_SIDE: usize = 512;
/// The maximum number of cells in a level.
pub const MAX_CELLS: usize = 1 << 16;
/// The maximum number of sprites that a level may place, and the maximum number of living sprites. The
/// reference logs a message for each sprite beyond this number.
pub const MAX_SPRITES: usize = 10_000;
/// The maximum number of sprites that a level loaded in reference mode may try to place. Sprites beyond
/// [`MAX_SPRITES`] are rejected one by one.
pub const MAX_ATTEMPTS: usize = 1 << 20;

/// The tick at which the reference ends every game.
pub const MAX_TICKS: i32 = 2000;
/// The number of messages after which the reference ends a game without a winner.
pub const MAX_MESSAGES: u32 = 25;
/// The maximum number of sprites in a state. This limit does not rely on the reference's counter, which
/// counts some kills twice.
pub const MAX_SLOTS: usize = 64_000;
/// The maximum work per tick. Each execution of an effect counts as [`EFFECT_WORK`], and each examined sprite
/// or cell counts as one. The busiest tick in the reference's traces needs about 7,000.
pub const MAX_WORK: usize = 1 << 18;
/// The work counted per execution of an effect, which allows up to 32,768 effects per tick.
pub const EFFECT_WORK: usize = 8;
/// The maximum number of simultaneously pending timers.
pub const MAX_TIMERS: usize = 1 << 16;
/// The maximum total number of holdings of all sprites. Each resource type that a sprite holds counts as one
/// holding.
pub const MAX_HELD: usize = 1 << 14;
/// The maximum number of sprite names in an observation, counting each name once per cell.
pub const MAX_SEEN: usize = 1 << 20;
