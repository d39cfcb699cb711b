//! STL as text: solids of facets, each with a loop of vertices.

use super::super::draft::Draft;
use super::super::error::Place;
use super::super::lines::{is_blank, take_line};
use super::super::number::{self, shown};
use super::super::{Loaded, ReadError};
use crate::scene::{Material, MaterialId, ObjectId};
use glam::DVec3;

pub(super) fn parse(bytes: &[u8], mut draft: Draft<'_>) -> Result<Loaded, ReadError> {
    let material = draft.builder.add_material(Material::new("default"));
    let mut reader = Reader { draft, material, object: None, facet: None, lines: Vec::new() };
    let mut rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut line = 0;
    while !rest.is_empty() {
        line += 1;
        let text = String::from_utf8_lossy(take_line(&mut rest));
        if let Err(what) = reader.read_line(line, text.trim_matches(is_blank)) {
            match &mut reader.facet {
                Some(facet) => {
                    reader.draft.refuse_face(Place::Line(line), &what);
                    facet.broken.get_or_insert(what);
                }
                None => reader.draft.fault(Place::Line(line), what),
            }
        }
    }
    reader.finish()
}

/// A facet that was begun.
struct Facet {
    line: usize,
    ring: Vec<usize>,
    /// What is wrong with it, at first.
    broken: Option<String>,
}

struct Reader<'a> {
    draft: Draft<'a>,
    material: MaterialId,
    /// The solid that was begun.
    object: Option<ObjectId>,
    facet: Option<Facet>,
    /// For each facet its line.
    lines: Vec<usize>,
}

impl Reader<'_> {
    /// A line may hold several words of the grammar. What is wrong in a facet breaks it, but not the next.
    fn read_line(&mut self, line: usize, text: &str) -> Result<(), String> {
        let mut rest = text;
        while !rest.is_empty() {
            let word = take_word(&mut rest);
            match word.to_ascii_lowercase().as_str() {
                "solid" => {
                    self.end_facet(Some("`solid`"));
                    let has = |word: &str| rest.split(is_blank).any(|other| other.eq_ignore_ascii_case(word));
                    if has("facet") && has("vertex") {
                        let what = "the facets follow in the line of `solid`, which ends with its name; break the line";
                        return Err(what.to_owned());
                    }
                    let name = if rest.is_empty() { "default" } else { rest };
                    self.object = Some(self.draft.builder.add_object(name));
                    return Ok(());
                }
                "endsolid" => {
                    self.end_facet(Some("`endsolid`"));
                    self.object = None;
                    return Ok(());
                }
                "facet" => {
                    self.end_facet(Some("the next `facet`"));
                    if self.object.is_none() {
                        self.object = Some(self.draft.builder.add_object("default"));
                    }
                    self.facet = Some(Facet { line, ring: Vec::new(), broken: None });
                    // The normal is whatever follows: some programs write `nan` for it.
                    if rest.get(..6).is_some_and(|word| word.eq_ignore_ascii_case("normal")) {
                        for _ in 0..4 {
                            take_word(&mut rest);
                        }
                    }
                }
                "vertex" => self.read_vertex(line, &mut rest)?,
                "endfacet" => self.end_facet(None),
                "outer" | "loop" | "endloop" => {}
                _ => {
                    return Err(format!(
                        "{} is no word of STL; it takes `solid`, `facet normal`, `outer loop`, `vertex` and their ends",
                        shown(word)
                    ));
                }
            }
        }
        Ok(())
    }

    fn read_vertex(&mut self, line: usize, rest: &mut &str) -> Result<(), String> {
        let mut position = [0.0; 3];
        for (k, coordinate) in position.iter_mut().enumerate() {
            let word = take_word(rest);
            let number = if word.is_empty() {
                Err(format!("a vertex takes 3 coordinates, but here are {k}"))
            } else {
                number::parse(word)
            };
            *coordinate = number?;
        }
        let Some(facet) = &mut self.facet else {
            return Err("a vertex outside of a facet; it takes `facet` and `endfacet` around it".to_owned());
        };
        let vertex = self.draft.add_vertex(DVec3::from(position), || Place::Line(line));
        facet.ring.push(vertex);
        Ok(())
    }

    /// Ends the facet that was begun, if one was. If it is not its own end that ends it, it is at fault.
    fn end_facet(&mut self, before: Option<&str>) {
        let (Some(Facet { line, ring, broken }), Some(object)) = (self.facet.take(), self.object) else { return };
        self.lines.push(line);
        let end = match (before, &broken) {
            (Some(before), _) => Some(format!("this facet has no `endfacet` before {before}")),
            (None, None) if ring.len() < 3 => Some(format!("a facet takes 3 vertices, but here are {}", ring.len())),
            (None, _) => None,
        };
        // Of a facet that is dropped the first fault is enough.
        if let Some(what) = end.as_ref().filter(|_| broken.is_none() || !self.draft.drops) {
            self.draft.refuse_face(Place::Line(line), what);
        }
        match broken.or(end) {
            Some(why) => self.draft.add_broken_face(why, vec![ring], object, self.material),
            None => self.draft.add_face(vec![ring], object, self.material),
        }
    }

    fn finish(mut self) -> Result<Loaded, ReadError> {
        self.end_facet(Some("the end of the file; it may be cut off"));
        if self.object.is_some() {
            self.draft.warn(&Place::File, "the last solid has no `endsolid`; the file may be cut off");
        }
        let lines = self.lines;
        self.draft.finish(|k| lines.get(k).map_or(Place::File, |&line| Place::Line(line)), |_| None)
    }
}

/// Takes a word off the rest of a line, which starts with none of the blanks that follow it.
fn take_word<'a>(rest: &mut &'a str) -> &'a str {
    let (word, after) = rest.split_at(rest.find(is_blank).unwrap_or(rest.len()));
    *rest = after.trim_start_matches(is_blank);
    word
}
