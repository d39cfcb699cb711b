//! What reflected radiance costs beyond the view: a table for docs/brdf.md. `cargo bench --bench reflect`.
//!
//! Rooms of 1,000 polygons seen from points on the floor; the lamps emit. To 1e-4 of the value, the mean over views and viewers' directions.

use glam::DVec3;
use nusselt::brdf::{
    AshikhminShirley, Blinn, Brdf, Fresnel, Ggx, GgxLtc, Lambert, Merl, Mirror, OrenNayar, Phong, ShBrdf, ShSymmetry,
    Ward, emitted, reflected_radiance,
};
use nusselt::contour::{Cell, ContourImage, Domain, SceneOrder, Viewpoint};
use nusselt::integral::CubatureOptions;
use nusselt::samples::{Kind, generate};
use nusselt::scene::{PolygonId, Side};
use std::hint::black_box;
use std::time::{Duration, Instant};

fn main() {
    let mut images = Vec::new();
    let mut viewing = Duration::ZERO;
    for seed in 1..=8 {
        let scene = generate(Kind::Room, 1_000, seed).expect("a room").to_builder().build().expect("a scene");
        let order = SceneOrder::new(&scene);
        let floor = Viewpoint::on_surface(&scene, PolygonId(0), Side::Front, DVec3::new(0.3, 0.2, 0.0));
        let floor = floor.expect("a floor");
        let start = Instant::now();
        images.push(order.view(&floor, &Domain::Above).expect("a view"));
        viewing += start.elapsed();
    }
    let lit = |image: &ContourImage| image.cells().filter(|&cell| emitted(cell).max_element() > 0.0).count();
    let cells: usize = images.iter().map(lit).sum();
    println!("{:?} a view, of {} cells that emit", viewing / images.len() as u32, cells as f64 / images.len() as f64);
    println!("what lamps emit:");
    for (name, brdf) in models() {
        measure(name, &*brdf, &images, emitted);
    }
    println!("every cell emits a radiance of its own:");
    for (name, brdf) in models()
        .into_iter()
        .filter(|(name, _)| ["Lambert", "Phong 10", "GGX 0.1", "GGX 0.1 by LTC", "SH 8"].contains(name))
    {
        measure(name, &*brdf, &images, |cell| DVec3::splat(1.0 + f64::from(cell.id().0) * 1e-3));
    }
}

/// The time of radiances towards viewers all around, at three angles of incidence.
fn measure(name: &str, brdf: &dyn Brdf, images: &[ContourImage], emission: impl Fn(Cell<'_>) -> DVec3 + Copy) {
    for degrees in [30.0_f64, 60.0, 80.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (mut total, mut longest, mut worst) = (Duration::ZERO, Duration::ZERO, 0.0_f64);
        let mut count = 0;
        for image in images {
            let normal = image.normal().expect("a floor has a normal");
            let (x, y) = normal.any_orthonormal_pair();
            for k in 0..8 {
                let azimuth = 0.3 + f64::from(k) * 0.785;
                let view = normal * cos + (x * azimuth.cos() + y * azimuth.sin()) * sin;
                let options = CubatureOptions { relative: 1e-4, absolute: 1e-12, evaluations: 1_000_000 };
                let start = Instant::now();
                let radiance = reflected_radiance(black_box(image), brdf, None, view, emission, options);
                let took = start.elapsed();
                let radiance = radiance.expect("a radiance");
                (total, longest, count) = (total + took, longest.max(took), count + 1);
                if radiance.value.max_element() > 1e-8 {
                    worst = worst.max(radiance.error.max_element() / radiance.value.max_element());
                }
            }
        }
        let mean = total / count;
        println!("{name:24} {degrees:2} degrees: {mean:>10.1?} mean {longest:>10.1?} longest, error to {worst:.0e}");
    }
}

fn models() -> Vec<(&'static str, Box<dyn Brdf>)> {
    let rho = DVec3::new(0.9, 0.5, 0.1);
    let fresnel = Fresnel::schlick(rho).expect("a reflectance");
    let good = "parameters in range";
    let rough = Ggx::new(fresnel, 0.5, 0.5).expect(good);
    let harmonics =
        |band| Box::new(ShBrdf::project(&rough, ShSymmetry::Isotropic, band).expect("a smooth function").brdf);
    let table = |model: &dyn Brdf| Box::new(Merl::tabulate(model).expect("a function"));
    vec![
        ("Lambert", Box::new(Lambert::new(rho).expect(good))),
        ("Phong 10", Box::new(Phong::new(rho, 10.0).expect(good))),
        ("Phong 2048", Box::new(Phong::new(rho, 2048.0).expect(good))),
        ("Phong 10.5", Box::new(Phong::new(rho, 10.5).expect(good))),
        ("Oren-Nayar 0.5", Box::new(OrenNayar::new(rho, 0.5).expect(good))),
        ("Blinn 100", Box::new(Blinn::new(rho, 100.0).expect(good))),
        ("Ward 0.2 0.05", Box::new(Ward::new(rho, 0.2, 0.05).expect(good))),
        ("Ashikhmin-Shirley 10 100", Box::new(AshikhminShirley::new(rho * 0.5, rho, 10.0, 100.0).expect(good))),
        ("GGX 0.5", Box::new(Ggx::new(fresnel, 0.5, 0.5).expect(good))),
        ("GGX 0.1", Box::new(Ggx::new(fresnel, 0.1, 0.1).expect(good))),
        ("GGX 0.02", Box::new(Ggx::new(fresnel, 0.02, 0.02).expect(good))),
        ("GGX 0.5 by LTC", Box::new(GgxLtc::new(rho, 0.5).expect(good))),
        ("GGX 0.1 by LTC", Box::new(GgxLtc::new(rho, 0.1).expect(good))),
        ("GGX 0.02 by LTC", Box::new(GgxLtc::new(rho, 0.02).expect(good))),
        ("SH 8", harmonics(8)),
        ("SH 16", harmonics(16)),
        ("SH 32", harmonics(32)),
        ("MERL of GGX 0.5", table(&rough)),
        ("MERL of GGX 0.1", table(&Ggx::new(fresnel, 0.1, 0.1).expect(good))),
        ("mirror", Box::new(Mirror::new(Fresnel::ALL))),
    ]
}
