//! Formats that are not read, with the programs that convert them.

use crate::error::InputError;
use crate::formats::{format_of, readable_extensions};

/// Formats of tensors that are not read: their extensions, names, and what converts them.
const FOREIGN: &[(&[&str], &str, &str)] = &[
    (
        &["mif", "mih"],
        "MRtrix's image format",
        "`mrconvert IN.mif OUT.nii.gz` writes NIfTI (then --order mrtrix)",
    ),
    (&["mgz", "mgh"], "FreeSurfer's image format", "`mri_convert IN.mgz OUT.nii.gz` writes NIfTI"),
    (&["hdr", "img"], "ANALYZE or a NIfTI pair", "nibabel, or `fslchfiletype NIFTI_GZ`, writes one .nii.gz"),
    (&["dcm"], "DICOM", "dcm2niix writes the measurement as NIfTI, to which tensors are then fitted"),
    (&["mnc"], "MINC", "`mnc2nii` writes NIfTI"),
    (&["mha", "mhd"], "MetaImage", "ITK (SimpleITK.WriteImage) or 3D Slicer writes .nrrd or .nii.gz"),
    (
        &["xdmf", "xmf", "h5", "hdf5"],
        "XDMF or HDF5",
        "ParaView's Resample To Image, saved as .vti, reads it; h5py and numpy.save write an array as .npy",
    ),
    (&["exo", "e", "ex2", "exoii"], "Exodus II", "ParaView's Resample To Image, saved as .vti, reads it"),
    (
        &["odb"],
        "Abaqus's result format",
        "a script in Abaqus Python writes the stresses; save them as .npy or .vti",
    ),
    (
        &[
            "vtu", "vtr", "vts", "pvtu", "pvti", "vtm", "vtmb", "vthb", "vtkhdf", "frd", "msh", "inp",
            "cgns", "med", "case", "rst", "bdf",
        ],
        "a mesh or a collection",
        "ParaView's Resample To Image, saved as .vti, puts it on a lattice (for .frd, ccx2paraview first)",
    ),
    (&["mat"], "MATLAB's format", "scipy.io.loadmat and numpy.save write an array as .npy"),
    (
        &["tif", "tiff", "jpg", "jpeg", "bmp"],
        "a picture",
        "any picture program saves it as .png, turned as it shows it",
    ),
    (&["pkl", "nc", "zarr", "parquet"], "an array store", "numpy.save writes an array as .npy"),
];

/// What is wrong with a name whose extension is not read.
pub(crate) fn unreadable(name: &str) -> InputError {
    let unpacked = name.strip_suffix(".gz").unwrap_or(name);
    let extension = format_of(unpacked);
    let known = FOREIGN.iter().find(|(extensions, _, _)| extensions.contains(&extension.as_str()));
    match known {
        Some(&(_, format, help)) => InputError::Foreign { format, help },
        None => InputError::Extension { expected: readable_extensions() },
    }
}
