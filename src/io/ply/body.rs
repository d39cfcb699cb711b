//! The body of a PLY file: vertices, faces and strips of triangles.

use super::super::draft::Draft;
use super::super::error::Place;
use super::super::number::shown;
use super::super::{Loaded, ReadError};
use super::header::{Element, Header, Kind};
use super::source::{LeftOver, Missing, Source, whole};
use crate::scene::Material;
use glam::DVec3;

/// What an element is read for, with the places of its properties.
#[derive(Clone, Copy)]
enum Role {
    Vertex([usize; 3]),
    Face(usize),
    Strips(usize),
    None,
}

/// A face as the file has it.
struct Face {
    /// Those corners that can be read.
    ring: Vec<usize>,
    /// What is wrong with it, at first.
    broken: Option<String>,
    origin: Origin,
}

/// Where a face is: its line in text, else its number among those of its element.
#[derive(Clone, Copy)]
enum Origin {
    Line(usize),
    Face(usize),
    Strips(usize),
}

impl Origin {
    fn place(self) -> Place {
        match self {
            Self::Line(line) => Place::Line(line),
            Self::Face(k) => Place::Item(format!("face {k}")),
            Self::Strips(k) => Place::Item(format!("tristrips {k}")),
        }
    }
}

struct Reader<'a> {
    draft: Draft<'a>,
    source: Source<'a>,
    vertex_count: usize,
    faces: Vec<Face>,
    /// The numbers of the element that are of interest.
    numbers: Vec<f64>,
    /// The first line with more in it than its element takes, and how many there are.
    surplus: Option<usize>,
    surplus_count: usize,
}

pub(super) fn parse<'a>(header: &Header<'a>, draft: Draft<'a>) -> Result<Loaded, ReadError> {
    let source = Source::new(header.encoding, header.body, header.lines);
    let mut reader = Reader {
        draft,
        source,
        vertex_count: 0,
        faces: Vec::new(),
        numbers: Vec::new(),
        surplus: None,
        surplus_count: 0,
    };
    for element in &header.elements {
        if let Err((place, what)) = reader.read_elements(element) {
            reader.draft.fault(place, what);
            return Err(reader.draft.into_error());
        }
    }
    reader.warn();
    reader.finish()
}

impl Reader<'_> {
    /// Reads all elements of a kind; an error if nothing after it can be read.
    fn read_elements(&mut self, element: &Element) -> Result<(), (Place, String)> {
        let role = role(element).map_err(|what| (Place::Line(element.line), what))?;
        let name = shown(&element.name);
        let least = element.least_size();
        if least == 0 {
            // Nothing is written for elements without properties, however many there are said to be.
            return Ok(());
        }
        let is_text = self.source.is_text();
        let most = self.source.bytes_left() / if is_text { 1 } else { least };
        if element.count > most {
            let what =
                format!("it promises {} elements {name}, but the file ends before; it may be cut off", element.count);
            return Err((Place::Line(element.line), what));
        }
        for k in 0..element.count {
            let result = self.source.begin().and_then(|()| self.read_numbers(element, role));
            let line = self.source.line;
            let place = || if is_text { Place::Line(line) } else { Place::Item(format!("{} {k}", element.name)) };
            match result {
                Ok(()) => {
                    self.add(role, k, place);
                    if self.source.has_surplus() {
                        self.surplus_count += 1;
                        self.surplus.get_or_insert(line);
                    }
                }
                Err(Missing::Bad(what)) if is_text => {
                    self.add_broken(role, k, place(), what);
                }
                Err(Missing::Bad(what)) => return Err((place(), what)),
                Err(Missing::End) => {
                    let what = format!("the file ends in element {k} of {} {name}; it may be cut off", element.count);
                    return Err((Place::File, what));
                }
            }
        }
        Ok(())
    }

    /// Reads an element, and keeps the numbers that its role needs.
    fn read_numbers(&mut self, element: &Element, role: Role) -> Result<(), Missing> {
        self.numbers.clear();
        self.numbers.resize(if let Role::Vertex(_) = role { 3 } else { 0 }, 0.0);
        for (k, property) in element.properties.iter().enumerate() {
            match (property.kind, role) {
                (Kind::Number(kind), Role::Vertex(places)) if places.contains(&k) => {
                    let number = self.source.number(kind)?;
                    for (_, coordinate) in places.iter().zip(&mut self.numbers).filter(|(place, _)| **place == k) {
                        *coordinate = number;
                    }
                }
                (Kind::Number(kind), _) => self.source.skip(kind, 1)?,
                (Kind::List { length, item }, Role::Face(place) | Role::Strips(place)) if place == k => {
                    let length = self.source.length(length)?;
                    for _ in 0..length {
                        let number = self.source.number(item)?;
                        self.numbers.push(number);
                    }
                }
                (Kind::List { length, item }, _) => {
                    let length = self.source.length(length)?;
                    self.source.skip(item, length)?;
                }
            }
        }
        Ok(())
    }

    /// Adds what the numbers of an element say.
    fn add(&mut self, role: Role, k: usize, place: impl Fn() -> Place) {
        match role {
            Role::Vertex(_) => {
                let position = DVec3::new(self.numbers[0], self.numbers[1], self.numbers[2]);
                self.draft.add_vertex(position, place);
                self.vertex_count += 1;
            }
            Role::Face(_) => {
                let (ring, broken) = indices(&self.numbers);
                if let Some(what) = &broken {
                    self.draft.refuse_face(place(), what);
                }
                let origin = self.origin(role, k);
                self.faces.push(Face { ring, broken, origin });
            }
            Role::Strips(_) => self.add_strips(k, place),
            Role::None => {}
        }
    }

    /// Adds the triangles of strips, which are separated by -1. Every second triangle is turned.
    #[expect(clippy::float_cmp, reason = "-1 is written exactly")]
    fn add_strips(&mut self, k: usize, place: impl Fn() -> Place) {
        let origin = self.origin(Role::Strips(0), k);
        let numbers = std::mem::take(&mut self.numbers);
        for strip in numbers.split(|&number| number == -1.0) {
            for (turn, corners) in strip.windows(3).enumerate() {
                let (mut ring, broken) = indices(corners);
                match &broken {
                    Some(what) => self.draft.refuse_face(place(), what),
                    None if turn % 2 == 1 => ring.swap(0, 1),
                    None => {}
                }
                self.faces.push(Face { ring, broken, origin });
            }
        }
    }

    /// Notes what is wrong with an element, and keeps its number.
    fn add_broken(&mut self, role: Role, k: usize, place: Place, what: String) {
        if let Role::Vertex(_) = role {
            self.draft.refuse_vertex(place, what);
            self.draft.builder.add_vertex(DVec3::NAN);
            self.vertex_count += 1;
            return;
        }
        if let Role::Face(_) = role {
            self.draft.refuse_face(place, &what);
            let origin = self.origin(role, k);
            let (ring, _) = indices(&self.numbers);
            self.faces.push(Face { ring, broken: Some(what), origin });
        } else {
            self.draft.fault(place, what);
        }
    }

    fn origin(&self, role: Role, k: usize) -> Origin {
        match role {
            _ if self.source.is_text() => Origin::Line(self.source.line),
            Role::Strips(_) => Origin::Strips(k),
            _ => Origin::Face(k),
        }
    }

    /// Says what is ignored though it may have been meant.
    fn warn(&mut self) {
        if let Some(line) = self.surplus {
            let count = self.surplus_count;
            let what = format_args!("more than its element takes was ignored, in {count} lines in all");
            self.draft.warn(&Place::Line(line), what);
        }
        match self.source.left_over() {
            LeftOver::Nothing => {}
            LeftOver::Line(line) => {
                self.draft.warn(&Place::Line(line), "what follows the last element was ignored");
            }
            LeftOver::Bytes(count) => {
                self.draft.warn(&Place::File, format_args!("the {count} bytes after the last element were ignored"));
            }
        }
    }

    fn finish(mut self) -> Result<Loaded, ReadError> {
        let object = self.draft.builder.add_object("default");
        let material = self.draft.builder.add_material(Material::new("default"));
        let count = self.vertex_count;
        let mut origins = Vec::with_capacity(self.faces.len());
        for Face { ring, broken, origin } in self.faces {
            origins.push(origin);
            let broken = broken.or_else(|| {
                let unknown = ring.iter().find(|&&index| index >= count)?;
                let known =
                    if count == 0 { "there are none".to_owned() } else { format!("they are 0 to {}", count - 1) };
                let what = format!("there is no vertex {unknown}; {known}");
                self.draft.refuse_face(origin.place(), &what);
                Some(what)
            });
            match broken {
                None => self.draft.add_face(vec![ring], object, material),
                Some(why) => self.draft.add_broken_face(why, vec![ring], object, material),
            }
        }
        self.draft.finish(|k| origins.get(k).map_or(Place::File, |origin| origin.place()), |_| None)
    }
}

/// The vertices that a face names, and what is wrong with what else it has.
fn indices(numbers: &[f64]) -> (Vec<usize>, Option<String>) {
    let ring: Vec<usize> = numbers.iter().copied().filter_map(whole).collect();
    let broken = match numbers.iter().find(|&&number| whole(number).is_none()) {
        _ if numbers.len() < 3 => Some(format!("a face takes at least 3 vertices, but here are {}", numbers.len())),
        Some(number) => Some(format!("{number} is not the index of a vertex")),
        None => None,
    };
    (ring, broken)
}

/// What an element is read for.
fn role(element: &Element) -> Result<Role, String> {
    let find = |name: &str| element.properties.iter().position(|property| property.name == name);
    let is_list = |k: usize| matches!(element.properties[k].kind, Kind::List { .. });
    match element.name.as_str() {
        "vertex" => {
            let mut places = [0; 3];
            for (place, name) in places.iter_mut().zip(["x", "y", "z"]) {
                *place = find(name)
                    .filter(|&k| !is_list(k))
                    .ok_or_else(|| format!("the vertices have no number `{name}`; they take x, y and z"))?;
            }
            Ok(Role::Vertex(places))
        }
        name @ ("face" | "tristrips") => {
            let mut lists = (0..element.properties.len()).filter(|&k| is_list(k));
            let only = lists.next().filter(|_| lists.next().is_none());
            let list = find("vertex_indices").or_else(|| find("vertex_index")).filter(|&k| is_list(k)).or(only);
            let list = list.ok_or_else(|| format!("the element {name} has no list `vertex_indices`"))?;
            Ok(if name == "face" { Role::Face(list) } else { Role::Strips(list) })
        }
        _ => Ok(Role::None),
    }
}
