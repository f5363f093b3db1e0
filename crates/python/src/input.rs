//! Texts with the names that messages give them.

/// A text and its name for the user.
#[derive(Clone, Debug)]
pub(crate) struct Named {
    pub(crate) name: String,
    pub(crate) text: String,
}
