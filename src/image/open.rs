//! Input files. Every file that a user names is opened here, and only if it is a regular one: reading a pipe
//! could wait for ever, reading a device would never end. Knows nothing of what is in them.

use crate::error::{Error, Result};
use std::fs::{File, FileType};
use std::io::{self, ErrorKind};
use std::os::unix::fs::FileTypeExt;
use std::path::Path;

/// Opens the regular file `path` for reading.
///
/// # Errors
/// [`Error::Io`] when the system refuses, or when `path` is anything but a regular file or a link to one.
pub fn open_regular(path: &Path) -> Result<File> {
    // Looked at before it is opened: opening a pipe waits for its writer.
    let opened = path.metadata().and_then(|metadata| match kind(metadata.file_type()) {
        None => File::open(path),
        Some((error, kind)) => {
            let advice = format!("this is not a regular file but a {kind}; name a file");
            Err(io::Error::new(error, advice))
        }
    });
    opened.map_err(|source| Error::io(path, "read", source))
}

/// What a file is that is not a regular one.
fn kind(file: FileType) -> Option<(ErrorKind, &'static str)> {
    let kind = match file {
        f if f.is_file() => return None,
        f if f.is_dir() => return Some((ErrorKind::IsADirectory, "folder")),
        f if f.is_fifo() => "pipe",
        f if f.is_socket() => "socket",
        _ => "device",
    };
    Some((ErrorKind::InvalidInput, kind))
}
