//! Any bytes: the OBJ reader gives a scene or a reason, and never panics.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    // The part after the first zero byte is the material file.
    let mut parts = data.splitn(2, |&byte| byte == 0);
    let (obj, mtl) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
    let _ = nusselt::io::obj::parse(obj, "fuzz.obj", &nusselt::io::ReadOptions::default(), |_| Ok(mtl.to_vec()));
});
