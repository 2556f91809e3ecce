//! A tensor, or a vector, from arrays of their own: which array is which component.

use crate::DataArray;

/// The arrays that a user names, `XX=S_XX,YY=S_YY,XY=S_XY`, or rows of three (or two) numbers, `X=T_x,Y=T_y,Z=T_z`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ComponentArrays {
    /// Component and array, in the order given.
    pairs: Vec<(String, String)>,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// One number a component of a tensor.
    Entries,
    /// Rows of a tensor, or the components of a vector, by x, y, z in this order.
    Rows,
}

const EXPECTED: &str = "expected XX=NAME,YY=NAME,XY=NAME and so on for arrays of one number, or X=NAME,Y=NAME,Z=NAME, or two of these, for rows or vectors";

impl ComponentArrays {
    /// The arrays as people write them.
    ///
    /// # Errors
    /// What was expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let pair = |part: &str| {
            let (component, array) = part.split_once('=')?;
            let (component, array) = (component.trim().to_lowercase(), array.trim());
            (!component.is_empty() && !array.is_empty()).then(|| (component, array.to_owned()))
        };
        let pairs: Option<Vec<(String, String)>> = text.split(',').map(pair).collect();
        let pairs = pairs.ok_or(EXPECTED)?;
        let names: Vec<&str> = pairs.iter().map(|p| p.0.as_str()).collect();
        if super::names::VECTOR_AXES.contains(&&names[..]) {
            return Ok(Self { pairs, kind: Kind::Rows });
        }
        let entries = super::names::entries(&names).ok_or(EXPECTED)?;
        super::TensorOrder::by_entries(&entries).map_err(|e| format!("expected {e}"))?;
        Ok(Self { pairs, kind: Kind::Entries })
    }

    /// As the option spells it.
    #[must_use]
    pub fn text(&self) -> String {
        let pairs: Vec<String> =
            self.pairs.iter().map(|(c, a)| format!("{}={a}", c.to_uppercase())).collect();
        pairs.join(",")
    }

    /// Whether the arrays hold one number each: entries of a tensor, or components of a vector where vectors are
    /// wanted.
    pub(crate) fn are_numbers(&self, wanted: crate::Wanted) -> bool {
        self.kind == Kind::Entries || wanted == crate::Wanted::Vectors
    }

    /// Names of the arrays, in the order given.
    pub fn arrays(&self) -> impl Iterator<Item = &str> {
        self.pairs.iter().map(|p| p.1.as_str())
    }

    /// One array of arrays in the order given; its components are named. `None` where their sizes do not fit.
    pub(crate) fn joined(&self, arrays: &[&DataArray]) -> Option<DataArray> {
        let names: Vec<&str> = self.pairs.iter().map(|p| p.0.as_str()).collect();
        match self.kind {
            Kind::Entries => joined(&names, arrays),
            Kind::Rows => joined_rows(&names, arrays),
        }
    }
}

/// Arrays of one number, tuple by tuple, with names for the components.
pub(crate) fn joined(names: &[&str], arrays: &[&DataArray]) -> Option<DataArray> {
    let first = arrays.first()?;
    let fits = |a: &&DataArray| a.components == 1 && a.values.len() == first.values.len();
    if names.len() != arrays.len() || !arrays.iter().all(fits) {
        return None;
    }
    let values = (0..first.values.len()).flat_map(|i| arrays.iter().map(move |a| a.values[i])).collect();
    let all: Vec<&str> = arrays.iter().map(|a| a.name.as_str()).collect();
    let array = DataArray::new(&all.join(", "), arrays.len(), values);
    Some(DataArray { scalar: first.scalar, ..array }.with_component_names(names))
}

/// Rows of a tensor along these axes one after the other; of arrays of one number, the components of a vector.
pub(crate) fn joined_rows(axes: &[&str], arrays: &[&DataArray]) -> Option<DataArray> {
    let (first, n) = (arrays.first()?, arrays.len());
    let length = first.components;
    if !arrays.iter().all(|a| a.components == length && a.values.len() == first.values.len()) {
        return None;
    }
    if length == 1 {
        return joined(axes, arrays);
    }
    if length != n || axes.len() != n {
        return None;
    }
    let tuples = first.values.len() / n;
    let row =
        |tuple: usize| arrays.iter().flat_map(move |a| a.values[tuple * n..(tuple + 1) * n].iter().copied());
    let values = (0..tuples).flat_map(row).collect();
    let all: Vec<&str> = arrays.iter().map(|a| a.name.as_str()).collect();
    let names: Vec<String> =
        axes.iter().flat_map(|row| axes.iter().map(move |column| format!("{row}{column}"))).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let array = DataArray::new(&all.join(", "), n * n, values).with_component_names(&names);
    Some(DataArray { scalar: first.scalar, ..array })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_are_said_by_entries_or_by_rows() {
        let arrays = ComponentArrays::parse("XX=S_XX, yy=S YY,XY=S_XY").expect("three components");
        assert_eq!(arrays.text(), "XX=S_XX,YY=S YY,XY=S_XY");
        let one = |name: &str, v: f64| DataArray::new(name, 1, vec![v, 10.0 * v]);
        let (a, b, c) = (one("S_XX", 1.0), one("S YY", 2.0), one("S_XY", 3.0));
        let joined = arrays.joined(&[&a, &b, &c]).expect("arrays of one size");
        assert_eq!(
            (joined.values, joined.component_names),
            (vec![1.0, 2.0, 3.0, 10.0, 20.0, 30.0], vec!["xx".into(), "yy".into(), "xy".into()])
        );
        let rows = ComponentArrays::parse("X=a,Y=b").expect("two rows");
        let two = |v: f64| DataArray::new("r", 2, vec![v, v + 1.0]);
        let joined = rows.joined(&[&two(1.0), &two(3.0)]).expect("rows");
        assert_eq!((joined.values, joined.components), (vec![1.0, 2.0, 3.0, 4.0], 4));
        assert!(rows.joined(&[&two(1.0), &one("s", 1.0)]).is_none());
        for text in ["", "XX", "XX=", "XX=a,YY=b", "XX=a,XX=b,XY=c", "Q=a", "Y=a,X=b"] {
            assert!(ComponentArrays::parse(text).is_err_and(|e| e.contains("expected")), "{text}");
        }
    }
}
