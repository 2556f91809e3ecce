"""What NIfTI and NRRD files may say that the plain ones do not, and dipy's measures for tensors of every shape."""

import itertools
import os
import pathlib
import warnings

import nibabel
import nrrd
import numpy as np
import vtk
from common import (
    ORIGIN,
    REPOSITORY,
    SPACING,
    TURN,
    Checks,
    full_tensors,
    sample_tensors,
    six,
    slice_of,
    tensors,
    turned,
)
from dipy.core.gradients import gradient_table
from dipy.data import get_fnames
from dipy.reconst import dti
from vtk.util.numpy_support import vtk_to_numpy

SHAPE = (4, 5, 3)
SLICES = [("x", 2), ("y", 4), ("z", 1)]
AFFINE = np.eye(4)
AFFINE[:3, :3], AFFINE[:3, 3] = TURN * SPACING, ORIGIN
# The first axis reversed: what the qform keeps in the sign of its first voxel size.
MIRRORED = AFFINE @ np.diag([-1.0, 1.0, 1.0, 1.0])
# Below this anisotropy double precision cannot tell the mode to 1e-6: it is off by about 2e-16 / FA.
ROUND = 1e-9
# Names of the spaces, and the signs that turn them to the right, anterior and superior.
SPACES = {
    "right-anterior-superior": [1.0, 1.0, 1.0],
    "left-anterior-superior": [-1.0, 1.0, 1.0],
    "left-posterior-superior": [-1.0, -1.0, 1.0],
}


def shared_data():
    """The sample files of other tools, where somebody has them."""
    folder = os.environ.get("TIGEREYE_DATA")
    folder = pathlib.Path(folder) if folder else REPOSITORY.parent / "shared" / "data"
    return folder.resolve() if folder.is_dir() else None


class Nifti(Checks):
    def save(self, data, name="a.nii", affine=AFFINE, intent=None, dtype=None, end="<"):
        picture = nibabel.Nifti1Image(data, affine, nibabel.Nifti1Header(endianness=end), dtype=dtype or data.dtype)
        if intent:
            picture.header.set_intent(*intent)
        nibabel.save(picture, self.path(name))
        return name

    def slices(self, name, voxel, tolerance, what, *options, directions=TURN):
        for axis, index in SLICES:
            found = self.plane(name, "--slice", f"{axis}={index}", *options)
            self.near(found, slice_of(voxel, axis, index, directions), tolerance, f"{what}, {axis}={index}")

    def test_general_matrices(self):
        """Nine components, row by row: a transposed matrix must show."""
        full = tensors(SHAPE, symmetric=False, seed=21)
        data = full.reshape(*SHAPE, 1, 9)
        for kind, end, name in itertools.product(["f4", "f8"], "<>", ["a.nii", "a.nii.gz"]):
            with self.subTest(f"{end}{kind}, {name}"):
                self.save(data.astype(kind), name, intent=(1004, (3, 3)), end=end)
                self.slices(name, full, 0.0, name)

    def test_matrices_of_the_plane(self):
        full = np.zeros((*SHAPE, 3, 3))
        full[..., :2, :2] = tensors(SHAPE, symmetric=False, seed=22)[..., :2, :2]
        self.save(full[..., :2, :2].reshape(*SHAPE, 1, 4), intent=(1004, (2, 2)))
        self.near(self.plane("a.nii", "--slice", "z=1"), slice_of(full, "z", 1, TURN), 0.0, "2 x 2 matrices")
        full[..., 1, 0] = full[..., 0, 1]
        lower = np.stack([full[..., 0, 0], full[..., 0, 1], full[..., 1, 1]], -1)
        self.save(lower[:, :, :, None, :], intent=(1005, (2,)))
        self.near(self.plane("a.nii", "--slice", "z=1"), slice_of(full, "z", 1, TURN), 0.0, "symmetric 2 x 2 matrices")

    def test_four_axes_in_every_order(self):
        """Six components along the fourth axis; dipy's order where nobody says another."""
        full = tensors(SHAPE, seed=23)
        for order, kind, end in itertools.product(["dipy", "fsl", "mrtrix"], ["f4", "f8"], "<>"):
            with self.subTest(f"{order}, {end}{kind}"):
                # MRtrix has its tensors along the scanner's axes.
                stored = turned(full, TURN) if order == "mrtrix" else full
                self.save(six(stored, order).astype(kind), end=end)
                self.slices("a.nii", full, 1e-6, order, "--order", order)
                if order == "dipy":
                    self.slices("a.nii", full, 1e-6, "no order")

    def test_scaled_integers(self):
        """Whole numbers with a slope and an intercept in the header; nibabel's own product is what is right."""
        full = tensors(SHAPE, seed=24)
        lower = six(full, "dipy")[:, :, :, None, :]
        for kind, end, (slope, intercept) in itertools.product(
            ["u1", "i1", "i2", "u2", "i4", "u4"], "<>", [(0.03125, -3.5), (-0.0625, 2.0), (1.0, 4.0)]
        ):
            with self.subTest(f"{end}{kind}, slope {slope}, intercept {intercept}"):
                header = nibabel.Nifti1Header(endianness=end)
                header.set_data_dtype(np.dtype(kind).newbyteorder(end))
                picture = nibabel.Nifti1Image(lower, AFFINE, header)
                picture.header.set_intent(1005, (3,))
                picture.header.set_slope_inter(slope, intercept)
                nibabel.save(picture, self.path("a.nii"))
                again = nibabel.load(self.path("a.nii"))
                self.assertEqual((again.dataobj.slope, again.dataobj.inter), (slope, intercept))
                self.assertEqual(again.get_data_dtype(), np.dtype(kind).newbyteorder(end))
                self.slices("a.nii", full_tensors(again.get_fdata()[:, :, :, 0], "dipy"), 1e-12, kind)

    def test_extensions_before_the_data(self):
        full = tensors(SHAPE, seed=25)
        picture = nibabel.Nifti1Image(six(full, "dipy")[:, :, :, None, :], AFFINE)
        picture.header.set_intent(1005, (3,))
        for text in [b"short", b"much longer than a block of sixteen bytes"]:
            picture.header.extensions.append(nibabel.nifti1.Nifti1Extension("comment", text))
        nibabel.save(picture, self.path("a.nii"))
        self.slices("a.nii", full, 0.0, "with extensions")

    def test_positions_of_either_hand(self):
        """Each transform alone, and both when they differ, with axes that are a rotation and axes that are mirrored."""
        full = tensors(SHAPE, seed=26)
        other = np.diag([7.0, 8.0, 9.0, 1.0])
        for (name, affine), (sform, qform) in itertools.product(
            [("rotation", AFFINE), ("mirrored", MIRRORED)], [(1, 0), (0, 1), (2, 3), (4, 1)]
        ):
            what = f"{name}, sform code {sform}, qform code {qform}"
            with self.subTest(what):
                picture = nibabel.Nifti1Image(six(full, "dipy")[:, :, :, None, :], None)
                picture.header.set_intent(1005, (3,))
                picture.set_qform(other if (sform, qform) == (4, 1) else affine, qform)
                picture.set_sform(affine if sform else None, sform)
                nibabel.save(picture, self.path("a.nii"))
                right = nibabel.load(self.path("a.nii")).affine
                # nibabel prefers the sform, as the standard's readers do.
                self.near(right, affine, 1e-6, f"{what}: nibabel itself")
                self.run_program("convert", "a.nii", "b.nii", "--force")
                self.near(nibabel.load(self.path("b.nii")).affine, right, 1e-6, what)
                axes = right[:3, :3] / np.linalg.norm(right[:3, :3], axis=0)
                # Components are along the voxel axes, so a transform only says how the picture lies.
                self.slices("a.nii", full, 1e-12, what, "--frame", "voxel", directions=axes)
                # The same field along the world's axes comes out the same.
                world = six(turned(full, axes), "dipy")[:, :, :, None, :]
                picture = nibabel.Nifti1Image(world, None, picture.header)
                nibabel.save(picture, self.path("w.nii"))
                self.slices("w.nii", full, 1e-5, f"{what}, world", "--frame", "world", directions=axes)

    def test_fields_written(self):
        """Generators and arrays as NIfTI files of one layer: five axes, the right intent, components row by row."""
        plane = tensors((4, 6), symmetric=False, seed=27)[..., :2, :2]
        np.save(self.path("array.npy"), plane)
        for field, name in itertools.product(
            ["wedge:size=7", "flamant:width=7,height=4", "drain:width=5,height=8", "array.npy"], ["b.nii", "b.nii.gz"]
        ):
            what = f"{field} as {name}"
            with self.subTest(what):
                expected = self.plane(field)
                symmetric = (expected == expected.swapaxes(-1, -2)).all()
                self.assertEqual(symmetric, field.startswith(("wedge", "flamant")), field)
                full = np.zeros((*expected.shape[:2], 3, 3))
                full[..., :2, :2] = expected[::-1]
                full = full.transpose(1, 0, 2, 3)[:, :, None]
                components = six(full, "dipy") if symmetric else full.reshape(*full.shape[:3], 9)
                self.run_program("convert", field, name, "--force")
                found = nibabel.load(self.path(name))
                self.assertEqual(found.shape, (*full.shape[:3], 1, components.shape[-1]), what)
                self.assertEqual(found.header["intent_code"], 1005 if symmetric else 1004, what)
                parameters = found.header.get_intent()[1]
                self.assertEqual(parameters[: 1 if symmetric else 2], (3.0,) if symmetric else (3.0, 3.0), what)
                self.near(found.affine, np.eye(4), 0.0, what)
                self.near(np.asarray(found.dataobj)[:, :, :, 0], components, 0.0, what)

    def test_an_oblique_volume_written(self):
        sample = nibabel.load(sample_tensors())
        for name in ["b.nii", "b.nii.gz"]:
            with self.subTest(name):
                self.run_program("convert", sample_tensors(), name, "--force")
                found = nibabel.load(self.path(name))
                self.assertEqual(found.shape, (10, 10, 10, 1, 6))
                self.near(found.affine, sample.affine, 1e-6, "affine")
                self.near(found.header.get_zooms()[:3], np.array(sample.header.get_zooms()[:3]), 1e-6, "voxel sizes")
                self.near(found.get_fdata(), sample.get_fdata(), 1e-7, "components")


class Nrrd(Checks):
    def header(self, kind, space="right-anterior-superior", axes=AFFINE[:3, :3]):
        return {
            "kinds": [kind, "space", "space", "space"],
            "space": space,
            "space directions": np.vstack([[np.nan] * 3, axes.T]),
            "space origin": ORIGIN,
        }

    def slices(self, name, voxel, tolerance, what, *options, directions=TURN):
        for axis, index in SLICES:
            found = self.plane(name, "--slice", f"{axis}={index}", *options)
            self.near(found, slice_of(voxel, axis, index, directions), tolerance, f"{what}, {axis}={index}")

    def test_types_in_every_encoding(self):
        whole = np.round(tensors(SHAPE, symmetric=False, seed=31))
        for kind, end, encoding in itertools.product(
            "i1 u1 i2 u2 i4 u4 i8 u8 f4 f8".split(), "<>", ["raw", "gzip", "ascii"]
        ):
            with self.subTest(f"{end}{kind}, {encoding}"):
                full = np.abs(whole) if kind.startswith("u") else whole
                values = np.moveaxis(full.reshape(*SHAPE, 9), -1, 0).astype(end + kind)
                nrrd.write(self.path("a.nrrd"), values, {**self.header("3D-matrix"), "encoding": encoding})
                self.near(
                    self.plane("a.nrrd", "--slice", "z=1", "--frame", "voxel"), slice_of(full, "z", 1, TURN), 0.0, kind
                )

    def test_matrices_of_the_plane(self):
        """The kinds of two dimensions, on two axes."""
        full = tensors((6, 4), symmetric=False, seed=32)[..., :2, :2]
        even = np.maximum(full, full.swapaxes(-1, -2))
        mask = np.ones((6, 4, 1))
        three = np.stack([even[..., 0, 0], even[..., 0, 1], even[..., 1, 1]], -1)
        cases = {
            "2D-symmetric-matrix": (three, even),
            "2D-masked-symmetric-matrix": (np.concatenate([mask, three], -1), even),
            "2D-matrix": (full.reshape(6, 4, 4), full),
            "2D-masked-matrix": (np.concatenate([mask, full.reshape(6, 4, 4)], -1), full),
        }
        for (kind, (data, expected)), encoding, end, detached in itertools.product(
            cases.items(), ["raw", "gzip", "ascii"], "<>", [False, True]
        ):
            what = f"{kind}, {encoding}, {end}, {'detached' if detached else 'attached'}"
            with self.subTest(what):
                name = "a.nhdr" if detached else "a.nrrd"
                header = {"kinds": [kind, "space", "space"], "encoding": encoding}
                values = np.moveaxis(data, -1, 0).astype(end + "f8")
                nrrd.write(self.path(name), values, header, detached_header=detached)
                self.near(self.plane(name), expected.transpose(1, 0, 2, 3)[::-1], 0.0, what)

    def test_masks(self):
        """Where the mask is 0 there is nothing, whatever the components say."""
        full = tensors(SHAPE, seed=33)
        mask = np.random.default_rng(34).integers(0, 2, size=SHAPE).astype(float)
        data = np.concatenate([mask[..., None], six(full, "fsl")], -1)
        nrrd.write(self.path("a.nrrd"), np.moveaxis(data, -1, 0), self.header("3D-masked-symmetric-matrix"))
        self.slices("a.nrrd", full * mask[..., None, None], 0.0, "masked", "--frame", "voxel")
        self.run_program("convert", "a.nrrd", "b.nrrd")
        values, _ = nrrd.read(self.path("b.nrrd"))
        self.assertTrue((values[0] == mask).all(), "the mask is lost")

    def test_measurement_frames(self):
        """A turned frame in every kind of three dimensions, with and without it asked for by name."""
        angle = 0.7
        frame = np.array(
            [[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]]
        )
        full = tensors(SHAPE, seed=35)
        general = tensors(SHAPE, symmetric=False, seed=36)
        mask = np.ones((*SHAPE, 1))
        for kind, data, measured in [
            ("3D-symmetric-matrix", six(full, "fsl"), full),
            ("3D-masked-symmetric-matrix", np.concatenate([mask, six(full, "fsl")], -1), full),
            ("3D-matrix", general.reshape(*SHAPE, 9), general),
        ]:
            with self.subTest(kind):
                # The format lists the frame's axes one by one; pynrrd writes each row of the matrix as one of them.
                header = {**self.header(kind), "measurement frame": frame.T}
                nrrd.write(self.path("a.nrrd"), np.moveaxis(data, -1, 0), header)
                voxel = turned(turned(measured, frame), TURN.T)
                self.slices("a.nrrd", voxel, 1e-12, kind)
                self.slices("a.nrrd", voxel, 1e-12, f"{kind}, asked for", "--frame", "measurement")
                # A file that is asked to be along other axes must follow.
                self.slices("a.nrrd", measured, 1e-12, f"{kind}, voxel", "--frame", "voxel")

    def test_spaces(self):
        """Worlds to the left and posterior: the same places and tensors once they are right-anterior-superior."""
        voxel = tensors(SHAPE, seed=37)
        for space, signs in SPACES.items():
            with self.subTest(space):
                to_ras = np.diag(signs)
                axes = to_ras @ AFFINE[:3, :3]
                header = {**self.header("3D-symmetric-matrix", space, axes), "space origin": to_ras @ ORIGIN}
                world = turned(voxel, to_ras @ TURN)
                nrrd.write(self.path("a.nrrd"), np.moveaxis(six(world, "fsl"), -1, 0), header)
                self.slices("a.nrrd", voxel, 1e-12, space, directions=to_ras @ TURN)
                self.run_program("convert", "a.nrrd", "b.nii", "--force")
                found = nibabel.load(self.path("b.nii"))
                self.near(found.affine, AFFINE, 1e-6, f"{space}: affine")
                self.near(found.get_fdata()[:, :, :, 0], six(voxel, "dipy"), 1e-12, f"{space}: components")

    def test_tensors_on_the_last_axis(self):
        """The format allows the components on any axis."""
        voxel = tensors(SHAPE, seed=38)
        header = {
            "kinds": ["space", "space", "space", "3D-symmetric-matrix"],
            "space": "right-anterior-superior",
            "space directions": np.vstack([AFFINE[:3, :3].T, [np.nan] * 3]),
            "space origin": ORIGIN,
        }
        for encoding in ["raw", "gzip", "ascii"]:
            with self.subTest(encoding):
                nrrd.write(self.path("a.nrrd"), six(voxel, "fsl"), {**header, "encoding": encoding})
                self.slices("a.nrrd", voxel, 0.0, encoding, "--frame", "voxel")

    def test_fields_written(self):
        """Generators and arrays as NRRD files of one layer."""
        plane = tensors((4, 6), symmetric=False, seed=39)[..., :2, :2]
        np.save(self.path("array.npy"), plane)
        for field in ["wedge:width=7,height=4", "drain:width=5,height=8", "array.npy"]:
            with self.subTest(field):
                expected = self.plane(field)
                self.run_program("convert", field, "b.nrrd", "--force")
                values, header = nrrd.read(self.path("b.nrrd"))
                symmetric = field.startswith("wedge")
                kind = "3D-masked-symmetric-matrix" if symmetric else "3D-masked-matrix"
                self.assertEqual(header["kinds"], [kind, "space", "space", "space"])
                self.near(header["space directions"][1:], np.eye(3), 0.0, "directions")
                full = np.zeros((*expected.shape[:2], 3, 3))
                full[..., :2, :2] = expected[::-1]
                full = full.transpose(1, 0, 2, 3)[:, :, None]
                components = six(full, "fsl") if symmetric else full.reshape(*full.shape[:3], 9)
                self.near(np.moveaxis(values[1:], 0, -1), components, 0.0, field)


class Measures(Checks):
    """`convert --invariants` against dipy.reconst.dti: 1e-6, absolute for FA and mode, of the largest value for MD."""

    def compare(self, file, full, what, *options, reader=vtk.vtkXMLImageDataReader, ending="vti"):
        self.run_program("convert", file, f"m.{ending}", "--invariants", "--force", *options)
        found = reader()
        found.SetFileName(self.path(f"m.{ending}"))
        found.ReadAllScalarsOn() if ending == "vtk" else None
        found.Update()
        points = found.GetOutput().GetPointData()
        eigenvalues = np.linalg.eigvalsh(full)[..., ::-1]
        anisotropy = dti.fractional_anisotropy(eigenvalues)
        # The mode divides by the anisotropy, which turns rounding into any number where there is none.
        round_ones = anisotropy < ROUND
        for name, expected in [
            ("FA", anisotropy),
            ("MD", dti.mean_diffusivity(eigenvalues)),
            ("mode", dti.mode(full)),
        ]:
            values = points.GetArray(name)
            self.assertIsNotNone(values, f"{what}: no array {name}")
            values = vtk_to_numpy(values).reshape(full.shape[:3][::-1]).transpose(2, 1, 0)
            scale = max(np.abs(expected).max(), 1e-300) if name == "MD" else 1.0
            off = np.abs(values - expected) / scale
            if name == "mode":
                self.assertLessEqual(np.abs(values).max(), 1.0 + 1e-12, f"{what}: a mode beyond 1")
                self.assertLess(round_ones.mean(), 0.25, f"{what}: too few modes compared")
                off[round_ones] = 0.0
            worst = np.unravel_index(off.argmax(), off.shape)
            self.assertLessEqual(
                off[worst], 1e-6, f"{what}: {name} of voxel {worst} is {values[worst]}, dipy has {expected[worst]}"
            )

    def test_shared_samples(self):
        """The same measured field in five layouts gives the same measures."""
        folder = shared_data()
        if folder is None:
            self.skipTest("no folder of shared samples: TIGEREYE_DATA does not name one")
        stored = nibabel.load(folder / "small_64D_tensor_dipy.nii.gz").get_fdata()
        full = full_tensors(stored, "dipy")
        for name, *options in [
            ("dipy.nii.gz", "--order", "dipy"),
            ("fsl.nii.gz", "--order", "fsl"),
            ("mrtrix.nii.gz", "--order", "mrtrix", "--frame", "voxel"),
            ("symmat5d.nii.gz",),
            ("masked.nrrd",),
        ]:
            with self.subTest(name):
                self.compare(folder / f"small_64D_tensor_{name}", full, name, *options)

    def test_a_model_fitted_by_dipy(self):
        """dipy's own sample, fitted here, so that no file between is trusted."""
        image_file, values_file, vectors_file = get_fnames(name="small_64D")
        picture = nibabel.load(image_file)
        with warnings.catch_warnings():
            # Some vectors of the sample are not quite of length 1; dipy says so each time.
            warnings.simplefilter("ignore")
            table = gradient_table(np.loadtxt(values_file), bvecs=np.loadtxt(vectors_file))
            fit = dti.TensorModel(table).fit(picture.get_fdata())
        lower = six(fit.quadratic_form, "dipy").astype(np.float64)
        written = nibabel.Nifti1Image(lower[:, :, :, None, :], picture.affine)
        written.header.set_intent(1005, (3,))
        nibabel.save(written, self.path("a.nii.gz"))
        for ending, reader in [
            ("vti", vtk.vtkXMLImageDataReader),
            ("vtp", vtk.vtkXMLPolyDataReader),
            ("vtk", vtk.vtkDataSetReader),
        ]:
            with self.subTest(ending):
                self.compare("a.nii.gz", full_tensors(lower, "dipy"), ending, reader=reader, ending=ending)

    def test_tensors_of_every_shape(self):
        """Zero, isotropic, linear, planar, negative and mixed eigenvalues, turned, of very different sizes."""
        generator = np.random.default_rng(41)
        shapes = [[0, 0, 0], [1, 1, 1], [3, 1, 1], [3, 3, 1], [3, 2, 1], [1, 0, 0], [1, 1, 0], [1, 0, -1], [-1, -2, -3]]
        # One that the axes leave alone, then turned ones: equal eigenvalues are exact only in the first.
        turns = [np.eye(3)] + [np.linalg.qr(generator.normal(size=(3, 3)))[0] for _ in range(5)]
        for size in [1.0, 1e-9, 1e9]:
            with self.subTest(f"size {size:g}"):
                full = np.array([[turned(size * np.diag(shape), turn) for turn in turns] for shape in shapes])
                # Two layers: a file of one layer is a plane, which has no invariants.
                full = full.reshape(len(shapes), len(turns) // 2, 2, 3, 3)
                full = (full + full.swapaxes(-1, -2)) / 2.0
                picture = nibabel.Nifti1Image(six(full, "dipy")[:, :, :, None, :], np.eye(4))
                picture.header.set_intent(1005, (3,))
                nibabel.save(picture, self.path("a.nii"))
                self.compare("a.nii", full, f"size {size:g}")
