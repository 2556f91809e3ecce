//! What is done with everything that was read.

use tigereye_io::volume::{Axis, Frame, Lattice, PlaneChoice, Reading, image_from_volume, points_from_image};
use tigereye_io::{Limits, legacy, nifti, nrrd, vti, vtp};

/// Small enough for many tries a second.
#[allow(dead_code)]
pub const LIMITS: Limits = Limits { cells: 1 << 16, values: 1 << 20 };

/// Slices, descriptions and every writer.
pub fn use_everything(lattice: Lattice) {
    let choice = PlaneChoice { plane: None, slice: Some((Axis::Z, 0)) };
    let _ = (lattice.scalars(choice), lattice.vectors(choice, None), lattice.story());
    let Ok(volume) = lattice.tensors(Reading::default()) else { return };
    let _ = (volume.slice(choice), volume.story(), volume.suspicion());
    for frame in [Frame::World, Frame::Voxel] {
        if let Ok(image) = image_from_volume(&volume, frame) {
            let _ = (vti::write(&image), legacy::write(&image, ""));
            let _ = vtp::write(&points_from_image(image));
        }
    }
    let _ = (nrrd::write(&volume, Frame::World, ""), nifti::write(&volume, nifti::WrittenAs::Matrices, ""));
}
