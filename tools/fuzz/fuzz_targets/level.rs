//! Any bytes as a level of a valid game: read, start, play a few ticks.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    tests::robustness::level(bytes);
});
