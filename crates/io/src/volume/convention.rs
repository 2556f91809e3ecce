//! What programs write and what is assumed of it: the tables that decide, and the page of the documentation made from
//! them.

use super::meaning::{Frame, Known};
use super::order::TensorOrder;

/// A name for a component order, after the program that writes it.
#[derive(Clone, Copy, Debug)]
pub struct Alias {
    /// What `--order` takes.
    pub name: &'static str,
    /// The programs that write tensors so; those with a version are run by the checks in `interop/`.
    pub programs: &'static str,
    /// The orders, by their number of components; other numbers of components are refused.
    pub orders: &'static [TensorOrder],
    /// The axes that these programs write components along, where they differ from the format's own.
    pub frame: Option<Frame>,
}

/// All aliases of `--order`.
pub const ALIASES: [Alias; 8] = [
    Alias {
        name: "vtk",
        programs: "VTK 9.7, ParaView, CalculiX, Ansys",
        orders: &[TensorOrder::VTK, TensorOrder::ROWS3],
        frame: None,
    },
    Alias {
        name: "nrrd",
        programs: "teem 1.12, pynrrd 1.1, 3D Slicer",
        orders: &[TensorOrder::UPPER2, TensorOrder::ROWS2, TensorOrder::UPPER, TensorOrder::ROWS3],
        frame: None,
    },
    Alias {
        name: "dipy",
        programs: "dipy 1.12 (`lower_triangular`, `quadratic_form`), NIfTI's own symmetric matrices",
        orders: &[TensorOrder::LOWER, TensorOrder::ROWS3],
        frame: None,
    },
    Alias {
        name: "fsl",
        programs: "FSL (`dtifit --save_tensor`)",
        orders: &[TensorOrder::UPPER],
        frame: Some(Frame::Fsl),
    },
    Alias {
        name: "mrtrix",
        programs: "MRtrix3 3.0 (`dwi2tensor`)",
        orders: &[TensorOrder::MRTRIX],
        frame: Some(Frame::World),
    },
    Alias { name: "itk", programs: "ITK and ANTs in memory", orders: &[TensorOrder::UPPER], frame: None },
    Alias {
        name: "voigt",
        programs: "textbooks and many finite-element codes",
        orders: &[TensorOrder::VOIGT2, TensorOrder::VOIGT],
        frame: None,
    },
    Alias {
        name: "abaqus",
        programs: "Abaqus (S11, S22, S33, S12, S13, S23; plane strain S11, S22, S33, S12)",
        orders: &[TensorOrder::PLANE_STRAIN, TensorOrder::MRTRIX],
        frame: None,
    },
];

impl Alias {
    /// The alias of a name in any case.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        ALIASES.iter().find(|a| a.name.eq_ignore_ascii_case(name.trim()))
    }

    /// Its order of a number of components.
    #[must_use]
    pub fn order(&self, components: usize) -> Option<TensorOrder> {
        self.orders.iter().copied().find(|o| o.components() == components)
    }
}

/// What a reader met, as far as it decides what components mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// A VTK array that is the active `Tensors` of its data set.
    VtkTensors,
    /// Another VTK array.
    VtkArray,
    /// NIfTI, intent 1005, a symmetric matrix.
    NiftiSymmetric,
    /// NIfTI, intent 1004, a matrix.
    NiftiMatrix,
    /// NIfTI, intents 1006 (displacement) and 1007 (vector).
    NiftiVector,
    /// NIfTI, several numbers a voxel without an intent.
    NiftiNumbers,
    /// NRRD, a kind of tensors.
    NrrdTensor,
    /// NRRD, several numbers a sample of another kind or none.
    NrrdNumbers,
    /// A NumPy array with two axes of cells, `[row][column]`.
    NumpyPlane,
    /// A NumPy array whose last axes are (2, 2), with two axes of cells.
    NumpyMatrices,
    /// A NumPy array with three axes of cells, `[x][y][z]`.
    NumpyVolume,
}

/// What components of such content mean where neither names nor the user say it.
#[derive(Clone, Copy, Debug)]
pub struct Convention {
    /// The content.
    pub content: Content,
    /// The content in words, as the documentation has it.
    pub words: &'static str,
    /// Numbers a point.
    pub components: usize,
    /// Their order, `None` for vectors.
    pub order: Option<(TensorOrder, Known)>,
    /// The axes they are along; NRRD files with a measurement frame state their own.
    pub frame: (Frame, Known),
    /// The programs that write so; those with a version are run by the checks in `interop/`.
    pub programs: &'static str,
}

const fn row(
    content: Content,
    words: &'static str,
    components: usize,
    order: Option<(TensorOrder, Known)>,
    frame: (Frame, Known),
    programs: &'static str,
) -> Convention {
    Convention { content, words, components, order, frame, programs }
}

const VTK_FRAME: (Frame, Known) = (Frame::World, Known::Stated);
const NIFTI_FRAME: (Frame, Known) = (Frame::Voxel, Known::Assumed);
const NRRD_FRAME: (Frame, Known) = (Frame::World, Known::Assumed);
const PLANE_FRAME: (Frame, Known) = (Frame::World, Known::Convention);
const AXES_FRAME: (Frame, Known) = (Frame::Voxel, Known::Assumed);

/// Every convention, in the order of the documentation.
pub const CONVENTIONS: [Convention; 29] = {
    use Content as C;
    use Known::{Assumed, Convention as Usual, Stated};
    use TensorOrder as O;
    [
        row(
            C::VtkTensors,
            "VTK, active `Tensors`",
            9,
            Some((O::ROWS3, Stated)),
            VTK_FRAME,
            "VTK 9.7, ParaView",
        ),
        row(
            C::VtkTensors,
            "VTK, active `Tensors`",
            6,
            Some((O::VTK, Stated)),
            VTK_FRAME,
            "VTK 9.7 (TENSORS6)",
        ),
        row(C::VtkArray, "VTK, another array", 9, Some((O::ROWS3, Usual)), VTK_FRAME, "ParaView, pyvista"),
        row(
            C::VtkArray,
            "VTK, another array",
            6,
            Some((O::VTK, Assumed)),
            VTK_FRAME,
            "ParaView, ccx2paraview",
        ),
        row(C::VtkArray, "VTK, another array", 4, Some((O::ROWS2, Assumed)), VTK_FRAME, "2D solvers"),
        row(
            C::VtkArray,
            "VTK, another array",
            3,
            Some((O::UPPER2, Assumed)),
            VTK_FRAME,
            "2D solvers; vectors otherwise",
        ),
        row(C::VtkArray, "VTK, a vector", 2, None, VTK_FRAME, "2D solvers"),
        row(
            C::NiftiSymmetric,
            "NIfTI, intent 1005",
            6,
            Some((O::LOWER, Stated)),
            NIFTI_FRAME,
            "dipy 1.12, ITK 5.4, ANTs",
        ),
        row(
            C::NiftiSymmetric,
            "NIfTI, intent 1005",
            3,
            Some((O::UPPER2, Stated)),
            NIFTI_FRAME,
            "the standard",
        ),
        row(C::NiftiMatrix, "NIfTI, intent 1004", 9, Some((O::ROWS3, Stated)), NIFTI_FRAME, "the standard"),
        row(C::NiftiMatrix, "NIfTI, intent 1004", 4, Some((O::ROWS2, Stated)), NIFTI_FRAME, "the standard"),
        row(
            C::NiftiVector,
            "NIfTI, intents 1006 and 1007",
            6,
            Some((O::UPPER, Assumed)),
            NIFTI_FRAME,
            "ITK, images of vectors",
        ),
        row(
            C::NiftiVector,
            "NIfTI, intents 1006 and 1007",
            3,
            None,
            (Frame::World, Usual),
            "ANTs (warps, 1006), 4D flow; images of vectors of ITK (1007) are `lps`",
        ),
        row(
            C::NiftiVector,
            "NIfTI, intents 1006 and 1007",
            2,
            None,
            (Frame::World, Usual),
            "ANTs (warps, 1006), 4D flow; images of vectors of ITK (1007) are `lps`",
        ),
        row(C::NiftiNumbers, "NIfTI, no intent", 9, Some((O::ROWS3, Assumed)), NIFTI_FRAME, "nibabel 5.4"),
        row(
            C::NiftiNumbers,
            "NIfTI, no intent",
            6,
            Some((O::LOWER, Assumed)),
            NIFTI_FRAME,
            "dipy 1.12; see the aliases for FSL and MRtrix3",
        ),
        row(C::NiftiNumbers, "NIfTI, no intent", 4, Some((O::ROWS2, Assumed)), NIFTI_FRAME, "nibabel 5.4"),
        row(C::NiftiNumbers, "NIfTI, no intent, a vector", 3, None, NIFTI_FRAME, "FSL (V1)"),
        row(
            C::NrrdNumbers,
            "NRRD, kind list, vector or none",
            9,
            Some((O::ROWS3, Assumed)),
            NRRD_FRAME,
            "pynrrd 1.1",
        ),
        row(
            C::NrrdNumbers,
            "NRRD, kind list, vector or none",
            6,
            Some((O::UPPER, Assumed)),
            NRRD_FRAME,
            "ITK, images of vectors",
        ),
        row(C::NrrdNumbers, "NRRD, a vector", 3, None, NRRD_FRAME, "ITK, teem 1.12"),
        row(C::NumpyMatrices, "NumPy (H, W, 2, 2)", 4, Some((O::ROWS2, Usual)), PLANE_FRAME, "this program"),
        row(C::NumpyPlane, "NumPy (H, W, 9), (H, W, 3, 3)", 9, Some((O::ROWS3, Usual)), PLANE_FRAME, "NumPy"),
        row(
            C::NumpyPlane,
            "NumPy (H, W, 6)",
            6,
            Some((O::LOWER, Assumed)),
            PLANE_FRAME,
            "dipy 1.12 (`lower_triangular`)",
        ),
        row(
            C::NumpyPlane,
            "NumPy (H, W, 4)",
            4,
            Some((O::ROWS2, Assumed)),
            PLANE_FRAME,
            "NumPy (a matrix flattened)",
        ),
        row(
            C::NumpyPlane,
            "NumPy (H, W, 3)",
            3,
            Some((O::UPPER2, Assumed)),
            PLANE_FRAME,
            "NumPy (an upper triangle)",
        ),
        row(
            C::NumpyVolume,
            "NumPy (X, Y, Z, 9), (X, Y, Z, 3, 3)",
            9,
            Some((O::ROWS3, Usual)),
            AXES_FRAME,
            "dipy 1.12 (`quadratic_form`)",
        ),
        row(
            C::NumpyVolume,
            "NumPy (X, Y, Z, 6)",
            6,
            Some((O::LOWER, Assumed)),
            AXES_FRAME,
            "dipy 1.12 (`lower_triangular`)",
        ),
        row(C::NumpyVolume, "NumPy (X, Y, Z, 3), a vector", 3, None, AXES_FRAME, "nibabel 5.4"),
    ]
};

impl Content {
    /// The row of the table for a number of components.
    #[must_use]
    pub fn convention(self, components: usize) -> Option<&'static Convention> {
        CONVENTIONS.iter().find(|c| c.content == self && c.components == components)
    }

    /// The order of components where neither names nor the user say it.
    #[must_use]
    pub fn order(self, components: usize) -> Option<(TensorOrder, Known)> {
        self.convention(components)?.order
    }

    /// The axes that components are along where nothing else says it.
    #[must_use]
    pub fn frame(self, components: usize) -> (Frame, Known) {
        self.convention(components).map_or_else(|| self.usual_frame(), |c| c.frame)
    }

    /// The axes of the format: those of tuples whose size has no row.
    const fn usual_frame(self) -> (Frame, Known) {
        match self {
            Self::VtkTensors | Self::VtkArray => VTK_FRAME,
            Self::NiftiSymmetric | Self::NiftiMatrix | Self::NiftiVector | Self::NiftiNumbers => NIFTI_FRAME,
            Self::NrrdTensor | Self::NrrdNumbers => NRRD_FRAME,
            Self::NumpyPlane | Self::NumpyMatrices => PLANE_FRAME,
            Self::NumpyVolume => AXES_FRAME,
        }
    }
}

/// The tables as a page in Markdown.
#[must_use]
pub fn documentation() -> String {
    let mut page = String::from(INTRODUCTION);
    page += "\n## Defaults when the file states nothing\n\n";
    page += "| content | numbers | order | known | components along | known | written so by |\n";
    page += "| --- | --- | --- | --- | --- | --- | --- |\n";
    for c in &CONVENTIONS {
        let (order, known) = match c.order {
            Some((order, known)) => (format!("`{order}`"), known.word()),
            None => ("a vector".to_owned(), ""),
        };
        let frame = c.frame.0.name();
        page += &format!(
            "| {} | {} | {order} | {known} | `{frame}` | {} | {} |\n",
            c.words,
            c.components,
            c.frame.1.word(),
            c.programs
        );
    }
    page += "\n## Names for `--order`\n\n| name | orders | components along | written so by |\n| --- | --- | --- | --- |\n";
    for a in &ALIASES {
        let orders: Vec<String> = a.orders.iter().map(|o| format!("`{o}`")).collect();
        let frame = a.frame.map_or_else(|| "as above".to_owned(), |f| format!("`{}`", f.name()));
        page += &format!("| `{}` | {} | {frame} | {} |\n", a.name, orders.join(", "), a.programs);
    }
    page
}

const INTRODUCTION: &str = "\
# Component orders and frames

<!-- Made from crates/io/src/volume/convention.rs by `TIGEREYE_BLESS=1 cargo test -p tigereye-io --test files`. -->

A tensor file holds several numbers per point, and few formats say which is which. `tigereye` decides in this order:

1. `--order`, `--components` and `--frame`, if given.
2. The names of the components, where the file has them: `ComponentName` of VTK XML files, METADATA of legacy files, the label of an NRRD
   axis, or separate arrays whose names differ in their index pair only (`S_XX`, `S_YY`, `S_XY`). Spellings: `XX`, `xx`, `11`, `00`,
   `S11`, `SXX`, `sigma_xx`, `stress_XX`, with or without separators; digits count from 0 where a 0 occurs, else from 1.
3. The format's own statement, such as an NRRD kind or a NIfTI intent.
4. The tables below. Every command reports on standard error what is *assumed*, but not what is *stated*.

`info` prints what was decided and how it is known. Components named as principal values (`Min`, `Mid`, `Max`, `Sigma 1`) are refused:
they have no directions. `voxel` is along the voxel axes, `world` along the axes of the file's space, `fsl` along the voxel axes with x
reversed where the determinant of the affine is positive, as FSL's gradient tables have it, `lps` along left, posterior and superior, as
ITK has vectors in memory. NRRD files with a measurement frame state
their own (`measurement`); those without space directions are taken as `voxel`.

Programs with a version are run by the checks in `interop/`, the others are named after their documentation.
";
