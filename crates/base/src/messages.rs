//! Parts of messages: counts and paths.

use std::fmt::{Display, Formatter, Result, Write};
use std::path::Path;

/// Returns a number followed by its noun, in the plural unless the number is 1.
///
/// ```
/// assert_eq!([0, 1, 2].map(|number| infinite_arcade_base::count(number, "tick")), ["0 ticks", "1 tick", "2 ticks"]);
/// ```
pub fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// A path for display in messages. File names may contain line breaks and other control characters, which
/// could forge lines in a message. Control characters are therefore escaped. JSON documents contain the path
/// unchanged.
///
/// ```
/// use infinite_arcade_base::MessagePath;
/// assert_eq!(std::path::Path::new("a\nb").in_message().to_string(), "a\\u{a}b");
/// ```
pub trait MessagePath {
    /// Returns the path's text for a message.
    fn in_message(&self) -> InMessage<'_>;
}

impl<P: AsRef<Path> + ?Sized> MessagePath for P {
    fn in_message(&self) -> InMessage<'_> {
        InMessage(self.as_ref())
    }
}

/// A path that is displayed with its control characters escaped. See [`MessagePath`].
#[derive(Clone, Copy, Debug)]
pub struct InMessage<'a>(&'a Path);

impl Display for InMessage<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        for character in self.0.to_string_lossy().chars() {
            match character.is_control() {
                true => write!(f, "{}", character.escape_unicode())?,
                false => f.write_char(character)?,
            }
        }
        Ok(())
    }
}
