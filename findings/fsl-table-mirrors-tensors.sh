#!/usr/bin/env bash
# Believed: FSL's gradient directions (bvec) are along the voxel axes, so a tensor fitted with them, by dipy or by least squares of
#           one's own, is along the voxel axes, too.
# So:       in images whose voxel axes are right-handed (positive determinant of the affine, as in RAS) the table has x reversed, and the
#           fitted tensors are mirrored. In left-handed ones (LAS, the usual export from scanners) they are not.
# Matters:  FA and eigenvalues are right in both, and what was tried on a LAS file seems to work; directions are mirrored in the next
#           RAS file. MRtrix, which knows the rule, tells the fibre's true angle in both.
set -euo pipefail
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
# The libraries are those of the same release of Debian.
apt-get download -q mrtrix3=3.0.3-3+b1 libtiff6 libwebp7 libzstd1 liblzma5 liblerc4 libjbig0 libjpeg62-turbo libdeflate0 \
    libpng16-16 libgomp1 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in *.deb; do dpkg -x "$package" debian; done
export LD_LIBRARY_PATH="$place/debian/usr/lib/x86_64-linux-gnu"
export PATH="$place/debian/usr/lib/mrtrix3/bin:$place/debian/usr/bin:$PATH"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check dipy==1.12.1 nibabel==5.4.2 numpy==2.4.6
env/bin/python - <<'PY'
import subprocess
import sys
import warnings
import dipy
import nibabel
import numpy as np
from dipy.core.gradients import gradient_table
from dipy.io.gradients import read_bvals_bvecs
from dipy.reconst.dti import TensorModel

version = subprocess.run(["dwi2tensor", "--version"], capture_output=True, text=True, check=True).stdout.split("\n")[0]
print(version, "- dipy", dipy.__version__)
angle = np.radians(30)
fibre = np.array([np.cos(angle), np.sin(angle), 0.0])
tensor = 0.3e-3 * np.eye(3) + 1.4e-3 * np.outer(fibre, fibre)
directions = np.random.default_rng(0).normal(size=(30, 3))
directions /= np.linalg.norm(directions, axis=1, keepdims=True)
signal = np.r_[1000.0, 1000.0 * np.exp(-1000.0 * np.einsum("gi,ij,gj->g", directions, tensor, directions))]


def angle_of(matrix):
    """The fibre's angle in the plane of x and y, in degrees."""
    vector = np.linalg.eigh(matrix)[1][:, -1]
    return round(float(np.degrees(np.arctan2(vector[1], vector[0])) % 180), 1)


def angles(x_of_voxels):
    """The fibre's angle by dipy along the table's axes, taken for the voxel axes and led to the world; and by MRtrix."""
    affine = np.diag([x_of_voxels, 1.0, 1.0, 1.0])
    nibabel.save(nibabel.Nifti1Image(np.tile(signal.astype("f4"), (3, 3, 3, 1)), affine), "dwi.nii")
    # Along the voxel axes; FSL's rule reverses x where these are right-handed.
    table = directions * [x_of_voxels, 1, 1]
    table = table * [-1, 1, 1] if np.linalg.det(affine) > 0 else table
    np.savetxt("dwi.bvec", np.vstack([np.zeros(3), table]).T)
    np.savetxt("dwi.bval", np.r_[0, np.full(30, 1000)][None], fmt="%d")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        bvals, bvecs = read_bvals_bvecs("dwi.bval", "dwi.bvec")
        fit = TensorModel(gradient_table(bvals, bvecs=bvecs)).fit(nibabel.load("dwi.nii").get_fdata())
    axes = affine[:3, :3]
    taken = axes @ fit.quadratic_form[1, 1, 1] @ axes.T
    command = ["dwi2tensor", "-quiet", "-force", "-fslgrad", "dwi.bvec", "dwi.bval", "dwi.nii", "tensor.nii"]
    subprocess.run(command, check=True)
    xx, yy, zz, xy, xz, yz = np.asarray(nibabel.load("tensor.nii").dataobj)[1, 1, 1]
    return angle_of(taken), angle_of(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))


found = {"RAS": angles(1.0), "LAS": angles(-1.0)}
for name, (by_dipy, by_mrtrix) in found.items():
    print(f"{name}: a fibre at 30 degrees lies at {by_dipy} by dipy's tensor along the voxel axes, at {by_mrtrix} by MRtrix")
sys.exit(0 if found == {"RAS": (150.0, 30.0), "LAS": (30.0, 30.0)} else 1)
PY
