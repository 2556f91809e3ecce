#!/usr/bin/env bash
# Believed: a NIfTI file with neither qform nor sform lies where the standard's method 1 puts it: voxel (i, j, k) at its voxel
#           sizes times (i, j, k), x to the right, y anterior. At worst readers differ in the origin.
# So:       nibabel mirrors x (an Analyze file's default) and puts the origin into the middle; ITK takes the axes along those of
#           its own world, whose x runs to the left and y to the back. Neither is the standard's, and they differ in y.
# Matters:  tensors and vectors along the world's axes change the signs of their mixed components with the reader. A file that
#           states no position has no world, so components are safe along its voxel axes alone.
set -euo pipefail
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check nibabel==5.4.2 numpy==2.4.6 SimpleITK==2.5.7
env/bin/python - <<'PY'
import sys
import nibabel
import numpy as np
import SimpleITK

image = nibabel.Nifti1Image(np.zeros((4, 3, 2), "f4"), None)
image.header.set_zooms((1.5, 1.0, 2.0))
image.set_qform(None, 0)
image.set_sform(None, 0)
nibabel.save(image, "plain.nii")

standard = np.diag([1.5, 1.0, 2.0, 1.0])
by_nibabel = nibabel.load("plain.nii").affine
read = SimpleITK.ReadImage("plain.nii")
# From ITK's world (left, posterior, superior) to that of NIfTI.
by_itk = np.eye(4)
by_itk[:3, :3] = np.reshape(read.GetDirection(), (3, 3)) * read.GetSpacing()
by_itk[:3, 3] = read.GetOrigin()
by_itk = np.diag([-1.0, -1.0, 1.0, 1.0]) @ by_itk
print("nibabel", nibabel.__version__, "- SimpleITK", SimpleITK.Version_VersionString())
for who, affine in (("the standard's method 1", standard), ("nibabel", by_nibabel), ("ITK", by_itk)):
    print(f"{who}: signs of x, y, z {np.sign(np.diag(affine)[:3]).astype(int)}, first voxel at {affine[:3, 3] + 0.0}")
as_believed = np.array_equal(by_nibabel[:3, :3], standard[:3, :3]) or np.array_equal(by_itk, standard)
signs = [np.sign(np.diag(a)[:3]).tolist() for a in (by_nibabel, by_itk)]
sys.exit(0 if not as_believed and signs == [[-1, 1, 1], [-1, -1, 1]] else 1)
PY
