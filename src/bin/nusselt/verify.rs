//! `nusselt verify`: checks a kept certificate, apart from the run that made it.

use crate::args::{Common, Loading};
use crate::failure::Failure;
use crate::input::load;
use crate::output::{print, print_json};
use crate::proof::{Proof, failed_certificate, name};
use crate::summary::{Lines, Timing, number, vector};
use nusselt::io::{CertificateRow, read_certificate};
use nusselt::scene::{Scene, Side};
use nusselt::verify::{Arithmetic, Evidence, EvidenceDomain};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Instant;

const EXAMPLE: &str = "\
Example: keep the proof of what is seen, and check it later, on another machine or by other arithmetic
  nusselt contour room.obj --eye 2,1.5,1.2 --sphere --certificate proof.json
  nusselt verify room.obj proof.json --rational

What is proved is what the file claims: the eye, the directions and the epsilon that are printed. With an epsilon above 0 the
order within the slivers that the file lists is excused, not proved.";

/// Check a certificate that contour --certificate kept against the scene, read again
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
pub(crate) struct Verify {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON
    scene: PathBuf,
    /// The certificate
    certificate: PathBuf,
    /// Use rational numbers alone: shares no predicate with what made the image, and takes about a hundred times as long
    #[arg(long)]
    rational: bool,
    #[command(flatten)]
    loading: Loading,
}

impl Verify {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        let (scene, load_s) = load(&self.scene, std::iter::empty(), &self.loading, common)?;
        let start = Instant::now();
        let refused = |error: nusselt::io::CertificateError| Failure::Work(error.to_string());
        let kept = read_certificate(&self.certificate).map_err(refused)?;
        kept.fit(&scene, &self.certificate.display().to_string()).map_err(refused)?;
        let load_s = load_s + start.elapsed().as_secs_f64();
        let evidence = &kept.evidence;
        let arithmetic = if self.rational { Arithmetic::Rational } else { Arithmetic::Kernel };
        let start = Instant::now();
        let outcome = evidence.check(&scene, arithmetic);
        let certify_ms = start.elapsed().as_secs_f64() * 1e3;
        let certificate = outcome.map_err(|defect| failed_certificate(&self.certificate, &self.scene, &defect))?;
        let proof = Proof::new(certificate, evidence, arithmetic, certify_ms);
        let timing = Timing { certify_ms: Some(certify_ms), ..Timing::new(load_s, 0.0, &[]) };
        if common.json {
            return print_json(&as_json(&scene, evidence, &proof, timing));
        }
        if common.quiet { Ok(()) } else { print(&in_words(&scene, evidence, &proof, timing)) }
    }
}

/// The polygon and the side of it that a domain lies above.
fn above(scene: &Scene, domain: EvidenceDomain) -> Option<(u32, &'static str)> {
    let EvidenceDomain::Above(piece, side) = domain else { return None };
    Some((scene.piece(piece).polygon().0, if side == Side::Front { "front" } else { "back" }))
}

fn as_json(scene: &Scene, evidence: &Evidence, proof: &Proof, timing: Timing) -> Value {
    let domain = match (evidence.domain, above(scene, evidence.domain)) {
        (_, Some((polygon, side))) => json!({ "kind": "above", "polygon": polygon, "side": side }),
        (EvidenceDomain::Hemisphere(normal), _) => json!({ "kind": "hemisphere", "normal": normal.to_array() }),
        _ => json!({ "kind": "sphere" }),
    };
    json!({
        "schema": "nusselt.verify/1",
        "eye": evidence.eye.to_array(),
        "domain": domain,
        "epsilon": evidence.epsilon,
        "slivers": evidence.slivers.len(),
        "arithmetic": name(proof.arithmetic),
        "certificate": CertificateRow::from(proof.certificate),
        "timing": timing,
    })
}

fn in_words(scene: &Scene, evidence: &Evidence, proof: &Proof, timing: Timing) -> String {
    let mut lines = Lines::default();
    lines.add("eye", vector(evidence.eye));
    match (evidence.domain, above(scene, evidence.domain)) {
        (_, Some((polygon, side))) => lines.add("domain", format!("hemisphere above the {side} of polygon {polygon}")),
        (EvidenceDomain::Hemisphere(normal), _) => lines.add("domain", format!("hemisphere about {}", vector(normal))),
        _ => lines.add("domain", "sphere"),
    }
    lines.add("epsilon", number(evidence.epsilon));
    proof.tell(&mut lines);
    lines.add("time", format!("load {:.3} s", timing.load_s));
    lines.0
}
