//! Regions: neighbouring faces with one label, and the loops that bound them.

use super::arrangement::{Arrangement, Half};
use super::circles::GreatCircles;
use super::mosaic::{Label, Mosaic};
use super::sets::Sets;
use crate::contour::directions::CircleId;
use crate::exact::Sign;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// The longest stretch of a great circle with one region to the left and one to the right, without a point at which
/// the boundary of a region turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chain {
    /// The first of its stretches, in the order of places, and how many there are.
    first: u32,
    count: u32,
    /// About how long it is, in radians.
    pub(crate) length: f64,
}

/// A chain, run through forward (counter-clockwise about the great circle's normal) or backward.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) chain: u32,
    pub(crate) forward: bool,
}

/// What a vertex is for the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Spot {
    /// One point.
    Plain,
    /// On a panorama's seam: a point at its left end and one at its right end.
    Seam,
    /// An end of the seam: a whole edge of the panorama.
    Pole,
}

/// The seam of a panorama: the half of a great circle that is behind another one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seam {
    /// The great circle that it is half of.
    pub(crate) along: CircleId,
    /// The great circle through its ends.
    pub(crate) across: CircleId,
}

/// A connected union of faces.
#[derive(Clone, Debug)]
pub(crate) struct Component {
    pub(crate) label: Label,
    /// Ascending.
    pub(crate) faces: Vec<u32>,
    /// Simple loops with the region to their left, seen from outside of the sphere. None if it is the whole sphere.
    pub(crate) loops: Vec<Vec<Run>>,
}

/// All regions of a mosaic.
pub(crate) struct Outlines<'a> {
    pub(crate) mosaic: Mosaic<'a>,
    pub(crate) circles: GreatCircles,
    arrangement: Arrangement,
    pub(crate) chains: Vec<Chain>,
    /// By what is seen, background last, then by the lowest face.
    pub(crate) components: Vec<Component>,
    spots: Vec<Spot>,
}

impl<'a> Outlines<'a> {
    /// Merges the faces of a mosaic.
    pub(crate) fn new(mut mosaic: Mosaic<'a>, seam: Option<Seam>) -> Self {
        let circles =
            GreatCircles::new(&mut mosaic, seam.as_ref().map_or(&[], |seam| std::slice::from_ref(&seam.along)));
        let arrangement = Arrangement::new(&mut mosaic, &circles);
        let stretches = arrangement.place_count() as u32;
        let borders: Vec<bool> = (0..stretches).map(|s| arrangement.is_border(&mosaic.faces, s)).collect();
        let spots = spots(&mut mosaic, &circles, &arrangement, seam);
        let (chains, chain_of) = chains(&arrangement, &borders, &spots);
        let components = components(&mosaic, &arrangement, &borders);
        let mut outlines = Self { mosaic, circles, arrangement, chains, components, spots };
        outlines.find_loops(&chain_of);
        outlines.components.sort_by_key(|c| (c.label.polygon.is_none(), c.label, c.faces[0]));
        outlines
    }

    fn find_loops(&mut self, chain_of: &[u32]) {
        let mut component_of = vec![None; self.mosaic.faces.len()];
        for (component, k) in self.components.iter().zip(0usize..) {
            component.faces.iter().for_each(|&face| component_of[face as usize] = Some(k));
        }
        let mut done = vec![[false; 2]; self.chains.len()];
        for start in (0..self.chains.len() as u32).flat_map(|chain| [true, false].map(|forward| Run { chain, forward }))
        {
            let component = self.face_beside(start).and_then(|face| component_of[face as usize]);
            let Some(component) = component else { continue };
            let mut runs = Vec::new();
            let mut run = start;
            while !std::mem::replace(&mut done[run.chain as usize][usize::from(run.forward)], true) {
                runs.push(run);
                let next = self.arrangement.next_around_region(&self.mosaic.faces, self.last_half(run));
                run = Run { chain: chain_of[next.stretch as usize], forward: next.forward };
            }
            if !runs.is_empty() {
                let loops = self.simple_loops(&runs);
                self.components[component].loops.extend(loops);
            }
        }
    }

    /// Cuts a loop at the points that it passes more than once. It does not cross itself, so that the order does not
    /// matter.
    fn simple_loops(&self, runs: &[Run]) -> Vec<Vec<Run>> {
        let mut loops = Vec::new();
        let mut path: Vec<(Option<(u32, bool)>, Run)> = Vec::new();
        let mut place_of: FxHashMap<(u32, bool), usize> = FxHashMap::default();
        for &run in runs {
            let vertex = self.start(run);
            let key = match self.spots[vertex as usize] {
                Spot::Plain => Some((vertex, false)),
                Spot::Seam => Some((vertex, self.is_right(run))),
                Spot::Pole => None,
            };
            if let Some(&known) = key.and_then(|key| place_of.get(&key)) {
                let split = path.split_off(known);
                split.iter().filter_map(|(key, _)| *key).for_each(|key| {
                    place_of.remove(&key);
                });
                loops.push(split.into_iter().map(|(_, run)| run).collect());
            }
            if let Some(key) = key {
                place_of.insert(key, path.len());
            }
            path.push((key, run));
        }
        loops.push(path.into_iter().map(|(_, run)| run).collect());
        loops
    }

    /// True if the face to the left of the start of a run is at the right end of a panorama.
    fn is_right(&self, run: Run) -> bool {
        let face = self.arrangement.face_beside(self.first_half(run));
        face.is_some_and(|face| self.mosaic.faces[face as usize].part == super::mosaic::Part::Right)
    }

    fn first_half(&self, Run { chain, forward }: Run) -> Half {
        let Chain { first, count, .. } = self.chains[chain as usize];
        Half { stretch: if forward { first } else { self.nth(first, count - 1) }, forward }
    }

    fn last_half(&self, Run { chain, forward }: Run) -> Half {
        let Chain { first, count, .. } = self.chains[chain as usize];
        Half { stretch: if forward { self.nth(first, count - 1) } else { first }, forward }
    }

    /// The n-th stretch after another on its great circle.
    fn nth(&self, stretch: u32, n: u32) -> u32 {
        let places = self.arrangement.places_on(self.arrangement.place(stretch).track);
        places.start + (stretch - places.start + n) % places.len() as u32
    }

    /// The face to the left of the start of a run.
    pub(super) fn face_beside(&self, run: Run) -> Option<u32> {
        self.arrangement.face_beside(self.first_half(run))
    }

    /// The vertex at which a run starts.
    pub(crate) fn start(&self, run: Run) -> u32 {
        let half = self.first_half(run);
        self.arrangement.vertex(if half.forward { half.stretch } else { self.arrangement.next(half.stretch) })
    }

    /// The vertex at which a run ends.
    pub(crate) fn end(&self, run: Run) -> u32 {
        self.start(Run { forward: !run.forward, ..run })
    }

    /// A vertex as a unit direction.
    pub(crate) fn unit(&self, vertex: u32) -> DVec3 {
        self.mosaic.directions.unit(self.arrangement.vertex_direction(vertex))
    }

    pub(crate) fn spot(&self, vertex: u32) -> Spot {
        self.spots[vertex as usize]
    }

    /// The number of the great circle of a chain.
    pub(crate) fn circle(&self, chain: u32) -> u32 {
        self.arrangement.place(self.chains[chain as usize].first).track
    }

    /// The faces beside the first and the last stretch of a chain, those on the positive side first.
    pub(crate) fn faces_at_ends(&self, chain: u32) -> [[u32; 2]; 2] {
        let run = Run { chain, forward: true };
        [self.first_half(run), self.last_half(run)]
            .map(|half| self.arrangement.faces_beside(half.stretch).unwrap_or_else(|| unreachable!("it is a border")))
    }

    /// True if two runs, one after the other, are on one great circle in one direction.
    pub(crate) fn go_on(&self, run: Run, next: Run) -> bool {
        self.circle(run.chain) == self.circle(next.chain) && run.forward == next.forward
    }

    /// To which side the boundary turns from one run to the next, exactly: positive for the left.
    pub(crate) fn turn(&mut self, run: Run, next: Run) -> Sign {
        if self.go_on(run, next) {
            return Sign::Zero;
        }
        // The next stretch is less than half a turn long, so its end is on the side to which it leads.
        let half = self.first_half(next);
        let ahead = if half.forward { self.arrangement.next(half.stretch) } else { half.stretch };
        let direction = self.arrangement.place(ahead).direction;
        let circle = self.circles.name(self.circle(run.chain));
        let Mosaic { skeleton, directions, knife, .. } = &mut self.mosaic;
        directions.side(skeleton, direction, circle, &mut knife.cache) * inside(run)
    }
}

/// The sign that directions to the left of a run have for the normal of its great circle.
pub(crate) fn inside(run: Run) -> Sign {
    if run.forward { Sign::Positive } else { Sign::Negative }
}

fn spots(mosaic: &mut Mosaic<'_>, circles: &GreatCircles, arrangement: &Arrangement, seam: Option<Seam>) -> Vec<Spot> {
    let mut spots = vec![Spot::Plain; arrangement.vertex_count()];
    let Some(Seam { along, across }) = seam else { return spots };
    let circle = circles.number(along);
    for place in arrangement.places_on(circle) {
        let parts = arrangement.faces_beside(place).map(|pair| pair.map(|face| mosaic.faces[face as usize]));
        if parts.is_some_and(|[a, b]| a.meets_at_seam(&b)) {
            for end in [place, arrangement.next(place)] {
                spots[arrangement.vertex(end) as usize] = Spot::Seam;
            }
        }
    }
    for place in arrangement.places_on(circle) {
        let direction = arrangement.place(place).direction;
        let Mosaic { skeleton, directions, knife, .. } = &mut *mosaic;
        if directions.side(skeleton, direction, across, &mut knife.cache).is_zero() {
            spots[arrangement.vertex(place) as usize] = Spot::Pole;
        }
    }
    spots
}

/// The chains, in the order of their first places, and that of every stretch.
fn chains(arrangement: &Arrangement, borders: &[bool], spots: &[Spot]) -> (Vec<Chain>, Vec<u32>) {
    let mut degrees = vec![0u32; arrangement.vertex_count()];
    for stretch in (0..borders.len() as u32).filter(|&s| borders[s as usize]) {
        for end in [stretch, arrangement.next(stretch)] {
            degrees[arrangement.vertex(end) as usize] += 1;
        }
    }
    // Nothing but one border goes straight through.
    let goes_through = |place: u32| {
        let vertex = arrangement.vertex(place) as usize;
        borders[place as usize]
            && borders[arrangement.previous(place) as usize]
            && degrees[vertex] == 2
            && spots[vertex] != Spot::Pole
    };
    let mut chains: Vec<Chain> = Vec::new();
    let mut chain_of = vec![u32::MAX; borders.len()];
    let mut follow = |first: u32| {
        let mut chain = Chain { first, count: 0, length: 0.0 };
        let mut stretch = first;
        loop {
            chain_of[stretch as usize] = chains.len() as u32;
            chain.count += 1;
            chain.length += arrangement.length(stretch);
            stretch = arrangement.next(stretch);
            if !goes_through(stretch) || stretch == first {
                break;
            }
        }
        chains.push(chain);
    };
    let mut place = 0;
    while (place as usize) < borders.len() {
        let on_circle = arrangement.places_on(arrangement.place(place).track);
        place = on_circle.end;
        let starts = on_circle.clone().filter(|&s| borders[s as usize] && !goes_through(s));
        let mut is_closed = borders[on_circle.start as usize];
        for first in starts {
            is_closed = false;
            follow(first);
        }
        if is_closed {
            follow(on_circle.start);
        }
    }
    (chains, chain_of)
}

/// The regions without their loops.
fn components(mosaic: &Mosaic<'_>, arrangement: &Arrangement, borders: &[bool]) -> Vec<Component> {
    let mut sets = Sets::new(mosaic.faces.len());
    for stretch in (0..borders.len() as u32).filter(|&s| !borders[s as usize]) {
        if let Some([a, b]) = arrangement.faces_beside(stretch) {
            sets.unite(a, b);
        }
    }
    let mut components: Vec<Component> = Vec::new();
    let mut component_of = vec![0; mosaic.faces.len()];
    for (face, k) in mosaic.faces.iter().zip(0u32..) {
        let Some(label) = face.label else { continue };
        let first = sets.find(k);
        if first == k {
            component_of[k as usize] = components.len();
            components.push(Component { label, faces: vec![k], loops: Vec::new() });
        } else {
            components[component_of[first as usize]].faces.push(k);
        }
    }
    components
}
