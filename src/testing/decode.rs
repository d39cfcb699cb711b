//! Cases from bytes, for fuzzing: every input means something, and means the same for ever.

use super::{Case, CaseWindows, Faces, Mode, Outlook, nudged};
use crate::scene::Side;
use arbitrary::{Arbitrary, Unstructured};
use glam::DVec3;

/// No operation is read once there are so many faces: more cost time and find nothing new.
const MOST_FACES: usize = 12;

impl Case {
    /// The first byte of every input that [`Case::decode`] reads.
    pub const VERSION: u8 = 2;

    /// Reads a case from bytes; `None` if they are of another version. Bytes past the end count as zeros.
    ///
    /// Version 1. A *coordinate* is one byte in grid mode: its remainder by 17, less 8. In chaos mode the byte's
    /// remainder by 8 says what follows: 0 to 3 such a byte; 4, 5 such a byte and one that nudges it by up to 4
    /// places; 6 such a byte and one that scales it by a power of two; 7 the eight bytes of an f64.
    ///
    /// | bytes | meaning |
    /// | --- | --- |
    /// | 1 | version |
    /// | 1 | bit 0: chaos mode; bits 1 to 3: epsilon, 0 for 0 to 5, then 2^-10, 2^-3; bits 4 to 6: the outlook |
    /// | 3 coordinates | the eye, if it is free |
    /// | 3 | where the eye is: a kind, a face, its corner |
    /// | 3 coordinates | the direction |
    /// | rest | faces, each an operation and its arguments |
    ///
    /// Kinds of eyes (remainder by 6): 0 to 2 free, 3 on a vertex, 4 in the middle of an edge, 5 in a plane.
    ///
    /// Outlook: 0, 1 sphere, 2 a frustum, 3 windows, 4, 5 hemisphere, 6 above the front of the face named with the eye, 7 above its back.
    ///
    /// Operations (remainder by 10): 0, 1 a triangle of three points; 2 a triangle that shares two
    /// corners of an earlier face; 3 a parallelogram of three points (two triangles in chaos mode); 4 a box;
    /// 5 a box seen from inside; 6 an earlier face again; 7 an earlier face turned over; 8 an earlier triangle with
    /// one coordinate moved one step; 9 a triangle on the middle of an earlier edge. After 12 faces no operation is read.
    pub fn decode(bytes: &[u8]) -> Option<Self> {
        let mut bytes = Bytes(bytes);
        if bytes.byte() != Self::VERSION {
            return None;
        }
        let head = bytes.byte();
        let mode = if head & 1 == 0 { Mode::Grid } else { Mode::Chaos };
        let epsilon = match head >> 1 & 7 {
            6 => 2f64.powi(-10),
            7 => 2f64.powi(-3),
            _ => 0.0,
        };
        let free = bytes.point(mode);
        let [kind, face, corner] = [(); 3].map(|()| bytes.byte());
        let direction = bytes.point(mode);
        let mut faces = Faces::default();
        while !bytes.0.is_empty() && faces.len() < MOST_FACES {
            bytes.face(mode, &mut faces);
        }
        let eye = eye(free, [kind, face, corner], &faces);
        let face = usize::from(face) % faces.len().max(1);
        let outlook = match head >> 4 & 7 {
            // What else there is to choose comes from the eye and the direction.
            2 => Outlook::Frustum(1 + (direction.x.to_bits() >> 44) as u8 % 179),
            3 => Outlook::Windows(CaseWindows {
                faces: [face, face + 1],
                with_moved: direction.y < 0.0,
                within_hemisphere: eye.x < 0.0,
            }),
            4 | 5 => Outlook::Hemisphere,
            6 if !faces.is_empty() => Outlook::Above(face, Side::Front),
            7 if !faces.is_empty() => Outlook::Above(face, Side::Back),
            _ => Outlook::Sphere,
        };
        Some(Self { mode, faces, eye, direction, outlook, epsilon })
    }
}

/// For `fuzz_target!(|case: Case| ...)`: all bytes that there are, read by [`Case::decode`].
impl<'a> Arbitrary<'a> for Case {
    fn arbitrary(u: &mut Unstructured<'a>) -> arbitrary::Result<Self> {
        let bytes = u.bytes(u.len())?;
        Self::decode(bytes).ok_or(arbitrary::Error::IncorrectFormat)
    }

    fn arbitrary_take_rest(u: Unstructured<'a>) -> arbitrary::Result<Self> {
        Self::decode(u.take_rest()).ok_or(arbitrary::Error::IncorrectFormat)
    }
}

fn eye(free: DVec3, [kind, face, corner]: [u8; 3], faces: &Faces) -> DVec3 {
    let Some(corners) = faces.loops().get(usize::from(face) % faces.len().max(1)) else { return free };
    let [a, b, c] = [0, 1, 2].map(|k| corners[(usize::from(corner) + k) % corners.len()]);
    let place = match kind % 6 {
        3 => a,
        4 => a * 0.5 + b * 0.5,
        // Inside of a triangle or beside it, by the quarter.
        5 => a + (b - a) * (f64::from(corner >> 4) * 0.25 - 1.0) + (c - a) * (f64::from(corner >> 2 & 3) * 0.25),
        _ => free,
    };
    if place.is_finite() { place } else { free }
}

/// Numbers read from the input; zeros past its end.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }

    fn small(&mut self) -> f64 {
        f64::from(self.byte() % 17) - 8.0
    }

    fn coordinate(&mut self, mode: Mode) -> f64 {
        if mode == Mode::Grid {
            return self.small();
        }
        match self.byte() % 8 {
            0..4 => self.small(),
            4 | 5 => {
                let x = self.small();
                nudged(x, i64::from(self.byte() % 9) - 4)
            }
            6 => {
                let x = self.small();
                x * 2f64.powi(i32::from(self.byte()) * 7 - 1015)
            }
            _ => {
                let x = f64::from_le_bytes([(); 8].map(|()| self.byte()));
                if x.is_finite() { x } else { 1.0 }
            }
        }
    }

    fn point(&mut self, mode: Mode) -> DVec3 {
        DVec3::new(self.coordinate(mode), self.coordinate(mode), self.coordinate(mode))
    }

    fn earlier(&mut self, faces: &Faces) -> Vec<DVec3> {
        let face = usize::from(self.byte()) % faces.len().max(1);
        faces.loops().get(face).cloned().unwrap_or_else(|| vec![DVec3::ZERO, DVec3::X, DVec3::Y])
    }

    /// Adds what the next operation makes.
    fn face(&mut self, mode: Mode, faces: &mut Faces) {
        let operation = self.byte() % 10;
        match operation {
            0 | 1 => {
                faces.push(&[(); 3].map(|()| self.point(mode)));
            }
            2 => {
                let corners = self.earlier(faces);
                let k = usize::from(self.byte());
                let [a, b] = [k + 1, k].map(|k| corners[k % corners.len()]);
                faces.push(&[a, b, self.point(mode)]);
            }
            3 => {
                let [a, b, c] = [(); 3].map(|()| self.point(mode));
                let d = a - b + c;
                if mode == Mode::Grid {
                    faces.push(&[a, b, c, d]);
                } else {
                    faces.push(&[a, b, c]);
                    faces.push(&[a, c, if d.is_finite() { d } else { b }]);
                }
            }
            4 | 5 => {
                let (p, q) = (self.point(mode), self.point(mode));
                let mut cuboid = Faces::default();
                cuboid.cuboid(p.min(q), p.max(q));
                faces.append(&if operation == 5 { cuboid.reversed() } else { cuboid });
            }
            6 => {
                faces.push(&self.earlier(faces));
            }
            7 => {
                let mut corners = self.earlier(faces);
                corners.reverse();
                faces.push(&corners);
            }
            8 => {
                let mut corners = self.earlier(faces);
                corners.truncate(3);
                let which = self.byte();
                let x = &mut corners[usize::from(which) % 3][usize::from(which / 4) % 3];
                let up = which & 128 == 0;
                *x = match mode {
                    Mode::Grid => *x + if up { 1.0 } else { -1.0 },
                    Mode::Chaos => nudged(*x, if up { 1 } else { -1 }),
                };
                faces.push(&corners);
            }
            _ => {
                let corners = self.earlier(faces);
                let k = usize::from(self.byte());
                let [a, b] = [k, k + 1].map(|k| corners[k % corners.len()]);
                faces.push(&[a * 0.5 + b * 0.5, self.point(mode), self.point(mode)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_bytes_of_this_version_are_a_case_with_finite_numbers() {
        let mut state = 1u64;
        for length in 0..400 {
            let mut bytes: Vec<u8> = (0..length)
                .map(|_| {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    (state >> 56) as u8
                })
                .collect();
            if let Some(first) = bytes.first_mut() {
                *first = Case::VERSION;
            }
            match Case::decode(&bytes) {
                None => assert!(bytes.is_empty()),
                Some(case) => {
                    let numbers = [case.eye, case.direction];
                    assert!(case.faces.corners().chain(numbers).all(DVec3::is_finite), "{case:?}");
                    assert!(case.faces.len() < MOST_FACES + 6);
                    assert!(case.image().is_ok() || case.mode == Mode::Chaos, "{case:?}");
                }
            }
        }
        assert_eq!(Case::decode(&[Case::VERSION + 1, 2, 3]), None);
    }

    #[test]
    fn a_known_input_keeps_its_meaning() {
        let case = Case::decode(&[2, 0, 8, 8, 8, 0, 0, 0, 8, 8, 9, 0, 8, 8, 10, 10, 8, 10, 8, 10, 10, 7, 0]).unwrap();
        let expected = Case {
            mode: Mode::Grid,
            faces: Faces::from(vec![
                vec![[0.0, 0.0, 2.0], [2.0, 0.0, 2.0], [0.0, 2.0, 2.0]],
                vec![[0.0, 2.0, 2.0], [2.0, 0.0, 2.0], [0.0, 0.0, 2.0]],
            ]),
            eye: DVec3::ZERO,
            direction: DVec3::Z,
            outlook: Outlook::Sphere,
            epsilon: 0.0,
        };
        assert_eq!(case, expected);
        assert_eq!(format!("{case:?}"), format!("{case:#?}"));
        // A camera, and windows.
        let outlook = |head: u8, eye: u8| {
            let bytes = [2, head, eye, 8, 8, 0, 0, 0, 8, 7, 9, 0, 8, 8, 10, 10, 8, 10, 8, 10, 10, 7, 0];
            Case::decode(&bytes).map(|case| case.outlook)
        };
        assert_eq!(outlook(0x20, 8), Some(Outlook::Frustum(1)));
        let windows = |within_hemisphere| CaseWindows { faces: [0, 1], with_moved: true, within_hemisphere };
        assert_eq!(outlook(0x30, 8), Some(Outlook::Windows(windows(false))));
        assert_eq!(outlook(0x30, 7), Some(Outlook::Windows(windows(true))));
    }
}
