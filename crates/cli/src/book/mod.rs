//! The pages of the book.

#[cfg(test)]
mod command_page;
pub(crate) mod manual;
