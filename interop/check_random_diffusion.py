"""Diffusion tensors from measurements whose fibres are known: fitted by dipy, by MRtrix and as FSL does, then read.

MRtrix knows both conventions, so it is the judge: what it says along the scanner's axes must be what tigereye says, with
`--order mrtrix` of its own tensors and with FSL's axes of tensors that were fitted with FSL's gradient tables.
"""

import functools
import shutil
import unittest

import nibabel
import numpy as np
from check_random_volumes import fsl_axes
from dipy.core.gradients import gradient_table
from dipy.io.gradients import read_bvals_bvecs
from dipy.reconst.dti import TensorModel, lower_triangular
from random_fields import Lattice, RandomChecks, Written, lattice, nearest, run_other, run_program, turn

# Measured directions and their weighting, in s/mm^2, and the measurements without weighting.
DIRECTIONS, WEIGHTING, PLAIN = 30, 1000.0, 3
# A fit to signals in single precision, relative to the largest diffusivity.
FIT = 2e-3
# The same as an angle of an axis, in degrees.
DEGREES = 0.1
MRTRIX = shutil.which("dwi2tensor") and shutil.which("mrconvert")


def measure(generator, folder, place, world):
    """Signals without noise of tensors along the world's axes: dwi.nii, with the table as FSL's bval and bvec files."""
    directions = generator.normal(size=(PLAIN + DIRECTIONS, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    weighting = np.full(len(directions), WEIGHTING)
    weighting[:PLAIN] = 0.0
    exponent = np.einsum("gi,xyzij,gj->xyzg", directions, world, directions)
    signal = (1000.0 * np.exp(-weighting * exponent)).astype("f4")
    nibabel.save(nibabel.Nifti1Image(signal, place.affine()), folder / "dwi.nii")
    table = directions @ fsl_axes(place.directions())
    table[:PLAIN] = 0.0
    np.savetxt(folder / "dwi.bvec", table.T, fmt="%.9f")
    np.savetxt(folder / "dwi.bval", weighting[None], fmt="%g")


def phantom(generator, size):
    """Positive tensors of the size of diffusivities in mm^2/s, every voxel another."""
    axes = np.array([turn(generator, "oblique") for _ in range(int(np.prod(size)))]).reshape(*size, 3, 3)
    values = generator.uniform(0.2e-3, 2.0e-3, (*size, 3))
    return np.einsum("...ij,...j,...kj->...ik", axes, values, axes)


def fitted_like_dtifit(folder):
    """Least squares on the logarithm with the table as it stands, saved as `dtifit --save_tensor` does."""
    dwi = nibabel.load(folder / "dwi.nii")
    g, b = np.loadtxt(folder / "dwi.bvec").T, np.loadtxt(folder / "dwi.bval")
    rows = [g[:, i] * g[:, j] * (1.0 if i == j else 2.0) for i in range(3) for j in range(i, 3)]
    design = np.column_stack([*(-b * r for r in rows), np.ones_like(b)])
    logs = np.log(dwi.get_fdata()).reshape(-1, len(b))
    found = np.linalg.lstsq(design, logs.T, rcond=None)[0][:6].T.reshape(*dwi.shape[:3], 6)
    nibabel.save(nibabel.Nifti1Image(found.astype("f4"), dwi.affine), folder / "fsl.nii")
    return "fsl.nii", ["--order", "fsl"]


def fitted_by_dipy(folder):
    """The README's recipe."""
    dwi = nibabel.load(folder / "dwi.nii")
    bvals, bvecs = read_bvals_bvecs(str(folder / "dwi.bval"), str(folder / "dwi.bvec"))
    fit = TensorModel(gradient_table(bvals, bvecs=bvecs)).fit(dwi.get_fdata())
    tensors = lower_triangular(fit.quadratic_form).astype("float32")
    nibabel.save(nibabel.Nifti1Image(tensors, dwi.affine), folder / "dipy.nii.gz")
    return "dipy.nii.gz", ["--order", "dipy", "--frame", "fsl"]


def fitted_by_mrtrix(folder, strides=None):
    quiet = ["-quiet", "-nthreads", "0"]
    gradients = ["-fslgrad", "dwi.bvec", "dwi.bval"]
    run_other(folder, "dwi2tensor", *quiet, *gradients, "dwi.nii", "mrtrix.nii")
    if strides is None:
        return "mrtrix.nii", ["--order", "mrtrix"]
    run_other(folder, "mrconvert", *quiet, "-strides", strides, "mrtrix.nii", "strided.nii")
    return "strided.nii", ["--order", "mrtrix"]


def found_again(folder, file, options, place, world, words):
    """The field by the voxels of a file that another program wrote: tensors follow their places."""
    image = nibabel.load(folder / file)
    there = Lattice(image.shape[:3], image.affine[:3, 3], image.affine[:3, :3])
    at = nearest(place.positions(), there.positions(), place.spacing().min())
    moved = world.reshape(-1, 3, 3)[at].reshape(*there.size, 3, 3)
    return Written(file, there, moved, words, options, tolerance=FIT)


class RandomDiffusion(RandomChecks):
    def measured(self, name, count, fit):
        def write(generator, folder):
            place, kind = lattice(generator, ("upright", "signed", "signed", "oblique"))
            world = phantom(generator, place.size)
            measure(generator, folder, place, world)
            file, options, *words = fit(generator, folder)
            return found_again(folder, file, options, place, world, [kind, *words])

        self.readings(name, count, write)

    def test_random_measurements_fitted_by_dipy(self):
        self.measured("dipy", 25, lambda _, folder: fitted_by_dipy(folder))

    def test_random_measurements_fitted_like_dtifit(self):
        self.measured("dtifit", 25, lambda _, folder: fitted_like_dtifit(folder))

    @unittest.skipUnless(MRTRIX, "MRtrix is not installed")
    def test_random_measurements_fitted_by_mrtrix(self):
        def fit(generator, folder):
            order, signs = generator.permutation(3) + 1, generator.choice([-1, 1], 3)
            strides = ",".join(str(int(s * o)) for s, o in zip(signs, order, strict=True)) + ",4"
            return (*fitted_by_mrtrix(folder, strides), f"strides {strides}")

        self.measured("MRtrix", 20, fit)


class Judged(RandomChecks):
    @unittest.skipUnless(MRTRIX, "MRtrix is not installed")
    def test_a_fibre_at_30_degrees_is_one_for_all_programs(self):
        """In files whose x runs to the right (RAS) and to the left (LAS)."""
        angle = np.deg2rad(30.0)
        fibre = np.array([np.cos(angle), np.sin(angle), 0.0])
        tensor = 0.3e-3 * np.eye(3) + 1.4e-3 * np.outer(fibre, fibre)

        def one(generator, folder, _, sign):
            place = Lattice((5, 4, 3), np.zeros(3), np.diag([2.0 * sign, 2.0, 2.0]))
            measure(generator, folder, place, np.broadcast_to(tensor, (*place.size, 3, 3)))
            files = [fitted_by_mrtrix(folder), fitted_like_dtifit(folder), fitted_by_dipy(folder)]
            # MRtrix's own word: along the scanner's axes.
            run_other(folder, "tensor2metric", "-quiet", "-vector", "v1.nii", "-modulate", "none", "mrtrix.nii")
            v1 = np.asarray(nibabel.load(folder / "v1.nii").dataobj)[2, 2, 1]
            said = {"MRtrix itself": np.rad2deg(np.arctan2(v1[1], v1[0])) % 180.0}
            for file, options in files:
                out = f"{file}.npy"
                run_program(folder, "convert", file, out, *options, "--slice", "z=1")
                xx, xy, _, yy = np.load(folder / out)[2, 2].ravel()
                said[file] = np.rad2deg(0.5 * np.arctan2(2.0 * xy, xx - yy)) % 180.0
            wrong = {file: round(float(degrees), 2) for file, degrees in said.items() if abs(degrees - 30.0) > DEGREES}
            if wrong:
                raise AssertionError(f"the fibre lies at 30 degrees, but {wrong}")

        for name, sign in [("RAS", 1.0), ("LAS", -1.0)]:
            with self.subTest(name):
                self.cases(f"a fibre in {name}", 1, functools.partial(one, sign=sign))
