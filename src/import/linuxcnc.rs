//! LinuxCNC: `lineardeltakins`, `rotarydeltakins` and `tripodkins`.

use super::{Files, ImportError, Imported};
use std::path::PathBuf;

/// The design that LinuxCNC files describe.
///
/// # Errors
/// Always.
pub fn linuxcnc(
    _files: &dyn Files,
    paths: &[PathBuf],
    _ignore: &[String],
) -> Result<Imported, ImportError> {
    Err(ImportError::Files { found: paths.len(), expected: "none yet" })
}
