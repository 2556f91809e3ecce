//! Image data as files describe them, before anybody asks what they mean.

use crate::ScalarType;

/// Arrays on a regular grid of points.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageData {
    /// Points along x, y and z, each at least 1. x runs fastest.
    pub dimensions: [usize; 3],
    /// Position of the first point.
    pub origin: [f64; 3],
    /// Distance of the points along each axis.
    pub spacing: [f64; 3],
    /// Rotation of the axes, row by row; `None` where the file does not say.
    pub direction: Option<[f64; 9]>,
    /// Arrays with one tuple per point.
    pub point_arrays: Vec<DataArray>,
    /// Arrays with one tuple per cell between the points.
    pub cell_arrays: Vec<DataArray>,
    /// Names of the active point arrays.
    pub point_active: ActiveArrays,
    /// Names of the active cell arrays.
    pub cell_active: ActiveArrays,
    /// What belongs to the whole data set.
    pub field_data: Vec<FieldEntry>,
    /// Arrays that were passed over because they hold something else than numbers: name and type.
    pub skipped: Vec<String>,
}

/// Names of the arrays a viewer shows first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ActiveArrays {
    /// Attribute `Scalars`.
    pub scalars: Option<String>,
    /// Attribute `Vectors`.
    pub vectors: Option<String>,
    /// Attribute `Tensors`.
    pub tensors: Option<String>,
    /// Attributes `Normals`, `TCoords`, `GlobalIds` and `PedigreeIds`: neither tensors nor vectors of a field.
    pub marks: Vec<String>,
}

/// One array: tuples of `components` numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct DataArray {
    /// Name; may be empty.
    pub name: String,
    /// Numbers per tuple.
    pub components: usize,
    /// Names of the components, empty strings where one has none; empty where none has.
    pub component_names: Vec<String>,
    /// All numbers, tuple by tuple.
    pub values: Vec<f64>,
    /// Type in the file: as read, and to be written.
    pub scalar: ScalarType,
}

/// One array of the field data.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldEntry {
    /// Name; may be empty.
    pub name: String,
    /// What it holds.
    pub values: FieldValues,
}

/// Contents of a [`FieldEntry`].
#[derive(Clone, Debug, PartialEq)]
pub enum FieldValues {
    /// Strings.
    Text(Vec<String>),
    /// Tuples of numbers.
    Numbers {
        /// Numbers per tuple.
        components: usize,
        /// All numbers.
        values: Vec<f64>,
        /// Type in the file.
        scalar: ScalarType,
    },
}

impl ImageData {
    /// An image of `dimensions` points without arrays: origin 0, spacing 1.
    #[must_use]
    pub fn empty(dimensions: [usize; 3]) -> Self {
        Self {
            dimensions,
            origin: [0.0; 3],
            spacing: [1.0; 3],
            direction: None,
            point_arrays: Vec::new(),
            cell_arrays: Vec::new(),
            point_active: ActiveArrays::default(),
            cell_active: ActiveArrays::default(),
            field_data: Vec::new(),
            skipped: Vec::new(),
        }
    }

    /// Cells between the points along each axis; an axis with one point counts as one layer.
    #[must_use]
    pub fn cell_dimensions(&self) -> [usize; 3] {
        self.dimensions.map(|n| n.saturating_sub(1).max(1))
    }

    /// The point array of a name, the first if there are several.
    #[must_use]
    pub fn point_array(&self, name: &str) -> Option<&DataArray> {
        self.point_arrays.iter().find(|a| a.name == name)
    }

    /// The first string of a field data entry.
    #[must_use]
    pub fn text(&self, name: &str) -> Option<&str> {
        self.field_data.iter().filter(|e| e.name == name).find_map(|e| match &e.values {
            FieldValues::Text(strings) => strings.first().map(String::as_str),
            FieldValues::Numbers { .. } => None,
        })
    }

    /// The numbers of a field data entry.
    #[must_use]
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        self.field_data.iter().filter(|e| e.name == name).find_map(|e| match &e.values {
            FieldValues::Numbers { values, .. } => Some(values.as_slice()),
            FieldValues::Text(_) => None,
        })
    }

    /// Adds a field data entry of one string.
    pub fn push_text(&mut self, name: &str, text: &str) {
        let values = FieldValues::Text(vec![text.to_owned()]);
        self.field_data.push(FieldEntry { name: name.to_owned(), values });
    }
}

impl DataArray {
    /// An array of `Float64` numbers without component names.
    #[must_use]
    pub fn new(name: &str, components: usize, values: Vec<f64>) -> Self {
        let component_names = Vec::new();
        Self { name: name.to_owned(), components, component_names, values, scalar: ScalarType::Float64 }
    }

    /// Puts the tuples into another order: the one at `i` comes from `order[i]`. Arrays of another number of tuples
    /// stay as they are.
    pub(crate) fn reorder(&mut self, order: &[usize]) {
        if self.values.len() == order.len() * self.components {
            let tuple = |&at: &usize| &self.values[at * self.components..(at + 1) * self.components];
            self.values = order.iter().flat_map(tuple).copied().collect();
        }
    }

    /// The same array with names for its components.
    #[must_use]
    pub fn with_component_names(mut self, names: &[&str]) -> Self {
        self.component_names = names.iter().map(|&n| n.to_owned()).collect();
        self
    }
}
