//! `nusselt verify`: checks a kept certificate, apart from the run that made it.

use crate::args::{Common, Loading};
use crate::failure::Failure;
use crate::input::load;
use crate::output::{print, print_json};
use crate::proof::{Proof, failed_certificate, name};
use crate::summary::{Lines, Timing, number, vector};
use glam::DVec3;
use nusselt::io::{CertificateRow, read_certificate};
use nusselt::scene::{PieceId, Scene, Side};
use nusselt::verify::{Arithmetic, Evidence, EvidenceDomain, EvidenceHorizon, EvidencePane};
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

/// The polygon that a piece is part of, and the name of a side.
fn surface(scene: &Scene, piece: PieceId, side: Side) -> (u32, &'static str) {
    (scene.piece(piece).polygon().0, if side == Side::Front { "front" } else { "back" })
}

fn domain_as_json(scene: &Scene, domain: &EvidenceDomain) -> Value {
    let horizon = domain.horizon().map(|horizon| match horizon {
        EvidenceHorizon::Normal(normal) => json!({ "kind": "hemisphere", "normal": normal.to_array() }),
        EvidenceHorizon::Above(piece, side) => {
            let (polygon, side) = surface(scene, piece, side);
            json!({ "kind": "above", "polygon": polygon, "side": side })
        }
    });
    match domain {
        EvidenceDomain::Frustum(normals) => json!({ "kind": "frustum", "normals": normals.map(|n| n.to_array()) }),
        EvidenceDomain::Window { panes, .. } => {
            let windows = panes.iter().map(|pane| match pane {
                EvidencePane::Polygon(polygon) => json!(polygon.0),
                EvidencePane::Ring(ring) => json!(ring.iter().map(DVec3::to_array).collect::<Vec<_>>()),
            });
            json!({ "kind": "window", "windows": windows.collect::<Vec<_>>(), "within": horizon })
        }
        _ => horizon.unwrap_or_else(|| json!({ "kind": "sphere" })),
    }
}

fn domain_in_words(scene: &Scene, domain: &EvidenceDomain) -> String {
    let horizon = domain.horizon().map(|horizon| match horizon {
        EvidenceHorizon::Normal(normal) => format!("hemisphere about {}", vector(normal)),
        EvidenceHorizon::Above(piece, side) => {
            let (polygon, side) = surface(scene, piece, side);
            format!("hemisphere above the {side} of polygon {polygon}")
        }
    });
    let horizon = horizon.unwrap_or_else(|| "sphere".to_owned());
    match domain {
        EvidenceDomain::Frustum(normals) => format!("camera between the planes {}", normals.map(vector).join("; ")),
        EvidenceDomain::Window { panes, .. } => format!("{} windows, {horizon}", panes.len()),
        _ => horizon,
    }
}

fn as_json(scene: &Scene, evidence: &Evidence, proof: &Proof, timing: Timing) -> Value {
    json!({
        "schema": "nusselt.verify/1",
        "eye": evidence.eye.to_array(),
        "domain": domain_as_json(scene, &evidence.domain),
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
    lines.add("domain", domain_in_words(scene, &evidence.domain));
    lines.add("epsilon", number(evidence.epsilon));
    proof.tell(&mut lines);
    lines.add("time", format!("load {:.3} s", timing.load_s));
    lines.0
}
