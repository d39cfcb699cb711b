//! Pictures of visible regions: valid polygons that cover what the projection shows once, and share their boundaries.

use geo::{Area, BooleanOps, BoundingRect, Intersects, MultiPolygon, Validation};
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{ContourImage, Domain, GeoRegion, Projection, ProjectionError, Projector, Viewpoint};
use nusselt::samples::{Kind, cornell_box, generate};
use nusselt::scene::{Material, PolygonId, Scene};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};

fn view(scene: &Scene, eye: DVec3, domain: &Domain) -> ContourImage {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).expect("epsilon is 0");
    bsp.view(&Viewpoint::free(eye), domain).expect("a view")
}

fn cornell(domain: &Domain) -> ContourImage {
    view(&cornell_box().to_builder().build().expect("sound"), DVec3::new(278.0, 273.0, 100.0), domain)
}

fn hemispheres() -> Vec<ContourImage> {
    let mut images: Vec<_> = [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::new(0.3, 1.0, -2.0)]
        .map(|normal| cornell(&Domain::Hemisphere(normal)))
        .into();
    for (kind, seed) in [(Kind::Room, 1), (Kind::Office, 2), (Kind::City, 3)] {
        let mesh = generate(kind, 100, seed).expect("a scene");
        let scene = mesh.to_builder().build().expect("sound");
        let eye = DVec3::from(mesh.free_points(1, seed)[0]);
        images.push(view(&scene, eye, &Domain::Hemisphere(DVec3::Z)));
        images.push(view(&scene, eye, &Domain::Hemisphere(DVec3::new(1.0, 0.0, -0.2))));
    }
    images
}

fn spheres() -> Vec<ContourImage> {
    let mesh = generate(Kind::Room, 100, 4).expect("a room");
    let scene = mesh.to_builder().build().expect("sound");
    let eyes = mesh.free_points(2, 5);
    let mut images: Vec<_> = eyes.into_iter().map(|eye| view(&scene, DVec3::from(eye), &Domain::Sphere)).collect();
    images.push(cornell(&Domain::Sphere));
    images.push(view(&Scene::builder().build().expect("no faces"), DVec3::ZERO, &Domain::Sphere));
    images
}

/// All images in all projections that show them.
fn pictures() -> Vec<(ContourImage, Projection)> {
    let hemispheres = hemispheres().into_iter().flat_map(|image| Projection::ALL.map(|p| (image.clone(), p)));
    let spheres = spheres().into_iter().flat_map(|image| Projection::ALL[1..].iter().map(move |&p| (image.clone(), p)));
    hemispheres.chain(spheres).collect()
}

fn regions(image: &ContourImage, projection: Projection) -> Vec<GeoRegion> {
    image.to_geo(projection).expect("the projection shows it")
}

fn area(regions: &[GeoRegion]) -> f64 {
    regions.iter().map(|region| region.shape.signed_area()).sum()
}

/// The directed segments of all rings.
fn segments(regions: &[GeoRegion]) -> Vec<[[f64; 2]; 2]> {
    let polygons = regions.iter().flat_map(|region| &region.shape.0);
    let rings = polygons.flat_map(|polygon| std::iter::once(polygon.exterior()).chain(polygon.interiors()));
    rings.flat_map(|ring| ring.lines().map(|line| [line.start, line.end].map(|p| [p.x + 0.0, p.y + 0.0]))).collect()
}

#[test]
fn regions_are_valid_polygons() {
    // Validation takes time: every projection has its turn.
    for (image, projection) in pictures().into_iter().step_by(5) {
        for region in regions(&image, projection) {
            let faults = region.shape.validation_errors();
            assert!(faults.is_empty(), "{projection:?} {:?}: {faults:?}", region.polygon);
            for polygon in &region.shape {
                assert!(polygon.signed_area() > 0.0, "exteriors are counter-clockwise");
                let exterior = geo::Polygon::new(polygon.exterior().clone(), Vec::new()).signed_area();
                assert!(
                    exterior > 0.0
                        && polygon
                            .interiors()
                            .iter()
                            .all(|hole| { geo::Polygon::new(hole.clone(), Vec::new()).signed_area() < 0.0 })
                );
            }
        }
    }
}

#[test]
fn regions_cover_what_the_projection_shows() {
    for (image, projection) in pictures() {
        let window = Projector::of_image(&image, projection).expect("it shows it").window();
        let is_sphere = *image.domain() == Domain::Sphere;
        let expected = match projection {
            Projection::Nusselt => PI,
            Projection::Stereographic if !is_sphere => PI,
            Projection::Gnomonic => window.size().element_product(),
            Projection::Equirectangular if is_sphere => 2.0 * PI * PI,
            Projection::Equirectangular => PI * PI,
            // What is left of a square pyramid of great circles about the opposite pole.
            Projection::Stereographic => stereographic_outside_of_the_pyramid(),
        };
        let found = area(&regions(&image, projection));
        // Chords leave their curves by the tolerance at most, on either side; the only curves that do not cancel are the
        // border's, which is at most 20 long.
        assert!((found - expected).abs() < 20.0 * Projector::TOLERANCE, "{projection:?}: {found} {expected}");
    }
}

/// Four sectors: the plane z = -x, in polar coordinates (r, t) with r = tan(theta / 2), is cos t sin theta = -cos theta.
fn stereographic_outside_of_the_pyramid() -> f64 {
    let steps = 100_000;
    let sector: f64 = (0..steps)
        .map(|k| {
            let t = (f64::from(k) + 0.5) / f64::from(steps) * PI / 4.0;
            let theta = PI - 1.0f64.atan2(t.cos());
            (theta / 2.0).tan().powi(2) / 2.0 * PI / 4.0 / f64::from(steps)
        })
        .sum();
    8.0 * sector
}

#[test]
fn areas_in_nusselts_projection_are_form_factors_times_pi() {
    for image in hemispheres() {
        let factors = image.form_factors().expect("a hemisphere");
        let mut found: BTreeMap<Option<PolygonId>, (f64, f64)> = BTreeMap::new();
        for region in regions(&image, Projection::Nusselt) {
            let sum = found.entry(region.polygon).or_default();
            sum.0 += region.shape.unsigned_area() / PI;
            sum.1 += segments(&[region]).iter().map(|[p, q]| (p[0] - q[0]).hypot(p[1] - q[1])).sum::<f64>();
        }
        for (polygon, (area, perimeter)) in found {
            let expected = polygon.map_or(factors.background, |id| factors.of(id));
            assert!((area - expected).abs() <= Projector::TOLERANCE * perimeter / PI, "{polygon:?}: {area} {expected}");
        }
    }
}

/// Every segment is in another region the other way round, bit by bit, but for those on the border of the picture.
#[test]
fn regions_share_their_boundaries_exactly() {
    for (image, projection) in pictures() {
        let regions = regions(&image, projection);
        let window = Projector::of_image(&image, projection).expect("it shows it").window();
        let is_sphere = *image.domain() == Domain::Sphere;
        let mut counts: BTreeMap<[[u64; 2]; 2], i32> = BTreeMap::new();
        let bits = |p: [f64; 2]| p.map(f64::to_bits);
        let segments = segments(&regions);
        for [p, q] in &segments {
            *counts.entry([bits(*p), bits(*q)]).or_default() += 1;
        }
        let mut border = 0.0;
        for [p, q] in segments {
            assert_eq!(counts[&[bits(p), bits(q)]], 1, "{projection:?}: {p:?} {q:?} is there twice");
            if counts.contains_key(&[bits(q), bits(p)]) {
                continue;
            }
            border += p[0] * q[1] - p[1] * q[0];
            let on_border = [p, q].iter().all(|p| match projection {
                Projection::Nusselt => (p[0].hypot(p[1]) - 1.0).abs() < 1e-12,
                Projection::Stereographic if !is_sphere => (p[0].hypot(p[1]) - 1.0).abs() < 1e-12,
                // Its corners are the nearest: pi - atan(sqrt 2) from the axis.
                Projection::Stereographic => p[0].hypot(p[1]) > 1.93,
                Projection::Gnomonic => (p[0].abs().max(p[1].abs()) - window.high.x).abs() < 1e-11,
                Projection::Equirectangular if is_sphere => p[0].abs() >= PI || p[1].abs() >= FRAC_PI_2,
                Projection::Equirectangular => true,
            });
            assert!(on_border, "{projection:?}: {p:?} {q:?} has one side");
        }
        assert!((border / 2.0 - area(&regions)).abs() < 1e-9, "{projection:?}");
    }
}

#[test]
fn regions_do_not_overlap() {
    for (image, projection) in pictures() {
        let regions = regions(&image, projection);
        if regions.len() > 60 {
            continue;
        }
        for (k, a) in regions.iter().enumerate() {
            for b in &regions[..k] {
                let [p, q] = [a, b].map(|region| region.shape.bounding_rect().expect("not empty"));
                if p.intersects(&q) {
                    // geo puts points on a grid of its own, 2^-29 of the extent.
                    let common = a.shape.intersection(&b.shape).unsigned_area();
                    assert!(common < 1e-6, "{projection:?}: {:?} and {:?} share {common}", a.polygon, b.polygon);
                }
            }
        }
    }
}

#[test]
fn the_whole_sphere_has_no_nusselt_picture() {
    assert_eq!(cornell(&Domain::Sphere).to_geo(Projection::Nusselt), Err(ProjectionError::NotAHemisphere));
}

/// Rectangles `[low x, low y, high x, high y, z]` over the eye.
fn above(rectangles: &[[f64; 5]], domain: &Domain) -> ContourImage {
    let corners = |&[a, b, c, d, z]: &[f64; 5]| [[a, b, z], [c, b, z], [c, d, z], [a, d, z]];
    let vertices: Vec<[f64; 3]> = rectangles.iter().flat_map(corners).collect();
    let faces: Vec<Vec<usize>> = (0..rectangles.len()).map(|k| (4 * k..4 * k + 4).collect()).collect();
    let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("rectangles");
    view(&scene, DVec3::ZERO, domain)
}

fn of(regions: &[GeoRegion], polygon: Option<u32>) -> &MultiPolygon {
    let polygon = polygon.map(PolygonId);
    &regions.iter().find(|region| region.polygon == polygon).expect("it is seen").shape
}

fn holes(shape: &MultiPolygon) -> Vec<usize> {
    shape.iter().map(|polygon| polygon.interiors().len()).collect()
}

/// A small square before a larger one before a wall: a disc, a ring and a wall with a hole.
#[test]
fn what_floats_before_a_wall_is_a_hole_in_it() {
    let rectangles = [[-9.0, -9.0, 9.0, 9.0, 3.0], [-2.0, -2.0, 2.0, 2.0, 2.0], [-0.5, -0.25, 0.25, 0.5, 1.0]];
    for domain in [Domain::Hemisphere(DVec3::Z), Domain::Hemisphere(DVec3::new(0.1, 0.2, 1.0)), Domain::Sphere] {
        let image = above(&rectangles, &domain);
        for projection in Projection::ALL {
            let Ok(regions) = image.to_geo(projection) else { continue };
            // In a panorama the zenith, which is in the small square, is not a point but an edge.
            if projection == Projection::Equirectangular {
                assert_eq!([0, 1, 2].map(|k| holes(of(&regions, Some(k)))), [vec![0], vec![0], vec![0]]);
                continue;
            }
            if projection == Projection::Gnomonic && domain == Domain::Sphere {
                continue;
            }
            assert_eq!(holes(of(&regions, Some(0))), [1], "{projection:?} {domain:?}");
            assert_eq!(holes(of(&regions, Some(1))), [1]);
            assert_eq!(holes(of(&regions, Some(2))), [0]);
            if projection == Projection::Nusselt {
                assert_eq!(holes(of(&regions, None)), [1], "the sky around the wall");
                assert!((area(&regions) - PI).abs() < 1e-4);
            }
        }
    }
}

#[test]
fn a_wall_seen_through_two_windows_is_two_polygons() {
    let image = above(
        &[
            [-9.0, -9.0, 9.0, 9.0, 2.0],
            [-9.0, -9.0, -2.0, 9.0, 1.0],
            [-1.0, -9.0, 1.0, 9.0, 1.0],
            [2.0, -9.0, 9.0, 9.0, 1.0],
            [-2.0, -9.0, -1.0, -1.0, 1.0],
            [-2.0, 1.0, -1.0, 9.0, 1.0],
            [1.0, -9.0, 2.0, -1.0, 1.0],
            [1.0, 1.0, 2.0, 9.0, 1.0],
        ],
        &Domain::Hemisphere(DVec3::Z),
    );
    assert_eq!(image.regions().iter().filter(|region| region.polygon() == Some(PolygonId(0))).count(), 2);
    let regions = regions(&image, Projection::Gnomonic);
    let windows = of(&regions, Some(0));
    assert_eq!(holes(windows), [0, 0]);
    // From one unit below, the windows are rectangles of 1 x 2 in the image plane.
    assert!((windows.unsigned_area() - 4.0).abs() < 1e-12);
    for window in windows {
        assert_eq!(window.exterior().0.len(), 5, "only the corners: {window:?}");
    }
}

#[test]
fn touching_in_a_point_does_not_connect_and_does_not_divide() {
    // Four quarters of a wall, two of them hidden, that meet in one point.
    let checker = above(
        &[[-4.0, -4.0, 4.0, 4.0, 2.0], [-9.0, -9.0, 0.0, 0.0, 1.0], [0.0, 0.0, 9.0, 9.0, 1.0]],
        &Domain::Hemisphere(DVec3::Z),
    );
    let shape = regions(&checker, Projection::Gnomonic);
    assert_eq!(holes(of(&shape, Some(0))), [0, 0], "two squares with a common corner");
    // Two squares with a common corner before the wall: two holes that touch.
    let touching = above(
        &[[-4.0, -4.0, 4.0, 4.0, 2.0], [-1.0, -1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0, 1.0]],
        &Domain::Hemisphere(DVec3::Z),
    );
    let shape = regions(&touching, Projection::Gnomonic);
    assert_eq!(holes(of(&shape, Some(0))), [2]);
    assert!(of(&shape, Some(0)).is_valid());
}

/// Squares on their corners before a wall, each with a corner all but at the wall's edge, and so small or so near that the
/// straight pieces of that edge would pass through them, or on their other side.
#[test]
fn regions_are_valid_where_corners_are_nearer_to_a_curve_than_the_tolerance() {
    let mut vertices = vec![[-9.0, -9.0, 2.0], [1.0, -9.0, 2.0], [1.0, 9.0, 2.0], [-9.0, 9.0, 2.0]];
    let mut faces = vec![vec![0, 1, 2, 3]];
    for k in 0..24 {
        let (gap, size) = (10f64.powi(-4 - k % 8), if k % 3 == 0 { 1e-7 } else { 0.05 });
        let (x, y) = (0.5 - gap, -2.0 + 0.17 * f64::from(k));
        faces.push((0..4).map(|j| vertices.len() + j).collect());
        vertices.extend([[x, y, 1.0], [x - size, y + size, 1.0], [x - 2.0 * size, y, 1.0], [x - size, y - size, 1.0]]);
    }
    let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("a wall and squares");
    for normal in [DVec3::Z, DVec3::new(0.3, -0.2, 1.0), DVec3::new(1.0, 0.1, 0.1)] {
        let image = view(&scene, DVec3::ZERO, &Domain::Hemisphere(normal));
        for projection in Projection::ALL {
            let regions = regions(&image, projection);
            for region in &regions {
                assert!(!region.is_tangled, "{projection:?} {:?}", region.polygon);
                let faults = region.shape.validation_errors();
                assert!(faults.is_empty(), "{projection:?} {:?}: {faults:?}", region.polygon);
            }
            if projection == Projection::Nusselt && normal == DVec3::Z {
                assert_eq!(holes(of(&regions, Some(0))), [24]);
            }
        }
    }
}

#[test]
fn an_empty_view_is_one_region_of_background() {
    let empty = Scene::builder().build().expect("no faces");
    let sphere = view(&empty, DVec3::ZERO, &Domain::Sphere);
    let [region] = &sphere.regions()[..] else { panic!("one region") };
    assert!(region.loops().is_empty() && region.polygon().is_none());
    let half = view(&empty, DVec3::ZERO, &Domain::Hemisphere(DVec3::new(1.0, 2.0, 3.0)));
    let [region] = &half.regions()[..] else { panic!("one region") };
    assert_eq!(region.loops().len(), 1);
    assert_eq!(region.loops()[0].sides().len(), 1, "the horizon, a whole great circle");
    for projection in Projection::ALL {
        let regions = regions(&half, projection);
        assert_eq!(regions.len(), 1);
        assert_eq!(holes(&regions[0].shape), [0], "{projection:?}");
    }
}

/// Its horizon goes once around, from one end of the picture to the other.
#[test]
fn panoramas_of_tilted_hemispheres_have_no_leaps() {
    let empty = Scene::builder().build().expect("no faces");
    for normal in [DVec3::new(0.5, -1.0, -1.0), DVec3::new(0.3, 1.0, -2.0), DVec3::new(1.0, 0.0, 3.0)] {
        let half = view(&empty, DVec3::ZERO, &Domain::Hemisphere(normal));
        let regions = regions(&half, Projection::Equirectangular);
        let long = segments(&regions).into_iter().filter(|[p, q]| (p[0] - q[0]).hypot(p[1] - q[1]) > 0.1);
        // Both ends of the picture, and the pole.
        assert_eq!(long.count(), 3, "{normal}");
        assert!((area(&regions) - PI * PI).abs() < 1e-6, "{normal}: {}", area(&regions) - PI * PI);
    }
}

/// A horizon that all but passes through the poles, found by a property test.
#[test]
fn panoramas_of_all_but_upright_horizons_have_no_leaps() {
    let empty = Scene::builder().build().expect("no faces");
    let normal = DVec3::new(-4.780_716_324_351_141_5, -3.807_920_823_809_259_2, -5e-324);
    let half = view(&empty, DVec3::ZERO, &Domain::Hemisphere(normal));
    let area = area(&regions(&half, Projection::Equirectangular));
    assert!((area - PI * PI).abs() < 1e-6, "{area}");
}
