//! Where tensors are totally anisotropic, over maps of light and gradients.

use tigereye_core::{Field, Grid, Tensor2, TotalAnisotropy};
use tigereye_render::{Overlay, Rgba, outline};

/// The cells of a field that transmit along one axis only, and the rule that says which.
#[derive(Clone, Debug, PartialEq)]
pub struct ThinCells {
    cells: Field<bool>,
    count: usize,
    rule: TotalAnisotropy,
}

impl ThinCells {
    /// Those of a field; `None` if it has none.
    #[must_use]
    pub fn of(field: &Field<Tensor2>, rule: TotalAnisotropy) -> Option<Self> {
        let cells = rule.cells(field);
        let count = cells.values().iter().filter(|thin| **thin).count();
        (count > 0).then_some(Self { cells, count, rule })
    }

    /// Those of [`Self::runs`]; `None` if the lengths do not add up to the cells of the grid.
    #[must_use]
    pub fn from_runs(grid: Grid, runs: &[usize], rule: TotalAnisotropy) -> Option<Self> {
        let cells = runs.iter().try_fold(0_usize, |sum, n| sum.checked_add(*n))?;
        if cells != grid.cells() {
            return None;
        }
        let values = runs.iter().enumerate().flat_map(|(i, n)| std::iter::repeat_n(i % 2 == 1, *n)).collect();
        let cells = Field::from_values(grid, values).ok()?;
        let count = runs.iter().skip(1).step_by(2).sum();
        Some(Self { cells, count, rule })
    }

    /// The lengths of runs of cells, row by row, by turns of other cells and of these.
    #[must_use]
    pub fn runs(&self) -> Vec<usize> {
        let (mut runs, mut thin) = (vec![0], false);
        for &cell in self.cells.values() {
            if cell != thin {
                runs.push(0);
                thin = cell;
            }
            if let Some(last) = runs.last_mut() {
                *last += 1;
            }
        }
        runs
    }

    /// The cells.
    #[must_use]
    pub const fn cells(&self) -> &Field<bool> {
        &self.cells
    }

    /// Their share of all cells, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.count as f64 / self.cells.grid().cells() as f64
    }

    /// Their share in words: `24.6 % of the cells`, `all cells`.
    #[must_use]
    pub fn share_in_words(&self) -> String {
        let others = self.cells.grid().cells() - self.count;
        match (self.count, others) {
            (_, 0) => "all cells".to_owned(),
            (1, _) => "one cell".to_owned(),
            _ if self.share() < 0.0005 => format!("{} cells", self.count),
            _ if self.share() >= 0.9995 => format!("all but {others} of the cells"),
            _ => format!("{:.1} % of the cells", 100.0 * self.share()),
        }
    }

    /// The same as the subject of a sentence, with its verb.
    #[must_use]
    pub fn share_with_verb(&self) -> String {
        let verb = if self.count == 1 { "is" } else { "are" };
        format!("{} {verb}", self.share_in_words())
    }

    /// What follows for light and gradients, as the rest of a sentence.
    #[must_use]
    pub fn effect_in_words(&self) -> &'static str {
        let is_everywhere = self.count == self.cells.grid().cells();
        match self.rule.blend() {
            _ if self.rule.is_cap() => "",
            Some(_) => " and transmit mostly along one axis; pictures outline where",
            None if is_everywhere => {
                ": light keeps to the directions of the samples, and edges between these are edges of the method"
            }
            None => {
                " and transmit along one axis only: their border, outlined in pictures, is an edge of the method \
                 (--total-anisotropy)"
            }
        }
    }

    /// What makes them thin, in words.
    #[must_use]
    pub fn rule_in_words(&self) -> String {
        let ratio = self.rule.ratio();
        match self.rule.blend() {
            _ if self.rule == TotalAnisotropy::NONE => "one semi-axis is 0".to_owned(),
            _ if self.rule.is_cap() => format!("semi-axes beyond {ratio}:1, taken as {ratio}:1"),
            Some([lower, upper]) => {
                format!("semi-axes beyond {ratio}:1, blended from {lower}:1 to {upper}:1")
            }
            None => format!("semi-axes beyond {ratio}:1"),
        }
    }

    /// Their outline.
    #[must_use]
    pub fn overlay(&self) -> Overlay {
        Overlay {
            label: format!("totally anisotropic ({}): {}", self.rule_in_words(), self.share_in_words()),
            points: outline(&self.cells),
            colour: Rgba::INK,
            width_px: 0.9,
            ..Overlay::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(thin: usize, of: usize, rule: TotalAnisotropy) -> Option<ThinCells> {
        let grid = Grid::new(of, 1).expect("a grid");
        let field =
            Field::from_fn(grid, |c| Tensor2::symmetric(if c.x < thin { 25.0 } else { 5.0 }, 0.0, 1.0));
        ThinCells::of(&field, rule)
    }

    #[test]
    fn shares_are_said_as_one_would() {
        let words = |thin, of| cells(thin, of, TotalAnisotropy::PUBLISHED).map(|c| c.share_in_words());
        assert_eq!(words(0, 10), None);
        assert_eq!(words(1, 10).as_deref(), Some("one cell"));
        assert_eq!(words(3, 10).as_deref(), Some("30.0 % of the cells"));
        assert_eq!(words(10, 10).as_deref(), Some("all cells"));
        assert_eq!(words(2, 10_000).as_deref(), Some("2 cells"));
        assert_eq!(words(9_999, 10_000).as_deref(), Some("all but 1 of the cells"));
    }

    #[test]
    fn cells_are_those_of_their_runs() {
        for (thin, runs) in [(3, vec![0, 3, 7]), (10, vec![0, 10])] {
            let some = cells(thin, 10, TotalAnisotropy::PUBLISHED).expect("thin cells");
            assert_eq!(some.runs(), runs);
            let grid = some.cells().grid();
            assert_eq!(ThinCells::from_runs(grid, &runs, TotalAnisotropy::PUBLISHED), Some(some));
        }
        let grid = Grid::new(5, 2).expect("a grid");
        for wrong in [&[0, 9][..], &[], &[usize::MAX, 11]] {
            assert_eq!(ThinCells::from_runs(grid, wrong, TotalAnisotropy::PUBLISHED), None);
        }
    }

    #[test]
    fn outlines_name_their_rule() {
        let label = |rule| cells(3, 10, rule).map(|c| c.overlay().label);
        let published = label(TotalAnisotropy::PUBLISHED).expect("an outline");
        assert!(published.contains("beyond 20:1)") && published.contains("30.0 %"), "{published}");
        assert!(label(TotalAnisotropy::SMOOTH).is_some_and(|l| l.contains("blended from 10:1 to 40:1")));
        assert_eq!(label(TotalAnisotropy::NONE), None);
    }
}
