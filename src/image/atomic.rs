//! Output files that appear whole or not at all: written beside the target, then renamed over it.
//!
//! Every file that glint writes goes through here. If anything fails (the disk is full, the process is
//! killed) the old file, if there was one, is still there, unchanged.

use crate::error::{Error, Result};
use atomic_write_file::{AtomicWriteFile, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes the file `path` by `write`, which gets a seekable file opened for reading and writing behind a
/// buffer. The file appears, synced to disk, when `write` has succeeded; a symbolic link is followed.
///
/// # Errors
/// [`Error::Io`] when the system refuses, or when `path` exists and is not a regular file (replacing a
/// device or a pipe by a file would destroy it); whatever `write` returns.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<AtomicWriteFile>) -> io::Result<()>,
) -> Result<()> {
    let failed = |source| Error::io(path, "write", source);
    let file = begin(path).map_err(failed)?;
    let mut writer = BufWriter::with_capacity(1 << 18, file);
    write(&mut writer).map_err(failed)?;
    writer.flush().map_err(failed)?;
    writer.into_inner().map_err(|e| failed(e.into_error()))?.commit().map_err(failed)
}

/// Whether [`write_whole`] could begin now: the folder is there and takes files. Leaves nothing behind.
///
/// # Errors
/// As [`write_whole`].
pub fn check_writable(path: &Path) -> Result<()> {
    begin(path).map(drop).map_err(|source| Error::io(path, "write", source))
}

/// A file beside the target, to be renamed over it.
fn begin(path: &Path) -> io::Result<AtomicWriteFile> {
    let target = path.canonicalize();
    let target = target.as_deref().unwrap_or(path);
    if target.exists() && !target.is_file() {
        let reason = "it exists and is not a regular file: name another output file";
        return Err(io::Error::new(io::ErrorKind::InvalidInput, reason));
    }
    OpenOptions::new().read(true).open(target)
}
