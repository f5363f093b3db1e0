//! Any bytes: parse, compile, print.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tests::robustness::text(bytes));
