//! What is seen of one element from a point, with all that may be between it known: shadows are cut off in its plane.
//!
//! A blocker hides what is on the other side of its plane, within the planes through the point and its sides: a convex polygon in the plane of the
//! element. This is done in floating point, as clipping of a few polygons in the plane: views are exact and tell everything at once, but most
//! of a row's entries need few points, and a few need many. All is in coordinates of the element's frame, with the height over it as the third; places in the
//! plane are relative to the foot of the point.

use super::bodies::FacetSide;
use super::element::{Element, Elements};
use super::facets::Facets;
use super::lies::Lies;
use super::rings::Rings;
use super::screens::{HalfPlane, Screens};
use super::shape::{Frame, clip};
use crate::integral::Receiver;
use glam::{DVec2, DVec3};

/// An element, seen from another one.
pub(super) struct Target<'a> {
    frame: &'a Frame,
    /// What it is seen from, in its frame.
    receiver: Receiver,
}

/// What is between, and memory that is used again.
#[derive(Default)]
pub(super) struct HiddenSpace {
    screens: Screens,
    /// What of the element is above the horizon.
    whole: Vec<DVec2>,
    parts: Rings,
    next: Rings,
    lines: Vec<(HalfPlane, FacetSide)>,
    cutting: Cutting,
    ring: Vec<DVec3>,
    /// The blockers, those that have cut something off lately first.
    order: Vec<Tried>,
    /// The half planes that parts were cut along.
    cuts: Vec<(HalfPlane, FacetSide)>,
    /// The sides whose shadows bound what is seen from any of the points, ascending, while they are noted.
    pub(super) bounds: Option<Vec<FacetSide>>,
}

/// Where the shadow of a side ends on an element, in the frame of that.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    pub(super) side: FacetSide,
    pub(super) segment: [DVec2; 2],
}

/// What is left of a part while it is cut, and what is left after one more line.
#[derive(Default)]
struct Cutting {
    left: Vec<DVec2>,
    inside: Vec<DVec2>,
}

/// A blocker, and which of its lines has last had all of the element outside: that is tried first.
#[derive(Clone, Copy)]
struct Tried {
    screen: u32,
    line: u32,
}

impl HiddenSpace {
    /// Those of some bounds whose sides have not been noted.
    pub(super) fn not_noted(&self, mut bounds: Vec<Bound>) -> Vec<Bound> {
        bounds.retain(|bound| self.bounds.as_ref().is_none_or(|noted| noted.binary_search(&bound.side).is_err()));
        bounds
    }
}

impl<'a> Target<'a> {
    /// With the facets that may be between. Forgets what was seen of another element.
    pub(super) fn new(
        facets: &Facets,
        elements: &'a Elements,
        [from, to]: [&Element; 2],
        between: &[u32],
        space: &mut HiddenSpace,
    ) -> Self {
        space.screens.set(facets, elements, from, to, between);
        space.order.clear();
        space.order.extend((0..space.screens.all.len() as u32).map(|screen| Tried { screen, line: 0 }));
        let [own, frame] = [from, to].map(|element| &elements.frames[element.facet as usize]);
        let normal = frame.turned(own.normal);
        // What is behind the plane of what it is seen from is not seen.
        if facets.lies(to.facet, from.facet) == Lies::Across {
            let above = HalfPlane::above(normal, own.height(frame.origin));
            clip(&to.flat, |p| above.height(p), &mut space.whole);
        } else {
            space.whole.clone_from(&to.flat);
        }
        Self { frame, receiver: Receiver::new(normal) }
    }

    /// The form factor of what is seen of the element's front from a point.
    pub(super) fn factor(&self, point: DVec3, space: &mut HiddenSpace) -> f64 {
        let at = self.frame.local(point);
        if at.z <= 0.0 || !cut_off_shadows(at, space) {
            return 0.0;
        }
        let HiddenSpace { parts, ring, .. } = space;
        parts.all().fold(0.0, |sum, part| sum + self.factor_of(part, at.z, ring))
    }

    /// The same if nothing were between.
    pub(super) fn whole_factor(&self, point: DVec3, space: &mut HiddenSpace) -> f64 {
        let at = self.frame.local(point);
        if at.z <= 0.0 {
            return 0.0;
        }
        let HiddenSpace { whole, parts, ring, .. } = space;
        parts.set(whole.iter().map(|&p| p - at.truncate()));
        parts.all().fold(0.0, |sum, part| sum + self.factor_of(part, at.z, ring))
    }

    /// To a part, from so high over it.
    fn factor_of(&self, part: &[DVec2], height: f64, ring: &mut Vec<DVec3>) -> f64 {
        // Clockwise as seen from the point.
        self.receiver.factor_of(part.iter().rev().map(|p| p.extend(-height)), ring)
    }

    /// What bounds what is seen of the element from a point, if bounds are noted; some may come twice.
    pub(super) fn bounds(&self, point: DVec3, space: &mut HiddenSpace) -> Vec<Bound> {
        let at = self.frame.local(point);
        if at.z <= 0.0 || !cut_off_shadows(at, space) {
            return Vec::new();
        }
        let HiddenSpace { parts, cuts, .. } = space;
        let of_line = |&(line, side): &(HalfPlane, FacetSide)| {
            let segments = parts.all().filter_map(move |part| line.bounds(part));
            segments.map(move |segment| Bound { side, segment: segment.map(|p| p + at.truncate()) })
        };
        cuts.iter().flat_map(of_line).collect()
    }
}

/// Leaves what of the element is in no shadow from a point over it, as convex parts; false if that is nothing.
fn cut_off_shadows(at: DVec3, space: &mut HiddenSpace) -> bool {
    let HiddenSpace { screens, whole, parts, next, lines, cutting, order, cuts, bounds, .. } = space;
    parts.set(whole.iter().map(|&p| p - at.truncate()));
    cuts.clear();
    for k in 0..order.len() {
        let Tried { screen, line } = &mut order[k];
        if !screens.shadow(*screen, at, line, parts.points(), lines) {
            continue;
        }
        // Of one part it is known already that no line has all of it outside.
        let is_one = parts.count() == 1;
        next.clear();
        for part in parts.all() {
            if !is_one && lines.iter().any(|(line, _)| line.has_outside(part)) {
                next.push(part);
                continue;
            }
            cut_off(part, lines, next, cutting, bounds.is_some().then_some(&mut *cuts));
        }
        std::mem::swap(parts, next);
        order[..=k].rotate_right(1);
        if parts.count() == 0 {
            return false;
        }
    }
    if let Some(bounds) = bounds {
        for &(line, side) in &*cuts {
            if let Err(place) = bounds.binary_search(&side)
                && parts.all().any(|part| line.bounds(part).is_some())
            {
                bounds.insert(place, side);
            }
        }
    }
    true
}

/// Puts what of a convex part is outside of some half plane into `next`, as convex parts; `cuts` gets those along which more is cut off than rounding may leave.
fn cut_off(
    part: &[DVec2],
    lines: &[(HalfPlane, FacetSide)],
    next: &mut Rings,
    cutting: &mut Cutting,
    mut cuts: Option<&mut Vec<(HalfPlane, FacetSide)>>,
) {
    let Cutting { left, inside } = cutting;
    left.clear();
    left.extend_from_slice(part);
    for &(line, side) in lines {
        if left.iter().all(|&p| line.height(p) >= 0.0) {
            continue;
        }
        inside.clear();
        let is_kept = next.push_by(|outside| halve(left, &line, outside, inside));
        if let Some(cuts) = cuts.as_mut().filter(|_| is_kept && line.reaches_beyond(left)) {
            cuts.push((line, side));
        }
        std::mem::swap(left, inside);
        if left.len() < 3 {
            break;
        }
    }
}

/// Adds the parts of a convex ring where a half plane is not, and where it is.
fn halve(ring: &[DVec2], line: &HalfPlane, outside: &mut Vec<DVec2>, inside: &mut Vec<DVec2>) {
    let Some(&last) = ring.last() else { return };
    let (mut a, mut from) = (last, line.height(last));
    for &b in ring {
        let to = line.height(b);
        if from > 0.0 && to < 0.0 || from < 0.0 && to > 0.0 {
            let crossing = a + (b - a) * (from / (from - to));
            outside.push(crossing);
            inside.push(crossing);
        }
        if to <= 0.0 {
            outside.push(b);
        }
        if to >= 0.0 {
            inside.push(b);
        }
        (a, from) = (b, to);
    }
}

#[cfg(test)]
mod tests {
    use super::super::PatchPlan;
    use super::*;
    use crate::scene::{Material, Scene};

    /// Not a power of two, so that what touches does so up to rounding only.
    const UNIT: f64 = 0.1;

    /// In these units, a floor of 1 x 1, a box of 1 x 1 x 1 that stands beside its corner, and a ceiling of 9 x 9, 3 above.
    fn scene() -> Scene {
        let at = |x: f64, y: f64, z: f64| [UNIT * x, UNIT * y, UNIT * z];
        let faces = [
            [at(0., 0., 0.), at(1., 0., 0.), at(1., 1., 0.), at(0., 1., 0.)],
            [at(-4., -4., 3.), at(-4., 5., 3.), at(5., 5., 3.), at(5., -4., 3.)],
            [at(1., 1., 1.), at(2., 1., 1.), at(2., 2., 1.), at(1., 2., 1.)],
            [at(1., 1., 0.), at(2., 1., 0.), at(2., 1., 1.), at(1., 1., 1.)],
            [at(2., 1., 0.), at(2., 2., 0.), at(2., 2., 1.), at(2., 1., 1.)],
            [at(2., 2., 0.), at(1., 2., 0.), at(1., 2., 1.), at(2., 2., 1.)],
            [at(1., 2., 0.), at(1., 1., 0.), at(1., 1., 1.), at(1., 2., 1.)],
        ];
        let rings: Vec<Vec<usize>> = (0..faces.len()).map(|face| (4 * face..4 * face + 4).collect()).collect();
        Scene::builder().mesh(faces.as_flattened(), &rings, Material::new("m")).build().unwrap()
    }

    /// True if the segment between two points meets the inside of the box (Kay and Kajiya's slabs).
    fn meets_box(p: DVec3, q: DVec3) -> bool {
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for (axis, [low, high]) in [[1.0, 2.0], [1.0, 2.0], [0.0, 1.0]].into_iter().enumerate() {
            let step = q[axis] - p[axis];
            let ends = [low, high].map(|bound| (UNIT * bound - p[axis]) / step);
            (first, last) = (first.max(ends[0].min(ends[1])), last.min(ends[0].max(ends[1])));
        }
        first < last
    }

    #[test]
    fn what_is_hidden_has_bounds_and_what_only_touches_has_none() {
        let scene = scene();
        let facets = Facets::of(&scene).unwrap();
        let elements = Elements::of(&scene, &facets, PatchPlan::Polygons).unwrap();
        let [floor, ceiling] = [0, 1].map(|number| &elements.all[number]);
        let mut space = HiddenSpace::default();
        let mut between: Vec<u32> = elements.all[2..].iter().map(|element| element.facet).collect();
        between.sort_unstable();
        let target = Target::new(&facets, &elements, [ceiling, floor], &between, &mut space);
        let (mut touches, mut hides) = (0, 0);
        // Corners of the ceiling, and places over the lines along the sides of floor and box.
        for k in 0..19 * 19 {
            let [x, y] = [k % 19, k / 19].map(|step| 0.5 * f64::from(step) - 4.0);
            let eye = UNIT * DVec3::new(x, y, 3.0);
            // The middles of 32 x 32 cells; the corners of shadows are at multiples of 1/4.
            let cell = |k: u32| UNIT * (f64::from(k) + 0.4375) / 32.0;
            let points = (0..32 * 32).map(|k| DVec3::new(cell(k % 32), cell(k / 32), 0.0));
            let hidden = points.filter(|&p| meets_box(p, eye)).count();
            space.bounds = Some(Vec::new());
            let bounds = target.bounds(facets.placement.local(eye), &mut space);
            let noted = space.bounds.take().unwrap();
            assert!(bounds.iter().all(|bound| noted.contains(&bound.side)), "{eye}: {bounds:?} {noted:?}");
            assert_eq!(noted.is_empty(), bounds.is_empty(), "{eye}: {bounds:?} {noted:?}");
            // What is hidden as a whole has no bounds either.
            if (1..32 * 32).contains(&hidden) {
                hides += 1;
                assert!(!bounds.is_empty(), "{eye}: {hidden} points are hidden");
            } else if x.min(y) >= 0.0 && x.max(y) <= 1.0 {
                // Straight above the floor: the shadow goes away from it.
                touches += 1;
                assert!(bounds.is_empty(), "{eye}: {bounds:?}");
            }
        }
        assert!(touches == 9 && hides > 30, "{touches} {hides}");
    }
}
