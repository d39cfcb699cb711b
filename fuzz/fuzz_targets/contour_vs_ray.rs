//! Labels: every cell shows what a ray in it meets, and so does the place of the case's own direction.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::contour::Location;
use nusselt::testing::{Case, RayAnswer, RayOracle, check_labels};

fuzz_target!(|case: Case| {
    let Ok(image) = case.image() else { return };
    let oracle = RayOracle::new(image.scene());
    if let Err(defect) = check_labels(&image, &oracle) {
        panic!("{defect}");
    }
    // With slivers the order may be wrong; what is seen at all may not.
    let Location::Cell(cell) = image.locate(case.direction) else { return };
    let seen = image.cell(cell).polygon();
    match oracle.cast(image.viewpoint().eye(), case.direction) {
        RayAnswer::Hit { polygon, .. } if image.uncut_slivers().is_empty() => assert_eq!(seen, Some(polygon)),
        RayAnswer::Hit { .. } => assert!(seen.is_some()),
        RayAnswer::Miss => assert_eq!(seen, None),
        RayAnswer::Boundary => {}
    }
});
