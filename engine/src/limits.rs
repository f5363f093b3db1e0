//! Limits on the size of games, levels and states. Anything that exceeds a limit of a file is rejected with a diagnostic
//! (`too-large`, `too-long`, `too-deep`); an episode that exceeds one at run time ends
//! [`Stopped`](crate::Outcome::Stopped). `docs/reference/limits.md` lists them for users.

/// Bytes of game text that are read; a game is a few kilobytes.
pub const MAX_SOURCE: usize = 1 << 17;
/// Bytes of one line of a game, without its indent and comment.
pub const MAX_LINE: usize = 2048;
/// Bytes of the name of a sprite type.
pub const MAX_NAME: usize = 128;
/// Levels of nesting in a SpriteSet; the games of the reference have four at most.
pub const MAX_NESTING: usize = 32;
/// Sprite types of a game.
pub const MAX_TYPES: usize = 512;
/// Parameters of a sprite type, those that it inherits included.
pub const MAX_PARAMETERS: usize = 256;
/// Names in one parameter of a sprite type.
pub const MAX_LIST: usize = 64;
/// Interactions of a game, each counted for each partner and each repetition.
pub const MAX_INTERACTIONS: usize = 20_000;
/// Cells that the largest sprite may cover along one side: the largest allowed `wMult` and `hMult`.
pub const MAX_REACH: i32 = 16;
/// Counters of a game.
pub const MAX_COUNTERS: i32 = 64;
/// Pixels of a cell.
pub const MAX_SQUARE: i32 = 10_000;
/// Problems of a file that are reported before the rest is summarised in one.
pub const MAX_PROBLEMS: usize = 100;

/// Bytes of level text that are read.
pub const MAX_LEVEL_TEXT: usize = 1 << 18;
/// Columns or rows of a level.
pub const MAX_SIDE: usize = 512;
/// Cells of a level.
pub const MAX_CELLS: usize = 1 << 16;
/// Sprites that a level may place, and sprites alive: the reference refuses to make more, with a message each.
pub const MAX_SPRITES: usize = 10_000;
/// Sprites that a level may try to place when it is loaded as the reference does: the surplus is rejected one by one.
pub const MAX_ATTEMPTS: usize = 1 << 20;

/// The tick at which the reference ends every game.
pub const MAX_TICKS: i32 = 2000;
/// Messages after which the reference ends a game without a winner.
pub const MAX_MESSAGES: u32 = 25;
/// Sprites that a state can hold, whatever the reference's counter says: it counts some kills twice.
pub const MAX_SLOTS: usize = 64_000;
/// Work of one tick: an executed effect counts [`EFFECT_WORK`], and each sprite or cell that is looked at counts one. The
/// busiest tick in the traces of the reference needs about 7000.
pub const MAX_WORK: usize = 1 << 18;
/// The work of one execution of an effect: at most 32,768 effects per tick.
pub const EFFECT_WORK: usize = 8;
/// Timers that can be planned at the same time.
pub const MAX_TIMERS: usize = 1 << 16;
/// Resources held by all sprites together, each kind that a sprite holds counted once.
pub const MAX_HELD: usize = 1 << 14;
/// Names of sprites in an observation, each counted in each cell.
pub const MAX_SEEN: usize = 1 << 20;
