//! `tigereye compare`: the difference of two results.

use crate::args::reading::{CompareArgs, ReadingArgs};
use crate::commands::print_text;
use crate::error::CliError;
use crate::input::{Input, Source};
use crate::{files, interrupt};
use std::path::Path;
use tigereye_core::{Difference, Field, Tensor2};
use tigereye_input::{Content, Reading, TensorFile};
use tigereye_io::volume::lattice_from_image;
use tigereye_io::{ChoiceError, IoError, Rows, Wanted, npy, vti};

/// Names of gradient volumes: ours and the published ones.
const VOLUME_ARRAYS: [&str; 2] = [tigereye_io::LTG_ARRAY, "Energy"];

/// Numbers with a shape, slowest index first.
struct Numbers {
    what: String,
    shape: Vec<usize>,
    /// Sample index of each entry of the first axis, for volumes.
    slices: Option<Vec<usize>>,
    values: Vec<f64>,
}

pub(crate) fn compare(args: &CompareArgs) -> Result<u8, CliError> {
    let (a, b) = (numbers(&args.a, &args.reading)?, numbers(&args.b, &args.reading)?);
    interrupt::check()?;
    let has = |n: &Numbers, slice| n.slices.as_ref().is_some_and(|s| s.contains(slice));
    if let Some(slice) = args.except_slices.iter().find(|s| !has(&a, s) && !has(&b, s)) {
        return Err(CliError::input("--except-slices", format!("neither result has a slice {slice}")));
    }
    let (a, b) = (a.without_slices(&args.except_slices), b.without_slices(&args.except_slices));
    if a.shape != b.shape {
        return Err(CliError::Input(format!(
            "{} is {} of shape {:?}, {} is {} of shape {:?}: expected the same shape",
            args.a, a.what, a.shape, args.b, b.what, b.shape
        )));
    }
    if let (Some(x), Some(y)) = (&a.slices, &b.slices)
        && x != y
    {
        let problem = format!("{} has the slices {x:?}, {} has {y:?}: expected the same", args.a, args.b);
        return Err(CliError::Input(problem));
    }
    let difference = Difference::between(&a.values, &b.values);
    print_text(&text(&difference, &a))?;
    Ok(u8::from(!difference.is_within(args.tolerance)))
}

fn numbers(text: &str, reading: &ReadingArgs) -> Result<Numbers, CliError> {
    let path = Path::new(text);
    let plain = reading.reading() == Reading::default();
    match files::extension(path).as_str() {
        "npy" if plain => {
            let array = npy::read_array(&files::read(path)?).map_err(|e| CliError::input(text, e))?;
            Ok(Numbers {
                what: "an array".to_owned(),
                shape: array.shape,
                slices: None,
                values: array.values,
            })
        }
        "vti" if plain => match result(text, &files::read(path)?)? {
            Some(numbers) => Ok(numbers),
            None => tensors(text, reading),
        },
        _ => tensors(text, reading),
    }
}

/// Tensors in a plane, or those of a whole volume along the world's axes, where nobody chooses a plane.
fn tensors(text: &str, reading: &ReadingArgs) -> Result<Numbers, CliError> {
    let source = Source::open(text, reading)?;
    match &source {
        Source::File(file @ TensorFile { content: Content::Tensors(volume), .. })
            if !file.has_plane(&reading.reading()) =>
        {
            let values = volume.in_world().map_err(|e| CliError::input(text, e))?;
            let [nx, ny, nz] = volume.lattice().size;
            let values = values.into_iter().flatten().collect();
            Ok(Numbers {
                what: "a tensor volume".to_owned(),
                shape: vec![nz, ny, nx, 3, 3],
                slices: None,
                values,
            })
        }
        _ => Input::of(source, reading).map(|input| {
            input.tell();
            of_tensors(&input.field)
        }),
    }
}

/// What this program or the thesis's made: a gradient volume, or image data without tensors.
fn result(text: &str, bytes: &[u8]) -> Result<Option<Numbers>, CliError> {
    let image = vti::read(bytes).map_err(|e| CliError::input(text, e))?;
    let is_volume = VOLUME_ARRAYS.iter().any(|name| image.point_array(name).is_some());
    if is_volume && let Ok(volume) = tigereye_io::ltg_from_image(&image) {
        let shape = vec![volume.slices.len(), volume.grid.height(), volume.grid.width()];
        let what = "a gradient volume".to_owned();
        return Ok(Some(Numbers { what, shape, slices: Some(volume.slices), values: volume.values }));
    }
    if !matches!(
        lattice_from_image(&image, None, Wanted::Tensors),
        Err(IoError::Choice(ChoiceError::NoArray { .. }))
    ) {
        return Ok(None);
    }
    let array = image.point_array("intensity").or(image.point_arrays.first());
    let Some(array) = array else { return Err(CliError::input(text, "holds no point array to compare")) };
    let [w, h, d] = image.dimensions;
    let shape = [d, h, w, array.components].into_iter().filter(|n| *n > 1).collect();
    // Row 0 on top, whichever way the file has it.
    let values = Rows::of(&image, &array.name).from_top(&array.values, [w, h], array.components);
    Ok(Some(Numbers { what: format!("the array {}", array.name), shape, slices: None, values }))
}

fn of_tensors(field: &Field<Tensor2>) -> Numbers {
    let shape = vec![field.grid().height(), field.grid().width(), 2, 2];
    let values = field.values().iter().flat_map(Tensor2::components).collect();
    Numbers { what: "a tensor field".to_owned(), shape, slices: None, values }
}

impl Numbers {
    fn without_slices(mut self, except: &[usize]) -> Self {
        let Some(slices) = self.slices.take() else { return self };
        let size: usize = self.shape[1..].iter().product();
        let kept: Vec<usize> = (0..slices.len()).filter(|&i| !except.contains(&slices[i])).collect();
        self.values = kept.iter().flat_map(|&i| self.values[i * size..(i + 1) * size].to_vec()).collect();
        self.shape[0] = kept.len();
        self.slices = Some(kept.into_iter().map(|i| slices[i]).collect());
        self
    }

    /// Indices of a position, slowest first.
    fn place(&self, mut position: usize) -> Vec<usize> {
        let mut place = vec![0; self.shape.len()];
        for (p, n) in place.iter_mut().zip(&self.shape).rev() {
            *p = position % n;
            position /= n;
        }
        if let (Some(first), Some(slices)) = (place.first_mut(), &self.slices) {
            *first = slices[*first];
        }
        place
    }
}

/// The message about a difference from `a`.
fn text(difference: &Difference, a: &Numbers) -> String {
    let place =
        if difference.largest > 0.0 { format!(" at {:?}", a.place(difference.at)) } else { String::new() };
    let unmatched = match difference.unmatched {
        0 => String::new(),
        n => format!("\n{n} values are not a number on one side only"),
    };
    format!(
        "{} of shape {:?}\nlargest difference {:e} ({:e} of the largest value){place}\nrelative L2 difference {:e}{unmatched}\n",
        a.what, a.shape, difference.largest, difference.largest_relative, difference.l2_relative
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_have_one_index_an_axis() {
        let numbers = Numbers { what: "x".into(), shape: vec![2, 2], slices: None, values: vec![0.0; 4] };
        assert_eq!((numbers.place(2), numbers.place(3)), (vec![1, 0], vec![1, 1]));
        let volume = Numbers { slices: Some(vec![4, 8]), ..numbers };
        assert_eq!(volume.place(3), [8, 1]);
    }
}
