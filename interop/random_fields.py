"""Random tensor fields for the readers' property tests, and what is right about each of them.

A writer makes a file in some layout, order, frame and precision and says where which tensor lies: a `Written` holds the
lattice in the file's world and the tensors along that world's axes. From these follow, without the program, every whole
volume (tensors by world position) and every plane (`Picture`). A case is its number: `RANDOM_SEED=S RANDOM_CASE=N
interop/run -k NAME` runs one alone; `RANDOM_CASES=N` says how many a writer gets.
"""

import concurrent.futures
import dataclasses
import itertools
import os
import pathlib
import subprocess
import tempfile
import unittest
import zlib

import numpy as np
from common import PROGRAM, tensors, turned
from read_back import OUTPUTS, read_vti
from scipy.spatial import cKDTree

SEED = int(os.environ.get("RANDOM_SEED", "1"))
ONLY = os.environ.get("RANDOM_CASE")
CASES = os.environ.get("RANDOM_CASES")
# Two processes at a time: what the smallest machines have.
WORKERS = 2
# Names of failed cases that are printed in full.
SHOWN = 8
# Largest distance of a position from the right one, relative to the smallest step: headers hold six digits or float32.
PLACE = 1e-3
# Largest error of a tensor, relative to the field's largest component: directions in float32, some hundred roundings.
SINGLE = 1e-5
# The same where directions follow from positions in text of six digits.
TEXT = 2e-4
# Sums of cosines that differ by less are equal, so that rounding decides nothing.
TIE = 1e-6


@dataclasses.dataclass
class Lattice:
    """Voxels in a world: sizes, the position of the first, and one column a step along each voxel axis."""

    size: tuple
    origin: np.ndarray
    axes: np.ndarray

    def positions(self):
        """(nx, ny, nz, 3)"""
        return self.origin + np.moveaxis(np.indices(self.size), 0, -1) @ self.axes.T

    def spacing(self):
        return np.linalg.norm(self.axes, axis=0)

    def directions(self):
        return self.axes / self.spacing()

    def affine(self):
        affine = np.eye(4)
        affine[:3, :3], affine[:3, 3] = self.axes, self.origin
        return affine

    def mirrored(self, signs):
        """The same lattice in a world some of whose axes point the other way."""
        return Lattice(self.size, np.asarray(signs) * self.origin, np.diag(signs) @ self.axes)


@dataclasses.dataclass
class Written:
    """A file, how to read it, and what it holds: `world` is (nx, ny, nz, 3, 3), along the axes of the file's world."""

    file: str
    lattice: Lattice
    world: np.ndarray
    words: list
    options: list = dataclasses.field(default_factory=list)
    # Where something was measured; elsewhere there are zero tensors.
    kept: np.ndarray = None
    # What leads from the file's world to the right, anterior and superior; that of viewers stays as it is.
    signs: tuple = (1.0, 1.0, 1.0)
    tolerance: float = SINGLE
    # Whether the file's own axes are known, so that a plane can be chosen by them.
    has_axes: bool = True

    def tensors(self):
        return self.world if self.kept is None else np.where(self.kept[..., None, None], self.world, 0.0)

    def permuted(self, order):
        """The same field with its voxel axes in another order."""
        place = Lattice(tuple(self.lattice.size[a] for a in order), self.lattice.origin, self.lattice.axes[:, order])
        kept = None if self.kept is None else self.kept.transpose(order)
        return dataclasses.replace(self, lattice=place, world=self.world.transpose(*order, 3, 4), kept=kept)

    def taken(self, index):
        """A part of the field: one slice a voxel axis, with the step 1 or -1."""
        starts = [range(n)[i][0] for n, i in zip(self.lattice.size, index, strict=True)]
        world = self.world[tuple(index)]
        origin = self.lattice.origin + self.lattice.axes @ starts
        place = Lattice(world.shape[:3], origin, self.lattice.axes * [i.step or 1 for i in index])
        kept = None if self.kept is None else self.kept[tuple(index)]
        return dataclasses.replace(self, lattice=place, world=world, kept=kept)

    def in_patient(self):
        """Lattice and tensors in the world to the right, anterior and superior."""
        return self.lattice.mirrored(self.signs), turned(self.tensors(), np.diag(self.signs))


@dataclasses.dataclass
class Picture:
    """A plane as it is to be shown: `field` is (H, W, 2, 2), row 0 on top; `corner` is the lower left cell."""

    field: np.ndarray
    corner: np.ndarray
    right: np.ndarray
    up: np.ndarray
    spacing: tuple


def world_axes_of(directions):
    """For each voxel axis the world axis that is its own: together they fit best, and rounding decides nothing."""
    best, chosen = -1.0, None
    for order in itertools.permutations(range(3)):
        fit = sum(abs(directions[world, voxel]) for voxel, world in enumerate(order))
        if fit > best + TIE:
            best, chosen = fit, order
    return chosen


def picture(written, axis, index):
    """The plane across voxel axis `axis` (0 to 2): laid out by the world, x before y before z, to the right and up."""
    lattice = written.lattice
    directions = lattice.directions()
    order = world_axes_of(directions)
    right, up = sorted((a for a in range(3) if a != axis), key=lambda a: order[a])
    signs = [1.0 if directions[order[a], a] >= 0.0 else -1.0 for a in (right, up)]
    # (W, H, ...), both axes along the world's.
    layer = [np.take(v, index, axis=axis) for v in (written.tensors(), lattice.positions())]
    layer = [v if right < up else v.swapaxes(0, 1) for v in layer]
    layer = [v[:: int(signs[0]), :: int(signs[1])] for v in layer]
    units = np.stack([signs[0] * directions[:, right], signs[1] * directions[:, up]])
    field = np.einsum("ai,whij,bj->whab", units, layer[0], units).transpose(1, 0, 2, 3)[::-1]
    spacing = lattice.spacing()
    return Picture(field, layer[1][0, 0], units[0], units[1], (spacing[right], spacing[up]))


def turn(generator, kind):
    """A matrix of orthonormal axes: `upright`, one of the 48 `signed` permutations, or any (`oblique`)."""
    if kind == "upright":
        return np.eye(3)
    if kind == "signed":
        return np.eye(3)[generator.permutation(3)] * generator.choice([-1.0, 1.0], 3)
    return np.linalg.qr(generator.normal(size=(3, 3)))[0]


def lattice(generator, kinds=("upright", "signed", "signed", "oblique"), least=2):
    """Sizes that differ, sides that differ, axes of either hand."""
    size = tuple(int(n) for n in generator.permutation([2, 3, 4, 5])[:3])
    size = tuple(max(n, least) for n in size)
    kind = str(generator.choice(kinds))
    # Eighths: exact in text and in single precision.
    origin = generator.integers(-160, 160, 3) / 8.0
    axes = turn(generator, kind) * (generator.integers(6, 25, 3) / 8.0)
    return Lattice(size, origin, axes), kind


def random_tensors(generator, size, symmetric):
    """Multiples of 1/64, every voxel another: a transposed, reversed or shifted field shows."""
    return tensors(size, symmetric, seed=int(generator.integers(1 << 30)))


def nearest(positions, sought, step):
    """For every sought position the number of the one that lies there, each once."""
    distance, found = cKDTree(np.reshape(positions, (-1, 3))).query(np.reshape(sought, (-1, 3)))
    if distance.max() > PLACE * step:
        worst = np.reshape(sought, (-1, 3))[distance.argmax()]
        raise AssertionError(f"something lies at {worst}, {distance.max() / step:.3g} steps from any right position")
    if len(set(found)) != len(found) or len(found) != np.reshape(positions, (-1, 3)).shape[0]:
        raise AssertionError("positions are missing or there twice")
    return found


def compare(found, expected, tolerance, what):
    """Raises where numbers differ by more than `tolerance` times the largest expected one."""
    if np.shape(found) != np.shape(expected):
        raise AssertionError(f"{what}: shape {np.shape(found)}, expected {np.shape(expected)}")
    off = np.abs(np.asarray(found, dtype=float) - expected)
    # Also where the difference is no number.
    if not off.max() <= tolerance * max(np.abs(expected).max(), 1e-300):
        at = np.unravel_index(np.argmax(np.where(np.isnan(off), np.inf, off)), off.shape)
        cell = at[:-2]
        raise AssertionError(
            f"{what}: in {tuple(map(int, cell))} {np.round(found[cell], 4).tolist()}, "
            f"expected {np.round(expected[cell], 4).tolist()}"
        )


def compare_places(positions, found, lattice_, expected, tolerance, what):
    """Compares tensors by where they lie in the world."""
    step = lattice_.spacing().min()
    at = nearest(lattice_.positions(), positions, step)
    compare(np.reshape(found, (-1, 3, 3)), np.reshape(expected, (-1, 3, 3))[at], tolerance, what)


def run_program(folder, *arguments):
    """Runs tigereye; raises what it said where it refuses."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=folder)
    if done.returncode != 0:
        said = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[0]
        raise AssertionError(f"tigereye {' '.join(map(str, arguments))}\n        {said}")
    return done


def run_other(folder, *arguments):
    """Runs another program; raises what it said where it fails."""
    done = subprocess.run([*map(str, arguments)], capture_output=True, text=True, cwd=folder)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, arguments))}\n    {done.stderr.strip()}")
    return done.stdout


class RandomChecks(unittest.TestCase):
    """A test is a writer and the number of its cases."""

    def cases(self, name, count, one):
        """Runs `one(generator, folder)`, which returns nothing and raises what is wrong, for every case of a writer."""
        if ONLY is not None:
            numbers = [int(ONLY)]
        else:
            numbers = range(int(CASES) if CASES else count)

        def run(number):
            generator = np.random.default_rng([SEED, zlib.crc32(name.encode()), number])
            with tempfile.TemporaryDirectory(prefix="tigereye-") as folder:
                words = []
                try:
                    one(generator, pathlib.Path(folder), words)
                except AssertionError as wrong:
                    return number, words, str(wrong)
            return None

        with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
            failed = [f for f in pool.map(run, numbers) if f]
        lines = [
            f"case {number} ({', '.join(words)})\n    {wrong}\n"
            f"    alone: RANDOM_SEED={SEED} RANDOM_CASE={number} interop/run -k {self._testMethodName}"
            for number, words, wrong in failed[:SHOWN]
        ]
        if failed:
            self.fail(f"{len(failed)} of {len(numbers)} cases of {name}:\n" + "\n".join(lines))

    def readings(self, name, count, write):
        """Reads what `write(generator, folder)` wrote, whole and one plane of it, and compares."""

        def one(generator, folder, words):
            written = write(generator, folder)
            words.extend([written.file, *written.words])
            faults = []
            for check in (whole_volume, plane, plane_as_image):
                try:
                    check(generator, folder, written)
                except AssertionError as wrong:
                    faults.append(str(wrong))
            if faults:
                raise AssertionError("\n    ".join(faults))

        self.cases(name, count, one)


def whole_volume(generator, folder, written):
    """`convert IN OUT` against the oracle, read by a program that OUT is for."""
    ending, read = OUTPUTS[int(generator.integers(len(OUTPUTS)))]
    out = f"whole.{ending}"
    run_program(folder, "convert", written.file, out, *written.options)
    positions, found, in_patient = read(folder / out)
    if in_patient:
        lattice_, expected = written.in_patient()
    else:
        lattice_, expected = written.lattice, written.tensors()
    what = f"whole as {out} by {read.__name__}"
    compare_places(positions, found, lattice_, expected, written.tolerance, what)


def chosen_plane(generator, written):
    """A voxel axis, an index along it, and the options that choose them."""
    size = written.lattice.size
    axis = size.index(1) if 1 in size else int(generator.integers(3))
    index = int(generator.integers(size[axis]))
    # A plane of one layer needs no choice.
    return axis, index, [] if 1 in size else ["--slice", f"{'xyz'[axis]}={index}"]


def shows_plane(folder, out, written, shown, chosen):
    """Whether a plane was written; tensors without components in it are refused, and then the oracle has zeros there."""
    try:
        run_program(folder, "convert", written.file, out, *written.options, *chosen)
    except AssertionError as refused:
        # Affines in single precision leave their rounding.
        largest = np.abs(shown.field).max()
        vanishing = any(np.abs(shown.field[..., i, i]).max() <= 1e-5 * largest for i in range(2))
        if "and the plane shows" in str(refused) and vanishing:
            return False
        raise
    return True


def plane(generator, folder, written):
    """`convert IN plane.npy --slice AXIS=INDEX` against the oracle."""
    if not written.has_axes:
        return
    axis, index, chosen = chosen_plane(generator, written)
    shown = picture(written, axis, index)
    if not shows_plane(folder, "plane.npy", written, shown, chosen):
        return
    right = shown.field
    compare(np.load(folder / "plane.npy"), right, written.tolerance, f"plane {' '.join(chosen)}")


def plane_as_image(generator, folder, written):
    """Of some planes, where they lie: in the world where they show its x and y, else along axes of their own."""
    if not written.has_axes or generator.random() > 0.3:
        return
    axis, index, _ = chosen_plane(generator, written)
    # A file of one layer is written whole where nobody chooses its plane.
    chosen = ["--slice", f"{'xyz'[axis]}={index}"]
    shown = picture(written, axis, index)
    if not shows_plane(folder, "plane.vti", written, shown, chosen):
        return
    positions, found, _ = read_vti(folder / "plane.vti")
    upright = np.allclose([shown.right, shown.up], np.eye(3)[:2], rtol=0.0, atol=TIE)
    corner = shown.corner if upright else np.array([shown.corner @ shown.right, shown.corner @ shown.up, 0.0])
    height, width = shown.field.shape[:2]
    place = Lattice((width, height, 1), corner, np.diag([*shown.spacing, 1.0]))
    full = np.zeros((width, height, 1, 3, 3))
    full[:, :, 0, :2, :2] = shown.field[::-1].transpose(1, 0, 2, 3)
    what = f"plane {' '.join(chosen)} as image data"
    compare_places(positions, found, place, full, written.tolerance, what)
