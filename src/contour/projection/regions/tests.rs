//! Boundaries in the plane: what their points are, where they are cut, and that rounding leaves polygons.

use super::*;
use crate::bsp::{BspOptions, SceneBsp};
use crate::contour::{Domain, ViewOptions, Viewpoint};
use crate::samples::cornell_box;
use crate::scene::{Material, Scene};

fn view(scene: &Scene, eye: DVec3, domain: &Domain) -> ContourImage {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).expect("epsilon is 0");
    bsp.view(&Viewpoint::free(eye), domain).expect("a view")
}

fn empty(domain: &Domain) -> ContourImage {
    view(&Scene::builder().build().expect("no faces"), DVec3::ZERO, domain)
}

fn with_flattener<T>(image: &ContourImage, projection: Projection, f: impl FnOnce(&Flattener<'_>) -> T) -> T {
    let projector = Projector::of_image(image, projection).expect("it shows it");
    let mut mosaic = Mosaic::new(image);
    let seam = projector.cut_to_picture(&mut mosaic);
    let outlines = Outlines::new(mosaic, seam);
    f(&Flattener { projector: &projector, outlines: &outlines })
}

/// How far a point is from a segment, by trying many points of that.
fn distance(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    (0..=1000).map(|k| p.distance(a.lerp(b, f64::from(k) / 1000.0))).fold(f64::INFINITY, f64::min)
}

#[test]
fn no_point_of_a_segment_is_nearer_than_the_nearest() {
    let points = [[0.0, 0.0], [1.0, 0.25], [-0.5, 2.0], [3.0, -1.0], [0.5, 0.125]].map(DVec2::from);
    for p in points {
        for a in points {
            assert_eq!(nearest_on_segment(p, a, a), a);
            for b in points {
                let nearest = nearest_on_segment(p, a, b);
                assert!(distance(nearest, [a, b]) < 2e-3, "{nearest} is not between {a} and {b}");
                assert!(p.distance(nearest) <= distance(p, [a, b]) + 1e-15, "{p} {a} {b}: {nearest}");
            }
        }
    }
}

#[test]
fn areas_of_rings_are_signed() {
    let ring = [[1.0, 1.0], [4.0, 1.0], [4.0, 3.0], [1.0, 3.0]].map(DVec2::from);
    assert_eq!(double_area(&ring).to_bits(), 12.0_f64.to_bits());
    let back: Vec<DVec2> = ring.iter().rev().copied().collect();
    assert_eq!(double_area(&back).to_bits(), (-12.0_f64).to_bits());
    assert_eq!(double_area(&[]).to_bits(), 0);
}

/// A stretch of a curve is halved where it bends, in the middle of what is between its ends.
#[test]
fn only_what_bends_is_halved() {
    let image = empty(&Domain::Hemisphere(DVec3::Z));
    with_flattener(&image, Projection::Nusselt, |flattener| {
        let curve = |axes: [DVec3; 2]| Curve { flattener, tolerance: 1e-3, axes, length: 0.5, parts: [Part::Front; 2] };
        let places = |path: &Path<'_>| {
            let curve = path.curve.as_ref().expect("a curve");
            let inner = path.points.iter().map(|point| point.1);
            std::iter::once(curve.place(0.0)).chain(inner).chain([curve.place(curve.length)]).collect::<Vec<_>>()
        };
        let piece = |path: &Path<'_>, stretch: usize| {
            let inner = path.points.iter().map(|point| point.0);
            let angles: Vec<f64> = [0.0].into_iter().chain(inner).chain([0.5]).collect();
            let ends = places(path);
            let span = [angles[stretch], angles[stretch + 1]];
            Piece { line: 7, span, ends: [ends[stretch], ends[stretch + 1]] }
        };
        let mut path = Path { curve: Some(curve([DVec3::X, DVec3::Y])), points: Vec::new() };
        // Each time another stretch: the only one, the last, the first, one between.
        for (stretch, angles) in [
            (0, vec![0.25]),
            (1, vec![0.25, 0.375]),
            (0, vec![0.125, 0.25, 0.375]),
            (2, vec![0.125, 0.25, 0.3125, 0.375]),
        ] {
            let added = path.halve(piece(&path, stretch));
            path.points.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert_eq!(path.points.iter().map(|point| point.0).collect::<Vec<_>>(), angles);
            assert_eq!(added, Some(path.points[stretch]));
            for (angle, place) in &path.points {
                let seen = flattener.projector.frame().components(DVec3::new(angle.cos(), angle.sin(), 0.0));
                assert!(place.distance(seen.truncate()) < 1e-15, "{angle} {place}");
            }
        }
        // A great circle through the middle of the picture is a diameter.
        let mut straight = Path { curve: Some(curve([DVec3::X, DVec3::Z])), points: Vec::new() };
        let whole = piece(&straight, 0);
        assert_eq!(straight.halve(whole), None);
        assert!(straight.points.is_empty());
        assert_eq!(Path { curve: None, points: Vec::new() }.halve(whole), None);
    });
}

/// Between two points of a path there is no line of the grid, where the curve runs one way across such lines, and the curve
/// leaves their chord by little.
#[test]
fn paths_are_cut_at_the_lines_of_the_grid_and_stay_near_their_curves() {
    let scene = cornell_box().to_builder().build().expect("sound");
    let tolerance = 1e-3;
    let spacing = 2.0 * f64::sqrt(tolerance);
    for domain in [Domain::Hemisphere(DVec3::Z), Domain::Hemisphere(DVec3::new(0.3, 1.0, -2.0)), Domain::Sphere] {
        let image = view(&scene, DVec3::new(278.0, 273.0, 100.0), &domain);
        for projection in [Projection::Nusselt, Projection::Stereographic, Projection::Equirectangular] {
            if projection == Projection::Nusselt && domain == Domain::Sphere {
                continue;
            }
            let cuts = with_flattener(&image, projection, |flattener| {
                let mut cuts = [0; 2];
                for chain in 0..flattener.outlines.chains.len() as u32 {
                    let path = flattener.path(chain, tolerance);
                    let Some(curve) = &path.curve else { continue };
                    let run = Run { chain, forward: true };
                    let mut points = vec![(0.0, flattener.start(run))];
                    points.extend(&path.points);
                    points.push((curve.length, flattener.end(run)));
                    for pair in points.windows(2) {
                        let [(from, p), (to, q)] = [pair[0], pair[1]];
                        assert!(from <= to, "{projection:?} {chain}: {from} {to}");
                        let (low, high) = (p.min(q) / spacing + 1e-9, p.max(q) / spacing - 1e-9);
                        let piece = curve.length / (curve.length / LONG).ceil();
                        let start = (f64::midpoint(from, to) / piece).floor() * piece;
                        let places = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| curve.place(start + share * piece));
                        for axis in 0..2 {
                            let runs_one_way = places.is_sorted_by(|a, b| a[axis] <= b[axis])
                                || places.is_sorted_by(|a, b| a[axis] >= b[axis]);
                            assert!(
                                !runs_one_way || low[axis].floor() + 1.0 >= high[axis],
                                "{projection:?} {domain:?} {chain}: a line between {p} and {q}"
                            );
                        }
                        for k in 1..16 {
                            let place = curve.place(from + (to - from) * f64::from(k) / 16.0);
                            let off = distance(place, [p, q]);
                            assert!(off < 1.5 * tolerance, "{projection:?} {chain}: {off} from the chord at {place}");
                        }
                    }
                    for (angle, place) in path.points {
                        assert!(curve.place(angle).distance(place) < 1e-9, "{projection:?} {chain}: {angle} {place}");
                        for axis in 0..2 {
                            cuts[axis] +=
                                usize::from(((place[axis] / spacing).round() * spacing - place[axis]).abs() == 0.0);
                        }
                    }
                }
                cuts
            });
            assert!(cuts[0] > 20 && cuts[1] > 20, "{projection:?} {domain:?}: {cuts:?} cuts");
        }
    }
}

/// Longitudes are one thing a turn apart: beside the seam the side that a point is on tells which is meant.
#[test]
fn what_is_beside_the_seam_is_at_the_end_that_it_is_seen_at() {
    let image = empty(&Domain::Sphere);
    with_flattener(&image, Projection::Equirectangular, |flattener| {
        for near in [0.0, 1e-300, 1e-15, 0.1, 0.7] {
            let [left, right] = [near - PI, PI - near].map(|x| DVec2::new(x, 0.5));
            for p in [left, right] {
                // No place is beyond an end.
                let ends = [left, right].map(|end| if end == p { p } else { DVec2::new(PI.copysign(end.x), 0.5) });
                for (part, expected) in [(Part::Left, ends[0]), (Part::Right, ends[1]), (Part::Front, p)] {
                    let place = flattener.beside_seam(p, part);
                    assert!(place.distance(expected) < 2e-15, "{p} {part:?}: {place}");
                    assert!(place.x.abs() <= PI);
                }
            }
        }
        for x in [-2.3, -1.0, 0.0, 2.3] {
            for part in [Part::Left, Part::Right, Part::Front] {
                assert_eq!(flattener.beside_seam(DVec2::new(x, -0.5), part), DVec2::new(x, -0.5), "far from it");
            }
        }
    });
}

/// Triangles so narrow that rounding moves corners onto others or turns them over, by themselves and as holes in a wall.
#[test]
fn what_rounding_turns_over_or_collapses_is_no_polygon_that_is_turned_over() {
    let bump = |x: f64, steps: u32| f64::from_bits(x.to_bits() + u64::from(steps));
    for wall in [false, true] {
        let mut vertices =
            vec![[-900.0, -900.0, 600.0], [900.0, -900.0, 600.0], [900.0, 900.0, 600.0], [-900.0, 900.0, 600.0]];
        let mut faces = if wall { vec![vec![0, 1, 2, 3]] } else { vec![] };
        for k in 0..200 {
            let (x, y, z) = (1.1 + f64::from(k % 20) / 3.0, 1.3 + f64::from(k / 20) / 3.0, 5.7);
            let first = vertices.len();
            vertices.push([x, y, z]);
            vertices.push([bump(x, 1 + k % 3), bump(y, k % 2), z]);
            vertices.push([bump(x, k % 2), bump(y, 1 + k % 4), z]);
            faces.push(vec![first, first + 1, first + 2]);
        }
        let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("triangles");
        let image = view(&scene, DVec3::ZERO, &Domain::Hemisphere(DVec3::Z));
        assert_eq!(image.regions().len(), 201 + usize::from(wall), "all of them are seen");
        for projection in Projection::ALL {
            let projector = Projector::of_image(&image, projection).expect("a hemisphere");
            let regions = projector.regions(&image, Projector::TOLERANCE);
            assert!(regions.len() < 190, "{projection:?}: some have no three points left, of {}", regions.len());
            for region in regions {
                for (ring, sign) in region.holes.iter().map(|ring| (ring, -1.0)).chain([(&region.exterior, 1.0)]) {
                    assert!(ring.len() > 2, "{projection:?}: {ring:?}");
                    assert!(sign * double_area(ring) >= 0.0, "{projection:?}: {ring:?} is turned over");
                }
            }
        }
    }
}

/// The horizon all but passes through the poles, and near them its longitudes are what rounding makes of them: pieces of it lie
/// on each other however often they are halved.
#[test]
fn what_stays_tangled_is_told() {
    let normal = DVec3::new(-4.780_716_324_351_141_5, -3.807_920_823_809_259_2, -5e-324);
    let bsp = SceneBsp::build(&Scene::builder().build().expect("no faces"), &BspOptions::default()).expect("a tree");
    let options = ViewOptions { quadtree_depth: Some(3), ..ViewOptions::default() };
    let image = bsp.view_with(&Viewpoint::free(DVec3::ZERO), &Domain::Hemisphere(normal), &options).expect("a view");
    with_flattener(&image, Projection::Equirectangular, |flattener| {
        let inner = flattener.all_inner(1e-4);
        let told: Vec<u32> = (0..).zip(&inner.is_tangled).filter_map(|(chain, told)| told.then_some(chain)).collect();
        let horizon = |&chain: &u32| !flattener.is_on_seam(chain);
        assert!(!told.is_empty() && told.iter().all(horizon), "the seam is straight: {told:?}");
    });
}
