//! The book's pages.

#[cfg(test)]
mod command_page;
pub(crate) mod manual;
