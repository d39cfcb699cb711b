//! The grammar of `--brdf`.

use super::{BrdfSpec, Part};
use glam::DVec3;
use nusselt::brdf::{
    AshikhminShirley, Blinn, Brdf, BrdfError, Fresnel, Ggx, GgxLtc, Lafortune, Lambert, MetallicRoughness, Mirror,
    OrenNayar, Phong, Ward,
};
use std::path::PathBuf;
use std::sync::Arc;

impl BrdfSpec {
    /// Of a specification; otherwise what is wrong with it and what was expected.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let parts = split(text).into_iter().map(part).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { parts })
    }
}

/// The parts of a sum. A + before a digit belongs to a number (1e+5).
fn split(text: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let mut start = 0;
    for (at, _) in text.match_indices('+') {
        let next = &text[at + 1..];
        if !next.starts_with(|c: char| c.is_ascii_digit()) {
            parts.push(&text[start..at]);
            start = at + 1;
        }
    }
    parts.push(&text[start..]);
    parts
}

/// One model.
fn part(text: &str) -> Result<Part, String> {
    let mut fields = text.split(':');
    let name = fields.next().unwrap_or_default();
    let fields = Fields { name, fields: fields.collect() };
    let model: Arc<dyn Brdf> = match name {
        "material" => {
            fields.expect(0..=0, "material")?;
            return Ok(Part::Material);
        }
        "lambert" => {
            fields.expect(1..=1, "lambert:RHO")?;
            fields.made(Lambert::new(fields.colour(0)?))?
        }
        "oren-nayar" => {
            fields.expect(2..=2, "oren-nayar:SIGMA:RHO")?;
            fields.made(OrenNayar::new(fields.colour(1)?, fields.number(0)?))?
        }
        "phong" => {
            fields.expect(1..=2, "phong:N[:RHO]")?;
            fields.made(Phong::new(fields.colour_or(1, DVec3::ONE)?, fields.number(0)?))?
        }
        "blinn" => {
            fields.expect(1..=2, "blinn:N[:RHO]")?;
            fields.made(Blinn::new(fields.colour_or(1, DVec3::ONE)?, fields.number(0)?))?
        }
        "lafortune" => {
            fields.expect(2..=3, "lafortune:CX,CY,CZ:N[:RHO]")?;
            let [x, y, z] = fields.numbers::<3>(0)?;
            fields.made(Lafortune::new(fields.colour_or(2, DVec3::ONE)?, DVec3::new(x, y, z), fields.number(1)?))?
        }
        "ward" => {
            fields.expect(1..=2, "ward:A[,A][:RHO]")?;
            let [x, y] = fields.pair(0)?;
            fields.made(Ward::new(fields.colour_or(1, DVec3::ONE)?, x, y))?
        }
        "ashikhmin" => {
            fields.expect(2..=3, "ashikhmin:N[,N]:RS[:RD]")?;
            let [x, y] = fields.pair(0)?;
            fields.made(AshikhminShirley::new(fields.colour_or(2, DVec3::ZERO)?, fields.colour(1)?, x, y))?
        }
        "ggx" => {
            fields.expect(1..=2, "ggx:A[,A][:FRESNEL]")?;
            let [x, y] = fields.pair(0)?;
            fields.made(Ggx::new(fields.fresnel(1)?, x, y))?
        }
        "mirror" => {
            fields.expect(0..=1, "mirror[:FRESNEL]")?;
            Arc::new(Mirror::new(fields.fresnel(0)?))
        }
        "gltf" => {
            fields.expect(3..=3, "gltf:BASE:METALLIC:ROUGHNESS")?;
            fields.made(MetallicRoughness::new(fields.colour(0)?, fields.number(1)?, fields.number(2)?))?
        }
        "ltc" => {
            fields.expect(1..=2, "ltc:A[:RHO]")?;
            fields.made(GgxLtc::new(fields.colour_or(1, DVec3::ONE)?, fields.number(0)?))?
        }
        "merl" => return Ok(Part::Merl(fields.file("merl:FILE")?)),
        "sh" => return Ok(Part::Sh(fields.file("sh:FILE")?)),
        "" => return Err("a model is missing; --help lists them".to_owned()),
        _ => {
            let known = "lambert, oren-nayar, phong, blinn, lafortune, ward, ashikhmin, ggx, ltc, mirror, gltf, merl, \
                         sh and material";
            return Err(format!("there is no model {name:?}; there are {known}"));
        }
    };
    Ok(Part::Model(model))
}

/// What follows the name of a model.
struct Fields<'a> {
    name: &'a str,
    fields: Vec<&'a str>,
}

impl Fields<'_> {
    fn expect(&self, count: std::ops::RangeInclusive<usize>, form: &str) -> Result<(), String> {
        if count.contains(&self.fields.len()) { Ok(()) } else { Err(format!("it takes the form {form}")) }
    }

    /// All that follows: a name may have colons.
    fn file(&self, form: &str) -> Result<PathBuf, String> {
        let name = self.fields.join(":");
        if name.is_empty() { Err(format!("it takes the form {form}")) } else { Ok(PathBuf::from(name)) }
    }

    fn made<B: Brdf + 'static>(&self, made: Result<B, BrdfError>) -> Result<Arc<dyn Brdf>, String> {
        Ok(Arc::new(made.map_err(|error| format!("{}: {error}", self.name))?))
    }

    /// The numbers of a field, one to so many.
    fn list(&self, at: usize, most: usize) -> Result<Vec<f64>, String> {
        numbers(self.fields[at], most).map_err(|what| format!("{}: {what}", self.name))
    }

    fn number(&self, at: usize) -> Result<f64, String> {
        Ok(self.list(at, 1)?[0])
    }

    fn numbers<const N: usize>(&self, at: usize) -> Result<[f64; N], String> {
        let list = self.list(at, N)?;
        let text = self.fields[at];
        list.try_into()
            .map_err(|_| format!("{}: it takes {N} numbers with commas between them, not {text:?}", self.name))
    }

    /// Two numbers, or one for both.
    fn pair(&self, at: usize) -> Result<[f64; 2], String> {
        let list = self.list(at, 2)?;
        Ok([list[0], list[list.len() - 1]])
    }

    fn colour(&self, at: usize) -> Result<DVec3, String> {
        colour(self.fields[at]).map_err(|what| format!("{}: {what}", self.name))
    }

    fn colour_or(&self, at: usize, default: DVec3) -> Result<DVec3, String> {
        if at < self.fields.len() { self.colour(at) } else { Ok(default) }
    }

    fn fresnel(&self, at: usize) -> Result<Fresnel, String> {
        let Some(&text) = self.fields.get(at) else { return Ok(Fresnel::ALL) };
        fresnel(text).map_err(|what| format!("{}: {what}", self.name))
    }
}

fn fresnel(text: &str) -> Result<Fresnel, String> {
    let made = match text.strip_prefix("ior=") {
        None if text == "all" => return Ok(Fresnel::ALL),
        None => Fresnel::schlick(colour(text)?),
        Some(index) => match index.split_once(";k=") {
            None => Fresnel::dielectric(numbers(index, 1)?[0]),
            Some((index, absorption)) => Fresnel::conductor(colour(index)?, colour(absorption)?),
        },
    };
    made.map_err(|error| error.to_string())
}

/// Three numbers, or one for all three.
pub(crate) fn colour(text: &str) -> Result<DVec3, String> {
    match numbers(text, 3)?[..] {
        [grey] => Ok(DVec3::splat(grey)),
        [red, green, blue] => Ok(DVec3::new(red, green, blue)),
        _ => Err(format!("a colour takes one number or three, R,G,B, not {text:?}")),
    }
}

fn numbers(text: &str, most: usize) -> Result<Vec<f64>, String> {
    let list = text.split(',').map(crate::args::parse_number).collect::<Result<Vec<_>, _>>()?;
    if list.len() > most {
        let many = if most == 1 { "one number".to_owned() } else { format!("at most {most} numbers") };
        return Err(format!("it takes {many}, not {text:?}"));
    }
    Ok(list)
}
