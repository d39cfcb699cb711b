//! The materials of the generated scenes.

use crate::scene::Material;

/// What a surface is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Paint {
    Wall,
    Ceiling,
    Floor,
    Lamp,
    Oak,
    Walnut,
    Metal,
    Fabric,
    Red,
    Blue,
    Yellow,
    Screen,
    Asphalt,
    Brick,
    Plaster,
    Concrete,
    Tiles,
    Sky,
}

impl Paint {
    /// The material, by the name of the paint in small letters.
    pub(super) fn material(self) -> Material {
        let (name, diffuse, emission) = match self {
            Self::Wall => ("wall", [0.8, 0.78, 0.72], 0.0),
            Self::Ceiling => ("ceiling", [0.85, 0.85, 0.85], 0.0),
            Self::Floor => ("floor", [0.45, 0.36, 0.27], 0.0),
            Self::Lamp => ("lamp", [0.8, 0.8, 0.8], 12.0),
            Self::Oak => ("oak", [0.6, 0.45, 0.28], 0.0),
            Self::Walnut => ("walnut", [0.3, 0.2, 0.13], 0.0),
            Self::Metal => ("metal", [0.5, 0.5, 0.52], 0.0),
            Self::Fabric => ("fabric", [0.35, 0.4, 0.45], 0.0),
            Self::Red => ("red", [0.65, 0.12, 0.1], 0.0),
            Self::Blue => ("blue", [0.12, 0.25, 0.6], 0.0),
            Self::Yellow => ("yellow", [0.75, 0.62, 0.12], 0.0),
            Self::Screen => ("screen", [0.05, 0.05, 0.06], 0.0),
            Self::Asphalt => ("asphalt", [0.15, 0.15, 0.16], 0.0),
            Self::Brick => ("brick", [0.5, 0.24, 0.18], 0.0),
            Self::Plaster => ("plaster", [0.75, 0.7, 0.6], 0.0),
            Self::Concrete => ("concrete", [0.45, 0.45, 0.44], 0.0),
            Self::Tiles => ("tiles", [0.45, 0.18, 0.12], 0.0),
            Self::Sky => ("sky", [0.0, 0.0, 0.0], 1.0),
        };
        Material { diffuse, emission: [emission; 3], ..Material::new(name) }
    }
}
