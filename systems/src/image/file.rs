//! Files that are written whole or not at all.

use std::{
    fmt, fs,
    io::{self, Write},
    path::{Path, PathBuf},
};
use tempfile::NamedTempFile;

/// Why a file cannot be written or read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    file: PathBuf,
    message: String,
}

impl FileError {
    pub(super) fn new(file: &Path, message: impl Into<String>) -> Self {
        Self { file: file.into(), message: message.into() }
    }

    fn unwritable(file: &Path, why: &io::Error) -> Self {
        Self::new(file, format!("cannot be written: {why}"))
    }

    /// The file.
    #[must_use]
    pub fn file(&self) -> &Path {
        &self.file
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.file.display(), self.message)
    }
}

impl std::error::Error for FileError {}

/// Checks, before the work that fills it, that a file can be written.
///
/// # Errors
/// What would keep it from being written now: its folder or a file of its name.
pub fn check_writable(path: &Path) -> Result<(), FileError> {
    let folder = folder(path);
    if path.file_name().is_none() || path.is_dir() {
        return Err(FileError::new(path, "cannot be written: it names a folder"));
    }
    if !folder.is_dir() {
        return Err(FileError::new(path, format!("cannot be written: there is no folder `{}`", folder.display())));
    }
    if fs::metadata(path).is_ok_and(|file| file.permissions().readonly()) {
        return Err(FileError::new(path, "cannot be written: it is read-only"));
    }
    temporary(&folder).map(drop).map_err(|why| FileError::unwritable(path, &why))
}

/// Writes a file in one step: others see it as it was or complete, never in between.
///
/// # Errors
/// What keeps it from being written; the file is then as it was.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    // A link stays a link; what it points to is replaced.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.into());
    let write = || {
        let mut file = temporary(&folder(&target))?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        file.persist(&target)?;
        Ok(())
    };
    write().map_err(|why| FileError::unwritable(path, &why))
}

/// The folder of a file.
fn folder(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder.into(),
        _ => ".".into(),
    }
}

/// A new file in a folder that goes away unless it is persisted.
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".snell-");
    // As any new file: what the user's umask leaves, not private as temporary files are.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.txt");
        for text in ["one", "two"] {
            check_writable(&path).expect("writable");
            write_atomically(&path, text.as_bytes()).expect("written");
            assert_eq!(fs::read_to_string(&path).expect("read"), text);
        }
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    }

    #[test]
    fn what_cannot_be_written_is_told_first() {
        let folder = tempfile::tempdir().expect("a folder");
        let told = |path: &Path| check_writable(path).expect_err("not writable").to_string();
        assert!(told(&folder.path().join("missing/a.png")).contains("there is no folder `"));
        assert!(told(folder.path()).contains("it names a folder"));
        let locked = folder.path().join("locked.png");
        fs::write(&locked, "kept").expect("written");
        let mut permissions = fs::metadata(&locked).expect("a file").permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&locked, permissions).expect("locked");
        assert!(told(&locked).contains("it is read-only"));
    }

    #[cfg(unix)]
    #[test]
    fn a_new_file_has_the_permissions_of_any_new_file_and_links_stay() {
        use std::os::unix::fs::{MetadataExt, symlink};
        let folder = tempfile::tempdir().expect("a folder");
        let [ours, plain, link] = ["ours", "plain", "link"].map(|name| folder.path().join(name));
        write_atomically(&ours, b"1").expect("written");
        fs::write(&plain, b"1").expect("written");
        let mode = |path: &Path| fs::metadata(path).expect("a file").mode();
        assert_eq!(mode(&ours), mode(&plain));
        symlink(&ours, &link).expect("a link");
        write_atomically(&link, b"2").expect("written");
        assert_eq!(fs::read(&ours).expect("read"), b"2");
        assert!(link.is_symlink());
    }
}
