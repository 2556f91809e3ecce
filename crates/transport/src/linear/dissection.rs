//! The stationary light of any sources, directly: the grid is taken apart into blocks, and the way light passes to and
//! fro between the halves of each is summed up in closed form.
//!
//! A block answers what enters it with what leaves it, a matrix. Two halves with the answers `R1` and `R2` pass light
//! to and fro: what goes back from the second to the first is `b = (I - R2' R1')^-1 (...)`, where `R'` are the parts of
//! the answers between the halves. So the answer of the whole follows from those of the halves (as in the adding method
//! for layers: van de Hulst 1963; for sparse matrices: nested dissection, George 1973). All entries are parts of light,
//! none is negative, and no pivoting is needed.
//!
//! With the answers known, sources take two passes through the blocks. From the cells to the whole, each block learns
//! what the sources inside it send between its halves and out of it while nothing enters; from the whole to the cells,
//! it learns what really enters. Nothing iterates, so nothing has to converge.

use super::blocks::{Blocks, Halves, Shape};
use super::cells::LinearScattering;
use super::dense::{Lanes, Packed, PackedSlice, Tiles, inverse_of_one_minus};
use super::parallel::{Parallel, Serial};
use crate::TransportError;
use crate::real::Real;
use std::ops::Range;
use std::sync::{Mutex, OnceLock};
use tigereye_core::{Cell, Grid};
use tigereye_simd::{Level, Proven, Task, Vector};

/// Which system is solved: that of light, or its adjoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// From sources: `a = A a + q`.
    Forward,
    /// Back from receivers: `x = A^T x + r`.
    Adjoint,
}

/// A field, prepared for stationary light of many sources in N lanes.
///
/// Edges are numbered `8 cell + k`. From sources, edge `(cell, k)` holds the flux (W) that enters the cell in direction
/// k. Back from receivers, edge `(cell, k)` holds what a flux of 1 W that *leaves* the cell towards the neighbour at
/// `k + 4` contributes to the receivers: light that is followed backwards enters from there.
pub struct Dissection<T, const N: usize> {
    grid: Grid,
    level: Level,
    blocks: Blocks,
    /// What passes between the halves of each block; nothing for single cells.
    merges: Vec<OnceLock<Merge<T>>>,
    /// The longest lists of edges: between the halves of a block and at one of its halves.
    longest: [usize; 2],
}

/// What passes between the two halves of a block: seven matrices, one after the other. A grid has as many of these as
/// cells, most of them a few dozen numbers, so that an allocation for each matrix would cost as much as the numbers.
struct Merge<T>(Box<[T]>);

/// The matrices of a [`Merge`].
struct Matrices<'a, T> {
    /// `(I - R2' R1')^-1`, over the edges back.
    to_and_fro: PackedSlice<'a, T>,
    /// What each half answers to light from the other, back to it and out of the block.
    returned: [PackedSlice<'a, T>; 2],
    sent_out: [PackedSlice<'a, T>; 2],
    /// What each half passes to the other of light from outside of the block.
    let_through: [PackedSlice<'a, T>; 2],
}

/// Rows and columns of the matrices between two halves, in the order of [`Matrices`].
fn shapes_between(halves: &Halves) -> [[usize; 2]; 7] {
    let (forth, back) = (halves.forth.len(), halves.back.len());
    let [one, two] = &halves.sides;
    [
        [back, back],
        [forth, back],
        [back, forth],
        [one.leaving.len(), back],
        [two.leaving.len(), forth],
        [forth, one.entering.len()],
        [back, two.entering.len()],
    ]
}

impl<T: Real> Merge<T> {
    fn of(matrices: [&Packed<T>; 7]) -> Self {
        Self(matrices.map(Packed::numbers).concat().into_boxed_slice())
    }

    #[inline(always)]
    fn matrices(&self, halves: &Halves) -> Matrices<'_, T> {
        let mut rest = &*self.0;
        let [to_and_fro, r1, r2, s1, s2, l1, l2] = shapes_between(halves).map(|shape| {
            let (matrix, after) = PackedSlice::split_from(rest, shape);
            rest = after;
            matrix
        });
        Matrices { to_and_fro, returned: [r1, r2], sent_out: [s1, s2], let_through: [l1, l2] }
    }
}

/// Buffers of a solution.
#[derive(Clone, Debug)]
pub struct Workspace<T, const N: usize>([Vec<Lanes<T, N>>; 5]);

/// What the buffers hold.
const FORTH: usize = 0;
const BACK: usize = 1;
/// What goes back before it has been to and fro.
const FIRST_BACK: usize = 2;
/// What passes between each half and the outside of the block.
const OUTSIDE: [usize; 2] = [3, 4];

/// The passes through the blocks.
#[derive(Clone, Copy)]
enum Pass {
    /// What the sources in a block send between its halves and out of it while nothing enters. The edges hold what the
    /// halves alone send there.
    Collect,
    /// Adds to the edges between the halves of a block what enters it from outside; those edges are final.
    Distribute,
}

/// What a block answers to what enters it: rows are edges that leave, columns edges that enter.
type Answer<T, const N: usize> = Result<Tiles<T, N>, Trapped>;

/// Light can get into a block and (next to) nothing of it ever leaves.
#[derive(Clone, Copy, Debug)]
struct Trapped {
    block: usize,
}

/// The generation whose blocks are prepared by one thread each: enough of them to keep the threads equally busy.
fn subtrees(blocks: &Blocks) -> usize {
    let many = blocks.generations.iter().position(|generation| generation.len() >= 64);
    many.unwrap_or(blocks.generations.len() - 1)
}

/// Of light that cannot leave, less than this part leaves per passage: what rounding makes of 0.
fn smallest_pivot<T: Real>() -> T {
    T::from_f64(T::SMALLEST_PIVOT)
}

impl<T: Real, const N: usize> Dissection<T, N> {
    /// Prepares `field`. Independent parts of the work go to `parallel`; the result does not depend on it.
    ///
    /// # Errors
    /// [`TransportError::Trapped`] where light can get into a part of the field that (next to) nothing leaves: there is
    /// no stationary state then.
    pub fn new(
        field: &LinearScattering<'_>,
        operator: Operator,
        level: Level,
        parallel: &dyn Parallel,
    ) -> Result<Self, TransportError> {
        let grid = field.grid();
        let blocks = Blocks::of(grid);
        let mut longest = [0, 0];
        for halves in blocks.shapes.iter().filter_map(|s| s.halves.as_ref()) {
            longest[0] = longest[0].max(halves.forth.len()).max(halves.back.len());
            let outer = halves.sides.iter().flat_map(|s| [s.entering.len(), s.leaving.len()]);
            longest[1] = longest[1].max(outer.max().unwrap_or(0));
        }
        let merges = blocks.blocks.iter().map(|_| OnceLock::new()).collect();
        let made = Self { grid, level, blocks, merges, longest };
        made.factorize(field, operator, parallel)?;
        Ok(made)
    }

    /// The grid.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        self.grid
    }

    /// Bytes of the prepared matrices.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.merges.iter().filter_map(|m| m.get()).map(|m| size_of_val(&*m.0)).sum()
    }

    /// Bytes that [`Self::new`] needs for a grid at the same time: the matrices it prepares, and what lies between its
    /// blocks on the way.
    #[must_use]
    pub fn bytes_for(grid: Grid) -> u128 {
        let blocks = Blocks::of(grid);
        let kept = |shape: &Shape| {
            let matrices = shape.halves.as_ref().map_or([[0, 0]; 7], shapes_between);
            let numbers: usize = matrices.into_iter().map(|[rows, columns]| rows * columns).sum();
            // The cell of the list, and what an allocation costs.
            size_of::<T>() * numbers + size_of::<OnceLock<Merge<T>>>() + 16
        };
        let answer =
            |shape: &Shape| shape.leaving.len() * shape.entering.len().div_ceil(N) * size_of::<Lanes<T, N>>();
        let kept: Vec<usize> = blocks.shapes.iter().map(kept).collect();
        let answers: Vec<usize> = blocks.shapes.iter().map(answer).collect();
        let of_generation = |of_shape: &[usize], generation: &Range<usize>| -> u128 {
            blocks.blocks[generation.clone()].iter().map(|b| of_shape[b.shape] as u128).sum()
        };
        let subtrees = subtrees(&blocks);
        let below = &blocks.generations[subtrees + 1..];
        let mut done: u128 = below.iter().map(|g| of_generation(&kept, g)).sum();
        let mut most = 0;
        for generation in blocks.generations[..=subtrees].iter().rev() {
            done += of_generation(&kept, generation);
            most = most.max(done + of_generation(&answers, generation));
        }
        // The products of the largest blocks.
        most + 8 * answers.iter().max().map_or(0, |bytes| *bytes as u128)
    }

    /// Subtrees first, each by one thread and its deepest blocks first, so that no more answers than those of its
    /// halves wait at a time; then the few large blocks above, which share the threads in each product.
    fn factorize(
        &self,
        field: &LinearScattering<'_>,
        operator: Operator,
        parallel: &dyn Parallel,
    ) -> Result<(), TransportError> {
        let subtrees = subtrees(&self.blocks);
        let roots = self.blocks.generations[subtrees].clone();
        let answers: Vec<Mutex<Option<Answer<T, N>>>> = (0..roots.end).map(|_| Mutex::new(None)).collect();
        let keep = |block: usize, answer| *answers[block].lock().expect("no task panics") = Some(answer);
        parallel.for_each(roots.len(), &|i| {
            keep(roots.start + i, self.answer_of(field, operator, roots.start + i));
        });
        for generation in self.blocks.generations[..subtrees].iter().rev() {
            for block in generation.clone() {
                let take = |half: usize| answers[half].lock().expect("no task panics").take();
                let answer = match self.blocks.halves(block) {
                    None => Ok(self.answer_of_cell(field, operator, block)),
                    Some((halves, [first, second])) => {
                        let halves_answer =
                            [take(first), take(second)].map(|a| a.expect("halves before wholes"));
                        self.join(block, halves, halves_answer, parallel)
                    }
                };
                keep(block, answer);
            }
        }
        let whole = answers[0].lock().expect("no task panics").take();
        let Some(Err(Trapped { block })) = whole else { return Ok(()) };
        let Cell { x, y } = self.grid.cell(self.blocks.blocks[block].first);
        Err(TransportError::Trapped { x, y })
    }

    /// What a block answers, with everything inside it prepared.
    fn answer_of(&self, field: &LinearScattering<'_>, operator: Operator, block: usize) -> Answer<T, N> {
        let Some((halves, numbers)) = self.blocks.halves(block) else {
            return Ok(self.answer_of_cell(field, operator, block));
        };
        let answers = numbers.map(|half| self.answer_of(field, operator, half));
        self.join(block, halves, answers, &Serial)
    }

    /// Prepares a block of two halves. Where both trap light, the first one's place is reported.
    fn join(
        &self,
        block: usize,
        halves: &Halves,
        [first, second]: [Answer<T, N>; 2],
        parallel: &dyn Parallel,
    ) -> Answer<T, N> {
        let (merge, answer) =
            self.merge(halves, [first?, second?], block == 0, parallel).map_err(|_| Trapped { block })?;
        assert!(self.merges[block].set(merge).is_ok(), "each block once");
        Ok(answer)
    }

    /// What a single cell answers: rows are edges that leave, columns edges that enter.
    fn answer_of_cell(&self, field: &LinearScattering<'_>, operator: Operator, block: usize) -> Tiles<T, N> {
        let block = &self.blocks.blocks[block];
        let shape = &self.blocks.shapes[block.shape];
        let p = field.matrix(self.grid.cell(block.first));
        let direction = |edge: isize| edge.rem_euclid(8) as usize;
        Tiles::from_fn(shape.leaving.len(), shape.entering.len(), |r, c| {
            let (k, j) = (direction(shape.leaving[r]), direction(shape.entering[c]));
            T::from_f64(match operator {
                Operator::Forward => p[k][j],
                // Opposite directions trade places, and so do cause and effect.
                Operator::Adjoint => p[(j + 4) % 8][(k + 4) % 8],
            })
        })
    }

    /// What passes between two halves, and what the whole answers; nothing asks the whole grid.
    fn merge(
        &self,
        halves: &Halves,
        answers: [Tiles<T, N>; 2],
        whole: bool,
        parallel: &dyn Parallel,
    ) -> Result<(Merge<T>, Tiles<T, N>), super::dense::SmallPivot> {
        let level = self.level;
        let [one, two] = &halves.sides;
        let [a1, a2] = &answers;
        let returned = [a1.part(&one.to_other, &one.from_other), a2.part(&two.to_other, &two.from_other)];
        let sent_out =
            [a1.part(&one.leaving_places, &one.from_other), a2.part(&two.leaving_places, &two.from_other)];
        let let_through =
            [a1.part(&one.to_other, &one.entering_places), a2.part(&two.to_other, &two.entering_places)];
        let packed_returned = returned.each_ref().map(Packed::of);
        let (forth, back) = (halves.forth.len(), halves.back.len());
        let loops = Tiles::zero(back, back).plus_product(&packed_returned[1], &returned[0], level, parallel);
        let to_and_fro = inverse_of_one_minus(&loops, smallest_pivot::<T>(), level, parallel)?;
        let to_and_fro = Packed::of(&to_and_fro);
        let packed_out = sent_out.each_ref().map(Packed::of);
        let answer_of_both = || {
            let (n1, n2) = (one.entering.len(), two.entering.len());
            let entering = n1 + n2;
            // What goes back, and then forth, per flux that enters the block.
            let first_back =
                Tiles::zero(back, n1).plus_product(&packed_returned[1], &let_through[0], level, parallel);
            let cause = Tiles::<T, N>::from_fn(back, entering, |r, c| {
                if c < n1 { first_back.at(r, c) } else { let_through[1].at(r, c - n1) }
            });
            let goes_back =
                Tiles::<T, N>::zero(back, entering).plus_product(&to_and_fro, &cause, level, parallel);
            let first_forth = Tiles::<T, N>::from_fn(forth, entering, |r, c| {
                if c < n1 { let_through[0].at(r, c) } else { T::default() }
            });
            let goes_forth = first_forth.plus_product(&packed_returned[0], &goes_back, level, parallel);
            let (m1, m2) = (one.leaving.len(), two.leaving.len());
            let direct =
                |answer: &Tiles<T, N>, side: &super::blocks::Side, columns: std::ops::Range<usize>| {
                    Tiles::from_fn(side.leaving.len(), entering, |r, c| {
                        if columns.contains(&c) {
                            let place = side.entering_places[c - columns.start] as usize;
                            answer.at(side.leaving_places[r] as usize, place)
                        } else {
                            T::default()
                        }
                    })
                };
            let upper: Tiles<T, N> =
                direct(a1, one, 0..n1).plus_product(&packed_out[0], &goes_back, level, parallel);
            let lower =
                direct(a2, two, n1..entering).plus_product(&packed_out[1], &goes_forth, level, parallel);
            Tiles::from_fn(
                m1 + m2,
                entering,
                |r, c| if r < m1 { upper.at(r, c) } else { lower.at(r - m1, c) },
            )
        };
        let answer = if whole { Tiles::zero(0, 0) } else { answer_of_both() };
        let packed_through = let_through.each_ref().map(Packed::of);
        let [r1, r2] = &packed_returned;
        let [s1, s2] = &packed_out;
        let [l1, l2] = &packed_through;
        Ok((Merge::of([&to_and_fro, r1, r2, s1, s2, l1, l2]), answer))
    }

    /// Buffers for [`Self::solve`].
    #[must_use]
    pub fn workspace(&self) -> Workspace<T, N> {
        let [between, outside] = self.longest;
        let zeros = |n: usize| vec![Lanes::zero(); n];
        Workspace([zeros(between), zeros(between), zeros(between), zeros(outside), zeros(outside)])
    }

    /// Bytes of what one thread needs to solve N lanes: edges and workspace.
    #[must_use]
    pub const fn solution_bytes(grid: Grid) -> u128 {
        (grid.cells() * 8 * size_of::<Lanes<T, N>>()) as u128
    }

    /// Replaces what sources put on the edges by the stationary light they cause, their own contributions included.
    /// Edges that lead into the grid from outside are left as they are and must be 0.
    ///
    /// Panics where `edges` has not eight rows a cell.
    pub fn solve(&self, edges: &mut [Lanes<T, N>], workspace: &mut Workspace<T, N>) {
        self.run(edges, workspace, &self.blocks.order, &vec![true; self.blocks.blocks.len()]);
    }

    /// [`Self::solve`] for sources beside few cells: `sources` lists edges that leave the cells `lit`, each with a lane
    /// and what the source puts there. What `edges` held before does not matter, but for edges that lead into the grid
    /// from outside.
    pub fn solve_near(
        &self,
        lit: &[Cell],
        sources: &[(usize, usize, T)],
        edges: &mut [Lanes<T, N>],
        workspace: &mut Workspace<T, N>,
    ) {
        let mut is_lit = vec![false; self.blocks.blocks.len()];
        for cell in lit {
            let mut block = self.blocks.of_cell[self.grid.index(*cell)];
            // The blocks that hold a lit block are lit.
            while !is_lit[block] {
                is_lit[block] = true;
                block = self.blocks.blocks[block].parent;
            }
        }
        let lit: Vec<usize> = self.blocks.order.iter().copied().filter(|&block| is_lit[block]).collect();
        for &block in &lit {
            let Some((halves, _)) = self.blocks.halves(block) else { continue };
            let first = self.blocks.blocks[block].first as isize * 8;
            for edge in halves.forth.iter().chain(&halves.back) {
                edges[(first + edge) as usize] = Lanes::zero();
            }
        }
        for &(edge, lane, value) in sources {
            edges[edge].0[lane] = value;
        }
        self.run(edges, workspace, &lit, &is_lit);
    }

    /// `lit`: the blocks with sources inside, each after its halves; `is_lit` says the same of every block.
    fn run(
        &self,
        edges: &mut [Lanes<T, N>],
        workspace: &mut Workspace<T, N>,
        lit: &[usize],
        is_lit: &[bool],
    ) {
        assert_eq!(edges.len(), self.grid.cells() * 8, "eight edges a cell");
        self.level.dispatch(Solve { dissection: self, edges, workspace, lit, is_lit });
    }
}

struct Solve<'a, T, const N: usize> {
    dissection: &'a Dissection<T, N>,
    edges: &'a mut [Lanes<T, N>],
    workspace: &'a mut Workspace<T, N>,
    lit: &'a [usize],
    is_lit: &'a [bool],
}

impl<T: Real, const N: usize> Task for Solve<'_, T, N> {
    type Number = T;
    type Output = ();

    #[inline(always)]
    fn work<P: Proven<T>>(self, proof: P) {
        let Self { dissection, edges, workspace: Workspace(buffers), lit, is_lit } = self;
        let blocks = &dissection.blocks;
        // Halves before wholes, then wholes before halves.
        let collect = lit.iter().map(|&block| (block, Pass::Collect));
        let distribute = blocks.order.iter().rev().map(|&block| (block, Pass::Distribute));
        for (block, pass) in collect.chain(distribute) {
            let Some((halves, _)) = blocks.halves(block) else { continue };
            let Some(merge) = dissection.merges[block].get() else { continue };
            let merge = merge.matrices(halves);
            let first = blocks.blocks[block].first as isize * 8;
            let [one, two] = &halves.sides;
            let between = [(&halves.forth, FORTH), (&halves.back, BACK), (&halves.back, FIRST_BACK)];
            for (list, buffer) in between {
                buffers[buffer][..list.len()].fill(Lanes::zero());
            }
            let outer = match pass {
                Pass::Collect => [&one.leaving, &two.leaving],
                Pass::Distribute => [&one.entering, &two.entering],
            };
            for (list, buffer) in outer.into_iter().zip(OUTSIDE) {
                gather(list, first, edges, &mut buffers[buffer]);
            }
            let to_and_fro = [
                (merge.returned[1], FORTH, FIRST_BACK),
                (merge.to_and_fro, FIRST_BACK, BACK),
                (merge.returned[0], BACK, FORTH),
            ];
            let [t0, t1, t2] = to_and_fro;
            let products = match pass {
                Pass::Collect => {
                    gather(&halves.forth, first, edges, &mut buffers[FORTH]);
                    gather(&halves.back, first, edges, &mut buffers[FIRST_BACK]);
                    [
                        t0,
                        t1,
                        t2,
                        (merge.sent_out[0], BACK, OUTSIDE[0]),
                        (merge.sent_out[1], FORTH, OUTSIDE[1]),
                    ]
                }
                Pass::Distribute => [
                    (merge.let_through[0], OUTSIDE[0], FORTH),
                    (merge.let_through[1], OUTSIDE[1], FIRST_BACK),
                    t0,
                    t1,
                    t2,
                ],
            };
            // One place in the code for all products: each is compiled many times over.
            for (matrix, from, to) in products {
                let [from, to] = buffers.get_disjoint_mut([from, to]).expect("two buffers");
                matrix.add_to(proof, from, to);
            }
            match pass {
                Pass::Collect => {
                    scatter(&halves.forth, first, &buffers[FORTH], edges);
                    scatter(&halves.back, first, &buffers[BACK], edges);
                    scatter(&one.leaving, first, &buffers[OUTSIDE[0]], edges);
                    scatter(&two.leaving, first, &buffers[OUTSIDE[1]], edges);
                }
                // In the dark, there is nothing to add to.
                Pass::Distribute if !is_lit[block] => {
                    scatter(&halves.forth, first, &buffers[FORTH], edges);
                    scatter(&halves.back, first, &buffers[BACK], edges);
                }
                Pass::Distribute => {
                    add::<P::Vector, N>(proof.vector(), &halves.forth, first, &buffers[FORTH], edges);
                    add::<P::Vector, N>(proof.vector(), &halves.back, first, &buffers[BACK], edges);
                }
            }
        }
    }
}

#[inline(always)]
fn gather<T: Real, const N: usize>(
    of: &[isize],
    first: isize,
    edges: &[Lanes<T, N>],
    to: &mut [Lanes<T, N>],
) {
    for (to, edge) in to.iter_mut().zip(of) {
        *to = edges[(first + edge) as usize];
    }
}

#[inline(always)]
fn scatter<T: Real, const N: usize>(
    of: &[isize],
    first: isize,
    from: &[Lanes<T, N>],
    edges: &mut [Lanes<T, N>],
) {
    for (from, edge) in from.iter().zip(of) {
        edges[(first + edge) as usize] = *from;
    }
}

#[inline(always)]
fn add<V: Vector, const N: usize>(
    proof: V::Proof,
    of: &[isize],
    first: isize,
    from: &[Lanes<V::Number, N>],
    edges: &mut [Lanes<V::Number, N>],
) {
    for (from, edge) in from.iter().zip(of) {
        let to = &mut edges[(first + edge) as usize].0;
        for c in 0..N / V::WIDTH {
            (V::load(proof, to, c) + V::load(proof, &from.0, c)).store(to, c);
        }
    }
}
