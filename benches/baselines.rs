//! The tables of docs/comparison.md: `cargo bench --bench baselines`, or for one size of the room
//! `cargo bench --bench baselines -- 10000`.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, Viewpoint};
use nusselt::hemicube::{Deviations, Hemicube};
use nusselt::integral::Sums;
use nusselt::samples::{Kind, generate};
use nusselt::scene::Scene;
use std::error::Error;
use std::time::Instant;

/// Views a row; the same points for every method and machine.
const VIEWS: usize = 20;
/// Each view is taken as often, in turn with the others, and the shortest time counts.
const ROUNDS: usize = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let sizes = match words.as_slice() {
        [] => vec![1_000, 10_000, 50_000],
        words => words.iter().map(|word| word.parse()).collect::<Result<_, _>>()?,
    };
    println!(
        "| polygons | method | ms | worst error > 1e-3 | worst > 1e-4 | 99% | median | lost | of | evaluations |\n\
         | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    );
    for polygons in sizes {
        let mesh = generate(Kind::Room, polygons, 1)?;
        let scene = mesh.to_builder().build()?;
        let points = mesh.free_points(VIEWS, 3);
        let views: Vec<Viewpoint> = points.into_iter().map(|point| Viewpoint::free(DVec3::from(point))).collect();
        compare(&scene, &views)?;
    }
    Ok(())
}

/// One row for each method.
fn compare(scene: &Scene, views: &[Viewpoint]) -> Result<(), Box<dyn Error>> {
    let bsp = SceneBsp::build(scene, &BspOptions::default())?;
    let mut exact = vec![Vec::new(); views.len()];
    measure(scene, "contour", views, &mut exact, |view, factors| {
        let image = bsp.view(view, &Domain::Hemisphere(DVec3::Z))?;
        let sums = image.form_factors().ok_or("a hemisphere has a normal")?;
        fill(factors, scene, &sums);
        Ok(image.cell_count())
    })?;
    for resolution in [64, 128, 256, 512, 1024] {
        let mut hemicube = Hemicube::new(scene, resolution)?;
        measure(scene, &format!("hemicube {resolution}"), views, &mut exact, |view, factors| {
            let view = hemicube.view(view, DVec3::Z)?;
            factors.extend(view.factors());
            Ok(view.stats().pixels)
        })?;
        measure(scene, &format!("analytic {resolution}"), views, &mut exact, |view, factors| {
            let view = hemicube.analytic(view, DVec3::Z)?;
            factors.extend(view.factors());
            Ok(view.evaluations())
        })?;
    }
    for count in [10_000, 100_000] {
        let mut rays = nusselt::hemicube::Rays::new(scene);
        measure(scene, &format!("rays {count}"), views, &mut exact, |view, factors| {
            let view = rays.view(view, DVec3::Z, count, 1)?;
            factors.extend(view.factors());
            Ok(0)
        })?;
    }
    Ok(())
}

/// The form factors of all polygons by number.
fn fill(factors: &mut Vec<f64>, scene: &Scene, sums: &Sums) {
    factors.resize(scene.polygon_count(), 0.0);
    for sum in &sums.polygons {
        factors[sum.polygon.index()] = sum.both();
    }
}

/// Times `method` on all views and prints its row. The first method fills `exact`.
fn measure(
    scene: &Scene,
    name: &str,
    views: &[Viewpoint],
    exact: &mut [Vec<f64>],
    mut method: impl FnMut(&Viewpoint, &mut Vec<f64>) -> Result<usize, Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let mut fastest = vec![f64::INFINITY; views.len()];
    let mut deviations = [1e-3, 1e-4].map(Deviations::above);
    let mut evaluations = 0;
    for round in 0..ROUNDS {
        for ((view, fastest), exact) in views.iter().zip(&mut fastest).zip(&mut *exact) {
            let mut factors = Vec::with_capacity(scene.polygon_count());
            let start = Instant::now();
            let count = method(view, &mut factors)?;
            *fastest = fastest.min(start.elapsed().as_secs_f64());
            if round > 0 {
                continue;
            }
            evaluations += count;
            if exact.is_empty() {
                exact.clone_from(&factors);
            }
            for deviations in &mut deviations {
                deviations.add(factors.iter().copied(), exact.iter().copied());
            }
        }
    }
    let count = views.len();
    let [large, small] = deviations;
    println!(
        "| {} | {name} | {:.3} | {:.2e} | {:.2e} | {:.2e} | {:.2e} | {} | {} | {} |",
        scene.polygon_count(),
        fastest.iter().sum::<f64>() * 1e3 / count as f64,
        large.quantile(1.0),
        small.quantile(1.0),
        small.quantile(0.99),
        small.quantile(0.5),
        small.lost() / count,
        small.visible() / count,
        evaluations / count,
    );
    Ok(())
}
