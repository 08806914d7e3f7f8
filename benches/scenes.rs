//! Which scenes there are.

use std::path::{Path, PathBuf};

/// Every scene file of the repository.
pub(crate) fn all() -> Vec<PathBuf> {
    let files = |path: PathBuf| std::fs::read_dir(path).into_iter().flatten().flatten();
    let folders = files(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes"));
    let mut scenes: Vec<PathBuf> = folders
        .flat_map(|folder| files(folder.path()))
        .map(|file| file.path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    scenes.sort();
    scenes
}
