//! Pictures of visible regions: polygons with holes in the plane.
//!
//! What a projection cannot show in one piece (the seam of a panorama, what is beyond a window) is cut off the cells, at
//! exact great circles, before they are merged. Every stretch between two regions is flattened once, so that both have the
//! same points on it, bit by bit. Curves are broken where they cross the lines of a grid that all share: between the
//! borders of a square, curves that do not cross have chords that do not cross.

use super::corners::Corners;
use super::crossings::{Piece, Pieces};
use super::{Projection, Projector, STEREOGRAPHIC_REACH};
use crate::contour::ContourImage;
use crate::contour::regions::mosaic::{Face, Mosaic, Part};
use crate::contour::regions::outlines::{Chain, Outlines, Run, Seam, Spot};
use crate::scene::{PolygonId, Side};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Arcs are cut into pieces of at most so many radians: the picture of a longer one may bend both ways and pass through
/// the middle of its chord.
const LONG: f64 = 0.15;
/// Halvings of such a piece at most.
const DEPTH: u32 = 24;
/// A line `x = at` (axis 0) or `y = at` of the picture.
struct Line {
    axis: usize,
    at: f64,
}

/// Longitudes further from 0 than this are near a panorama's seam.
const BESIDE: f64 = 0.75 * PI;
/// So many times the points that there are may be added to keep curves apart.
const ADDED: usize = 8;
/// No picture is finer, but where that keeps curves apart.
const FINEST: f64 = 1e-9;

/// A connected part of the picture of what is seen of one side of a polygon, or of the background: a polygon with
/// holes, y up.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatRegion {
    /// The polygon seen in it; `None` for background.
    pub polygon: Option<PolygonId>,
    /// The side of it.
    pub side: Option<Side>,
    /// The outer ring, counter-clockwise; the first point is not repeated.
    pub exterior: Vec<DVec2>,
    /// The rings of the holes, clockwise.
    pub holes: Vec<Vec<DVec2>>,
    /// True if its rings may touch, cross or be on the wrong side of each other or of those of other regions: what is left
    /// of that is as near as rounding, or was given up for its number.
    pub is_tangled: bool,
}

/// Twice the area of a ring, positive if it is counter-clockwise.
fn double_area(ring: &[DVec2]) -> f64 {
    let Some(&origin) = ring.first() else { return 0.0 };
    ring.windows(2).map(|pair| (pair[0] - origin).perp_dot(pair[1] - origin)).sum()
}

impl Projector {
    /// A fine tolerance for [`Projector::regions`]: a full circle of radius 1 gets some 1,300 points.
    pub const TOLERANCE: f64 = 1e-5;

    /// The visible regions of the image in the picture, cut to what the projection shows: by polygon and side,
    /// background last, then by their lowest cells. The projector must be for the domain of the image, as that of [`Projector::of_image`]
    /// is.
    ///
    /// Curves are flattened to within about `tolerance`, in the picture's units (less than 1e-9, or NaN, counts as 1e-9). Regions
    /// that share a part of their boundary share its points exactly. Where straight pieces would cross, or a corner of a region lies between such a
    /// piece and its curve, those pieces are halved until that is over, with at most nine times as many points. So regions are valid polygons, with
    /// their holes inside. What is left, as it is nearer than the rounding of the points or as there are too many, is told
    /// by [`FlatRegion::is_tangled`].
    ///
    /// Regions and holes that rounding leaves fewer than three different points are left out.
    ///
    /// A panorama is cut at 180 degrees. Of the whole sphere a stereographic picture shows what
    /// is less than 135 degrees to the right, left, top or bottom; here the pyramid beyond is left out, not a
    /// square of the picture.
    pub fn regions(&self, image: &ContourImage, tolerance: f64) -> Vec<FlatRegion> {
        let mut mosaic = Mosaic::new(image);
        let seam = self.cut_to_picture(&mut mosaic);
        let mut outlines = Outlines::new(mosaic, seam);
        let components = std::mem::take(&mut outlines.components);
        let flattener = Flattener { projector: self, outlines: &outlines };
        let inner = flattener.all_inner(tolerance.max(FINEST));
        let regions = components.iter().filter_map(|component| {
            let rings = component.loops.iter().map(|runs| flattener.ring(runs, &inner.points));
            let mut rings: Vec<_> =
                rings.filter(|ring| ring.len() > 2).map(|ring| (double_area(&ring), ring)).collect();
            // The only ring that runs around its inside the other way.
            let outer = (0..rings.len()).max_by(|&a, &b| rings[a].0.total_cmp(&rings[b].0).then(b.cmp(&a)))?;
            let (area, mut exterior) = rings.remove(outer);
            if area < 0.0 {
                exterior.reverse();
            }
            let holes = rings.into_iter().map(|(area, mut hole)| {
                if area > 0.0 {
                    hole.reverse();
                }
                hole
            });
            let label = component.label;
            let is_tangled = component.loops.iter().flatten().any(|run| inner.is_tangled[run.chain as usize]);
            Some(FlatRegion { polygon: label.polygon, side: label.side, exterior, holes: holes.collect(), is_tangled })
        });
        regions.collect()
    }

    /// A vector of the frame's axes in those of the world.
    fn in_world(&self, v: DVec3) -> DVec3 {
        self.frame.right() * v.x + self.frame.up() * v.y + self.frame.towards() * v.z
    }

    /// Cuts cells where the picture ends or has a seam, and takes what is not shown out of the domain.
    fn cut_to_picture(&self, mosaic: &mut Mosaic<'_>) -> Option<Seam> {
        let is_shown = |face: &Face| face.label.is_some();
        match self.projection {
            Projection::Nusselt => {}
            Projection::Gnomonic => {
                for &clip in &self.clips {
                    let circle = mosaic.push_circle(self.in_world(clip));
                    mosaic.cut(circle, is_shown, |face, side| {
                        face.label = face.label.filter(|_| side.is_positive());
                    });
                }
            }
            // A hemisphere about the axis fits as it is.
            Projection::Stereographic if self.window.high.x <= 1.0 => {}
            Projection::Stereographic => {
                // What is in the pyramid so far is marked as if it were left of a seam.
                mosaic.faces.iter_mut().for_each(|face| face.part = Part::Left);
                let slope = (PI - STEREOGRAPHIC_REACH).tan();
                for side in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y] {
                    let circle = mosaic.push_circle(self.in_world(side + DVec3::Z * slope));
                    mosaic.cut(
                        circle,
                        |face| face.part == Part::Left,
                        |face, side| {
                            face.part = if side.is_positive() { Part::Front } else { Part::Left };
                        },
                    );
                }
                for face in &mut mosaic.faces {
                    face.label = face.label.filter(|_| face.part == Part::Front);
                    face.part = Part::Front;
                }
            }
            Projection::Equirectangular => {
                let [along, across] = [DVec3::X, DVec3::Z].map(|n| mosaic.push_circle(self.in_world(n)));
                let behind = |face: &Face| face.part != Part::Front;
                mosaic.cut(
                    across,
                    |_| true,
                    |face, side| {
                        face.part = if side.is_positive() { Part::Front } else { Part::Right };
                    },
                );
                mosaic.cut(along, behind, |face, side| {
                    face.part = if side.is_positive() { Part::Right } else { Part::Left };
                });
                return Some(Seam { along, across });
            }
        }
        None
    }
}

/// Lays the boundaries of regions in the plane.
struct Flattener<'a> {
    projector: &'a Projector,
    outlines: &'a Outlines<'a>,
}

/// A stretch of a great circle by the angle from its start.
struct Curve<'a> {
    flattener: &'a Flattener<'a>,
    tolerance: f64,
    axes: [DVec3; 2],
    length: f64,
    /// Where it starts and where it ends, as to the seam.
    parts: [Part; 2],
}

/// A chain in the picture: its points between its ends, with their angles.
struct Path<'a> {
    /// `None` if it is straight.
    curve: Option<Curve<'a>>,
    points: Vec<(f64, DVec2)>,
}

/// The points of all chains without their ends, forward.
struct Inner {
    points: Vec<Vec<DVec2>>,
    /// Whether pieces of a chain cross others still, or have a corner between them and the curve.
    is_tangled: Vec<bool>,
}

impl Path<'_> {
    /// Adds a point in the middle of a piece of a curve, if it bends by more than rounding; not in its place in the list.
    fn halve(&mut self, piece: Piece) -> Option<(f64, DVec2)> {
        let curve = self.curve.as_ref()?;
        let Piece { span: [from, to], ends: [p, q], .. } = piece;
        let middle = f64::midpoint(from, to);
        let place = curve.place(middle);
        let bends = place.distance(nearest_on_segment(place, p, q)) > f64::EPSILON;
        (bends && middle > from && middle < to).then(|| {
            self.points.push((middle, place));
            (middle, place)
        })
    }
}

impl Curve<'_> {
    fn place(&self, angle: f64) -> DVec2 {
        let (sine, cosine) = angle.sin_cos();
        let place = self.flattener.projector.point(self.axes[0] * cosine + self.axes[1] * sine);
        // It comes close to the seam only at its ends.
        let [near, far] = if angle < self.length / 2.0 { [0, 1] } else { [1, 0] }.map(|k: usize| self.parts[k]);
        self.flattener.beside_seam(place, if near == Part::Front { far } else { near })
    }

    /// Where it crosses a line of the picture between two angles: a line is a circle on the sphere, `n . d = c`.
    fn crossing(&self, line: &Line, [from, to]: [f64; 2]) -> Option<f64> {
        let projector = self.flattener.projector;
        let axis = if line.axis == 0 { DVec3::X } else { DVec3::Y };
        let (n, c) = match projector.projection {
            Projection::Nusselt | Projection::Gnomonic => (axis, line.at),
            Projection::Stereographic => (axis - DVec3::Z * line.at, line.at),
            Projection::Equirectangular if line.axis == 0 => {
                let (sine, cosine) = line.at.sin_cos();
                (DVec3::new(cosine, 0.0, -sine), 0.0)
            }
            Projection::Equirectangular => (DVec3::Y, line.at.sin()),
        };
        let n = projector.in_world(n);
        let [a, b] = self.axes.map(|axis| n.dot(axis));
        let (middle, half) = (b.atan2(a), (c / a.hypot(b)).acos());
        let candidates = [middle - half, middle + half].map(|angle| angle + ((from - angle) / TAU).ceil() * TAU);
        candidates.into_iter().find(|&angle| angle > from && angle < to)
    }

    /// The points between two angles at which the picture crosses lines of a grid, and those that it needs beyond.
    fn bend_across_grid(&self, [from, to]: [f64; 2], [p, q]: [DVec2; 2], path: &mut Vec<(f64, DVec2)>) {
        let spacing = 2.0 * self.tolerance.sqrt();
        let mut cuts: Vec<(f64, DVec2)> = Vec::new();
        for axis in 0..2 {
            let [low, high] = [p[axis].min(q[axis]), p[axis].max(q[axis])].map(|x| x / spacing);
            let mut k = low.floor() + 1.0;
            while k < high {
                let line = Line { axis, at: k * spacing };
                if let Some(angle) = self.crossing(&line, [from, to]) {
                    let mut place = self.place(angle);
                    place[axis] = line.at;
                    cuts.push((angle, place));
                }
                k += 1.0;
            }
        }
        cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut from, mut p) = (from, p);
        for (angle, place) in cuts {
            self.bend([from, angle], [p, place], DEPTH, path);
            path.push((angle, place));
            (from, p) = (angle, place);
        }
        self.bend([from, to], [p, q], DEPTH, path);
    }

    /// The points between two angles that the picture needs.
    fn bend(&self, [from, to]: [f64; 2], [p, q]: [DVec2; 2], depth: u32, path: &mut Vec<(f64, DVec2)>) {
        let middle = f64::midpoint(from, to);
        let place = self.place(middle);
        let off = place.distance(nearest_on_segment(place, p, q));
        // Not a number is no reason to go on.
        if depth > 0 && off > self.tolerance {
            self.bend([from, middle], [p, place], depth - 1, path);
            path.push((middle, place));
            self.bend([middle, to], [place, q], depth - 1, path);
        }
    }
}

fn nearest_on_segment(p: DVec2, a: DVec2, b: DVec2) -> DVec2 {
    let ab = b - a;
    let along = (p - a).dot(ab) / ab.length_squared();
    if along.is_finite() { a + ab * along.clamp(0.0, 1.0) } else { a }
}

impl<'a> Flattener<'a> {
    fn is_panorama(&self) -> bool {
        self.projector.projection == Projection::Equirectangular
    }

    /// Rounding may put what is beside the seam of a panorama on its other side. What is far from it is left alone: a
    /// stretch may begin beside the seam and end elsewhere.
    fn beside_seam(&self, p: DVec2, part: Part) -> DVec2 {
        let x = match part {
            _ if !self.is_panorama() => p.x,
            Part::Right if p.x < -BESIDE => (p.x + TAU).min(PI),
            Part::Left if p.x > BESIDE => (p.x - TAU).max(-PI),
            _ => p.x,
        };
        DVec2::new(x, p.y)
    }

    fn part_of(&self, face: u32) -> Part {
        self.outlines.mosaic.faces[face as usize].part
    }

    /// True if a chain lies on the seam.
    fn is_on_seam(&self, chain: u32) -> bool {
        let [[a, b], _] = self.outlines.faces_at_ends(chain).map(|pair| pair.map(|face| self.part_of(face)));
        a != b && a != Part::Front && b != Part::Front
    }

    fn curve(&'a self, chain: u32) -> Curve<'a> {
        let start = self.outlines.unit(self.outlines.start(Run { chain, forward: true }));
        let normal = self.outlines.mosaic.directions.normal(self.outlines.circles.name(self.outlines.circle(chain)));
        let parts = self.outlines.faces_at_ends(chain).map(|[a, b]| self.part_of(a).max(self.part_of(b)));
        let Chain { length, .. } = self.outlines.chains[chain as usize];
        Curve {
            flattener: self,
            tolerance: FINEST,
            axes: [start, normal.v.cross(start).normalize_or_zero()],
            length,
            parts,
        }
    }

    /// The points of all chains. Where straight pieces of curves cross, or have a corner between them and the curve, they are
    /// halved until they do not: curves that do not cross may be nearer to each other than the tolerance.
    fn all_inner(&self, tolerance: f64) -> Inner {
        let mut paths: Vec<Path<'_>> = Vec::new();
        let mut pieces: Vec<Piece> = Vec::new();
        for chain in 0..self.outlines.chains.len() as u32 {
            let run = Run { chain, forward: true };
            let path = self.path(chain, tolerance);
            let mut start = (0.0, self.start(run));
            let length = path.curve.as_ref().map_or(1.0, |curve| curve.length);
            for &(angle, place) in path.points.iter().chain([&(length, self.end(run))]) {
                pieces.push(Piece { line: chain, span: [start.0, angle], ends: [start.1, place] });
                start = (angle, place);
            }
            paths.push(path);
        }
        let square = 2.0 * tolerance.sqrt();
        // Chords are bent by what their middles are off.
        let corners = Corners::new(self.corners(), square, 2.0 * tolerance);
        let mut pieces = Pieces::new(pieces, square);
        // What stays nearer than rounding along all of its length would never end.
        let mut room = ADDED * (pieces.len() + paths.len());
        let mut new: Vec<u32> = (0..pieces.len() as u32).collect();
        let mut is_tangled = vec![false; paths.len()];
        loop {
            let has_corner = |number: &u32| {
                let Piece { line, ends, .. } = pieces.get(*number);
                let curve = paths[line as usize].curve.as_ref();
                curve.is_some_and(|curve| corners.are_between(ends, curve.axes[0].cross(curve.axes[1])))
            };
            let mut faults = pieces.meeting(&new);
            faults.extend(new.iter().copied().filter(has_corner));
            faults.sort_unstable();
            faults.dedup();
            // The halves, and what cannot be halved and may be at fault again. The others have been found to be in order.
            new = faults.clone();
            for &number in faults.iter().take(room) {
                let piece = pieces.get(number);
                if let Some((angle, place)) = paths[piece.line as usize].halve(piece) {
                    new.push(pieces.halve(number, angle, place));
                }
            }
            if new.len() == faults.len() {
                for number in faults {
                    is_tangled[pieces.get(number).line as usize] = true;
                }
                break;
            }
            room -= new.len() - faults.len();
        }
        let points = paths.into_iter().map(|mut path| {
            path.points.sort_by(|a, b| a.0.total_cmp(&b.0));
            path.points.into_iter().map(|point| point.1).collect()
        });
        let points = points.collect();
        Inner { points, is_tangled }
    }

    /// The corners of all regions in the picture, with their directions; not poles, which have many places.
    fn corners(&self) -> impl Iterator<Item = (DVec2, DVec3)> {
        let chains = 0..self.outlines.chains.len() as u32;
        let runs = chains.flat_map(|chain| [true, false].map(|forward| Run { chain, forward }));
        runs.filter_map(|run| {
            let vertex = self.outlines.start(run);
            (self.outlines.spot(vertex) != Spot::Pole).then(|| (self.start(run), self.outlines.unit(vertex)))
        })
    }

    /// A chain in the picture.
    fn path(&self, chain: u32, tolerance: f64) -> Path<'_> {
        let forward = Run { chain, forward: true };
        let ends = [self.outlines.start(forward), self.outlines.end(forward)];
        // Great circles are straight in gnomonic pictures, as are meridians in panoramas.
        let is_meridian = || ends.iter().any(|&v| self.outlines.spot(v) == Spot::Pole) || self.is_on_seam(chain);
        let mut points = Vec::new();
        if self.projector.projection == Projection::Gnomonic || self.is_panorama() && is_meridian() {
            return Path { curve: None, points };
        }
        let curve = Curve { tolerance, ..self.curve(chain) };
        let pieces = (curve.length / LONG).ceil().max(1.0);
        let mut last = self.start(forward);
        for k in 1..=pieces as u32 {
            let [from, to] = [k - 1, k].map(|k| curve.length * f64::from(k) / pieces);
            let next = if k == pieces as u32 { self.end(forward) } else { curve.place(to) };
            curve.bend_across_grid([from, to], [last, next], &mut points);
            if k < pieces as u32 {
                points.push((to, next));
            }
            last = next;
        }
        Path { curve: Some(curve), points }
    }

    /// Where a run starts: the same place for all that start or end there, but for the seam and its ends.
    fn start(&self, run: Run) -> DVec2 {
        let vertex = self.outlines.start(run);
        let direction = self.outlines.unit(vertex);
        if self.projector.projection == Projection::Gnomonic {
            return self.projector.point_within(direction);
        }
        let place = self.projector.point(direction);
        if !self.is_panorama() {
            return place;
        }
        let part = self.part_at_start(run);
        let at_end = |part| if part == Part::Left { -PI } else { PI };
        match self.outlines.spot(vertex) {
            Spot::Plain => self.beside_seam(place, part),
            Spot::Seam => DVec2::new(at_end(part), place.y),
            // A meridian arrives at its own longitude.
            Spot::Pole => {
                let curve = self.curve(run.chain);
                let longitude =
                    if self.is_on_seam(run.chain) { at_end(part) } else { curve.place(curve.length / 2.0).x };
                DVec2::new(longitude, FRAC_PI_2.copysign(place.y))
            }
        }
    }

    /// Where a run ends, seen from the same side.
    fn end(&self, run: Run) -> DVec2 {
        let vertex = self.outlines.end(run);
        let back = Run { forward: !run.forward, ..run };
        if self.is_panorama() && self.is_on_seam(run.chain) {
            let place = self.projector.point(self.outlines.unit(vertex));
            let y = if self.outlines.spot(vertex) == Spot::Pole { FRAC_PI_2.copysign(place.y) } else { place.y };
            return DVec2::new(self.start(run).x, y);
        }
        self.start(back)
    }

    /// As to the seam, the side of a run on which its start is seen.
    fn part_at_start(&self, run: Run) -> Part {
        let ends = self.outlines.faces_at_ends(run.chain);
        let [left, right] = ends[usize::from(!run.forward)].map(|face| self.part_of(face));
        let [own, other] = if run.forward { [left, right] } else { [right, left] };
        if own == Part::Front { other } else { own }
    }

    /// The ring of a loop, counter-clockwise around the inside of the region: pictures show the sphere from within.
    fn ring(&self, runs: &[Run], inner: &[Vec<DVec2>]) -> Vec<DVec2> {
        let mut ring = Vec::new();
        for &run in runs {
            ring.push(self.start(run));
            let points = inner[run.chain as usize].iter().copied();
            if run.forward {
                ring.extend(points);
            } else {
                ring.extend(points.rev());
            }
            ring.push(self.end(run));
        }
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        ring.reverse();
        ring
    }
}

#[cfg(test)]
mod tests;
