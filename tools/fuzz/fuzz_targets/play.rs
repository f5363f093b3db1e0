//! Any bytes as a valid game, its level and actions: play, with every state checked.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    tests::robustness::play(bytes);
});
