//! Facets that are the outside of a convex body, such as the walls and the roof of a building: from where none of its inside is seen they cast one convex shadow.
//!
//! What a view costs by shadows is what is cut: the outline of a box has six sides at most where its three faces have twelve, and between the faces nothing
//! is cut that has to be cut off next.

use super::facets::{Facet, spanning};
use super::lies::Lies;
use super::shape::sides;
use glam::DVec3;
use std::collections::HashMap;

/// Bodies of more facets than this are left as they are: their outlines have about as many sides as what is seen of them has facets.
pub(super) const MOST_FACETS: usize = 32;

/// A side of a facet, by the number of that and of the side from 1 on; 0 is its plane. Of two facets of a body that share a side it is that of the first.
pub(super) type FacetSide = (u32, u32);

/// The boundary of a convex polyhedron, all of it but for one face at most.
pub(super) struct Body {
    pub(super) corners: Vec<DVec3>,
    pub(super) facets: Vec<u32>,
    pub(super) edges: Vec<Edge>,
    /// Three corners of the face that it lacks, which run counter-clockwise seen from outside: where that is in front its inside may be seen.
    pub(super) lacks: Option<[DVec3; 3]>,
}

pub(super) struct Edge {
    /// The places of its corners, as they follow each other around the facet to the left of it.
    pub(super) ends: [u32; 2],
    /// The places among its facets of those beside it; none at the face that it lacks.
    pub(super) left: u32,
    pub(super) right: Option<u32>,
    pub(super) side: FacetSide,
}

/// The bodies of a scene.
pub(super) struct Bodies {
    pub(super) all: Vec<Body>,
    /// The one that each facet is part of.
    pub(super) of_facet: Vec<Option<u32>>,
    /// The names of the sides of each facet.
    sides: Vec<Vec<FacetSide>>,
}

impl Bodies {
    /// Finds those that show from outside: each of their facets is behind the planes of all others, by exact signs.
    pub(super) fn of(facets: &[Facet], lies: impl Fn(u32, u32) -> Lies) -> Self {
        let around = Sides::of(facets);
        let mut found = Self { all: Vec::new(), of_facet: vec![None; facets.len()], sides: Vec::new() };
        let mut is_done: Vec<bool> = facets.iter().map(|facet| facet.is_covered).collect();
        for first in 0..facets.len() as u32 {
            if is_done[first as usize] {
                continue;
            }
            let group = around.group(first, &is_done, &lies);
            for &facet in &group {
                is_done[facet as usize] = true;
            }
            if let Some(body) = around.body(group) {
                let number = found.all.len() as u32;
                body.facets.iter().for_each(|&facet| found.of_facet[facet as usize] = Some(number));
                found.all.push(body);
            }
        }
        let name = |own: u32, place: u32, side: [DVec3; 2]| {
            let body = found.of_facet[own as usize];
            let shared =
                around.beyond(side).filter(|&(other, _)| body.is_some() && found.of_facet[other as usize] == body);
            shared.map_or((own, place + 1), |other| other.min((own, place + 1)))
        };
        let names = |(own, facet): (u32, &Facet)| {
            (0..).zip(sides(&facet.ring)).map(|(place, side)| name(own, place, side)).collect()
        };
        found.sides = (0..).zip(facets).map(names).collect();
        found
    }

    /// The name of a side of a facet, by its place in the ring.
    pub(super) fn side(&self, facet: u32, place: u32) -> FacetSide {
        self.sides[facet as usize][place as usize]
    }
}

/// A point, to be found again: zeros of both signs are one.
type Key = [u64; 3];

fn key(p: DVec3) -> Key {
    (p + DVec3::ZERO).to_array().map(f64::to_bits)
}

/// The facets with all their sides.
struct Sides<'a> {
    facets: &'a [Facet],
    /// The one side that runs as it does.
    of: HashMap<[Key; 2], Option<FacetSide>>,
}

impl<'a> Sides<'a> {
    fn of(facets: &'a [Facet]) -> Self {
        let mut of = HashMap::new();
        for (number, facet) in facets.iter().enumerate() {
            for (place, side) in sides(&facet.ring).enumerate() {
                let name = (number as u32, place as u32 + 1);
                of.entry(side.map(key)).and_modify(|one| *one = None).or_insert(Some(name));
            }
        }
        Self { facets, of }
    }

    /// The same side of the facet that is beyond it.
    fn beyond(&self, [a, b]: [DVec3; 2]) -> Option<FacetSide> {
        self.of.get(&[key(b), key(a)]).copied().flatten()
    }

    /// A facet with those that are reached over sides and are convex with all.
    fn group(&self, first: u32, is_done: &[bool], lies: &impl Fn(u32, u32) -> Lies) -> Vec<u32> {
        let mut group = vec![first];
        let mut next = 0;
        while next < group.len() && group.len() <= MOST_FACETS {
            for side in sides(&self.facets[group[next] as usize].ring) {
                let Some((other, _)) = self.beyond(side).filter(|&(other, _)| !is_done[other as usize]) else {
                    continue;
                };
                let are_convex =
                    |&one: &u32| one != other && lies(one, other) == Lies::Behind && lies(other, one) == Lies::Behind;
                if group.iter().all(are_convex) {
                    group.push(other);
                }
            }
            next += 1;
        }
        group
    }

    /// The body of facets that are convex together, if they are closed but for one plane face.
    fn body(&self, mut facets: Vec<u32>) -> Option<Body> {
        if facets.len() < 3 || facets.len() > MOST_FACETS {
            return None;
        }
        facets.sort_unstable();
        let (mut corners, mut places) = (Vec::new(), HashMap::new());
        let mut place_of = |p: DVec3| {
            *places.entry(key(p)).or_insert_with(|| {
                corners.push(p);
                corners.len() as u32 - 1
            })
        };
        let (mut edges, mut after) = (Vec::new(), HashMap::new());
        for (left, &facet) in facets.iter().enumerate() {
            for (number, side) in sides(&self.facets[facet as usize].ring).enumerate() {
                let right = self.beyond(side).and_then(|(other, _)| facets.binary_search(&other).ok());
                let ends = side.map(&mut place_of);
                if right.is_none_or(|right| left < right) {
                    let (left, right) = (left as u32, right.map(|right| right as u32));
                    edges.push(Edge { ends, left, right, side: (facet, number as u32 + 1) });
                }
                // Around the face that is lacking sides run the other way.
                if right.is_none() && after.insert(ends[1], ends[0]).is_some() {
                    return None;
                }
            }
        }
        let lacks = match edges.iter().find(|edge| edge.right.is_none()) {
            None => None,
            Some(edge) => {
                let ring = loop_of(edge.ends[0], &after)?;
                let ring: Vec<DVec3> = ring.into_iter().map(|corner| corners[corner as usize]).collect();
                let face = spanning(&ring);
                if Lies::of(&ring, face) != Lies::On || Lies::of(&corners, face) != Lies::Behind {
                    return None;
                }
                Some(face)
            }
        };
        Some(Body { corners, facets, edges, lacks })
    }
}

/// All corners, if they follow each other in one loop.
fn loop_of(first: u32, after: &HashMap<u32, u32>) -> Option<Vec<u32>> {
    let mut ring = vec![first];
    loop {
        let next = *after.get(ring.last()?)?;
        if next == first {
            return (ring.len() == after.len()).then_some(ring);
        }
        if ring.len() == after.len() {
            return None;
        }
        ring.push(next);
    }
}

#[cfg(test)]
mod tests {
    use super::super::facets::Facets;
    use super::*;
    use crate::scene::{Material, Scene};

    /// The faces of a box from 0 to 1, z scaled, without the one whose number is given: bottom, top, then sides.
    fn cube(height: f64, without: Option<usize>) -> Vec<Vec<DVec3>> {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, height * z);
        let faces = [
            [at(0., 0., 0.), at(0., 1., 0.), at(1., 1., 0.), at(1., 0., 0.)],
            [at(0., 0., 1.), at(1., 0., 1.), at(1., 1., 1.), at(0., 1., 1.)],
            [at(0., 0., 0.), at(1., 0., 0.), at(1., 0., 1.), at(0., 0., 1.)],
            [at(1., 0., 0.), at(1., 1., 0.), at(1., 1., 1.), at(1., 0., 1.)],
            [at(1., 1., 0.), at(0., 1., 0.), at(0., 1., 1.), at(1., 1., 1.)],
            [at(0., 1., 0.), at(0., 0., 0.), at(0., 0., 1.), at(0., 1., 1.)],
        ];
        (0..6).filter(|&k| Some(k) != without).map(|k| faces[k].to_vec()).collect()
    }

    fn bodies(faces: &[Vec<DVec3>]) -> Bodies {
        let (mut vertices, mut rings) = (Vec::new(), Vec::new());
        for face in faces {
            rings.push((vertices.len()..vertices.len() + face.len()).collect::<Vec<_>>());
            vertices.extend(face.iter().map(DVec3::to_array));
        }
        let scene = Scene::builder().mesh(&vertices, &rings, Material::new("m")).build().unwrap();
        Facets::of(&scene).unwrap().bodies
    }

    #[test]
    fn boxes_are_bodies_closed_or_without_one_face() {
        let closed = bodies(&cube(2.0, None));
        assert_eq!((closed.all.len(), closed.all[0].facets.len(), closed.all[0].edges.len()), (1, 6, 12));
        assert!(closed.all[0].lacks.is_none());
        let open = bodies(&cube(2.0, Some(0)));
        let [body] = &open.all[..] else { panic!("{} bodies", open.all.len()) };
        assert_eq!((body.facets.len(), body.edges.len()), (5, 12));
        // Its bottom, seen from below.
        let [a, b, c] = body.lacks.unwrap();
        assert!((b - a).cross(c - a).z < 0.0 && [a, b, c].iter().all(|p| p.z.abs() <= 0.0));
        assert_eq!(open.of_facet, [Some(0); 5]);
    }

    #[test]
    fn sides_have_one_name_in_both_facets() {
        let closed = bodies(&cube(1.0, None));
        let mut names: Vec<FacetSide> =
            (0..6).flat_map(|facet| (0..4).map(move |k| (facet, k))).map(|(facet, k)| closed.side(facet, k)).collect();
        names.sort_unstable();
        let all = names.len();
        names.dedup();
        assert_eq!((all, names.len()), (24, 12));
    }

    #[test]
    fn what_shows_its_inside_or_is_not_convex_is_none() {
        // Two faces are missing; all are turned around; a pit is part of no body, and that around it is one from where the pit is not seen.
        let two: Vec<_> = cube(1.0, Some(0)).into_iter().skip(1).collect();
        assert!(bodies(&two).all.is_empty());
        let turned: Vec<_> = cube(1.0, None).into_iter().map(|face| face.into_iter().rev().collect()).collect();
        assert!(bodies(&turned).all.is_empty());
        let mut dented = cube(1.0, Some(1));
        let top = [[0., 0., 1.], [1., 0., 1.], [1., 1., 1.], [0., 1., 1.]].map(DVec3::from);
        let pit = DVec3::new(0.5, 0.5, 0.5);
        dented.extend((0..4).map(|k| vec![top[k], top[(k + 1) % 4], pit]));
        let dented = bodies(&dented);
        assert_eq!(dented.all.len(), 1);
        assert_eq!(dented.of_facet, [[Some(0); 5].as_slice(), &[None; 4]].concat());
        assert!(dented.all[0].lacks.is_some_and(|face| face.iter().all(|p| p.z >= 1.0)));
    }
}
