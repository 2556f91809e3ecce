//! Which number of a tuple is which entry of a 3x3 tensor.

use crate::IoError;
use std::fmt;

/// Names of the entries, row by row.
const ENTRIES: [&str; 9] = ["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];

/// For every entry of the 3x3 tensor, row by row, the component it is read from; `None` where it is zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TensorOrder {
    entries: [Option<usize>; 9],
    components: usize,
}

impl TensorOrder {
    /// Nine components, row by row.
    pub const ROWS3: Self = Self::of([0, 1, 2, 3, 4, 5, 6, 7, 8], 9);
    /// Six components as VTK has them: XX YY ZZ XY YZ XZ.
    pub const VTK: Self = Self::of([0, 3, 5, 3, 1, 4, 5, 4, 2], 6);
    /// Six components, the upper triangle by rows, of NRRD and FSL: XX XY XZ YY YZ ZZ.
    pub const UPPER: Self = Self::of([0, 1, 2, 1, 3, 4, 2, 4, 5], 6);
    /// Six components, the lower triangle by rows, of NIfTI's SYMMATRIX and dipy: XX XY YY XZ YZ ZZ.
    pub const LOWER: Self = Self::of([0, 1, 3, 1, 2, 4, 3, 4, 5], 6);
    /// Six components as MRtrix3 has them: XX YY ZZ XY XZ YZ.
    pub const MRTRIX: Self = Self::of([0, 3, 4, 3, 1, 5, 4, 5, 2], 6);
    /// Four components of a plane tensor, row by row.
    pub const ROWS2: Self = Self::plane([0, 1, 2, 3], 4);
    /// Three components of a symmetric plane tensor: XX XY YY.
    pub const UPPER2: Self = Self::plane([0, 1, 1, 2], 3);
    /// The orders of six components in use, with the tools that write them.
    pub const SIX: [(&'static str, Self); 4] =
        [("vtk", Self::VTK), ("nrrd, fsl", Self::UPPER), ("dipy", Self::LOWER), ("mrtrix", Self::MRTRIX)];

    const fn of(indices: [usize; 9], components: usize) -> Self {
        let (mut entries, mut i) = ([None; 9], 0);
        while i < 9 {
            entries[i] = Some(indices[i]);
            i += 1;
        }
        Self { entries, components }
    }

    const fn plane([xx, xy, yx, yy]: [usize; 4], components: usize) -> Self {
        let entries = [Some(xx), Some(xy), None, Some(yx), Some(yy), None, None, None, None];
        Self { entries, components }
    }

    /// The order a number of components has where nobody says otherwise and it is not six.
    #[must_use]
    pub const fn usual(components: usize) -> Option<Self> {
        match components {
            9 => Some(Self::ROWS3),
            4 => Some(Self::ROWS2),
            3 => Some(Self::UPPER2),
            _ => None,
        }
    }

    /// An alias (`vtk`, `nrrd`, `dipy`, `fsl`, `mrtrix`) or the components themselves, `xx,xy,xz,yy,yz,zz`.
    ///
    /// # Errors
    /// [`IoError::Order`] for anything else, or for another number of components.
    pub fn parse(text: &str, components: usize) -> Result<Self, IoError> {
        let fault = |expected: &'static str| IoError::Order { order: shorten(text), components, expected };
        let lower = text.trim().to_ascii_lowercase();
        let six = match lower.as_str() {
            "vtk" => Self::VTK,
            "nrrd" | "fsl" => Self::UPPER,
            "dipy" => Self::LOWER,
            "mrtrix" => Self::MRTRIX,
            _ => return Self::listed(&lower, components).map_err(fault),
        };
        let order = if components == 6 { Some(six) } else { Self::usual(components) };
        order.ok_or_else(|| fault("6 components (or 9, 4, 3) for a tool's name"))
    }

    fn listed(text: &str, components: usize) -> Result<Self, &'static str> {
        const WORDS: &str = "vtk, nrrd, dipy, fsl, mrtrix or component names such as xx,xy,xz,yy,yz,zz";
        let words: Vec<&str> = text.split(',').map(str::trim).take(10).collect();
        if !words.iter().all(|w| ENTRIES.contains(w)) {
            return Err(WORDS);
        }
        Self::by_names(&words, components)
    }

    /// The order by the names of all components; a symmetric tensor names only one of xy and yx.
    pub(super) fn by_names(names: &[&str], components: usize) -> Result<Self, &'static str> {
        if names.len() != components {
            return Err("a name for every component");
        }
        let mut entries = [None; 9];
        for (at, name) in names.iter().enumerate() {
            let entry = ENTRIES.iter().position(|e| e == name).ok_or("names from xx to zz")?;
            if entries[entry].replace(at).is_some() {
                return Err("every component once");
            }
        }
        let given = entries;
        for i in 0..3 {
            for j in 0..3 {
                entries[3 * i + j] = given[3 * i + j].or(given[3 * j + i]);
            }
        }
        let plane = entries[0].is_some() && entries[1].is_some() && entries[4].is_some();
        let out: usize = [2, 5, 6, 7, 8].iter().filter(|&&e| entries[e].is_some()).count();
        if !plane || (out != 0 && out != 5) {
            return Err("xx, xy and yy, and either all or none of xz, yz and zz");
        }
        Ok(Self { entries, components })
    }

    /// Numbers per tuple.
    #[must_use]
    pub const fn components(&self) -> usize {
        self.components
    }

    /// Whether the tensors are those of a plane: the z row and column are zero.
    #[must_use]
    pub const fn is_plane(&self) -> bool {
        self.entries[8].is_none()
    }

    /// The 3x3 tensor of a tuple, row by row; a missing component is not a number.
    #[must_use]
    pub fn tensor(&self, tuple: &[f64]) -> [f64; 9] {
        self.entries.map(|e| e.map_or(0.0, |i| tuple.get(i).copied().unwrap_or(f64::NAN)))
    }
}

/// The components in the order of the file: `xx,xy,xz,yy,yz,zz`.
impl fmt::Display for TensorOrder {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for component in 0..self.components {
            let entry = self.entries.iter().position(|e| *e == Some(component));
            write!(f, "{}{}", if component == 0 { "" } else { "," }, entry.map_or("-", |e| ENTRIES[e]))?;
        }
        Ok(())
    }
}

fn shorten(text: &str) -> String {
    crate::error::shortened(text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_spelled_as_their_tools_have_them() {
        for (order, text) in [
            (TensorOrder::VTK, "xx,yy,zz,xy,yz,xz"),
            (TensorOrder::UPPER, "xx,xy,xz,yy,yz,zz"),
            (TensorOrder::LOWER, "xx,xy,yy,xz,yz,zz"),
            (TensorOrder::MRTRIX, "xx,yy,zz,xy,xz,yz"),
            (TensorOrder::ROWS3, "xx,xy,xz,yx,yy,yz,zx,zy,zz"),
            (TensorOrder::ROWS2, "xx,xy,yx,yy"),
            (TensorOrder::UPPER2, "xx,xy,yy"),
        ] {
            assert_eq!(order.to_string(), text);
            assert_eq!(TensorOrder::parse(text, order.components()), Ok(order));
        }
        assert_eq!(TensorOrder::parse("xx,yx,yy,zx,zy,zz", 6), Ok(TensorOrder::LOWER));
        assert_eq!(TensorOrder::parse("FSL", 6), Ok(TensorOrder::UPPER));
        assert_eq!(TensorOrder::parse("dipy", 9), Ok(TensorOrder::ROWS3));
    }

    #[test]
    fn orders_that_do_not_fit_are_refused() {
        for (text, components) in [
            ("afni", 6),
            ("", 6),
            ("xx,xy,xz,yy,yz,zz", 9),
            ("xx,xx,yy", 3),
            ("xx,xy,xz,yy", 4),
            ("xx,yy,zz", 3),
            ("vtk", 7),
        ] {
            let message = TensorOrder::parse(text, components).map_err(|e| e.to_string());
            assert!(message.is_err_and(|m| m.contains("expected")), "{text}");
        }
    }
}
