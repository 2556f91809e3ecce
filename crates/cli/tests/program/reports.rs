//! Files of situations that users of other programs reported, each read as its author meant it or refused by name. The
//! files are looked for in the folder `reports` of `TIGEREYE_DATA` or of `../shared/data`.

use crate::support::Place;
use std::path::PathBuf;
use tigereye_core::{Field, Svd, Tensor2};
use tigereye_io::npy;
use tigereye_test_support::data_folder;

/// Relative error of numbers that files hold in single precision or with six digits.
const DIGITS: f64 = 1e-5;

/// What a command reads of a report, and what it says beside.
struct Reports {
    folder: PathBuf,
    place: Place,
}

impl Reports {
    fn open() -> Option<Self> {
        data_folder("reports").map(|folder| Self { folder, place: Place::new() })
    }

    fn path(&self, name: &str) -> String {
        self.folder.join(name).display().to_string()
    }

    /// The plane as `convert` writes it, and what was said on standard error.
    #[track_caller]
    fn plane(&self, name: &str, options: &[&str]) -> (Field<Tensor2>, String) {
        let path = self.path(name);
        let run = self.place.tigereye(&[&["convert", &path, "out.npy", "--force"], options].concat());
        assert_eq!(run.code, 0, "{name} {options:?}: {}", run.stderr);
        (npy::read_tensors(&self.place.read("out.npy")).unwrap(), run.stderr)
    }

    /// Every inner cell is this tensor; what was said.
    #[track_caller]
    fn inner(&self, name: &str, options: &[&str], [xx, xy, yx, yy]: [f64; 4]) -> String {
        let (field, said) = self.plane(name, options);
        let grid = field.grid();
        let inner = |x: usize, n: usize| x > 0 && x + 1 < n || n < 3;
        for (cell, t) in field.iter() {
            if inner(cell.x, grid.width()) && inner(cell.y, grid.height()) {
                same(name, t, &Tensor2::new(xx, xy, yx, yy));
            }
        }
        said
    }
}

#[track_caller]
fn same(what: &str, found: &Tensor2, expected: &Tensor2) {
    let scale = expected.max_abs().max(1e-300);
    let both = found.components().into_iter().zip(expected.components());
    let off = both.map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) <= DIGITS * scale, "{what}: {found:?} instead of {expected:?}");
}

fn angle_deg(t: &Tensor2) -> f64 {
    Svd::of(&t.symmetric_part()).phi_rad().to_degrees().rem_euclid(180.0)
}

#[test]
fn fsl_tensors_point_the_same_way_in_images_of_either_hand() {
    let Some(reports) = Reports::open() else { return };
    for name in ["fsl_ras.nii.gz", "fsl_las.nii.gz"] {
        let (field, said) = reports.plane(name, &["--order", "fsl", "--slice", "z=1"]);
        for (_, t) in field.iter() {
            assert!((angle_deg(t) - 30.0).abs() < 0.1, "{name}: {t:?}");
        }
        assert!(!said.contains("WARNING"), "{name}: {said}");
    }
    // Along the voxel axes, where somebody says so, only one of them does; and the recipe for dipy gives 30 degrees,
    // too.
    let (field, _) =
        reports.plane("fsl_ras.nii.gz", &["--order", "fsl", "--frame", "voxel", "--slice", "z=1"]);
    assert!((angle_deg(&field.values()[0]) - 150.0).abs() < 0.1);
    let (_, said) = reports.plane("fsl_ras.nii.gz", &["--order", "nrrd", "--slice", "z=1"]);
    assert!(said.contains("WARNING") && said.contains("--frame fsl"), "{said}");
}

#[test]
fn rounding_chooses_no_axes() {
    let Some(reports) = Reports::open() else { return };
    let path = reports.path("mixed_signs_rounded.npy");
    let run = reports.place.tigereye(&["lines", &path, "--seed", "32,20", "-o", "lines.vtp", "--json"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let lines = tigereye_io::vtp::read(&reports.place.read("lines.vtp")).unwrap();
    // The tension is radial about (20, 19.5): the line through (32, 20) is a radius, with y upwards.
    assert!(lines.points.len() > 3);
    let off = |p: &[f64; 3]| ((p[0] - 20.0) * 0.5 - (p[1] - 19.5) * 12.0).abs() / 12.0;
    assert!(lines.points.iter().all(|p| off(p) < 0.05), "{:?}", &lines.points[..4]);
}

#[test]
fn planes_are_laid_out_by_their_geometry() {
    let Some(reports) = Reports::open() else { return };
    for name in ["meshgrid.vtk", "swapped_axes.vti"] {
        let (field, _) = reports.plane(name, &[]);
        let grid = field.grid();
        assert_eq!((grid.width(), grid.height()), (21, 15), "{name}");
        for (cell, t) in field.iter() {
            let lower_right = name == "meshgrid.vtk" && cell.x == 20 && cell.y == 14;
            let is_round = 1.0 - Svd::of(t).axis_ratio() < 1e-6;
            assert_eq!(is_round, lower_right, "{name} {cell:?}: {t:?}");
            assert!(is_round || (angle_deg(t) - 20.0).abs() < 0.1, "{name} {cell:?}: {t:?}");
        }
        let path = reports.path(name);
        let run = reports.place.tigereye(&["lines", &path, "-o", "lines.vtp"]);
        assert_eq!(run.code, 0, "{}", run.stderr);
        let lines = tigereye_io::vtp::read(&reports.place.read("lines.vtp")).unwrap();
        let range = |axis: usize| {
            let values = lines.points.iter().map(|p| p[axis]);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)])
        };
        let ([x0, x1], [y0, y1]) = (range(0), range(1));
        assert!(x0 >= -1e-6 && x1 <= 20.0 + 1e-6 && x1 > 19.0, "{name}: {x0} to {x1}");
        assert!(y0 >= -1e-6 && y1 <= 14.0 + 1e-6 && y1 > 13.0, "{name}: {y0} to {y1}");
    }
}

#[test]
fn components_are_what_their_names_say() {
    let Some(reports) = Reports::open() else { return };
    for name in ["plane_strain_named.vti", "upper_S11.vti", "upper_sigma_xx.vtp", "voigt_named.vti"] {
        let said = reports.inner(name, &[], [5.0, 2.0, 2.0, -1.0]);
        assert_eq!(said, "", "{name}");
    }
    // Another tensor, with yy and xy where VTK's own order has yy and xz.
    assert_eq!(reports.inner("voigt_named_active.vtk", &[], [5.0, 2.0, 2.0, 3.0]), "");
    let said = reports.inner("plane_strain_plain.vti", &["--order", "xx,yy,zz,xy"], [5.0, 2.0, 2.0, -1.0]);
    assert_eq!(said, "");
    let (_, said) = reports.plane("plane_strain_plain.vti", &[]);
    assert!(said.contains("assumed component order xx,xy,yx,yy") && said.contains("xx,yy,zz,xy"), "{said}");
    reports.inner("names_11_22_33_12_13_23.vti", &["--slice", "x=1"], [2.0, 0.3, 0.3, 3.0]);
    reports.inner("itk_sym.nii.gz", &["--slice", "z=1"], [3.0, 1.0, 1.0, 2.0]);
    let path = reports.path("principal_values.vti");
    reports.place.refuses(&["info", &path], &["S_Principal", "principal values", "Min, Mid, Max, Worst"]);
}

#[test]
fn arrays_nobody_asked_for_are_in_nobodys_way() {
    let Some(reports) = Reports::open() else { return };
    for name in ["ids_binary.vtk", "string_beside.vtk", "string_in_field.vtk"] {
        let (field, _) = reports.plane(name, &[]);
        assert!(field.values().iter().all(|t| t.is_finite() && !t.is_zero()), "{name}");
    }
    let (field, _) = reports.plane("hidden_point.vti", &[]);
    let masked = field.values().iter().filter(|t| t.is_zero()).count();
    assert_eq!((masked, field.values().iter().map(Tensor2::max_abs).fold(0.0, f64::max)), (1, 3.0));
    let info = reports.place.succeeds(&["info", &reports.path("hidden_point.vti")]);
    assert!(info.stdout.contains("1 points hidden"), "{}", info.stdout);
}

#[test]
fn derivatives_know_their_frames_and_holes() {
    let Some(reports) = Reports::open() else { return };
    // The velocity along the world's axes in a volume whose x runs to the left: the picture has the world's x to the
    // right.
    let said = reports.inner(
        "velocity_las.nii.gz",
        &["--derive", "gradient", "--slice", "z=1"],
        [0.3, -0.7, 0.5, 0.2],
    );
    assert!(said.contains("vectors along the world axes, right, anterior and superior"), "{said}");
    let gradient = Tensor2::new(0.2, 0.1, 0.3, 0.0);
    let mask = reports.path("uv_mask.npy");
    for (name, options) in [
        ("uv_nan.npy", &["--derive", "gradient", "--mask", &mask][..]),
        ("uv_zero.npy", &["--derive", "gradient", "--mask", &mask]),
        ("uv_nan.npy", &["--derive", "gradient", "--not-finite", "zero"]),
    ] {
        let (field, said) = reports.plane(name, options);
        let lost = field.values().iter().filter(|t| t.is_zero()).count();
        assert!(lost > 0 && lost < field.grid().cells() / 2, "{name}: {lost} cells lost");
        field.values().iter().filter(|t| !t.is_zero()).for_each(|t| same(name, t, &gradient));
        assert!(said.contains(&format!("{lost} of ")), "{name}: {said}");
    }
    let (field, _) = reports.plane("quadric.npy", &["--derive", "hessian"]);
    for (cell, t) in field.iter() {
        assert!((t.yy() + 3.0).abs() < 1e-9, "{cell:?}: {t:?}");
    }
    let path = reports.path("piv_xyuvfm.txt");
    reports.place.refuses(&["convert", &path, "piv.npy"], &["--derive"]);
    let (field, _) = reports.plane("piv_xyuvfm.txt", &["--derive", "gradient"]);
    assert!(field.values().iter().all(Tensor2::is_finite));
}

#[test]
fn anisotropy_of_a_plane_is_that_of_the_volume() {
    let Some(reports) = Reports::open() else { return };
    let facts = reports.place.succeeds(&["info", &reports.path("shear.npy"), "--json"]).json();
    let (plane, volume) =
        (&facts["fractional_anisotropy"]["max"], &facts["volume"]["fractional_anisotropy"]["max"]);
    assert_eq!(plane, volume);
    assert!((plane.as_f64().unwrap() - 1.5_f64.sqrt()).abs() < 1e-12, "{plane}");
}
