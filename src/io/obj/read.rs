//! The OBJ reader.

use super::super::draft::Draft;
use super::super::error::Place;
use super::super::lines::{Line, is_blank, lines};
use super::super::mtl::{self, Definition};
use super::super::number::{self, shown};
use super::super::{Loaded, ReadError, ReadOptions, read_regular};
use crate::scene::{Material, MaterialId, ObjectId};
use glam::DVec3;
use std::collections::{HashMap, HashSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Reads the bytes of an OBJ file, and the material files that it names beside it.
pub(in crate::io) fn read(path: &Path, bytes: &[u8], options: &ReadOptions) -> Result<Loaded, ReadError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut known: HashSet<PathBuf> = HashSet::new();
    let mut files = vec![path.to_owned()];
    let mut loaded = parse(bytes, &path.to_string_lossy(), options, |name| {
        let path = folder.join(name);
        let path = if path.exists() { path } else { folder.join(name.replace('\\', "/")) };
        // Each file once, whatever it is called.
        if known.contains(&fs::canonicalize(&path)?) {
            return Ok(Vec::new());
        }
        let bytes = read_regular(&path)?;
        known.insert(fs::canonicalize(&path)?);
        files.push(path);
        Ok(bytes)
    })?;
    loaded.files = files;
    Ok(loaded)
}

/// Reads the bytes of an OBJ file. `name` is what messages call it; `load` gives the bytes of the material
/// files it names. Takes any bytes. Of what `load` reads nothing is noted in [`Loaded::files`].
///
/// ```
/// use nusselt::io::{ReadOptions, obj};
/// let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no floor\nf 1 2 3 4\n";
/// let loaded = obj::parse(text, "floor.obj", &ReadOptions::default(), |_| Ok(Vec::new()))?;
/// assert_eq!(loaded.scene.objects(), ["floor"]);
///
/// let error = obj::parse(b"v 0 0 1e400\nf 1 2 3", "bad.obj", &ReadOptions::default(), |_| Ok(Vec::new())).unwrap_err();
/// assert!(error.to_string().starts_with("bad.obj:1: "));
/// # Ok::<(), nusselt::io::ReadError>(())
/// ```
///
/// # Errors
/// [`ReadError::Invalid`] with everything that is wrong.
pub fn parse(
    bytes: &[u8],
    name: &str,
    options: &ReadOptions,
    load: impl FnMut(&str) -> io::Result<Vec<u8>>,
) -> Result<Loaded, ReadError> {
    let mut reader = Reader::new(name, options, load);
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        reader.draft.fault(Place::File, "its text is UTF-16; save it as UTF-8");
        return Err(reader.draft.into_error());
    }
    for line in lines(bytes) {
        reader.read_line(&line);
    }
    reader.finish()
}

/// A face with the vertices as the file numbers them, from 0.
struct Face {
    line: usize,
    /// Those of them that can be read.
    ring: Vec<usize>,
    /// What is wrong with it, at first.
    broken: Option<String>,
    object: ObjectId,
    material: usize,
}

struct Reader<'a, L> {
    load: L,
    draft: Draft<'a>,
    vertex_count: usize,
    faces: Vec<Face>,
    object: Option<String>,
    group: Option<String>,
    /// The object of the next face, once it is known.
    current: Option<ObjectId>,
    /// The names of the materials that are used, and where they are in the list.
    used: Vec<String>,
    used_places: HashMap<String, usize>,
    material: Option<usize>,
    libraries: HashSet<String>,
    definitions: HashMap<String, (String, Definition)>,
    ignored: Option<(usize, String)>,
    ignored_count: usize,
}

/// Keywords that say nothing about the shape of a face.
const WITHOUT_EFFECT: &[&str] = &[
    "vt",
    "vn",
    "p",
    "l",
    "s",
    "mg",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "maplib",
    "usemap",
];

impl<'a, L: FnMut(&str) -> io::Result<Vec<u8>>> Reader<'a, L> {
    fn new(name: &'a str, options: &ReadOptions, load: L) -> Self {
        Self {
            load,
            draft: Draft::new(name, options),
            vertex_count: 0,
            faces: Vec::new(),
            object: None,
            group: None,
            current: None,
            used: Vec::new(),
            used_places: HashMap::new(),
            material: None,
            libraries: HashSet::new(),
            definitions: HashMap::new(),
            ignored: None,
            ignored_count: 0,
        }
    }

    fn read_line(&mut self, line: &Line<'_>) {
        let (keyword, rest) = line.split();
        match keyword {
            "v" => self.read_vertex(line.number, rest),
            "f" => self.read_face(line.number, rest),
            "o" => self.name_object(rest, true),
            "g" => self.name_object(rest, false),
            // As with `o` and `g`: no name is the default.
            "usemtl" => self.material = Some(self.use_material(if rest.is_empty() { "default" } else { rest })),
            "mtllib" => self.read_libraries(line.number, rest),
            _ if WITHOUT_EFFECT.contains(&keyword) => {}
            _ => {
                self.ignored_count += 1;
                self.ignored.get_or_insert_with(|| (line.number, shown(keyword)));
            }
        }
    }

    fn read_vertex(&mut self, line: usize, rest: &str) {
        let mut tokens = rest.split(is_blank).filter(|token| !token.is_empty());
        let mut position = [0.0; 3];
        for k in 0..3 {
            let result = match tokens.next() {
                Some(token) => number::parse(token),
                None => Err(format!("a vertex takes 3 coordinates, but here are {k}")),
            };
            match result {
                Ok(number) => position[k] = number,
                Err(what) => {
                    self.draft.refuse_vertex(Place::Line(line), what);
                    position = [f64::NAN; 3];
                    break;
                }
            }
        }
        self.draft.builder.add_vertex(DVec3::from(position));
        self.vertex_count += 1;
    }

    fn read_face(&mut self, line: usize, rest: &str) {
        let (ring, broken) = self.ring(rest);
        if let Some(what) = &broken {
            self.draft.refuse_face(Place::Line(line), what);
        }
        let object = self.current_object();
        let material = self.material.unwrap_or_else(|| self.use_material("default"));
        self.material = Some(material);
        self.faces.push(Face { line, ring, broken, object, material });
    }

    /// The corners that can be read, and what is wrong with the others.
    fn ring(&self, corners: &str) -> (Vec<usize>, Option<String>) {
        let mut ring = Vec::new();
        let mut broken = None;
        for token in corners.split(is_blank).filter(|token| !token.is_empty()) {
            match self.index(token) {
                Ok(index) => ring.push(index),
                Err(what) => broken = broken.or(Some(what)),
            }
        }
        if ring.len() < 3 && broken.is_none() {
            broken = Some(format!("a face takes at least 3 vertices, but here are {}", ring.len()));
        }
        ring.shrink_to_fit();
        (ring, broken)
    }

    /// The vertex that a corner of a face names, from 0. It may come later in the file.
    fn index(&self, token: &str) -> Result<usize, String> {
        let number = token.split('/').next().unwrap_or_default();
        let Ok(index) = number.parse::<i64>() else {
            return Err(format!("{} is not the index of a vertex; it takes a whole number", shown(token)));
        };
        let count = self.vertex_count;
        let back = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
        match index {
            0 => Err("there is no vertex 0; vertices are counted from 1".to_owned()),
            1.. => Ok(back - 1),
            _ => count
                .checked_sub(back)
                .ok_or_else(|| format!("vertex {index} from here on back: there are only {count} so far")),
        }
    }

    fn name_object(&mut self, name: &str, is_object: bool) {
        let name = Some(name.to_owned()).filter(|name| !name.is_empty());
        if is_object {
            self.object = name;
        } else {
            self.group = name;
        }
        self.current = None;
    }

    fn current_object(&mut self) -> ObjectId {
        let name = self.object.as_deref().or(self.group.as_deref()).unwrap_or("default");
        let builder = &mut self.draft.builder;
        *self.current.get_or_insert_with(|| builder.add_object(name))
    }

    fn use_material(&mut self, name: &str) -> usize {
        if let Some(&place) = self.used_places.get(name) {
            return place;
        }
        self.used.push(name.to_owned());
        self.used_places.insert(name.to_owned(), self.used.len() - 1);
        self.used.len() - 1
    }

    /// The rest of the line is one name with blanks in it, or several names.
    fn read_libraries(&mut self, line: usize, rest: &str) {
        if self.libraries.contains(rest) || self.read_library(rest).is_ok() {
            return;
        }
        for name in rest.split(is_blank).filter(|name| !name.is_empty()) {
            if self.libraries.contains(name) {
                continue;
            }
            if let Err(error) = self.read_library(name) {
                let name_shown = shown(name);
                self.draft.warn(&Place::Line(line), format_args!("no materials from {name_shown}: {error}"));
                self.libraries.insert(name.to_owned());
            }
        }
    }

    fn read_library(&mut self, name: &str) -> io::Result<()> {
        let bytes = (self.load)(name)?;
        self.libraries.insert(name.to_owned());
        for definition in mtl::parse(&bytes, name, &mut self.draft.faults, &mut self.draft.warnings) {
            let key = definition.material.name.clone();
            // The first definition counts, as it does for readers that stop at it.
            self.definitions.entry(key).or_insert_with(|| (name.to_owned(), definition));
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Loaded, ReadError> {
        let origins = self.add_materials();
        let lines = self.add_faces();
        if let Some((line, keyword)) = self.ignored {
            let count = self.ignored_count;
            self.draft.warn(
                &Place::Line(line),
                format_args!("{keyword} and what else is not known was ignored, {count} lines in all"),
            );
        }
        let face = |k: usize| lines.get(k).map_or(Place::File, |&line| Place::Line(line));
        let material = |k: usize| origins.get(k).cloned().flatten().map(|(file, line)| (file, Place::Line(line)));
        self.draft.finish(face, material)
    }

    /// Adds the materials that are used; for each the file and line that define it.
    fn add_materials(&mut self) -> Vec<Option<(String, usize)>> {
        let mut origins = Vec::new();
        let mut undefined = Vec::new();
        for name in &self.used {
            let (material, origin) = match self.definitions.get(name) {
                Some((file, definition)) => (definition.material.clone(), Some((file.clone(), definition.line))),
                None => (Material::new(name.clone()), None),
            };
            if origin.is_none() && name != "default" {
                undefined.push(name.as_str());
            }
            self.draft.builder.add_material(material);
            origins.push(origin);
        }
        if !undefined.is_empty() {
            let names: Vec<_> = undefined.iter().take(8).map(|name| shown(name)).collect();
            let more = if undefined.len() > names.len() { ", ..." } else { "" };
            let (count, names) = (undefined.len(), names.join(", "));
            let what = format!("{count} materials are defined nowhere, grey is taken for them: {names}{more}");
            self.draft.warn(&Place::File, what);
        }
        origins
    }

    /// Adds the faces; for each its line.
    fn add_faces(&mut self) -> Vec<usize> {
        let count = self.vertex_count;
        let mut lines = Vec::with_capacity(self.faces.len());
        for Face { line, ring, broken, object, material } in self.faces.drain(..) {
            let broken = broken.or_else(|| {
                let unknown = ring.iter().find(|&&index| index >= count)?;
                let what = format!("there is no vertex {}; the file has {count}", unknown + 1);
                self.draft.refuse_face(Place::Line(line), &what);
                Some(what)
            });
            lines.push(line);
            let material = MaterialId(material as u32);
            match broken {
                None => self.draft.add_face(vec![ring], object, material),
                Some(why) => self.draft.add_broken_face(why, vec![ring], object, material),
            }
        }
        lines
    }
}
