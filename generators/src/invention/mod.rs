//! Invention of rules from mechanics whose ports are merged, so that one sprite type has opposed uses. One mechanic
//! needs the type, and another uses it up, removes it, or makes it a danger or an obstacle.
//!
//! A [`Mechanic`](mechanic::Mechanic) consists of a few VGDL clauses about open roles, which are called its *ports*. An
//! [`Invention`] combines mechanics and an ending, and partitions the ports: the ports in one class are merged into one
//! type. `soundness.rs` rejects partitions by the tags of their ports before anything is compiled. `emit/` writes the
//! rules of the remaining partitions, and `fiction/` finds nouns that suit everything that a type does.

mod draw;
mod emit;
#[cfg(test)]
mod ending_tests;
mod fiction;
mod genome;
mod mechanic;
mod merge;
mod profile;
mod soundness;
mod supply;
#[cfg(test)]
mod tests;
mod variation;

pub use draw::{Census, InventionConfig, Lead, is_part, share_idea};
pub use genome::{Invented, Invention};
pub use mechanic::MechanicInWords;
pub use profile::{Profile, Verb};
pub use supply::InventionSupply;
pub use variation::InventionVariation;
