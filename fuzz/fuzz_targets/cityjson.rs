//! Any bytes: the CityJSON reader gives a scene or a reason, whatever the origin is, and never panics.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::io::{Origin, ReadOptions, cityjson};

fuzz_target!(|data: &[u8]| {
    let polygons = [Origin::File, Origin::Local, Origin::Integers].map(|origin| {
        let options = ReadOptions { origin, ..ReadOptions::default() };
        cityjson::parse(data, "fuzz.json", &options).ok().map(|loaded| loaded.scene.polygon_count())
    });
    // The numbering of polygons is that of the file.
    let mut known = polygons.into_iter().flatten();
    if let Some(first) = known.next() {
        assert!(known.all(|count| count == first), "{polygons:?}");
    }
});
