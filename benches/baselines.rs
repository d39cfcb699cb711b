//! scratch
use glam::DVec3;
use nusselt::contour::Viewpoint;
use nusselt::hemicube::Hemicube;
use nusselt::samples::{Kind, generate};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let sizes: Vec<usize> = words.first().map_or(vec![1000, 10_000, 50_000], |w| vec![w.parse().unwrap()]);
    let resolutions: Vec<usize> = words.get(1).map_or(vec![64, 128, 256, 512, 1024], |w| vec![w.parse().unwrap()]);
    let rounds: usize = words.get(2).map_or(3, |w| w.parse().unwrap());
    for n in sizes {
        let mesh = generate(Kind::Room, n, 1)?;
        let scene = mesh.to_builder().build()?;
        let points = mesh.free_points(20, 3);
        for &r in &resolutions {
            let mut hemicube = Hemicube::new(&scene, r)?;
            let mut best = f64::INFINITY;
            let mut stats = Default::default();
            let mut back = 0.0;
            for _ in 0..rounds {
                let start = Instant::now();
                for p in &points {
                    let view = hemicube.view(&Viewpoint::free(DVec3::from(*p)), DVec3::Z)?;
                    stats = view.stats();
                    back += view.background();
                }
                best = best.min(start.elapsed().as_secs_f64() / points.len() as f64);
            }
            println!("{n} {} pieces {r}: {:.3} ms  {stats:?} background {back:e}", scene.piece_count(), best * 1e3);
        }
    }
    Ok(())
}
