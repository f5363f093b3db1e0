//! Interprets arbitrary bytes as the text of a game. Parses, compiles and prints the game.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tests::robustness::text(bytes));
