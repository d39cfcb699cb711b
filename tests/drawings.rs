//! Drawings of cells and arcs show each direction where it belongs, once, to the stated tolerance.
//!
//! The oracle goes the other way: what a point of the picture looks along is written down here anew, and whether
//! that direction lies in a cell or on an arc is asked of the corners alone.

use glam::{DVec2, DVec3};
use nusselt::contour::{Projection, Projector, ViewFrame, Window};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

fn cases(n: u32) -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok());
    ProptestConfig { cases: asked.unwrap_or(n), max_shrink_iters: 2_000, ..ProptestConfig::default() }
}

/// The direction that a point of a picture looks along.
fn direction_at(projector: &Projector, p: DVec2) -> DVec3 {
    let r2 = p.length_squared();
    let d = match projector.projection() {
        Projection::Nusselt => p.extend((1.0 - r2).max(0.0).sqrt()),
        Projection::Gnomonic => p.extend(1.0),
        Projection::Stereographic => (2.0 * p).extend(1.0 - r2),
        Projection::Equirectangular => {
            let (east, up) = (p.x.sin_cos(), p.y.sin_cos());
            DVec3::new(east.0 * up.1, up.0, east.1 * up.1)
        }
    };
    let frame = projector.frame();
    (frame.right() * d.x + frame.up() * d.y + frame.towards() * d.z).normalize()
}

/// Nusselt's disc does not fill its window.
fn shows(projector: &Projector, p: DVec2) -> bool {
    inside(projector.window(), p, 0.0) && (projector.projection() != Projection::Nusselt || p.length() < 1.0)
}

fn inside(window: Window, p: DVec2, margin: f64) -> bool {
    p.cmpge(window.low + margin).all() && p.cmple(window.high - margin).all()
}

fn distance(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let (along, length) = (b - a, a.distance_squared(b));
    if length == 0.0 { p.distance(a) } else { p.distance(a + along * ((p - a).dot(along) / length).clamp(0.0, 1.0)) }
}

fn edges(path: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> {
    path.iter().copied().zip(path.iter().copied().cycle().skip(1)).map(|(a, b)| [a, b])
}

/// How often closed paths run around a point, counter-clockwise.
fn winding(paths: &[Vec<DVec2>], p: DVec2) -> i32 {
    let crossing = |[a, b]: [DVec2; 2]| {
        let left = (b - a).perp_dot(p - a) > 0.0;
        i32::from(a.y <= p.y && b.y > p.y && left) - i32::from(b.y <= p.y && a.y > p.y && !left)
    };
    paths.iter().flat_map(|path| edges(path)).map(crossing).sum()
}

/// A view: a frame, and the normal of a hemisphere unless the whole sphere is seen.
type View = (DVec3, bool);

fn projectors((towards, whole): View) -> Vec<Projector> {
    let of = |projection| {
        let frame = match projection {
            Projection::Equirectangular => ViewFrame::panorama(towards),
            _ => ViewFrame::upright(towards),
        };
        Projector::new(projection, frame, (!whole).then_some(towards)).ok()
    };
    Projection::ALL.into_iter().filter_map(of).collect()
}

/// Turned over to the front side of the horizon.
fn seen(d: DVec3, (towards, whole): View) -> DVec3 {
    if whole { d } else { d - towards * (2.0 * d.dot(towards).min(0.0) / towards.length_squared()) }
}

/// Anything, or near the axes, where seams and poles are: some coordinates are 0, either 0, or all but 0.
fn direction() -> impl Strategy<Value = DVec3> {
    let near_zero = prop::sample::select(vec![0.0, -0.0, 1e-17, -1e-17, 1e-9, 1.0, -1.0, 2.0, -2.0]);
    let any = [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from);
    prop_oneof![any, [near_zero.clone(), near_zero.clone(), near_zero].prop_map(DVec3::from)]
        .prop_filter("too short", |d| d.length() > 0.1)
        .prop_map(DVec3::normalize)
}

/// Along an axis, whose frames are exact, or anywhere.
fn view() -> impl Strategy<Value = View> {
    let axes = vec![DVec3::Y, DVec3::NEG_Y, DVec3::X, DVec3::Z, DVec3::NEG_Z];
    (prop_oneof![prop::sample::select(axes), direction()], any::<bool>())
}

/// Triangles, and regular polygons around a direction.
fn corners() -> impl Strategy<Value = Vec<DVec3>> {
    let triangle = [direction(), direction(), direction()].prop_map(|[a, b, c]| {
        let volume = a.dot(b.cross(c));
        if volume > 0.0 { vec![a, b, c] } else { vec![a, c, b] }
    });
    let regular = (direction(), 3..7usize, 0.02..1.4f64, 0.0..PI).prop_map(|(middle, n, radius, phase)| {
        let (u, v) = middle.any_orthonormal_pair();
        let corner = |k: usize| {
            let angle = phase + 2.0 * PI * k as f64 / n as f64;
            middle * radius.cos() + (u * angle.cos() + v * angle.sin()) * radius.sin()
        };
        let (a, b, c) = (corner(0), corner(1), corner(2));
        let order: Vec<DVec3> = (0..n).map(corner).collect();
        if a.dot(b.cross(c)) > 0.0 { order } else { order.into_iter().rev().collect() }
    });
    prop_oneof![triangle, regular]
}

fn heights(cell: &[DVec3], d: DVec3) -> f64 {
    let sides = cell.iter().zip(cell.iter().cycle().skip(1)).map(|(a, b)| a.cross(*b).dot(d));
    sides.fold(f64::INFINITY, f64::min)
}

/// Convex, not too flat to tell inside from outside, and in front of the horizon.
fn is_cell(cell: &[DVec3], (towards, whole): View) -> bool {
    let convex = (0..cell.len()).all(|k| {
        let [a, b, c] = [0, 1, 2].map(|i| cell[(k + i) % cell.len()]);
        a.dot(b.cross(c)) > 1e-7
    });
    convex && (whole || cell.iter().all(|d| d.dot(towards) >= 0.0))
}

/// How far pictures of arcs may be off, in tolerances.
fn allowed(projector: &Projector) -> f64 {
    // Beside a pole a panorama's picture of an arc has corners, of which half is missed.
    if projector.projection() == Projection::Equirectangular { 2.0 } else { 1.1 }
}

fn check_cell(projector: &Projector, cell: &[DVec3], tolerance: f64) -> Result<(), TestCaseError> {
    let paths = projector.cell(cell, tolerance);
    let allowed = allowed(projector) * tolerance;
    let (name, window) = (projector.projection().name(), projector.window());
    for path in &paths {
        prop_assert!(path.len() > 2, "{name}: no area: {path:?}");
        // A path that touches a corner of the window may have it twice.
        let repeats = projector.projection() != Projection::Stereographic && edges(path).any(|[a, b]| a == b);
        prop_assert!(!repeats, "{name}: a point comes twice: {path:?}");
        prop_assert!(path.iter().all(|&p| inside(window, p, -1e-9)), "{name}: out of the window: {path:?}");
        let area: f64 = edges(path).map(|[a, b]| b.perp_dot(a) / 2.0).sum();
        // The sides of what is narrower than the tolerance may change places.
        let border: f64 = edges(path).map(|[a, b]| a.distance(b)).sum();
        prop_assert!(area > -border * tolerance, "{name}: not clockwise: {path:?}");
    }
    // All over the window, and just off what is drawn, on either side.
    let cells_of_grid = 17;
    let steps = (0..cells_of_grid * cells_of_grid).map(|k| {
        let place = DVec2::new((k % cells_of_grid) as f64 + 0.47, (k / cells_of_grid) as f64 + 0.53);
        window.low + window.size() * place / f64::from(cells_of_grid)
    });
    let beside = paths.iter().flat_map(|path| edges(path)).flat_map(|[a, b]| {
        let off = (b - a).perp().normalize() * (1.1 * allowed);
        [a.midpoint(b) + off, a.midpoint(b) - off]
    });
    for p in steps.chain(beside).filter(|&p| shows(projector, p)) {
        if paths.iter().flat_map(|path| edges(path)).all(|edge| distance(p, edge) > allowed) {
            let height = heights(cell, direction_at(projector, p));
            let expected = i32::from(height > 0.0);
            prop_assert!(
                winding(&paths, p) == -expected || height.abs() < 1e-12,
                "{name}: {p} is drawn {} times, {height}: {paths:?}",
                -winding(&paths, p)
            );
        }
    }
    Ok(())
}

/// Points of an arc at fractions of its angle.
fn along(ends: [DVec3; 2], t: f64) -> DVec3 {
    let angle = ends[0].angle_between(ends[1]);
    (ends[0] * ((1.0 - t) * angle).sin() + ends[1] * (t * angle).sin()).normalize()
}

fn drawn_length(projector: &Projector, ends: [DVec3; 2]) -> f64 {
    let lines = projector.arc(ends.map(DVec3::normalize), 1e-5);
    lines.iter().flat_map(|line| line.windows(2)).map(|pair| pair[0].distance(pair[1])).sum()
}

/// How far a point of a picture is from an arc's picture; at most that for panoramas.
fn off_arc(projector: &Projector, ends: [DVec3; 2], p: DVec2) -> f64 {
    let normal = ends[0].cross(ends[1]).normalize();
    let d = direction_at(projector, p);
    let foot = (d - normal * d.dot(normal)).normalize();
    let between = normal.cross(ends[0]).dot(foot) >= 0.0 && foot.cross(ends[1]).dot(normal) >= 0.0;
    let nearer = if d.dot(ends[0]) > d.dot(ends[1]) { ends[0] } else { ends[1] };
    let nearest = if between { foot } else { nearer };
    match projector.projection() {
        // Near a pole and at the seam pictures leap.
        Projection::Equirectangular => d.angle_between(nearest),
        // Near the horizon the nearest direction is not the nearest in the picture.
        Projection::Nusselt => {
            let points: Vec<DVec2> = (0..=1000).map(|k| projector.point(along(ends, f64::from(k) / 1000.0))).collect();
            points.windows(2).map(|pair| distance(p, [pair[0], pair[1]])).fold(f64::INFINITY, f64::min)
        }
        Projection::Gnomonic | Projection::Stereographic => projector.point(nearest).distance(p),
    }
}

fn check_arc(projector: &Projector, ends: [DVec3; 2], tolerance: f64) -> Result<(), TestCaseError> {
    let lines = projector.arc(ends, tolerance);
    let (name, window) = (projector.projection().name(), projector.window());
    for line in &lines {
        prop_assert!(line.len() > 1, "{name}: a point: {line:?}");
        prop_assert!(line.iter().all(|&p| inside(window, p, -1e-9)), "{name}: out of the window: {line:?}");
        for (pair, t) in line.windows(2).flat_map(|pair| [0.0, 0.3, 0.5, 0.8, 1.0].map(|t| (pair, t))) {
            let off = off_arc(projector, ends, pair[0].lerp(pair[1], t));
            prop_assert!(off <= 1.1 * tolerance + 1e-6, "{name}: {off} off: {line:?}");
        }
    }
    let frame = projector.frame();
    let mut crosses_nothing = true;
    for k in 0..=250 {
        let d = along(ends, f64::from(k) / 250.0);
        let p = projector.point(d);
        let is_behind = projector.projection() == Projection::Gnomonic && d.dot(projector.frame().towards()) < 1e-9;
        let same_octant = [frame.right(), frame.up(), frame.towards()].map(|a| a.dot(d) * a.dot(ends[0]) > 1e-9);
        crosses_nothing &= !is_behind && same_octant == [true; 3] && inside(window, p, 1e-7);
        let leaps = projector.projection() == Projection::Equirectangular
            && (p.x.abs() > PI - 1e-7 || p.y.abs() > FRAC_PI_2 - 1e-7);
        if p.is_finite() && inside(window, p, 1e-7) && !leaps && !is_behind {
            let to = |pair: &[DVec2]| distance(p, [pair[0], pair[1]]);
            let off = lines.iter().flat_map(|line| line.windows(2)).map(to).fold(f64::INFINITY, f64::min);
            prop_assert!(off <= allowed(projector) * tolerance + 1e-7, "{name}: {p} is {off} away from {lines:?}");
        }
    }
    prop_assert!(!crosses_nothing || lines.len() == 1, "{name}: in pieces: {lines:?}");
    Ok(())
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn a_cell_is_drawn_once_wherever_its_directions_are(view in view(), corners in corners(), fine in 1..4i32) {
        let cell: Vec<DVec3> = corners.into_iter().map(|d| seen(d, view)).collect();
        let cell = if is_cell(&cell, view) { cell } else { cell.into_iter().rev().collect() };
        prop_assume!(is_cell(&cell, view));
        for projector in projectors(view) {
            check_cell(&projector, &cell, 10f64.powi(-fine - 1))?;
        }
    }

    #[test]
    fn an_arc_is_drawn_where_its_directions_are(view in view(), ends in [direction(), direction()], fine in 1..4i32) {
        let ends = ends.map(|d| seen(d, view));
        prop_assume!((1e-6..PI - 1e-3).contains(&ends[0].angle_between(ends[1])));
        for projector in projectors(view) {
            check_arc(&projector, ends, 10f64.powi(-fine - 1))?;
        }
    }

    #[test]
    fn the_window_is_what_the_hemisphere_needs(towards in direction()) {
        // Of a pole that is barely inside, the directions tried here miss the longitudes that it brings.
        prop_assume!(towards.z == 0.0 || towards.z.abs() > 0.1);
        let projector = Projector::new(Projection::Equirectangular, ViewFrame::panorama(towards), Some(towards));
        let projector = projector.expect("a panorama");
        let Window { low, high } = projector.window();
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (u, v) = towards.any_orthonormal_pair();
        for (turn, off) in (0..720).flat_map(|k| (0..=100).map(move |j| (k, j))) {
            let (turn, off) = (f64::from(turn) * PI / 360.0, f64::from(off) * FRAC_PI_2 / 100.0);
            let p = projector.point(towards * off.cos() + (u * turn.cos() + v * turn.sin()) * off.sin());
            // Straight up and down there is no longitude, and behind there are two.
            if p.y.abs() < FRAC_PI_2 - 1e-6 && p.x.abs() < PI - 1e-6 {
                (least, most) = (least.min(p), most.max(p));
            }
        }
        prop_assert!(least.cmpge(low - 1e-6).all() && most.cmple(high + 1e-6).all(), "{least} {most} in {low} {high}");
        prop_assert!((least - low).max_element() < 0.3 && (high - most).max_element() < 0.3, "{least} {most} in {low} {high}");
    }
}

fn sphere(projection: Projection) -> Projector {
    Projector::new(projection, ViewFrame::new(DVec3::Y, DVec3::Z), None).expect("not nusselt")
}

#[test]
fn an_arc_along_a_seam_is_drawn_once() {
    // The meridian behind is the left and the right edge of a panorama.
    let behind = [DVec3::new(0.0, -1.0, -1.0), DVec3::new(0.0, -1.0, 1.0)];
    let panorama = sphere(Projection::Equirectangular);
    assert!((drawn_length(&panorama, behind) - FRAC_PI_2).abs() < 1e-9);
    assert_eq!(panorama.arc(behind.map(DVec3::normalize), 1e-3).len(), 1);
    // The horizon, the middle meridian and the equator of a stereographic picture.
    let picture = sphere(Projection::Stereographic);
    let eighth = (PI / 8.0).tan();
    let horizon = [DVec3::new(1.0, 0.0, 1.0), DVec3::new(-1.0, 0.0, 1.0)];
    assert!((drawn_length(&picture, horizon) - FRAC_PI_2).abs() < 1e-4);
    for across in [DVec3::X, DVec3::NEG_Z] {
        let ends = [DVec3::Y + across, DVec3::Y - across];
        assert!((drawn_length(&picture, ends) - 2.0 * eighth).abs() < 1e-9, "{across}");
    }
}

#[test]
fn arcs_to_the_antipode_are_drawn_as_far_as_the_window_reaches() {
    let picture = sphere(Projection::Stereographic);
    let edge = picture.window().high.x;
    for side in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z] {
        assert!((drawn_length(&picture, [side, DVec3::NEG_Y]) - (edge - 1.0)).abs() < 1e-9, "{side}");
        assert!((drawn_length(&picture, [DVec3::NEG_Y, side]) - (edge - 1.0)).abs() < 1e-9, "{side}");
    }
    let corner = DVec3::new(1.0, 0.0, -1.0);
    assert!((drawn_length(&picture, [corner, DVec3::NEG_Y]) - (edge * 2f64.sqrt() - 1.0)).abs() < 1e-9);
}

#[test]
fn windows_reach_as_far_as_documented() {
    let reach = |picture: &Projector, angle: f64| {
        let frame = picture.frame();
        picture.point(frame.towards() * angle.to_radians().cos() + frame.right() * angle.to_radians().sin()).x
    };
    for (projection, angle) in [(Projection::Gnomonic, 75.0), (Projection::Stereographic, 135.0)] {
        let picture = sphere(projection);
        assert_eq!(picture.projection(), projection);
        let Window { low, high } = picture.window();
        assert!((high - DVec2::splat(reach(&picture, angle))).length() < 1e-9, "{projection:?}");
        assert_eq!(low, -high);
    }
    let half = Projector::new(Projection::Stereographic, ViewFrame::upright(DVec3::Y), Some(DVec3::Y)).expect("any");
    assert_eq!(half.window(), Window { low: DVec2::splat(-1.0), high: DVec2::splat(1.0) });
}

#[test]
fn the_length_of_a_direction_does_not_matter() {
    for projector in projectors((DVec3::Y, false)) {
        let d = DVec3::new(0.3, 0.5, -0.2);
        let [place, near, far] = [1.0, 0.25, 8.0].map(|length| projector.point(d * length));
        assert!(place.distance(near) < 1e-12 && place.distance(far) < 1e-12, "{:?}", projector.projection());
    }
}

#[test]
fn what_has_no_length_or_no_area_is_not_drawn() {
    let [a, b] = [DVec3::new(1.0, 4.0, 1.0), DVec3::new(1.5, 4.0, 2.0)].map(DVec3::normalize);
    for projector in projectors((DVec3::Y, true)) {
        assert!(projector.arc([a, a], 1e-3).is_empty(), "{:?}", projector.projection());
        assert!(projector.cell(&[a, b], 1e-3).is_empty(), "{:?}", projector.projection());
        // Slivers may repeat a direction.
        let sliver = projector.cell(&[a, a, b], 1e-3);
        let area: f64 = sliver.iter().flat_map(|path| edges(path)).map(|[p, q]| q.perp_dot(p) / 2.0).sum();
        assert!(area.abs() < 1e-12 && sliver.iter().all(|path| path.len() > 2), "{sliver:?}");
    }
}
