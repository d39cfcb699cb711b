//! What property tests and fuzzing once found, by name: each a case printed as Rust (`{:?}` of a `Case`), or the bytes of
//! a fuzzer's input.
//!
//! From the fuzzer: `cargo +nightly fuzz fmt TARGET FILE` prints the case; or keep the bytes, and take them
//! with `decoded`. Whatever it was that failed, every check is run.

use nusselt::scene::Side;
use nusselt::testing::{Case, Faces, Mode, Outlook, check_bsp, check_image};

/// Every check of the testing module.
#[track_caller]
fn holds(case: &Case) {
    let bsp = case.bsp().expect("the case has a BSP");
    assert_eq!(check_bsp(&bsp, case.eye), Ok(()), "{case:?}");
    let image = case.view(&bsp).expect("the case has an image");
    assert_eq!(check_image(&image), Ok(()), "{case:?}");
}

/// A fuzzer's input, of a version that is still read.
#[track_caller]
fn decoded(bytes: &[u8]) -> Case {
    Case::decode(bytes).expect("an input of a known version")
}

/// Seen from that far, the square of an edge's length underflows: the nearest point was not a number.
#[test]
fn a_viewpoint_on_a_surface_is_found_from_afar() {
    let mut case = Case {
        mode: Mode::Chaos,
        faces: Faces::from(vec![vec![[3.0, 0.0, 0.0], [0.0, 0.0, 0.0], [3.0, 1.0, 0.0]]]),
        eye: [3.599_131_035_634_557e162, 0.0, 0.0].into(),
        direction: [0.0, 0.0, 1.0].into(),
        outlook: Outlook::Above(0, Side::Front),
        epsilon: 0.0,
    };
    holds(&case);
    for exponent in [-1074, -600, 0, 150, 300, 600, 1023] {
        case.eye.x = 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2);
        holds(&case);
    }
}

#[test]
fn an_input_of_no_faces_and_one_of_nothing_but_copies_hold() {
    holds(&decoded(&[Case::VERSION]));
    holds(&decoded(&[Case::VERSION, 0, 4, 5, 6, 3, 0, 0, 9, 8, 8, 6, 0, 7, 0, 8, 0, 130, 9, 1, 3, 4, 5, 6, 7, 8]));
}
