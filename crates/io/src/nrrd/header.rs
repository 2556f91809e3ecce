//! The text header of an NRRD file.

use super::error::NrrdError;
use super::layout::{KINDS, Kind, Layout};
use crate::limits::LimitError;
use crate::text::shortened;
use crate::volume::order_of;
use crate::{ByteOrder, IoError, Limits, ScalarType, Wanted};

/// Most axes of an array, as in teem.
const MAX_AXES: usize = 16;
/// Longest header; fields are short.
const MAX_HEADER: usize = 1 << 20;

/// Kinds of axes whose numbers form a vector.
const VECTOR_KINDS: [&str; 6] =
    ["vector", "2-vector", "3-vector", "covariant-vector", "3-gradient", "3-normal"];

/// Kinds of axes along which a picture extends: no tuples there.
const DOMAIN_KINDS: [&str; 3] = ["domain", "space", "time"];

/// How the numbers are encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Raw,
    Gzip,
    Text,
}

/// What the header says, in range.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub(super) scalar: ScalarType,
    pub(super) order: ByteOrder,
    pub(super) encoding: Encoding,
    /// Numbers in all; within the limits.
    pub(super) count: u64,
    pub(super) line_skip: u64,
    /// `None` where the data are the last bytes of the file.
    pub(super) byte_skip: Option<u64>,
    pub(super) data_file: Option<String>,
    /// First byte behind the header.
    pub(super) end: usize,
    pub(super) space: Option<String>,
    pub(super) measurement: Option<[f64; 9]>,
    sizes: Vec<u64>,
    kinds: Vec<String>,
    kinds_line: usize,
    /// Labels of the axes; empty where there are none.
    labels: Vec<String>,
    directions: Vec<Option<[f64; 3]>>,
    directions_line: usize,
    spacings: Vec<f64>,
    /// Least and greatest position along each axis; empty where there are none.
    minima: Vec<f64>,
    maxima: Vec<f64>,
    centerings: Vec<String>,
    origin: Option<[f64; 3]>,
    /// Units of the axes of the space, and of those of the array; empty where there are none.
    space_units: Vec<String>,
    units: Vec<String>,
    limits: Limits,
    /// The line that says that the numbers are diffusion-weighted images.
    weighted: Option<usize>,
    /// Lines of the header.
    lines: usize,
}

/// One `field: value` line.
struct Entry<'a> {
    line: usize,
    name: String,
    value: &'a str,
}

/// All lines, and where the data begin.
struct Fields<'a> {
    entries: Vec<Entry<'a>>,
    /// The line that says that the numbers are diffusion-weighted images, not tensors.
    weighted: Option<usize>,
    lines: usize,
    end: usize,
}

/// How keys and values begin that say so (NA-MIC, "Nrrd format for diffusion-weighted images").
const WEIGHTED: [&str; 2] = ["modality:=dwmri", "dwmri_"];

impl<'a> Fields<'a> {
    fn parse(bytes: &'a [u8]) -> Result<Self, NrrdError> {
        let fault = |line, field, found: &[u8], expected| NrrdError::Field {
            line,
            field,
            found: shortened(found),
            expected,
        };
        let magic = bytes.strip_prefix(b"NRRD000").and_then(|rest| rest.first());
        if !magic.is_some_and(|v| (b'1'..=b'6').contains(v)) {
            return Err(fault(1, "magic", bytes.get(..8).unwrap_or(bytes), "NRRD0001 to NRRD0006"));
        }
        let (mut at, mut line) = (0, 0);
        let mut entries: Vec<Entry> = Vec::new();
        let mut weighted = None;
        loop {
            let rest = &bytes[at..];
            line += 1;
            let Some(length) = rest.iter().take(MAX_HEADER.saturating_sub(at)).position(|&b| b == b'\n')
            else {
                // A header of its own may end without a blank line.
                if bytes.len() > MAX_HEADER {
                    return Err(fault(line, "end of the header", b"", "a blank line within a megabyte"));
                }
                if !rest.is_empty() {
                    entries.extend(Self::entry(rest, line)?);
                }
                return Ok(Self { entries, weighted, lines: line, end: bytes.len() });
            };
            let text = rest[..length].strip_suffix(b"\r").unwrap_or(&rest[..length]);
            at += length + 1;
            if text.is_empty() {
                return Ok(Self { entries, weighted, lines: line, end: at });
            }
            if line > 1 {
                entries.extend(Self::entry(text, line)?);
                // The names of several files follow up to the end.
                if entries.last().is_some_and(|e| e.name == "datafile" && e.value.starts_with("LIST")) {
                    return Ok(Self { entries, weighted, lines: line, end: bytes.len() });
                }
                let begins = |key: &&str| {
                    text.get(..key.len()).is_some_and(|t| t.eq_ignore_ascii_case(key.as_bytes()))
                };
                weighted = weighted.or_else(|| WEIGHTED.iter().any(begins).then_some(line));
            }
        }
    }

    /// A field; `None` for comments and for the key/value pairs of applications.
    fn entry(text: &'a [u8], line: usize) -> Result<Option<Entry<'a>>, NrrdError> {
        let fault = |expected| NrrdError::Field { line, field: "line", found: shortened(text), expected };
        if text.starts_with(b"#") {
            return Ok(None);
        }
        let words = std::str::from_utf8(text).map_err(|_| fault("UTF-8 text"))?;
        // `key:=value` belongs to applications.
        match words.split_once(':') {
            Some((_, value)) if value.starts_with('=') => Ok(None),
            Some((name, value)) => {
                let name: String = name.trim().to_ascii_lowercase().split_whitespace().collect();
                Ok(Some(Entry { line, name, value: value.trim() }))
            }
            None => Err(fault("`field: value`, `key:=value`, a comment or a blank line")),
        }
    }

    /// Refuses fields that are given twice: programs differ in which of them they take.
    fn check_once(&self) -> Result<(), NrrdError> {
        for (i, e) in self.entries.iter().enumerate() {
            if self.entries[..i].iter().any(|before| before.name == e.name) {
                let found = shortened(e.name.as_bytes());
                return Err(NrrdError::Field {
                    line: e.line,
                    field: "field",
                    found,
                    expected: "every field once",
                });
            }
        }
        Ok(())
    }

    /// The value of a field by its name without blanks.
    fn get(&self, names: &[&str]) -> Option<&Entry<'a>> {
        self.entries.iter().find(|e| names.contains(&e.name.as_str()))
    }

    fn required(
        &self,
        names: &[&str],
        field: &'static str,
        expected: &'static str,
    ) -> Result<&Entry<'a>, NrrdError> {
        let missing = || NrrdError::Field { line: self.lines, field, found: String::new(), expected };
        self.get(names).ok_or_else(missing)
    }
}

impl Entry<'_> {
    fn fault(&self, field: &'static str, expected: &'static str) -> NrrdError {
        NrrdError::Field { line: self.line, field, found: shortened(self.value.as_bytes()), expected }
    }

    fn integer(&self, field: &'static str, expected: &'static str) -> Result<i64, NrrdError> {
        self.value.parse().map_err(|_| self.fault(field, expected))
    }
}

impl Header {
    pub(super) fn parse(bytes: &[u8], limits: Limits) -> Result<Self, IoError> {
        let fields = Fields::parse(bytes)?;
        fields.check_once()?;
        let scalar = scalar(fields.required(&["type"], "type", TYPES)?)?;
        let encoding = encoding(fields.required(&["encoding"], "encoding", ENCODINGS)?)?;
        let sizes = sizes(&fields)?;
        let count = sizes.iter().fold(1_u128, |n, &s| n.saturating_mul(u128::from(s)));
        let count = match u64::try_from(count) {
            Ok(n) if n <= limits.values => n,
            _ => {
                let line = fields.get(&["sizes"]).map_or(1, |e| e.line);
                return Err(too_large(bytes, line, count, limits.values).into());
            }
        };
        let order = byte_order(&fields, scalar, encoding)?;
        if let Some(e) = fields.get(&["blocksize"]) {
            return Err(e.fault("block size", "numbers, not blocks").into());
        }
        let line_skip = match fields.get(&["lineskip"]) {
            Some(e) => u64::try_from(e.integer("line skip", "a count from 0")?)
                .map_err(|_| e.fault("line skip", "a count from 0"))?,
            None => 0,
        };
        let byte_skip = match fields.get(&["byteskip"]) {
            None => Some(0),
            Some(e) => match e.integer("byte skip", "a count from 0, or -1 with raw data")? {
                -1 if encoding == Encoding::Raw => None,
                n => Some(
                    u64::try_from(n)
                        .map_err(|_| e.fault("byte skip", "a count from 0, or -1 with raw data"))?,
                ),
            },
        };
        let kinds = fields.get(&["kinds"]);
        let axes = sizes.len();
        let (directions, directions_line) = match fields.get(&["spacedirections"]) {
            Some(e) => (vectors(e, "space directions", axes)?, e.line),
            None => (Vec::new(), 0),
        };
        if !directions.is_empty() && directions.len() != axes {
            let (found, expected) = (directions.len().to_string(), "a vector or `none` for every axis");
            return Err(NrrdError::Field {
                line: directions_line,
                field: "space directions",
                found,
                expected,
            }
            .into());
        }
        Ok(Self {
            scalar,
            order,
            encoding,
            count,
            line_skip,
            byte_skip,
            data_file: data_file(&fields)?,
            end: fields.end,
            space: fields.get(&["space"]).map(|e| shortened(e.value.as_bytes())),
            measurement: fields.get(&["measurementframe"]).map(measurement).transpose()?.flatten(),
            sizes,
            kinds: kinds.map_or_else(Vec::new, |e| e.value.split_whitespace().map(str::to_owned).collect()),
            kinds_line: kinds.map_or(fields.lines, |e| e.line),
            space_units: fields.get(&["spaceunits"]).map_or_else(Vec::new, |e| labels(e.value)),
            units: fields.get(&["units"]).map_or_else(Vec::new, |e| labels(e.value)),
            labels: fields.get(&["labels"]).map_or_else(Vec::new, |e| labels(e.value)),
            directions,
            directions_line,
            spacings: fields.get(&["spacings"]).map_or(Ok(Vec::new()), |e| spacings(e, axes))?,
            minima: fields.get(&["axismins"]).map_or(Ok(Vec::new()), |e| spacings(e, axes))?,
            maxima: fields.get(&["axismaxs"]).map_or(Ok(Vec::new()), |e| spacings(e, axes))?,
            centerings: fields
                .get(&["centerings", "centers"])
                .map_or_else(Vec::new, |e| e.value.split_whitespace().map(str::to_owned).collect()),
            origin: fields.get(&["spaceorigin"]).map(origin).transpose()?.flatten(),
            limits,
            weighted: fields.weighted,
            lines: fields.lines,
        })
    }

    pub(super) fn fault(&self, field: &'static str, found: &str, expected: &'static str) -> NrrdError {
        NrrdError::Field { line: self.lines, field, found: shortened(found.as_bytes()), expected }
    }

    pub(super) const fn has_directions(&self) -> bool {
        !self.directions.is_empty()
    }

    /// Finds the axis of tuples: by its kind, or else the first axis if it has a number of components that fits.
    pub(super) fn layout(&self, wanted: Wanted) -> Result<Layout, IoError> {
        let fault = |found: &str, expected| NrrdError::Field {
            line: self.kinds_line,
            field: "kinds",
            found: shortened(found.as_bytes()),
            expected,
        };
        if !self.kinds.is_empty() && self.kinds.len() != self.sizes.len() {
            return Err(fault(&self.kinds.join(" "), "a kind for every axis").into());
        }
        let kind = |name: &String| KINDS.into_iter().find(|k| k.name.eq_ignore_ascii_case(name));
        let tensors: Vec<(usize, Kind)> =
            self.kinds.iter().enumerate().filter_map(|(i, k)| Some((i, kind(k)?))).collect();
        let is_vector = |k: &String| VECTOR_KINDS.iter().any(|v| k.eq_ignore_ascii_case(v));
        let (axis, kind) = match (wanted, &tensors[..]) {
            (Wanted::Scalars | Wanted::Mask, _) => return self.scalar_layout(),
            (Wanted::Vectors, _) => match self.kinds.iter().position(is_vector) {
                Some(axis) if matches!(self.sizes[axis], 2 | 3) => (axis, None),
                None if self.kinds.is_empty() && matches!(self.sizes[0], 2 | 3) => (0, None),
                _ => {
                    return Err(fault(&self.kinds.join(" "), VECTOR_NAMES).into());
                }
            },
            (Wanted::Tensors, [(axis, kind)]) => (*axis, Some(*kind)),
            (Wanted::Tensors, []) if let Some(line) = self.weighted => {
                return Err(NrrdError::Weighted { line }.into());
            }
            (Wanted::Tensors, []) => {
                let axis = self.axis_of_numbers();
                (axis.ok_or_else(|| fault(&self.kinds.join(" "), KIND_NAMES))?, None)
            }
            (Wanted::Tensors, _) => return Err(fault(&self.kinds.join(" "), "one tensor axis").into()),
        };
        let tuple = kind.map_or(self.sizes[axis], |k| k.tuple() as u64);
        if tuple != self.sizes[axis] {
            return Err(fault(
                &format!("{} of size {}", self.kinds[axis], self.sizes[axis]),
                "the size of that kind",
            )
            .into());
        }
        let masked = kind.map_or(tuple == 7, |k| k.masked);
        let inner = self.sizes[..axis].iter().product::<u64>() as usize;
        let lattice = (0..self.sizes.len()).filter(|&a| a != axis).collect();
        let layout = Layout { kind, masked, axis, tuple: tuple as usize, lattice, size: [1; 3], inner };
        self.sized(layout)
    }

    /// The axis of tuples where no kind of tensors names it: labels do, or it has 6, 7 or 9 numbers of another kind
    /// than the lattice's, or it is the first without a kind.
    fn axis_of_numbers(&self) -> Option<usize> {
        let size = |axis: usize| self.sizes[axis];
        let named = |axis: usize| order_of(&self.component_names(axis, size(axis) as usize)).is_some();
        let is_domain = |axis: usize| {
            self.kinds.get(axis).is_some_and(|k| DOMAIN_KINDS.iter().any(|d| k.eq_ignore_ascii_case(d)))
        };
        let is_tuple = |axis: usize| {
            self.kinds.get(axis).is_some_and(|k| {
                k.eq_ignore_ascii_case("list") || VECTOR_KINDS.iter().any(|v| k.eq_ignore_ascii_case(v))
            })
        };
        let fits = |axis: usize| matches!(size(axis), 6 | 7 | 9) && self.sizes.len() > 2;
        let axes = || (0..self.sizes.len()).filter(|&a| !is_domain(a));
        axes()
            .find(|&a| named(a))
            // Three or four numbers are a tensor only if the user gives their order.
            .or_else(|| axes().find(|&a| is_tuple(a) && (fits(a) || matches!(size(a), 3 | 4))))
            .or_else(|| Some(0).filter(|&a| !is_domain(a) && fits(a)))
    }

    /// Names of the components on an axis, where its label lists as many: `xx,xy,xz,yy,yz,zz`.
    pub(super) fn component_names(&self, axis: usize, components: usize) -> Vec<String> {
        let Some(label) = self.labels.get(axis) else { return Vec::new() };
        let separators = [',', ';', '|', ' ', '\t'];
        let names: Vec<String> =
            label.split(separators).filter(|w| !w.is_empty()).map(str::to_owned).collect();
        if names.len() == components { names } else { Vec::new() }
    }

    /// Refuses space directions that are no axes of a space: `none` on an axis of the lattice, a vector on the axis of
    /// tuples, and vectors that lie in a plane.
    pub(super) fn check_directions(&self, layout: &Layout) -> Result<(), NrrdError> {
        if !self.has_directions() {
            return Ok(());
        }
        let fault = |found: String, expected| NrrdError::Field {
            line: self.directions_line,
            field: "space directions",
            found,
            expected,
        };
        let on = |axis: usize| self.directions[axis];
        if let Some(axis) = layout.lattice.iter().find(|&&a| on(a).is_none()) {
            return Err(fault(format!("none for axis {axis}"), "`none` for the axis of components only"));
        }
        let tuples = (0..self.sizes.len()).find(|a| !layout.lattice.contains(a));
        if let Some(axis) = tuples.filter(|&a| on(a).is_some()) {
            return Err(fault(format!("a vector for axis {axis}"), "`none` for the axis of components"));
        }
        let (axes, _) = self.geometry(layout);
        if determinant(axes).abs() > DEPENDENT * axes.map(length).iter().product::<f64>() {
            return Ok(());
        }
        Err(fault("dependent vectors".to_owned(), "linearly independent vectors"))
    }

    /// Single numbers: every axis is the lattice's.
    fn scalar_layout(&self) -> Result<Layout, IoError> {
        let lattice = (0..self.sizes.len()).collect();
        self.sized(Layout { kind: None, masked: false, axis: 0, tuple: 1, lattice, size: [1; 3], inner: 1 })
    }

    /// The layout with the size of its lattice.
    fn sized(&self, mut layout: Layout) -> Result<Layout, IoError> {
        if !(1..=3).contains(&layout.lattice.len()) {
            return Err(NrrdError::Field {
                line: self.kinds_line,
                field: "kinds",
                found: format!("{} axes", self.sizes.len()),
                expected: "one to three axes besides those of tuples",
            }
            .into());
        }
        let cells = u128::from(self.count) / layout.tuple as u128;
        if cells > u128::from(self.limits.cells) {
            return Err(LimitError::Cells { byte: 0, cells, limit: self.limits.cells }.into());
        }
        // The product of all sizes is within the limits.
        layout.lattice.iter().enumerate().for_each(|(i, &a)| layout.size[i] = self.sizes[a] as usize);
        Ok(layout)
    }

    /// Steps along the lattice's axes, and the first voxel.
    pub(super) fn geometry(&self, layout: &Layout) -> ([[f64; 3]; 3], [f64; 3]) {
        let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for (i, &a) in layout.lattice.iter().enumerate() {
            if let Some(Some(direction)) = self.directions.get(a) {
                axes[i] = *direction;
            } else if let Some([min, max]) =
                self.range_of(a).filter(|_| self.spacings.get(a).is_none_or(|s| s.is_nan()))
            {
                let steps = self.sizes[a] as f64 - if self.is_node_centred(a) { 1.0 } else { 0.0 };
                axes[i][i] = if steps > 0.0 && max != min { (max - min) / steps } else { 1.0 };
            } else if let Some(s) = self.spacings.get(a).filter(|s| s.is_finite() && **s != 0.0) {
                axes[i][i] = *s;
            }
        }
        if layout.lattice.len() < 3 && self.has_directions() {
            // A plane gets the normal of its axes, so that turning stays possible.
            axes[2] = normal(axes[0], axes[1]).unwrap_or(axes[2]);
        }
        (axes, self.origin.unwrap_or_else(|| self.origin_of_ranges(layout, axes)))
    }

    /// First and last position along an axis, where the file has them.
    fn range_of(&self, axis: usize) -> Option<[f64; 2]> {
        let [min, max] = [&self.minima, &self.maxima].map(|v| v.get(axis).copied().filter(|v| v.is_finite()));
        Some([min?, max?])
    }

    /// Whether samples lie at both ends of the range or in the middle of equal parts, as the file states it or as its
    /// spacing tells.
    fn stated_node_centring(&self, axis: usize) -> Option<bool> {
        match self.centerings.get(axis).map(|c| c.to_ascii_lowercase()).as_deref() {
            Some("node") => return Some(true),
            Some("cell") => return Some(false),
            _ => {}
        }
        let [min, max] = self.range_of(axis)?;
        let spacing = self.spacings.get(axis).filter(|s| s.is_finite() && **s != 0.0)?;
        let (steps, samples) = (((max - min) / spacing).abs(), *self.sizes.get(axis)? as f64);
        // Numbers of a header have few digits.
        let is = |expected: f64| (steps - expected).abs() < 1e-3;
        if is(samples - 1.0) { Some(true) } else { is(samples).then_some(false) }
    }

    /// By default samples lie at the centres of cells, as in teem.
    fn is_node_centred(&self, axis: usize) -> bool {
        self.stated_node_centring(axis).unwrap_or(false)
    }

    /// What is assumed of ranges whose ends may be samples or borders, in words.
    pub(super) fn assumed_centring(&self, layout: &Layout) -> Option<String> {
        let is_placed = |a: usize| self.directions.get(a).is_some_and(Option::is_some);
        let is_open = |a: usize| {
            let has_least = self.minima.get(a).is_some_and(|v| v.is_finite());
            has_least && !is_placed(a) && self.stated_node_centring(a).is_none()
        };
        let open: Vec<String> =
            layout.lattice.iter().filter(|&&a| is_open(a)).map(|a| (a + 1).to_string()).collect();
        (!open.is_empty() && self.origin.is_none()).then(|| {
            format!(
                "no centerings: the ranges (axis mins, axis maxs) of axis {} are taken as the outer borders of cells, half a step outside of \
                 their middles",
                open.join(", ")
            )
        })
    }

    /// A warning where the file measures its axes in different units.
    pub(super) fn unequal_units(&self, layout: &Layout) -> Option<String> {
        let of_axes = || layout.lattice.iter().filter_map(|&a| self.units.get(a).cloned()).collect();
        let all: Vec<String> = if self.has_directions() { self.space_units.clone() } else { of_axes() };
        let stated: Vec<&String> = all.iter().filter(|unit| !matches!(unit.trim(), "" | "???")).collect();
        stated.windows(2).any(|pair| pair[0].trim() != pair[1].trim()).then(|| {
            let units = stated.iter().map(|unit| unit.trim()).collect::<Vec<_>>().join(", ");
            format!("the axes have different units ({units}), taken as they stand")
        })
    }

    /// The first sample, where the file gives the least position along each axis.
    fn origin_of_ranges(&self, layout: &Layout, axes: [[f64; 3]; 3]) -> [f64; 3] {
        let mut origin = [0.0; 3];
        for (i, &a) in layout.lattice.iter().enumerate() {
            let least = self.minima.get(a).copied().filter(|v| v.is_finite());
            let inside = if self.is_node_centred(a) { 0.0 } else { 0.5 * axes[i][i] };
            origin[i] = least.map_or(0.0, |v| v + inside);
        }
        origin
    }
}

const TYPES: &str = "a number type such as float, double, short or uint8";
const ENCODINGS: &str = "raw, gzip or ascii";
const KIND_NAMES: &str = "a tensor kind such as 3D-symmetric-matrix for one axis, or 6, 7 or 9 numbers on the first axis, or on one of kind list or vector (there also 3 or 4, if --order names them)";
const VECTOR_NAMES: &str = "two or three numbers on an axis of kind vector, 2-vector, 3-vector, covariant-vector, 3-gradient or 3-normal";

fn too_large(bytes: &[u8], line: usize, count: u128, limit: u64) -> LimitError {
    let before = bytes.split(|&b| b == b'\n').take(line - 1).map(|l| l.len() + 1).sum();
    LimitError::Cells { byte: before, cells: count, limit }
}

fn scalar(e: &Entry) -> Result<ScalarType, NrrdError> {
    Ok(match e.value.to_ascii_lowercase().as_str() {
        "signed char" | "int8" | "int8_t" => ScalarType::Int8,
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => ScalarType::UInt8,
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => {
            ScalarType::Int16
        }
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => ScalarType::UInt16,
        "int" | "signed int" | "int32" | "int32_t" => ScalarType::Int32,
        "uint" | "unsigned int" | "uint32" | "uint32_t" => ScalarType::UInt32,
        "longlong"
        | "long long"
        | "long long int"
        | "signed long long"
        | "signed long long int"
        | "int64"
        | "int64_t" => ScalarType::Int64,
        "ulonglong" | "unsigned long long" | "unsigned long long int" | "uint64" | "uint64_t" => {
            ScalarType::UInt64
        }
        "float" => ScalarType::Float32,
        "double" => ScalarType::Float64,
        _ => return Err(e.fault("type", TYPES)),
    })
}

fn encoding(e: &Entry) -> Result<Encoding, NrrdError> {
    match e.value.to_ascii_lowercase().as_str() {
        "raw" => Ok(Encoding::Raw),
        "gzip" | "gz" => Ok(Encoding::Gzip),
        "ascii" | "text" | "txt" => Ok(Encoding::Text),
        _ => Err(e.fault("encoding", ENCODINGS)),
    }
}

fn byte_order(fields: &Fields, scalar: ScalarType, encoding: Encoding) -> Result<ByteOrder, NrrdError> {
    if encoding == Encoding::Text || scalar.bytes() == 1 {
        return Ok(ByteOrder::Little);
    }
    let e = fields.required(&["endian"], "endian", "little or big")?;
    match e.value.to_ascii_lowercase().as_str() {
        "little" => Ok(ByteOrder::Little),
        "big" => Ok(ByteOrder::Big),
        _ => Err(e.fault("endian", "little or big")),
    }
}

fn sizes(fields: &Fields) -> Result<Vec<u64>, NrrdError> {
    let d = fields.required(&["dimension"], "dimension", "a number of axes from 1 to 16")?;
    let axes = d.integer("dimension", "a number of axes from 1 to 16")?;
    if !(1..=MAX_AXES as i64).contains(&axes) {
        return Err(d.fault("dimension", "a number of axes from 1 to 16"));
    }
    let expected = "a positive integer for every axis";
    let e = fields.required(&["sizes"], "sizes", expected)?;
    let sizes: Option<Vec<u64>> =
        e.value.split_whitespace().take(MAX_AXES + 1).map(|w| w.parse().ok().filter(|&n| n > 0)).collect();
    sizes.filter(|s| s.len() as i64 == axes).ok_or_else(|| e.fault("sizes", expected))
}

/// The data file: a plain name, so that a header cannot point anywhere else.
fn data_file(fields: &Fields) -> Result<Option<String>, NrrdError> {
    let Some(e) = fields.get(&["datafile"]) else { return Ok(None) };
    let several =
        e.value.starts_with("LIST") || e.value.split_whitespace().count() > 1 && e.value.contains('%');
    if several || e.value.is_empty() {
        let expected = "the name of one file: `unu save -f nrrd -i NAME.nhdr -o NAME.nrrd` joins several";
        return Err(e.fault("data file", expected));
    }
    if e.value.starts_with(['/', '\\'])
        || e.value.contains(':')
        || e.value.split(['/', '\\']).any(|p| p == "..")
    {
        return Err(e.fault("data file", "a name in the folder of the header or below it"));
    }
    Ok(Some(e.value.to_owned()))
}

/// Vectors in parentheses, `none` where an axis has none. Two components get a third of 0.
fn vectors(e: &Entry, field: &'static str, most: usize) -> Result<Vec<Option<[f64; 3]>>, NrrdError> {
    let expected = "vectors (x,y,z), or none";
    let fault = || e.fault(field, expected);
    let (mut rest, mut found) = (e.value.trim_start(), Vec::new());
    while !rest.is_empty() {
        if found.len() >= most {
            return Err(fault());
        }
        if let Some(behind) = rest.strip_prefix('(') {
            let (inside, behind) = behind.split_once(')').ok_or_else(fault)?;
            let numbers: Option<Vec<f64>> = inside.split(',').take(4).map(finite).collect();
            found.push(Some(match numbers.as_deref() {
                Some(&[x, y, z]) => [x, y, z],
                Some(&[x, y]) => [x, y, 0.0],
                _ => return Err(fault()),
            }));
            rest = behind.trim_start();
        } else {
            rest = rest.strip_prefix("none").ok_or_else(fault)?.trim_start();
            found.push(None);
        }
    }
    Ok(found)
}

fn finite(word: &str) -> Option<f64> {
    word.trim().parse().ok().filter(|v: &f64| v.is_finite())
}

fn origin(e: &Entry) -> Result<Option<[f64; 3]>, NrrdError> {
    Ok(vectors(e, "space origin", 1)?.first().copied().flatten())
}

/// Vectors of the file are the columns of the matrix. Two vectors of a plane are completed by z.
fn measurement(e: &Entry) -> Result<Option<[f64; 9]>, NrrdError> {
    let found = vectors(e, "measurement frame", 3)?;
    let columns = match found[..] {
        [Some(a), Some(b), Some(c)] => [a, b, c],
        [Some(a), Some(b)] => [a, b, [0.0, 0.0, 1.0]],
        _ if found.iter().all(Option::is_none) => return Ok(None),
        _ => return Err(e.fault("measurement frame", "a vector for every axis of the space")),
    };
    let at = |i: usize| columns[i % 3][i / 3];
    Ok(Some([at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8)]))
}

fn spacings(e: &Entry, axes: usize) -> Result<Vec<f64>, NrrdError> {
    let numbers: Option<Vec<f64>> = e.value.split_whitespace().map(|w| w.parse().ok()).collect();
    numbers.filter(|n| n.len() == axes).ok_or_else(|| e.fault("spacings", "a number or nan for every axis"))
}

/// Volume of a box over the product of its edges below which these count as lying in a plane: files hold six digits.
const DEPENDENT: f64 = 1e-6;

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

fn length(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

/// Labels in double quotes, one for every axis.
fn labels(text: &str) -> Vec<String> {
    text.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

/// The unit vector at right angles to two others.
fn normal(a: [f64; 3], b: [f64; 3]) -> Option<[f64; 3]> {
    let n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    (length > 0.0 && length.is_finite()).then(|| n.map(|v| v / length))
}
