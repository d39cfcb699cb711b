//! Projections, closed forms, tables that make no sense.

use super::{ShBrdf, ShSymmetry};
use crate::brdf::reflect::{Lit, Surroundings, reflect, white_furnace};
use crate::brdf::tests::{RHO, at, polar};
use crate::brdf::{Brdf, BrdfError, Form, Fresnel, Ggx, Lambert, Mirror, Phong, RgbEstimate, Sum};
use crate::integral::{CubatureOptions, Smoothness};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// A BRDF that is a polynomial of degree 4, even in z.
struct Polynomial {
    anisotropy: f64,
}

impl Brdf for Polynomial {
    fn eval(&self, u: DVec3, v: DVec3) -> DVec3 {
        let along = u.x * v.x + u.y * v.y;
        let heights = u.z * u.z * v.z * v.z;
        let twist = self.anisotropy * (u.x * v.x).powi(2);
        RHO * (0.1 + 0.02 * along + 0.03 * along * along + 0.01 * heights + twist) + DVec3::X * (0.01 * along.powi(4))
    }

    fn form(&self, _: DVec3) -> Form<'_> {
        Form::General { peaks: Vec::new(), creases: Vec::new(), smoothness: Smoothness::Smooth }
    }
}

fn pairs() -> impl Iterator<Item = (DVec3, DVec3)> {
    (0..200).map(|k| {
        let t = f64::from(k);
        (at((t * 7.3) % 90.0, t), at((t * 3.1) % 90.0, t * t))
    })
}

#[test]
fn what_is_a_series_is_projected_exactly() {
    for (symmetry, anisotropy) in [(ShSymmetry::Isotropic, 0.0), (ShSymmetry::General, 0.05)] {
        let exact = Polynomial { anisotropy };
        let projected = ShBrdf::project(&exact, symmetry, 4).unwrap();
        for (u, v) in pairs() {
            let off = projected.brdf.eval(u, v) - exact.eval(u, v);
            assert!(off.abs().max_element() < 1e-13, "{symmetry:?} {off}");
        }
        assert!(projected.largest_error.max_element() < 1e-13);
        assert!(projected.brdf.is_reciprocal());
    }
    // An isotropic table cannot hold it, and says so.
    let projected = ShBrdf::project(&Polynomial { anisotropy: 0.05 }, ShSymmetry::Isotropic, 4).unwrap();
    assert!(projected.rms_error.min_element() > 1e-4, "{projected:?}");
}

fn projected() -> Vec<(&'static str, ShBrdf)> {
    let of = |brdf: &dyn Brdf, symmetry, band| ShBrdf::project(brdf, symmetry, band).unwrap().brdf;
    let rough = Ggx::new(Fresnel::schlick(RHO).unwrap(), 0.5, 0.5).unwrap();
    let brushed = Ggx::new(Fresnel::ALL, 0.4, 0.8).unwrap();
    vec![
        ("Lambert", of(&Lambert::new(RHO).unwrap(), ShSymmetry::Isotropic, 0)),
        ("Phong 5", of(&Phong::new(RHO, 5.0).unwrap(), ShSymmetry::Isotropic, 9)),
        ("GGX 0.5", of(&rough, ShSymmetry::Isotropic, 16)),
        ("GGX 0.5, 22", of(&rough, ShSymmetry::Isotropic, 22)),
        ("GGX 0.4 0.8", of(&brushed, ShSymmetry::General, 6)),
    ]
}

#[test]
fn white_furnaces_show_the_albedo() {
    let matt = &projected()[0].1;
    assert!((matt.albedo(at(40.0, 0.0)).value - RHO).abs().max_element() < 1e-14);
    for (name, brdf) in projected() {
        for degrees in [0.0, 30.0, 70.0, 88.0, 90.0] {
            let outgoing = at(degrees, 0.7);
            let albedo = brdf.albedo(outgoing);
            let options = CubatureOptions { relative: 1e-6, ..CubatureOptions::default() };
            let furnace = white_furnace(brdf.form(outgoing), &|u| brdf.eval(u, outgoing), outgoing, options);
            // The stated error is a bound; it is far below what is asked of analytic forms.
            assert!(albedo.error.max_element() < 1e-10, "{name} at {degrees}: {albedo:?}");
            assert!((furnace.value - albedo.value).abs().cmple(furnace.error + albedo.error).all(), "{name}");
            let series = brdf.series(outgoing);
            let brute = polar(DVec3::X, 20, &|u| series.eval(u) * u.z);
            assert!((albedo.value - brute).abs().max_element() < 1e-9, "{name} at {degrees}: {albedo:?} {brute}");
        }
    }
}

#[test]
fn closed_forms_are_what_cubature_gives() {
    let mut worst = 0.0_f64;
    for (name, brdf) in projected() {
        for (k, radius) in [1.5_f64, 0.5, 0.05, 6e-4].into_iter().enumerate() {
            let outgoing = at(20.0 + 22.0 * k as f64, 1.0);
            // One of them crosses the horizon.
            let centre = at([0.0, 75.0, 30.0, 60.0][k], 2.0);
            let (x, y) = centre.any_orthonormal_pair();
            let corner = |j: u32| {
                let (sin, cos) = (f64::from(j) * TAU / 5.0).sin_cos();
                centre * radius.cos() + (x * cos + y * sin) * radius.sin()
            };
            let lit: Vec<Lit> = Lit::new(&(0..5).map(corner).collect::<Vec<_>>(), DVec3::ONE).into_iter().collect();
            let from = |_| RgbEstimate::default();
            let surroundings = Surroundings { lit: &lit, from: &from };
            let series = brdf.series(outgoing);
            let eval = |u| series.eval(u);
            let options = CubatureOptions { relative: 1e-10, absolute: 1e-12, evaluations: 300_000 };
            let of = |form| reflect(form, &eval, outgoing, &surroundings, options);
            let closed = reflect(
                brdf.form(outgoing),
                &eval,
                outgoing,
                &surroundings,
                CubatureOptions { absolute: 1e-9, ..options },
            );
            let smoothness = Smoothness::Waves { band: brdf.band() };
            let cubature = of(Form::General { peaks: Vec::new(), creases: Vec::new(), smoothness });
            let off = (closed.value - cubature.value).abs();
            assert!(off.cmple(closed.error + cubature.error).all(), "{name} {radius}: {closed:?} {cubature:?}");
            assert!(closed.error.max_element() < 1e-9, "{name} {radius}: {closed:?}");
            worst = worst.max(off.max_element());
            // Asked for more than the bound allows, cubature takes over where it is better.
            let small = reflect(
                brdf.form(outgoing),
                &eval,
                outgoing,
                &surroundings,
                CubatureOptions { relative: 1e-9, absolute: 0.0, evaluations: 100_000 },
            );
            assert!(small.error.max_element() <= closed.error.max_element(), "{name} {radius}: {small:?} {closed:?}");
            assert!((small.value - cubature.value).abs().cmple(small.error + cubature.error).all(), "{small:?}");
        }
    }
    println!("worst {worst:e}");
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn higher_bands_are_nearer() {
    let rough = Ggx::new(Fresnel::ALL, 0.5, 0.5).unwrap();
    let errors: Vec<f64> = [4, 8, 16, 32]
        .into_iter()
        .map(|band| {
            let projected = ShBrdf::project(&rough, ShSymmetry::Isotropic, band).unwrap();
            println!(
                "band {band}: {} of {}, largest {}",
                projected.rms_error.x, projected.rms.x, projected.largest_error.x
            );
            assert!(projected.largest_error.x >= projected.rms_error.x);
            projected.rms_error.x / projected.rms.x
        })
        .collect();
    assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
}

#[test]
fn a_projection_is_the_nearest_series() {
    // The albedo is off by no more than the mean error: a stated error that has to do with what is computed.
    let rough = Ggx::new(Fresnel::ALL, 0.5, 0.5).unwrap();
    let projected = ShBrdf::project(&rough, ShSymmetry::Isotropic, 16).unwrap();
    let mut squares = [0.0; 2];
    for (z, weight) in super::project::gauss_legendre(20) {
        let outgoing = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
        let off = (projected.brdf.albedo(outgoing).value - rough.albedo(outgoing).value).x;
        squares[0] += weight * off * off;
        // Cauchy and Schwarz: the integral of the cosine's square over the hemisphere is 2 pi / 3, times the 2 pi of the mean.
        squares[1] = TAU / 3.0 * TAU * projected.rms_error.x.powi(2);
    }
    // 1.1: the stated error is a sampled one.
    assert!(squares[0] <= 1.1 * squares[1], "{squares:?}");
    // Moving any coefficient moves it away: the mean square over the hemisphere is smallest.
    let distance = |brdf: &ShBrdf| -> f64 {
        let rule = super::project::gauss_legendre(40);
        let mut sum = 0.0;
        for &(z, weight) in &rule {
            let outgoing = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
            let series = brdf.series(outgoing);
            for &(height, other) in &rule {
                for k in 0..80 {
                    let (sin, cos) = (PI * (f64::from(k) + 0.5) / 40.0).sin_cos();
                    let radius = (1.0 - height * height).sqrt();
                    let u = DVec3::new(radius * cos, radius * sin, height);
                    sum += weight * other * (series.eval(u) - rough.eval(u, outgoing)).x.powi(2);
                }
            }
        }
        sum
    };
    let low = ShBrdf::project(&rough, ShSymmetry::Isotropic, 4).unwrap().brdf;
    let least = distance(&low);
    // Of harmonics with even l + m only.
    for at in [0, 2, 12, 24, 25, 35] {
        for step in [-0.01, 0.01] {
            let mut moved = low.coefficients().to_vec();
            moved[at] += DVec3::splat(step);
            let moved = ShBrdf::new(ShSymmetry::Isotropic, 4, moved).unwrap();
            assert!(distance(&moved) > least, "{at} {step}");
        }
    }
}

#[test]
fn tables_are_in_the_stated_order() {
    for band in [0, 1, 5] {
        let mut next = 0;
        for m in 0..=band {
            for l in m..=band {
                for k in m..=band {
                    assert_eq!(ShBrdf::index_isotropic(band, m, l, k), next);
                    next += 1;
                }
            }
        }
        assert_eq!(next, ShSymmetry::Isotropic.count(band));
    }
    // A table with one entry is its own transpose only on the diagonal.
    for (indices, is_reciprocal) in [((1, 1, 1), true), ((1, 1, 3), false), ((0, 2, 2), true), ((2, 3, 2), false)] {
        let mut table = vec![DVec3::ZERO; ShSymmetry::Isotropic.count(3)];
        table[ShBrdf::index_isotropic(3, indices.0, indices.1, indices.2)] = DVec3::ONE;
        let brdf = ShBrdf::new(ShSymmetry::Isotropic, 3, table).unwrap();
        assert_eq!(brdf.is_reciprocal(), is_reciprocal, "{indices:?}");
        let (u, v) = (at(30.0, 30.0), at(65.0, 65.0));
        let [there, back] = [brdf.eval(u, v), brdf.eval(v, u)];
        assert_eq!((there - back).length() < 1e-15, is_reciprocal);
    }
    let mut table = vec![DVec3::ZERO; ShSymmetry::General.count(2)];
    table[ShBrdf::index_general(2, (1, -1), (2, 2))] = DVec3::ONE;
    let brdf = ShBrdf::new(ShSymmetry::General, 2, table).unwrap();
    assert!(!brdf.is_reciprocal());
    let (u, v) = (at(30.0, 1.0), at(65.0, 2.0));
    let expected = (3.0 / (4.0 * PI)).sqrt() * u.y * (15.0 / (16.0 * PI)).sqrt() * (v.x * v.x - v.y * v.y);
    assert!((brdf.eval(u, v).x - expected).abs() < 1e-15);
}

#[test]
fn tables_that_make_no_sense_are_refused() {
    let isotropic = ShSymmetry::Isotropic;
    let table = vec![DVec3::ZERO; 5];
    assert_eq!(ShBrdf::new(isotropic, 1, vec![DVec3::ZERO; 4]), Err(BrdfError::BadTable { count: 4, expected: 5 }));
    let high = Err(BrdfError::HighBand { band: 65, highest: 64 });
    assert_eq!(ShBrdf::new(isotropic, 65, table.clone()), high);
    let mut bad = table.clone();
    bad[3].y = f64::NAN;
    assert!(matches!(ShBrdf::new(isotropic, 1, bad), Err(BrdfError::BadCoefficient { index: 3, .. })));
    assert!(ShBrdf::new(isotropic, 1, table).is_ok());
    let glossy: Vec<Box<dyn Brdf>> = vec![Box::new(Lambert::new(RHO).unwrap()), Box::new(Mirror::new(Fresnel::ALL))];
    let refused = ShBrdf::project(&Sum::new(glossy), isotropic, 3);
    assert!(matches!(refused, Err(BrdfError::NoFunction)));
    assert!(ShBrdf::project(&Lambert::new(RHO).unwrap(), ShSymmetry::General, 17).is_err());
}
