//! Joining parts to one mesh: corners that lie on the sides of other parts become corners of those too.

use super::cast::{Boundary, Cast};
use super::merge::{Merged, merge};
use super::{Part, Shadows};
use crate::bsp::{LineId, PointId};
use crate::bvh::{Hierarchy, vertex};
use crate::contour::directions::DirectionId;
use crate::contour::polygon::HalfSphere;
use crate::contour::regions::circles::GreatCircles;
use crate::contour::regions::mosaic::Mosaic;
use crate::contour::regions::places::{FaceSide, Places};
use crate::exact::Sign;
use crate::scene::{PieceId, PlaneId, Side};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// A straight line that sides of parts lie on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Track {
    /// An edge of the scene, by the line that stands for all that are the same: all parts beside it have the same corners there.
    Edge(LineId),
    /// Where a piece was cut along a great circle.
    Cut(PieceId, u32),
}

/// Where a vertex is.
#[derive(Clone, Copy, Debug)]
enum Spot {
    Scene(PointId),
    /// Where the ray in a direction meets a plane.
    On(PlaneId, DirectionId),
}

/// The mesh of all parts.
pub(super) fn weave(hierarchy: &Hierarchy, cast: Cast<'_>) -> Shadows {
    let Cast { light, mut mosaic, parts, edge_on } = cast;
    let circles = GreatCircles::new(&mut mosaic, &[]);
    // With each the sign that the normal of the edge's own great circle has for that which gives the order.
    let mut tracks: FxHashMap<Track, (u32, Sign)> = FxHashMap::default();
    let mut own = Boundary::default();
    let places = Places::new(&mut mosaic, &circles, 0, |mosaic, face, arc, circle| {
        let piece = parts[face as usize].0;
        own.turn_to(hierarchy, piece);
        let line = mosaic.directions.line(arc.along.circle());
        let track = match line.map(|line| hierarchy.skeleton.representative(line).0) {
            Some(line) if own.sides.iter().any(|side| side.line == line) => Track::Edge(line),
            _ => Track::Cut(piece, circle),
        };
        let next = tracks.len() as u32;
        let (_, way) = circles.of(HalfSphere::new(arc.along.circle(), Sign::Positive));
        tracks.entry(track).or_insert((next, way)).0
    });
    let parts = merge(&mut mosaic, &circles, &places, &parts);
    let mut weaver = Weaver::new(hierarchy, mosaic, places, &parts);
    let mut all: Vec<(PieceId, bool, Vec<u32>)> = Vec::with_capacity(parts.len() + edge_on.len());
    for Merged { piece, is_lit, sides } in parts {
        let mut corners = weaver.around_part(&sides);
        // Parts run clockwise as the light sees them.
        if hierarchy.skeleton.shown_side(hierarchy.scene.piece(piece), light) == Some(Side::Front) {
            corners.reverse();
        }
        all.push((piece, is_lit, corners));
    }
    for piece in edge_on {
        own.turn_to(hierarchy, piece);
        all.push((piece, false, weaver.around_edge_on(&own, |line| tracks.get(&Track::Edge(line)).copied())));
    }
    all.sort_by_key(|&(piece, ..)| piece);
    let mut shadows =
        Shadows { scene: hierarchy.scene.clone(), light, vertices: Vec::new(), parts: Vec::new(), corners: Vec::new() };
    // Vertices are numbered as parts come to them.
    let mut numbers: FxHashMap<u32, u32> = FxHashMap::default();
    for (piece, is_lit, corners) in all {
        shadows.parts.push(Part { piece, is_lit, start: shadows.corners.len() as u32 });
        for corner in corners {
            let number = *numbers.entry(corner).or_insert_with(|| {
                shadows.vertices.push(weaver.position(corner));
                shadows.vertices.len() as u32 - 1
            });
            shadows.corners.push(number);
        }
    }
    shadows
}

/// The places of all tracks, and what is known of the vertices there.
struct Weaver<'a> {
    hierarchy: &'a Hierarchy,
    mosaic: Mosaic<'a>,
    places: Places,
    /// For every vertex of the places the one that stands for it: a corner of the scene is only one.
    same: Vec<u32>,
    /// Those of vertices that are corners after merging, and of more than the places have if only pieces that are seen edge on have some corner.
    spots: Vec<Option<Spot>>,
    of_point: FxHashMap<PointId, u32>,
}

impl<'a> Weaver<'a> {
    fn new(hierarchy: &'a Hierarchy, mosaic: Mosaic<'a>, places: Places, parts: &[Merged]) -> Self {
        let count = places.vertices.len();
        let mut weaver = Self {
            hierarchy,
            mosaic,
            places,
            same: (0..count as u32).collect(),
            spots: vec![None; count],
            of_point: FxHashMap::default(),
        };
        let mut own = Boundary::default();
        for Merged { piece, sides, .. } in parts {
            own.turn_to(hierarchy, *piece);
            let plane = hierarchy.scene.piece(*piece).plane_id();
            for &FaceSide { ends, .. } in sides {
                let place = weaver.places.all[ends[0] as usize];
                let here = place.vertex;
                // A direction to a corner of the scene may also be that of a shadow's corner, somewhere behind it.
                let point = weaver.mosaic.directions.point(place.direction);
                match point.filter(|point| own.sides.iter().any(|side| side.point == *point)) {
                    Some(point) => {
                        weaver.spots[here as usize] = Some(Spot::Scene(point));
                        weaver.same[here as usize] = *weaver.of_point.entry(point).or_insert(here);
                    }
                    None => {
                        weaver.spots[here as usize].get_or_insert(Spot::On(plane, place.direction));
                    }
                }
            }
        }
        weaver
    }

    fn vertex(&self, place: u32) -> u32 {
        self.same[self.places.all[place as usize].vertex as usize]
    }

    /// The vertices around a part, as its sides run.
    fn around_part(&self, sides: &[FaceSide]) -> Vec<u32> {
        let mut corners = Vec::new();
        for &FaceSide { forward, ends, .. } in sides {
            self.along(ends, forward, &mut corners);
        }
        corners
    }

    /// The vertices from one place of a track on to before another one.
    fn along(&self, [mut place, end]: [u32; 2], forward: bool, corners: &mut Vec<u32>) {
        while place != end {
            let vertex = self.vertex(place);
            if self.spots[vertex as usize].is_some() {
                corners.push(vertex);
            }
            place = if forward { self.places.next(place) } else { self.places.previous(place) };
        }
    }

    /// The vertices around a piece that is seen edge on, as its boundary runs. Its edges may be those of others.
    fn around_edge_on(&mut self, own: &Boundary, track: impl Fn(LineId) -> Option<(u32, Sign)>) -> Vec<u32> {
        let mut corners = Vec::new();
        for (k, side) in own.sides.iter().enumerate() {
            let ends = [side.point, own.sides[(k + 1) % own.sides.len()].point].map(|point| self.corner(point));
            let places = track(side.line).and_then(|(track, way)| {
                let on = self.places.on(track);
                let [from, to] = ends.map(|corner| on.clone().find(|&place| self.vertex(place) == corner));
                Some(([from?, to?], way))
            });
            match places {
                // Counter-clockwise about the normal of its great circle a line runs forward.
                Some((places, way)) => self.along(places, side.forward == way.is_positive(), &mut corners),
                None => corners.push(ends[0]),
            }
        }
        corners
    }

    /// The vertex that a corner of the scene is.
    fn corner(&mut self, point: PointId) -> u32 {
        *self.of_point.entry(point).or_insert_with(|| {
            self.spots.push(Some(Spot::Scene(point)));
            self.spots.len() as u32 - 1
        })
    }

    fn position(&mut self, corner: u32) -> DVec3 {
        let Self { hierarchy, mosaic, spots, .. } = self;
        let Mosaic { directions, knife, .. } = mosaic;
        match spots[corner as usize] {
            Some(Spot::Scene(point)) => hierarchy.scene.vertex(vertex(point)),
            Some(Spot::On(plane, direction)) => {
                directions.point_on_plane(&hierarchy.skeleton, direction, plane, &mut knife.cache)
            }
            None => unreachable!("it is a corner of some part"),
        }
    }
}
