//! Certificates: every image is proved, and what is not claimed rightly is refused.

use super::{cases, hold, mode};
use nusselt::testing::{Case, case, check_verdict, gallery, mutated};
use nusselt::verify::Arithmetic;
use proptest::prelude::*;

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn every_image_is_proved_whatever_epsilon_is(case in mode().prop_flat_map(case), exponent in 0i32..24) {
        // From twice the scene's size to a millionth of it, and 0.
        let epsilon = hold(case.scene())?.diagonal() * 2f64.powi(1 - exponent);
        for epsilon in [0.0, epsilon].into_iter().filter(|epsilon| epsilon.is_finite()) {
            hold(hold(Case { epsilon, ..case.clone() }.image())?.certify())?;
        }
    }

    #[test]
    fn changed_evidence_is_accepted_only_if_it_claims_the_same(
        case in mode().prop_flat_map(case),
        bytes in any::<[u8; 8]>(),
    ) {
        let image = hold(case.image())?;
        let scene = image.scene();
        if scene.piece_count() > 0 {
            hold(check_verdict(&image, &mutated(&image.evidence(), scene, bytes)))?;
        }
    }
}

#[test]
fn the_gallery_is_proved_by_rational_numbers() {
    for (name, case) in gallery::all() {
        let image = case.image().unwrap_or_else(|error| panic!("{name}: {error}"));
        if let Err(defect) = image.evidence().check(image.scene(), Arithmetic::Rational) {
            panic!("{name}: {defect}\n{case:?}");
        }
    }
}
