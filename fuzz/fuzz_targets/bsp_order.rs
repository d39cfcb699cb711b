//! Order: front to back no fragment hides an earlier one, but for recorded slivers; back to front is the
//! mirror.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::testing::{Case, check_mirror, check_order};

fuzz_target!(|case: Case| {
    let Ok(bsp) = case.bsp() else { return };
    let verdict = check_mirror(&bsp, case.eye).and_then(|()| check_order(&bsp, case.eye));
    if let Err(defect) = verdict {
        panic!("{defect}");
    }
    assert!(bsp.epsilon() > 0.0 || bsp.uncut_slivers().is_empty(), "slivers without an epsilon");
});
