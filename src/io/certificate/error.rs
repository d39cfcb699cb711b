//! What can go wrong when a kept certificate is read.

use super::super::error::advice;
use super::rows::SceneSize;
use std::path::PathBuf;

/// Why a kept certificate could not be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CertificateError {
    /// The file could not be opened or read.
    #[error("cannot read {}: {source}{}", path.display(), advice(source))]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// What the file contains is not a certificate, or a damaged one.
    #[error("{file}: it is no certificate, or a damaged one: {what}; make it anew with contour --certificate")]
    Invalid {
        /// The name of the file.
        file: String,
        /// The item, what is wrong with it, and where.
        what: String,
    },
    /// It was made for a scene of another size.
    #[error("{file}: it was made for a scene of {made_for}, but this one has {found}; name the scene it was made for")]
    OtherScene {
        /// The name of the file.
        file: String,
        /// The size of the scene it was made for, as the file says.
        made_for: SceneSize,
        /// The size of the scene at hand.
        found: SceneSize,
    },
}
