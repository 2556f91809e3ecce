//! What components mean: names, aliases, frames and what is assumed, read from bytes as programs write them.

use tigereye_core::Tensor2;
use tigereye_io::volume::{
    ALIASES, CONVENTIONS, ComponentArrays, Frame, Known, Lattice, Plane, PlaneChoice, Reading, Shear,
    TensorOrder, VolumeError, documentation, lattice_from_image, lattice_from_points,
};
use tigereye_io::{
    ArrayChoice, ArrayError, ChoiceError, DataArray, ImageData, IoError, ScalarType, Wanted, legacy, nifti,
    nrrd,
};

/// Components of one symmetric tensor by their names; no two alike.
const ENTRIES: [(&str, f64); 6] =
    [("xx", 5.0), ("yy", -1.0), ("zz", 3.0), ("xy", 2.0), ("xz", 0.4), ("yz", 0.3)];

fn value(name: &str) -> f64 {
    let mirrored: String = name.chars().rev().collect();
    ENTRIES.iter().find(|(n, _)| *n == name || *n == mirrored).unwrap().1
}

/// An image of 3 x 2 x 1 points with one array of equal tuples.
pub(crate) fn image(name: &str, tuple: &[f64], names: &[&str]) -> ImageData {
    let mut image = ImageData::empty([3, 2, 1]);
    let values = tuple.repeat(6);
    image.point_arrays.push(DataArray::new(name, tuple.len(), values).with_component_names(names));
    image
}

pub(crate) fn plane(lattice: Lattice, reading: Reading) -> Result<Tensor2, IoError> {
    let choice = PlaneChoice { plane: Some(Plane::Xy), slice: None };
    Ok(lattice.tensors(reading)?.slice(choice)?.field.values()[0])
}

pub(crate) const EXPECTED: Tensor2 = Tensor2::symmetric(5.0, 2.0, -1.0);

/// The page of the documentation is made of the tables that decide; TIGEREYE_BLESS=1 writes it.
#[test]
fn the_documentation_is_made_of_the_tables() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/reference/component-orders.md");
    if std::env::var_os("TIGEREYE_BLESS").is_some() {
        std::fs::write(path, documentation()).unwrap();
    }
    let found = std::fs::read_to_string(path).unwrap();
    assert!(found == documentation(), "{path} is stale: TIGEREYE_BLESS=1 makes it anew");
}

#[test]
fn tables_have_one_row_for_every_case() {
    for (i, row) in CONVENTIONS.iter().enumerate() {
        let same =
            |c: &&tigereye_io::volume::Convention| c.content == row.content && c.components == row.components;
        assert_eq!(CONVENTIONS.iter().filter(same).count(), 1, "row {i}");
        assert!(row.order.is_none_or(|(order, _)| order.components() == row.components), "row {i}");
    }
    for alias in &ALIASES {
        for order in alias.orders {
            assert_eq!(TensorOrder::parse(alias.name, order.components()), Ok(*order));
        }
        let others = (1..10).filter(|&n| alias.order(n).is_none());
        for components in others {
            let fault = TensorOrder::parse(&alias.name.to_uppercase(), components).unwrap_err().to_string();
            assert!(fault.contains(&format!("{components}")) && fault.contains("expected"), "{fault}");
        }
    }
}

/// Whatever the spelling, the association and the order: names decide, and are called stated.
#[test]
fn names_beat_every_convention() {
    let spelt = |style: &str, entry: &str| {
        let digits = |first: u8| entry.bytes().map(|b| (b - b'x' + first).to_string()).collect::<String>();
        match style {
            "11" => digits(1),
            "00" => digits(0),
            "S11" => format!("S{}", digits(1)),
            "XX" => entry.to_uppercase(),
            "sigma_xx" => format!("sigma_{entry}"),
            "stress-XX" => format!("stress-{}", entry.to_uppercase()),
            _ => entry.to_owned(),
        }
    };
    let orders = [
        "xx,yy,zz,xy,yz,xz",
        "xx,yy,zz,yz,xz,xy",
        "xx,xy,xz,yy,yz,zz",
        "xx,xy,yy,xz,yz,zz",
        "zz,yy,xx,zy,zx,yx",
        "xx,yy,zz,xy",
        "xx,yy,xy",
        "xy,xx,yy",
        "xx,xy,xz,yx,yy,yz,zx,zy,zz",
        "xx,xy,yx,yy",
    ];
    for order in orders {
        let entries: Vec<&str> = order.split(',').collect();
        let tuple: Vec<f64> = entries.iter().map(|e| value(e)).collect();
        for style in ["xx", "XX", "11", "00", "S11", "sigma_xx", "stress-XX"] {
            let names: Vec<String> = entries.iter().map(|e| spelt(style, e)).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            for active in [false, true] {
                let mut image = image("t", &tuple, &names);
                image.point_active.tensors = active.then(|| "t".to_owned());
                let lattice = lattice_from_image(&image, None, Wanted::Tensors).unwrap();
                assert_eq!(lattice.order.unwrap().1, Known::Stated, "{order} as {style}");
                assert_eq!(plane(lattice, Reading::default()), Ok(EXPECTED), "{order} as {style}");
            }
        }
    }
    // What the user says comes first, and the contradiction is known.
    let image = image("t", &[5.0, 2.0, -1.0], &["xx", "yy", "xy"]);
    let lattice = lattice_from_image(&image, None, Wanted::Tensors).unwrap();
    let reading = Reading { order: Some("xx,xy,yy"), ..Reading::default() };
    let volume = lattice.clone().tensors(reading).unwrap();
    assert_eq!(volume.contradicted_order(), Some(TensorOrder::VOIGT2));
    assert_eq!(plane(lattice, reading), Ok(EXPECTED));
}

#[test]
fn unnamed_numbers_are_assumed_or_said() {
    for (components, known) in
        [(9, Known::Convention), (6, Known::Assumed), (4, Known::Assumed), (3, Known::Assumed)]
    {
        let lattice =
            lattice_from_image(&image("t", &vec![1.0; components], &[]), None, Wanted::Tensors).unwrap();
        assert_eq!(lattice.order.unwrap().1, known, "{components}");
    }
    let strain = image("t", &[5.0, -1.0, 3.0, 2.0], &[]);
    let strain = || lattice_from_image(&strain, None, Wanted::Tensors).unwrap();
    let by = |order| plane(strain(), Reading { order: Some(order), ..Reading::default() });
    assert_eq!(by("xx,yy,zz,xy"), Ok(EXPECTED));
    assert_eq!(by("abaqus"), Ok(EXPECTED));
    assert!(matches!(by("vtk"), Err(IoError::Volume(VolumeError::Order { .. }))));
}

#[test]
fn principal_values_are_no_tensor() {
    let names = ["Min", "Mid", "Max", "Worst"];
    for (name, names) in
        [("S_Principal", &names[..]), ("t", &["Sigma 1", "Sigma 2", "Sigma 3"]), ("eigenvalues", &[])]
    {
        let image = image(name, &vec![1.0; names.len().max(3)], names);
        for array in [None, Some(name)] {
            let found =
                lattice_from_image(&image, array, Wanted::Tensors).and_then(|l| plane(l, Reading::default()));
            assert!(
                matches!(found, Err(IoError::Volume(VolumeError::Principal { .. }))),
                "{name}: {found:?}"
            );
        }
    }
}

#[test]
fn the_tensor_is_taken_before_vectors_and_ids() {
    let mut image = image("velocity", &[1.0, 2.0, 3.0], &[]);
    image.point_arrays.push(DataArray::new("id", 1, vec![7.0; 6]));
    image.point_arrays.push(DataArray::new("stress", 6, [5.0, -1.0, 3.0, 2.0, 0.3, 0.4].repeat(6)));
    let found = lattice_from_image(&image, None, Wanted::Tensors).unwrap();
    assert_eq!(found.array, "stress");
    let vectors = lattice_from_image(&image, None, Wanted::Vectors).unwrap();
    assert_eq!(vectors.array, "velocity");
    // In the cells beside vectors of the points, too, and in arrays of their own.
    let mut cells = image.clone();
    let stress = cells.point_arrays.pop().unwrap();
    cells.cell_arrays.push(DataArray::new("stress", 6, stress.values[..12].to_vec()));
    assert_eq!(lattice_from_image(&cells, None, Wanted::Tensors).unwrap().array, "stress");
    cells.cell_arrays = ["S_XX", "S_YY", "S_XY"].map(|n| DataArray::new(n, 1, vec![1.0; 2])).to_vec();
    assert_eq!(lattice_from_image(&cells, None, Wanted::Tensors).unwrap().array, "S_XX, S_YY, S_XY");
    image.point_arrays.push(DataArray::new("strain", 6, vec![0.0; 36]));
    let several = lattice_from_image(&image, None, Wanted::Tensors).unwrap_err();
    assert!(
        matches!(&several, IoError::Choice(ChoiceError::Ambiguous { candidates }) if candidates.len() == 2),
        "{several}"
    );
}

/// Colours and normals are no tensors, and a tensor beside the active one is reported as ignored.
#[test]
fn what_is_beside_the_tensor_is_known() {
    let mut image = ImageData::empty([2, 1, 1]);
    image
        .point_arrays
        .push(DataArray { scalar: ScalarType::UInt8, ..DataArray::new("rgb", 3, vec![9.0; 6]) });
    image.point_arrays.push(DataArray::new("N", 3, vec![1.0; 6]));
    image.point_active.marks.push("N".to_owned());
    let refused = lattice_from_image(&image, None, Wanted::Tensors).unwrap_err();
    assert!(matches!(refused, IoError::Choice(ChoiceError::NoArray { .. })), "{refused}");
    for name in ["a", "b"] {
        image.point_arrays.push(DataArray::new(name, 9, vec![1.0; 18]));
    }
    image.point_active.tensors = Some("b".to_owned());
    let found = lattice_from_image(&image, None, Wanted::Tensors).unwrap();
    assert_eq!(found.array, "b");
    assert!(found.remarks.iter().any(|r| r.contains("ignored: `a`")), "{:?}", found.remarks);
    let named = lattice_from_image(&image, ArrayChoice::Named("a"), Wanted::Tensors).unwrap();
    assert_eq!((named.array.as_str(), named.remarks.len()), ("a", 0));
}

#[test]
fn separate_arrays_are_one_tensor() {
    let mut parts = ImageData::empty([3, 2, 1]);
    let add = |image: &mut ImageData, name: &str, tuple: &[f64]| {
        image.point_arrays.push(DataArray::new(name, tuple.len(), tuple.repeat(6)));
    };
    for (name, v) in [("S_YY", -1.0), ("pressure", 9.0), ("S_XX", 5.0), ("S_XY", 2.0)] {
        add(&mut parts, name, &[v]);
    }
    let found = lattice_from_image(&parts, None, Wanted::Tensors).unwrap();
    assert_eq!((found.components, found.order.unwrap().1), (3, Known::Stated));
    assert_eq!(plane(found, Reading::default()), Ok(EXPECTED));
    // Two tensors are not guessed between; naming one helps.
    for (name, v) in [("E_XX", 0.5), ("E_YY", 0.6), ("E_XY", 0.7)] {
        add(&mut parts, name, &[v]);
    }
    let ambiguous = lattice_from_image(&parts, None, Wanted::Tensors);
    assert!(matches!(ambiguous, Err(IoError::Choice(ChoiceError::Ambiguous { .. }))));
    // By the words of the message.
    for name in ["S_YY, S_XX, S_XY", "points:S_YY,S_XX,S_XY"] {
        let found = lattice_from_image(&parts, ArrayChoice::Named(name), Wanted::Tensors).unwrap();
        assert_eq!(plane(found, Reading::default()), Ok(EXPECTED), "{name}");
    }
    let arrays = ComponentArrays::parse("XX=S_XX,YY=S_YY,XY=S_XY").unwrap();
    let found = lattice_from_image(&parts, ArrayChoice::Components(&arrays), Wanted::Tensors).unwrap();
    assert_eq!(plane(found, Reading::default()), Ok(EXPECTED));
    let absent = ComponentArrays::parse("XX=S_XX,YY=S_YY,XY=S_XZ").unwrap();
    let fault = lattice_from_image(&parts, ArrayChoice::Components(&absent), Wanted::Tensors).unwrap_err();
    assert!(fault.to_string().contains("`S_XZ`"), "{fault}");
    // Rows.
    let mut rows = ImageData::empty([3, 2, 1]);
    for (name, row) in [("T_y", [2.0, -1.0, 0.3]), ("T_z", [0.4, 0.3, 3.0]), ("T_x", [5.0, 2.0, 0.4])] {
        add(&mut rows, name, &row);
    }
    let found = lattice_from_image(&rows, None, Wanted::Tensors).unwrap();
    assert_eq!(plane(found, Reading::default()), Ok(EXPECTED));
    // Components of a velocity.
    let mut flow = ImageData::empty([3, 2, 1]);
    for (name, v) in [("x", 0.0), ("v", 2.0), ("u", 1.0)] {
        add(&mut flow, name, &[v]);
    }
    let found = lattice_from_image(&flow, None, Wanted::Vectors).unwrap();
    assert_eq!((found.components, &found.values[..2]), (2, &[1.0, 2.0][..]));
}

/// One array at points and one in cells are as ambiguous as two at points.
#[test]
fn points_and_cells_are_not_chosen_between() {
    let mut both = ImageData::empty([4, 3, 1]);
    both.point_arrays.push(DataArray::new("s", 4, [5.0, 2.0, 2.0, -1.0].repeat(12)));
    both.cell_arrays.push(DataArray::new("s", 4, [9.0, 0.0, 0.0, 9.0].repeat(6)));
    for choice in [None, Some("s")] {
        let fault = lattice_from_image(&both, choice, Wanted::Tensors).unwrap_err().to_string();
        assert!(fault.contains("`points:s`") && fault.contains("`cells:s`"), "{fault}");
    }
    let read = |name| lattice_from_image(&both, Some(name), Wanted::Tensors).map(|l| (l.size, l.values[0]));
    assert_eq!(read("points:s"), Ok(([4, 3, 1], 5.0)));
    assert_eq!(read("cells:s"), Ok(([3, 2, 1], 9.0)));
    assert!(read("cells:t").is_err());
    // The one that the file marks as its tensors is meant.
    both.cell_active.tensors = Some("s".to_owned());
    assert_eq!(lattice_from_image(&both, None, Wanted::Tensors).unwrap().size, [3, 2, 1]);
    both.point_active.tensors = Some("s".to_owned());
    assert!(lattice_from_image(&both, None, Wanted::Tensors).is_err());
}

/// Blocks are an assumption about rows of numbers, which symmetric ones confirm.
#[test]
fn blocks_that_are_not_symmetric_are_said_to_be_assumed() {
    let said = |text: &str| !tigereye_io::matrices::read_lattice(text.as_bytes()).unwrap().remarks.is_empty();
    assert!(said("1 2 3 4\n5 6 7 8\n"));
    assert!(!said("1 2 3 4\n2 6 4 8\n"));
}

/// What VTK hides is no data, what it duplicates is.
#[test]
fn hidden_points_and_cells_are_masked() {
    let mut grid = ImageData::empty([4, 3, 1]);
    let tuple: Vec<f64> = (0..12).flat_map(|i| [f64::from(i) + 1.0, 0.0, 0.0, 1.0]).collect();
    grid.point_arrays.push(DataArray::new("t", 4, tuple));
    let mut ghosts = vec![0.0; 12];
    (ghosts[5], ghosts[6], ghosts[0]) = (2.0, 1.0, 3.0);
    grid.point_arrays.push(DataArray::new("vtkGhostType", 1, ghosts));
    let masked = |image: &ImageData, array: &str| -> Vec<usize> {
        let mask = lattice_from_image(image, Some(array), Wanted::Tensors).unwrap().mask.unwrap();
        (0..mask.len()).filter(|&i| mask[i] == 0.0).collect()
    };
    assert_eq!(masked(&grid, "t"), [0, 5]);
    // Cells with a hidden point are hidden.
    grid.cell_arrays.push(DataArray::new("c", 4, vec![1.0; 24]));
    assert_eq!(masked(&grid, "c"), [0, 1, 3, 4]);
    // Points are, where all their cells are.
    grid.point_arrays.pop();
    grid.cell_arrays.push(DataArray::new("vtkGhostType", 1, vec![32.0, 32.0, 0.0, 1.0, 8.0, 0.0]));
    assert_eq!(masked(&grid, "t"), [0, 1]);
    assert_eq!(masked(&grid, "c"), [0, 1, 4]);
}

#[test]
fn engineering_shears_are_halved_once() {
    let order = |order| Reading { order: Some(order), shear: Some(Shear::Engineering), ..Reading::default() };
    let six =
        lattice_from_image(&image("strain", &[5.0, -1.0, 3.0, 4.0, 0.6, 0.8], &[]), None, Wanted::Tensors)
            .unwrap();
    let volume = six.tensors(order("vtk")).unwrap();
    assert_eq!(volume.stored(0), [5.0, 2.0, 0.4, 2.0, -1.0, 0.3, 0.4, 0.3, 3.0]);
    let plain = lattice_from_image(
        &image("strain", &[5.0, -1.0, 4.0], &["xx", "yy", "gamma_xy"]),
        None,
        Wanted::Tensors,
    );
    let volume =
        plain.unwrap().tensors(Reading { shear: Some(Shear::Engineering), ..Reading::default() }).unwrap();
    assert_eq!(volume.stored(0)[..2], [5.0, 2.0]);
    assert!(!volume.suggests_engineering_shears(), "said");
    let strain = image("strain", &[5.0, -1.0, 3.0, 4.0, 0.6, 0.8], &[]);
    let open = lattice_from_image(&strain, None, Wanted::Tensors).unwrap();
    assert!(open.tensors(Reading::default()).unwrap().suggests_engineering_shears());
    let nine = lattice_from_image(&image("strain", &[1.0; 9], &[]), None, Wanted::Tensors).unwrap();
    assert!(matches!(nine.tensors(order("vtk")), Err(VolumeError::NoSharedShear { .. })));
}

fn legacy_bytes(kind: &str, body: &[u8]) -> Vec<u8> {
    let head =
        format!("# vtk DataFile Version 5.1\ntitle\n{kind}\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 1 1\n");
    [head.as_bytes(), body].concat()
}

#[test]
fn legacy_files_name_their_components() {
    let body = "POINT_DATA 2\nTENSORS6 t double\n5 -1 3 0.3 0.4 2\n5 -1 3 0.3 0.4 2\nMETADATA\nCOMPONENT_NAMES\nXX\nYY\nZZ\nYZ\nXZ\nX%59\n\
                INFORMATION 0\n\nFIELD FieldData 2\nother 2 2 double\n1 2 3 4\nMETADATA\nCOMPONENT_NAMES\na%20b\nc\n\nlast 1 2 int\n7 8\n";
    // Keywords in any case, too.
    for body in [
        body.to_owned(),
        body.replace("POINT_DATA", "point_data")
            .replace("TENSORS6", "Tensors6")
            .replace("METADATA", "metadata"),
    ] {
        let image = legacy::read(&legacy_bytes("ASCII", body.as_bytes())).unwrap();
        let lattice = lattice_from_image(&image, None, Wanted::Tensors).unwrap();
        assert_eq!(lattice.order.map(|o| o.1), Some(Known::Stated));
        assert_eq!(plane(lattice, Reading::default()), Ok(EXPECTED));
        assert_eq!(image.point_array("other").unwrap().component_names, ["a b", "c"]);
        assert_eq!(image.point_array("last").unwrap().values, [7.0, 8.0]);
    }
}

/// Arrays without numbers are stepped over to the byte, so that what follows is right.
#[test]
fn legacy_files_may_hold_what_nobody_asked_for() {
    let text = "FIELD FieldData 2\nunits 1 1 string\nMPa of 2%20K\nflags 1 3 bit\n1 0 1\nPOINT_DATA 2\nSCALARS b bit\nLOOKUP_TABLE default\n1 0\n\
                FIELD more 2\nnames 1 2 string\nalpha\nbeta gamma\nt 9 2 double\n5 2 0 2 -1 0 0 0 3 5 2 0 2 -1 0 0 0 3\n";
    let image = legacy::read(&legacy_bytes("ASCII", text.as_bytes())).unwrap();
    assert_eq!(
        plane(lattice_from_image(&image, None, Wanted::Tensors).unwrap(), Reading::default()),
        Ok(EXPECTED)
    );
    assert_eq!(image.skipped, ["`b` (bit, no numbers)", "`names` (string, no numbers)"]);
    let mut body = b"POINT_DATA 2\nFIELD more 4\nids 1 2 vtkIdType\n".to_vec();
    body.extend([0, 0, 0, 3, 0, 0, 0, 9, b'\n']);
    body.extend(b"names 1 2 string\n\xc3abc");
    // A string of 70 bytes has its length in two.
    body.extend([0x80, 70]);
    body.extend([b'x'; 70]);
    body.extend(b"\nbits 9 2 bit\n");
    body.extend([0xff, 0x00, 0x80, b'\n']);
    body.extend(b"t 9 2 double\n");
    let tuple = [5.0_f64, 2.0, 0.0, 2.0, -1.0, 0.0, 0.0, 0.0, 3.0];
    body.extend(tuple.repeat(2).iter().flat_map(|v| v.to_be_bytes()));
    let image = legacy::read(&legacy_bytes("BINARY", &body)).unwrap();
    assert_eq!(image.point_array("ids").unwrap().values, [3.0, 9.0]);
    assert_eq!(
        plane(lattice_from_image(&image, None, Wanted::Tensors).unwrap(), Reading::default()),
        Ok(EXPECTED)
    );
    // More strings than bytes are refused before anything is counted.
    let huge = legacy_bytes("ASCII", b"FIELD f 1\ns 1 99999999999 string\nx\n");
    assert!(matches!(legacy::read(&huge), Err(IoError::Array(ArrayError::Truncated { .. }))));
}

/// Single precision stays single: teem's `tend` takes no double.
#[test]
fn files_are_written_in_the_precision_they_had() {
    for scalar in [ScalarType::Float32, ScalarType::Float64, ScalarType::Int16] {
        let mut image = image("t", &[5.0, -1.0, 3.0, 2.0, 0.0, 0.0], &[]);
        image.point_arrays[0].scalar = scalar;
        let volume =
            lattice_from_image(&image, None, Wanted::Tensors).unwrap().tensors(Reading::default()).unwrap();
        let expected = if scalar == ScalarType::Float64 { ScalarType::Float64 } else { ScalarType::Float32 };
        let nrrd = nrrd::read(&nrrd::write(&volume, Frame::World, "").unwrap(), None).unwrap();
        let nifti = nifti::read(&nifti::write(&volume, nifti::WrittenAs::Matrices, "").unwrap()).unwrap();
        assert_eq!((nrrd.scalar, nifti.scalar), (expected, expected), "{scalar:?}");
    }
    let skew = image("t", &[1.0, 2.0, 3.0, 4.0], &[]);
    let skew = lattice_from_image(&skew, None, Wanted::Tensors).unwrap().tensors(Reading::default()).unwrap();
    assert_eq!(
        nifti::write(&skew, nifti::WrittenAs::Fsl, ""),
        Err(IoError::Volume(VolumeError::NotSymmetric))
    );
}

/// A points file hides points like an image does.
#[test]
fn points_are_masked_like_images() {
    let points = (0..4).map(|i| [f64::from(i % 2), f64::from(i / 2), 0.0]).collect();
    let mut data = tigereye_io::PolyData { points, ..tigereye_io::PolyData::default() };
    data.point_arrays.push(DataArray::new("t", 4, vec![1.0; 16]));
    data.point_arrays.push(DataArray::new("vtkGhostType", 1, vec![0.0, 2.0, 0.0, 0.0]));
    let lattice = lattice_from_points(data, None, Wanted::Tensors).unwrap();
    assert_eq!(lattice.mask, Some(vec![1.0, 0.0, 1.0, 1.0]));
    assert!(lattice.remarks.iter().any(|n| n.contains("1 points hidden")), "{:?}", lattice.remarks);
}

/// What a plane does not have is refused, not shown as zero; two components of a model in a plane are along its axes.
#[test]
fn components_belong_to_the_plane_that_is_shown() {
    let upright = |components: usize, names: &[&str]| {
        let mut image = ImageData::empty([3, 1, 2]);
        let tuple: Vec<f64> = (1..=components).map(|v| v as f64).collect();
        image.point_arrays.push(DataArray::new("t", components, tuple.repeat(6)).with_component_names(names));
        image
    };
    let image = upright(3, &["S11", "S22", "S12"]);
    let tensors = |reading| {
        let lattice = lattice_from_image(&image, None, Wanted::Tensors).unwrap();
        lattice.tensors(reading).unwrap().slice(PlaneChoice::default()).map(|s| s.field.values()[0])
    };
    let fault = tensors(Reading::default()).unwrap_err().to_string();
    assert!(fault.contains("xx,yy,xy") && fault.contains("--order xx,zz,xz"), "{fault}");
    let by = |order| tensors(Reading { order: Some(order), ..Reading::default() });
    assert_eq!(by("xx,zz,xz"), Ok(Tensor2::symmetric(1.0, 3.0, 2.0)));
    let vectors = |names: &[&str], frame| {
        let lattice = lattice_from_image(&upright(2, names), None, Wanted::Vectors).unwrap();
        lattice.vectors(PlaneChoice::default(), frame).map(|s| s.field.values()[0])
    };
    assert_eq!(vectors(&["X", "Z"], None), Ok([1.0, 2.0]));
    assert_eq!(vectors(&["w", "u"], None), Ok([2.0, 1.0]));
    for (names, found) in [(&[][..], "x and y"), (&["u", "v"], "x and y"), (&["v", "w"], "y and z")] {
        for frame in [None, Some(Frame::Voxel)] {
            let fault = vectors(names, frame).unwrap_err().to_string();
            assert!(fault.contains(&format!("along {found}, and the plane shows x and z")), "{fault}");
        }
    }
}

/// Two components say nothing of a plane that is tilted against them: vectors are refused, and of tensors it is said
/// what is assumed. A turn within the plane of the components is no tilt.
#[test]
fn planes_that_are_tilted_against_their_components_are_known() {
    let turned = |axis: usize, degrees: f64, components: usize| {
        let mut image = ImageData::empty([3, 2, 1]);
        let radians = degrees.to_radians();
        let (sin, cos) = (tigereye_core::math::sin(radians), tigereye_core::math::cos(radians));
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut direction = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        (direction[4 * a], direction[4 * b]) = (cos, cos);
        (direction[3 * a + b], direction[3 * b + a]) = (-sin, sin);
        image.direction = Some(direction);
        image.point_arrays.push(DataArray::new("t", components, vec![1.0; 6 * components]));
        image
    };
    for (axis, degrees, is_tilted) in [
        (2, 30.0, false),
        (2, 90.0, false),
        (0, 20.0, true),
        (0, 44.0, true),
        (0, 80.0, true),
        (1, 60.0, true),
    ] {
        let vectors = lattice_from_image(&turned(axis, degrees, 2), None, Wanted::Vectors).unwrap();
        let found = vectors.vectors(PlaneChoice::default(), None);
        assert_eq!(found.is_err(), is_tilted, "{axis} by {degrees}");
        let along_voxels = vectors.vectors(PlaneChoice::default(), Some(Frame::Voxel)).unwrap();
        assert_eq!(along_voxels.field.values()[0].map(f64::abs), [1.0; 2]);
        if let Err(fault) = found {
            let fault = fault.to_string();
            assert!(fault.contains("is tilted against these") && fault.contains("--frame voxel"), "{fault}");
        }
        let tensors = lattice_from_image(&turned(axis, degrees, 4), None, Wanted::Tensors).unwrap();
        let tensors = tensors.tensors(Reading::default()).unwrap();
        let slice = tensors.slice(PlaneChoice::default()).unwrap();
        let said = tensors.tilted(&slice.cut);
        assert_eq!(said.is_some(), is_tilted, "{axis} by {degrees}: {said:?}");
    }
    // Turned within the plane xz, whose zz is not there.
    let mut upright = turned(1, 30.0, 3);
    upright.dimensions = [3, 1, 2];
    upright.point_arrays[0] =
        DataArray::new("t", 3, vec![1.0; 18]).with_component_names(&["S11", "S22", "S12"]);
    let tensors = lattice_from_image(&upright, None, Wanted::Tensors).unwrap();
    let fault = tensors.tensors(Reading::default()).unwrap().slice(PlaneChoice::default()).unwrap_err();
    assert!(fault.to_string().contains("--order xx,zz,xz"), "{fault}");
}
