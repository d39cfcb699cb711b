//! What holds of every model: reciprocity, energy, white furnaces; values that are known.

mod estimates;

use super::reflect::{Lit, Surroundings, reflect, white_furnace};
use super::{
    AshikhminShirley, Blinn, Brdf, BrdfError, Form, Fresnel, Ggx, Lafortune, Lambert, MetallicRoughness, Mirror,
    OrenNayar, Phong, RgbEstimate, Sum, Ward,
};
use crate::integral::brute::{brute, gauss};
use crate::integral::{CubatureOptions, Smoothness, clip, unit_outline};
use crate::scene::{self, Material};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

pub(super) const RHO: DVec3 = DVec3::new(0.9, 0.5, 0.1);
pub(super) const HEMISPHERE: [DVec3; 4] = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];

pub(super) fn at(degrees: f64, azimuth: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos)
}

/// What cubature leaves where a model has a kink along a circle that is no great one: that where both directions are
/// equally far from the normal.
fn kink(name: &str) -> f64 {
    if name.starts_with("Ashikhmin") { 5e-6 } else { 0.0 }
}

/// Models, each with the width of its narrowest detail.
fn models() -> Vec<(String, Box<dyn Brdf>, f64)> {
    let mut all: Vec<(String, Box<dyn Brdf>, f64)> = Vec::new();
    let mut add = |name: String, brdf: Box<dyn Brdf>, width: f64| all.push((name, brdf, width));
    add("Lambert".into(), Box::new(Lambert::new(RHO).unwrap()), 1.0);
    for sigma in [0.0, 0.3, 1.0] {
        add(format!("Oren-Nayar {sigma}"), Box::new(OrenNayar::new(RHO, sigma).unwrap()), 0.5);
    }
    for n in [0.0, 1.0, 2.5, 20.0, 300.5, 2048.0] {
        let width = 1.0 / f64::max(n, 1.0).sqrt();
        add(format!("Phong {n}"), Box::new(Phong::new(RHO, n).unwrap()), width);
        add(format!("Blinn {n}"), Box::new(Blinn::new(RHO, n).unwrap()), width);
        let lobe = Lafortune::new(RHO, DVec3::new(-0.9, -0.8, 1.0), n).unwrap();
        add(format!("Lafortune {n}"), Box::new(lobe), width);
    }
    let glass = Fresnel::dielectric(1.5).unwrap();
    let gold = Fresnel::conductor(DVec3::new(0.18, 0.42, 1.37), DVec3::new(3.4, 2.3, 1.8)).unwrap();
    let plastic = Fresnel::schlick(RHO).unwrap();
    for (fresnel, name) in [(Fresnel::ALL, "white"), (glass, "glass"), (gold, "gold"), (plastic, "Schlick")] {
        for [ax, ay] in [[1.0, 1.0], [0.3, 0.3], [0.02, 0.02], [0.05, 0.4]] {
            add(format!("GGX {name} {ax} {ay}"), Box::new(Ggx::new(fresnel, ax, ay).unwrap()), ax);
        }
    }
    for [ax, ay] in [[0.5, 0.5], [0.02, 0.02], [0.3, 0.05]] {
        add(format!("Ward {ax} {ay}"), Box::new(Ward::new(RHO, ax, ay).unwrap()), ay);
    }
    for [nx, ny] in [[1.0, 1.0], [10.0, 1000.0], [2000.0, 2000.0]] {
        let model = AshikhminShirley::new(DVec3::splat(0.6), DVec3::new(0.04, 0.3, 0.9), nx, ny).unwrap();
        add(format!("Ashikhmin-Shirley {nx} {ny}"), Box::new(model), 1.0 / ny.sqrt());
    }
    for (metallic, roughness) in [(0.0, 0.2), (0.0, 1.0), (0.6, 0.5), (1.0, 0.3)] {
        let model = MetallicRoughness::new(RHO, metallic, roughness).unwrap();
        add(format!("glTF {metallic} {roughness}"), Box::new(model), roughness * roughness);
    }
    add("mirror".into(), Box::new(Mirror::new(glass)), 1.0);
    let base = Box::new(Lambert::new(0.5 * RHO).unwrap());
    let gloss = Box::new(Phong::new(0.5 * RHO, 50.0).unwrap());
    add("sum".into(), Box::new(Sum::new(vec![base, gloss])), 0.1);
    all
}

#[test]
fn exchanging_the_directions_changes_nothing() {
    for (name, brdf, _) in models() {
        assert!(brdf.is_reciprocal());
        for k in 0..500 {
            let t = f64::from(k);
            // Mostly near the mirror direction, where lobes are.
            let one = at((t * 7.3) % 90.0, t);
            let near = DVec3::new((t * 1.7).sin(), (t * 2.9).cos(), (t * 0.3).sin()) * (0.1 * (t % 7.0).exp2() / 16.0);
            let other = (super::mirrored(one) + near).normalize();
            if other.z <= 0.0 || one.z <= 0.0 {
                continue;
            }
            let [there, back] = [brdf.eval(one, other), brdf.eval(other, one)];
            assert!((there - back).abs().max_element() <= 1e-11 * there.max_element(), "{name}: {there} {back}");
            assert!(there.is_finite() && there.min_element() >= 0.0, "{name}: {there}");
            assert_eq!(brdf.eval(DVec3::new(other.x, other.y, -other.z), one), DVec3::ZERO);
        }
    }
}

#[test]
fn no_more_is_reflected_than_comes() {
    for (name, brdf, _) in models() {
        for degrees in [0.0, 20.0, 50.0, 75.0, 85.0, 89.0, 89.9] {
            for azimuth in [0.0, 0.8] {
                let albedo = brdf.albedo(at(degrees, azimuth));
                let most = (albedo.value - albedo.error).max_element();
                // The matt base of glTF does not know that its coat reflects nearly all at grazing angles.
                let limit = if name.starts_with("glTF") { 2.0 } else { 1.0 };
                assert!(most <= limit && albedo.value.min_element() >= 0.0, "{name} at {degrees}: {albedo:?}");
                let off = albedo.error.max_element();
                // Near the horizon there is a thin layer all around in which the integrand changes.
                let allowed = if degrees > 80.0 { 1e-6 + 2.0 * kink(&name) } else { 1e-8 + kink(&name) };
                assert!(off <= allowed * albedo.value.max_element() + 1e-11, "{name} at {degrees}: {albedo:?}");
            }
        }
    }
}

/// The integral over the hemisphere by 100 points a field of a grid in azimuth and height, finer towards the azimuth of `axis`, the horizon and
/// the normal.
pub(super) fn polar(axis: DVec3, fields: u32, f: &impl Fn(DVec3) -> DVec3) -> DVec3 {
    let n = f64::from(fields);
    let middle = axis.y.atan2(axis.x);
    let mut sum = DVec3::ZERO;
    for k in 0..fields * fields {
        for (s, weight_s) in gauss() {
            for (t, weight_t) in gauss() {
                let [x, y] = [(f64::from(k % fields) + s) / n, (f64::from(k / fields) + t) / n];
                // z = 1 - (1 - x^3)^2.
                let below = 1.0 - x * x * x;
                let (z, radius) = (1.0 - below * below, below * (2.0 - below * below).sqrt());
                let weight = weight_s * weight_t * 18.0 * below * x * x * y * y * PI / (n * n);
                for turn in [y * y * y, -y * y * y] {
                    let (sin, cos) = (middle + PI * turn).sin_cos();
                    sum += f(DVec3::new(radius * cos, radius * sin, z)) * weight;
                }
            }
        }
    }
    sum
}

#[test]
fn white_furnaces_show_the_albedo() {
    for (name, brdf, width) in models() {
        for degrees in [0.0, 30.0, 70.0, 88.0] {
            let outgoing = at(degrees, 0.7);
            let albedo = brdf.albedo(outgoing);
            if let Form::Dirac { direction, reflectance } = brdf.form(outgoing) {
                assert_eq!(direction, super::mirrored(outgoing));
                assert_eq!(albedo, RgbEstimate { value: reflectance, error: DVec3::ZERO });
                continue;
            }
            let eval = |incoming| brdf.eval(incoming, outgoing);
            let options = CubatureOptions { relative: 1e-6, ..CubatureOptions::default() };
            let furnace = white_furnace(brdf.form(outgoing), &eval, outgoing, options);
            let off = (furnace.value - albedo.value).abs();
            assert!(off.cmple(furnace.error + albedo.error).all(), "{name} at {degrees}: {furnace:?} for {albedo:?}");
            if name.starts_with("Oren") {
                // The closed form is the better witness.
                continue;
            }
            // Cut where some models have kinks.
            let hemisphere = unit_outline(&HEMISPHERE);
            let side = DVec3::new(outgoing.x, outgoing.y, 0.0).try_normalize().unwrap_or(DVec3::X);
            let axis = super::mirrored(outgoing);
            let cuts = match brdf.form(outgoing) {
                Form::Lobes(lobes) => lobes.iter().map(|lobe| lobe.axis).collect(),
                Form::General { creases, .. } => creases,
                _ => vec![axis],
            };
            let mut parts = vec![clip(&hemisphere, side), clip(&hemisphere, -side)];
            for cut in cuts {
                parts = parts.iter().flat_map(|part| [clip(part, cut), clip(part, -cut)]).collect();
            }
            let f = |incoming: DVec3| brdf.eval(incoming, outgoing) * incoming.z;
            let is_phong = ["Lambert", "Phong", "Lafortune", "sum"].iter().any(|kind| name.starts_with(kind));
            let [coarse, fine] = [1_u32, 2].map(|effort| -> DVec3 {
                if is_phong {
                    let width = width * outgoing.z.max(0.3) / f64::from(effort);
                    parts.iter().map(|part| brute(part, axis, width, &f)).sum()
                } else {
                    polar(axis, 30 + 30 * effort, &f)
                }
            });
            let off = (albedo.value - fine).abs();
            // Brute force is off by no more than thrice what a step of it changes, or by the rounding of very many terms.
            let allowed = albedo.error + 3.0 * (fine - coarse).abs() + (1e-12 + 10.0 * kink(&name));
            assert!(
                off.cmple(allowed).all(),
                "{name} at {degrees}: {albedo:?} instead of {fine}, give or take {allowed}"
            );
            assert!((fine - coarse).abs().max_element() < 1e-4, "{name} at {degrees}: {coarse} {fine}");
        }
    }
}

#[test]
fn known_albedos() {
    for n in [0.0, 1.0, 2.5, 100.0, 2048.0] {
        let phong = Phong::new(RHO, n).unwrap().albedo(DVec3::Z);
        assert!((phong.value - RHO).abs().max_element() < 1e-8, "{n}: {phong:?}");
        let blinn = Blinn::new(RHO, n).unwrap().albedo(DVec3::Z);
        assert!((blinn.value - RHO).abs().max_element() < 1e-8, "{n}: {blinn:?}");
    }
    let matt = OrenNayar::new(RHO, 0.0).unwrap().albedo(at(60.0, 0.0));
    assert!((matt.value - RHO).abs().max_element() < 1e-8);
    // Nothing is lost by smooth facets.
    let smooth = Ggx::new(Fresnel::ALL, 0.001, 0.001).unwrap().albedo(at(30.0, 0.0));
    assert!((smooth.value - 1.0).abs().max_element() < 1e-4, "{smooth:?}");
}

#[test]
fn lafortune_holds_phong() {
    let outgoing = at(40.0, 0.3);
    for n in [1.0, 7.0, 30.5] {
        let phong = Phong::new(RHO, n).unwrap();
        let lafortune = Lafortune::new(RHO, DVec3::new(-1.0, -1.0, 1.0), n).unwrap();
        for k in 0..50 {
            let incoming = at(f64::from(k) * 1.7, f64::from(k));
            let [one, other] = [phong.eval(incoming, outgoing), lafortune.eval(incoming, outgoing)];
            assert!((one - other).abs().max_element() <= 1e-13 * one.max_element(), "{one} {other}");
        }
    }
}

/// A model in general form, whatever it has.
struct General<'a>(&'a dyn Brdf);

impl Brdf for General<'_> {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        self.0.eval(incoming, outgoing)
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        let Form::Lobes(lobes) = self.0.form(outgoing) else { panic!("not a lobe") };
        let creases = lobes.iter().map(|lobe| lobe.axis).collect();
        Form::General { peaks: lobes.iter().map(super::Lobe::peak).collect(), creases, smoothness: Smoothness::Smooth }
    }
}

#[test]
fn closed_forms_are_what_cubature_gives() {
    let mut worst = 0.0_f64;
    let options = CubatureOptions { relative: 1e-10, absolute: 1e-13, evaluations: 10_000_000 };
    let mut lobes: Vec<Box<dyn Brdf>> = vec![Box::new(Lambert::new(RHO).unwrap())];
    for n in [1.0, 4.0, 64.0, 700.0, 2048.0] {
        lobes.push(Box::new(Phong::new(RHO, n).unwrap()));
        lobes.push(Box::new(Lafortune::new(RHO, DVec3::new(-0.99, -0.95, 1.0), n).unwrap()));
    }
    for brdf in &lobes {
        for (k, radius) in [1.5, 0.5, 0.05, 6e-4].into_iter().enumerate() {
            for degrees in [0.0, 45.0, 80.0, 89.9] {
                let outgoing = at(degrees, 1.0);
                // Some on the lobe, some off it.
                let centre = (super::mirrored(outgoing) + DVec3::new(0.02, 0.01, 0.1) * (k as f64)).normalize();
                let (x, y) = centre.any_orthonormal_pair();
                let corner = |j: u32| {
                    let (sin, cos) = (f64::from(j) * TAU / 5.0).sin_cos();
                    centre * f64::cos(radius) + (x * cos + y * sin) * f64::sin(radius)
                };
                let lit: Vec<Lit> = Lit::new(&(0..5).map(corner).collect::<Vec<_>>(), DVec3::ONE).into_iter().collect();
                let from = |_| RgbEstimate::default();
                let surroundings = Surroundings { lit: &lit, from: &from };
                let of = |brdf: &dyn Brdf, options| {
                    let eval = |incoming| brdf.eval(incoming, outgoing);
                    reflect(brdf.form(outgoing), &eval, outgoing, &surroundings, options)
                };
                let analytic = of(brdf.as_ref(), CubatureOptions { absolute: 1e-9, ..options });
                let numeric = of(&General(brdf.as_ref()), options);
                let off = (analytic.value - numeric.value).abs();
                assert!(off.cmple(analytic.error + numeric.error).all(), "{analytic:?} {numeric:?}");
                assert!(analytic.error.max_element() < 1e-9, "{analytic:?}");
                worst = worst.max(off.max_element());
            }
        }
    }
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn materials_reflect_as_their_files_say() {
    let [incoming, outgoing] = [at(30.0, 1.0), at(50.0, 2.0)];
    let of = |material: &Material| material.brdf().unwrap().eval(incoming, outgoing);
    let paint =
        Material { diffuse: [0.6, 0.3, 0.1], specular: [0.2, 0.3, 0.4], exponent: 7.0, ..Material::new("paint") };
    let [matt, gloss] = [paint.diffuse, paint.specular].map(DVec3::from);
    let expected = |matt, gloss| {
        let gloss = Phong::new(gloss, 7.0).unwrap().eval(incoming, outgoing);
        Lambert::new(matt).unwrap().eval(incoming, outgoing) + gloss
    };
    assert!((of(&paint) - expected(matt, gloss)).length() < 1e-15 && !paint.reflects_too_much());
    // 0.9 + 0.6 in green alone is too much.
    let bright = Material { diffuse: [0.5, 0.9, 0.1], specular: [0.2, 0.6, 0.4], ..paint.clone() };
    let by_sum = DVec3::new(1.0, 1.5, 1.0);
    let [matt, gloss] = [bright.diffuse, bright.specular].map(|colour| DVec3::from(colour) / by_sum);
    assert!((of(&bright) - expected(matt, gloss)).length() < 1e-15 && bright.reflects_too_much());
    // One alone that is too much, and what is so much that it overflows.
    let white = Material { diffuse: [1.2, 0.4, f64::MAX], specular: [0.0, 0.0, f64::MAX], ..paint.clone() };
    assert_eq!(white.reflectances(), Ok([DVec3::new(1.0, 0.4, 0.5), DVec3::new(0.0, 0.0, 0.5)]));
    assert!(white.reflects_too_much() && white.brdf().is_ok());
    // By the equations of glTF's appendix B.3.5, written out, with the height-correlated masking of B.3.6.1.
    let (base_colour, metallic, roughness) = ([0.9, 0.5, 0.1], 0.3, 0.6_f64);
    let gltf = scene::MetallicRoughness { base_colour, metallic, roughness };
    let gltf = Material { metallic_roughness: Some(gltf), ..Material::new("paint") };
    let half = (incoming + outgoing).normalize();
    let a2 = roughness.powi(4);
    let distribution = a2 / (PI * (half.z * half.z * (a2 - 1.0) + 1.0).powi(2));
    let [l, v] = [incoming.z, outgoing.z];
    let visible = 0.5 / (l * (v * v * (1.0 - a2) + a2).sqrt() + v * (l * l * (1.0 - a2) + a2).sqrt());
    let at_normal = DVec3::splat(0.04).lerp(DVec3::from(base_colour), metallic);
    let fresnel = at_normal + (1.0 - at_normal) * (1.0 - half.dot(outgoing)).powi(5);
    let matt = DVec3::from(base_colour) * (1.0 - metallic) / PI;
    let expected = (1.0 - fresnel) * matt + fresnel * distribution * visible;
    assert!((of(&gltf) - expected).length() < 1e-14 * expected.length(), "{} {expected}", of(&gltf));
    for bad in [
        Material { diffuse: [-0.1, 0.0, 0.0], ..paint.clone() },
        Material { specular: [0.0, f64::NAN, 0.0], ..paint.clone() },
        Material { exponent: 1e7, ..paint.clone() },
        Material {
            metallic_roughness: Some(scene::MetallicRoughness { base_colour, metallic: 1.5, roughness }),
            ..paint
        },
    ] {
        assert!(bad.brdf().is_err(), "{bad:?}");
    }
}

#[test]
fn parameters_that_make_no_sense_are_refused() {
    let [bad, nan] = [DVec3::splat(1.5), DVec3::splat(f64::NAN)];
    assert_eq!(Lambert::new(bad), Err(BrdfError::BadReflectance(bad)));
    assert!(matches!(Lambert::new(nan), Err(BrdfError::BadReflectance(_))));
    assert_eq!(Phong::new(RHO, -1.0), Err(BrdfError::BadExponent(-1.0)));
    assert!(matches!(Blinn::new(RHO, f64::INFINITY), Err(BrdfError::BadExponent(_))));
    assert_eq!(Ward::new(RHO, 0.1, 0.0), Err(BrdfError::BadRoughness(0.0)));
    assert!(matches!(Ggx::new(Fresnel::ALL, f64::NAN, 0.1), Err(BrdfError::BadRoughness(_))));
    assert!(matches!(OrenNayar::new(RHO, -0.1), Err(BrdfError::OutOfRange { .. })));
    let shown = |error: Option<BrdfError>| error.map(|error| error.to_string());
    let metallic = shown(MetallicRoughness::new(RHO, 2.0, 0.5).err());
    assert_eq!(metallic.as_deref(), Some("the metallic part has to be from 0 to 1, not 2"));
    let rough = shown(MetallicRoughness::new(RHO, 0.5, f64::NAN).err());
    assert_eq!(rough.as_deref(), Some("a roughness of glTF has to be from 0 to 1, not NaN"));
    assert!(matches!(Lafortune::new(RHO, DVec3::splat(2.0), 10.0), Err(BrdfError::NotConserving(_))));
    assert!(matches!(Lafortune::new(RHO, nan, 10.0), Err(BrdfError::BadScale(_))));
    assert!(AshikhminShirley::new(-RHO, RHO, 1.0, 1.0).is_err());
    let black = Lafortune::new(RHO, DVec3::ZERO, 3.0).unwrap();
    assert_eq!(black.albedo(at(FRAC_PI_2, 0.0)).value, DVec3::ZERO);
}
