//! The command line program `nusselt`.

mod args;
mod brdf;
mod compare;
mod contour;
mod draw;
mod failure;
mod form_factors;
mod info;
mod input;
mod lighting;
mod materials;
mod output;
mod place;
mod point_factors;
mod progress;
mod proof;
mod radiosity;
mod reflect;
mod render;
mod repairs;
mod scene;
mod shadows;
mod summary;
mod verify;

use clap::Parser;
use failure::Failure;
use std::process::ExitCode;

/// Exact from-point visibility: what is seen from a point, and the form factors that follow from it.
#[derive(Parser)]
#[command(name = "nusselt", version, max_term_width = 100, after_help = "Every command has a --help with an example.")]
struct Program {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    common: args::Common,
}

#[derive(clap::Subcommand)]
enum Command {
    Info(info::Info),
    Contour(contour::Contour),
    #[command(name = "point-factors")]
    PointFactors(point_factors::PointFactorsOf),
    #[command(name = "form-factors")]
    FormFactors(form_factors::FormFactors),
    Radiosity(radiosity::Radiosity),
    Render(render::Render),
    Draw(draw::Draw),
    Shadows(shadows::ShadowsOf),
    Reflect(reflect::Reflect),
    Compare(compare::Compare),
    Verify(verify::Verify),
    Scene(scene::Scene),
}

impl Command {
    fn run(&self, common: &args::Common) -> Result<(), Failure> {
        match self {
            Self::Info(command) => command.run(common),
            Self::Contour(command) => command.run(common),
            Self::PointFactors(command) => command.run(common),
            Self::FormFactors(command) => command.run(common),
            Self::Radiosity(command) => command.run(common),
            Self::Render(command) => command.run(common),
            Self::Draw(command) => command.run(common),
            Self::Shadows(command) => command.run(common),
            Self::Reflect(command) => command.run(common),
            Self::Compare(command) => command.run(common),
            Self::Verify(command) => command.run(common),
            Self::Scene(command) => command.run(common),
        }
    }
}

fn main() -> ExitCode {
    let outcome = match Program::try_parse() {
        Ok(program) => program.common.start_threads().and_then(|()| program.command.run(&program.common)),
        Err(error) => failure::of_clap(&error),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure::report(&failure);
            match failure {
                Failure::Usage(_) => ExitCode::from(2),
                Failure::Work(_) => ExitCode::from(1),
            }
        }
    }
}
