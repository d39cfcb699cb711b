//! How a surface reflects, as it is said on the command line.

mod parse;

pub(crate) use parse::colour;

use crate::failure::Failure;
use crate::materials::Numbered;
use nusselt::brdf::{Brdf, Sum, Unmeasured};
use nusselt::io::{ReadError, read_merl, read_sh};
use std::path::PathBuf;
use std::sync::Arc;

/// The grammar, for `--help`.
pub(crate) const GRAMMAR: &str = "\
How a surface reflects (--brdf): one of these, or several with + between them. RHO, RS and RD are reflectances: one number from 0 to 1, or
R,G,B. N is an exponent from 0 to 1000000, A a roughness from 0.0001 to 10 (the a of the papers), along --tangent and across where two are given.
  lambert:RHO                     matt
  oren-nayar:SIGMA:RHO            rough and matt; SIGMA is the deviation of the slopes in radians
  phong:N[:RHO]                   energy-normalised lobe about the mirror direction; RHO is 1 if left out, here and below
  blinn:N[:RHO]                   lobe of the halfway vector
  lafortune:CX,CY,CZ:N[:RHO]      generalised cosine lobe; C = -1,-1,1 is phong
  ward:A[,A][:RHO]                Ward's model, in the form that conserves energy
  ashikhmin:N[,N]:RS[:RD]         Ashikhmin and Shirley; RD, of the base, is 0 if left out
  ggx:A[,A][:FRESNEL]             microfacets; FRESNEL is all (everything is reflected), a reflectance at normal incidence (Schlick),
                                  ior=N (a dielectric), or ior=N;k=K (a metal; N and K are numbers or R,G,B)
  ltc:A[:RHO]                     ggx as a linearly transformed cosine, A from 0.0025 to 1: fast, with its distance to ggx in the error
  mirror[:FRESNEL]                a smooth surface
  gltf:BASE:METALLIC:ROUGHNESS    metallic-roughness of glTF; BASE is a reflectance
  merl:FILE                       measurements in MERL's format; sh:FILE a table of spherical harmonics. Names of files have no +
  material                        what the scene says: of the polygon that --eye is on (reflect), or of the material it is given for (render)";

/// A sum of models.
#[derive(Clone)]
pub(crate) struct BrdfSpec {
    parts: Vec<Part>,
}

#[derive(Clone)]
enum Part {
    Model(Arc<dyn Brdf>),
    /// Measurements, and tables of spherical harmonics, in files.
    Merl(PathBuf),
    Sh(PathBuf),
    /// Of the polygon that one stands on.
    Material,
}

impl BrdfSpec {
    /// What it is on a surface of that material; `None` where one stands on no polygon.
    pub(crate) fn brdf(&self, material: Option<Numbered<'_>>) -> Result<Box<dyn Brdf>, Failure> {
        let mut parts = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            parts.push(part.brdf(material)?);
        }
        Ok(match parts.len() {
            1 => parts.swap_remove(0),
            _ => Box::new(Sum::new(parts)),
        })
    }

    /// True if the material of the polygon is asked for.
    pub(crate) fn has_material(&self) -> bool {
        self.parts.iter().any(|part| matches!(part, Part::Material))
    }
}

impl Part {
    fn brdf(&self, material: Option<Numbered<'_>>) -> Result<Box<dyn Brdf>, Failure> {
        match (self, material) {
            (Self::Model(model), _) => Ok(Box::new(model.clone())),
            (Self::Merl(path), _) => Ok(Box::new(read_merl(path, Unmeasured::default()).map_err(|error| refused(&error))?)),
            (Self::Sh(path), _) => Ok(Box::new(read_sh(path).map_err(|error| refused(&error))?)),
            (Self::Material, Some(material)) => material.brdf(),
            (Self::Material, None) => Err(Failure::Usage(
                "--brdf material is that of the polygon that --eye is on, and it is on none; give --on K, or another model"
                    .to_owned(),
            )),
        }
    }
}

fn refused(error: &ReadError) -> Failure {
    Failure::Work(error.to_string())
}
