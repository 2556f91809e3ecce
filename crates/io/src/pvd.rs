//! ParaView's collections, `.pvd`: image files with the time of each.

use crate::IoError;
use crate::text::shortened;
use crate::write_error::WriteError;
use quick_xml::escape::escape;
use std::fmt::Write as _;

/// Writes a collection of files, by time and by name relative to the collection.
///
/// # Errors
/// [`WriteError::Unwritable`] for names with control characters.
pub fn write(frames: &[(f64, String)]) -> Result<Vec<u8>, IoError> {
    let mut xml = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <Collection>\n",
    );
    for (time, file) in frames {
        if file.chars().any(char::is_control) {
            return Err(WriteError::Unwritable { name: shortened(file.as_bytes()) }.into());
        }
        // Writing to a String does not fail.
        let _ = writeln!(
            xml,
            "    <DataSet timestep=\"{time:?}\" part=\"0\" file=\"{}\"/>",
            escape(file.as_str())
        );
    }
    xml.push_str("  </Collection>\n</VTKFile>\n");
    Ok(xml.into_bytes())
}
