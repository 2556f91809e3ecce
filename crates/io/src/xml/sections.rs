//! What the data sets of VTK XML files have in common: one piece, arrays of points and cells, field data.

use super::error::XmlError;
use super::{ArrayReader, Content, Element};
use crate::IoError;
use crate::image::{ActiveArrays, DataArray, FieldEntry, FieldValues};

/// The data set of a file, `<ImageData>` or `<PolyData>`; `tag` is its name in brackets.
pub(crate) fn data_set<'a>(
    root: &'a Element,
    name: &'static str,
    tag: &'static str,
) -> Result<&'a Element, XmlError> {
    if root.name != "VTKFile" {
        return Err(root.unexpected("<VTKFile>"));
    }
    if root.required("type", name)? != name {
        return Err(root.wrong("type", name));
    }
    let missing = || XmlError::MissingElement { byte: root.byte, parent: root.name.clone(), element: name };
    let mut children = root.children.iter();
    let child = children.next().ok_or_else(missing)?;
    if child.name != name {
        return Err(child.unexpected(tag));
    }
    match children.next() {
        Some(second) => Err(second.unexpected("<AppendedData> or the end")),
        None => Ok(child),
    }
}

/// The only `<Piece>` of a data set.
pub(crate) fn only_piece(set: &Element) -> Result<&Element, XmlError> {
    let pieces: Vec<&Element> = set.children.iter().filter(|c| c.name == "Piece").collect();
    match pieces[..] {
        [piece] => Ok(piece),
        [] => Err(XmlError::Pieces { byte: set.byte, pieces: 0 }),
        [_, second, ..] => Err(XmlError::Pieces { byte: second.byte, pieces: pieces.len() }),
    }
}

/// The arrays of `<PointData>` or `<CellData>`, and which are active. Arrays without numbers are passed over and named
/// in `skipped`.
pub(crate) fn read_arrays(
    element: &Element,
    arrays: &mut ArrayReader,
    tuples: u64,
    skipped: &mut Vec<String>,
) -> Result<(ActiveArrays, Vec<DataArray>), IoError> {
    let active = |kind: &str| element.attribute(kind).filter(|n| !n.is_empty()).map(str::to_owned);
    let marks = ["Normals", "TCoords", "GlobalIds", "PedigreeIds"].into_iter().filter_map(active).collect();
    let (scalars, vectors, tensors) = (active("Scalars"), active("Vectors"), active("Tensors"));
    let active = ActiveArrays { scalars, vectors, tensors, marks };
    let mut list = Vec::new();
    for child in &element.children {
        if child.name != "DataArray" && child.name != "Array" {
            return Err(child.unexpected("<DataArray>").into());
        }
        let name = child.attribute("Name").unwrap_or_default().to_owned();
        match arrays.read(child, Some(tuples))? {
            Content::Numbers { components, values, scalar } => {
                let component_names = component_names(child, components);
                list.push(DataArray { name, components, component_names, values, scalar });
            }
            Content::Skipped(kind) => skipped.push(skipped_words(&name, &kind)),
            // Strings of points and cells are skipped before they are decoded.
            Content::Text(_) => {}
        }
    }
    Ok((active, list))
}

/// An array that was passed over, for messages.
pub(crate) fn skipped_words(name: &str, kind: &str) -> String {
    format!("`{}` ({kind}, no numbers)", crate::text::shortened(name.as_bytes()))
}

fn component_names(element: &Element, components: usize) -> Vec<String> {
    let mut names = Vec::new();
    for (attribute, value) in &element.attributes {
        let index = attribute.strip_prefix("ComponentName").and_then(|i| i.parse::<usize>().ok());
        if let Some(i) = index.filter(|&i| i < components) {
            names.resize(components, String::new());
            names[i].clone_from(value);
        }
    }
    names
}

/// Everything in `<FieldData>`.
pub(crate) fn read_field_data(
    element: &Element,
    arrays: &mut ArrayReader,
    list: &mut Vec<FieldEntry>,
) -> Result<(), IoError> {
    for child in &element.children {
        if child.name != "DataArray" && child.name != "Array" {
            return Err(child.unexpected("<DataArray> or <Array>").into());
        }
        let values = match arrays.read(child, None)? {
            Content::Text(strings) => FieldValues::Text(strings),
            Content::Numbers { components, values, scalar } => {
                FieldValues::Numbers { components, values, scalar }
            }
            Content::Skipped(_) => continue,
        };
        list.push(FieldEntry { name: child.attribute("Name").unwrap_or_default().to_owned(), values });
    }
    Ok(())
}
