#!/usr/bin/env bash
# Believed: ITK knows both formats, so what it reads from a tensor NRRD and writes as NIfTI is the same field: positions go from the world
#           to the left and posterior to the one to the right and anterior, and so do the tensors, turned by the measurement frame.
# So:       positions are changed, components are only put into the standard's order, number by number. The measurement frame is not
#           applied and not kept. The intent is SYMMATRIX, but its parameter, the size of the matrices, stays 0.
# Matters:  the file cannot say which axes its tensors are along, and by the numbers they are mirrored or turned against the positions. A
#           reader that goes by the standard's parameter finds matrices of size 0.
set -euo pipefail
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check itk-io==5.4.7 pynrrd==1.1.3 nibabel==5.4.2 numpy==2.4.6
env/bin/python -W ignore - <<'PY'
import sys
import itk
import nibabel
import nrrd
import numpy as np

SIZE = (2, 3, 4)
ENTRIES = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]
angle = np.radians(40)
frame = np.array([[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
measured = np.array([[3.0, 0.5, 0.25], [0.5, 2.0, 0.125], [0.25, 0.125, 1.0]])
six = np.float32([measured[e] for e in ENTRIES])
header = {
    "kinds": ["3D-symmetric-matrix", "space", "space", "space"],
    "space": "left-posterior-superior",
    "space directions": np.vstack([[np.nan] * 3, np.eye(3)]),
    "space origin": [10.0, 20.0, 30.0],
    # One axis of the frame a row.
    "measurement frame": frame,
    "encoding": "raw",
}
nrrd.write("tensors.nrrd", np.tile(six[:, None, None, None], (1, *SIZE)), header)

# ITK's own reader and writer, as its ImageFileReader and ImageFileWriter call them.
reader, writer = itk.NrrdImageIO.New(), itk.NiftiImageIO.New()
reader.SetFileName("tensors.nrrd")
reader.ReadImageInformation()
region = itk.ImageIORegion(3)
for a in range(3):
    region.SetIndex(a, 0)
    region.SetSize(a, reader.GetDimensions(a))
    writer.SetNumberOfDimensions(3)
    writer.SetDimensions(a, reader.GetDimensions(a))
    writer.SetSpacing(a, reader.GetSpacing(a))
    writer.SetOrigin(a, reader.GetOrigin(a))
    writer.SetDirection(a, reader.GetDirection(a))
buffer = itk.image_from_array(np.zeros((*SIZE[::-1], 6), "f4"), ttype=itk.VectorImage[itk.F, 3])
reader.SetIORegion(region)
reader.Read(buffer.GetBufferPointer())
writer.SetMetaDataDictionary(reader.GetMetaDataDictionary())
writer.SetIORegion(region)
writer.SetNumberOfComponents(reader.GetNumberOfComponents())
writer.SetComponentType(reader.GetComponentType())
writer.SetPixelType(reader.GetPixelType())
writer.SetFileName("tensors.nii")
writer.Write(buffer.GetBufferPointer())
pixel = reader.GetPixelTypeAsString(reader.GetPixelType())
print("ITK", itk.Version.GetITKVersion(), "- pixels read:", pixel)

found = nibabel.load("tensors.nii")
numbers = np.asarray(found.dataobj)[0, 0, 0, 0]
intent, size = int(found.header["intent_code"]), float(found.header["intent_p1"])
lower = np.array([measured[e] for e in [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)]])
world = frame.T @ measured @ frame
turned = np.diag([-1, -1, 1]) @ world @ np.diag([-1, -1, 1])
print("position of the first voxel: NRRD", header["space origin"], "to the left and posterior; NIfTI", found.affine[:3, 3].tolist())
print("directions of the NIfTI voxel axes:", np.diag(found.affine)[:3].tolist())
print("numbers in NRRD:", six.tolist())
print("numbers in NIfTI:", numbers.tolist(), "- the same in the standard's order:", np.allclose(numbers, lower))
entries = [turned[e].round(3).item() for e in [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)]]
print("turned into the NIfTI file's world they would be:", entries)
print(f"intent {intent}, size of the matrices {size:g}; header extensions: {len(found.header.extensions)}")
as_said = np.allclose(numbers, lower) and (intent, size) == (1005, 0.0) and not found.header.extensions
as_said &= np.allclose(found.affine[:3, 3], [-10, -20, 30]) and not np.allclose(numbers, entries)
sys.exit(0 if as_said else 1)
PY
