//! Any bytes: the STL reader gives a scene or a reason, and never panics.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::io::{ReadOptions, stl};

fuzz_target!(|data: &[u8]| {
    let _ = stl::parse(data, "fuzz.stl", &ReadOptions::default());
});
