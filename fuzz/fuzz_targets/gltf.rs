//! Any bytes: the glTF and GLB reader gives a scene or a reason, and never panics.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::io::{ReadOptions, gltf};

fuzz_target!(|data: &[u8]| {
    // The part after the first zero byte is the buffer beside, but for GLB, which has its own.
    let (json, buffer) = match data.iter().position(|&byte| byte == 0) {
        Some(end) if !data.starts_with(b"glTF") => (&data[..end], &data[end + 1..]),
        _ => (data, &data[..0]),
    };
    let _ = gltf::parse(json, "fuzz.gltf", &ReadOptions::default(), |_| Ok(buffer.to_vec()));
});
