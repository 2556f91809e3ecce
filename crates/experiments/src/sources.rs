//! Fields of every source: generators, formulas, data files, other fields.

use crate::fault::{SourceFault, SpecError};
use crate::form::{DeriveRule, FieldFile, FieldSource, Named, Parameter, Placed, Sigma};
use crate::host::Host;
use crate::parse::parse;
use tigereye_core::{Cell, Field, Grid, Tensor2};
use tigereye_fields::{Arguments, ExpressionField, FieldError, Form, with_noise};
use tigereye_input::{Derivation, Derived, PlaneField, Reading};
use tigereye_io::volume::{ComponentArrays, Crop, Frame, Plane, PlaneChoice, Shear, parse_slice};

/// The field of a source.
///
/// # Errors
/// What is wrong with it.
pub fn make_field(source: &FieldSource, host: &dyn Host) -> Result<Field<Tensor2>, SourceFault> {
    make_plane(source, host).map(|(plane, _)| plane.field)
}

/// The field of a source with where it lies and what was read, and the format of its data file, where it has one.
///
/// # Errors
/// What is wrong with it.
pub fn make_plane(
    source: &FieldSource,
    host: &dyn Host,
) -> Result<(PlaneField, Option<&'static str>), SourceFault> {
    let made = |field| {
        let story = vec!["made by a generator or formulas, row 0 on top, x right, y up".to_owned()];
        (PlaneField::new(field, story), None)
    };
    match source {
        FieldSource::Generator { name, parameters } => {
            let arguments = arguments_of(parameters)?;
            Ok(tigereye_fields::generate(name, &arguments).map(made).map_err(|e| e.to_string())?)
        }
        FieldSource::Axes { width, height, phi, s1, s2 } => {
            let form = Form::Axes { phi: phi.to_string(), s1: s1.to_string(), s2: s2.to_string() };
            let field = ExpressionField { width: *width, height: *height, form }.build();
            field.map(made).map_err(|e| of_formula(&e, &[("phi", phi), ("s1", s1), ("s2", s2)]))
        }
        FieldSource::Components { width, height, xx, xy, yx, yy } => {
            let formulas = [("xx", xx), ("xy", xy), ("yx", yx), ("yy", yy)];
            let [xx, xy, yx, yy] = formulas.map(|(_, formula)| formula.to_string());
            let form = Form::Components { xx, xy, yx, yy };
            let field = ExpressionField { width: *width, height: *height, form }.build();
            field.map(made).map_err(|e| of_formula(&e, &formulas))
        }
        FieldSource::Noisy { of, share, seed } => {
            let (mut plane, kind) = make_plane(of, host)?;
            plane.field = with_noise(&plane.field, share.get(), *seed);
            plane.story.push(format!("noise of {} % of each tensor added", 100.0 * share.get()));
            Ok((plane, kind))
        }
        FieldSource::File { path, stride, .. } => {
            let fault = |e: &dyn std::fmt::Display| format!("{path}: {e}");
            let reading = reading_of(source).map_err(|e| fault(&e))?;
            let (mut plane, kind) = if is_field_file(path) {
                let (plane, kind) = plane_in_file(path, host)?;
                (defined_plane(plane, &reading).map_err(|e| fault(&e))?, kind)
            } else {
                let file = tigereye_input::open(path, &reading, &mut |name| host.read(name))
                    .map_err(|e| fault(&e))?;
                let plane = file.plane(&reading).map_err(|e| fault(&e))?;
                file.remarks()
                    .iter()
                    .chain(&plane.remarks)
                    .chain(&plane.oblong())
                    .for_each(|words| host.remark(&format!("{path}: {words}")));
                (plane, Some(file.kind))
            };
            let height = plane.field.grid().height();
            plane.field = strided(&plane.field, *stride).map_err(|e| fault(&e))?;
            plane.geometry = plane.geometry.strided(*stride, height);
            Ok((plane, kind))
        }
    }
}

/// The fault of a field by formulas, at the formula.
fn of_formula(error: &FieldError, formulas: &[(&str, &Placed<String>)]) -> SourceFault {
    let place = |name: &str| formulas.iter().find(|(n, _)| *n == name).map(|(_, formula)| formula.place());
    match error {
        FieldError::Expression { expression, error } => SourceFault {
            problem: format!("expression `{expression}`: {}", error.kind),
            place: place(expression).map(|place| place.inside(error.line, error.column)),
        },
        FieldError::NonFiniteValue { expression, .. } | FieldError::NegativeAxis { expression, .. } => {
            SourceFault { problem: error.to_string(), place: place(expression) }
        }
        other => SourceFault::from(other.to_string()),
    }
}

/// Whether a file's name says that it holds a [`crate::form::FieldFile`].
#[must_use]
pub fn is_field_file(name: &str) -> bool {
    tigereye_input::format_of(name) == "ron"
}

/// Reads a field that has a file of its own.
///
/// # Errors
/// The first fault, with line and column.
pub fn load_field(file: &str, text: &str) -> Result<FieldFile, SpecError> {
    parse(file, text, |field: &FieldFile| &field.format)
}

/// The field that a file of its own defines.
fn plane_in_file(path: &str, host: &dyn Host) -> Result<(PlaneField, Option<&'static str>), SourceFault> {
    let text = String::from_utf8(host.read(path)?).map_err(|_| format!("{path}: expected UTF-8 text"))?;
    let mut file = load_field(path, &text).map_err(|e| e.to_string())?;
    let mut source = &mut file.field;
    while let FieldSource::Noisy { of, .. } = source {
        source = of;
    }
    if let FieldSource::File { path: other, mask, .. } = source {
        // One might lead back to the first.
        if is_field_file(other) {
            let problem =
                format!("{path}: its field is in {other}: expected a generator, formulas or a data file");
            return Err(problem.into());
        }
        for name in std::iter::once(other).chain(mask) {
            *name = beside(path, name, host);
        }
    }
    make_plane(&file.field, host).map_err(|e| SourceFault::from(e.in_file(path, &text)))
}

/// What a file at `path` calls `name`: the file beside it, where there is one.
pub(crate) fn beside(path: &str, name: &str, host: &dyn Host) -> String {
    let beside = path.rfind(['/', '\\']).map(|folder| format!("{}{name}", &path[..=folder]));
    beside.filter(|path| host.has(path)).unwrap_or_else(|| name.to_owned())
}

/// A field that needs no reading, cropped and resampled.
///
/// # Errors
/// [`tigereye_input::InputError::Needless`] for what only data files have, and as [`PlaneField::cropped`] and
/// [`PlaneField::resampled`].
pub fn defined_plane(plane: PlaneField, reading: &Reading) -> Result<PlaneField, tigereye_input::InputError> {
    let grid = plane.field.grid();
    let choice = reading.choice.resolve([grid.width(), grid.height(), 1])?;
    let of_files = [
        (choice.0 != Plane::Xy, "--plane"),
        (reading.order.is_some(), "--order"),
        (reading.components.is_some(), "--components"),
        (reading.shear.is_some(), "--shear"),
        (reading.frame.is_some(), "--frame"),
        (reading.array.is_some(), "--array"),
        (reading.derive.is_some(), "--derive"),
        (reading.mask.is_some(), "--mask"),
        (reading.mask_array.is_some(), "--mask-array"),
        (reading.mask_above != 0.0, "--mask-above"),
        (reading.zero_not_finite, "--not-finite"),
        (reading.limit.is_some(), "--limit"),
    ];
    if let Some((_, option)) = of_files.into_iter().find(|(is_given, _)| *is_given) {
        let why = "the field is made by a generator or a field file and lies in the plane xy";
        return Err(tigereye_input::InputError::Needless { option, why });
    }
    plane.cropped(reading)?.resampled(reading)
}

/// What an experiment says about a file; nothing for other sources.
fn reading_of(source: &FieldSource) -> Result<Reading, String> {
    let FieldSource::File {
        array,
        components,
        order,
        shear,
        frame,
        slice,
        plane,
        crop,
        resample,
        derive,
        mask,
        mask_array,
        mask_above,
        not_finite,
        ..
    } = source
    else {
        return Ok(Reading::default());
    };
    let zero_not_finite = match not_finite.as_deref() {
        None | Some("refuse") => false,
        Some("zero") => true,
        Some(other) => return Err(format!("not_finite `{other}`: expected refuse or zero")),
    };
    if !mask_above.is_finite() || *mask_above < 0.0 {
        return Err(format!("mask_above {mask_above}: expected a finite number from 0"));
    }
    let frame = frame.as_ref().map(|name| {
        Frame::from_name(name)
            .ok_or_else(|| format!("frame `{name}`: expected voxel, world, measurement, fsl or lps"))
    });
    let shear = match shear.as_deref() {
        None => None,
        Some("tensor") => Some(Shear::Tensor),
        Some("engineering") => Some(Shear::Engineering),
        Some(other) => return Err(format!("shear `{other}`: expected tensor or engineering")),
    };
    let components = components
        .as_ref()
        .map(|text| ComponentArrays::parse(text).map_err(|e| format!("components `{text}`: {e}")));
    let plane = plane
        .as_ref()
        .map(|name| Plane::from_name(name).ok_or_else(|| format!("plane `{name}`: expected xy, xz or yz")));
    let slice = slice.as_ref().map(|text| parse_slice(text).map_err(|e| format!("slice `{text}`: {e}")));
    let crop = crop.as_ref().map(|text| Crop::parse(text).map_err(|e| format!("crop `{text}`: {e}")));
    Ok(Reading {
        array: array.clone(),
        components: components.transpose()?,
        order: order.clone(),
        shear,
        frame: frame.transpose()?,
        choice: PlaneChoice { plane: plane.transpose()?, slice: slice.transpose()? },
        crop: crop.transpose()?,
        resample: resample.map(|(width, height)| [width, height]),
        derive: derive.map(derivation),
        mask: mask.clone(),
        mask_array: mask_array.clone(),
        mask_above: *mask_above,
        zero_not_finite,
        limit: None,
    })
}

fn derivation(rule: DeriveRule) -> Derivation {
    let (kind, sigma, window) = match rule {
        DeriveRule::Gradient { sigma } => (Derived::Gradient, sigma, None),
        DeriveRule::Hessian { sigma } => (Derived::Hessian, sigma, None),
        DeriveRule::StrainRate { sigma } => (Derived::StrainRate, sigma, None),
        DeriveRule::Structure { sigma, window } => (Derived::Structure, sigma, window),
        DeriveRule::Orientation { sigma, window } => (Derived::Orientation, sigma, window),
    };
    Derivation {
        kind,
        sigma: sigma.map_or_else(|| kind.usual_sigma(), Sigma::get),
        window: window.map(Sigma::get),
    }
}

fn arguments_of(parameters: &Named<Parameter>) -> Result<Arguments, String> {
    let mut arguments = Arguments::new();
    for (key, value) in parameters.iter() {
        arguments.insert(key, &value.0).map_err(|e| e.to_string())?;
    }
    Ok(arguments)
}

/// Every `stride`-th cell of both directions.
fn strided(field: &Field<Tensor2>, stride: usize) -> Result<Field<Tensor2>, String> {
    if stride == 0 {
        return Err("a stride of 0 keeps no cell: expected 1 or more".to_owned());
    }
    let grid = field.grid();
    let kept = Grid::new(grid.width().div_ceil(stride), grid.height().div_ceil(stride))
        .map_err(|e| e.to_string())?;
    Ok(Field::from_fn(kept, |c| *field.at(Cell::new(c.x * stride, c.y * stride))))
}
