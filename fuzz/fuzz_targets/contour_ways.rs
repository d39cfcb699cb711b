//! Both ways to a view, by the 3D BSP and by a hierarchy of boxes, give the same regions, and the second is proved.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::bvh::SceneBvh;
use nusselt::testing::{Case, check_same_regions};

fuzz_target!(|case: Case| {
    let Ok(by_bsp) = (Case { epsilon: 0.0, ..case.clone() }).image() else { return };
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
});
