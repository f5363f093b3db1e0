//! Treats any bytes as a valid game, its level and actions, and plays them, checking every state.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    tests::robustness::play(bytes);
});
