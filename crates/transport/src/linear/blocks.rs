//! How a grid is halved again and again until its blocks are single cells, and which light passes between the halves.
//!
//! An *edge* is the light that enters a cell in one of eight directions: the number `8 cell + k` holds it. A block has
//! edges that enter it, edges that leave it (they enter cells outside), and edges between its halves. Every edge inside
//! the grid passes between the halves of exactly one block. Blocks of equal size at equal sides of the grid have the
//! same edges relative to their first cell, so these lists are made once per shape.

use std::collections::HashMap;
use std::ops::Range;
use tigereye_core::{Grid, NEIGHBOUR_OFFSETS};

/// Blocks of one size, at the same sides of the grid.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// Edges that enter, relative to the first cell's edge 0.
    pub(super) entering: Vec<isize>,
    /// Edges that leave.
    pub(super) leaving: Vec<isize>,
    /// The two halves and what passes between them; `None` for a single cell.
    pub(super) halves: Option<Halves>,
}

/// What passes between the two halves of a block, and how their edges become those of the block: those of the first
/// half that do not lead to the second, then those of the second.
#[derive(Clone, Debug)]
pub(super) struct Halves {
    shapes: [usize; 2],
    /// First cell of the second half, relative to that of the block.
    second: usize,
    /// Edges from the first half to the second, and back.
    pub(super) forth: Vec<isize>,
    pub(super) back: Vec<isize>,
    pub(super) sides: [Side; 2],
}

/// One half: places in its own lists of edges.
#[derive(Clone, Debug)]
pub(super) struct Side {
    /// Edges that enter from outside of the block, as the block's.
    pub(super) entering: Vec<isize>,
    /// Edges that leave the block.
    pub(super) leaving: Vec<isize>,
    /// Their places among the half's own.
    pub(super) entering_places: Vec<u32>,
    pub(super) leaving_places: Vec<u32>,
    /// Places of the edges that come from the other half, and of those that lead there.
    pub(super) from_other: Vec<u32>,
    pub(super) to_other: Vec<u32>,
}

/// A block of the grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    /// Which of the shapes.
    pub(super) shape: usize,
    /// Row-major number of its first cell.
    pub(super) first: usize,
    /// Its halves, as numbers of blocks; `None` for a single cell.
    pub(super) halves: Option<[usize; 2]>,
    /// The block it is a half of; itself for the whole grid.
    pub(super) parent: usize,
}

/// All blocks of a grid: the whole grid first, then generation by generation, with the blocks of one generation
/// contiguous.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    pub(super) shapes: Vec<Shape>,
    pub(super) blocks: Vec<Block>,
    /// Blocks of the same depth.
    pub(super) generations: Vec<Range<usize>>,
    /// Every block after its halves, those of a block one after the other: what is worked on stays in the cache.
    pub(super) order: Vec<usize>,
    /// The block of each single cell.
    pub(super) of_cell: Vec<usize>,
}

/// Width, height, and whether each side (left, right, top, bottom) lies at the rim of the grid.
type Key = (usize, usize, [bool; 4]);

impl Blocks {
    pub(super) fn of(grid: Grid) -> Self {
        let mut shapes = Shapes { stride: grid.width(), known: HashMap::new(), shapes: Vec::new() };
        let root = shapes.of((grid.width(), grid.height(), [true; 4]));
        let shapes = shapes.shapes;
        let mut blocks = vec![Block { shape: root, first: 0, halves: None, parent: 0 }];
        let mut of_cell = vec![0; grid.cells()];
        let mut generations = Vec::new();
        let mut generation = 0..1;
        while !generation.is_empty() {
            generations.push(generation.clone());
            for i in generation.clone() {
                let Block { shape, first, .. } = blocks[i];
                let Some(halves) = &shapes[shape].halves else {
                    of_cell[first] = i;
                    continue;
                };
                let half = |shape, first| Block { shape, first, halves: None, parent: i };
                blocks[i].halves = Some([blocks.len(), blocks.len() + 1]);
                blocks.push(half(halves.shapes[0], first));
                blocks.push(half(halves.shapes[1], first + halves.second));
            }
            generation = generation.end..blocks.len();
        }
        let order = halves_first(&blocks);
        Self { shapes, blocks, generations, order, of_cell }
    }

    /// The halves of a block and what passes between them.
    pub(super) fn halves(&self, block: usize) -> Option<(&Halves, [usize; 2])> {
        let block = &self.blocks[block];
        self.shapes[block.shape].halves.as_ref().zip(block.halves)
    }
}

/// The numbers of all blocks, each after its halves.
fn halves_first(blocks: &[Block]) -> Vec<usize> {
    let mut order = Vec::with_capacity(blocks.len());
    let mut open = vec![0];
    // Wholes before halves, the second half first, read backwards.
    while let Some(block) = open.pop() {
        order.push(block);
        open.extend(blocks[block].halves.into_iter().flatten());
    }
    order.reverse();
    order
}

/// Shapes in the making.
struct Shapes {
    stride: usize,
    known: HashMap<Key, usize>,
    shapes: Vec<Shape>,
}

impl Shapes {
    fn of(&mut self, key: Key) -> usize {
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let (width, height, rim) = key;
        let shape = if (width, height) == (1, 1) { self.cell(rim) } else { self.halved(key) };
        debug_assert!(width * height > 0);
        self.shapes.push(shape);
        self.known.insert(key, self.shapes.len() - 1);
        self.shapes.len() - 1
    }

    /// Edge `k` of the cell at `(x, y)`, relative to the block's first cell.
    const fn edge(&self, x: isize, y: isize, k: usize) -> isize {
        (y * self.stride as isize + x) * 8 + k as isize
    }

    fn cell(&self, [left, right, top, bottom]: [bool; 4]) -> Shape {
        let inside =
            |dx: isize, dy: isize| !(dx < 0 && left || dx > 0 && right || dy < 0 && top || dy > 0 && bottom);
        let (mut entering, mut leaving) = (Vec::new(), Vec::new());
        for (k, (dx, dy)) in NEIGHBOUR_OFFSETS.into_iter().enumerate() {
            if inside(-dx, -dy) {
                entering.push(self.edge(0, 0, k));
            }
            if inside(dx, dy) {
                leaving.push(self.edge(dx, dy, k));
            }
        }
        Shape { entering, leaving, halves: None }
    }

    fn halved(&mut self, (width, height, [left, right, top, bottom]): Key) -> Shape {
        let (first, second, offset) = if width >= height {
            let w = width / 2;
            ((w, height, [left, false, top, bottom]), (width - w, height, [false, right, top, bottom]), w)
        } else {
            let h = height / 2;
            let offset = h * self.stride;
            ((width, h, [left, right, top, false]), (width, height - h, [left, right, false, bottom]), offset)
        };
        let shapes = [self.of(first), self.of(second)];
        let shift = [0, offset as isize * 8];
        let edges = |half: usize| {
            let shape = &self.shapes[shapes[half]];
            let shifted = |edges: &[isize]| edges.iter().map(|e| e + shift[half]).collect::<Vec<_>>();
            (shifted(&shape.entering), shifted(&shape.leaving))
        };
        let (first, second) = (edges(0), edges(1));
        let passing = |from: &[isize], to: &[isize]| -> Vec<isize> {
            let to: std::collections::HashSet<_> = to.iter().collect();
            from.iter().copied().filter(|e| to.contains(e)).collect()
        };
        let forth = passing(&first.1, &second.0);
        let back = passing(&second.1, &first.0);
        let sides = [side(&first, &back, &forth), side(&second, &forth, &back)];
        Shape {
            entering: [&*sides[0].entering, &*sides[1].entering].concat(),
            leaving: [&*sides[0].leaving, &*sides[1].leaving].concat(),
            halves: Some(Halves { shapes, second: offset, forth, back, sides }),
        }
    }
}

/// Sorts the edges of a half (entering, leaving) into those of the block and those that pass between the halves.
fn side((entering, leaving): &(Vec<isize>, Vec<isize>), from_other: &[isize], to_other: &[isize]) -> Side {
    let places = |own: &[isize], of: &[isize]| -> Vec<u32> {
        let place: HashMap<_, _> = own.iter().zip(0..).collect();
        of.iter().map(|e| place[e]).collect()
    };
    let without = |own: &[isize], others: &[isize]| -> Vec<isize> {
        let others: std::collections::HashSet<_> = others.iter().collect();
        own.iter().copied().filter(|e| !others.contains(e)).collect()
    };
    let (outer_entering, outer_leaving) = (without(entering, from_other), without(leaving, to_other));
    Side {
        entering_places: places(entering, &outer_entering),
        leaving_places: places(leaving, &outer_leaving),
        from_other: places(entering, from_other),
        to_other: places(leaving, to_other),
        entering: outer_entering,
        leaving: outer_leaving,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_edge_inside_the_grid_passes_between_two_halves_once() {
        for (width, height) in [(1, 1), (2, 1), (5, 3), (8, 8), (13, 7)] {
            let grid = Grid::new(width, height).expect("a grid");
            let blocks = Blocks::of(grid);
            let mut seen = vec![0; grid.cells() * 8];
            for (i, block) in blocks.blocks.iter().enumerate() {
                if let Some((halves, _)) = blocks.halves(i) {
                    for e in halves.forth.iter().chain(&halves.back) {
                        seen[(block.first as isize * 8 + e) as usize] += 1;
                    }
                }
            }
            for cell in grid.iter() {
                for k in 0..8 {
                    let from_inside = usize::from(grid.neighbour(cell, (k + 4) % 8).is_some());
                    assert_eq!(seen[grid.index(cell) * 8 + k], from_inside, "{cell:?}, {k}");
                }
            }
            let root = &blocks.shapes[blocks.blocks[0].shape];
            assert!(root.entering.is_empty() && root.leaving.is_empty());
        }
    }
}
