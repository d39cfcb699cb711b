//! What lights a surface: skies, linear emission, lights without extent; against closed forms and brute force.

mod common;

use common::Random;
use glam::DVec3;
use nusselt::brdf::{
    Brdf, Emission, Fresnel, Ggx, Lambert, Light, Lighting, Mirror, Phong, ReflectError, Sky, emitted,
    emitted_by_both_sides, reflected_radiance,
};
use nusselt::contour::{Cell, ContourImage, Domain, SceneOrder, Viewpoint};
use nusselt::exact::{Sign, orient3d};
use nusselt::integral::CubatureOptions;
use nusselt::scene::{Material, Scene};
use std::f64::consts::PI;

const RHO: DVec3 = DVec3::new(0.9, 0.5, 0.1);

fn options(relative: f64) -> CubatureOptions {
    CubatureOptions { relative, absolute: 1e-12, evaluations: 3_000_000 }
}

fn scene(faces: &[&[[f64; 3]]]) -> Scene {
    let lamp = Material { emission: [2.0, 1.0, 0.5], ..Material::new("lamp") };
    let builder = faces.iter().fold(Scene::builder(), |builder, face| {
        builder.mesh(face, &[(0..face.len()).collect::<Vec<_>>()], lamp.clone())
    });
    builder.build().expect("a scene")
}

/// From the origin, up.
fn above(scene: &Scene) -> ContourImage {
    hemisphere(scene, DVec3::ZERO, DVec3::Z)
}

fn hemisphere(scene: &Scene, eye: DVec3, normal: DVec3) -> ContourImage {
    SceneOrder::new(scene).view(&Viewpoint::free(eye), &Domain::Hemisphere(normal)).expect("a view")
}

fn models() -> Vec<(&'static str, Box<dyn Brdf>)> {
    let good = "parameters in range";
    vec![
        ("Lambert", Box::new(Lambert::new(RHO).expect(good))),
        ("Phong 20", Box::new(Phong::new(RHO, 20.0).expect(good))),
        ("Phong 2048", Box::new(Phong::new(RHO, 2048.0).expect(good))),
        ("GGX 0.3", Box::new(Ggx::new(Fresnel::ALL, 0.3, 0.3).expect(good))),
        ("GGX 0.02", Box::new(Ggx::new(Fresnel::ALL, 0.02, 0.02).expect(good))),
    ]
}

fn under(sky: Sky) -> Lighting {
    Lighting { sky: Some(sky), ..Lighting::default() }
}

#[test]
fn open_skies_light_level_and_upright_surfaces_as_known() {
    let empty = scene(&[]);
    let matt = Lambert::new(RHO).unwrap();
    let of = |image: &ContourImage, sky| {
        let normal = image.normal().unwrap();
        under(sky).reflected(image, &matt, None, normal, options(1e-9)).unwrap()
    };
    let [level, upright] = [above(&empty), hemisphere(&empty, DVec3::ZERO, DVec3::X)];
    let zenith = DVec3::new(3.0, 2.0, 1.0);
    let constant = of(&level, Sky::constant(zenith).unwrap());
    assert!((constant.value - RHO * zenith).length() < 1e-14, "{constant:?}");
    // Overcast: 7 pi / 9 of the zenith's radiance, and (pi / 2 + 4 / 3) / 3.
    let overcast = Sky::overcast(zenith, DVec3::Z).unwrap();
    for (image, factor) in [(&level, 7.0 / 9.0), (&upright, (PI / 2.0 + 4.0 / 3.0) / (3.0 * PI))] {
        let radiance = of(image, overcast);
        assert!((radiance.value - RHO * zenith * factor).abs().cmple(radiance.error + 1e-14).all(), "{radiance:?}");
        assert!(radiance.error.max_element() <= 1.01e-9 * radiance.value.max_element());
    }
    // From below nothing comes but a constant sky.
    let below = hemisphere(&empty, DVec3::ZERO, DVec3::NEG_Z);
    assert_eq!(of(&below, overcast).value, DVec3::ZERO);
    assert!(of(&below, Sky::constant(zenith).unwrap()).value.x > 1.0);
}

/// The integral over the hemisphere above the plane of `up`, in polar coordinates about `pole`, finer towards it.
fn polar(pole: DVec3, f: &impl Fn(DVec3) -> DVec3) -> DVec3 {
    let (x, y) = pole.any_orthonormal_pair();
    // Gauss's rule of 3 points in each field.
    let nodes = [(0.5 - 0.15_f64.sqrt(), 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + 0.15_f64.sqrt(), 5.0 / 18.0)];
    let (rings, sectors) = (400, 800);
    let mut sum = DVec3::ZERO;
    for ring in 0..rings {
        for (s, weight_s) in nodes {
            let t = (f64::from(ring) + s) / f64::from(rings);
            let (angle, step) = (PI * t * t, 2.0 * PI * t / f64::from(rings));
            for sector in 0..sectors {
                let turn = 2.0 * PI * (f64::from(sector) + 0.5) / f64::from(sectors);
                let u = pole * angle.cos() + (x * turn.cos() + y * turn.sin()) * angle.sin();
                sum += f(u) * (angle.sin() * step * weight_s * 2.0 * PI / f64::from(sectors));
            }
        }
    }
    sum
}

#[test]
fn clear_skies_are_what_brute_force_gives() {
    let empty = scene(&[]);
    let matt = Lambert::new(RHO).unwrap();
    let image = above(&empty);
    for sun in [DVec3::Z, DVec3::new(1.0, 0.3, 1.0), DVec3::new(1.0, 0.0, 0.1)] {
        let sky = Sky::clear(DVec3::ONE, DVec3::Z, sun).unwrap();
        let brute = polar(sun.normalize(), &|u| sky.radiance(u) * matt.eval(u, DVec3::Z) * u.z.max(0.0));
        let fine = under(sky).reflected(&image, &matt, None, DVec3::Z, options(1e-8)).unwrap();
        // Brute force has a kink at the horizon, where the integrand is as flat as z.
        assert!((fine.value - brute).abs().max_element() < 2e-5 * brute.max_element(), "{fine:?} {brute}");
        for relative in [1e-2, 1e-4, 1e-6] {
            for (name, brdf) in models() {
                for view in [DVec3::new(0.3, 0.0, 1.0), DVec3::new(-1.0, 0.0, 0.1)] {
                    let [quick, slow] = [relative, 1e-8]
                        .map(|relative| under(sky).reflected(&image, &*brdf, None, view, options(relative)).unwrap());
                    let off = (quick.value - slow.value).abs();
                    assert!(off.cmple(quick.error + slow.error).all(), "{name}: {quick:?} {slow:?}");
                    assert!(quick.error.max_element() <= 1.01 * relative * quick.value.max_element(), "{quick:?}");
                }
            }
        }
    }
}

#[test]
fn what_hides_the_sky_takes_its_part_away() {
    let screens = scene(&[
        &[[1.0, -2.0, 0.5], [1.0, 2.0, 0.5], [1.5, 2.0, 3.0], [1.2, -2.0, 4.0]],
        &[[-1.0, -1.0, 0.2], [-0.2, -1.0, 0.8], [-0.5, 1.0, 1.0]],
    ]);
    let [open, hidden] = [above(&scene(&[])), above(&screens)];
    let view = DVec3::new(-0.5, 0.2, 0.7);
    for sky in [
        Sky::overcast(DVec3::ONE, DVec3::new(0.2, 0.1, 1.0)).unwrap(),
        Sky::clear(DVec3::ONE, DVec3::Z, DVec3::new(1.0, 0.1, 0.6)).unwrap(),
        Sky::constant(DVec3::ONE).unwrap(),
    ] {
        for (name, brdf) in models() {
            let of = |image: &ContourImage, shows: &dyn Fn(Cell<'_>) -> bool| {
                let emission = |cell: Cell<'_>| if shows(cell) { Emission::Sky(&sky) } else { Emission::NONE };
                reflected_radiance(image, &*brdf, None, view, emission, options(1e-6)).unwrap()
            };
            let whole = of(&open, &|_| true);
            let seen = of(&hidden, &|cell| cell.polygon().is_none());
            let rest = of(&hidden, &|cell| cell.polygon().is_some());
            let off = (whole.value - seen.value - rest.value).abs();
            let error = whole.error + seen.error + rest.error;
            assert!(off.cmple(error).all(), "{name}: {whole:?} {seen:?} {rest:?}");
            assert!(seen.value.x > 0.0 && rest.value.x > 0.0, "{name}: {seen:?} {rest:?}");
            let lit = under(sky).reflected(&hidden, &*brdf, None, view, options(1e-6)).unwrap();
            let lamps = Lighting::default().reflected(&hidden, &*brdf, None, view, options(1e-6)).unwrap();
            let off = (lit.value - seen.value - lamps.value).abs();
            assert!(off.cmple(lit.error + seen.error + lamps.error).all(), "{name}: {lit:?} {seen:?} {lamps:?}");
        }
    }
}

#[test]
fn mirrors_show_the_sky() {
    let sky = Sky::clear(RHO, DVec3::Z, DVec3::new(1.0, 0.0, 1.0)).unwrap();
    let image = above(&scene(&[]));
    let view = DVec3::new(0.3, 0.5, 0.9);
    let radiance = under(sky).reflected(&image, &Mirror::new(Fresnel::ALL), None, view, options(1e-6)).unwrap().value;
    let expected = sky.radiance(DVec3::new(-0.3, -0.5, 0.9).normalize());
    assert!((radiance - expected).length() < 1e-14, "{radiance} {expected}");
}

/// The integral over a triangle in space, by 4^8 parts.
fn over_triangle([a, b, c]: [DVec3; 3], depth: u32, f: &impl Fn(DVec3) -> DVec3) -> DVec3 {
    if depth > 0 {
        let [ab, bc, ca] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
        let parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
        return parts.into_iter().map(|part| over_triangle(part, depth - 1, f)).sum();
    }
    // Exact to degree 2.
    let points = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
    points.into_iter().map(f).sum::<DVec3>() * ((b - a).cross(c - a).length() / 6.0)
}

#[test]
fn radiances_at_vertices_are_interpolated() {
    let face = [[-1.0, -1.0, 1.0], [-1.5, 1.0, 1.5], [1.0, 1.2, 2.0], [1.4, -0.9, 1.4]];
    // Planar: the last corner is moved into the plane of the others.
    let [a, b, c, d] = face.map(DVec3::from);
    let normal = (b - a).cross(c - a);
    let d = DVec3::new(d.x, d.y, (normal.dot(a) - normal.x * d.x - normal.y * d.y) / normal.z);
    let radiances = [DVec3::new(1.0, 0.0, 3.0), DVec3::new(2.0, 5.0, 3.0), DVec3::new(4.0, 0.0, 3.0), DVec3::ZERO];
    for corners in [vec![a, b, c], vec![a, b, c, d]] {
        let arrays: Vec<[f64; 3]> = corners.iter().map(DVec3::to_array).collect();
        let image = above(&scene(&[&arrays]));
        let scene = image.scene();
        let emission = |cell: Cell<'_>| match cell.piece() {
            None => Emission::NONE,
            Some(piece) => {
                let vertices = scene.piece(piece).points();
                let of = |p: DVec3| radiances[corners.iter().position(|&c| c == p).unwrap()];
                Emission::Vertices(vertices.map(of).collect())
            }
        };
        // If it is not exactly planar it is triangulated, at the scene's choice: its pieces tell.
        let triangles: Vec<[DVec3; 3]> = scene
            .pieces()
            .flat_map(|piece| {
                let points: Vec<DVec3> = piece.points().collect();
                (1..points.len() - 1).map(move |k| [points[0], points[k], points[k + 1]]).collect::<Vec<_>>()
            })
            .collect();
        for (name, brdf) in models() {
            if name.ends_with("2048") || name.ends_with("0.02") {
                continue;
            }
            let view = DVec3::new(0.3, -0.4, 0.8).normalize();
            let radiance = reflected_radiance(&image, &*brdf, Some(DVec3::X), view, emission, options(1e-8)).unwrap();
            let brute: DVec3 = triangles
                .iter()
                .map(|&[a, b, c]| {
                    let of = |p: DVec3| radiances[corners.iter().position(|&c| c == p).unwrap()];
                    let area = (b - a).cross(c - a);
                    over_triangle([a, b, c], 8, &|p| {
                        let at = |q: DVec3, r: DVec3| (q - p).cross(r - p).dot(area) / area.length_squared();
                        let emitted = of(a) * at(b, c) + of(b) * at(c, a) + of(c) * at(a, b);
                        let u = p.normalize();
                        let solid = u.dot(area).abs() / area.length() / p.length_squared();
                        brdf.eval(u, view) * emitted * (u.z * solid)
                    })
                })
                .sum();
            // The rule's error falls with the fourth power of a part's size, 1 / 256.
            let off = (radiance.value - brute).abs();
            assert!(off.max_element() < 1e-7 * brute.max_element(), "{name}: {radiance:?} {brute}");
            let even = |cell: Cell<'_>| {
                cell.piece().map_or(Emission::NONE, |piece| {
                    Emission::Vertices(vec![RHO; scene.piece(piece).vertices().len()].into())
                })
            };
            let even = reflected_radiance(&image, &*brdf, None, view, even, options(1e-8)).unwrap();
            let constant = |cell: Cell<'_>| if cell.polygon().is_some() { RHO } else { DVec3::ZERO };
            let constant = reflected_radiance(&image, &*brdf, None, view, constant, options(1e-8)).unwrap();
            let off = (even.value - constant.value).abs();
            assert!(off.cmple(even.error + constant.error).all(), "{name}: {even:?} {constant:?}");
        }
        // A mirror shows the point that is hit.
        let view = DVec3::new(0.45, -0.27, 0.9);
        let hit = |[a, b, c]: [DVec3; 3]| {
            let u = DVec3::new(-0.45, 0.27, 0.9);
            let area = (b - a).cross(c - a);
            let p = u * (area.dot(a) / area.dot(u));
            let at = |q: DVec3, r: DVec3| (q - p).cross(r - p).dot(area) / area.length_squared();
            let shares = [at(b, c), at(c, a), at(a, b)];
            let of = |p: DVec3| radiances[corners.iter().position(|&c| c == p).unwrap()];
            shares.iter().all(|&s| s >= 0.0).then(|| of(a) * shares[0] + of(b) * shares[1] + of(c) * shares[2])
        };
        let expected = triangles.iter().find_map(|&triangle| hit(triangle)).unwrap();
        let mirror = Mirror::new(Fresnel::ALL);
        let shown = reflected_radiance(&image, &mirror, None, view, emission, options(1e-6)).unwrap().value;
        assert!((shown - expected).length() < 1e-13, "{shown} {expected}");
    }
}

#[test]
fn radiances_have_to_fit_the_vertices() {
    let image = above(&scene(&[&[[-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, 1.0, 1.0]]]));
    let matt = Lambert::new(RHO).unwrap();
    let of = |emission: &dyn Fn(Cell<'_>) -> Emission<'static>| {
        reflected_radiance(&image, &matt, None, DVec3::Z, emission, options(1e-6))
    };
    let four = of(&|cell| cell.polygon().map_or(Emission::NONE, |_| Emission::Vertices(vec![RHO; 4].into())));
    assert!(matches!(four, Err(ReflectError::WrongVertices { vertices: 3, radiances: 4, .. })), "{four:?}");
    let background = of(&|_| Emission::Vertices(vec![RHO; 3].into()));
    assert!(matches!(background, Err(ReflectError::WrongVertices { vertices: 0, radiances: 3, .. })), "{background:?}");
    let bad = of(&|cell| cell.polygon().map_or(Emission::NONE, |_| Emission::Vertices(vec![-RHO; 3].into())));
    assert!(matches!(bad, Err(ReflectError::BadEmission { .. })), "{bad:?}");
}

#[test]
fn backs_emit_if_both_sides_are_to() {
    let image = above(&scene(&[&[[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [0.0, 1.0, 1.0]]]));
    let matt = Lambert::new(RHO).unwrap();
    let of = |is_two_sided| {
        let lighting = Lighting { is_two_sided, ..Lighting::default() };
        lighting.reflected(&image, &matt, None, DVec3::Z, options(1e-6)).unwrap().value
    };
    assert_eq!(of(false), DVec3::ZERO);
    let factor = image.form_factors().unwrap().polygons[0].back;
    assert!((of(true) - RHO * DVec3::new(2.0, 1.0, 0.5) * factor).length() < 1e-14);
    let cell = image.cells().find(|cell| cell.polygon().is_some()).unwrap();
    assert_eq!((emitted(cell), emitted_by_both_sides(cell).x), (DVec3::ZERO, 2.0));
}

#[test]
fn lights_without_extent_follow_their_laws() {
    let image = above(&scene(&[]));
    let position = DVec3::new(1.0, -2.0, 2.0);
    let intensity = DVec3::new(90.0, 9.0, 0.9);
    let view = DVec3::new(0.5, 0.2, 0.9).normalize();
    for (name, brdf) in models() {
        let of = |light| {
            let lighting = Lighting { lights: vec![light], ..Lighting::default() };
            lighting.reflected(&image, &*brdf, Some(DVec3::X), view, options(1e-6)).unwrap()
        };
        let expected = brdf.eval(position / 3.0, view) * intensity * (2.0 / 3.0 / 9.0);
        let point = of(Light::Point { position, intensity });
        assert!((point.value - expected).length() <= 1e-13 * expected.length(), "{name}: {point:?} {expected}");
        assert_eq!(point.error, DVec3::ZERO);
        let sun = of(Light::Directional { towards: position * 1e200, irradiance: intensity / 9.0 });
        assert!((sun.value - expected).length() <= 1e-13 * expected.length(), "{name}: {sun:?} {expected}");
        let below = of(Light::Point { position: -position, intensity });
        assert_eq!(below.value, DVec3::ZERO);
    }
    let mirror = Mirror::new(Fresnel::ALL);
    let lighting = Lighting { lights: vec![Light::Point { position, intensity }], ..Lighting::default() };
    let seen = lighting.reflected(&image, &mirror, None, DVec3::new(-1.0, 2.0, 2.0), options(1e-6)).unwrap();
    assert_eq!(seen.value, DVec3::ZERO);
    for light in [
        Light::Point { position: DVec3::ZERO, intensity },
        Light::Point { position: DVec3::NAN, intensity },
        Light::Point { position, intensity: -intensity },
        Light::Directional { towards: DVec3::ZERO, irradiance: intensity },
        Light::Directional { towards: DVec3::Z, irradiance: DVec3::INFINITY },
    ] {
        let lighting = Lighting { lights: vec![light], ..Lighting::default() };
        let refused = lighting.reflected(&image, &mirror, None, view, options(1e-6));
        assert!(matches!(refused, Err(ReflectError::BadLight(_))), "{refused:?}");
    }
}

/// The irradiance of a light above the origin over what it would be, and the error.
fn share(image: &ContourImage, light: Light) -> (f64, f64) {
    let white = Lambert::new(DVec3::ONE).expect("a reflectance");
    let of = |image: &ContourImage| {
        let lighting = Lighting { lights: vec![light], ..Lighting::default() };
        // What polygons emit is not looked at: they show their backs, or are black.
        lighting.reflected(image, &white, None, DVec3::Z, options(1e-6)).expect("a radiance")
    };
    let open = of(&hemisphere(&scene(&[]), image.viewpoint().eye(), DVec3::Z));
    let seen = of(image);
    (seen.value.x / open.value.x, seen.error.x / open.value.x)
}

#[test]
fn shadows_are_exact() {
    // A square at height 1 whose back is seen, in two triangles that meet along its diagonal.
    let square = scene(&[
        &[[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0]],
        &[[-1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]],
    ]);
    let image = above(&square);
    let point =
        |x: f64, y: f64, z: f64| share(&image, Light::Point { position: DVec3::new(x, y, z), intensity: DVec3::ONE });
    let sun = |x: f64, y: f64, z: f64| {
        share(&image, Light::Directional { towards: DVec3::new(x, y, z), irradiance: DVec3::ONE })
    };
    assert_eq!(point(0.3, 0.1, 2.0), (0.0, 0.0));
    assert_eq!(point(0.3, 0.1, 0.9), (1.0, 0.0));
    // In the plane, and just behind it.
    assert_eq!(point(0.3, 0.1, 1.0), (1.0, 0.0));
    assert_eq!(point(0.3, 0.1, 1.0_f64.next_up()), (0.0, 0.0));
    // On the diagonal both triangles hide it.
    assert_eq!(point(0.5, 0.5, 2.0), (0.0, 0.0));
    assert_eq!(sun(0.25, 0.25, 1.0), (0.0, 0.0));
    // Beside the square, just so.
    assert_eq!(point(2.0_f64.next_up(), 0.0, 2.0), (1.0, 0.0));
    assert_eq!(point(2.0_f64.next_down(), 0.0, 2.0), (0.0, 0.0));
    assert_eq!(sun(1.0_f64.next_up(), 0.0, 1.0), (1.0, 0.0));
    // On its edge it is between: the error says so.
    let (value, error) = point(2.0, 0.0, 2.0);
    assert!([0.0, 1.0].contains(&value) && [1.0].contains(&error), "{value} {error}");
}

#[test]
fn points_are_seen_that_no_triangle_separates_from_the_eye() {
    let mut random = Random(5);
    let (mut seen, mut hidden) = (0, 0);
    for _ in 0..40 {
        let triangles: Vec<[DVec3; 3]> = (0..12)
            .map(|_| {
                let middle = random.in_cube(2.0) + DVec3::Z * 3.0;
                [0; 3].map(|_| middle + random.in_cube(1.0))
            })
            .collect();
        let builder = triangles.iter().fold(Scene::builder(), |builder, triangle| {
            builder.mesh(&triangle.map(|p| p.to_array()), &[vec![0, 1, 2]], Material::new("black"))
        });
        let eye = random.in_cube(0.3);
        let image = hemisphere(&builder.build().unwrap(), eye, DVec3::Z);
        for _ in 0..50 {
            let light = random.in_cube(2.5) + DVec3::Z * 3.0;
            // The segment crosses the triangle: its ends are on different sides, and the line turns one way about all edges.
            let crosses = |&[a, b, c]: &[DVec3; 3]| {
                orient3d(a, b, c, eye) * orient3d(a, b, c, light) == Sign::Negative
                    && orient3d(eye, light, a, b) == orient3d(eye, light, b, c)
                    && orient3d(eye, light, b, c) == orient3d(eye, light, c, a)
            };
            let is_hidden = triangles.iter().any(crosses);
            let found = share(&image, Light::Point { position: light, intensity: DVec3::ONE });
            assert_eq!(found, (if is_hidden { 0.0 } else { 1.0 }, 0.0), "{eye} {light}");
            if is_hidden { hidden += 1 } else { seen += 1 }
        }
    }
    assert!(seen > 500 && hidden > 100, "{seen} {hidden}");
}
