//! Unfinished solutions, kept to go on from.

use crate::io::digest::Digest;
use crate::radiosity::SolverState;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};

/// The schema's name.
pub const STATE_SCHEMA: &str = "nusselt.radiosity-state/3";

/// What a state belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StateKey {
    /// Of the patches ([`scene_digest`](crate::io::matrix::scene_digest)), before any is halved.
    pub patches: Digest,
    /// Of what they emit and reflect.
    pub materials: Digest,
    /// The tolerance of form factors.
    pub tolerance: f64,
    /// Whether patches overshoot.
    pub overshoot: bool,
    /// If patches are halved: those on which radiosities differ by more than this part, when so much is left to be sent.
    pub halving: Option<HalvingKey>,
}

/// What it depends on which patches are halved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HalvingKey {
    /// The part by which radiosities of one patch may differ.
    pub gradient: f64,
    /// The part of the emitted power that is left when that is looked at.
    pub until: f64,
}

impl StateKey {
    /// Of a scene of patches, solved to this tolerance without overshooting or halving.
    pub fn new(scene: &crate::scene::Scene, tolerance: f64) -> Self {
        let materials = scene.polygons().fold(Digest::EMPTY, |digest, polygon| {
            let material = polygon.material();
            let [reflected, _] = material.reflectances().unwrap_or_default();
            let colours = [reflected.to_array(), material.emission];
            colours.iter().flatten().fold(digest, |digest, x| digest.with(&x.to_bits().to_le_bytes()))
        });
        let patches = crate::io::matrix::scene_digest(scene);
        Self { patches, materials, tolerance, overshoot: false, halving: None }
    }
}

/// What is kept of an unfinished solution.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeptState {
    /// The patches that were halved, ascending, time by time.
    pub halved: Vec<Vec<u32>>,
    /// The solution for the patches after that.
    pub solver: SolverState,
}

/// Why a state cannot be gone on from.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StateError {
    /// It is no state, or one of another version.
    #[error("it is not a state of this version: {0}; leave out --resume to start anew")]
    Malformed(String),
    /// Its numbers are not those that were written.
    #[error("some of its numbers have been changed or damaged; leave out --resume to start anew")]
    Damaged,
    /// It belongs to something else.
    #[error("it is for {what}; leave out --resume to start anew")]
    Other {
        /// What is different.
        what: &'static str,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Kept {
    schema: String,
    key: StateKey,
    halved: Vec<Vec<u32>>,
    shots: usize,
    gone: [[f64; 3]; 3],
    radiosity: Vec<[f64; 3]>,
    unshot: Vec<[f64; 3]>,
    guess: Vec<[f64; 3]>,
    guessed: usize,
    groups: Vec<u32>,
    /// Of all numbers above: against accidents, not against forgery.
    digest: Digest,
}

impl Kept {
    fn numbers(&self) -> Digest {
        let whole = |digest: Digest, number: usize| digest.with(&(number as u64).to_le_bytes());
        let colours = |digest: Digest, list: &[[f64; 3]]| {
            list.iter().flatten().fold(whole(digest, list.len()), |digest, x| digest.with(&x.to_bits().to_le_bytes()))
        };
        let patches = |digest: Digest, list: &Vec<u32>| {
            list.iter().fold(whole(digest, list.len()), |digest, &patch| whole(digest, patch as usize))
        };
        let digest = self.halved.iter().fold(whole(Digest::EMPTY, self.halved.len()), patches);
        let digest = patches(digest, &self.groups);
        let digest = [self.shots, self.guessed].into_iter().fold(digest, whole);
        [&self.gone[..], &self.radiosity, &self.unshot, &self.guess].into_iter().fold(digest, colours)
    }
}

/// Writes a state.
///
/// # Errors
/// Those of `out`.
pub fn write_state(key: &StateKey, halved: &[Vec<u32>], solver: &SolverState, out: &mut impl Write) -> io::Result<()> {
    let list = |colours: &[DVec3]| colours.iter().map(DVec3::to_array).collect();
    let mut kept = Kept {
        schema: STATE_SCHEMA.to_owned(),
        key: *key,
        halved: halved.to_vec(),
        shots: solver.shots,
        gone: solver.gone.map(|power| power.to_array()),
        radiosity: list(&solver.radiosity),
        unshot: list(&solver.unshot),
        guess: list(&solver.guess),
        guessed: solver.guessed,
        groups: solver.groups.clone(),
        digest: Digest::EMPTY,
    };
    kept.digest = kept.numbers();
    serde_json::to_writer(out, &kept).map_err(io::Error::from)
}

/// Reads a state that belongs to `key`. Takes any text.
///
/// # Errors
/// If it is no state, or that of something else.
pub fn read_state(key: &StateKey, text: &str) -> Result<KeptState, StateError> {
    let kept: Kept = serde_json::from_str(text).map_err(|error| StateError::Malformed(error.to_string()))?;
    if kept.schema != STATE_SCHEMA {
        return Err(StateError::Malformed(format!("its schema is {:?}", kept.schema)));
    }
    let differs = [
        (kept.key.patches != key.patches, "another scene, or other patches"),
        (kept.key.materials != key.materials, "other materials"),
        (kept.key.tolerance.to_bits() != key.tolerance.to_bits(), "another tolerance"),
        (kept.key.overshoot != key.overshoot, "another --overshoot"),
        (kept.key.halving != key.halving, "another --subdivide, --gradient or --until"),
    ];
    if let Some((_, what)) = differs.into_iter().find(|(differs, _)| *differs) {
        return Err(StateError::Other { what });
    }
    if kept.digest != kept.numbers() {
        return Err(StateError::Damaged);
    }
    let list = |colours: Vec<[f64; 3]>| colours.into_iter().map(DVec3::from).collect();
    let solver = SolverState {
        radiosity: list(kept.radiosity),
        unshot: list(kept.unshot),
        gone: kept.gone.map(DVec3::from),
        shots: kept.shots,
        guess: list(kept.guess),
        guessed: kept.guessed,
        groups: kept.groups,
    };
    Ok(KeptState { halved: kept.halved, solver })
}
