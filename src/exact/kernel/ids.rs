//! Splitters and directions that a kernel keeps by number: approximated once, made from integers at most once.

use super::super::Sign;
use super::super::approx::Approx3;
use super::super::arena::Kept3;
use super::super::definition::{Direction, Splitter};
use super::super::zeros::{ZeroComponents, defined_on, have_common_end};
use super::{CircleRelation, Kernel, range_of_direction, range_of_splitter};

/// A splitter that a [`Kernel`] knows; only that kernel knows what it means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SplitterId(u32);

/// A direction that a [`Kernel`] knows; only that kernel knows what it means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DirectionId(u32);

/// What a kernel knows, each kind by number. What the filter reads lies side by side, apart from the much
/// larger rest.
#[derive(Clone, Debug)]
pub(super) struct Table<T> {
    approx: Vec<Approx3>,
    definitions: Vec<T>,
    zeros: Vec<ZeroComponents>,
    /// The integer vectors, once they were needed.
    exact: Vec<Option<Kept3>>,
}

impl<T> Table<T> {
    pub(super) const EMPTY: Self =
        Self { approx: Vec::new(), definitions: Vec::new(), zeros: Vec::new(), exact: Vec::new() };

    fn push(&mut self, definition: T, approx: Approx3, zeros: ZeroComponents) -> u32 {
        self.approx.push(approx);
        self.definitions.push(definition);
        self.zeros.push(zeros);
        self.exact.push(None);
        self.exact.len() as u32 - 1
    }

    fn clear(&mut self) {
        self.approx.clear();
        self.definitions.clear();
        self.zeros.clear();
        self.exact.clear();
    }
}

impl Kernel {
    /// Takes in a splitter for calls that come often: it is approximated once, and its integers are
    /// made at most once.
    pub fn add_splitter(&mut self, definition: &Splitter) -> SplitterId {
        let approx = self.approx_splitter(definition);
        SplitterId(self.splitters.push(*definition, approx, ZeroComponents::of_splitter(definition, self.eye)))
    }

    /// Takes in a direction for calls that come often.
    pub fn add_direction(&mut self, definition: &Direction) -> DirectionId {
        let approx = self.approx_direction(definition);
        DirectionId(self.directions.push(*definition, approx, ZeroComponents::of_direction(definition, self.eye)))
    }

    /// Forgets all splitters and directions taken in; their ids mean nothing any more. The memory is
    /// kept for the next ones.
    pub fn clear(&mut self) {
        self.splitters.clear();
        self.directions.clear();
        self.arena.clear();
    }

    /// The normal of a splitter taken in before, in floating point.
    pub(crate) fn approx_normal(&self, splitter: SplitterId) -> &Approx3 {
        &self.splitters.approx[splitter.0 as usize]
    }

    /// [`Kernel::side`] for a direction and a splitter taken in before.
    #[inline]
    pub fn side_of(&mut self, direction: DirectionId, splitter: SplitterId) -> Sign {
        let approx = &self.directions.approx[direction.0 as usize];
        if let Some(sign) = approx.dot_sign(&self.splitters.approx[splitter.0 as usize]) {
            self.stats.filter += 1;
            return sign;
        }
        self.undecided_side_of(direction, splitter)
    }

    #[cold]
    fn undecided_side_of(&mut self, direction: DirectionId, splitter: SplitterId) -> Sign {
        let (d, s) = (direction.0 as usize, splitter.0 as usize);
        if self.directions.zeros[d].cover(self.splitters.zeros[s])
            || defined_on(&self.directions.definitions[d], &self.splitters.definitions[s])
        {
            self.stats.identity += 1;
            return Sign::Zero;
        }
        self.make_splitter(splitter);
        self.make_direction(direction);
        let (Some(direction), Some(normal)) = (&self.directions.exact[d], &self.splitters.exact[s]) else {
            unreachable!("both were made")
        };
        let arbitrary = self.arena.arbitrary_signs();
        let sign = self.arena.kept_dot_sign(normal, direction);
        self.count_stage(arbitrary);
        sign
    }

    /// [`Kernel::orientation`] for splitters taken in before.
    #[inline]
    pub fn orientation_of(&mut self, splitters: [SplitterId; 3]) -> Sign {
        let [a, b, c] = splitters.map(|s| &self.splitters.approx[s.0 as usize]);
        if let Some(sign) = a.det_sign(b, c) {
            self.stats.filter += 1;
            return sign;
        }
        self.undecided_orientation_of(splitters)
    }

    #[cold]
    fn undecided_orientation_of(&mut self, splitters: [SplitterId; 3]) -> Sign {
        // Of definitions taken in twice, integers find that they are the same.
        let [a, b, c] = splitters;
        let zeros = splitters.map(|s| self.splitters.zeros[s.0 as usize]);
        let known = |s: SplitterId| &self.splitters.definitions[s.0 as usize];
        if a == b || b == c || c == a || ZeroComponents::shared(zeros) || have_common_end(splitters.map(known)) {
            self.stats.identity += 1;
            return Sign::Zero;
        }
        for s in splitters {
            self.make_splitter(s);
        }
        // By reference: copies of what was just written wait for each other.
        let [Some(a), Some(b), Some(c)] = splitters.map(|s| self.splitters.exact[s.0 as usize].as_ref()) else {
            unreachable!("all were made")
        };
        let arbitrary = self.arena.arbitrary_signs();
        let sign = self.arena.kept_det_sign(a, b, c);
        self.count_stage(arbitrary);
        sign
    }

    /// [`Kernel::compare_circles`] for splitters taken in before.
    pub fn compare_circles_of(&mut self, a: SplitterId, b: SplitterId) -> CircleRelation {
        if a == b {
            self.stats.identity += 1;
            return CircleRelation::Same;
        }
        let [p, q] = [a, b].map(|s| &self.splitters.approx[s.0 as usize]);
        if p.not_parallel(q) {
            self.stats.filter += 1;
            return CircleRelation::Different;
        }
        self.make_splitter(a);
        self.make_splitter(b);
        let [Some(a), Some(b)] = [a, b].map(|s| self.splitters.exact[s.0 as usize].as_ref()) else {
            unreachable!("both were made")
        };
        let arbitrary = self.arena.arbitrary_signs();
        let sign = self.arena.kept_parallel(a, b);
        self.count_stage(arbitrary);
        CircleRelation::of(sign)
    }

    /// Makes the integers of a splitter, at the first call. They may come from different grids: a vector
    /// stands for its positive multiples too.
    #[inline]
    fn make_splitter(&mut self, id: SplitterId) {
        if self.splitters.exact[id.0 as usize].is_none() {
            self.make_new_splitter(id);
        }
    }

    #[cold]
    fn make_new_splitter(&mut self, id: SplitterId) {
        let definition = self.splitters.definitions[id.0 as usize];
        let range = range_of_splitter(self.range, &definition);
        self.splitters.exact[id.0 as usize] = Some(self.keep(range, |exact| exact.keep_splitter(&definition)));
    }

    #[inline]
    fn make_direction(&mut self, id: DirectionId) {
        if self.directions.exact[id.0 as usize].is_none() {
            self.make_new_direction(id);
        }
    }

    #[cold]
    fn make_new_direction(&mut self, id: DirectionId) {
        let definition = self.directions.definitions[id.0 as usize];
        let range = range_of_direction(self.range, &definition);
        self.directions.exact[id.0 as usize] = Some(self.keep(range, |exact| exact.keep_direction(&definition)));
    }
}
