//! Ridges of volumes: surfaces.

use super::RidgeBounds;
use super::mesh::RidgeMesh;
use crate::tetrahedra::{Edges, Mesh, march};
use crate::{ExtractionError, RidgeOptions, Surface, Volume};

/// Ridge surfaces of a volume.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RidgeSurface {
    /// The triangles. Their orientation is arbitrary: both sides of a ridge are alike.
    pub shape: Surface,
    /// Value at each point.
    pub value: Vec<f64>,
    /// Strength at each point, in values over squared (scaled) cells.
    pub strength: Vec<f64>,
    /// Connected component of each triangle, 0 the largest. Triangles that share a point are connected, also across the
    /// seam of a periodic axis.
    pub piece: Vec<u32>,
    /// Area of each piece, in squared (scaled) cells.
    pub area: Vec<f64>,
    /// The bounds that applied.
    pub bounds: RidgeBounds,
}

/// The height ridges of codimension 1 of a volume, as [`crate::ridge_lines`] finds those of a field: where the slope
/// along the eigenvector of the smallest eigenvalue of the Hessian is zero and that eigenvalue is negative (Eberly
/// 1996). The cubes of the mesh are cut into tetrahedra, within each of which the eigenvectors are aligned; if that is
/// impossible, the surface has a hole. Volumes with one sample along an axis have no surfaces. Time grows with the
/// third power of `samples_per_cell`: one step per sample suffices for crests a few samples apart.
///
/// The result depends on the scale of the third axis ([`RidgeOptions::cell`]), which the caller has to choose.
///
/// # Errors
/// [`ExtractionError::Option`] for an option out of range, [`ExtractionError::MeshSize`] if the mesh has too many
/// nodes.
pub fn ridge_surface(volume: &Volume<'_>, options: &RidgeOptions) -> Result<RidgeSurface, ExtractionError> {
    let Some(edges) = RidgeMesh::new(volume, options)? else {
        return Ok(RidgeSurface::default());
    };
    let mesh = march(&edges);
    let known = |i: usize| mesh.vertices[i].known.map(|v| edges.unscaled(v));
    let place = |i: usize| volume.position(edges.in_volume(mesh.vertices[i].place));
    let shape =
        Surface { points: (0..mesh.vertices.len()).map(place).collect(), triangles: mesh.triangles.clone() };
    let pieces = pieces(&mesh, &shape.triangles, edges.nodes(), volume.periodic());
    let mut found = RidgeSurface { bounds: edges.bounds(), ..RidgeSurface::default() };
    let large = Pieces::new(&shape, &pieces, options);
    let mut name = vec![u32::MAX; mesh.vertices.len()];
    for (triangle, piece) in shape.triangles.iter().zip(&large.of_triangle) {
        let Some(piece) = piece else { continue };
        for &v in triangle {
            if name[v as usize] == u32::MAX {
                name[v as usize] = found.value.len() as u32;
                let [value, strength] = known(v as usize);
                found.shape.points.push(shape.points[v as usize]);
                found.value.push(value);
                found.strength.push(strength);
            }
        }
        found.shape.triangles.push(triangle.map(|v| name[v as usize]));
        found.piece.push(*piece);
    }
    found.area = large.area;
    Ok(found)
}

/// The lowest connected vertex of each triangle, which identifies its component.
fn pieces(mesh: &Mesh, triangles: &[[u32; 3]], nodes: [usize; 3], periodic: [bool; 3]) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    // Join vertices on both sides of a seam: those at its far end get the key of the near end.
    let mut near: Vec<(u64, u32)> =
        mesh.vertices.iter().zip(0..).map(|(v, i)| (at_seam(v.key, nodes, periodic), i)).collect();
    near.sort_unstable();
    for w in near.windows(2).filter(|w| w[0].0 == w[1].0) {
        join(&mut parent, w[0].1, w[1].1);
    }
    for t in triangles {
        join(&mut parent, t[0], t[1]);
        join(&mut parent, t[0], t[2]);
    }
    triangles.iter().map(|t| root(&mut parent, t[0])).collect()
}

/// The key of a vertex with nodes at the far end of periodic axes replaced by those at the near end.
fn at_seam(key: u64, nodes: [usize; 3], periodic: [bool; 3]) -> u64 {
    let (node, direction) = ((key / 8) as usize, key % 8);
    let at = [node % nodes[0], node / nodes[0] % nodes[1], node / (nodes[0] * nodes[1])];
    let at = [0, 1, 2].map(|d| if periodic[d] && at[d] + 1 == nodes[d] { 0 } else { at[d] });
    8 * ((at[2] * nodes[1] + at[1]) * nodes[0] + at[0]) as u64 + direction
}

fn root(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}

fn join(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parent, a), root(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

/// The components of sufficient area.
struct Pieces {
    of_triangle: Vec<Option<u32>>,
    area: Vec<f64>,
}

impl Pieces {
    fn new(shape: &Surface, root: &[u32], options: &RidgeOptions) -> Self {
        let mut area = vec![0.0; shape.points.len()];
        for (&t, &r) in shape.triangles.iter().zip(root) {
            area[r as usize] += shape.area_of(t, options.cell);
        }
        let mut roots = root.to_vec();
        roots.sort_unstable();
        roots.dedup();
        roots.retain(|&r| area[r as usize] >= options.least_extent);
        roots.sort_by(|&a, &b| area[b as usize].total_cmp(&area[a as usize]));
        let mut rank = vec![None; shape.points.len()];
        for (i, &r) in roots.iter().enumerate() {
            rank[r as usize] = Some(i as u32);
        }
        Self {
            of_triangle: root.iter().map(|&r| rank[r as usize]).collect(),
            area: roots.iter().map(|&r| area[r as usize]).collect(),
        }
    }
}
