//! Smoke.
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, Viewpoint};
use nusselt::scene::{Material, Scene};

fn rng(s: &mut u64) -> f64 {
    *s = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    ((*s >> 11) as f64) / (1u64 << 53) as f64
}

fn boxes(n: usize, seed: u64) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let mut s = seed;
    let mut v = vec![];
    let mut f: Vec<Vec<usize>> = vec![];
    let mut add = |c: [f64; 3], h: [f64; 3], a: f64, inward: bool| {
        let o = v.len();
        for k in 0..8 {
            let x = if k & 1 == 0 { -h[0] } else { h[0] };
            let y = if k & 2 == 0 { -h[1] } else { h[1] };
            let z = if k & 4 == 0 { -h[2] } else { h[2] };
            v.push([c[0] + x * a.cos() - y * a.sin(), c[1] + x * a.sin() + y * a.cos(), c[2] + z]);
        }
        for q in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            let mut q: Vec<usize> = q.iter().map(|i| i + o).collect();
            if inward {
                q.reverse();
            }
            f.push(q);
        }
    };
    add([0.0; 3], [10.0; 3], 0.0, true);
    for _ in 0..n {
        let c = [0; 3].map(|_| rng(&mut s) * 16.0 - 8.0);
        let h = [0; 3].map(|_| rng(&mut s) * 0.5 + 0.1);
        let a = if rng(&mut s) < 0.5 { 0.0 } else { rng(&mut s) };
        add(c, h, a, false);
    }
    (v, f)
}

#[test]
fn smoke() {
    for n in [1000] {
        let (v, f) = boxes(n, 7);
        let t = std::time::Instant::now();
        let scene = Scene::builder().mesh(&v, &f, Material::new("m")).build().unwrap();
        let t1 = t.elapsed();
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
        println!("n {} scene {:?} bsp {:?} {:?}", f.len(), t1, t.elapsed() - t1, bsp.stats());
        let mut s = 5;
        for k in 0..10 {
            let e = DVec3::new(rng(&mut s) * 19.0 - 9.5, rng(&mut s) * 19.0 - 9.5, rng(&mut s) * 19.0 - 9.5);
            let dom = if k % 2 == 0 { Domain::Sphere } else { Domain::Hemisphere(DVec3::Z) };
            let t = std::time::Instant::now();
            let img = bsp.view(&Viewpoint::free(e), &dom).unwrap();
            let t1 = t.elapsed();
            let om = img.solid_angles();
            println!(
                "  {:?} cells {} vis {} omega err {:e} bg {:e} ff err {:e} {:?} {:?}",
                t1,
                img.cell_count(),
                om.polygons.len(),
                om.total() - if k % 2 == 0 { 4.0 } else { 2.0 } * std::f64::consts::PI,
                om.background,
                img.form_factors().map_or(0.0, |f| f.total() - 1.0),
                t.elapsed(),
                img.stats()
            );
        }
    }
}
