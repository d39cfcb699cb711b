//! Reflected radiance over contour images: white rooms, mirrors, closed forms against cubature, cubature against more of it.

use glam::DVec3;
use nusselt::brdf::{
    Brdf, Form, Fresnel, Ggx, GgxLtc, Lambert, Merl, Mirror, OrenNayar, Phong, ReflectError, RgbEstimate, ShBrdf,
    ShSymmetry, Sum, Ward, emitted, reflected_radiance,
};
use nusselt::contour::{Cell, ContourImage, Domain, Location, SceneOrder, Viewpoint};
use nusselt::integral::{CubatureOptions, Smoothness};
use nusselt::samples::{Kind, generate};
use nusselt::scene::{Material, PolygonId, Scene, Side};

const RHO: DVec3 = DVec3::new(0.9, 0.5, 0.1);

fn room() -> ContourImage {
    let scene = generate(Kind::Room, 1_000, 1).expect("a room").to_builder().build().expect("a scene");
    let floor = Viewpoint::on_surface(&scene, PolygonId(0), Side::Front, DVec3::ZERO).expect("a floor");
    SceneOrder::new(&scene).view(&floor, &Domain::Above).expect("a view")
}

/// Directions towards viewers, from the normal to 89.9 degrees.
fn views(image: &ContourImage) -> Vec<DVec3> {
    let normal = image.normal().expect("a floor has a normal");
    let (x, y) = normal.any_orthonormal_pair();
    let tilted = |degrees: f64, azimuth: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        normal * cos + (x * azimuth.cos() + y * azimuth.sin()) * sin
    };
    vec![normal, tilted(30.0, 0.4), tilted(60.0, 2.0), tilted(80.0, 4.0), tilted(89.9, 5.0)]
}

fn models() -> Vec<(&'static str, Box<dyn Brdf>)> {
    let good = "parameters in range";
    let gold = Fresnel::conductor(DVec3::new(0.18, 0.42, 1.37), DVec3::new(3.4, 2.3, 1.8)).expect(good);
    let glass = Fresnel::dielectric(1.5).expect(good);
    let base = Box::new(Lambert::new(0.5 * RHO).expect(good));
    let coat = Box::new(Ggx::new(glass, 0.2, 0.2).expect(good));
    vec![
        ("Lambert", Box::new(Lambert::new(RHO).expect(good))),
        ("Phong 5", Box::new(Phong::new(RHO, 5.0).expect(good))),
        ("Phong 500", Box::new(Phong::new(RHO, 500.0).expect(good))),
        ("Phong 30.5", Box::new(Phong::new(RHO, 30.5).expect(good))),
        ("GGX 0.05", Box::new(Ggx::new(gold, 0.05, 0.05).expect(good))),
        ("GGX 0.4 0.1", Box::new(Ggx::new(gold, 0.4, 0.1).expect(good))),
        ("Ward", Box::new(Ward::new(RHO, 0.2, 0.1).expect(good))),
        ("Oren-Nayar", Box::new(OrenNayar::new(RHO, 0.5).expect(good))),
        ("mirror", Box::new(Mirror::new(glass))),
        ("plastic", Box::new(Sum::new(vec![base, coat]))),
    ]
}

fn options(relative: f64) -> CubatureOptions {
    CubatureOptions { relative, absolute: 1e-12, evaluations: 30_000_000 }
}

fn assert_within(one: RgbEstimate, other: RgbEstimate, slack: f64, what: &str) {
    let off = (one.value - other.value).abs();
    assert!(off.cmple(one.error + other.error + slack).all(), "{what}: {one:?} {other:?}");
}

#[test]
fn a_white_room_shows_the_albedo() {
    let image = room();
    assert!(image.cell_count() > 500);
    let normal = image.normal().unwrap();
    let (x, y) = normal.any_orthonormal_pair();
    for (name, brdf) in models() {
        for view in views(&image).into_iter().take(4) {
            let radiance = reflected_radiance(&image, &*brdf, Some(x), view, |_| DVec3::ONE, options(1e-4)).unwrap();
            let local = DVec3::new(x.dot(view), y.dot(view), normal.dot(view)).normalize();
            // 1e-12: a thousand cells, each with rounded corners.
            let white = match brdf.form(local) {
                Form::Sum(_) => continue,
                _ => brdf.albedo(local),
            };
            assert_within(radiance, white, 1e-12, name);
            assert!(radiance.error.max_element() <= 1.01e-4 * white.value.max_element(), "{name}: {radiance:?}");
        }
    }
}

#[test]
fn more_effort_gives_the_same_within_the_estimate() {
    let image = room();
    let mut lit = 0;
    for (name, brdf) in models() {
        for view in views(&image) {
            let quick = reflected_radiance(&image, &*brdf, Some(DVec3::X), view, emitted, options(1e-3)).unwrap();
            let slow = reflected_radiance(&image, &*brdf, Some(DVec3::X), view, emitted, options(1e-7)).unwrap();
            assert_within(quick, slow, 0.0, name);
            assert!(slow.error.max_element() <= 1.01e-7 * slow.value.max_element() + 2e-12, "{name}: {slow:?}");
            lit += u32::from(slow.value.max_element() > 1e-3);
        }
    }
    assert!(lit > 20, "only {lit} see a lamp");
}

#[test]
fn tables_reflect_what_they_were_made_of() {
    let image = room();
    let normal = image.normal().unwrap();
    let x = normal.any_orthonormal_vector();
    let y = normal.cross(x);
    let rough = Ggx::new(Fresnel::schlick(RHO).unwrap(), 0.5, 0.5).unwrap();
    let projected = ShBrdf::project(&rough, ShSymmetry::Isotropic, 16).unwrap();
    let measured = Merl::tabulate(&rough).unwrap();
    let fast = GgxLtc::new(RHO, 0.5).unwrap();
    for view in views(&image).into_iter().take(3) {
        let local = DVec3::new(x.dot(view), y.dot(view), normal.dot(view)).normalize();
        let exact = reflected_radiance(&image, &rough, Some(x), view, emitted, options(1e-6)).unwrap();
        let models: [(&str, &dyn Brdf, f64); 3] =
            [("harmonics", &projected.brdf, 0.15), ("measured", &measured, 0.01), ("cosines", &fast, 0.25)];
        for (name, brdf, off) in models {
            let white = reflected_radiance(&image, brdf, Some(x), view, |_| DVec3::ONE, options(1e-4)).unwrap();
            assert_within(white, brdf.albedo(local), 1e-12, name);
            let lit = reflected_radiance(&image, brdf, Some(x), view, emitted, options(1e-4)).unwrap();
            let difference = (lit.value - exact.value).abs();
            // What a series, bins and one lobe for another leave; of the last the stated error is a bound.
            assert!(difference.max_element() <= off * exact.value.max_element(), "{name}: {lit:?} {exact:?}");
            if name == "cosines" {
                assert_within(lit, exact, 0.0, name);
            }
        }
    }
}

/// Whatever form a model has, by cubature.
struct General<'a>(&'a dyn Brdf);

impl Brdf for General<'_> {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        self.0.eval(incoming, outgoing)
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        let Form::Lobes(lobes) = self.0.form(outgoing) else { panic!("not a lobe") };
        let peak = |width| nusselt::integral::Peak { axis: lobes[0].axis, width };
        let peaks = vec![peak(1.0 / f64::from(lobes[0].power.max(1)).sqrt())];
        Form::General { peaks, creases: vec![lobes[0].axis], smoothness: Smoothness::Smooth }
    }
}

#[test]
fn closed_forms_are_exact() {
    let image = room();
    for (name, brdf) in models().into_iter().take(3) {
        for view in views(&image) {
            let closed = reflected_radiance(&image, &*brdf, None, view, emitted, options(1e-4)).unwrap();
            let cubature = reflected_radiance(&image, &General(&*brdf), None, view, emitted, options(1e-9)).unwrap();
            assert_within(closed, cubature, 0.0, name);
            assert!(closed.error.max_element() < 1e-9, "{name}: {closed:?}");
            assert!((closed.value - cubature.value).abs().max_element() < 1e-9 * (1.0 + closed.value.max_element()));
        }
    }
}

#[test]
fn matt_surfaces_reflect_their_form_factors() {
    let image = room();
    let scene = image.scene();
    let factors = image.form_factors().unwrap();
    let of =
        |sum: &nusselt::integral::PolygonSum| DVec3::from(scene.polygon(sum.polygon).material().emission) * sum.front;
    let expected: DVec3 = factors.polygons.iter().map(of).sum();
    let matt = Lambert::new(DVec3::ONE).unwrap();
    let radiance = reflected_radiance(&image, &matt, None, image.normal().unwrap(), emitted, options(1e-4)).unwrap();
    assert!((radiance.value - expected).abs().max_element() <= 1e-13 * expected.max_element());
    assert!(expected.max_element() > 0.0);
}

#[test]
fn mirrors_show_what_is_there() {
    let image = room();
    let normal = image.normal().unwrap();
    let mirror = Mirror::new(Fresnel::ALL);
    // Every cell its own colour.
    let colour = |cell: Cell<'_>| DVec3::new(f64::from(cell.id().0), 1.0, 0.0);
    let mut inside = 0;
    for view in views(&image) {
        let radiance = reflected_radiance(&image, &mirror, None, view, colour, options(1e-4)).unwrap();
        let Location::Cell(cell) = image.locate(normal * (2.0 * normal.dot(view)) - view) else { continue };
        inside += 1;
        assert_eq!(radiance.value, DVec3::new(f64::from(cell.0), 1.0, 0.0));
        assert_eq!(radiance.error, DVec3::ZERO);
    }
    assert!(inside >= 4);
}

#[test]
fn a_mirror_at_an_edge_tells_both_sides() {
    // Two squares that meet above the eye, one bright.
    let corners = |low: f64| [[low, -1.0, 1.0], [low + 1.0, -1.0, 1.0], [low + 1.0, 1.0, 1.0], [low, 1.0, 1.0]];
    let square = [vec![3, 2, 1, 0]];
    let lamp = Material { emission: [2.0; 3], ..Material::new("lamp") };
    let scene =
        Scene::builder().mesh(&corners(-1.0), &square, lamp).mesh(&corners(0.0), &square, Material::new("dark"));
    let scene = scene.build().unwrap();
    let image = SceneOrder::new(&scene).view(&Viewpoint::free(DVec3::ZERO), &Domain::Hemisphere(DVec3::Z)).unwrap();
    let radiance =
        reflected_radiance(&image, &Mirror::new(Fresnel::ALL), None, DVec3::Z, emitted, options(1e-4)).unwrap();
    assert_eq!(radiance.error, DVec3::splat(2.0));
    // Matt: half of the factor of a square of side 2 at height 1, of which the lamp is one half.
    let matt = Lambert::new(DVec3::ONE).unwrap();
    let radiance = reflected_radiance(&image, &matt, None, DVec3::Z, emitted, options(1e-4)).unwrap();
    let factor = 4.0 / std::f64::consts::PI * (1.0 / 2.0_f64.sqrt()) * (1.0 / 2.0_f64.sqrt()).atan();
    assert!((radiance.value.x - factor).abs() < 1e-14, "{radiance:?} {factor}");
    // Backs emit nothing.
    let below = SceneOrder::new(&scene)
        .view(&Viewpoint::free(DVec3::new(0.0, 0.0, 2.0)), &Domain::Hemisphere(DVec3::NEG_Z))
        .unwrap();
    let radiance = reflected_radiance(&below, &matt, None, DVec3::NEG_Z, emitted, options(1e-4)).unwrap();
    assert_eq!(radiance.value, DVec3::ZERO);
}

#[test]
fn turning_the_tangent_turns_the_lobe() {
    let image = room();
    let view = views(&image)[2];
    let normal = image.normal().unwrap();
    let ggx = |x, y| Ggx::new(Fresnel::ALL, x, y).unwrap();
    let tangent = normal.any_orthonormal_vector();
    let of = |brdf: &dyn Brdf, tangent| reflected_radiance(&image, brdf, Some(tangent), view, emitted, options(1e-6));
    let one = of(&ggx(0.5, 0.1), tangent).unwrap();
    assert_within(one, of(&ggx(0.1, 0.5), normal.cross(tangent)).unwrap(), 0.0, "exchanged");
    assert_within(one, of(&ggx(0.5, 0.1), tangent * -1e300).unwrap(), 0.0, "turned by half");
    let other = of(&ggx(0.5, 0.1), normal.cross(tangent)).unwrap();
    assert!((one.value - other.value).abs().max_element() > 1e-3 * one.value.max_element(), "{one:?} {other:?}");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let image = room();
    let normal = image.normal().unwrap();
    let matt = Lambert::new(RHO).unwrap();
    let of = |tangent, view| reflected_radiance(&image, &matt, tangent, view, emitted, options(1e-4));
    for view in [-normal, DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
        assert!(matches!(of(None, view), Err(ReflectError::BadView(_))));
    }
    for tangent in [normal, DVec3::ZERO, DVec3::NAN] {
        assert!(matches!(of(Some(tangent), normal), Err(ReflectError::BadTangent(_))));
    }
    let negative = reflected_radiance(&image, &matt, None, normal, |_| -DVec3::ONE, options(1e-4));
    assert!(matches!(negative, Err(ReflectError::BadEmission { .. })));
    let order = SceneOrder::new(image.scene());
    let sphere = order.view(&Viewpoint::free(DVec3::new(0.1, 0.2, 1.0)), &Domain::Sphere).unwrap();
    let refused = reflected_radiance(&sphere, &matt, None, normal, emitted, options(1e-4));
    assert_eq!(refused, Err(ReflectError::NoNormal));
}
