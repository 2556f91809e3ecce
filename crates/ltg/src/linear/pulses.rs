//! Which pulses of a cell differ, and which of them are compared.
//!
//! A pulse in sample t sends `2 pi Tbar w_k(t)` to neighbour k. The cone weights are constant over the cores of the
//! four face cones and over the eight overlaps with the diagonal cones, and special in the four directions where two
//! overlaps meet: no more than sixteen pulses of a cell differ, however many samples there are. Only where a cell
//! transmits nothing in some samples (total anisotropy) do pulses of one class differ: there, every sample is a class
//! of its own.

use crate::LtgError;
use crate::settings::check_slices;
use tigereye_core::Cell;
use tigereye_transport::{LinearScattering, Scheme};

/// Classes of equal pulses, and the comparisons that a gradient needs of each cell.
#[derive(Clone, Debug)]
pub(crate) struct Comparisons {
    /// Cone weights of each class.
    pub(crate) classes: Vec<[f64; 8]>,
    /// A sample of each class.
    pub(crate) samples: Vec<usize>,
    /// Pairs of classes that lie 2K samples apart, each once.
    pub(crate) turns: Vec<[usize; 2]>,
    /// For each distinct value of a cell's gradient the class whose neighbours are compared, and the turn.
    pub(crate) values: Vec<(usize, usize)>,
    /// For each slice (ascending) which of the values it has.
    pub(crate) of_slice: Vec<usize>,
}

impl Comparisons {
    /// The comparisons for these slices (ascending, each once) and the angular step K. With `every_sample`, each sample
    /// is a class of its own.
    pub(crate) fn new(
        scheme: &Scheme,
        every_sample: bool,
        slices: &[usize],
        omega_step: usize,
    ) -> Result<Self, LtgError> {
        let directions = scheme.directions();
        check_slices(directions, slices, omega_step)?;
        let s = directions.count();
        let (mut classes, mut samples): (Vec<[f64; 8]>, Vec<usize>) = (Vec::new(), Vec::new());
        let mut class_of = |t: usize| {
            let weights = *scheme.weights(t);
            let known = if every_sample {
                samples.iter().position(|known| *known == t)
            } else {
                classes.iter().position(|known| *known == weights)
            };
            known.unwrap_or_else(|| {
                classes.push(weights);
                samples.push(t);
                classes.len() - 1
            })
        };
        let (mut turns, mut values, mut of_slice) = (Vec::new(), Vec::new(), Vec::new());
        for &t in slices {
            let own = class_of(t);
            let turn = [class_of((t + s - omega_step) % s), class_of((t + omega_step) % s)];
            let turn = place_of(&mut turns, turn);
            of_slice.push(place_of(&mut values, (own, turn)));
        }
        Ok(Self { classes, samples, turns, values, of_slice })
    }

    /// The classes whose neighbours are compared, each once, in order of their first value.
    pub(crate) fn moved(&self) -> Vec<usize> {
        let mut moved = Vec::new();
        for &(class, _) in &self.values {
            place_of(&mut moved, class);
        }
        moved
    }

    /// The energy that a pulse of each class puts into the field, W: 0 where the cell transmits nothing of it.
    pub(crate) fn energies(&self, field: &LinearScattering<'_>, cell: Cell) -> Vec<f64> {
        self.samples.iter().map(|&t| field.pulse_energy(cell, t)).collect()
    }
}

/// The place of `value` in a list, at whose end it is put where it is new.
fn place_of<T: PartialEq>(list: &mut Vec<T>, value: T) -> usize {
    list.iter().position(|known| *known == value).unwrap_or_else(|| {
        list.push(value);
        list.len() - 1
    })
}

/// Whether some cell that passes light on transmits nothing in some sample.
pub(crate) fn has_dark_samples(field: &LinearScattering<'_>) -> bool {
    let transmission = field.transmission();
    let passes = |cell: &Cell| transmission.reflection(*cell).is_none() && transmission.rate(*cell) > 0.0;
    field.grid().iter().filter(passes).any(|cell| transmission.shape(cell).iter().any(|v| *v <= 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{Directions, Field, Grid, Normalization, Tensor2, TransmissionField};
    use tigereye_transport::{Scattering, SharedWeights};

    fn comparisons(s: usize, k: usize, tensor: Tensor2) -> Comparisons {
        let directions = Directions::new(s).expect("directions");
        let field = Field::from_fn(Grid::new(3, 3).expect("a grid"), |_| tensor);
        let t = TransmissionField::from_tensors(&field, directions, Normalization::Local).expect("a field");
        let scheme = Scheme::new(directions, SharedWeights::Thesis);
        let scattering = Scattering::new(&scheme, &t);
        let slices: Vec<usize> = (0..s).collect();
        let dark = has_dark_samples(&LinearScattering::new(&scattering));
        Comparisons::new(&scheme, dark, &slices, k).expect("comparisons")
    }

    #[test]
    fn at_most_sixteen_pulses_of_a_cell_differ() {
        let classes = |s: usize| comparisons(s, s.div_ceil(12), Tensor2::IDENTITY).classes.len();
        assert_eq!([8, 16, 24, 32, 64, 360].map(classes), [8, 16, 16, 16, 16, 16]);
    }

    #[test]
    fn slices_find_their_class_and_turn() {
        let c = comparisons(32, 3, Tensor2::IDENTITY);
        let scheme = Scheme::new(Directions::new(32).expect("directions"), SharedWeights::Thesis);
        for (t, &value) in c.of_slice.iter().enumerate() {
            let (class, turn) = c.values[value];
            assert_eq!(c.classes[class], *scheme.weights(t));
            let [before, after] = c.turns[turn].map(|class| c.classes[class]);
            assert_eq!((before, after), (*scheme.weights((t + 29) % 32), *scheme.weights((t + 3) % 32)));
        }
    }

    #[test]
    fn samples_that_pass_nothing_are_told_from_others() {
        let needle = Tensor2::from_axes(0.3, 1.0, 0.0);
        assert_eq!(comparisons(32, 3, needle).classes.len(), 32);
    }
}
