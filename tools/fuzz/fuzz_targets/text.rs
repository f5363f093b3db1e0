//! Parses, compiles and prints any bytes.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tests::robustness::text(bytes));
