//! Tables of models: look-up, reciprocity, honest integrals.

use super::{BINS, COUNT, Merl, Unmeasured, bin, directions, is_below};
use crate::brdf::reflect::{Lit, Surroundings, reflect};
use crate::brdf::tests::{RHO, at, polar};
use crate::brdf::{Blinn, Brdf, BrdfError, Fresnel, Ggx, Lambert, RgbEstimate};
use crate::integral::CubatureOptions;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

fn tables() -> Vec<(&'static str, Box<dyn Brdf>, Merl)> {
    let models: [(&str, Box<dyn Brdf>); 4] = [
        ("Lambert", Box::new(Lambert::new(RHO).unwrap())),
        ("Blinn 20", Box::new(Blinn::new(RHO, 20.0).unwrap())),
        ("Blinn 1000", Box::new(Blinn::new(RHO, 1000.0).unwrap())),
        ("GGX 0.2", Box::new(Ggx::new(Fresnel::schlick(RHO).unwrap(), 0.2, 0.2).unwrap())),
    ];
    models
        .into_iter()
        .map(|(name, model)| {
            let table = Merl::tabulate(&*model).unwrap();
            (name, model, table)
        })
        .collect()
}

#[test]
fn the_middles_of_bins_have_the_values_of_the_bins() {
    for (name, model, table) in tables() {
        for index in (0..COUNT).step_by(997) {
            let bin = bin(index);
            if is_below(bin) {
                continue;
            }
            let [u, v] = directions(bin);
            // Turned about the normal: it is isotropic.
            let turn = glam::DQuat::from_rotation_z(index as f64);
            let [expected, found] = [model.eval(u, v), table.eval(turn * u, turn * v)];
            // Angles near 0 are known to 1e-16 of 5e-5, and what is next to a bin may be much larger.
            let allowed = 1e-8 * expected.max_element() + 1e-12;
            assert!((expected - found).abs().max_element() <= allowed, "{name} {bin:?}: {expected} {found}");
        }
    }
}

#[test]
fn between_the_middles_it_is_interpolated() {
    // Matt: exactly the same everywhere.
    let (_, _, matt) = tables().swap_remove(0);
    for k in 0..2000 {
        let t = f64::from(k);
        let value = matt.eval(at((t * 7.31) % 90.0, t), at((t * 3.17) % 90.0, t * t));
        assert!((value - RHO / PI).abs().max_element() < 1e-15, "{value}");
    }
    // Of a smooth lobe it is off by the square of a bin's size.
    let (_, blinn, table) = tables().swap_remove(1);
    let mut worst = 0.0_f64;
    for k in 0..2000 {
        let t = f64::from(k);
        let (u, v) = (at((t * 7.31) % 75.0, t), at((t * 3.17) % 75.0, t * t));
        worst = worst.max((blinn.eval(u, v) - table.eval(u, v)).abs().max_element());
    }
    // Bins of theta_h of up to 2 degrees: 20 / 8 times 0.035^2 of a peak of 2.5.
    assert!(worst < 8e-3 && worst > 1e-6, "{worst}");
}

#[test]
fn it_is_continuous() {
    // A table of noise: jumps would be of size 1, over 1e-9 radians.
    let noise = |k: usize| ((k as f64 * 12.9898).sin() * 43_758.545_3).fract().abs();
    let table = Merl::new((0..COUNT).map(|k| DVec3::splat(noise(k))).collect(), Unmeasured::Refuse).unwrap();
    for k in 0..20_000 {
        let t = f64::from(k);
        let v = at((t * 3.17) % 85.0, t * t);
        // About the mirror direction, the viewer's, and anywhere.
        let u = match k % 3 {
            0 => (crate::brdf::mirrored(v) + at(90.0, t) * 1e-3 * (t * 0.7).sin()).normalize(),
            1 => (v + at(90.0, t) * 1e-2 * (t * 0.7).sin()).normalize(),
            _ => at((t * 7.31) % 85.0, t),
        };
        let near = (u + DVec3::new((t * 1.1).sin(), (t * 2.3).cos(), (t * 0.9).sin()) * 1e-9).normalize();
        // The first bin of theta_h ends at 5e-5, where a degree of phi_d is 1e-6: a slope of 1e6 over 1e-9.
        let change = (table.eval(u, v) - table.eval(near, v)).abs().max_element();
        assert!(change < 2e-3, "{k}: {change}");
    }
}

#[test]
fn exchanging_the_directions_changes_nothing() {
    let noise = |k: usize| ((k as f64 * 12.9898).sin() * 43_758.545_3).fract().abs();
    let table = Merl::new((0..COUNT).map(|k| DVec3::splat(noise(k))).collect(), Unmeasured::Refuse).unwrap();
    assert!(table.is_reciprocal());
    for k in 0..2000 {
        let t = f64::from(k);
        let (u, v) = (at((t * 7.31) % 90.0, t), at((t * 3.17) % 90.0, t * t));
        let [there, back] = [table.eval(u, v), table.eval(v, u)];
        assert!((there - back).abs().max_element() < 1e-9, "{there} {back}");
        assert!(there.min_element() >= 0.0);
        assert_eq!(table.eval(-u, v), DVec3::ZERO);
    }
}

#[test]
fn albedos_are_those_of_the_models_and_conserve_energy() {
    for (name, model, table) in tables() {
        for degrees in [0.0, 40.0, 70.0] {
            let outgoing = at(degrees, 0.3);
            let [exact, tabulated] = [model.albedo(outgoing), table.albedo(outgoing)];
            // 1% is the interpolation of lobes over bins.
            let off = (exact.value - tabulated.value).abs();
            assert!(off.max_element() <= 0.01 * exact.value.max_element(), "{name} {degrees}: {exact:?} {tabulated:?}");
            assert!(tabulated.value.max_element() <= 1.0 + tabulated.error.max_element());
            let options = CubatureOptions { relative: 1e-3, absolute: 0.0, evaluations: 1_000_000 };
            let furnace = crate::brdf::reflect::white_furnace(
                table.form(outgoing),
                &|u| table.eval(u, outgoing),
                outgoing,
                options,
            );
            let off = (furnace.value - tabulated.value).abs();
            assert!(off.cmple(furnace.error + tabulated.error).all(), "{name} {degrees}: {furnace:?} {tabulated:?}");
            println!("{name} {degrees}: {tabulated:?}");
            if name != "Blinn 1000" {
                let expected = polar(crate::brdf::mirrored(outgoing), 120, &|u| table.eval(u, outgoing) * u.z);
                let off = (expected - tabulated.value).abs();
                // 3e-6: the product rule's own, over kinks.
                assert!(off.cmple(tabulated.error + 3e-6).all(), "{name} {degrees}: {tabulated:?} {expected}");
            }
        }
    }
}

#[test]
fn estimates_are_honest() {
    let noise = |k: usize| ((k as f64 * 12.9898).sin() * 43_758.545_3).fract().abs();
    let rough = |k: usize| DVec3::splat(0.5 + noise(k));
    let mut all: Vec<(&str, Merl)> = tables().into_iter().map(|(name, _, table)| (name, table)).collect();
    all.push(("noise", Merl::new((0..COUNT).map(rough).collect(), Unmeasured::Refuse).unwrap()));
    let (mut cases, mut too_small) = (0, 0);
    for (name, table) in &all {
        for k in 0..24 {
            let t = f64::from(k);
            let outgoing = at((t * 17.0) % 80.0, t);
            let radius = [0.3, 0.05, 0.01_f64][k as usize % 3];
            let centre = (crate::brdf::mirrored(outgoing) + DVec3::new(t.sin(), t.cos(), 1.5) * (radius * (t % 4.0)))
                .normalize();
            let (x, y) = centre.any_orthonormal_pair();
            let corner = |j: u32| {
                let (sin, cos) = (f64::from(j) * TAU / 5.0).sin_cos();
                centre * radius.cos() + (x * cos + y * sin) * radius.sin()
            };
            let boundary: Vec<DVec3> = (0..5).map(corner).collect();
            let Some(lit) = Lit::new(&boundary, DVec3::ONE) else { continue };
            let lit = [lit];
            let from = |_| RgbEstimate::default();
            let surroundings = Surroundings { lit: &lit, from: &from };
            let eval = |u| table.eval(u, outgoing);
            let options = CubatureOptions { relative: 1e-3, absolute: 0.0, evaluations: 100_000 };
            let quick = reflect(table.form(outgoing), &eval, outgoing, &surroundings, options);
            // A hundred times the precision or the effort.
            let more = CubatureOptions { relative: 1e-5, absolute: 0.0, evaluations: 1_500_000 };
            let slow = reflect(table.form(outgoing), &eval, outgoing, &surroundings, more);
            // Of a matt table both are exact to begin with: that tells nothing.
            if slow.error.max_element() > 0.5 * quick.error.max_element() {
                continue;
            }
            cases += 1;
            if !(quick.value - slow.value).abs().cmple(quick.error + slow.error).all() {
                too_small += 1;
                println!("{name} {k}: {quick:?} {slow:?}");
            }
        }
    }
    println!("{too_small} of {cases} too small");
    assert!(cases > 60 && too_small * 50 <= cases, "{too_small} of {cases}");
}

#[test]
fn what_was_not_measured_is_filled_or_refused() {
    let mut values = vec![DVec3::ONE; COUNT];
    let index = |[i, j, k]: [usize; 3]| (i * BINS[1] + j) * BINS[2] + k;
    // Far below the horizon, and well above it.
    let [below, above] = [[80, 60, 0], [20, 30, 40]];
    assert!(is_below(below) && !is_below(above));
    values[index([80, 59, 0])] = DVec3::splat(7.0);
    values[index(below)] = -DVec3::ONE;
    let table = Merl::new(values.clone(), Unmeasured::Refuse).unwrap();
    assert_eq!(table.values()[index(below)], DVec3::splat(7.0));
    values[index(above)] = DVec3::new(1.0, -1e-9, 1.0);
    let refused = Merl::new(values.clone(), Unmeasured::Refuse).unwrap_err();
    assert_eq!(refused, BrdfError::BadMeasurement { bin: above, value: DVec3::new(1.0, -1e-9, 1.0) });
    assert_eq!(Merl::new(values.clone(), Unmeasured::Fill).unwrap().values()[index(above)], DVec3::ONE);
    values[index([3, 0, 5])] = -DVec3::ONE;
    let bin = [3, 0, 5];
    assert_eq!(Merl::new(values.clone(), Unmeasured::Fill), Err(BrdfError::BadMeasurement { bin, value: -DVec3::ONE }));
    values[12] = DVec3::new(0.0, f64::INFINITY, 0.0);
    assert!(matches!(Merl::new(values, Unmeasured::Fill), Err(BrdfError::BadCoefficient { index: 12, .. })));
    assert_eq!(Merl::new(Vec::new(), Unmeasured::Fill), Err(BrdfError::BadTable { count: 0, expected: COUNT }));
}
