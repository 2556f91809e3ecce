//! Fields sampled finer than the cells of the map they are drawn on.
//!
//! With n samples per cell, a map of W x H cells has n (W - 1) + 1 by n (H - 1) + 1 samples, and sample (i, j) lies at
//! (i/n, j/n) cells: sample 0 at the centre of cell 0, the last one at the centre of the last cell. Each is drawn as a
//! small square about its position, so that half a cell along the frame stays empty.

use crate::colour::Rgba;
use crate::map_frame::{self, MapFrame};
use crate::scene::{Item, Raster};
use tigereye_core::{Cell, CellShape, Field, Grid};

/// Longest side of a map in pixels, beyond which samples are combined.
const LONGEST_PX: usize = 960;

/// The arrangement of samples on cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sampling {
    /// Samples per cell along x and y, at least 1.
    pub(crate) per_cell: [usize; 2],
    /// Cells of the map.
    pub(crate) cells: Grid,
    samples: Grid,
}

impl Sampling {
    /// The cells that `samples` cover. A `per_cell` of 0 counts as 1, and is limited to the number of samples; if it
    /// does not divide the samples evenly, the last cell is covered in part.
    pub(crate) fn of(samples: Grid, per_cell: [usize; 2]) -> Self {
        let steps = [samples.width() - 1, samples.height() - 1];
        let per_cell = per_cell.map(|n| n.clamp(1, steps[0].max(steps[1]).max(1)));
        let [width, height] = [0, 1].map(|axis| steps[axis].div_ceil(per_cell[axis]) + 1);
        // There are never more cells than samples, so this size is valid.
        Self { per_cell, cells: Grid::new(width, height).unwrap_or(samples), samples }
    }

    /// Width and height of a cell in pixels. Its smaller side has `fixed` pixels, or by default as many as give samples
    /// along it a whole number of pixels, unless samples are smaller than pixels.
    pub(crate) fn cell_px(&self, shape: CellShape, fixed: Option<usize>) -> [f64; 2] {
        if fixed.is_some() || self.per_cell == [1; 2] {
            return map_frame::cell_px(self.cells, shape, fixed, 480, 40);
        }
        let [x, y] = shape.sides();
        let per_cell = self.per_cell[usize::from(y < x)];
        let longer = shape.longer_side([self.cells.width(), self.cells.height()]).ceil() as usize;
        let longer = longer.saturating_mul(per_cell);
        let sample = if longer <= LONGEST_PX {
            (480 / longer).clamp(1, 40) as f64
        } else {
            1.0 / longer.div_ceil(LONGEST_PX) as f64
        };
        [x, y].map(|side| side * (sample * per_cell as f64))
    }

    fn sample_px(&self, page: &MapFrame) -> [f64; 2] {
        [0, 1].map(|axis| page.cell[axis] / self.per_cell[axis] as f64)
    }

    /// Samples along x and y that are combined into one cell of a raster: more than 1 if they are smaller than a pixel.
    pub(crate) fn block(&self, page: &MapFrame) -> [usize; 2] {
        self.sample_px(page).map(|side| (1.0 / (page.fineness * side)).round().max(1.0) as usize)
    }

    /// A remark on the mean that one cell of a raster shows, if it combines several samples.
    pub(crate) fn mean_in_words(&self, [x, y]: [usize; 2]) -> Option<String> {
        (x.max(y) > 1).then(|| format!("one pixel = mean of {x} × {y} {}", self.places()))
    }

    /// The samples in colour; `colour` is given columns and rows of the block's first sample.
    pub(crate) fn raster(&self, page: &MapFrame, colour: impl Fn(Cell) -> Rgba) -> Item {
        let (block, sample) = (self.block(page), self.sample_px(page));
        let columns = self.samples.width().div_ceil(block[0]);
        let mut cells = Vec::with_capacity(columns * self.samples.height().div_ceil(block[1]));
        for y in (0..self.samples.height()).step_by(block[1]) {
            cells.extend((0..self.samples.width()).step_by(block[0]).map(|x| colour(Cell::new(x, y))));
        }
        let margin = [0, 1].map(|axis| 0.5 * (page.cell[axis] - sample[axis]));
        let (x_px, y_px) = (page.left + margin[0], page.top + margin[1]);
        let cell_px = [0, 1].map(|axis| sample[axis] * block[axis] as f64);
        Item::Raster(Raster { x_px, y_px, cell_px, columns, cells })
    }

    /// Cells of which every sample nearest to them is `broken`.
    pub(crate) fn cells_where(&self, broken: impl Fn(Cell) -> bool) -> Vec<Cell> {
        let near = |cell: usize, samples: usize, per_cell: usize| {
            let (middle, half) = (cell * per_cell, per_cell / 2);
            middle.saturating_sub(half).min(samples - 1)..(middle + half + 1).min(samples)
        };
        let all_broken = |c: &Cell| {
            let columns = near(c.x, self.samples.width(), self.per_cell[0]);
            near(c.y, self.samples.height(), self.per_cell[1])
                .all(|y| columns.clone().all(|x| broken(Cell::new(x, y))))
        };
        self.cells.iter().filter(all_broken).collect()
    }

    /// The word of a legend for the positions of values.
    pub(crate) fn places(&self) -> &'static str {
        if self.per_cell == [1; 2] { "cells" } else { "samples" }
    }

    /// The map in words: `W x H cells`, and the number of samples per cell unless it is 1.
    pub(crate) fn in_words(&self) -> String {
        let cells = format!("{} x {} cells", self.cells.width(), self.cells.height());
        match self.per_cell {
            [1, 1] => cells,
            [m, n] if m == n => format!("{cells} with {n} samples per side of a cell"),
            [m, n] => format!("{cells} with {m} x {n} samples per cell"),
        }
    }
}

/// Mean of the finite values of a block of samples from `first` on; the value itself for a block of 1.
pub(crate) fn block_mean(field: &Field<f64>, first: Cell, block: [usize; 2]) -> f64 {
    let grid = field.grid();
    if block == [1; 2] {
        return *field.at(first);
    }
    let (mut sum, mut count) = (0.0, 0.0);
    for y in first.y..(first.y + block[1]).min(grid.height()) {
        for x in first.x..(first.x + block[0]).min(grid.width()) {
            let value = *field.at(Cell::new(x, y));
            if value.is_finite() {
                sum += value;
                count += 1.0;
            }
        }
    }
    sum / count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::Style;

    fn grid(width: usize, height: usize) -> Grid {
        Grid::new(width, height).expect("a grid")
    }

    fn frame(sampling: &Sampling) -> MapFrame {
        let cell = sampling.cell_px(CellShape::SQUARE, None);
        MapFrame::begin(sampling.cells, (&Style::default(), ""), cell, &|_| 0.0)
    }

    #[test]
    fn samples_reach_from_the_first_to_the_last_centre() {
        for (cells, n) in [((5, 4), 1), ((5, 4), 3), ((1, 6), 4), ((7, 1), 2)] {
            let samples = grid(n * (cells.0 - 1) + 1, n * (cells.1 - 1) + 1);
            let sampling = Sampling::of(samples, [n; 2]);
            assert_eq!((sampling.cells, sampling.per_cell), (grid(cells.0, cells.1), [n; 2]));
            let page = frame(&sampling);
            let Item::Raster(raster) = sampling.raster(&page, |_| Rgba::INK) else { panic!("a raster") };
            assert_eq!((raster.columns, raster.rows()), (samples.width(), samples.height()));
            let first = [raster.x_px + 0.5 * raster.cell_px[0], raster.y_px + 0.5 * raster.cell_px[1]];
            let last = [
                first[0] + raster.cell_px[0] * (samples.width() - 1) as f64,
                first[1] + raster.cell_px[1] * (samples.height() - 1) as f64,
            ];
            let ends = [page.centre(Cell::new(0, 0)), page.centre(Cell::new(cells.0 - 1, cells.1 - 1))];
            // Rounding of some hundred pixels.
            for (a, b) in [first, last].into_iter().flatten().zip(ends.iter().flat_map(|p| p.to_array())) {
                assert!((a - b).abs() < 1e-9, "{cells:?} {n}: {first:?} {last:?} {ends:?}");
            }
        }
    }

    #[test]
    fn impossible_samplings_stay_maps() {
        assert_eq!(Sampling::of(grid(6, 6), [0; 2]), Sampling::of(grid(6, 6), [1; 2]));
        assert_eq!(Sampling::of(grid(6, 6), [4; 2]).cells, grid(3, 3));
        assert_eq!(Sampling::of(grid(6, 3), [usize::MAX; 2]).cells, grid(2, 2));
        assert_eq!(Sampling::of(grid(1, 1), [usize::MAX; 2]).cells, grid(1, 1));
    }

    #[test]
    fn fine_maps_have_whole_pixels_or_combine_samples() {
        let side = |samples: usize, n: usize| {
            let sampling = Sampling::of(grid(samples, samples), [n; 2]);
            let page = frame(&sampling);
            (page.cell[0] / n as f64, sampling.block(&page)[0], page.width())
        };
        assert_eq!(side(101, 4).0, 4.0);
        assert_eq!(side(801, 4).0, 1.0);
        let (sample, block, width) = side(4001, 8);
        assert_eq!((sample, block), (0.2, 5));
        assert!(width <= LONGEST_PX as f64);
    }

    #[test]
    fn a_cell_is_broken_if_all_its_samples_are() {
        let sampling = Sampling::of(grid(7, 1), [3; 2]);
        // Cells at samples 0, 3 and 6; each has the neighbours of its sample.
        assert_eq!(sampling.cells_where(|c| c.x >= 5), [Cell::new(2, 0)]);
        assert_eq!(sampling.cells_where(|c| c.x < 2), [Cell::new(0, 0)]);
        assert!(sampling.cells_where(|c| c.x == 3).is_empty());
    }
}
