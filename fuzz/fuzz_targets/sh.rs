//! Any bytes: the reader of spherical harmonics gives a BRDF or a reason, and what was read and is written again reads the same.
#![no_main]

use glam::DVec3;
use libfuzzer_sys::fuzz_target;
use nusselt::brdf::Brdf;
use nusselt::io::{parse_sh, read_sh, write_sh};

fuzz_target!(|data: &[u8]| {
    let Ok(brdf) = parse_sh(data, "fuzz.sh") else { return };
    let [one, other] = [DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.48, 0.64, 0.6)];
    let [there, back] = [brdf.eval(one, other), brdf.eval(other, one)];
    assert!(there.is_finite() && back.is_finite());
    if brdf.is_reciprocal() {
        // Sums of coefficients to 1e12, at most 16 bits or so more of them in size.
        let most: f64 = brdf.coefficients().iter().map(|c| c.abs().max_element()).sum();
        assert!((there - back).abs().max_element() <= 1e-9 * most);
    }
    // A file takes longer than all the rest.
    if data.len() % 8 == 0 {
        let path = std::env::temp_dir().join(format!("nusselt-fuzz-sh-{}", std::process::id()));
        write_sh(&path, &brdf).expect("room for it");
        assert_eq!(read_sh(&path).expect("what was written is read"), brdf);
        std::fs::remove_file(&path).expect("it is there");
    }
});
