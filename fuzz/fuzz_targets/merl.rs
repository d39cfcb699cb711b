//! Any bytes, as they are and as a whole file of their repetitions: the reader of measurements gives a BRDF or a reason, and a BRDF is one.
#![no_main]

use glam::DVec3;
use libfuzzer_sys::fuzz_target;
use nusselt::brdf::{Brdf, Merl, Unmeasured};
use nusselt::io::parse_merl;

/// Three sizes, and three tables of 90 x 90 x 180 numbers.
const HEADER: usize = 12;
const LENGTH: usize = HEADER + 3 * 8 * 90 * 90 * 180;

fn check(brdf: &Merl) {
    assert!(brdf.values().iter().all(|value| value.is_finite() && value.min_element() >= 0.0));
    for [one, other] in [
        [DVec3::Z, DVec3::Z],
        [DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.6, 0.0, 0.8)],
        [DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.48, 0.64, 0.6)],
        [DVec3::new(1.0, 0.0, 1e-3).normalize(), DVec3::new(-1.0, 0.1, 1e-4).normalize()],
    ] {
        let [there, back] = [brdf.eval(one, other), brdf.eval(other, one)];
        assert!(there.is_finite() && there.min_element() >= 0.0);
        // Angles are rounded, and what is next to a bin may be 1e12.
        let most = brdf.values().iter().fold(0.0_f64, |most, value| most.max(value.max_element()));
        assert!((there - back).abs().max_element() <= 1e-7 * most);
    }
    let _ = brdf.form(DVec3::new(0.6, 0.0, 0.8));
}

fuzz_target!(|data: &[u8]| {
    let ways = [Unmeasured::Refuse, Unmeasured::Fill];
    for unmeasured in ways {
        // Of this length none is.
        assert!(parse_merl(data, "fuzz.binary", unmeasured).is_err());
    }
    let Some((header, numbers)) = data.split_at_checked(HEADER).filter(|(_, numbers)| !numbers.is_empty()) else {
        return;
    };
    let mut file = header.to_vec();
    file.extend(numbers.iter().cycle().take(LENGTH - HEADER));
    // The last byte tells which way.
    let unmeasured = ways[usize::from(numbers[numbers.len() - 1] & 1)];
    if let Ok(brdf) = parse_merl(&file, "fuzz.binary", unmeasured) {
        check(&brdf);
    }
});
