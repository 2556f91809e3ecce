#!/usr/bin/env bash
# Believed: VTK's legacy writer keeps where image data lie, or refuses what the format has no words for, as it cannot say directions.
# So:       it writes origin and spacing, leaves out the direction matrix and reports success. The data come back upright.
# Matters:  tensors are along the world's axes and are not turned, so in the file that comes back neither their places nor their
#           angle to the voxel axes are what they were. The XML format keeps both.
set -euo pipefail
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check vtk==9.7.2 numpy==2.4.6
env/bin/python - <<'PY'
import math
import sys
import vtk

angle = math.radians(30)
c, s = math.cos(angle), math.sin(angle)
data = vtk.vtkImageData()
data.SetDimensions(3, 2, 2)
data.SetDirectionMatrix([c, -s, 0, s, c, 0, 0, 0, 1])
tensors = vtk.vtkDoubleArray()
tensors.SetName("stress")
tensors.SetNumberOfComponents(9)
for _ in range(data.GetNumberOfPoints()):
    # Tension along the first voxel axis, in the world's axes.
    tensors.InsertNextTuple([c * c, c * s, 0, c * s, s * s, 0, 0, 0, 0])
data.GetPointData().SetTensors(tensors)

# What VTK itself says meanwhile goes to a file.
window = vtk.vtkFileOutputWindow()
window.SetFileName("said.txt")
vtk.vtkOutputWindow.SetInstance(window)
found = {}
for name, writer, reader in [
    ("legacy", vtk.vtkDataSetWriter(), vtk.vtkDataSetReader()),
    ("XML", vtk.vtkXMLImageDataWriter(), vtk.vtkXMLImageDataReader()),
]:
    writer.SetFileName(name)
    writer.SetInputData(data)
    success = writer.Write()
    reader.SetFileName(name)
    reader.Update()
    image = reader.GetOutput()
    point = [round(x, 3) for x in image.GetPoint(2)]
    tensor = [round(x, 3) for x in image.GetPointData().GetTensors().GetTuple(0)[:2]]
    found[name] = point
    print(f"{name}: success {success}, third point at {point}, xx and xy {tensor}")
try:
    said = open("said.txt").read()
except FileNotFoundError:
    said = ""
print("VTK", vtk.vtkVersion.GetVTKVersion(), "- third point at", [round(x, 3) for x in data.GetPoint(2)], "- warnings:", repr(said))
right = [round(2 * c, 3), round(2 * s, 3), 0.0]
sys.exit(0 if found == {"legacy": [2.0, 0.0, 0.0], "XML": right} and not said else 1)
PY
