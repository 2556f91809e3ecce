//! Which number of a tuple is which entry of a 3x3 tensor.

use super::Alias;
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
    pub const ROWS3: Self = Self::symmetric([0, 1, 2, 3, 4, 5, 6, 7, 8], 9);
    /// Six components as VTK has them: XX YY ZZ XY YZ XZ.
    pub const VTK: Self = Self::symmetric([0, 3, 5, 3, 1, 4, 5, 4, 2], 6);
    /// Six components, the upper triangle by rows, of NRRD, ITK and FSL: XX XY XZ YY YZ ZZ.
    pub const UPPER: Self = Self::symmetric([0, 1, 2, 1, 3, 4, 2, 4, 5], 6);
    /// Six components, the lower triangle by rows, of NIfTI's SYMMATRIX and dipy: XX XY YY XZ YZ ZZ.
    pub const LOWER: Self = Self::symmetric([0, 1, 3, 1, 2, 4, 3, 4, 5], 6);
    /// Six components as MRtrix3 has them: XX YY ZZ XY XZ YZ.
    pub const MRTRIX: Self = Self::symmetric([0, 3, 4, 3, 1, 5, 4, 5, 2], 6);
    /// Six components in Voigt's order: XX YY ZZ YZ XZ XY.
    pub const VOIGT: Self = Self::symmetric([0, 5, 4, 5, 1, 3, 4, 3, 2], 6);
    /// Four components of a plane tensor, row by row.
    pub const ROWS2: Self = Self::plane([0, 1, 2, 3], 4);
    /// Three components of a symmetric plane tensor: XX XY YY.
    pub const UPPER2: Self = Self::plane([0, 1, 1, 2], 3);
    /// Three components of a symmetric plane tensor in Voigt's order: XX YY XY.
    pub const VOIGT2: Self = Self::plane([0, 2, 2, 1], 3);
    /// Four components of plane strain and axial symmetry: XX YY ZZ XY.
    pub const PLANE_STRAIN: Self = Self {
        entries: [Some(0), Some(3), None, Some(3), Some(1), None, None, None, Some(2)],
        components: 4,
    };
    /// The orders of six components in use, with the tools that write them.
    pub const SIX: [(&'static str, Self); 5] = [
        ("vtk", Self::VTK),
        ("nrrd, itk, fsl", Self::UPPER),
        ("dipy", Self::LOWER),
        ("mrtrix", Self::MRTRIX),
        ("voigt", Self::VOIGT),
    ];

    const fn symmetric(indices: [usize; 9], components: usize) -> Self {
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

    /// An alias of [`ALIASES`](super::ALIASES) or the components themselves, `xx,xy,xz,yy,yz,zz`, in any spelling that files use
    /// (`11,12,13,22,23,33`).
    ///
    /// # Errors
    /// [`IoError::Order`] for anything else, and for an alias or names that do not fit the number of components.
    pub fn parse(text: &str, components: usize) -> Result<Self, IoError> {
        let fault = |expected: &'static str| IoError::Order { order: shorten(text), components, expected };
        if let Some(alias) = Alias::named(text) {
            return alias.order(components).ok_or_else(|| fault(alternatives(components)));
        }
        Self::listed(text, components).map_err(fault)
    }

    fn listed(text: &str, components: usize) -> Result<Self, &'static str> {
        // A component more than there can be is enough to refuse it.
        let words: Vec<&str> = text.split(',').map(str::trim).take(10).collect();
        let entries = super::names::entries(&words).ok_or(
            "vtk, nrrd, dipy, fsl, mrtrix, itk, voigt, abaqus or component names such as xx,xy,xz,yy,yz,zz",
        )?;
        if entries.len() != components {
            return Err("a name for every component");
        }
        Self::by_entries(&entries)
    }

    /// The order by the entry (row by row) of every component; a symmetric tensor has only one of xy and yx. Entries that no component
    /// gives are zero: those outside of the plane, or the shears across it in plane strain.
    pub(crate) fn by_entries(list: &[usize]) -> Result<Self, &'static str> {
        let mut given = [None; 9];
        for (at, &entry) in list.iter().enumerate() {
            if given[entry].replace(at).is_some() {
                return Err("every component once");
            }
        }
        let mut entries = given;
        for i in 0..3 {
            for j in 0..3 {
                entries[3 * i + j] = given[3 * i + j].or(given[3 * j + i]);
            }
        }
        let has = |i: usize, j: usize| entries[3 * i + j].is_some();
        let plane = |i: usize, j: usize| has(i, i) && has(j, j) && has(i, j);
        let floating = (0..3).any(|i| (0..3).any(|j| has(i, j) && !(has(i, i) && has(j, j))));
        if floating || !(plane(0, 1) || plane(0, 2) || plane(1, 2)) {
            return Err(
                "the normal components and the shear of a plane (xx, xy and yy), and others only with their normal components",
            );
        }
        Ok(Self { entries, components: list.len() })
    }

    /// Whether an entry is given, by a component of its own or that of its mirror image.
    #[must_use]
    pub const fn has(&self, row: usize, column: usize) -> bool {
        self.entries[3 * row + column].is_some()
    }

    /// Numbers per tuple.
    #[must_use]
    pub const fn components(&self) -> usize {
        self.components
    }

    /// Whether a component stands for two entries, so that an engineering shear is one number: the entries xy and yx, and so on.
    #[must_use]
    pub fn has_shared_shears(&self) -> bool {
        [(1, 3), (2, 6), (5, 7)]
            .into_iter()
            .any(|(a, b)| self.entries[a].is_some() && self.entries[a] == self.entries[b])
    }

    /// The components that are shears, each once.
    pub(crate) fn shears(self) -> impl Iterator<Item = usize> {
        (0..self.components).filter(move |&c| [1, 2, 3, 5, 6, 7].iter().any(|&e| self.entries[e] == Some(c)))
    }

    /// The 3x3 tensor of a tuple, row by row; a missing component is not a number.
    #[must_use]
    pub fn tensor(&self, tuple: &[f64]) -> [f64; 9] {
        self.entries.map(|e| e.map_or(0.0, |i| tuple.get(i).copied().unwrap_or(f64::NAN)))
    }
}

/// What `--order` may be for a number of components.
const fn alternatives(components: usize) -> &'static str {
    match components {
        9 => "an order of nine components: vtk, nrrd, dipy, or names such as xx,xy,xz,yx,yy,yz,zx,zy,zz",
        6 => "an order of six components: vtk, nrrd, dipy, fsl, mrtrix, itk, voigt, abaqus, or names",
        4 => "an order of four components: nrrd (xx,xy,yx,yy), or names such as xx,yy,zz,xy",
        3 => "an order of three components: nrrd (xx,xy,yy), voigt (xx,yy,xy), or names",
        _ => "names of all components",
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
            (TensorOrder::VOIGT, "xx,yy,zz,yz,xz,xy"),
            (TensorOrder::VOIGT2, "xx,yy,xy"),
            (TensorOrder::PLANE_STRAIN, "xx,yy,zz,xy"),
        ] {
            assert_eq!(order.to_string(), text);
            assert_eq!(TensorOrder::parse(text, order.components()), Ok(order));
        }
        assert_eq!(TensorOrder::parse("xx,yx,yy,zx,zy,zz", 6), Ok(TensorOrder::LOWER));
        assert_eq!(TensorOrder::parse("FSL", 6), Ok(TensorOrder::UPPER));
        assert_eq!(TensorOrder::parse("dipy", 9), Ok(TensorOrder::ROWS3));
        assert_eq!(TensorOrder::parse("11,22,12", 3), Ok(TensorOrder::VOIGT2));
        assert_eq!(TensorOrder::parse("voigt", 3), Ok(TensorOrder::VOIGT2));
        // A model in the plane xz, and a tensor without the shears across its plane.
        let upright = TensorOrder::parse("xx,zz,xz", 3).map(|o| o.tensor(&[1.0, 2.0, 3.0]));
        assert_eq!(upright, Ok([1.0, 0.0, 3.0, 0.0, 0.0, 0.0, 3.0, 0.0, 2.0]));
        let strain = TensorOrder::PLANE_STRAIN.tensor(&[5.0, -1.0, 7.0, 2.0]);
        assert_eq!(strain, [5.0, 2.0, 0.0, 2.0, -1.0, 0.0, 0.0, 0.0, 7.0]);
    }

    #[test]
    fn orders_that_do_not_fit_are_refused() {
        for (text, components) in [
            ("afni", 6),
            ("", 6),
            ("xx,xy,xz,yy,yz,zz", 9),
            ("xx,xx,yy", 3),
            ("xx,xy,xz,yy", 4),
            ("vtk", 3),
            ("vtk", 4),
            ("dipy", 3),
            ("fsl", 9),
            ("mrtrix", 3),
            ("itk", 4),
            ("xx,yy,zz", 3),
            ("vtk", 7),
        ] {
            let message = TensorOrder::parse(text, components).map_err(|e| e.to_string());
            assert!(message.is_err_and(|m| m.contains("expected")), "{text}");
        }
    }
}
