//! Tiling: solid angles sum to the domain's, form factors to 1, and directions lie in exactly one cell: those
//! through the scene's vertices and between them, inside of cells, and the case's own.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::testing::{Case, check_sums, check_tiling, telling_directions};

fuzz_target!(|case: Case| {
    let Ok(image) = case.image() else { return };
    let mut directions = telling_directions(&image);
    directions.push(case.direction);
    directions.retain(|&d| d != glam::DVec3::ZERO);
    let verdict = check_sums(&image).and_then(|()| check_tiling(&image, &directions));
    if let Err(defect) = verdict {
        panic!("{defect}");
    }
});
