//! Marching tetrahedra: surfaces between the nodes of a mesh, from crossings of its edges.
//!
//! Every cube of the mesh is cut into six tetrahedra along a diagonal (Freudenthal 1942): the one from the corner with
//! three even indices to the one with three odd indices (Tucker 1945). Neighbouring cubes are mirror images, so they
//! fit together, no direction is favoured, and the surfaces of a symmetric volume are symmetric if the number of nodes
//! along the axis is odd. The crossing of an edge is decided once for the edge, so there are no cracks. A tetrahedron
//! gives triangles if its crossings separate its corners into two sets; it gives none for other patterns, which occur
//! beside missing nodes and where crossings have no common orientation.

use crate::shapes::{cross, dot};
use rayon::prelude::*;

/// The crossing of an edge by the surface.
pub(crate) enum Crossing {
    /// Both ends lie on the same side, or one is missing.
    None,
    /// The edge is crossed, but by a surface that does not qualify.
    Rejected,
    /// Crossed at the fraction `at`, with the values `known` there.
    At { at: f64, known: [f64; 2] },
}

/// A mesh to march through.
pub(crate) trait Edges: Sync {
    /// The data of a node.
    type Node: Send + Sync;
    /// Nodes along each axis.
    fn nodes(&self) -> [usize; 3];
    /// The nodes of layer `k`, x fastest.
    fn layer(&self, k: usize) -> Vec<Self::Node>;
    /// The crossing of the edge between two nodes, given with their positions in nodes.
    fn crossing(&self, a: (&Self::Node, [f64; 3]), b: (&Self::Node, [f64; 3])) -> Crossing;
    /// The side a node lies on, if sides are defined globally: the normals of triangles (by the right-hand rule in x, y
    /// and the third axis) then point to the side that is `false`.
    fn side(&self, node: &Self::Node) -> Option<bool>;
}

/// A point on an edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    /// Identifies the edge: eight times the index of the lowest node of the edge, square or cube it spans, plus its
    /// axes as bits (1 for x, 2 for y, 4 for the third axis); no bit for a vertex at the node itself.
    pub(crate) key: u64,
    /// Position in nodes.
    pub(crate) place: [f64; 3],
    /// Its values.
    pub(crate) known: [f64; 2],
}

/// Unique vertices in ascending order of keys, and the triangles between them.
#[derive(Debug, Default)]
pub(crate) struct Mesh {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Layers of cubes a task marches through; the layer of nodes between two tasks is computed by both.
const LAYERS: usize = 8;
/// A point closer to a node than this fraction of an edge is moved to the node.
const SNAP: f64 = 1e-6;
/// Stands for an edge without a vertex.
const NONE: u32 = u32::MAX;
/// Stands for an edge whose vertex was rejected.
const REJECTED: u32 = u32::MAX - 1;

/// The surface through the crossings of all edges.
pub(crate) fn march<E: Edges>(edges: &E) -> Mesh {
    let nodes = edges.nodes();
    if nodes.iter().any(|&n| n < 2) {
        return Mesh::default();
    }
    let layers = nodes[2] - 1;
    let part = |c: usize| Part::march(edges, c * LAYERS..((c + 1) * LAYERS).min(layers));
    let parts: Vec<Part> = (0..layers.div_ceil(LAYERS)).into_par_iter().map(part).collect();
    welded(parts)
}

/// The result of one task.
#[derive(Default)]
struct Part {
    vertices: Vec<Vertex>,
    triangles: Vec<[u32; 3]>,
}

/// A layer of nodes, and the vertices on the edges and diagonals that start at each, by the axes they span.
struct Layer<N> {
    nodes: Vec<N>,
    on_edges: Vec<[u32; 8]>,
}

impl Part {
    fn march<E: Edges>(edges: &E, layers: core::ops::Range<usize>) -> Self {
        let mut part = Self::default();
        let mut lower = part.layer(edges, layers.start);
        for k in layers {
            let upper = part.layer(edges, k + 1);
            part.rising(edges, k, &mut lower, &upper);
            part.cubes(edges, k, &lower, &upper);
            lower = upper;
        }
        part
    }

    /// A layer with its own edges.
    fn layer<E: Edges>(&mut self, edges: &E, k: usize) -> Layer<E::Node> {
        let [nx, ny, _] = edges.nodes();
        let nodes = edges.layer(k);
        let mut on_edges = vec![[NONE; 8]; nodes.len()];
        for j in 0..ny {
            for i in 0..nx {
                for d in 1..4 {
                    if i + (d & 1) < nx && j + (d >> 1) < ny {
                        let at = |[x, y, _]: [usize; 3]| &nodes[y * nx + x];
                        on_edges[j * nx + i][d] = self.vertex(edges, ends([i, j, k], d), at);
                    }
                }
            }
        }
        Layer { nodes, on_edges }
    }

    /// The edges from a layer to the next.
    fn rising<E: Edges>(&mut self, edges: &E, k: usize, lower: &mut Layer<E::Node>, upper: &Layer<E::Node>) {
        let [nx, ny, _] = edges.nodes();
        for j in 0..ny {
            for i in 0..nx {
                for d in 4..8 {
                    if i + (d & 1) < nx && j + ((d >> 1) & 1) < ny {
                        let at = |[x, y, z]: [usize; 3]| {
                            let layer = if z == k { &lower.nodes } else { &upper.nodes };
                            &layer[y * nx + x]
                        };
                        let vertex = self.vertex(edges, ends([i, j, k], d), at);
                        lower.on_edges[j * nx + i][d] = vertex;
                    }
                }
            }
        }
    }

    /// The vertex on the edge between two nodes, which are found by their indices.
    fn vertex<'a, E: Edges>(
        &mut self,
        edges: &E,
        [a, b]: [[usize; 3]; 2],
        node: impl Fn([usize; 3]) -> &'a E::Node,
    ) -> u32
    where
        E::Node: 'a,
    {
        let [nx, ny, _] = edges.nodes();
        let [from, to] = [a, b].map(|n| n.map(|v| v as f64));
        let (at, known) = match edges.crossing((node(a), from), (node(b), to)) {
            Crossing::None => return NONE,
            Crossing::Rejected => return REJECTED,
            Crossing::At { at, known } => (at, known),
        };
        let key = |n: [usize; 3], d: usize| 8 * ((n[2] * ny + n[1]) * nx + n[0]) as u64 + d as u64;
        let (key, place) = if at < SNAP {
            (key(a, 0), from)
        } else if at > 1.0 - SNAP {
            (key(b, 0), to)
        } else {
            let lowest = [0, 1, 2].map(|axis| a[axis].min(b[axis]));
            let along = [0, 1, 2].map(|axis| usize::from(a[axis] != b[axis]) << axis);
            let place = [0, 1, 2].map(|axis| from[axis] + at * (to[axis] - from[axis]));
            (key(lowest, along.into_iter().sum()), place)
        };
        self.vertices.push(Vertex { key, place, known });
        (self.vertices.len() - 1) as u32
    }

    fn cubes<E: Edges>(&mut self, edges: &E, k: usize, lower: &Layer<E::Node>, upper: &Layer<E::Node>) {
        let [nx, ny, _] = edges.nodes();
        for j in 0..ny - 1 {
            for i in 0..nx - 1 {
                let layer = |c: usize| if c < 4 { lower } else { upper };
                let index = |c: usize| (j + ((c >> 1) & 1)) * nx + i + (c & 1);
                let even = (i & 1) | (j & 1) << 1 | (k & 1) << 2;
                for path in PATHS {
                    let corner = [0, path[0], path[0] | path[1], 7].map(|c| c ^ even);
                    let on = EDGES.map(|(a, b)| {
                        let lowest = corner[a] & corner[b];
                        layer(lowest).on_edges[index(lowest)][corner[a] ^ corner[b]]
                    });
                    if on == [NONE; 6] {
                        continue;
                    }
                    let place = |c: usize| [i + (c & 1), j + ((c >> 1) & 1), k + (c >> 2)].map(|v| v as f64);
                    let sides = corner.map(|c| (place(c), edges.side(&layer(c).nodes[index(c)])));
                    self.tetrahedron(on, sides);
                }
            }
        }
    }

    /// The triangles of a tetrahedron with these vertices on its edges, their normals away from corners inside and
    /// towards the others.
    fn tetrahedron(&mut self, on: [u32; 6], corners: [([f64; 3], Option<bool>); 4]) {
        let mut triangles = triangles_of(on);
        for triangle in triangles.iter_mut().flatten() {
            let [p, q, r] = triangle.map(|v| self.vertices[v as usize].place);
            let from = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|d| b[d] - a[d]);
            let normal = cross(from(p, q), from(p, r));
            let along = |(corner, side): ([f64; 3], Option<bool>)| {
                side.map_or(0.0, |inside| dot(normal, from(p, corner)) * if inside { -1.0 } else { 1.0 })
            };
            if corners.into_iter().map(along).sum::<f64>() < 0.0 {
                triangle.swap(1, 2);
            }
        }
        self.triangles.extend(triangles.into_iter().flatten());
    }
}

/// The ends of the edge that spans the axes `d` (bits) and starts at a node: first the end whose indices along these
/// axes are even, then the one whose are odd.
fn ends(node: [usize; 3], d: usize) -> [[usize; 3]; 2] {
    let along = [0, 1, 2].map(|axis| (d >> axis) & 1);
    let even = [0, 1, 2].map(|axis| node[axis] + along[axis] * (node[axis] & 1));
    [even, [0, 1, 2].map(|axis| if along[axis] == 0 { node[axis] } else { 2 * node[axis] + 1 - even[axis] })]
}

/// The first two steps of the six ways from the even corner of a cube to the opposite one.
const PATHS: [[usize; 2]; 6] = [[1, 2], [1, 4], [2, 1], [2, 4], [4, 1], [4, 2]];
/// Edges of a tetrahedron by their corners.
const EDGES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// One corner or two are separated from the others, or none is.
fn triangles_of(on: [u32; 6]) -> [Option<[u32; 3]>; 2] {
    let pattern = (0..6).fold(0, |m, e| m | u8::from(on[e] != NONE) << e);
    let [triangle, second] = match pattern {
        0b00_0111 => [[0, 1, 2], [0; 3]],
        0b01_1001 => [[0, 3, 4], [0; 3]],
        0b10_1010 => [[1, 3, 5], [0; 3]],
        0b11_0100 => [[2, 4, 5], [0; 3]],
        0b01_1110 => [[1, 2, 4], [1, 4, 3]],
        0b10_1101 => [[0, 2, 5], [0, 5, 3]],
        0b11_0011 => [[0, 1, 5], [0, 5, 4]],
        _ => return [None; 2],
    };
    if on.contains(&REJECTED) {
        return [None; 2];
    }
    let of = |t: [usize; 3]| t.map(|e| on[e]);
    [Some(of(triangle)), (second != [0; 3]).then(|| of(second))]
}

/// Merges vertices of the same key, in the order of keys. Triangles that collapse to a point or line are removed, as
/// are pairs that coincide: both arise from points moved to nodes.
fn welded(parts: Vec<Part>) -> Mesh {
    let mut vertices: Vec<Vertex> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for part in parts {
        let offset = vertices.len() as u32;
        vertices.extend(part.vertices);
        triangles.extend(part.triangles.iter().map(|t| t.map(|v| v + offset)));
    }
    let mut order: Vec<u32> = (0..vertices.len() as u32).collect();
    order.sort_by_key(|&v| vertices[v as usize].key);
    let mut name = vec![0; vertices.len()];
    let mut unique: Vec<Vertex> = Vec::new();
    for v in order {
        let vertex = vertices[v as usize];
        if unique.last().is_none_or(|u| u.key != vertex.key) {
            unique.push(vertex);
        }
        name[v as usize] = (unique.len() - 1) as u32;
    }
    let triangles = triangles.into_iter().map(|t| t.map(|v| name[v as usize]));
    let triangles: Vec<_> = triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect();
    Mesh { vertices: unique, triangles: without_pairs(triangles) }
}

fn without_pairs(triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    let corners = |t: [u32; 3]| {
        let mut t = t;
        t.sort_unstable();
        t
    };
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by_key(|&i| corners(triangles[i]));
    let mut kept = vec![false; triangles.len()];
    for same in order.chunk_by(|&a, &b| corners(triangles[a]) == corners(triangles[b])) {
        kept[same[0]] = same.len() % 2 == 1;
    }
    triangles.into_iter().zip(kept).filter_map(|(t, k)| k.then_some(t)).collect()
}
