//! Surfaces of equal value between samples.

use super::isolines::crossing;
use crate::tetrahedra::{Crossing, Edges, march};
use crate::{Surface, Volume};

/// The surface on which values, linear on tetrahedra between samples, equal `level` (marching tetrahedra). Periodic
/// axes close; see [`Surface`] for the seam. The normals of the triangles, by the right-hand rule in x, y and the third
/// axis, point to lower values. Values equal to the level count as above it. The surface ends at open borders and
/// beside non-finite samples. It is empty for a level that is not finite, and for a volume with fewer than two samples
/// along an axis.
#[must_use]
pub fn isosurface(volume: &Volume<'_>, level: f64) -> Surface {
    if !level.is_finite() || volume.size().iter().any(|&s| s < 2) {
        return Surface::default();
    }
    let mesh = march(&Samples { volume, level });
    let mut name = vec![u32::MAX; mesh.vertices.len()];
    let mut surface = Surface::default();
    for triangle in &mesh.triangles {
        for &v in triangle {
            if name[v as usize] == u32::MAX {
                name[v as usize] = surface.points.len() as u32;
                surface.points.push(volume.position(mesh.vertices[v as usize].place));
            }
        }
        surface.triangles.push(triangle.map(|v| name[v as usize]));
    }
    surface
}

/// The samples themselves as nodes.
struct Samples<'a> {
    volume: &'a Volume<'a>,
    level: f64,
}

impl Edges for Samples<'_> {
    type Node = f64;

    fn nodes(&self) -> [usize; 3] {
        [0, 1, 2].map(|d| self.volume.size()[d] + usize::from(self.volume.periodic()[d]))
    }

    fn layer(&self, k: usize) -> Vec<f64> {
        let size = self.volume.size();
        let [nx, ny, _] = self.nodes();
        let value = |i: usize, j: usize| {
            self.volume.values()[((k % size[2]) * size[1] + j % size[1]) * size[0] + i % size[0]]
        };
        (0..ny).flat_map(|j| (0..nx).map(move |i| value(i, j))).collect()
    }

    fn crossing(&self, a: (&f64, [f64; 3]), b: (&f64, [f64; 3])) -> Crossing {
        crossing(*a.0, *b.0, self.level)
            .map_or(Crossing::None, |at| Crossing::At { at, known: [self.level, 0.0] })
    }

    fn side(&self, node: &f64) -> Option<bool> {
        Some(*node >= self.level)
    }
}
