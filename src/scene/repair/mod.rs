//! What becomes of broken faces: chosen by the user, and listed where it changed anything.

mod effect;
mod snap;
mod spec;

pub(super) use effect::note_welding;
pub(super) use snap::snap;
pub use spec::RepairSpecError;

use super::{PolygonId, SceneProblem};
use glam::DVec3;

/// What becomes of faces that are not as they should be. The default changes no coordinate and drops nothing.
///
/// A polygon that is dropped keeps its number and has neither rings nor pieces ([`Shape::Dropped`](super::Shape));
/// vertices that only dropped polygons name are left out. What was changed is listed in [`Scene::repairs`](super::Scene::repairs).
///
/// As text it is a list such as `non-planar=drop,weld=0.001` of the policies that are not the default:
///
/// ```
/// use nusselt::scene::{OrDrop, Repair};
/// let repair: Repair = "self-crossing=drop,weld=0.001".parse()?;
/// assert_eq!(repair, Repair { self_crossing: OrDrop::Drop, weld: Some(0.001), ..Repair::default() });
/// assert_eq!(repair.to_string(), "self-crossing=drop,weld=0.001");
/// # Ok::<(), nusselt::scene::RepairSpecError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Repair {
    /// `non-planar`: polygons whose vertices are not exactly in one plane.
    pub non_planar: NonPlanarPolicy,
    /// `zero-area`: polygons whose vertices are all on one line, or that fold back on themselves.
    pub zero_area: ZeroAreaPolicy,
    /// `self-crossing`: polygons whose boundary crosses itself, whose holes are outside, or that cannot be
    /// triangulated for the range of their coordinates or the work it would take.
    pub self_crossing: OrDrop,
    /// `malformed`: faces with a ring of fewer than three vertices, and faces that name vertices that do not
    /// exist or are not finite.
    pub malformed: OrDrop,
    /// `duplicate`: polygons with area and exactly the same corners as one before, in either direction.
    pub duplicates: DuplicatePolicy,
    /// `weld`: moves vertices onto others that are nearer than this, in scene units; finite and not negative.
    ///
    /// The vertices that faces name are taken in order: each moves onto the nearest vertex that was left where it is, if
    /// one is nearer than the tolerance (of equally near ones, onto the first), and stays where it is otherwise. So
    /// none moves farther than the tolerance, there are no chains, the order of the faces does not matter,
    /// and welding once more changes nothing. Distances are rounded up, by some units in the last place.
    pub weld: Option<f64>,
}

/// What becomes of polygons that are not exactly planar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NonPlanarPolicy {
    /// They are triangulated over their own vertices.
    #[default]
    Triangulate,
    /// They are problems.
    Reject,
    /// They are dropped.
    Drop,
}

/// What becomes of polygons without area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ZeroAreaPolicy {
    /// They stay, and hide nothing.
    #[default]
    Keep,
    /// They are problems.
    Reject,
}

/// What becomes of polygons that there is no use for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum OrDrop {
    /// They are problems.
    #[default]
    Reject,
    /// They are dropped.
    Drop,
}

/// What becomes of a polygon with the same corners as one before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DuplicatePolicy {
    /// Both stay.
    #[default]
    Keep,
    /// The later one is a problem.
    Reject,
    /// The later one is dropped.
    Drop,
}

/// What a [`Repair`] changed. Empty if nothing was asked for, or nothing was broken.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Repairs {
    /// The polygons that were dropped, ascending.
    pub dropped: Vec<Dropped>,
    /// The vertices that welding moved, by their place in the input.
    pub moved: Vec<MovedVertex>,
    /// Polygons in whose rings welding made neighbouring corners one, ascending.
    pub shortened: Vec<PolygonId>,
    /// Polygons whose corners were not all on one line before welding and that have no area after it, ascending.
    pub collapsed: Vec<PolygonId>,
    /// Polygons that were exactly planar before welding and are not after it, ascending.
    pub bent: Vec<PolygonId>,
}

impl Repairs {
    /// True if nothing was changed.
    pub fn is_empty(&self) -> bool {
        self.dropped.is_empty() && self.moved.is_empty()
    }

    /// The farthest that a vertex was moved, rounded; 0 if none was.
    pub fn farthest_move(&self) -> f64 {
        self.moved.iter().fold(0.0, |far, moved| far.max(moved.distance()))
    }
}

/// A polygon that was dropped.
#[derive(Clone, Debug, PartialEq)]
pub struct Dropped {
    /// Its number, which stays its own.
    pub polygon: PolygonId,
    /// The policy by which it was dropped.
    pub cause: DropCause,
    /// What was wrong with it: the first thing, if there were several.
    pub problem: SceneProblem,
    /// The diagonal of the box around those of its vertices that exist and are finite, rounded.
    pub size: f64,
}

/// The policies that drop polygons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DropCause {
    /// [`Repair::malformed`].
    Malformed,
    /// [`Repair::self_crossing`].
    SelfCrossing,
    /// [`Repair::non_planar`].
    NonPlanar,
    /// [`Repair::duplicates`].
    Duplicate,
}

impl DropCause {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Malformed, Self::SelfCrossing, Self::NonPlanar, Self::Duplicate];

    /// The policy's name in the text of a [`Repair`].
    pub fn name(self) -> &'static str {
        match self {
            Self::Malformed => "malformed",
            Self::SelfCrossing => "self-crossing",
            Self::NonPlanar => "non-planar",
            Self::Duplicate => "duplicate",
        }
    }
}

/// A vertex that was moved onto another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovedVertex {
    /// Its place in the input, from 0.
    pub vertex: usize,
    /// Where it was.
    pub from: DVec3,
    /// Where it is now: where the other one is and was.
    pub to: DVec3,
}

impl MovedVertex {
    /// How far it was moved, in scene units, rounded.
    pub fn distance(&self) -> f64 {
        super::flat::distance(self.from, self.to)
    }
}
