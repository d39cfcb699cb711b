//! Stated errors of all models against a truth that shares nothing with them but the models' values.

use super::{at, models};
use crate::brdf::reflect::{Lit, Surroundings, reflect};
use crate::brdf::{Brdf, Form, Fresnel, Ggx, RgbEstimate, ShBrdf, ShSymmetry};
use crate::integral::brute::over_triangle;
use crate::integral::random::{Random, Tally};
use crate::integral::{CubatureOptions, Smoothness, clip, perimeter, solid_angle};
use glam::DVec3;

/// Cases in all.
const CASES: usize = 10_000;

/// Integrals by 100 points a triangle, in quarters until the quarters sum to what the whole gave, with what they differ by.
struct Truth<'a, F> {
    f: &'a F,
    axis: DVec3,
    /// The width of the narrowest detail at the axis.
    width: f64,
    /// What a triangle and its quarters may differ by.
    tolerance: f64,
    value: DVec3,
    doubt: DVec3,
    evaluations: usize,
}

impl<F: Fn(DVec3) -> DVec3> Truth<'_, F> {
    fn add(&mut self, [a, b, c]: [DVec3; 3], whole: DVec3, depth: u32) {
        let [d, e, g] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
        let quarters = [[a, d, g], [d, b, e], [g, e, c], [d, e, g]];
        let values = quarters.map(|quarter| over_triangle(quarter, self.f));
        self.evaluations += 400;
        let sum: DVec3 = values.iter().sum();
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let near = ((a + b + c) / 3.0).distance(self.axis) - longest;
        let is_fine = longest < 0.5 && longest < self.width + near.max(0.0);
        let off = (sum - whole).abs();
        if depth == 0 || (is_fine && off.max_element() <= self.tolerance) {
            (self.value, self.doubt) = (self.value + sum, self.doubt + off);
            return;
        }
        for (quarter, value) in quarters.into_iter().zip(values) {
            self.add(quarter, value, depth - 1);
        }
    }
}

/// A model's stated errors in random cases; how many of them the truth was not known well enough for.
fn check(name: &str, brdf: &dyn Brdf, width: f64, random: &mut Random, cases: usize) -> (Tally, usize) {
    let mut tally = Tally::new(name);
    let mut unknown = 0;
    while tally.cases + unknown < cases {
        // To 89.9 degrees.
        let outgoing = random.direction();
        let axis = crate::brdf::mirrored(outgoing);
        let polygon = random.polygon(axis, width);
        if solid_angle(&polygon) < 1e-7 {
            continue;
        }
        let lit: Vec<Lit> = Lit::new(&polygon, DVec3::ONE).into_iter().collect();
        let surroundings = Surroundings { lit: &lit, from: &|_| RgbEstimate::default() };
        let form = brdf.form(outgoing);
        let (cuts, is_smooth) = match &form {
            Form::Lobes(lobes) => (lobes.iter().map(|lobe| lobe.axis).collect(), true),
            Form::General { creases, smoothness, .. } => (creases.clone(), *smoothness == Smoothness::Smooth),
            _ => (vec![axis], true),
        };
        // Of what has kinks the truth is dear.
        let digits = if is_smooth { random.between(2.0, 6.0) } else { random.between(2.0, 3.5) };
        let options = CubatureOptions { relative: 10_f64.powf(-digits), absolute: 0.0, evaluations: 1_000_000 };
        let eval = |incoming| brdf.eval(incoming, outgoing);
        let found = reflect(form, &eval, outgoing, &surroundings, options);
        let (stated, size) = (found.error.max_element(), found.value.abs().max_element());
        // Less than any light can be told from: the tail of a lobe that ends before the polygon.
        if size < 1e-30 {
            continue;
        }
        let f = |incoming: DVec3| brdf.eval(incoming, outgoing) * incoming.z;
        let narrow = width * outgoing.z.max(width).min(1.0);
        let (value, doubt) = (DVec3::ZERO, DVec3::ZERO);
        let mut truth = Truth {
            f: &f,
            axis,
            width: narrow,
            tolerance: (1e-5 * stated).max(1e-14 * size),
            value,
            doubt,
            evaluations: 0,
        };
        let outline = polygon.clone();
        let mut parts = vec![polygon];
        for cut in cuts {
            parts = parts.iter().flat_map(|part| [clip(part, cut), clip(part, -cut)]).collect();
        }
        for part in parts.iter().filter(|part| part.len() > 2) {
            let middle = part.iter().sum::<DVec3>().normalize_or(DVec3::Z);
            for k in 0..part.len() {
                let triangle = [middle, part[k], part[(k + 1) % part.len()]];
                truth.add(triangle, over_triangle(triangle, &f), if is_smooth { 16 } else { 10 });
            }
        }
        if truth.doubt.max_element() > (0.1 * stated).max(1e-13 * size) {
            unknown += 1;
            continue;
        }
        // Sums of very many terms. And both cut and halve the polygon, which rounds corners: by 2e-16 or so along the rim, where the value is about the mean, as this
        // is more than the rest for small polygons only.
        let rim = 4.0 * f64::EPSILON * perimeter(&outline) / solid_angle(&outline);
        let doubt = truth.doubt + (4e-15 + rim) * truth.value.abs();
        let off = (found.value - truth.value).abs();
        let is_too_small = !off.cmple(found.error + doubt).all();
        if is_too_small {
            println!("{name}: {outgoing} {digits}: {found:?} instead of {}", truth.value);
        }
        tally.add(
            if is_too_small { off.max_element() } else { off.max_element().min(stated) },
            stated,
            truth.evaluations,
        );
    }
    (tally, unknown)
}

/// Every second of the models, so that two tests run side by side.
fn check_every_second(first: usize) {
    let rough = Ggx::new(Fresnel::ALL, 0.5, 0.5).unwrap();
    let series = ShBrdf::project(&rough, ShSymmetry::Isotropic, 8).unwrap().brdf;
    let mut all: Vec<(String, Box<dyn Brdf>, f64)> = models();
    all.push(("SH 8".into(), Box::new(series), 0.3));
    all.retain(|(_, brdf, _)| !matches!(brdf.form(at(10.0, 0.0)), Form::Dirac { .. }));
    let cases = CASES.div_ceil(all.len());
    let (mut sum, mut unknown) = (0, 0);
    let mut random = Random(7 + first as u64);
    for (name, brdf, width) in all.iter().skip(first).step_by(2) {
        let (tally, left_out) = check(name, &**brdf, *width, &mut random, cases);
        sum += tally.cases;
        unknown += left_out;
        tally.check();
    }
    println!("{sum} cases; of {unknown} others the truth is not known");
    // One in twenty or so is not: where its triangles get too small before it settles.
    assert!(unknown * 10 < sum, "{unknown} of {sum}");
}

#[test]
fn stated_errors_are_honest_for_one_half_of_the_models() {
    check_every_second(0);
}

#[test]
fn stated_errors_are_honest_for_the_other_half_of_the_models() {
    check_every_second(1);
}
