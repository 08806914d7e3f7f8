//! A render's fingerprint: one hash of its settings and of the contents of every file it was read from.

use crate::error::{Error, Result};
use std::path::PathBuf;

/// BLAKE3 of `settings` and the inputs' contents, in order, as 64 hexadecimal digits. Names of files do not
/// count: a moved scene keeps its fingerprint. Files that cannot be read (missing textures) count as absent.
///
/// # Errors
/// [`Error::Io`] when a file that can be opened fails while it is read.
pub fn fingerprint(inputs: &[PathBuf], settings: &str) -> Result<String> {
    let mut all = blake3::Hasher::new();
    all.update(blake3::hash(settings.as_bytes()).as_bytes());
    for path in inputs {
        if !path.is_file() {
            all.update(b"absent");
            continue;
        }
        // Each file by its own hash: no two lists of files run together into the same bytes.
        let mut file = blake3::Hasher::new();
        file.update_mmap_rayon(path).map_err(|e| Error::io(path, "read", e))?;
        all.update(file.finalize().as_bytes());
    }
    Ok(all.finalize().to_hex().to_string())
}
