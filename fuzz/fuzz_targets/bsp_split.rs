//! Splitting: the fragments of every piece tile it exactly, whatever epsilon is.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::testing::{Case, check_fragments};

fuzz_target!(|case: Case| {
    let Ok(bsp) = case.bsp() else { return };
    if let Err(defect) = check_fragments(&bsp) {
        panic!("{defect}");
    }
});
