//! Which number of a tuple is which entry of a 3x3 tensor.

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

    /// The order by the entry (row by row) of every component; a symmetric tensor has only one of xy and yx. Entries
    /// that no component gives are zero: those outside of the plane, or the shears across it in plane strain.
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

    /// Whether a component stands for two entries, so that an engineering shear is one number: the entries xy and yx,
    /// and so on.
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

impl fmt::Display for TensorOrder {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for component in 0..self.components {
            let entry = self.entries.iter().position(|e| *e == Some(component));
            write!(f, "{}{}", if component == 0 { "" } else { "," }, entry.map_or("-", |e| ENTRIES[e]))?;
        }
        Ok(())
    }
}
