//! The arrays of a `.npz` archive.

use super::error::NpyError;
use super::lattice_of_members;
use super::positions::is_position;
use crate::limits::LimitError;
use crate::text::shortened;
use crate::volume::Lattice;
use crate::{ArrayChoice, IoError, Limits, Wanted};
use std::io::{Cursor, Read as _};
use zip::ZipArchive;

/// Most arrays of an archive.
const MAX_ARRAYS: usize = 4096;
/// Largest expansion that deflate can reach, rounded up.
const DEFLATE_RATIO: u64 = 1040;
const ARCHIVE: &str = "a .npz archive";

fn fault(problem: impl Into<String>, expected: &'static str) -> NpyError {
    NpyError::Archive { problem: problem.into(), expected }
}

/// The bytes of one `.npy` file of an archive, and its name: the named one (with or without `.npy`), or the only one.
///
/// # Errors
/// [`NpyError::Archive`], which lists the arrays.
pub fn array_of_archive(bytes: &[u8], name: Option<&str>) -> Result<(String, Vec<u8>), IoError> {
    let mut archive = Archive::open(bytes)?;
    let chosen = match (name, &archive.files[..]) {
        (Some(name), files) => files.iter().find(|f| plain(f) == name || *f == name),
        (None, [only]) => Some(only),
        (None, _) => return Err(fault(archive.listed(), "the name of one").into()),
    };
    let chosen = chosen.cloned().ok_or_else(|| {
        let name = shortened(name.unwrap_or_default().as_bytes());
        fault(format!("no array `{name}`, {}", archive.listed()), "one of these")
    })?;
    archive.bytes_of(&chosen)
}

/// A tensor, a vector or a number a cell out of an archive: the array that is chosen, placed by arrays of positions.
///
/// # Errors
/// As [`arrays_of_archive`] and [`super::lattice_of_members`].
pub fn read_archive(bytes: &[u8], choice: ArrayChoice, wanted: Wanted) -> Result<Lattice, IoError> {
    let ArrayChoice::Named(name) = choice else {
        return lattice_of_members(&arrays_of_archive(bytes)?, choice, wanted);
    };
    // Of a large archive only what is asked for is unpacked.
    let member = array_of_archive(bytes, Some(name))?;
    let named = member.0.clone();
    let mut members = files_of_archive(bytes, |file| is_position(plain(file)) && plain(file) != named)?;
    members.push(member);
    lattice_of_members(&members, ArrayChoice::Named(&named), wanted)
}

/// Names and bytes of all `.npy` files of an archive.
///
/// # Errors
/// [`NpyError::Archive`], and [`LimitError::Values`] for more bytes together than the default limit of one array.
pub fn arrays_of_archive(bytes: &[u8]) -> Result<Vec<(String, Vec<u8>)>, IoError> {
    let all = files_of_archive(bytes, |_| true)?;
    if all.is_empty() { Err(fault(Archive::open(bytes)?.listed(), "at least one").into()) } else { Ok(all) }
}

fn files_of_archive(
    bytes: &[u8],
    is_wanted: impl Fn(&str) -> bool,
) -> Result<Vec<(String, Vec<u8>)>, IoError> {
    let mut archive = Archive::open(bytes)?;
    let (mut all, mut total) = (Vec::new(), 0_u64);
    for file in archive.files.clone().into_iter().filter(|file| is_wanted(file)) {
        let (name, data) = archive.bytes_of(&file)?;
        total += data.len() as u64;
        let limit = Limits::default().values;
        if total > 8 * limit + (1 << 20) {
            return Err(LimitError::Values { array: name, byte: 0, limit }.into());
        }
        all.push((name, data));
    }
    Ok(all)
}

/// An archive that is open, and the names of its `.npy` files.
struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    files: Vec<String>,
}

fn unreadable(e: zip::result::ZipError) -> IoError {
    fault(shortened(e.to_string().as_bytes()), ARCHIVE).into()
}

impl<'a> Archive<'a> {
    fn open(bytes: &'a [u8]) -> Result<Self, IoError> {
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(unreadable)?;
        if zip.len() > MAX_ARRAYS {
            return Err(fault(format!("{} arrays", zip.len()), "at most 4096").into());
        }
        let files = zip.file_names().filter(|n| n.ends_with(".npy")).map(str::to_owned).collect();
        Ok(Self { zip, files })
    }

    /// The arrays in words, the first twenty of them.
    fn listed(&self) -> String {
        let names: Vec<String> =
            self.files.iter().take(20).map(|n| format!("`{}`", shortened(plain(n).as_bytes()))).collect();
        if names.is_empty() { "no array".to_owned() } else { format!("the arrays are {}", names.join(", ")) }
    }

    fn bytes_of(&mut self, file: &str) -> Result<(String, Vec<u8>), IoError> {
        let name = || shortened(file.as_bytes());
        let entry = self.zip.by_name(file).map_err(unreadable)?;
        let most = entry
            .compressed_size()
            .saturating_mul(DEFLATE_RATIO)
            .min(8 * Limits::default().values + (1 << 20));
        let declared = entry.size();
        if declared > most {
            let problem = format!("`{}` declares {declared} bytes", name());
            return Err(fault(problem, "no more than deflate can hold").into());
        }
        let mut data = Vec::new();
        let read = entry.take(declared).read_to_end(&mut data);
        read.map_err(|e| fault(format!("`{}`: {e}", name()), ARCHIVE))?;
        Ok((plain(file).to_owned(), data))
    }
}

fn plain(file: &str) -> &str {
    file.strip_suffix(".npy").unwrap_or(file)
}
