"""VTK reads what tigereye writes, and tigereye reads what VTK writes, in every encoding."""

import itertools

import nibabel
import numpy as np
import vtk
from common import Checks, full_tensors, sample_tensors, six, tensors, turned
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

W, H = 5, 4
TYPES = {
    "Int8": vtk.VTK_SIGNED_CHAR,
    "UInt8": vtk.VTK_UNSIGNED_CHAR,
    "Int16": vtk.VTK_SHORT,
    "UInt16": vtk.VTK_UNSIGNED_SHORT,
    "Int32": vtk.VTK_INT,
    "UInt32": vtk.VTK_UNSIGNED_INT,
    "Int64": vtk.VTK_LONG_LONG,
    "UInt64": vtk.VTK_UNSIGNED_LONG_LONG,
    "Float32": vtk.VTK_FLOAT,
    "Float64": vtk.VTK_DOUBLE,
}
ENCODINGS = ["ascii", "inline", "appended base64", "appended raw"]
COMPRESSORS = {"none": None, "zlib": vtk.vtkZLibDataCompressor, "lz4": vtk.vtkLZ4DataCompressor}


def whole_numbers(seed=3):
    """Symmetric tensors of numbers that every type holds, point by point: the upper rows last, as VTK has it."""
    numbers = np.random.default_rng(seed).integers(0, 60, size=(H, W, 3, 3)).astype(float)
    return np.maximum(numbers, numbers.swapaxes(-1, -2))


def picture(points):
    """The field that tigereye shows: rows reversed, third row and column dropped."""
    return points[::-1, :, :2, :2]


def array(values, kind=vtk.VTK_DOUBLE, name="Tensors"):
    found = numpy_to_vtk(np.ascontiguousarray(values), deep=True, array_type=kind)
    found.SetName(name)
    return found


def image(values, kind=vtk.VTK_DOUBLE):
    data = vtk.vtkImageData()
    data.SetDimensions(W, H, 1)
    data.SetOrigin(1.0, -2.0, 0.5)
    data.SetSpacing(0.5, 0.25, 1.0)
    data.GetPointData().AddArray(array(values, kind))
    if values.shape[-1] == 9:
        data.GetPointData().SetActiveTensors("Tensors")
    return data


def configured(writer, data, path, encoding, compressor, wide, big):
    writer.SetFileName(path)
    writer.SetInputData(data)
    {"ascii": writer.SetDataModeToAscii, "inline": writer.SetDataModeToBinary}.get(
        encoding, writer.SetDataModeToAppended
    )()
    writer.SetEncodeAppendedData(encoding == "appended base64")
    kind = COMPRESSORS[compressor]
    writer.SetCompressor(kind() if kind else None)
    writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
    writer.SetByteOrderToBigEndian() if big else writer.SetByteOrderToLittleEndian()
    # Several blocks even in small files.
    writer.SetBlockSize(256)
    assert writer.Write() == 1, path


class VtkWrites(Checks):
    def test_image_data_in_every_encoding(self):
        points = whole_numbers()
        for kind, encoding, compressor, wide, big in itertools.product(
            TYPES, ENCODINGS, COMPRESSORS, [False, True], [False, True]
        ):
            what = f"{kind}, {encoding}, {compressor}, {'UInt64' if wide else 'UInt32'}, {'big' if big else 'little'}"
            with self.subTest(what):
                values = points.reshape(-1, 9)
                data = image(values.astype(values.dtype), TYPES[kind])
                configured(vtk.vtkXMLImageDataWriter(), data, self.path("a.vti"), encoding, compressor, wide, big)
                self.assertTrue((self.plane("a.vti") == picture(points)).all(), what)

    def test_symmetric_tensors_have_vtks_order(self):
        points = tensors((H, W))
        data = image(six(points, "vtk").reshape(-1, 6))
        configured(vtk.vtkXMLImageDataWriter(), data, self.path("a.vti"), "appended raw", "zlib", True, False)
        self.assertTrue((self.plane("a.vti") == picture(points)).all())

    def test_lzma_is_refused_by_name(self):
        writer = vtk.vtkXMLImageDataWriter()
        writer.SetFileName(self.path("a.vti"))
        writer.SetInputData(image(whole_numbers().reshape(-1, 9)))
        writer.SetCompressorTypeToLZMA()
        self.assertEqual(writer.Write(), 1)
        self.assertIn("vtkLZMADataCompressor", self.run_program("info", "a.vti", code=2))

    def test_poly_data_on_a_lattice(self):
        points = whole_numbers()
        data = vtk.vtkPolyData()
        places = vtk.vtkPoints()
        for y, x in itertools.product(range(H), range(W)):
            places.InsertNextPoint(1.0 + 0.5 * x, -2.0 + 0.25 * y, 0.5)
        data.SetPoints(places)
        data.GetPointData().AddArray(array(points.reshape(-1, 9)))
        data.GetPointData().SetActiveTensors("Tensors")
        cells = vtk.vtkCellArray()
        for i in range(W * H):
            cells.InsertNextCell(1, [i])
        data.SetVerts(cells)
        for encoding, compressor, wide, big in itertools.product(ENCODINGS, COMPRESSORS, [False, True], [False, True]):
            with self.subTest(f"{encoding}, {compressor}, {wide}, {big}"):
                configured(vtk.vtkXMLPolyDataWriter(), data, self.path("a.vtp"), encoding, compressor, wide, big)
                self.assertTrue((self.plane("a.vtp") == picture(points)).all())

    def test_legacy_files(self):
        points = whole_numbers()
        grid = vtk.vtkStructuredGrid()
        grid.SetDimensions(W, H, 1)
        places = vtk.vtkPoints()
        for y, x in itertools.product(range(H), range(W)):
            places.InsertNextPoint(0.5 * x, 0.25 * y, 3.0)
        grid.SetPoints(places)
        rectilinear = vtk.vtkRectilinearGrid()
        rectilinear.SetDimensions(W, H, 1)
        rectilinear.SetXCoordinates(array(0.5 * np.arange(W), name="x"))
        rectilinear.SetYCoordinates(array(0.25 * np.arange(H), name="y"))
        rectilinear.SetZCoordinates(array(np.zeros(1), name="z"))
        plain = image(points.reshape(-1, 9))
        for (name, data), text, version in itertools.product(
            [("points", plain), ("grid", grid), ("rectilinear", rectilinear)], [True, False], [42, 51]
        ):
            with self.subTest(f"{name}, {'ASCII' if text else 'BINARY'}, version {version}"):
                if name != "points":
                    data.GetPointData().AddArray(array(points.reshape(-1, 9)))
                    data.GetPointData().SetActiveTensors("Tensors")
                writer = vtk.vtkDataSetWriter()
                writer.SetFileName(self.path("a.vtk"))
                writer.SetInputData(data)
                writer.SetFileTypeToASCII() if text else writer.SetFileTypeToBinary()
                writer.SetFileVersion(version)
                self.assertEqual(writer.Write(), 1)
                self.assertTrue((self.plane("a.vtk") == picture(points)).all())


class VtkReads(Checks):
    def read(self, reader, file):
        reader.SetFileName(self.path(file))
        reader.Update()
        return reader.GetOutput()

    def readers(self):
        structured = {"p.vtk": vtk.vtkStructuredPointsReader, "g.vtk": vtk.vtkStructuredGridReader}
        return {"o.vti": vtk.vtkXMLImageDataReader, "o.vtp": vtk.vtkXMLPolyDataReader, **structured}

    def check(self, data, expected, what):
        tensors_of = data.GetPointData().GetTensors()
        self.assertIsNotNone(tensors_of, what)
        self.assertEqual(tensors_of.GetName(), "Tensors", what)
        self.near(vtk_to_numpy(tensors_of).reshape(-1, 3, 3), expected.reshape(-1, 3, 3), 1e-14, what)

    def test_planes(self):
        for field in ["inverse:size=7", "drain:size=6"]:
            plane = self.plane(field)[::-1]
            expected = np.zeros((*plane.shape[:2], 3, 3))
            expected[..., :2, :2] = plane
            for file, reader in self.readers().items():
                if file == "g.vtk":
                    continue
                self.run_program("convert", field, file, "--force")
                data = self.read(reader(), file)
                self.check(data, expected, f"{field} as {file}")
                if file == "o.vti":
                    n = plane.shape[0] - 1
                    self.assertEqual(data.GetExtent(), (0, n, 0, n, 0, 0))
                    names = [data.GetPointData().GetTensors().GetComponentName(i) for i in range(9)]
                    self.assertEqual(names, ["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"])
                    story = data.GetFieldData().GetAbstractArray("tigereye").GetValue(0)
                    self.assertIn("convert", self.story_of(story)["command"])

    def test_turned_volumes(self):
        """The measured sample has an oblique affine: positions and tensors in the world, from every format."""
        sample = nibabel.load(sample_tensors())
        stored = full_tensors(np.asarray(sample.dataobj)[..., 0, :], "dipy").transpose(2, 1, 0, 3, 4)
        directions = sample.affine[:3, :3] / np.linalg.norm(sample.affine[:3, :3], axis=0)
        for (file, reader), (frame, expected) in itertools.product(
            self.readers().items(), [("voxel", turned(stored, directions)), ("world", stored)]
        ):
            if file == "p.vtk":
                continue
            with self.subTest(f"{file}, components along the {frame} axes"):
                # For convert, --frame voxel asks for a picture in voxel axes; the file's own frame is voxel anyway.
                option = ["--frame", frame] if frame == "world" else []
                self.run_program("convert", sample_tensors(), file, "--force", *option)
                data = self.read(reader(), file)
                self.assertEqual(data.GetNumberOfPoints(), 1000)
                corner = sample.affine @ [9, 0, 4, 1]
                self.near(np.array(data.GetPoint(4 * 100 + 9)), corner[:3], 1e-6, file)
                self.near(
                    vtk_to_numpy(data.GetPointData().GetTensors()).reshape(-1, 3, 3), expected.reshape(-1, 3, 3), 1e-6, file
                )

    def test_results(self):
        self.run_program("ltg", "inverse:size=9", "--directions", "8", "-o", "g.vti")
        data = self.read(vtk.vtkXMLImageDataReader(), "g.vti")
        self.assertEqual(data.GetExtent(), (0, 8, 0, 8, 0, 7))
        self.run_program("ltg", "inverse:size=9", "--directions", "8", "-o", "g.npy")
        values = vtk_to_numpy(data.GetPointData().GetArray("LTG")).reshape(8, 9, 9)
        self.assertTrue((values == np.load(self.path("g.npy"))).all())
        self.run_program("propagate", "inverse:size=9", "--light", "4,7", "-o", "l.vti", "l.npy", "l.pvd")
        data = self.read(vtk.vtkXMLImageDataReader(), "l.vti")
        intensity = vtk_to_numpy(data.GetPointData().GetArray("intensity")).reshape(9, 9, 32)
        self.assertTrue((intensity == np.load(self.path("l.npy"))).all())
        frames = sorted((self.folder / "l").glob("*.vti"))
        last = self.read(vtk.vtkXMLImageDataReader(), f"l/{frames[-1].name}")
        for name in ["energy", "flux"]:
            a, b = (vtk_to_numpy(d.GetPointData().GetArray(name)) for d in (data, last))
            self.assertTrue((a == b).all(), name)
        self.assertEqual((self.folder / "l.pvd").read_text().count("<DataSet"), len(frames))
