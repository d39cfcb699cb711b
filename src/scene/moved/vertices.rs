//! The vertices of a scene with objects moved.

use super::super::assemble::next_id;
use super::super::{Data, SceneError, VertexId};
use super::{MoveError, Moves};
use glam::DVec3;
use std::collections::HashMap;

/// Where vertices are after a move, and under which number.
///
/// Vertices that stay keep their order, and a vertex that moves follows the one it was: so the order within every polygon
/// stays, and with it how it is triangulated. Only where one that moves comes to one that stays, it takes that one's number.
#[derive(Default)]
pub(super) struct Places {
    pub(super) positions: Vec<DVec3>,
    /// For each old vertex its new number, if something that stays names it.
    staying: Vec<Option<VertexId>>,
    /// By old vertex and move, ascending.
    moving: Vec<(Rider, VertexId)>,
    /// Whether something that moves names the new vertex.
    is_approached: Vec<bool>,
}

/// An old vertex and the number of a move that it takes part in.
type Rider = (VertexId, u32);

/// What becomes of a position that something moves to.
#[derive(Clone, Copy)]
enum Target {
    Open,
    /// An old vertex is there and stays.
    Staying(VertexId),
    /// It has that number.
    New(VertexId),
}

impl Places {
    pub(super) fn new(old: &Data, moves: &Moves) -> Result<Self, MoveError> {
        let mut stays = vec![false; old.vertices.len()];
        let mut riders: Vec<Rider> = Vec::new();
        for polygon in &old.polygons {
            let vertices = polygon.rings.iter().flatten();
            match moves.of(polygon) {
                Some(number) => riders.extend(vertices.map(|&v| (v, number))),
                None => {
                    for vertex in vertices {
                        stays[vertex.index()] = true;
                    }
                }
            }
        }
        riders.sort_unstable();
        riders.dedup();

        // The keys come from files, so the map is one that cannot be filled with collisions on purpose.
        let mut targets: HashMap<[u64; 3], Target> = HashMap::with_capacity(riders.len());
        let mut goals = Vec::with_capacity(riders.len());
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &(vertex, number) in &riders {
            let change = &moves.all[number as usize];
            // x + 0 is x, but +0 for -0.
            let goal = change.transform.transform_point3(old.vertices[vertex.index()]) + DVec3::ZERO;
            if !goal.is_finite() {
                return Err(MoveError::Overflow { object: change.object });
            }
            targets.insert(key(goal), Target::Open);
            goals.push(goal);
            (low, high) = (low.min(goal), high.max(goal));
        }
        for (k, &position) in old.vertices.iter().enumerate().filter(|&(k, _)| stays[k]) {
            if (position.cmpge(low) & position.cmple(high)).all()
                && let Some(target) = targets.get_mut(&key(position))
            {
                *target = Target::Staying(VertexId(k as u32));
            }
        }

        let count = old.vertices.len();
        let mut places = Self {
            positions: Vec::with_capacity(count + riders.len()),
            staying: Vec::with_capacity(count),
            ..Self::default()
        };
        let mut next = 0;
        for (k, &position) in old.vertices.iter().enumerate() {
            places.staying.push(stays[k].then_some(VertexId(places.positions.len() as u32)));
            if stays[k] {
                places.positions.push(position);
            }
            while riders.get(next).is_some_and(|rider| rider.0.index() == k) {
                if let Some(target @ Target::Open) = targets.get_mut(&key(goals[next])) {
                    *target = Target::New(VertexId(places.positions.len() as u32));
                    places.positions.push(goals[next]);
                }
                next += 1;
            }
        }
        next_id(places.positions.len(), "vertices").map_err(|problem| SceneError { problems: vec![problem] })?;
        places.is_approached = vec![false; places.positions.len()];
        for (&rider, &goal) in riders.iter().zip(&goals) {
            let id = match targets[&key(goal)] {
                Target::New(id) => id,
                Target::Staying(vertex) => places.stays(vertex),
                Target::Open => unreachable!("all positions have numbers"),
            };
            places.is_approached[id.index()] = true;
            places.moving.push((rider, id));
        }
        Ok(places)
    }

    /// The new number of an old vertex where it stays. Something that stays must name it.
    pub(super) fn stays(&self, vertex: VertexId) -> VertexId {
        self.staying[vertex.index()].expect("a vertex of something that stays")
    }

    /// The new number of an old vertex that takes part in a move.
    pub(super) fn moved(&self, vertex: VertexId, number: u32) -> VertexId {
        let place = self.moving.partition_point(|&(rider, _)| rider < (vertex, number));
        self.moving[place].1
    }

    /// True if something that moves has come to the vertex.
    pub(super) fn is_approached(&self, vertex: VertexId) -> bool {
        self.is_approached[vertex.index()]
    }
}

fn key(position: DVec3) -> [u64; 3] {
    position.to_array().map(f64::to_bits)
}
