//! What headers of NIfTI files say of positions, frames and components.

use crate::conventions::image;
use std::io::Write as _;
use tigereye_core::{Svd, Tensor2};
use tigereye_io::volume::{Frame, Known, Lattice, Plane, PlaneChoice, Reading, World, lattice_from_image};
use tigereye_io::{ScalarType, Wanted, nifti};

/// A size has no sign, and half a scaling is none.
#[test]
fn sizes_and_scalings_of_nifti_are_taken_as_nibabel_takes_them() {
    let mut file = nifti_voxel(RAS, [3, 1, 1, 1, 1, 1, 1, 1], 0, &[5.0], None);
    file[254..256].copy_from_slice(&0_i16.to_le_bytes());
    file[84..88].copy_from_slice(&(-3_f32).to_le_bytes());
    assert_eq!(nifti::read(&file).unwrap().spacing(), [2.0, 3.0, 2.0]);
    let mut scaled = |slope: f32, intercept: f32| {
        file[112..116].copy_from_slice(&slope.to_le_bytes());
        file[116..120].copy_from_slice(&intercept.to_le_bytes());
        nifti::read(&file).map(|l| l.values[0]).map_err(|e| e.to_string())
    };
    assert_eq!((scaled(2.0, 1.0), scaled(f32::NAN, f32::NAN)), (Ok(11.0), Ok(5.0)));
    let fault = scaled(2.0, f32::NAN).unwrap_err();
    assert!(fault.contains("byte 116: NIfTI field scl_inter: found NaN"), "{fault}");
}

/// NIfTI of one voxel with the affine of the sform, and another qform where asked.
fn nifti_voxel(
    affine: [[f32; 4]; 3],
    shape: [i16; 8],
    intent: i16,
    values: &[f64],
    qform: Option<[f32; 3]>,
) -> Vec<u8> {
    let mut head = vec![0_u8; 352];
    let mut put = |at: usize, bytes: &[u8]| head[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, &348_i32.to_le_bytes());
    shape.iter().enumerate().for_each(|(i, n)| put(40 + 2 * i, &n.to_le_bytes()));
    put(68, &intent.to_le_bytes());
    put(70, &64_i16.to_le_bytes());
    put(72, &64_i16.to_le_bytes());
    [1.0_f32, 2.0, 2.0, 2.0].iter().enumerate().for_each(|(i, v)| put(76 + 4 * i, &v.to_le_bytes()));
    put(108, &352_f32.to_le_bytes());
    put(254, &1_i16.to_le_bytes());
    affine.iter().flatten().enumerate().for_each(|(i, v)| put(280 + 4 * i, &v.to_le_bytes()));
    if let Some(offset) = qform {
        put(252, &1_i16.to_le_bytes());
        offset.iter().enumerate().for_each(|(i, v)| put(268 + 4 * i, &v.to_le_bytes()));
    }
    put(344, b"n+1\0");
    head.write_all(&ScalarType::Float64.encode(values)).unwrap();
    head
}

const RAS: [[f32; 4]; 3] = [[2.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0]];
const LAS: [[f32; 4]; 3] = [[-2.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0]];

/// Method 1 of the standard: voxels at their sizes times their indices, neither mirrored (nibabel) nor along ITK's
/// axes. No world is stated.
#[test]
fn files_without_a_position_lie_as_the_standard_says() {
    let mut file = nifti_voxel(RAS, [4, 1, 1, 1, 6, 1, 1, 1], 0, &[1.0, 0.5, 0.0, 2.0, 0.0, 3.0], None);
    file[254..256].copy_from_slice(&0_i16.to_le_bytes());
    let lattice = nifti::read(&file).unwrap();
    let sizes = [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
    assert_eq!((lattice.axes, lattice.origin), (sizes, [0.0; 3]));
    assert_eq!(lattice.world, World::Scanner("not stated".to_owned()));
}

/// The angle of a tensor's major axis in the world, degrees from 0 to 180.
fn world_angle(lattice: Lattice, reading: Reading) -> f64 {
    let [xx, xy, _, _, yy, ..] = lattice.tensors(reading).unwrap().in_world().unwrap()[0];
    Svd::of(&Tensor2::symmetric(xx, xy, yy)).phi_rad().to_degrees().rem_euclid(180.0)
}

/// One fibre at 30 degrees in the world, fitted with FSL's gradient tables, is at 150 degrees in its axes for images of
/// either hand.
#[test]
fn fsl_tensors_are_along_its_gradient_tables() {
    let t = Tensor2::from_eigen(150.0_f64.to_radians(), 3.0, 1.0);
    let upper = [t.xx(), t.xy(), 0.0, t.yy(), 0.0, 1.0];
    let fsl = Reading { order: Some("fsl"), ..Reading::default() };
    for affine in [RAS, LAS] {
        let file = nifti_voxel(affine, [4, 1, 1, 1, 6, 1, 1, 1], 0, &upper, None);
        let lattice = nifti::read(&file).unwrap();
        assert_eq!(lattice.reverses_x_for_fsl(), affine == RAS);
        assert!((world_angle(lattice.clone(), fsl) - 30.0).abs() < 1e-9);
        let volume = lattice.clone().tensors(fsl).unwrap();
        assert_eq!(volume.frame(), (Frame::Fsl, Known::Convention));
        // The user's frame comes first, whatever the order.
        let voxel = Reading { frame: Some(Frame::Voxel), ..fsl };
        let along_voxels = if affine == RAS { 150.0 } else { 30.0 };
        assert!((world_angle(lattice, voxel) - along_voxels).abs() < 1e-9);
        // Written as FSL reads it, it is what FSL wrote.
        let back = nifti::read(&nifti::write(&volume, nifti::WrittenAs::Fsl, "").unwrap()).unwrap();
        assert!(back.values.iter().zip(upper).all(|(a, b)| (a - b).abs() < 1e-15), "{:?}", back.values);
        let mrtrix = nifti::read(&nifti::write(&volume, nifti::WrittenAs::Mrtrix, "").unwrap()).unwrap();
        assert!(
            (world_angle(mrtrix, Reading { order: Some("mrtrix"), ..Reading::default() }) - 30.0).abs()
                < 1e-9
        );
    }
    // A frame that the file states is not replaced by the program's.
    let lattice = lattice_from_image(&image("t", &upper, &[]), None, Wanted::Tensors).unwrap();
    assert_eq!(lattice.tensors(fsl).unwrap().frame().0, Frame::World);
}

#[test]
fn nifti_vectors_of_an_intent_are_along_the_world() {
    for intent in [1006, 1007] {
        let two = nifti_voxel(LAS, [5, 1, 1, 1, 1, 2, 1, 1], intent, &[1.0, 2.0], None);
        assert_eq!(nifti::read(&two).unwrap().frame.0, Frame::World);
    }
    for (intent, frame) in [(1007, Frame::World), (1006, Frame::World), (0, Frame::Voxel)] {
        let file = nifti_voxel(LAS, [5, 1, 1, 1, 1, 3, 1, 1], intent, &[1.0, 2.0, 3.0], None);
        assert_eq!(nifti::read(&file).unwrap().frame.0, frame, "intent {intent}");
    }
}

/// Colours, points and FSL's warps are no vectors along known axes; single numbers are numbers under any intent.
#[test]
fn nifti_intents_of_something_else_are_refused_by_name() {
    for (intent, name) in [
        (1008, "points"),
        (1009, "triangles"),
        (1010, "quaternions"),
        (2003, "RGB"),
        (2004, "RGBA"),
        (2006, "a warp of FNIRT"),
        (2007, "cubic spline of FNIRT"),
        (2009, "quadratic spline of FNIRT"),
        (2016, "TOPUP"),
    ] {
        for shape in [[5, 1, 1, 1, 1, 3, 1, 1], [4, 1, 1, 1, 3, 1, 1, 1]] {
            let fault = nifti::read(&nifti_voxel(RAS, shape, intent, &[1.0, 2.0, 3.0], None)).unwrap_err();
            let fault = fault.to_string();
            assert!(fault.starts_with("byte 68: NIfTI field intent_code") && fault.contains(name), "{fault}");
            assert_eq!(fault.contains("--frame fsl"), intent == 2006, "{fault}");
        }
        assert!(nifti::read(&nifti_voxel(RAS, [3, 1, 1, 1, 1, 1, 1, 1], intent, &[1.0], None)).is_ok());
    }
}

#[test]
fn transforms_that_disagree_are_said() {
    let file = |qform| nifti_voxel(RAS, [4, 1, 1, 1, 6, 1, 1, 1], 0, &[0.0; 6], qform);
    assert!(nifti::read(&file(None)).unwrap().warnings.is_empty());
    assert!(nifti::read(&file(Some([0.0; 3]))).unwrap().warnings.is_empty());
    let apart = nifti::read(&file(Some([0.0, 0.0, 5.0]))).unwrap().warnings;
    assert!(apart[0].contains("disagree by up to 5.000"), "{apart:?}");
}

/// Half turns come with parts of single precision, whose squares do not add up to 1.
#[test]
fn half_turns_of_quaternions_are_exact() {
    let half = (0.5_f32).sqrt();
    let mut file = nifti_voxel(RAS, [4, 1, 1, 1, 6, 1, 1, 1], 0, &[0.0; 6], Some([0.0; 3]));
    // No sform; half a turn about the diagonal of x and y swaps them and reverses z.
    file[254..256].copy_from_slice(&0_i16.to_le_bytes());
    for (i, part) in [half, half, 0.0].into_iter().enumerate() {
        file[256 + 4 * i..260 + 4 * i].copy_from_slice(&part.to_le_bytes());
    }
    let axes = nifti::read(&file).unwrap().axes;
    let expected = [[0.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]];
    for (found, expected) in axes.iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < 1e-7, "{axes:?}");
    }
}

/// ITK writes images of vectors as it has them in memory: left, posterior and superior.
#[test]
fn vectors_of_itk_are_read_along_its_axes() {
    let file = nifti_voxel(RAS, [5, 1, 1, 1, 1, 3, 1, 1], 1007, &[1.0, 2.0, 3.0], None);
    let lattice = nifti::read(&file).unwrap();
    let plane = PlaneChoice { plane: Some(Plane::Xy), slice: None };
    let shown = |frame| lattice.vectors(plane, frame).unwrap().field.values()[0];
    assert_eq!((shown(None), shown(Some(Frame::Lps))), ([1.0, 2.0], [-1.0, -2.0]));
}

/// FSL reverses nothing where nobody says how a volume lies.
#[test]
fn volumes_without_an_affine_are_not_reversed_for_fsl() {
    let mut file = nifti_voxel(RAS, [4, 1, 1, 1, 6, 1, 1, 1], 0, &[0.0; 6], None);
    assert!(nifti::read(&file).unwrap().reverses_x_for_fsl());
    file[254..256].copy_from_slice(&0_i16.to_le_bytes());
    assert!(!nifti::read(&file).unwrap().reverses_x_for_fsl());
}
