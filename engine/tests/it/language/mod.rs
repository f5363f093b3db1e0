//! Tests the way from the text of a game to its rules: what is read, rejected, converted and reported.

mod as_reference;
mod causes;
mod clauses;
mod compile;
mod dialects;
mod game_space;
