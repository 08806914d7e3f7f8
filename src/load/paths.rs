//! Finds files that an OBJ or MTL file names, the way exporters on other systems wrote them.

use std::path::{Component, Path, PathBuf};

/// Where a named file was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// Where the name says.
    AsNamed(PathBuf),
    /// Under another spelling of the name, or in another folder: worth a warning.
    Elsewhere(PathBuf),
    /// Nowhere; the path is where it should be.
    Missing(PathBuf),
}

/// Looks for the file `name`, relative to `folder`.
///
/// In this order: as named (with either slash); with another case of letters, as systems that ignore
/// case do; the bare file name in `folder`, for absolute paths of the exporter's machine.
pub(super) fn find_file(folder: &Path, name: &str) -> Found {
    let name = name.trim().trim_matches('"').replace('\\', "/");
    let named = folder.join(&name);
    if is_there(&named) {
        return Found::AsNamed(named);
    }
    let bare = name.rsplit('/').next().map(PathBuf::from).unwrap_or_default();
    let anywhere = find_ignoring_case(folder, Path::new(&name))
        .or_else(|| find_ignoring_case(folder, &bare))
        .filter(|path| is_there(path));
    anywhere.map_or(Found::Missing(named), Found::Elsewhere)
}

/// Whether there is something to open; whoever opens it says why it cannot be read.
fn is_there(path: &Path) -> bool {
    path.exists() && !path.is_dir()
}

/// Follows `name` from `folder`, comparing without case where there is no exact match.
fn find_ignoring_case(folder: &Path, name: &Path) -> Option<PathBuf> {
    let mut found = folder.to_path_buf();
    for component in name.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => found.push(".."),
            Component::RootDir | Component::Prefix(_) => found.push(component),
            Component::Normal(wanted) => {
                let exact = found.join(wanted);
                found = if exact.exists() {
                    exact
                } else {
                    let wanted = wanted.to_string_lossy().to_lowercase();
                    let here =
                        if found.as_os_str().is_empty() { Path::new(".") } else { found.as_path() };
                    let matches = std::fs::read_dir(here).ok()?.filter_map(|entry| {
                        let name = entry.ok()?.file_name();
                        (name.to_string_lossy().to_lowercase() == wanted).then_some(name)
                    });
                    // The order of a folder is the file system's; the smallest name is everybody's.
                    found.join(matches.min()?)
                };
            }
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_found_as_exporters_name_them() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        std::fs::create_dir(root.join("Textures")).unwrap();
        std::fs::write(root.join("Textures/Wood.png"), "").unwrap();
        std::fs::write(root.join("wall paper.png"), "").unwrap();
        let wood = root.join("Textures/Wood.png");
        assert_eq!(find_file(root, "Textures/Wood.png"), Found::AsNamed(wood.clone()));
        assert_eq!(find_file(root, "Textures\\Wood.png"), Found::AsNamed(wood.clone()));
        assert_eq!(find_file(root, ".\\textures\\WOOD.PNG"), Found::Elsewhere(wood));
        let paper = root.join("wall paper.png");
        assert_eq!(find_file(root, "\"wall paper.png\""), Found::AsNamed(paper.clone()));
        assert_eq!(find_file(root, "C:\\work\\Wall Paper.png"), Found::Elsewhere(paper));
        assert_eq!(find_file(root, "none.png"), Found::Missing(root.join("none.png")));
        // A folder is not a file.
        assert_eq!(find_file(root, "Textures"), Found::Missing(root.join("Textures")));
        assert_eq!(find_file(root, ""), Found::Missing(root.join("")));
    }
}
