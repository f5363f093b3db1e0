//! Interprets arbitrary bytes as a level of a valid game. Parses the level, starts it, and plays a few ticks.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    tests::robustness::level(bytes);
});
