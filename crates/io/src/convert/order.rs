//! Which component of a tuple is which entry of the tensor.

use crate::DataArray;
use std::fmt;
use tigereye_core::Tensor2;

/// Order of the components of a tensor array, and the entries of the xy plane taken from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComponentOrder {
    /// Nine components, the 3x3 tensor row by row: 0, 1, 3, 4 are taken.
    Rows3,
    /// Six components, VTK's order XX YY ZZ XY YZ XZ: 0, 3, 3, 1 are taken.
    Vtk6,
    /// Four components, the 2x2 tensor row by row.
    Rows2,
    /// Three components of a symmetric 2x2 tensor: xx, xy, yy.
    Symmetric2,
    /// The array's own component names say it: indices of xx, xy, yx, yy.
    Named([usize; 4]),
}

impl ComponentOrder {
    /// The order by the component names, where they are complete, else by the number of components.
    pub(super) fn of(array: &DataArray) -> Option<Self> {
        let by_count = match array.components {
            9 => Self::Rows3,
            6 => Self::Vtk6,
            4 => Self::Rows2,
            3 => Self::Symmetric2,
            _ => return None,
        };
        Some(Self::named(array).unwrap_or(by_count))
    }

    /// All components must bear tensor names; a symmetric tensor may have only one of xy and yx.
    fn named(array: &DataArray) -> Option<Self> {
        const NAMES: [&str; 9] = ["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];
        let names: Vec<String> = array.component_names.iter().map(|n| n.to_ascii_lowercase()).collect();
        if names.len() != array.components || !names.iter().all(|n| NAMES.contains(&n.as_str())) {
            return None;
        }
        let at = |name: &str| names.iter().position(|n| n == name);
        let (xy, yx) = (at("xy"), at("yx"));
        Some(Self::Named([at("xx")?, xy.or(yx)?, yx.or(xy)?, at("yy")?]))
    }

    /// Indices of xx, xy, yx, yy in a tuple.
    #[must_use]
    pub const fn indices(self) -> [usize; 4] {
        match self {
            Self::Rows3 => [0, 1, 3, 4],
            Self::Vtk6 => [0, 3, 3, 1],
            Self::Rows2 => [0, 1, 2, 3],
            Self::Symmetric2 => [0, 1, 1, 2],
            Self::Named(indices) => indices,
        }
    }

    /// The tensor of one tuple, which must have all its components.
    pub(super) fn tensor(self, tuple: &[f64]) -> Tensor2 {
        let [xx, xy, yx, yy] = self.indices().map(|i| tuple[i]);
        Tensor2::new(xx, xy, yx, yy)
    }
}

impl fmt::Display for ComponentOrder {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Rows3 => write!(f, "9 components, 3x3 row by row"),
            Self::Vtk6 => write!(f, "6 components, XX YY ZZ XY YZ XZ"),
            Self::Rows2 => write!(f, "4 components, 2x2 row by row"),
            Self::Symmetric2 => write!(f, "3 components, XX XY YY"),
            Self::Named([xx, xy, yx, yy]) => {
                write!(f, "by component names: xx = {xx}, xy = {xy}, yx = {yx}, yy = {yy}")
            }
        }
    }
}
