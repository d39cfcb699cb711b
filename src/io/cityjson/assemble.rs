//! From city objects to faces.

use super::super::draft::{Draft, Unfolding};
use super::super::error::Place;
use super::super::number::shown;
use super::super::{Loaded, ReadError, ReadOptions};
use super::boundary::{Surface, depth, surfaces};
use super::coordinates::{Coordinates, Placing};
use super::json::{CityObject, Geometry, Model};
use super::lod::Lod;
use crate::scene::{Material, MaterialId, ObjectId};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// Builds the scene of a file of so many bytes.
pub(super) fn assemble(
    model: &Model,
    size: usize,
    options: &ReadOptions,
    mut draft: Draft<'_>,
) -> Result<Loaded, ReadError> {
    let prepared = prepare(model, options);
    let (coordinates, wanted) = match prepared {
        Ok(prepared) => prepared,
        Err((place, what)) => {
            draft.fault(place, what);
            return Err(draft.into_error());
        }
    };
    if let Err((id, what)) = check_size(model, size, wanted) {
        draft.fault(Place::Item(city_object(id)), what);
        return Err(draft.into_error());
    }
    for (k, &vertex) in model.vertices.iter().enumerate() {
        draft.add_vertex(coordinates.point(vertex), || Place::Item(format!("vertex {k}")));
    }
    let mut assembly = Assembly {
        model,
        coordinates,
        draft,
        materials: HashMap::new(),
        templates: HashMap::new(),
        runs: Vec::new(),
        count: 0,
        ignored: 0,
        without_level: 0,
    };
    let mut ids = HashSet::new();
    for (number, (id, object)) in model.city_objects.0.iter().enumerate() {
        if !ids.insert(id) {
            assembly.draft.fault(Place::Item(city_object(id)), "the file has two city objects with this id");
        }
        assembly.add_object(number, id, object, wanted);
    }
    assembly.finish(wanted)
}

/// What coordinates are, and which level of detail is wanted.
fn prepare(model: &Model, options: &ReadOptions) -> Result<(Coordinates, Option<Lod>), (Place, String)> {
    let coordinates =
        Coordinates::of(model, options.origin).map_err(|what| (Place::Item("transform".to_owned()), what))?;
    let Some(name) = &options.lod else { return Ok((coordinates, None)) };
    let wanted = Lod::named(name)
        .ok_or_else(|| (Place::File, format!("{} is no level of detail; one is written like 2 or 2.2", shown(name))))?;
    let mut levels: Vec<Lod> = Vec::new();
    for lod in model.city_objects.0.iter().flat_map(|(_, object)| levels_of(model, object)) {
        if lod == wanted {
            return Ok((coordinates, Some(wanted)));
        }
        // Enough to name.
        if levels.len() < 16 && !levels.contains(&lod) {
            levels.push(lod);
        }
    }
    levels.sort_by(|a, b| a.compare(*b));
    let known: Vec<String> = levels.iter().map(ToString::to_string).collect();
    let known = if known.is_empty() { "none is given".to_owned() } else { format!("there are {}", known.join(", ")) };
    Err((Place::File, format!("nothing has the level of detail {wanted}; {known}")))
}

/// Checks that the instances of templates do not unfold to too much; otherwise says with which city object they do.
fn check_size(model: &Model, size: usize, wanted: Option<Lod>) -> Result<(), (&str, String)> {
    let templates = model.templates.iter().flat_map(|templates| &templates.templates);
    // Templates that cannot be used are faults of their instances.
    let size_of = |template| surfaces(template).map_or(0, |surfaces| surfaces.iter().map(Surface::size).sum());
    let sizes: Vec<u64> = templates.map(size_of).collect();
    let mut limit = Unfolding::of(size as u64);
    for (id, object) in &model.city_objects.0 {
        let level = wanted.or_else(|| highest(model, object));
        for geometry in object.geometry.iter().flatten().filter(|geometry| is_instance(geometry)) {
            let known = geometry.template.and_then(|template| sizes.get(template));
            if let Some(&size) = known.filter(|_| self::level(model, geometry) == level) {
                limit.take(size).map_err(|what| (id.as_str(), what))?;
            }
        }
    }
    Ok(())
}

/// The highest level of detail of a city object.
fn highest(model: &Model, object: &CityObject) -> Option<Lod> {
    levels_of(model, object).max_by(|a, b| a.compare(*b))
}

/// The levels of detail of what has surfaces.
fn levels_of<'a>(model: &'a Model, object: &'a CityObject) -> impl Iterator<Item = Lod> {
    let geometries = object.geometry.iter().flatten().filter(|geometry| shape(model, geometry).is_some());
    geometries.filter_map(|geometry| level(model, geometry))
}

/// The geometry that has the surfaces: itself, or the template of an instance. `None` if it has none, as points have.
fn shape<'a>(model: &'a Model, geometry: &'a Geometry) -> Option<&'a Geometry> {
    let shape =
        if is_instance(geometry) { model.templates.as_ref()?.templates.get(geometry.template?)? } else { geometry };
    depth(&shape.r#type).map(|_| shape)
}

fn is_instance(geometry: &Geometry) -> bool {
    geometry.r#type == "GeometryInstance"
}

fn level(model: &Model, geometry: &Geometry) -> Option<Lod> {
    geometry.lod.or_else(|| shape(model, geometry)?.lod)
}

fn city_object(id: &str) -> String {
    format!("city object {}", shown(id))
}

/// Faces that follow each other: the surfaces of one geometry.
struct Run {
    first: usize,
    object: usize,
    geometry: usize,
}

struct Assembly<'a, 'd> {
    model: &'a Model,
    coordinates: Coordinates,
    draft: Draft<'d>,
    materials: HashMap<&'a str, MaterialId>,
    /// The surfaces of the templates that were used, by their numbers.
    templates: HashMap<usize, Result<Rc<Vec<Surface<'a>>>, String>>,
    runs: Vec<Run>,
    /// How many faces there are.
    count: usize,
    /// How many geometries are points, lines or unknown.
    ignored: usize,
    /// How many city objects have no geometry of the level that is wanted.
    without_level: usize,
}

impl<'a> Assembly<'a, '_> {
    /// Adds the geometries of a city object.
    fn add_object(&mut self, number: usize, id: &str, object: &'a CityObject, wanted: Option<Lod>) {
        let model = self.model;
        let Some(geometries) = object.geometry.as_ref().filter(|list| !list.is_empty()) else { return };
        let level = wanted.or_else(|| highest(model, object));
        let mut object_id: Option<ObjectId> = None;
        let mut is_other_level = false;
        for (place, geometry) in geometries.iter().enumerate() {
            let run = Run { first: self.count, object: number, geometry: place };
            let instance = match self.instance(geometry) {
                Ok(instance) => instance,
                Err(what) => {
                    self.draft.fault(Place::Item(format!("{}, geometry {place}", city_object(id))), what);
                    continue;
                }
            };
            let Some(shape) = shape(model, geometry) else {
                self.ignored += 1;
                continue;
            };
            if self::level(model, geometry) != level {
                is_other_level = true;
                continue;
            }
            self.runs.push(run);
            let surfaces = match self.surfaces(geometry, shape) {
                Ok(surfaces) => surfaces,
                Err(what) => {
                    self.draft.fault(Place::Item(format!("{}, geometry {place}", city_object(id))), what);
                    continue;
                }
            };
            let object_id = *object_id.get_or_insert_with(|| self.draft.builder.add_object(id));
            for surface in &*surfaces {
                self.add_surface(surface, instance.as_ref(), object_id, surface.kind.unwrap_or(&object.r#type));
            }
        }
        self.without_level += usize::from(object_id.is_none() && is_other_level);
    }

    /// The surfaces of a geometry. Those of a template are collected once, as it may be used very often.
    fn surfaces(&mut self, geometry: &'a Geometry, shape: &'a Geometry) -> Result<Rc<Vec<Surface<'a>>>, String> {
        let collect = || surfaces(shape).map(Rc::new);
        match geometry.template.filter(|_| is_instance(geometry)) {
            Some(template) => self.templates.entry(template).or_insert_with(collect).clone(),
            None => collect(),
        }
    }

    /// Where a template is put, if the geometry is an instance of one.
    fn instance(&self, geometry: &Geometry) -> Result<Option<Placing>, String> {
        if !is_instance(geometry) {
            return Ok(None);
        }
        let templates = self.model.templates.as_ref().map_or(&[][..], |templates| &templates.templates);
        let template = geometry.template.ok_or("an instance takes a `template`")?;
        let Some(shape) = templates.get(template) else {
            return Err(format!("there is no template {template}; the file has {}", templates.len()));
        };
        if is_instance(shape) {
            return Err(format!("template {template} is an instance itself"));
        }
        let matrix = geometry.matrix.as_ref().ok_or("an instance takes a `transformationMatrix`")?;
        let at = geometry.boundaries.only().ok_or("the `boundaries` of an instance take one vertex")?;
        let Some(&vertex) = self.model.vertices.get(at) else {
            return Err(format!("there is no vertex {at}; the file has {}", self.model.vertices.len()));
        };
        self.coordinates.placing(matrix, self.coordinates.point(vertex)).map(Some)
    }

    fn add_surface(&mut self, surface: &Surface<'_>, placing: Option<&Placing>, object: ObjectId, kind: &'a str) {
        let draft = &mut self.draft;
        let material = *self.materials.entry(kind).or_insert_with(|| draft.builder.add_material(Material::new(kind)));
        let number = self.count;
        self.count += 1;
        let model = self.model;
        let templates = model.templates.as_ref().map_or(&[][..], |templates| &templates.vertices);
        let count = if placing.is_some() { templates.len() } else { model.vertices.len() };
        let (mut rings, broken) = surface.rings(count);
        if let Some(what) = &broken {
            self.draft.refuse_face(place(model, &self.runs, number), what);
        }
        if let Some(placing) = placing {
            for ring in &mut rings {
                for corner in &mut *ring {
                    let place = || place(model, &self.runs, number);
                    *corner = self.draft.add_vertex(placing.point(templates[*corner]), place);
                }
                if placing.is_mirrored {
                    ring.reverse();
                }
            }
        }
        match broken {
            None => self.draft.add_face(rings, object, material),
            Some(why) => self.draft.add_broken_face(why, rings, object, material),
        }
    }

    fn finish(mut self, wanted: Option<Lod>) -> Result<Loaded, ReadError> {
        if self.ignored > 0 {
            let count = self.ignored;
            self.draft.warn(&Place::File, format_args!("{count} geometries without surfaces were ignored"));
        }
        if let Some(level) = wanted
            && self.without_level > 0
        {
            let count = self.without_level;
            self.draft.warn(&Place::File, format_args!("{count} city objects have no level of detail {level}"));
        }
        let (model, runs) = (self.model, self.runs);
        self.draft.finish(|k| place(model, &runs, k), |_| None)
    }
}

/// Where a face is in the file.
fn place(model: &Model, runs: &[Run], face: usize) -> Place {
    let run = runs.partition_point(|run| run.first <= face).checked_sub(1).and_then(|run| runs.get(run));
    let Some(Run { first, object, geometry }) = run else { return Place::File };
    let id = model.city_objects.0.get(*object).map_or("", |(id, _)| id);
    Place::Item(format!("{}, geometry {geometry}, surface {}", city_object(id), face - first))
}
