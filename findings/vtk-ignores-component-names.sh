#!/usr/bin/env bash
# Believed: a VTK array whose six components are named XX YY ZZ YZ XZ XY (the order of Voigt's notation) is that tensor: the names are
#           kept in files and shown by viewers.
# So:       the filters go by position alone, XX YY ZZ XY YZ XZ, and compute with other tensors than the names say.
# Matters:  principal values, glyphs and invariants come out wrong and look plausible; the trace, which does not depend on the last three,
#           is right.
set -euo pipefail
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check vtk==9.7.2 numpy==2.4.6
env/bin/python - <<'PY'
import sys
import numpy as np
import vtk

VOIGT = ["XX", "YY", "ZZ", "YZ", "XZ", "XY"]
VTK = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]
tensor = np.array([[5.0, 2.0, 0.0], [2.0, -1.0, 0.0], [0.0, 0.0, 0.0]])
right = np.sort(np.linalg.eigvalsh(tensor))


def principal_values(names):
    array = vtk.vtkDoubleArray()
    array.SetName("stress")
    array.SetNumberOfComponents(6)
    for i, name in enumerate(names):
        array.SetComponentName(i, name)
    array.InsertNextTuple([tensor["XYZ".index(a), "XYZ".index(b)] for a, b in names])
    points = vtk.vtkPoints()
    points.InsertNextPoint(0, 0, 0)
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.GetPointData().SetTensors(array)
    # Through a file and back, which keeps the names.
    writer, reader = vtk.vtkXMLPolyDataWriter(), vtk.vtkXMLPolyDataReader()
    for step in (writer, reader):
        step.SetFileName("stress.vtp")
    writer.SetInputData(data)
    writer.Write()
    reader.Update()
    kept = [reader.GetOutput().GetPointData().GetArray("stress").GetComponentName(i) for i in range(6)]
    wanted = vtk.vtkTensorPrincipalInvariants()
    wanted.SetInputConnection(reader.GetOutputPort())
    wanted.Update()
    found = wanted.GetOutput().GetPointData()
    return kept, np.sort([found.GetArray(f"stress - Sigma {i}").GetValue(0) for i in (1, 2, 3)])


print("VTK", vtk.vtkVersion.GetVTKVersion(), "- principal values by hand:", right.round(3).tolist())
wrong = {}
for what, names in [("VTK's order", VTK), ("Voigt's order", VOIGT)]:
    kept, values = principal_values(names)
    print(f"{what}: names read {kept}, principal values {values.round(3).tolist()}")
    wrong[what] = kept == names and not np.allclose(values, right)
sys.exit(0 if wrong == {"VTK's order": False, "Voigt's order": True} else 1)
PY
