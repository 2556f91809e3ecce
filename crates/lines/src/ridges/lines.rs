//! Ridges of fields: lines.

use super::RidgeBounds;
use super::mesh::{Node, RidgeMesh};
use crate::chains::{chained, without_repetitions};
use crate::tetrahedra::{Crossing, Edges};
use crate::{ExtractionError, Polyline, Polylines, RidgeOptions, Volume};
use rayon::prelude::*;
use tigereye_core::{Field, Point};

/// Ridge lines of a field, the longest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RidgeLines {
    /// The lines. They do not branch: where crests meet, lines end beside each other.
    pub shape: Polylines,
    /// Value at each point.
    pub value: Vec<f64>,
    /// Strength at each point, in values over squared (scaled) cells.
    pub strength: Vec<f64>,
    /// Length of each line, in (scaled) cells.
    pub length: Vec<f64>,
    /// The bounds that applied.
    pub bounds: RidgeBounds,
}

/// Points closer to each other than this, in cells, are merged.
const SAME: f64 = 1e-6;

/// The height ridges of a field: points where the slope along the eigenvector of the smallest eigenvalue of the
/// Hessian is zero and that eigenvalue is negative (Eberly, Ridges in Image and Data Analysis, 1996). The field is
/// interpolated by a quintic spline; ridges are searched on a mesh of `samples_per_cell` steps per cell and their
/// points refined along its edges until the slope vanishes.
///
/// Non-finite cells are missing: rows and columns at the border without any value are cut off, and there are no ridges
/// where one of the six by six cells around a point is missing, nor in the margin ([`RidgeOptions::margin`]). Constant
/// fields and fields thinner than two cells have no ridges. Beside crests narrower than a cell the spline oscillates by
/// about a fifth, which produces weak companions; [`RidgeOptions::least_value`] and `least_strength` remove them.
///
/// # Errors
/// [`ExtractionError::Option`] for an option out of range, [`ExtractionError::MeshSize`] if the mesh has too many
/// nodes.
pub fn ridge_lines(field: &Field<f64>, options: &RidgeOptions) -> Result<RidgeLines, ExtractionError> {
    let options = RidgeOptions { cell: [options.cell[0], options.cell[1], 1.0], ..*options };
    let Some(mesh) = RidgeMesh::new(&Volume::of_field(field), &options)? else {
        return Ok(RidgeLines::default());
    };
    let [nx, ny, _] = mesh.nodes();
    let nodes = mesh.layer(0);
    let row = |j: usize| row_of_edges(&mesh, &nodes, j);
    let rows: Vec<Vec<[Mark; 3]>> = (0..ny).into_par_iter().map(row).collect();
    // Number the points by the edge they lie on, in the order of nodes, whatever thread found them.
    let mut found = RidgeLines::default();
    let mut on_edges = vec![[NONE; 3]; nodes.len()];
    for (i, marks) in rows.into_iter().flatten().enumerate() {
        for (d, mark) in marks.into_iter().enumerate() {
            if let Mark::At { position, value, strength } = mark {
                on_edges[i][d] = found.value.len() as u32;
                found.shape.points.push(position);
                found.value.push(value);
                found.strength.push(strength);
            } else if matches!(mark, Mark::Rejected) {
                on_edges[i][d] = REJECTED;
            }
        }
    }
    found.bounds = mesh.bounds();
    // Join the crossings within each triangle, and the segments to lines.
    let segments = segments(&on_edges, [nx, ny]);
    let mut lines = chained(found.value.len(), &segments);
    without_repetitions(&mut lines, &found.shape.points, SAME);
    Ok(found.with(lines, &options))
}

/// Stands for an edge without a point.
const NONE: u32 = u32::MAX;
/// Stands for an edge whose point was rejected.
const REJECTED: u32 = u32::MAX - 1;

/// The crossing of an edge.
enum Mark {
    None,
    Rejected,
    At { position: Point, value: f64, strength: f64 },
}

/// Whether the square to the lower right of a node is cut from its upper left to its lower right corner, rather than
/// from the upper right to the lower left one. Neighbouring squares alternate, so that a mesh of an even number of
/// squares is its own mirror image and no direction of ridges is favoured.
const fn falls(i: usize, j: usize) -> bool {
    (i + j).is_multiple_of(2)
}

/// Both ends of the edges of a node: to the right, downwards, and across the square between them.
const fn edges_of(i: usize, j: usize) -> [[[usize; 2]; 2]; 3] {
    let across = if falls(i, j) { [[i, j], [i + 1, j + 1]] } else { [[i + 1, j], [i, j + 1]] };
    [[[i, j], [i + 1, j]], [[i, j], [i, j + 1]], across]
}

fn row_of_edges(mesh: &RidgeMesh, nodes: &[Node], j: usize) -> Vec<[Mark; 3]> {
    let [nx, ny, _] = mesh.nodes();
    let at = |[i, j]: [usize; 2]| (&nodes[j * nx + i], [i as f64, j as f64, 0.0]);
    let mark = |[from, to]: [[usize; 2]; 2]| {
        if from[0].max(to[0]) >= nx || from[1].max(to[1]) >= ny {
            return Mark::None;
        }
        match mesh.crossing(at(from), at(to)) {
            Crossing::None => Mark::None,
            Crossing::Rejected => Mark::Rejected,
            Crossing::At { at, known: [value, strength] } => {
                let [i, j] = [0, 1].map(|d| from[d] as f64 + at * (to[d] as f64 - from[d] as f64));
                let [x, y, _] = mesh.in_volume([i, j, 0.0]);
                let [value, strength] = [value, strength].map(|v| mesh.unscaled(v));
                Mark::At { position: Point::new(x, y), value, strength }
            }
        }
    };
    (0..nx).map(|i| edges_of(i, j).map(mark)).collect()
}

/// One segment in each triangle of which exactly two edges are crossed.
fn segments(on_edges: &[[u32; 3]], [nx, ny]: [usize; 2]) -> Vec<[u32; 2]> {
    let mut segments = Vec::new();
    for j in 0..ny.saturating_sub(1) {
        for i in 0..nx.saturating_sub(1) {
            let node = j * nx + i;
            let [top, left, across] = on_edges[node];
            let (right, bottom) = (on_edges[node + 1][1], on_edges[node + nx][0]);
            // The sides that meet at the two corners off the diagonal.
            let corners =
                if falls(i, j) { [[top, right], [left, bottom]] } else { [[top, left], [right, bottom]] };
            for [a, b] in corners {
                let triangle = [a, b, across];
                let mut crossed = triangle.into_iter().filter(|&p| p != NONE);
                if let (Some(a), Some(b), None) = (crossed.next(), crossed.next(), crossed.next())
                    && a != REJECTED
                    && b != REJECTED
                {
                    segments.push([a, b]);
                }
            }
        }
    }
    segments
}

impl RidgeLines {
    /// Keeps the lines that are long enough, longest first, and only the points they use.
    fn with(self, lines: Vec<Polyline>, options: &RidgeOptions) -> Self {
        let cell = [options.cell[0], options.cell[1]];
        let mut measured: Vec<(f64, Polyline)> =
            lines.into_iter().map(|l| (self.shape.length(&l, cell), l)).collect();
        measured.retain(|(length, _)| *length >= options.least_extent);
        measured.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut found = Self { bounds: self.bounds, ..Self::default() };
        for (length, line) in measured {
            let first = found.value.len() as u32;
            for &p in &line.points {
                let p = p as usize;
                found.shape.points.push(self.shape.points[p]);
                found.value.push(self.value[p]);
                found.strength.push(self.strength[p]);
            }
            let points = (first..found.value.len() as u32).collect();
            found.shape.lines.push(Polyline { points, closed: line.closed });
            found.length.push(length);
        }
        found
    }
}
