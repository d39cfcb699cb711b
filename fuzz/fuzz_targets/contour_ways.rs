//! Both ways to a view, by the 3D BSP and by a hierarchy of boxes, give the same regions, and the second is proved. So do faces cut to tiles,
//! which go into views together.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::bvh::SceneBvh;
use nusselt::testing::{Case, check_same_regions};

fuzz_target!(|case: Case| {
    let case = Case { epsilon: 0.0, ..case };
    check(&case);
    // Faces that are cut take the place of the first one in turn, so that tiles are cut again.
    let tiles = (0..2 * case.faces.len().min(4)).fold(case.faces.clone(), |faces, k| faces.split(k / 2 % faces.len()));
    check(&Case { faces: tiles, ..case });
});

fn check(case: &Case) {
    let Ok(by_bsp) = case.image() else { return };
    let (viewpoint, domain) = case.viewpoint(by_bsp.scene());
    let by_boxes = match SceneBvh::build(by_bsp.scene()).view(&viewpoint, &domain) {
        Ok(image) => image,
        Err(error) => panic!("there is a view by the BSP but none by boxes: {error}\n{case:?}"),
    };
    if let Err(defect) = by_boxes.certify() {
        panic!("{defect}\n{case:?}");
    }
    if let Err(defect) = check_same_regions(&by_bsp, &by_boxes) {
        panic!("{defect}\n{case:?}");
    }
}
