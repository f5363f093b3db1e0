//! Derives a valid game, a level and actions from arbitrary bytes. Plays the actions and checks every state.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    tests::robustness::play(bytes);
});
