//! Proofs: how it is said that one succeeded or failed.

use crate::failure::Failure;
use crate::summary::{Lines, number};
use nusselt::contour::ContourImage;
use nusselt::scene::Scene;
use nusselt::verify::{Arithmetic, Certificate, Defect, Evidence};
use std::path::Path;
use std::time::Instant;

/// A proof that succeeded.
pub(crate) struct Proof {
    pub(crate) certificate: Certificate,
    pub(crate) arithmetic: Arithmetic,
    pub(crate) certify_ms: f64,
    epsilon: f64,
    slivers: usize,
}

impl Proof {
    pub(crate) fn new(certificate: Certificate, evidence: &Evidence, arithmetic: Arithmetic, certify_ms: f64) -> Self {
        Self { certificate, arithmetic, certify_ms, epsilon: evidence.epsilon, slivers: evidence.slivers.len() }
    }
}

/// Proves an image that was just made of the scene of a file; the evidence is for keeping.
pub(crate) fn prove(file: &Path, image: &ContourImage, arithmetic: Arithmetic) -> Result<(Evidence, Proof), Failure> {
    let start = Instant::now();
    let evidence = image.evidence();
    let outcome = evidence.check(image.scene(), arithmetic);
    let certify_ms = start.elapsed().as_secs_f64() * 1e3;
    let certificate = outcome.map_err(|defect| failed_image(file, image.scene(), &evidence, &defect))?;
    let proof = Proof::new(certificate, &evidence, arithmetic, certify_ms);
    Ok((evidence, proof))
}

/// The name by which an arithmetic is asked for.
pub(crate) fn name(arithmetic: Arithmetic) -> &'static str {
    match arithmetic {
        Arithmetic::Kernel => "kernel",
        Arithmetic::Rational => "rational",
    }
}

impl Proof {
    /// Says that it succeeded, and what exactly was proved.
    pub(crate) fn tell(&self, lines: &mut Lines) {
        let Certificate { cells, great_circles, exact_decisions } = self.certificate;
        let (arithmetic, ms) = (name(self.arithmetic), self.certify_ms);
        lines.add("proof", format!("holds for all directions; {arithmetic} arithmetic, {ms:.3} ms"));
        let numbers = format!("{cells} cells on {great_circles} great circles, {exact_decisions} exact decisions");
        lines.add("", numbers);
        if self.slivers > 0 {
            let (slivers, epsilon) = (self.slivers, number(self.epsilon));
            lines.add("", format!("but for the order of {slivers} slivers, left uncut by epsilon {epsilon}"));
        }
    }
}

/// An image that was just made failed its proof: the program is wrong, not its input; but with an epsilon,
/// more may be out of order than is excused.
///
/// One message: what is wrong where, then the eye and the polygons that take part as lines of Rust.
fn failed_image(file: &Path, scene: &Scene, evidence: &Evidence, defect: &Defect) -> Failure {
    let lines = defect.to_rust(evidence, scene);
    let [what, advice] = if evidence.epsilon > 0.0 {
        ["the contour image failed its proof", "try a smaller --epsilon; if it must hold, report"]
    } else {
        ["the contour image is wrong, which is a bug of this program", "please report"]
    };
    let lines = lines.trim_end();
    let what = format!("{what}: {defect}; nothing was written, {advice} this with the lines that follow\n{lines}");
    Failure::about(file, &what)
}

/// A kept certificate does not hold.
pub(crate) fn failed_certificate(file: &Path, scene: &Path, defect: &Defect) -> Failure {
    let reason = match defect {
        // Says so itself.
        Defect::Malformed { .. } => "",
        _ => {
            "; the scene or the certificate was changed, or the image was wrong: make it anew with contour \
              --certificate"
        }
    };
    Failure::about(file, &format!("the certificate does not hold for {}: {defect}{reason}", scene.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use nusselt::bsp::{BspOptions, SceneBsp};
    use nusselt::contour::{Domain, Viewpoint};

    fn message(failure: Failure) -> String {
        let Failure::Work(message) = failure else { panic!("not exit code 1: {failure:?}") };
        message
    }

    #[test]
    fn a_failed_proof_says_what_is_wrong_where_and_gives_lines_to_paste() {
        let scene = nusselt::samples::cornell_box().to_builder().build().expect("the box");
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0");
        let eye = Viewpoint::free(DVec3::new(278.0, 273.0, -100.0));
        let evidence = bsp.view(&eye, &Domain::Sphere).expect("a good viewpoint").evidence();
        let file = Path::new("rooms/box.obj");

        let mut relabelled = evidence.clone();
        let cell = relabelled.cells.iter().position(|cell| cell.piece.is_some()).expect("something is seen");
        relabelled.cells[cell].piece = None;
        let defect = relabelled.check(&scene, Arithmetic::Kernel).expect_err("it shows background");
        let text = message(failed_image(file, &scene, &relabelled, &defect));
        let mut lines = text.lines();
        let first = lines.next().expect("a message");
        assert!(first.starts_with("rooms/box.obj: ") && first.contains(&format!("cell {cell} ")), "{first}");
        assert!(first.contains("a bug of this program") && first.contains("nothing was written"), "{first}");
        assert!(lines.any(|line| line == "let eye = DVec3::new(278.0, 273.0, -100.0);"), "{text}");
        assert!(text.contains("let polygons") && text.ends_with("];"), "{text}");
        let kept = message(failed_certificate(Path::new("kept.json"), file, &defect));
        assert!(kept.starts_with("kept.json: ") && kept.contains("rooms/box.obj"), "{kept}");
        assert_eq!(kept.lines().count(), 1);

        let mut with_epsilon = relabelled.clone();
        with_epsilon.epsilon = 0.5;
        let text = message(failed_image(file, &scene, &with_epsilon, &defect));
        assert!(text.contains("try a smaller --epsilon") && !text.contains("bug"), "{text}");

        let mut lacking = evidence.clone();
        lacking.cells.remove(0);
        let defect = lacking.check(&scene, Arithmetic::Kernel).expect_err("there is a gap");
        let text = message(failed_image(file, &scene, &lacking, &defect));
        assert!(text.contains("great circle "), "{text}");
    }

    #[test]
    fn slivers_are_told_beside_the_proof() {
        let evidence = Evidence {
            eye: DVec3::ZERO,
            domain: nusselt::verify::EvidenceDomain::Sphere,
            epsilon: 0.5,
            slivers: Vec::new(),
            splitters: Vec::new(),
            cells: Vec::new(),
        };
        let certificate = Certificate { cells: 8, great_circles: 3, exact_decisions: 70 };
        let mut proof = Proof::new(certificate, &evidence, Arithmetic::Rational, 1.5);
        let told = |proof: &Proof| {
            let mut lines = Lines::default();
            proof.tell(&mut lines);
            lines.0
        };
        assert_eq!(
            told(&proof),
            "proof        holds for all directions; rational arithmetic, 1.500 ms\n             \
             8 cells on 3 great circles, 70 exact decisions\n"
        );
        proof.slivers = 2;
        assert!(told(&proof).contains("but for the order of 2 slivers, left uncut by epsilon 0.5"));
    }
}
