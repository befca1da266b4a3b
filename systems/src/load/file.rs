//! Finding and opening the files that others name.

use crate::load::fault::{Fault, nearest};
use std::ffi::OsStr;
use std::fs::{File, Metadata};
use std::io::{BufRead, BufReader, ErrorKind};
use std::path::{Path, PathBuf};

/// Makes sure that a file is there and is a regular one. Done before opening it: to open a pipe would wait for someone
/// to write to it.
///
/// # Errors
/// What is not, with the name that may have been meant.
pub(super) fn check(path: &Path) -> Result<Metadata, Fault> {
    let data = std::fs::metadata(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => Fault::of_file(path, format!("does not exist{}", hint(path))),
        _ => Fault::of_file(path, format!("cannot be opened: {error}")),
    })?;
    if data.is_file() { Ok(data) } else { Err(Fault::of_file(path, "is not a file")) }
}

/// Opens a text file behind its byte order mark.
///
/// # Errors
/// What cannot be opened, is no regular file, is larger than `most` bytes, or is UTF-16.
pub(super) fn open_text(path: &Path, most: u64) -> Result<impl BufRead + use<>, Fault> {
    let fault = |message: String| Fault::of_file(path, message);
    if check(path)?.len() > most {
        return Err(fault(format!("is larger than {} MiB", most >> 20)));
    }
    let file = File::open(path).map_err(|error| fault(format!("cannot be opened: {error}")))?;
    let mut reader = BufReader::with_capacity(1 << 16, file);
    match reader.fill_buf().map_err(|error| fault(format!("cannot be read: {error}")))? {
        [0xEF, 0xBB, 0xBF, ..] => reader.consume(3),
        // Without a mark, UTF-16 shows by the zero in one half of its first character.
        &[0xFF, 0xFE, ..] | &[0xFE, 0xFF, ..] | &[0, _, ..] | &[_, 0, ..] => {
            return Err(fault("is not UTF-8 but seems to be UTF-16: save it as UTF-8".into()));
        }
        _ => {}
    }
    Ok(reader)
}

/// The path of a file that another in `folder` names. Backslashes separate folders where no file has them in its name.
pub(super) fn resolve(folder: &Path, name: &str) -> PathBuf {
    let plain = folder.join(name);
    if name.contains('\\') && !plain.is_file() { folder.join(name.replace('\\', "/")) } else { plain }
}

/// ` (did you mean …?)` if the folder of a missing file holds one of the same kind with a name like it.
fn hint(path: &Path) -> String {
    /// Names looked at: a hint is not worth the time that huge folders take.
    const MOST_NAMES: usize = 1000;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (Some(name), Ok(entries)) = (path.file_name(), folder.read_dir()) else { return String::new() };
    let same_kind = |other: &PathBuf| {
        let [a, b] = [path, other.as_path()].map(|path| path.extension().map(OsStr::to_ascii_lowercase));
        a == b && other.file_name() != Some(name)
    };
    let paths = entries.take(MOST_NAMES).flatten().map(|entry| entry.path()).filter(same_kind);
    let mut names: Vec<String> =
        paths.filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned())).collect();
    names.sort();
    nearest(&name.to_string_lossy(), names.iter().map(String::as_str))
        .map(|near| format!(" (did you mean `{near}`?)"))
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_text_file_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let message = |path: &Path| open_text(path, 8).err().map(|fault| fault.message);
        assert_eq!(message(folder.path()).as_deref(), Some("is not a file"));
        let file = folder.path().join("box.obj");
        std::fs::write(&file, "v 0 0 0\nv").expect("written");
        assert_eq!(message(&file).as_deref(), Some("is larger than 0 MiB"));
        for text in [&b"\xFF\xFEv\0"[..], b"\xFE\xFF\0v", b"v\0 \0", b"\0v\0 "] {
            std::fs::write(&file, text).expect("written");
            assert!(message(&file).is_some_and(|message| message.contains("UTF-16")));
        }
        let missing = message(&folder.path().join("Bxo.obj"));
        assert_eq!(missing.as_deref(), Some("does not exist (did you mean `box.obj`?)"));
        assert_eq!(message(&folder.path().join("box.mtl")).as_deref(), Some("does not exist"));
    }
}
