//! Projects GGX onto spherical harmonics and writes the table: `cargo run --release --example project_sh -- ROUGHNESS BAND FILE`.

use glam::DVec3;
use nusselt::brdf::{Fresnel, Ggx, ShBrdf, ShSymmetry};
use nusselt::io::write_sh;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [roughness, band, file] = &arguments[..] else {
        return Err("usage: project_sh ROUGHNESS BAND FILE".into());
    };
    let (roughness, band) = (roughness.parse()?, band.parse()?);
    let ggx = Ggx::new(Fresnel::schlick(DVec3::splat(0.9))?, roughness, roughness)?;
    let projected = ShBrdf::project(&ggx, ShSymmetry::Isotropic, band)?;
    let [off, largest, size] = [projected.rms_error, projected.largest_error, projected.rms].map(|rgb| rgb.x);
    println!(
        "off by {:.2}% in the root mean square ({off:.4} of {size:.4} sr^-1), {largest:.4} at most",
        100.0 * off / size
    );
    write_sh(Path::new(file), &projected.brdf)?;
    Ok(())
}
