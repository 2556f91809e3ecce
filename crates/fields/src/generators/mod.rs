//! The generators, one per file. A new one is a file with a constant `GENERATOR` and a line here.

use crate::Generator;

mod curve;
mod degenerate_point;

macro_rules! generators {
    ($($name:ident),+ $(,)?) => {
        $(mod $name;)+
        /// All generators, sorted by name.
        pub(crate) static ALL: &[&Generator] = &[$(&$name::GENERATOR),+];
    };
}

generators! {
    absorb,
    bow,
    cantilever,
    cone,
    corner,
    cross_x,
    diag_drain,
    double_gyre,
    drain,
    drain_alt,
    drain_old,
    flamant,
    gyre,
    helix,
    inverse,
    isotropic,
    kirsch,
    point_load,
    random,
    rings,
    sink,
    spiral,
    star,
    step,
    trisector,
    v,
    wedge,
    x,
    y,
}
