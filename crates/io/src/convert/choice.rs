//! Which array of image data is meant.

use super::arrays::described;
use super::error::ChoiceError;
use super::wanted::{Association, NAMED_MASK, Wanted};
use crate::image::ActiveArrays;
use crate::volume::{
    ComponentArrays, Group, Naming, VECTOR_AXES, VolumeError, groups, joined, joined_rows,
    names_principal_values, naming, outside_tensors, row_groups,
};
use crate::{DataArray, ImageData, IoError};
use std::borrow::Cow;

/// Which array the user names.
#[derive(Clone, Copy, Debug, Default)]
pub enum ArrayChoice<'a> {
    /// None: the active one of the wanted kind, or the only one that fits.
    #[default]
    Usual,
    /// An array by its name.
    Named(&'a str),
    /// Components in arrays of their own.
    Components(&'a ComponentArrays),
}

impl<'a> From<Option<&'a str>> for ArrayChoice<'a> {
    fn from(name: Option<&'a str>) -> Self {
        name.map_or(Self::Usual, Self::Named)
    }
}

pub(crate) type Found<'a> = (Association, Cow<'a, DataArray>);

/// The array that the user names, or the active one, or the one that suits best; separate arrays of single components
/// are joined.
pub(crate) fn choose_array<'a>(
    image: &'a ImageData,
    choice: ArrayChoice,
    wanted: Wanted,
) -> Result<Found<'a>, IoError> {
    match choice {
        ArrayChoice::Named(name) => match named(image, name) {
            Ok((on, array)) => Ok((on, Cow::Borrowed(array))),
            Err(error) => joined_as(image, name, wanted).ok_or(error),
        },
        ArrayChoice::Components(components) => by_components(image, components),
        ArrayChoice::Usual => usual(image, wanted),
    }
}

fn of(image: &ImageData, on: Association) -> (&[DataArray], &ActiveArrays) {
    match on {
        Association::Points => (&image.point_arrays, &image.point_active),
        Association::Cells => (&image.cell_arrays, &image.cell_active),
    }
}

const BOTH: [Association; 2] = [Association::Points, Association::Cells];

fn all(image: &ImageData) -> impl Iterator<Item = (Association, &DataArray)> {
    BOTH.into_iter().flat_map(|on| of(image, on).0.iter().map(move |a| (on, a)))
}

/// An array by its name, which `points:` or `cells:` may stand before.
fn named<'a>(image: &'a ImageData, name: &str) -> Result<(Association, &'a DataArray), IoError> {
    let called =
        |name: &str| all(image).filter(|(_, a)| a.name == name).collect::<Vec<(Association, &DataArray)>>();
    let at_one = || {
        let (on, rest) = BOTH.into_iter().find_map(|on| Some((on, name.strip_prefix(on.prefix())?)))?;
        called(rest).into_iter().find(|f| f.0 == on)
    };
    match called(name)[..] {
        [found] => Ok(found),
        [] => Ok(at_one().ok_or_else(|| missing(image, &format!("array `{name}`")))?),
        [..] => Err(ambiguous(called(name)).into()),
    }
}

/// The array of separate ones whose names, one after the other, are `name`, as messages list them.
fn joined_as<'a>(image: &'a ImageData, name: &str, wanted: Wanted) -> Option<Found<'a>> {
    let plain = |text: &str| text.split(',').map(|word| word.trim().to_owned()).collect::<Vec<String>>();
    let find = |on: Association| {
        let name = plain(name.strip_prefix(on.prefix()).unwrap_or(name));
        let found = separate(of(image, on).0, wanted).into_iter().find(|array| plain(&array.name) == name);
        found.map(|array| (on, Cow::Owned(array)))
    };
    // Where both have it, the prefix tells which is meant.
    let is_given = |on: &Association| name.starts_with(on.prefix());
    let all: Vec<Association> = BOTH.into_iter().filter(is_given).collect();
    let all = if all.is_empty() { BOTH.to_vec() } else { all };
    let mut found: Vec<Found> = all.into_iter().filter_map(find).collect();
    if found.len() == 1 { found.pop() } else { None }
}

/// The arrays that fit, with their association where they differ in it.
fn ambiguous<'a>(found: impl IntoIterator<Item = (Association, &'a DataArray)>) -> ChoiceError {
    let found: Vec<(Association, &DataArray)> = found.into_iter().collect();
    let differ = found.iter().any(|f| f.0 != found[0].0);
    let words = |(on, array): &(Association, &DataArray)| {
        let prefix = if differ { on.prefix() } else { "" };
        described([&DataArray {
            name: format!("{prefix}{}", array.name),
            ..DataArray::new("", array.components, Vec::new())
        }])
    };
    ChoiceError::Ambiguous { candidates: found.iter().flat_map(words).collect() }
}

fn by_components<'a>(image: &'a ImageData, components: &ComponentArrays) -> Result<Found<'a>, IoError> {
    let found = components.arrays().map(|name| named(image, name)).collect::<Result<Vec<_>, _>>()?;
    let (on, first) = found[0];
    let arrays: Vec<&DataArray> = found.iter().map(|f| f.1).collect();
    let joined = components.joined(&arrays).filter(|_| found.iter().all(|f| f.0 == on));
    let unfit = || VolumeError::UnequalComponents {
        first: first.name.clone(),
        found: described(arrays.iter().copied()),
    };
    Ok((on, Cow::Owned(joined.ok_or_else(unfit)?)))
}

fn usual(image: &ImageData, wanted: Wanted) -> Result<Found<'_>, IoError> {
    let suits = |(on, a): &(Association, &DataArray)| wanted.suits(a, of(image, *on).1);
    // What is called a mask goes before what happens to be active.
    let is_named = wanted == Wanted::Mask && all(image).any(|found| suits(&found) == NAMED_MASK);
    let is_active = |found: &(Association, &DataArray)| {
        let active = of(image, found.0).1;
        !is_named && wanted.active(active) == Some(&found.1.name) && suits(found) > 0
    };
    let borrowed = |(on, a)| (on, Cow::Borrowed(a));
    let active: Vec<Found> = all(image).filter(is_active).map(borrowed).collect();
    if let Some(found) = only(active)? {
        return Ok(found);
    }
    // Three numbers are a tensor only where nothing else is, at points and cells alike.
    let first = if is_named { NAMED_MASK } else { wanted.certain() };
    for least in [first, wanted.certain(), 1] {
        let mut fitting: Vec<Found> = Vec::new();
        for on in BOTH {
            let (arrays, active) = of(image, on);
            let best = arrays.iter().map(|a| wanted.suits(a, active)).max().unwrap_or(0);
            if best >= least {
                let fits = |a: &&DataArray| wanted.suits(a, active) == best;
                fitting.extend(arrays.iter().filter(fits).map(|a| borrowed((on, a))));
            } else {
                let mut found = separate(arrays, wanted);
                if found.len() > 1 {
                    return Err(ChoiceError::Ambiguous { candidates: described(&found) }.into());
                }
                fitting.extend(found.pop().map(|found| (on, Cow::Owned(found))));
            }
        }
        if let Some(found) = only(fitting)? {
            return Ok(found);
        }
    }
    let principal = |a: &DataArray| {
        naming(&a.component_names, a.components) == Naming::Principal || names_principal_values(&a.name)
    };
    match all(image).find(|(_, a)| wanted == Wanted::Tensors && a.components > 1 && principal(a)) {
        Some((_, a)) => {
            Err(VolumeError::Principal { array: a.name.clone(), names: a.component_names.join(", ") }.into())
        }
        None => Err(missing(image, wanted.words()).into()),
    }
}

/// Most arrays that a message names.
const MOST_NAMED: usize = 12;

/// The message for the case that the usual array of `image` was taken although there are others of its kind.
pub(crate) fn left_aside(image: &ImageData, wanted: Wanted, chosen: &Found) -> Option<String> {
    let is_another = |(on, array): &(Association, &DataArray)| {
        let is_chosen = *on == chosen.0 && array.name == chosen.1.name;
        !is_chosen && wanted.suits(array, of(image, *on).1) >= wanted.certain()
    };
    let others: Vec<&str> = all(image).filter(is_another).map(|(_, array)| array.name.as_str()).collect();
    if others.is_empty() {
        return None;
    }
    let active = wanted.active(of(image, chosen.0).1) == Some(&chosen.1.name);
    let how = if active { format!("the active {} ", wanted.word()) } else { String::new() };
    let named = others[..others.len().min(MOST_NAMED)].join("`, `");
    let more = others.len().saturating_sub(MOST_NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let (name, option) = (&chosen.1.name, wanted.option());
    Some(format!("took {how}`{name}`; ignored: `{named}`{more} ({option})"))
}

/// The only one of those that fit, where there is any.
fn only(mut found: Vec<Found>) -> Result<Option<Found>, IoError> {
    match found.len() {
        0 | 1 => Ok(found.pop()),
        _ => Err(ambiguous(found.iter().map(|(on, array)| (*on, array.as_ref()))).into()),
    }
}

/// The tensors, or the vectors, whose components are arrays of their own and called so.
fn separate(arrays: &[DataArray], wanted: Wanted) -> Vec<DataArray> {
    let with = |n: usize| arrays.iter().filter(|a| a.components == n).collect::<Vec<&DataArray>>();
    match wanted {
        Wanted::Tensors => {
            [entries(&with(1)), rows(&with(3), VECTOR_AXES[0]), rows(&with(2), VECTOR_AXES[1])].concat()
        }
        Wanted::Vectors => {
            let numbers = with(1);
            let names: Vec<&str> = numbers.iter().map(|a| a.name.as_str()).collect();
            let others: Vec<&DataArray> = outside_tensors(&names).into_iter().map(|i| numbers[i]).collect();
            VECTOR_AXES.iter().flat_map(|axes| rows(&others, axes)).collect()
        }
        Wanted::Scalars | Wanted::Mask => Vec::new(),
    }
}

/// Tensors whose entries are arrays of one number.
fn entries(arrays: &[&DataArray]) -> Vec<DataArray> {
    let names: Vec<&str> = arrays.iter().map(|a| a.name.as_str()).collect();
    let of_group = |group: Group| {
        let parts: Vec<&DataArray> = group.members.iter().map(|&i| arrays[i]).collect();
        let spelt = group.order.to_string();
        joined(&spelt.split(',').collect::<Vec<_>>(), &parts)
    };
    groups(&names).into_iter().filter_map(of_group).collect()
}

/// Tensors whose rows, or vectors whose components, are arrays, along these axes.
fn rows(arrays: &[&DataArray], axes: &[&str]) -> Vec<DataArray> {
    let names: Vec<&str> = arrays.iter().map(|a| a.name.as_str()).collect();
    let of_group =
        |members: Vec<usize>| joined_rows(axes, &members.iter().map(|&i| arrays[i]).collect::<Vec<_>>());
    row_groups(&names, axes).into_iter().filter_map(of_group).collect()
}

fn missing(image: &ImageData, wanted: &str) -> ChoiceError {
    let words = |(on, array): (Association, &DataArray)| {
        let is_vector = array.components == 2 || of(image, on).1.vectors.as_ref() == Some(&array.name);
        let words = described([array]).concat();
        if is_vector { words.replace(')', ", a vector)") } else { words }
    };
    let mut available: Vec<String> = all(image).map(words).collect();
    available.extend(image.skipped.iter().cloned());
    ChoiceError::NoArray { wanted: wanted.to_owned(), available }
}
