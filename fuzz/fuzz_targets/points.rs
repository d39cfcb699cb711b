//! Any bytes: the reader of points gives points or a reason, and never panics.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::io::parse_points;

fuzz_target!(|data: &[u8]| {
    if let Ok(points) = parse_points(data, "fuzz.csv") {
        assert!(!points.is_empty());
        assert!(points.iter().all(|p| p.point.is_finite() && p.normal.is_finite() && p.normal != glam::DVec3::ZERO));
    }
});
