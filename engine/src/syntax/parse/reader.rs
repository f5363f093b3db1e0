//! The parser's state.

use crate::diagnostic::Diagnostic;
use crate::syntax::description::Description;

/// The parser's state. The methods that read lines are in `lines.rs`, and the methods that read tokens are
/// in `tokens.rs`.
#[derive(Default)]
pub(super) struct Reader {
    pub(super) description: Description,
    pub(super) problems: Vec<Diagnostic>,
    /// `true` if the indentation of the SpriteSet's lines is aligned to columns. In that case, lines that
    /// deviate have already been reported.
    pub(super) columns: bool,
}
