//! The tensor kinds of the format, and which axis of an array is the tensor's.

use crate::volume::{Content, Known, Naming, TensorOrder, naming};

/// A tensor kind of the format.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind {
    pub(super) name: &'static str,
    pub(super) order: TensorOrder,
    pub(super) masked: bool,
}

/// All of them: kinds 24 to 31 of the format's list.
pub(super) const KINDS: [Kind; 8] = [
    Kind { name: "2D-symmetric-matrix", order: TensorOrder::UPPER2, masked: false },
    Kind { name: "2D-masked-symmetric-matrix", order: TensorOrder::UPPER2, masked: true },
    Kind { name: "2D-matrix", order: TensorOrder::ROWS2, masked: false },
    Kind { name: "2D-masked-matrix", order: TensorOrder::ROWS2, masked: true },
    Kind { name: "3D-symmetric-matrix", order: TensorOrder::UPPER, masked: false },
    Kind { name: "3D-masked-symmetric-matrix", order: TensorOrder::UPPER, masked: true },
    Kind { name: "3D-matrix", order: TensorOrder::ROWS3, masked: false },
    Kind { name: "3D-masked-matrix", order: TensorOrder::ROWS3, masked: true },
];

impl Kind {
    /// Numbers per tuple, the mask among them.
    pub(super) const fn tuple(&self) -> usize {
        self.order.components() + self.masked as usize
    }
}

/// Which axis of the array is the tensor's, and which are the lattice's.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub(super) kind: Option<Kind>,
    pub(super) masked: bool,
    /// The tensor's axis.
    pub(super) axis: usize,
    /// Its size.
    pub(super) tuple: usize,
    /// The lattice's axes, fastest first.
    pub(super) lattice: Vec<usize>,
    pub(super) size: [usize; 3],
    /// Numbers before the tensor's axis: voxels that come in one run per component.
    pub(super) inner: usize,
}

impl Layout {
    /// By the names of the components, else that of the kind, else by the tables.
    pub(super) fn order(&self, names: &[String], components: usize) -> Option<(TensorOrder, Known)> {
        match (naming(names, components), self.kind) {
            (Naming::Tensor(order), _) => Some((order, Known::Stated)),
            (_, Some(kind)) => Some((kind.order, Known::Stated)),
            (_, None) => Content::NrrdNumbers.order(components),
        }
    }

    /// Tuples voxel by voxel and the mask apart.
    pub(super) fn tuples(&self, stored: Vec<f64>) -> (Vec<f64>, Option<Vec<f64>>) {
        if self.inner == 1 && !self.masked {
            return (stored, None);
        }
        let voxels = stored.len() / self.tuple;
        let skip = usize::from(self.masked);
        let mut values = Vec::with_capacity(voxels * (self.tuple - skip));
        let mut mask = Vec::with_capacity(if self.masked { voxels } else { 0 });
        for voxel in 0..voxels {
            let first = (voxel / self.inner) * self.inner * self.tuple + voxel % self.inner;
            let number = |c: usize| stored[first + c * self.inner];
            if self.masked {
                mask.push(number(0));
            }
            values.extend((skip..self.tuple).map(number));
        }
        (values, self.masked.then_some(mask))
    }
}
