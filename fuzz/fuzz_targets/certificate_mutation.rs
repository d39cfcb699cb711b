//! Certificates: the image is proved; with a change in its evidence, which the last eight bytes choose, both arithmetics
//! come to one verdict, and accept only what claims the same.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::testing::{Case, check_verdict, mutated};

fuzz_target!(|data: &[u8]| {
    let Some(case) = Case::decode(data) else { return };
    let Ok(image) = case.image() else { return };
    if let Err(defect) = image.certify() {
        panic!("{defect}\n{case:?}");
    }
    let scene = image.scene();
    if scene.piece_count() == 0 || image.cell_count() > 400 {
        return;
    }
    let mut bytes = [0; 8];
    for (byte, last) in bytes.iter_mut().zip(data.iter().rev()) {
        *byte = *last;
    }
    let changed = mutated(&image.evidence(), scene, bytes);
    if let Err(defect) = check_verdict(&image, &changed) {
        panic!("{defect}\nwith {bytes:?} of {case:?}");
    }
});
