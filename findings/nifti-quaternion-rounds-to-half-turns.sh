#!/usr/bin/env bash
# Believed: a NIfTI header holds three of the four numbers of a unit quaternion, so the fourth is sqrt(1 - b^2 - c^2 - d^2).
# So:       the three are in single precision. Near half turns what is left under the root is their rounding, and readers
#           take the fourth as 0 where that is small; the plain formula gives a turn of its own.
# Matters:  a scan whose axes are swapped and reversed exactly comes out skewed by some 1e-4: it is oblique for software that asks,
#           the last voxel of two hundred lies a twentieth beside its place, and permuted axes are no longer recognised.
set -euo pipefail
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check nibabel==5.4.2 numpy==2.4.6
env/bin/python - <<'PY'
import sys
import nibabel
import numpy as np
from nibabel.quaternions import quat2mat

# x of the voxels runs along z, y against y, z along x: a half turn about an axis between x and z.
axes = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
affine = np.eye(4)
affine[:3, :3] = axes
image = nibabel.Nifti1Image(np.zeros((200, 200, 200), "u1"), None)
image.set_qform(affine, 1)
image.set_sform(None, 0)
nibabel.save(image, "turned.nii.gz")

header = nibabel.load("turned.nii.gz").header
b, c, d = (float(header[f"quatern_{k}"]) for k in "bcd")
left = 1.0 - (b * b + c * c + d * d)
plain = quat2mat([max(left, 0.0) ** 0.5, b, c, d])
read = header.get_qform()[:3, :3]
off = {"nibabel": np.abs(read - axes).max(), "the plain formula": np.abs(plain - axes).max()}
print("nibabel", nibabel.__version__, f"- b, c, d = {b}, {c}, {d}; left under the root: {left:.3g}")
for who, error in off.items():
    print(f"{who}: axes off by {error:.3g}, the last of 200 voxels by {199 * error:.3g} voxels")
sys.exit(0 if off["nibabel"] < 1e-6 and off["the plain formula"] > 1e-4 else 1)
PY
