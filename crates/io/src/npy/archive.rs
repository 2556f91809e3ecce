//! One array of a `.npz` archive.

use crate::error::shortened;
use crate::{IoError, Limits};
use std::io::{Cursor, Read as _};
use zip::ZipArchive;

/// Most arrays of an archive.
const MAX_ARRAYS: usize = 4096;
/// Largest expansion that deflate can reach, rounded up.
const DEFLATE_RATIO: u64 = 1040;
const ARCHIVE: &str = "a .npz archive";

fn fault(problem: impl Into<String>, expected: &'static str) -> IoError {
    IoError::Archive { problem: problem.into(), expected }
}

/// The bytes of one `.npy` file of an archive, and its name: the named one (with or without `.npy`), or the only one.
///
/// # Errors
/// [`IoError::Archive`], which lists the arrays.
pub fn array_of_archive(bytes: &[u8], name: Option<&str>) -> Result<(String, Vec<u8>), IoError> {
    let unreadable = |e: zip::result::ZipError| fault(shortened(e.to_string().as_bytes()), ARCHIVE);
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(unreadable)?;
    if archive.len() > MAX_ARRAYS {
        return Err(fault(format!("{} arrays", archive.len()), "at most 4096"));
    }
    let files: Vec<String> =
        archive.file_names().filter(|n| n.ends_with(".npy")).map(str::to_owned).collect();
    let listed = || {
        let names: Vec<String> =
            files.iter().take(20).map(|n| format!("`{}`", shortened(plain(n).as_bytes()))).collect();
        if names.is_empty() { "no array".to_owned() } else { format!("the arrays are {}", names.join(", ")) }
    };
    let chosen = match (name, &files[..]) {
        (Some(name), _) => files.iter().find(|f| plain(f) == name || *f == name),
        (None, [only]) => Some(only),
        (None, _) => return Err(fault(listed(), "the name of one")),
    };
    let chosen = chosen.ok_or_else(|| {
        let name = shortened(name.unwrap_or_default().as_bytes());
        fault(format!("no array `{name}`, {}", listed()), "one of these")
    })?;
    let entry = archive.by_name(chosen).map_err(unreadable)?;
    let most =
        entry.compressed_size().saturating_mul(DEFLATE_RATIO).min(8 * Limits::default().values + (1 << 20));
    let declared = entry.size();
    if declared > most {
        return Err(fault(
            format!("`{}` declares {declared} bytes", shortened(chosen.as_bytes())),
            "no more than deflate can hold",
        ));
    }
    let mut data = Vec::new();
    let read = entry.take(declared).read_to_end(&mut data);
    read.map_err(|e| fault(format!("`{}`: {e}", shortened(chosen.as_bytes())), ARCHIVE))?;
    Ok((plain(chosen).to_owned(), data))
}

fn plain(file: &str) -> &str {
    file.strip_suffix(".npy").unwrap_or(file)
}
