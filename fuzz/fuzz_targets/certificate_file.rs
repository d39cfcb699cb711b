//! Any bytes: the reader of certificates gives evidence or a reason; checking that against a box comes to an end; and
//! what is written reads back the same.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::io::{KeptCertificate, write_certificate};
use nusselt::scene::{Material, Scene};
use nusselt::verify::Arithmetic;
use std::sync::LazyLock;

/// A box, seen from inside: the scene of the seeds.
static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let vertices: Vec<[f64; 3]> = (0..8).map(|k| [1, 2, 4].map(|bit| f64::from(u8::from(k & bit != 0)))).collect();
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]].map(Vec::from);
    Scene::builder().mesh(&vertices, &faces, Material::new("m")).build().expect("a box")
});

fuzz_target!(|data: &[u8]| {
    let Ok(kept) = KeptCertificate::from_json(data, "fuzz.json") else { return };
    let _ = kept.fit(&SCENE, "fuzz.json");
    let fast = kept.evidence.check(&SCENE, Arithmetic::Kernel);
    let slow = kept.evidence.check(&SCENE, Arithmetic::Rational);
    assert_eq!(
        fast.as_ref().map_err(|d| d.rule()).map(|c| c.cells),
        slow.as_ref().map_err(|d| d.rule()).map(|c| c.cells)
    );
    let mut written = Vec::new();
    write_certificate(&kept.evidence, &SCENE, &mut written).expect("memory takes all");
    let again = KeptCertificate::from_json(&written, "again.json").expect("what was written is read");
    assert_eq!(again.evidence, kept.evidence);
});
