//! What headers of NRRD files say of axes and components.

use tigereye_io::nrrd::NrrdError;
use tigereye_io::volume::{Known, Lattice, TensorOrder};
use tigereye_io::{IoError, Wanted, nrrd};

/// What NRRD files do not say is asked for in full.
#[test]
fn messages_about_nrrd_name_what_is_read() {
    let head = "NRRD0005\ntype: float\ndimension: 3\nsizes: 3 2 2\nencoding: ascii\nkinds:";
    let fault = |more: &str, wanted| {
        let text = format!("{head} {more}\n\n{}", "1 0 1 ".repeat(4));
        nrrd::read_with_limits(text.as_bytes(), None, wanted, tigereye_io::Limits::default())
            .map(|_| ())
            .map_err(|e| e.to_string())
    };
    for kind in ["vector", "3-vector", "covariant-vector", "3-gradient", "3-normal"] {
        assert_eq!(fault(&format!("{kind} domain domain"), Wanted::Vectors), Ok(()));
        let words = fault("space domain domain", Wanted::Vectors).unwrap_err();
        assert!(words.contains(kind), "{kind}: {words}");
    }
    let list = fault("vector domain domain\ndata file: LIST\na.raw\nb.raw", Wanted::Tensors).unwrap_err();
    assert!(list.contains("line 7: NRRD field `data file`") && list.contains("unu save"), "{list}");
}

#[test]
fn axes_of_nrrd_in_different_units_are_warned_of() {
    let warnings = |more: &str| {
        let text = format!(
            "NRRD0005\ntype: float\ndimension: 3\nsizes: 3 2 2\nkinds: 2D-symmetric-matrix domain domain\nencoding: ascii\n\
             {more}\n\n{}",
            "1 0 1 ".repeat(4)
        );
        nrrd::read(text.as_bytes(), None).unwrap().warnings
    };
    let space = "space dimension: 2\nspace directions: none (1,0) (0,1)\nspace units:";
    assert_eq!(warnings(&format!("{space} \"mm\" \"mm\"")), Vec::<String>::new());
    assert_eq!(warnings("units: \"MPa\" \"mm\" \"mm\""), Vec::<String>::new());
    for more in [format!("{space} \"mm\" \"cm\""), "units: \"\" \"mm\" \"cm\"".to_owned()] {
        let found = warnings(&more);
        assert!(found.len() == 1 && found[0].contains("different units (mm, cm)"), "{more}: {found:?}");
    }
}

fn nrrd_text(fields: &str) -> Result<Lattice, IoError> {
    let numbers = "5 2 0.4 -1 0.3 3 ".repeat(2);
    let head = format!(
        "NRRD0005\ntype: float\ndimension: 4\nsizes: 6 2 1 1\nencoding: ascii\n{fields}\n\n{numbers}"
    );
    nrrd::read(head.as_bytes(), None)
}

#[test]
fn nrrd_axes_that_are_none_are_refused() {
    let kind = "kinds: 3D-symmetric-matrix space space space\nspace dimension: 3\nspace directions: ";
    assert!(nrrd_text(&format!("{kind}none (1,0,0) (0,1,0) (0,0,1)")).is_ok());
    for (directions, words) in [
        ("none (1,0,0) (2,0,0) (0,0,1)", "linearly independent"),
        ("none (1,0,0) none (0,0,1)", "`none` for the axis of components only"),
        ("(1,0,0) none (0,1,0) (0,0,1)", "`none` for the axis of components"),
        ("none (1,0,0) (0,1,0) (0,0,1) none", "vectors"),
        ("none (1,0,0) (0,1,0) (0,0,0)", "linearly independent"),
    ] {
        let fault = nrrd_text(&format!("{kind}{directions}")).unwrap_err().to_string();
        assert!(fault.starts_with("line ") && fault.contains(words), "{directions}: {fault}");
    }
    let twice =
        nrrd_text("kinds: 3D-symmetric-matrix space space space\nencoding: raw").unwrap_err().to_string();
    assert!(twice.contains("every field once") && twice.contains("encoding"), "{twice}");
}

/// Seven gradients are not a mask and six components.
#[test]
fn nrrd_of_diffusion_weighted_images_is_refused() {
    for key in ["modality:=DWMRI", "DWMRI_gradient_0000:=1 0 0"] {
        let fault = nrrd_text(&format!("kinds: list domain domain domain\n{key}")).unwrap_err();
        assert!(matches!(fault, IoError::Nrrd(NrrdError::Weighted { .. })), "{fault}");
        assert!(nrrd_text(&format!("kinds: 3D-symmetric-matrix domain domain domain\n{key}")).is_ok());
    }
}

#[test]
fn nrrd_labels_name_components() {
    let labels = "kinds: list domain domain domain\nlabels: \"XX;XY;XZ;YY;YZ;ZZ\" \"x\" \"y\" \"z\"";
    let lattice = nrrd_text(labels).unwrap();
    assert_eq!(lattice.order, Some((TensorOrder::UPPER, Known::Stated)));
    let other = nrrd_text(&labels.replace("XX;XY;XZ;YY;YZ;ZZ", "xx yy zz xy yz xz")).unwrap();
    assert_eq!(other.order, Some((TensorOrder::VTK, Known::Stated)));
    for kind in ["list", "vector", "???"] {
        let lattice = nrrd_text(&format!("kinds: {kind} domain domain domain")).unwrap();
        assert_eq!(lattice.order, Some((TensorOrder::UPPER, Known::Assumed)), "{kind}: as ITK writes");
    }
}

#[test]
fn nrrd_axes_may_be_given_by_their_ranges() {
    let head = |more: &str| {
        let text = format!(
            "NRRD0004\ntype: float\ndimension: 3\nsizes: 6 3 2\nkinds: 3D-symmetric-matrix domain domain\nencoding: ascii\n\
             axis mins: nan 1 10\naxis maxs: nan 4 14\n{more}\n\n{}",
            "1 0 0 1 0 1 ".repeat(6)
        );
        let lattice = nrrd::read(text.as_bytes(), None).unwrap();
        ((lattice.axes[0][0], lattice.axes[1][1], lattice.origin), lattice.remarks)
    };
    let (node, cell) = ((1.5, 4.0, [1.0, 10.0, 0.0]), (1.0, 2.0, [1.5, 11.0, 0.0]));
    assert_eq!(head("centerings: ??? node node"), (node, vec![]));
    assert_eq!(head("centerings: ??? cell cell"), (cell, vec![]));
    // Spacings tell, too.
    assert_eq!(head("spacings: nan 1.5 4"), (node, vec![]));
    assert_eq!(head("spacings: nan 1 2"), (cell, vec![]));
    let (at, remarks) = head("content: field");
    assert_eq!(at, cell);
    assert!(
        remarks.len() == 1 && remarks[0].contains("of axis 2, 3 are taken as the outer borders"),
        "{remarks:?}"
    );
}
