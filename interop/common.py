"""What the checks share: the program, temporary folders, and the tensors they send around."""

import itertools
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

PROGRAM = os.environ["TIGEREYE"]
REPOSITORY = pathlib.Path(__file__).resolve().parent.parent

# Component names in the orders of six components, row by row of the full matrix.
ORDERS = {
    "vtk": [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)],
    "fsl": [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)],
    "dipy": [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)],
    "mrtrix": [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)],
}

# An affine with turned and permuted axes, as scanners have them; orthogonal up to the rounding of single precision.
_C, _S = np.cos(0.3), np.sin(0.3)
TURN = np.array([[0.0, -_C, _S], [-1.0, 0.0, 0.0], [0.0, _S, _C]])
SPACING = np.array([2.0, 1.5, 3.0])
ORIGIN = np.array([-20.0, 7.5, 30.0])


def tensors(shape, symmetric=True, seed=1):
    """Numbers that single precision holds exactly: tensors (..., 3, 3) of small multiples of 1/64."""
    numbers = np.random.default_rng(seed).integers(-200, 200, size=(*shape, 3, 3)) / 64.0
    return (numbers + numbers.swapaxes(-1, -2)) / 2.0 if symmetric else numbers


def slice_of(voxel, axis, index, directions):
    """The plane across a voxel axis of tensors along the voxel axes, as a picture of the world: (H, W, 2, 2), row 0 on top.

    Every voxel axis belongs to the world axis it is nearest to, all together; the lower one runs to the right, and axes that
    run against the world's are reversed. The directions are columns.
    """
    orders = itertools.permutations(range(3))
    world = max(orders, key=lambda order: sum(abs(directions[order[a], a]) for a in range(3)))
    normal = "xyz".index(axis)
    right, up = sorted((a for a in range(3) if a != normal), key=lambda a: world[a])
    signs = [1 if directions[world[a], a] > 0.0 else -1 for a in (right, up)]
    layer = np.take(voxel, index, axis=normal)
    if right > up:
        layer = layer.swapaxes(0, 1)
    layer = layer[..., [right, up], :][..., :, [right, up]] * np.outer(signs, signs)
    return layer[:: signs[0], :: signs[1]].transpose(1, 0, 2, 3)[::-1]


def six(full, order):
    """The components of symmetric tensors in an order, along the last axis."""
    return np.stack([full[..., i, j] for i, j in ORDERS[order]], axis=-1)


def full_tensors(components, order):
    """The inverse of `six`."""
    full = np.empty((*components.shape[:-1], 3, 3))
    for c, (i, j) in enumerate(ORDERS[order]):
        full[..., i, j] = full[..., j, i] = components[..., c]
    return full


def turned(full, matrix):
    """Components along other axes: M D M^T."""
    return np.einsum("ij,...jk,lk->...il", matrix, full, matrix)


class Checks(unittest.TestCase):
    """A check with a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tigereye-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def path(self, name):
        return str(self.folder / name)

    def run_program(self, *arguments, code=0):
        """Runs the program and returns what it printed."""
        done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder)
        words = f"tigereye {' '.join(map(str, arguments))}\n{done.stdout}{done.stderr}"
        self.assertEqual(done.returncode, code, words)
        return done.stdout if code == 0 else done.stderr

    def plane(self, file, *options):
        """The field that the program reads: (H, W, 2, 2), row 0 on top."""
        self.run_program("convert", file, "plane.npy", "--force", *options)
        return np.load(self.path("plane.npy"))

    def near(self, found, expected, tolerance, what):
        scale = max(np.abs(expected).max(), 1e-300)
        self.assertEqual(np.shape(found), np.shape(expected), what)
        worst = np.abs(np.asarray(found) - expected).max() / scale
        self.assertLessEqual(worst, tolerance, f"{what}: off by {worst:.3g} of the largest value")

    def story_of(self, text):
        """The provenance in a file's field data."""
        story = json.loads(text)
        self.assertEqual(set(story), {"version", "command", "parameters", "input_blake3"})
        return story


def sample_tensors():
    """dipy's sample, fitted: a file of symmetric matrices that belongs to the project."""
    return REPOSITORY / "data" / "small_64D_tensor.nii.gz"
