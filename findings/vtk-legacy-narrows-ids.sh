#!/usr/bin/env bash
# Believed: an array of ids (vtkIdType) is written to a legacy VTK file as wide as it is in memory, 64 bits, at least by the newer
#           version 5.1, which has a 64-bit type for its cells.
# So:       both versions write 32 bits under the name vtkIdType, in binary files and in text. An id of 2^31 comes back negative and
#           2^32 + 5 as 5, without a word. Arrays of the type vtktypeint64 beside it keep their numbers.
# Matters:  a reader that counts eight bytes an id loses its place, and with it every array behind, tensors among them.
set -euo pipefail
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check vtk==9.7.2 numpy==2.4.6
env/bin/python - <<'PY'
import sys
import vtk

NUMBERS = [0, 7, 2**31 - 1, 2**31, 2**32 + 5, 2**40]
NARROWED = [0, 7, 2**31 - 1, -(2**31), 5, 0]

data = vtk.vtkImageData()
data.SetDimensions(len(NUMBERS), 1, 1)
for kind, name in [(vtk.vtkIdTypeArray, "ids"), (vtk.vtkTypeInt64Array, "numbers")]:
    array = kind()
    array.SetName(name)
    for number in NUMBERS:
        array.InsertNextValue(number)
    data.GetPointData().AddArray(array)
print("VTK", vtk.vtkVersion.GetVTKVersion(), "- bytes of an id in memory:", data.GetPointData().GetArray("ids").GetDataTypeSize())

as_said = True
for version in (42, 51):
    for binary in (True, False):
        writer = vtk.vtkDataSetWriter()
        writer.SetFileName("ids.vtk")
        writer.SetInputData(data)
        writer.SetFileVersion(version)
        writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
        success = writer.Write()
        content = open("ids.vtk", "rb").read()
        start = content.index(b"vtkIdType\n") + len(b"vtkIdType\n")
        length = content.index(b"numbers 1") - start
        reader = vtk.vtkDataSetReader()
        reader.SetFileName("ids.vtk")
        reader.Update()
        points = reader.GetOutput().GetPointData()
        found = {n: [points.GetArray(n).GetValue(i) for i in range(len(NUMBERS))] for n in ("ids", "numbers")}
        print(f"version {version}, {'binary' if binary else 'text'}: success {success}, ids {found['ids']}, numbers {found['numbers']}")
        if binary:
            # A line ends the array.
            print(f"    {(length - 1) / len(NUMBERS):g} bytes an id")
            as_said &= length - 1 == 4 * len(NUMBERS)
        as_said &= success == 1 and found == {"ids": NARROWED, "numbers": NUMBERS}
sys.exit(0 if as_said else 1)
PY
