//! Any bytes: the PLY reader gives a scene or a reason, and never panics.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::io::{ReadOptions, ply};

fuzz_target!(|data: &[u8]| {
    let _ = ply::parse(data, "fuzz.ply", &ReadOptions::default());
});
