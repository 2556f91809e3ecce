//! Component orders as people spell them.

use super::convention::Alias;
use super::error::VolumeError;
use super::names::entries;
use super::order::TensorOrder;

impl TensorOrder {
    /// An alias of [`ALIASES`](super::ALIASES) or the components themselves, `xx,xy,xz,yy,yz,zz`, in any spelling that
    /// files use (`11,12,13,22,23,33`).
    ///
    /// # Errors
    /// [`VolumeError::Order`] for anything else, and for an alias or names that do not fit the number of components.
    pub fn parse(text: &str, components: usize) -> Result<Self, VolumeError> {
        let fault =
            |expected: &'static str| VolumeError::Order { order: shorten(text), components, expected };
        if let Some(alias) = Alias::named(text) {
            return alias.order(components).ok_or_else(|| fault(alternatives(components)));
        }
        Self::listed(text, components).map_err(fault)
    }

    fn listed(text: &str, components: usize) -> Result<Self, &'static str> {
        // A component more than there can be is enough to refuse it.
        let words: Vec<&str> = text.split(',').map(str::trim).take(10).collect();
        let entries = entries(&words).ok_or(
            "vtk, nrrd, dipy, fsl, mrtrix, itk, voigt, abaqus or component names such as xx,xy,xz,yy,yz,zz",
        )?;
        if entries.len() != components {
            return Err("a name for every component");
        }
        Self::by_entries(&entries)
    }
}

/// What `--order` may be for a number of components.
const fn alternatives(components: usize) -> &'static str {
    match components {
        9 => "an order of nine components: vtk, nrrd, dipy, or names such as xx,xy,xz,yx,yy,yz,zx,zy,zz",
        6 => "an order of six components: vtk, nrrd, dipy, fsl, mrtrix, itk, voigt, abaqus, or names",
        4 => "an order of four components: nrrd (xx,xy,yx,yy), abaqus (xx,yy,zz,xy), or names",
        3 => "an order of three components: nrrd (xx,xy,yy), voigt (xx,yy,xy), or names",
        _ => "names of all components",
    }
}

/// The components in the order of the file: `xx,xy,xz,yy,yz,zz`.
fn shorten(text: &str) -> String {
    crate::text::shortened(text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_spelled_as_their_tools_have_them() {
        for (order, text) in [
            (TensorOrder::VTK, "xx,yy,zz,xy,yz,xz"),
            (TensorOrder::UPPER, "xx,xy,xz,yy,yz,zz"),
            (TensorOrder::LOWER, "xx,xy,yy,xz,yz,zz"),
            (TensorOrder::MRTRIX, "xx,yy,zz,xy,xz,yz"),
            (TensorOrder::ROWS3, "xx,xy,xz,yx,yy,yz,zx,zy,zz"),
            (TensorOrder::ROWS2, "xx,xy,yx,yy"),
            (TensorOrder::UPPER2, "xx,xy,yy"),
            (TensorOrder::VOIGT, "xx,yy,zz,yz,xz,xy"),
            (TensorOrder::VOIGT2, "xx,yy,xy"),
            (TensorOrder::PLANE_STRAIN, "xx,yy,zz,xy"),
        ] {
            assert_eq!(order.to_string(), text);
            assert_eq!(TensorOrder::parse(text, order.components()), Ok(order));
        }
        assert_eq!(TensorOrder::parse("xx,yx,yy,zx,zy,zz", 6), Ok(TensorOrder::LOWER));
        assert_eq!(TensorOrder::parse("FSL", 6), Ok(TensorOrder::UPPER));
        assert_eq!(TensorOrder::parse("dipy", 9), Ok(TensorOrder::ROWS3));
        assert_eq!(TensorOrder::parse("11,22,12", 3), Ok(TensorOrder::VOIGT2));
        assert_eq!(TensorOrder::parse("voigt", 3), Ok(TensorOrder::VOIGT2));
        // A model in the plane xz, and a tensor without the shears across its plane.
        let upright = TensorOrder::parse("xx,zz,xz", 3).map(|o| o.tensor(&[1.0, 2.0, 3.0]));
        assert_eq!(upright, Ok([1.0, 0.0, 3.0, 0.0, 0.0, 0.0, 3.0, 0.0, 2.0]));
        let strain = TensorOrder::PLANE_STRAIN.tensor(&[5.0, -1.0, 7.0, 2.0]);
        assert_eq!(strain, [5.0, 2.0, 0.0, 2.0, -1.0, 0.0, 0.0, 0.0, 7.0]);
    }

    #[test]
    fn orders_that_do_not_fit_are_refused() {
        for (text, components) in [
            ("afni", 6),
            ("", 6),
            ("xx,xy,xz,yy,yz,zz", 9),
            ("xx,xx,yy", 3),
            ("xx,xy,xz,yy", 4),
            ("vtk", 3),
            ("vtk", 4),
            ("dipy", 3),
            ("fsl", 9),
            ("mrtrix", 3),
            ("itk", 4),
            ("xx,yy,zz", 3),
            ("vtk", 7),
        ] {
            let message = TensorOrder::parse(text, components).map_err(|e| e.to_string());
            assert!(message.is_err_and(|m| m.contains("expected")), "{text}");
        }
    }
}
