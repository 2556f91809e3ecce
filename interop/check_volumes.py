"""NIfTI and NRRD in both directions with nibabel and pynrrd, and the invariants of diffusion tensors with dipy."""

import itertools

import nibabel
import nrrd
import numpy as np
from common import ORIGIN, SPACING, TURN, Checks, full_tensors, sample_tensors, six, slice_of, tensors, turned
from dipy.reconst import dti

SHAPE = (4, 5, 3)
AFFINE = np.eye(4)
AFFINE[:3, :3] = TURN * SPACING
AFFINE[:3, 3] = ORIGIN


def plane_of(full, z):
    """What tigereye shows of a volume (x, y, z, 3, 3) with components along the voxel axes: slice z."""
    return slice_of(full, "z", z, TURN)


class Nibabel(Checks):
    def save(self, data, name="a.nii", affine=AFFINE, intent=None, change=None):
        picture = nibabel.Nifti1Image(data, affine)
        if intent:
            picture.header.set_intent(*intent)
        if change:
            change(picture)
        nibabel.save(picture, self.path(name))
        return name

    def test_orders_of_four_axes(self):
        full = tensors(SHAPE)
        for order, name in itertools.product(["dipy", "fsl", "mrtrix", "vtk"], ["a.nii", "a.nii.gz"]):
            with self.subTest(f"{order}, {name}"):
                self.save(six(full, order).astype(np.float32), name)
                options = ["--order", order, "--frame", "voxel", "--slice", "z=1"]
                self.assertTrue((self.plane(name, *options) == plane_of(full, 1)).all())

    def test_number_types_and_byte_orders(self):
        whole = np.round(tensors(SHAPE, seed=2))
        whole = np.maximum(whole, whole.swapaxes(-1, -2)) % 100
        lower = six(whole, "dipy")[:, :, :, None, :]
        for kind, end in itertools.product("i1 u1 i2 u2 i4 u4 i8 u8 f4 f8".split(), "<>"):
            with self.subTest(f"{end}{kind}"):
                header = nibabel.Nifti1Header(endianness=end)
                header.set_data_dtype(np.dtype(kind).newbyteorder(end))
                picture = nibabel.Nifti1Image(lower.astype(kind), AFFINE, header)
                picture.header.set_intent(1005, (3,))
                # 64-bit integers are allowed only where somebody insists.
                nibabel.save(picture, self.path("a.nii"))
                self.assertTrue((self.plane("a.nii", "--slice", "z=2") == plane_of(whole, 2)).all())

    def test_scaling(self):
        full = tensors(SHAPE, seed=3)
        picture = nibabel.Nifti1Image(six(full, "dipy")[:, :, :, None, :], AFFINE)
        picture.header.set_intent(1005, (3,))
        picture.header.set_data_dtype(np.int16)
        picture.header.set_slope_inter(0.0625, -3.5)
        nibabel.save(picture, self.path("a.nii"))
        expected = full_tensors(np.asarray(nibabel.load(self.path("a.nii")).dataobj)[:, :, :, 0], "dipy")
        self.near(self.plane("a.nii", "--slice", "z=0"), plane_of(expected, 0), 1e-6, "scaled")

    def test_positions(self):
        full = tensors(SHAPE, seed=4)
        for name, keep in [("sform", "sform"), ("qform", "qform")]:
            with self.subTest(name):

                def change(picture, keep=keep):
                    picture.set_sform(AFFINE, 1 if keep == "sform" else 0)
                    picture.set_qform(AFFINE, 1 if keep == "qform" else 0)

                self.save(six(full, "dipy")[:, :, :, None, :], intent=(1005, (3,)), change=change)
                self.run_program("convert", "a.nii", "b.nii", "--force")
                self.near(nibabel.load(self.path("b.nii")).affine, AFFINE, 1e-6, name)

    def test_what_tigereye_writes(self):
        for symmetric, name in itertools.product([True, False], ["b.nii", "b.nii.gz"]):
            with self.subTest(f"{symmetric}, {name}"):
                full = tensors(SHAPE, symmetric, seed=5)
                data = six(full, "dipy") if symmetric else full.reshape(*SHAPE, 9)
                intent = (1005, (3,)) if symmetric else (1004, (3, 3))
                self.save(data[:, :, :, None, :], intent=intent)
                self.run_program("convert", "a.nii", name, "--force")
                found = nibabel.load(self.path(name))
                self.assertEqual(found.shape, (*SHAPE, 1, data.shape[-1]))
                self.assertEqual(found.header["intent_code"], intent[0])
                self.near(found.affine, AFFINE, 1e-6, "affine")
                self.near(np.asarray(found.dataobj)[:, :, :, 0], data, 1e-12, "components")
                story = found.header.extensions[0].get_content()
                self.story_of((story if isinstance(story, str) else story.decode()).rstrip("\0"))


class Pynrrd(Checks):
    def header(self, kind):
        return {
            "kinds": [kind, "space", "space", "space"],
            "space": "right-anterior-superior",
            "space directions": np.vstack([[np.nan] * 3, (TURN * SPACING).T]),
            "space origin": ORIGIN,
        }

    def test_kinds_encodings_and_byte_orders(self):
        full = tensors(SHAPE, seed=6)
        general = tensors(SHAPE, symmetric=False, seed=7)
        mask = np.ones((*SHAPE, 1))
        cases = {
            "3D-symmetric-matrix": (six(full, "fsl"), full),
            "3D-masked-symmetric-matrix": (np.concatenate([mask, six(full, "fsl")], -1), full),
            "3D-matrix": (general.reshape(*SHAPE, 9), general),
            "3D-masked-matrix": (np.concatenate([mask, general.reshape(*SHAPE, 9)], -1), general),
        }
        for (kind, (data, expected)), encoding, end, detached in itertools.product(
            cases.items(), ["raw", "gzip", "ascii"], "<>", [False, True]
        ):
            with self.subTest(f"{kind}, {encoding}, {end}, {'detached' if detached else 'attached'}"):
                name = "a.nhdr" if detached else "a.nrrd"
                values = np.moveaxis(data, -1, 0).astype(end + "f8")
                header = {**self.header(kind), "encoding": encoding}
                nrrd.write(self.path(name), values, header, detached_header=detached)
                found = self.plane(name, "--slice", "z=1", "--frame", "voxel")
                self.assertTrue((found == plane_of(expected, 1)).all())

    def test_measurement_frames(self):
        full = tensors(SHAPE, seed=8)
        frame = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        header = {**self.header("3D-symmetric-matrix"), "measurement frame": frame}
        nrrd.write(self.path("a.nrrd"), np.moveaxis(six(full, "fsl"), -1, 0), header)
        # pynrrd gives the frame as the file has it: vectors are the columns of the matrix that leads to the world.
        world = turned(full, frame.T)
        found = self.plane("a.nrrd", "--slice", "z=1")
        self.near(found, plane_of(turned(world, TURN.T), 1), 1e-12, "along the voxel axes")

    def test_what_tigereye_writes(self):
        for symmetric in [True, False]:
            with self.subTest(f"symmetric: {symmetric}"):
                full = tensors(SHAPE, symmetric, seed=9)
                kind = "3D-symmetric-matrix" if symmetric else "3D-matrix"
                data = six(full, "fsl") if symmetric else full.reshape(*SHAPE, 9)
                nrrd.write(self.path("a.nrrd"), np.moveaxis(data, -1, 0), self.header(kind))
                self.run_program("convert", "a.nrrd", "b.nrrd", "--force", "--frame", "voxel")
                values, header = nrrd.read(self.path("b.nrrd"))
                self.assertEqual(header["space"], "right-anterior-superior")
                self.near(header["space origin"], ORIGIN, 1e-12, "origin")
                self.near(header["space directions"][1:], (TURN * SPACING).T, 1e-12, "directions")
                self.assertTrue((values[0] == 1.0).all(), "mask")
                # Along the voxel axes, as they were read and as was asked; the measurement frame leads to the world.
                components = six(full, "fsl") if symmetric else full.reshape(*SHAPE, 9)
                self.near(np.moveaxis(values[1:], 0, -1), components, 1e-12, "components along the voxel axes")
                self.near(header["measurement frame"], TURN.T, 1e-12, "measurement frame")
                world = turned(full, TURN)
                expected = six(world, "fsl") if symmetric else world.reshape(*SHAPE, 9)
                self.run_program("convert", "b.nrrd", "c.nrrd", "--force")
                values, header = nrrd.read(self.path("c.nrrd"))
                self.near(np.moveaxis(values[1:], 0, -1), expected, 1e-12, "components in the world")
                self.near(header["measurement frame"], np.eye(3), 0.0, "measurement frame of the world")
                self.story_of(header["tigereye"].replace("\\\\", "\\"))


class Dipy(Checks):
    def test_invariants(self):
        stored = np.asarray(nibabel.load(sample_tensors()).dataobj)[:, :, :, 0, :]
        eigenvalues = np.linalg.eigvalsh(full_tensors(stored, "dipy").astype(float))[..., ::-1]
        self.run_program("convert", sample_tensors(), "a.vti", "--invariants")
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy

        reader = vtk.vtkXMLImageDataReader()
        reader.SetFileName(self.path("a.vti"))
        reader.Update()
        points = reader.GetOutput().GetPointData()
        full = full_tensors(stored, "dipy")
        for name, expected in [
            ("FA", dti.fractional_anisotropy(eigenvalues)),
            ("MD", dti.mean_diffusivity(eigenvalues)),
            ("mode", dti.mode(full)),
        ]:
            found = vtk_to_numpy(points.GetArray(name)).reshape(10, 10, 10).transpose(2, 1, 0)
            scale = np.abs(expected).max() if name == "MD" else 1.0
            self.assertLessEqual(np.abs(found - expected).max() / scale, 1e-6, name)
