"""Where tensors are: extents, spacings, origins and directions in both ways, planes of turned volumes, and slices."""

import itertools

import nibabel
import nrrd
import numpy as np
import vtk
from check_vtk import array
from common import ORIGIN, SPACING, TURN, Checks, six, slice_of, tensors, turned
from random_fields import world_axes_of
from vtk.util.numpy_support import vtk_to_numpy

SHAPE = (4, 5, 3)
READERS = {"vti": vtk.vtkXMLImageDataReader, "vtp": vtk.vtkXMLPolyDataReader, "vtk": vtk.vtkDataSetReader}
NAMES = ["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"]
# The voxel axes to the right and up of the plane across an axis.
AXES = {"x": (1, 2), "y": (0, 2), "z": (0, 1)}


def points_of(data):
    return np.array([data.GetPoint(i) for i in range(data.GetNumberOfPoints())])


def in_file_order(full):
    """Tensors (x, y, z, 3, 3) one a point, x fastest, as VTK counts."""
    return full.transpose(2, 1, 0, 3, 4).reshape(-1, 3, 3)


def lattice_points(shape, origin, axes):
    """Positions of the points of a lattice, x fastest; the axes are the columns."""
    z, y, x = np.meshgrid(*(np.arange(n) for n in reversed(shape)), indexing="ij")
    return origin + np.stack([x, y, z], -1).reshape(-1, 3) @ np.asarray(axes).T


def volume(full, directions=None, extent=None):
    """Image data of a volume, tensors along the world's axes."""
    data = vtk.vtkImageData()
    if extent:
        data.SetExtent(*extent)
    else:
        data.SetDimensions(*full.shape[:3])
    data.SetOrigin(*ORIGIN)
    data.SetSpacing(*SPACING)
    if directions is not None:
        data.SetDirectionMatrix(np.asarray(directions).ravel().tolist())
    data.GetPointData().AddArray(array(in_file_order(full).reshape(-1, 9)))
    data.GetPointData().SetActiveTensors("Tensors")
    return data


class Places(Checks):
    def read(self, file):
        reader = READERS[file.rsplit(".", 1)[1]]()
        reader.SetFileName(self.path(file))
        reader.Update()
        return reader.GetOutput()

    def written(self, data, file="a.vti"):
        writer = vtk.vtkXMLPolyDataWriter() if file.endswith("vtp") else vtk.vtkXMLImageDataWriter()
        writer.SetFileName(self.path(file))
        writer.SetInputData(data)
        self.assertEqual(writer.Write(), 1)

    def tensors_at(self, data, places, expected, what):
        active = data.GetPointData().GetTensors()
        self.assertIsNotNone(active, f"{what}: no active tensors")
        self.assertEqual(active.GetName(), "Tensors", what)
        self.assertEqual(active.GetNumberOfComponents(), 9, what)
        self.near(points_of(data), places, 1e-6, f"{what}, positions")
        self.near(vtk_to_numpy(active).reshape(-1, 3, 3), expected, 1e-6, f"{what}, tensors")

    def named(self, data, what):
        """What the XML formats also keep: component names and the file's story."""
        active = data.GetPointData().GetTensors()
        self.assertEqual([active.GetComponentName(i) for i in range(9)], NAMES, what)
        story = data.GetFieldData().GetAbstractArray("tigereye")
        self.assertIsNotNone(story, f"{what}: no field data `tigereye`")
        self.assertIn("convert", self.story_of(story.GetValue(0))["command"], what)


class Planes(Places):
    def test_fields_that_are_not_square(self):
        """More columns than rows and asymmetric tensors, from a generator and from an array."""
        plane = tensors((4, 6), symmetric=False, seed=11)[..., :2, :2]
        np.save(self.path("array.npy"), plane)
        for field, ending in itertools.product(
            ["inverse:size=7", "wedge:width=7,height=5", "drain:width=5,height=8", "array.npy"], READERS
        ):
            what = f"{field} as .{ending}"
            with self.subTest(what):
                expected = self.plane(field)
                if field == "array.npy":
                    self.assertTrue((expected == plane).all(), what)
                height, width = expected.shape[:2]
                full = np.zeros((height, width, 3, 3))
                full[..., :2, :2] = expected[::-1]
                self.run_program("convert", field, f"o.{ending}", "--force")
                data = self.read(f"o.{ending}")
                places = lattice_points((width, height, 1), np.zeros(3), np.eye(3))
                self.tensors_at(data, places, full.reshape(-1, 3, 3), what)
                if ending != "vtp":
                    self.assertEqual(data.GetDimensions(), (width, height, 1), what)
                    self.assertEqual(data.GetSpacing(), (1.0, 1.0, 1.0), what)
                    self.assertEqual(data.GetOrigin(), (0.0, 0.0, 0.0), what)
                if ending == "vti":
                    self.assertEqual(data.GetExtent(), (0, width - 1, 0, height - 1, 0, 0), what)
                    self.assertTrue(data.GetDirectionMatrix().IsIdentity(), what)
                if ending != "vtk":
                    self.named(data, what)
                # These must be able to show a transposed matrix.
                if field.startswith(("drain", "array")):
                    self.assertGreater(np.abs(expected[..., 0, 1] - expected[..., 1, 0]).max(), 0.0, field)

    def test_slices_of_volumes(self):
        """Slices in every direction as files: rows, origin and spacing of the plane."""
        upright = tensors(SHAPE, symmetric=False, seed=12)
        self.written(volume(upright))
        for (axis, ending), last in itertools.product(itertools.product(AXES, READERS), [False, True]):
            index = SHAPE["xyz".index(axis)] - 1 if last else 0
            what = f"{axis}={index} as .{ending}"
            with self.subTest(what):
                expected = slice_of(upright, axis, index, np.eye(3))
                height, width = expected.shape[:2]
                full = np.zeros((height, width, 3, 3))
                full[..., :2, :2] = expected[::-1]
                right, up = AXES[axis]
                self.assertTrue((self.plane("a.vti", "--slice", f"{axis}={index}") == expected).all(), what)
                self.run_program("convert", "a.vti", f"s.{ending}", "--slice", f"{axis}={index}", "--force")
                # Only the planes along x and y lie in the world as they are.
                height_in_world = ORIGIN[2] + index * SPACING[2] if axis == "z" else 0.0
                origin = np.array([ORIGIN[right], ORIGIN[up], height_in_world])
                places = lattice_points((width, height, 1), origin, np.diag([SPACING[right], SPACING[up], 1.0]))
                self.tensors_at(self.read(f"s.{ending}"), places, full.reshape(-1, 3, 3), what)


class Volumes(Places):
    def test_turned_volumes_from_nrrd_and_nifti(self):
        """Oblique voxel axes: the direction matrix is theirs, tensors are along the world's axes."""
        voxel = tensors(SHAPE, seed=13)
        affine = np.eye(4)
        affine[:3, :3], affine[:3, 3] = TURN * SPACING, ORIGIN
        picture = nibabel.Nifti1Image(six(voxel, "dipy")[:, :, :, None, :], affine)
        picture.header.set_intent(1005, (3,))
        nibabel.save(picture, self.path("a.nii"))
        world = turned(voxel, TURN)
        header = {
            "kinds": ["3D-symmetric-matrix", "space", "space", "space"],
            "space": "right-anterior-superior",
            "space directions": np.vstack([[np.nan] * 3, (TURN * SPACING).T]),
            "space origin": ORIGIN,
        }
        nrrd.write(self.path("a.nrrd"), np.moveaxis(six(world, "fsl"), -1, 0), header)
        for file, ending in itertools.product(["a.nii", "a.nrrd"], READERS):
            what = f"{file} as .{ending}"
            with self.subTest(what):
                self.run_program("convert", file, f"o.{ending}", "--force")
                data = self.read(f"o.{ending}")
                self.tensors_at(data, lattice_points(SHAPE, ORIGIN, TURN * SPACING), in_file_order(world), what)
                if ending == "vti":
                    self.assertEqual(data.GetExtent(), (0, 3, 0, 4, 0, 2), what)
                    self.near(np.array(data.GetSpacing()), SPACING, 1e-6, f"{what}, spacing")
                    self.near(np.array(data.GetOrigin()), ORIGIN, 1e-6, f"{what}, origin")
                    matrix = data.GetDirectionMatrix()
                    found = np.array([[matrix.GetElement(i, j) for j in range(3)] for i in range(3)])
                    self.near(found, TURN, 1e-6, f"{what}, directions")
                if ending != "vtk":
                    self.named(data, what)
            for axis, index in [("x", 2), ("y", 0), ("z", 1)]:
                with self.subTest(f"{file}, {axis}={index}"):
                    found = self.plane(file, "--slice", f"{axis}={index}")
                    self.near(found, slice_of(voxel, axis, index, TURN), 1e-6, f"{file}, {axis}={index}")

    def test_direction_matrices(self):
        """VTK's turned image data: slices along their axes, and whole again."""
        world = tensors(SHAPE, symmetric=False, seed=14)
        voxel = turned(world, TURN.T)
        self.written(volume(world, TURN))
        for axis, index in [("x", 1), ("y", 4), ("z", 2)]:
            with self.subTest(f"{axis}={index}"):
                found = self.plane("a.vti", "--slice", f"{axis}={index}")
                self.near(found, slice_of(voxel, axis, index, TURN), 1e-12, f"{axis}={index}")
        for ending in READERS:
            with self.subTest(f"as .{ending}"):
                self.run_program("convert", "a.vti", f"o.{ending}", "--force")
                places = lattice_points(SHAPE, ORIGIN, TURN * SPACING)
                self.tensors_at(self.read(f"o.{ending}"), places, in_file_order(world), ending)

    def test_axes_that_run_backwards(self):
        """Where axes run to the left and down, the picture is still what a viewer shows: x to the right, y up."""
        world = tensors(SHAPE, symmetric=False, seed=15)
        for signs in itertools.product([1.0, -1.0], repeat=2):
            with self.subTest(f"signs {signs}"):
                # The third sign keeps the matrix a rotation, as VTK asks.
                self.written(volume(world, np.diag([*signs, signs[0] * signs[1]])))
                # Neighbours along x and y of the world.
                shown = world[:: int(signs[0]), :: int(signs[1])]
                self.assertTrue((self.plane("a.vti", "--slice", "z=1") == slice_of(shown, "z", 1, np.eye(3))).all())

    def test_extents_that_do_not_start_at_zero(self):
        """VTK's origin belongs to index 0, wherever the extent starts."""
        world = tensors(SHAPE, symmetric=False, seed=16)
        for name, directions in [("upright", None), ("turned", TURN)]:
            self.written(volume(world, directions, extent=(2, 5, -1, 3, 7, 9)))
            places = points_of(self.read("a.vti"))
            for ending in READERS:
                with self.subTest(f"{name} as .{ending}"):
                    self.run_program("convert", "a.vti", f"o.{ending}", "--force")
                    self.tensors_at(self.read(f"o.{ending}"), places, in_file_order(world), f"{name} as .{ending}")

    def test_poly_data_volumes(self):
        """Points of a turned lattice whose size nobody tells."""
        world = tensors(SHAPE, symmetric=False, seed=17)
        data = vtk.vtkPolyData()
        points = vtk.vtkPoints()
        points.SetDataTypeToDouble()
        places = lattice_points(SHAPE, ORIGIN, TURN * SPACING)
        for place in places:
            points.InsertNextPoint(*place)
        data.SetPoints(points)
        data.GetPointData().AddArray(array(in_file_order(world).reshape(-1, 9)))
        data.GetPointData().SetActiveTensors("Tensors")
        self.written(data, "a.vtp")
        voxel = turned(world, TURN.T)
        # Points have no order: x, y and z are the world's axes that those of the lattice are nearest to.
        own = world_axes_of(TURN)
        order = [own.index(axis) for axis in range(3)]
        steps = [1 if TURN[axis, own.index(axis)] > 0 else -1 for axis in range(3)]
        for axis, index in [("x", 3), ("y", 2), ("z", 0)]:
            with self.subTest(f"{axis}={index}"):
                a = "xyz".index(axis)
                counted = index if steps[own[a]] > 0 else SHAPE[a] - 1 - index
                found = self.plane("a.vtp", "--slice", f"{'xyz'[own[a]]}={counted}")
                self.near(found, slice_of(voxel, axis, index, TURN), 1e-9, f"{axis}={index}")
        self.run_program("convert", "a.vtp", "o.vti")
        along = tuple(slice(None, None, step) for step in steps)
        grid = places.reshape(*reversed(SHAPE), 3).transpose(2, 1, 0, 3).transpose(*order, 3)[along]
        there = grid.transpose(2, 1, 0, 3).reshape(-1, 3)
        expected = in_file_order(world.transpose(*order, 3, 4)[along])
        self.tensors_at(self.read("o.vti"), there, expected, "poly data as .vti")

    def test_legacy_volumes(self):
        """Three axes in the legacy geometries, with unequal steps of the axes."""
        world = tensors(SHAPE, symmetric=False, seed=18)
        values = array(in_file_order(world).reshape(-1, 9))
        upright = lattice_points(SHAPE, ORIGIN, np.diag(SPACING))
        oblique = lattice_points(SHAPE, ORIGIN, TURN * SPACING)
        rectilinear = vtk.vtkRectilinearGrid()
        rectilinear.SetDimensions(*SHAPE)
        steps = (array(ORIGIN[a] + SPACING[a] * np.arange(SHAPE[a]), name="xyz"[a]) for a in range(3))
        for put in (rectilinear.SetXCoordinates, rectilinear.SetYCoordinates, rectilinear.SetZCoordinates):
            put(next(steps))
        grid = vtk.vtkStructuredGrid()
        grid.SetDimensions(*SHAPE)
        points = vtk.vtkPoints()
        points.SetDataTypeToDouble()
        for place in oblique:
            points.InsertNextPoint(*place)
        grid.SetPoints(points)
        for data in (rectilinear, grid):
            data.GetPointData().AddArray(values)
            data.GetPointData().SetActiveTensors("Tensors")
        cases = [("points", volume(world), upright), ("rectilinear", rectilinear, upright), ("grid", grid, oblique)]
        for (name, data, places), text, version in itertools.product(cases, [True, False], [42, 51]):
            what = f"{name}, {'ASCII' if text else 'BINARY'}, version {version}"
            with self.subTest(what):
                writer = vtk.vtkDataSetWriter()
                writer.SetFileName(self.path("a.vtk"))
                writer.SetInputData(data)
                writer.SetFileTypeToASCII() if text else writer.SetFileTypeToBinary()
                writer.SetFileVersion(version)
                self.assertEqual(writer.Write(), 1)
                voxel = turned(world, TURN.T) if name == "grid" else world
                found = self.plane("a.vtk", "--slice", "z=2")
                # Text has six digits of a position, so axes are turned a little.
                self.near(found, slice_of(voxel, "z", 2, TURN if name == "grid" else np.eye(3)), 1e-5, what)
                self.run_program("convert", "a.vtk", "o.vti", "--force")
                data_read = self.read("o.vti")
                self.near(points_of(data_read), places, 1e-5, what)


class Results(Places):
    def test_results_lie_on_their_slice(self):
        """Light, gradient and lines of an oblique slice are where VTK has the points of its voxels."""
        world = tensors(SHAPE, seed=19)
        self.written(volume(world, TURN))
        index = 1
        # The picture has the voxel axis y to the left and x down.
        picture = lattice_points(SHAPE, ORIGIN, TURN * SPACING).reshape(*reversed(SHAPE), 3)[index, ::-1, ::-1]
        expected = picture.swapaxes(0, 1).reshape(-1, 3)
        chosen = ["a.vti", "--slice", f"z={index}", "--directions", "8", "--normalization", "local"]
        self.run_program("propagate", *chosen, "--light", "1,1", "-o", "l.vti")
        self.near(points_of(self.read("l.vti")), expected, 1e-6, "light")
        self.run_program("ltg", *chosen, "-o", "g.vti")
        found = points_of(self.read("g.vti")).reshape(-1, len(expected), 3)
        self.near(found[0], expected, 1e-6, "first layer of the gradient")
        steps = (found - found[0]) @ TURN[:, 2]
        self.near(np.abs(steps), np.abs(np.arange(len(found)))[:, None] + 0.0 * steps, 1e-6, "axis of directions")
        self.run_program("lines", "a.vti", "--slice", f"z={index}", "-o", "l.vtp")
        lines = points_of(self.read("l.vtp"))
        self.assertLess(np.abs((lines - expected[0]) @ TURN[:, 2]).max(), 1e-6, "lines")

    def test_light_and_its_gradient(self):
        """What the sweep and the propagation write of a field that lies nowhere counts cells."""
        self.run_program("ltg", "inverse:size=9", "--directions", "8", "-o", "g.vti")
        self.run_program("propagate", "inverse:size=9", "--light", "4,7", "-o", "l.vti")
        self.run_program("convert", "inverse:size=9", "f.vti")
        field = self.read("f.vti")
        for file, extent, name in [("g.vti", (0, 8, 0, 8, 0, 7), "LTG"), ("l.vti", (0, 8, 0, 8, 0, 0), "intensity")]:
            with self.subTest(file):
                data = self.read(file)
                self.assertEqual(data.GetExtent(), extent)
                self.assertEqual(data.GetOrigin()[:2], field.GetOrigin()[:2])
                self.assertEqual(data.GetSpacing()[:2], field.GetSpacing()[:2])
                self.assertTrue(data.GetDirectionMatrix().IsIdentity())
                found = data.GetPointData().GetArray(name)
                self.assertIsNotNone(found, f"no array {name}")
                self.assertTrue(np.isfinite(vtk_to_numpy(found)).all())
                story = data.GetFieldData().GetAbstractArray("tigereye")
                self.assertIsNotNone(story)
                self.story_of(story.GetValue(0))
        energy = vtk_to_numpy(self.read("l.vti").GetPointData().GetArray("energy")).reshape(9, 9)
        # Row 0 of a result is the first row of the field, as in the published volumes, and not the lowest as in files
        # of tensors. The lamp, in column 4 of row 7, is the brightest cell.
        self.assertEqual(np.unravel_index(energy.argmax(), energy.shape), (7, 4))
