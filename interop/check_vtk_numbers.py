"""VTK's files with numbers that faults would show in: asymmetric tensors, both signs, the ends of every number type.

`check_vtk.py` goes through the encodings with small whole numbers; these checks go through the numbers. What counts as
right is what VTK itself reads back, so digits that its text files lose are nobody's fault here.
"""

import itertools

import numpy as np
import vtk
from check_vtk import COMPRESSORS, ENCODINGS, TYPES, H, W, array, configured, image, picture
from common import Checks, full_tensors, six, tensors
from vtk.util.numpy_support import vtk_to_numpy

# tigereye computes in double precision, which holds whole numbers up to here.
WHOLE = 2**53


def every_size(kind, shape):
    """Numbers of a type over its whole range, the smallest and the largest among them."""
    generator = np.random.default_rng(len(kind))
    numpy_type = np.dtype(kind.lower())
    if numpy_type.kind == "f":
        # Squares stay finite, and so do the norms that VTK writes beside the numbers.
        decades = 15 if kind == "Float32" else 140
        values = generator.normal(size=shape) * 10.0 ** generator.uniform(-decades, decades, size=shape)
    else:
        limits = np.iinfo(numpy_type)
        low, high = max(int(limits.min), -WHOLE), min(int(limits.max), WHOLE)
        values = generator.integers(low, high, size=shape, endpoint=True)
        values.flat[0], values.flat[1] = low, high
    return values.astype(numpy_type)


def read_back(reader, path):
    """The tensors that VTK reads, one row a point: nine components, or six."""
    # Norms of large whole numbers overflow in VTK's writer, and its reader complains of them; the numbers are right.
    vtk.vtkObject.GlobalWarningDisplayOff()
    try:
        reader.SetFileName(path)
        reader.Update()
    finally:
        vtk.vtkObject.GlobalWarningDisplayOn()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("Tensors"))


def on_grid(values):
    """Nine or six components a point as tensors (H, W, 3, 3), the upper rows last."""
    values = values.astype(float)
    full = values.reshape(-1, 3, 3) if values.shape[-1] == 9 else full_tensors(values, "vtk")
    return full.reshape(H, W, 3, 3)


def lattice(values, kind=vtk.VTK_DOUBLE, places=vtk.VTK_FLOAT):
    """Poly data whose points form a grid, each point a vertex."""
    data = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetDataType(places)
    cells = vtk.vtkCellArray()
    for i, (y, x) in enumerate(itertools.product(range(H), range(W))):
        points.InsertNextPoint(1.0 + 0.5 * x, -2.0 + 0.25 * y, 0.5)
        cells.InsertNextCell(1, [i])
    data.SetPoints(points)
    data.SetVerts(cells)
    data.GetPointData().AddArray(array(values, kind))
    data.GetPointData().SetActiveTensors("Tensors")
    return data


class Numbers(Checks):
    def same(self, file, points, what, *options):
        found = self.plane(file, *options)
        expected = picture(points)
        self.assertEqual(found.dtype, np.float64, what)
        self.assertEqual(found.shape, expected.shape, what)
        wrong = np.argwhere(found != expected)
        self.assertEqual(len(wrong), 0, f"{what}: {len(wrong)} components differ, the first at {wrong[:1].tolist()}")

    def test_every_type_over_its_range(self):
        for kind, encoding, compressor, big in itertools.product(TYPES, ENCODINGS, COMPRESSORS, [False, True]):
            what = f"{kind}, {encoding}, {compressor}, {'big' if big else 'little'}"
            with self.subTest(what):
                values = every_size(kind, (W * H, 9))
                data = image(values, TYPES[kind])
                configured(vtk.vtkXMLImageDataWriter(), data, self.path("a.vti"), encoding, compressor, True, big)
                back = read_back(vtk.vtkXMLImageDataReader(), self.path("a.vti"))
                digits = 1e-6 if encoding == "ascii" else 0.0
                self.assertTrue(np.allclose(back, values, digits, 0.0), f"{what}: VTK does not read what it wrote")
                self.same("a.vti", on_grid(back), what)

    def test_asymmetric_tensors_in_every_encoding(self):
        values = tensors((H, W), symmetric=False).reshape(-1, 9)
        for kind, encoding, compressor, wide, big in itertools.product(
            ["Float32", "Float64"], ENCODINGS, COMPRESSORS, [False, True], [False, True]
        ):
            what = f"{kind}, {encoding}, {compressor}, {'UInt64' if wide else 'UInt32'}, {'big' if big else 'little'}"
            with self.subTest(what):
                stored = values.astype(kind.lower())
                data = image(stored, TYPES[kind])
                configured(vtk.vtkXMLImageDataWriter(), data, self.path("a.vti"), encoding, compressor, wide, big)
                self.same("a.vti", on_grid(values), what)

    def test_six_components_in_every_encoding(self):
        values = six(tensors((H, W)), "vtk").reshape(-1, 6)
        for kind, encoding, compressor, wide, big in itertools.product(
            ["Int16", "Float32"], ENCODINGS, COMPRESSORS, [False, True], [False, True]
        ):
            what = f"{kind}, {encoding}, {compressor}, {'UInt64' if wide else 'UInt32'}, {'big' if big else 'little'}"
            with self.subTest(what):
                stored = (64 * values if kind == "Int16" else values).astype(kind.lower())
                data = image(stored, TYPES[kind])
                # VTK takes six components for tensors too.
                self.assertGreaterEqual(data.GetPointData().SetActiveTensors("Tensors"), 0)
                configured(vtk.vtkXMLImageDataWriter(), data, self.path("a.vti"), encoding, compressor, wide, big)
                self.same("a.vti", on_grid(stored), what)

    def test_other_arrays_before_the_tensors(self):
        """The tensors are not the first array, so that offsets and skipped blocks matter."""
        values = tensors((H, W), symmetric=False).reshape(-1, 9)
        for encoding, compressor, wide in itertools.product(ENCODINGS, COMPRESSORS, [False, True]):
            what = f"{encoding}, {compressor}, {'UInt64' if wide else 'UInt32'}"
            with self.subTest(what):
                data = vtk.vtkImageData()
                data.SetDimensions(W, H, 1)
                numbers = np.arange(W * H)
                data.GetPointData().SetScalars(array(numbers.astype(np.uint8), vtk.VTK_UNSIGNED_CHAR, "numbers"))
                data.GetPointData().AddArray(array(np.zeros((W * H, 9)), name="Other"))
                data.GetPointData().AddArray(array(values))
                data.GetPointData().SetActiveTensors("Tensors")
                words = vtk.vtkStringArray()
                words.SetName("words")
                words.InsertNextValue("a text, \"quoted\" & <marked>")
                data.GetFieldData().AddArray(words)
                configured(vtk.vtkXMLImageDataWriter(), data, self.path("a.vti"), encoding, compressor, wide, False)
                self.same("a.vti", on_grid(values), what)
                self.same("a.vti", np.zeros((H, W, 3, 3)), what, "--array", "Other")

    def test_blocks_without_a_rest(self):
        """Data that fill their last block exactly; the header then gives 0 as its size."""
        values = tensors((8, 8), symmetric=False, seed=4)
        for encoding, compressor, wide in itertools.product(ENCODINGS[1:], ["zlib", "lz4"], [False, True]):
            with self.subTest(f"{encoding}, {compressor}, {'UInt64' if wide else 'UInt32'}"):
                data = vtk.vtkImageData()
                data.SetDimensions(8, 8, 1)
                data.GetPointData().AddArray(array(values.reshape(-1, 9)))
                data.GetPointData().SetActiveTensors("Tensors")
                self.assertEqual(values.size * 8 % 256, 0, "blocks of 256 bytes")
                configured(vtk.vtkXMLImageDataWriter(), data, self.path("a.vti"), encoding, compressor, wide, False)
                self.assertTrue((self.plane("a.vti") == picture(values)).all())

    def test_poly_data_types_and_components(self):
        for kind, components, places, encoding, big in itertools.product(
            ["Int8", "UInt16", "Int64", "Float32", "Float64"],
            [6, 9],
            [vtk.VTK_FLOAT, vtk.VTK_DOUBLE],
            ["inline", "appended raw"],
            [False, True],
        ):
            what = f"{kind}, {components} components, {encoding}, {'big' if big else 'little'}"
            with self.subTest(what):
                values = every_size(kind, (W * H, components))
                data = lattice(values, TYPES[kind], places)
                configured(vtk.vtkXMLPolyDataWriter(), data, self.path("a.vtp"), encoding, "zlib", True, big)
                self.same("a.vtp", on_grid(values), what)

    def test_legacy_types_and_components(self):
        for kind, components, text, version in itertools.product(TYPES, [6, 9], [True, False], [42, 51]):
            what = f"{kind}, {components} components, {'ASCII' if text else 'BINARY'}, version {version}"
            with self.subTest(what):
                data = image(every_size(kind, (W * H, components)), TYPES[kind])
                self.assertGreaterEqual(data.GetPointData().SetActiveTensors("Tensors"), 0)
                self.legacy(data, text, version)
                back = read_back(vtk.vtkStructuredPointsReader(), self.path("a.vtk"))
                self.same("a.vtk", on_grid(back), what)

    def test_legacy_field_arrays(self):
        """Arrays that are not the active tensors stand in a FIELD, whatever came before them."""
        values = tensors((H, W), symmetric=False).reshape(-1, 9)
        for text, version in itertools.product([True, False], [42, 51]):
            what = f"{'ASCII' if text else 'BINARY'}, version {version}"
            with self.subTest(what):
                data = vtk.vtkImageData()
                data.SetDimensions(W, H, 1)
                data.GetPointData().SetScalars(array(np.arange(W * H, dtype=np.float32), vtk.VTK_FLOAT, "numbers"))
                data.GetPointData().AddArray(array(values))
                self.legacy(data, text, version)
                self.same("a.vtk", on_grid(values), what)

    def legacy(self, data, text, version):
        writer = vtk.vtkDataSetWriter()
        writer.SetFileName(self.path("a.vtk"))
        writer.SetInputData(data)
        writer.SetFileTypeToASCII() if text else writer.SetFileTypeToBinary()
        writer.SetFileVersion(version)
        self.assertEqual(writer.Write(), 1)

    def test_lzma_is_refused_by_convert(self):
        """Both kinds of file, in every encoding that is compressed; nothing is written."""
        values = tensors((H, W)).reshape(-1, 9)
        for (file, writer, data), encoding in itertools.product(
            [
                ("a.vti", vtk.vtkXMLImageDataWriter, image(values)),
                ("a.vtp", vtk.vtkXMLPolyDataWriter, lattice(values)),
            ],
            ENCODINGS[1:],
        ):
            with self.subTest(f"{file}, {encoding}"):
                out = writer()
                out.SetFileName(self.path(file))
                out.SetInputData(data)
                out.SetCompressorTypeToLZMA()
                out.SetDataModeToBinary() if encoding == "inline" else out.SetDataModeToAppended()
                out.SetEncodeAppendedData(encoding == "appended base64")
                self.assertEqual(out.Write(), 1)
                self.assertIn("vtkLZMADataCompressor", self.run_program("convert", file, "b.npy", code=2))
                self.assertFalse((self.folder / "b.npy").exists(), "a refused file leaves an output")
