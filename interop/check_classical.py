"""Lines, exponents and ridges as the vtk package reads them, over the tensors that `convert` writes."""

import numpy as np
import vtk
from check_vtk_places import READERS, points_of
from common import Checks
from vtk.util.numpy_support import vtk_to_numpy


def arrays(data):
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


class ClassicalChecks(Checks):
    def read(self, name):
        reader = READERS[name.rsplit(".", 1)[1]]()
        reader.SetFileName(str(self.path(name)))
        reader.Update()
        self.assertEqual(reader.GetErrorCode(), 0)
        return reader.GetOutput()

    def lines_of(self, data):
        points, ids = points_of(data), vtk.vtkIdList()
        data.GetLines().InitTraversal()
        while data.GetLines().GetNextCell(ids):
            yield points[[ids.GetId(i) for i in range(ids.GetNumberOfIds())]]

    def test_lines_run_along_the_tensors_beneath_them(self):
        self.run_program("convert", "wedge:size=21", self.path("t.vti"))
        self.run_program("lines", "wedge:size=21", "--step", "0.05", "-o", self.path("l.vtp"))
        data, tensors = self.read("l.vtp"), self.read("t.vti")
        self.assertEqual(set(arrays(data.GetPointData())), {"values"})
        self.assertEqual(set(arrays(data.GetCellData())), {"family", "ends"})
        middles, ways = [], []
        for line in self.lines_of(data):
            middles.append((line[1:] + line[:-1]) / 2.0)
            ways.append(line[1:] - line[:-1])
        middles, ways = np.concatenate(middles), np.concatenate(ways)
        self.assertGreater(len(middles), 1000)
        probes = vtk.vtkPoints()
        for p in middles:
            probes.InsertNextPoint(*p)
        at = vtk.vtkPolyData()
        at.SetPoints(probes)
        probe = vtk.vtkProbeFilter()
        probe.SetInputData(at)
        probe.SetSourceData(tensors)
        probe.Update()
        found = vtk_to_numpy(probe.GetOutput().GetPointData().GetTensors()).reshape(-1, 3, 3)[:, :2, :2]
        axes = np.linalg.eigh(found)[1][:, :, 1]
        size = np.linalg.norm(ways[:, :2], axis=1)
        # The steps that reach a border are very short; their direction is rounding.
        long = size > 0.01
        across = np.abs(axes[:, 0] * ways[:, 1] - axes[:, 1] * ways[:, 0])[long] / size[long]
        self.assertLess(np.quantile(across, 0.99), 0.01)

    def test_exponents_cover_the_field_and_ridges_lie_on_them(self):
        self.run_program("ftle", "inverse:size=31", "--length", "5", "-o", self.path("f.vti"))
        image = self.read("f.vti")
        self.assertEqual(image.GetDimensions(), (61, 61, 1))
        self.assertEqual(image.GetBounds()[:4], (0.0, 30.0, 0.0, 30.0))
        self.run_program("ridges", self.path("f.vti"), "--array", "FTLE", "-o", self.path("r.vtp"))
        ridges = self.read("r.vtp")
        points = points_of(ridges)
        on_cross = (np.abs(points[:, 0] - 15.0) < 0.05) | (np.abs(points[:, 1] - 15.0) < 0.05)
        self.assertGreater(on_cross.mean(), 0.3)
        self.assertEqual(set(arrays(ridges.GetPointData())), {"value", "strength"})

    def test_surfaces_close_over_the_directions(self):
        self.run_program("ltg", "inverse:size=15", "--directions", "16", "-o", self.path("g.vti"))
        self.run_program("ridges", self.path("g.vti"), "-o", self.path("s.vtp"))
        surface = self.read("s.vtp")
        self.assertGreater(surface.GetNumberOfPolys(), 100)
        bounds = surface.GetBounds()
        self.assertTrue(1.0 <= bounds[0] and bounds[1] <= 13.0 and 0.0 <= bounds[4] and bounds[5] <= 16.0)
        self.assertEqual(set(arrays(surface.GetCellData())), {"piece"})

    def test_skeletons_are_points_and_lines(self):
        self.run_program("topology", "trisector:size=21", "-o", self.path("k.vtp"))
        skeleton = self.read("k.vtp")
        self.assertEqual((skeleton.GetNumberOfVerts(), skeleton.GetNumberOfLines()), (1, 3))
        self.assertEqual(tuple(skeleton.GetPoint(0)), (10.0, 10.0, 0.0))
        self.assertEqual(list(arrays(skeleton.GetCellData())["half_turns"]), [-1, -1, -1, -1])
