"""Whole volumes that tigereye wrote, read by the programs that the formats belong to.

Each function gives positions (N, 3), tensors (N, 3, 3) along the axes of the world of these positions, and whether that
world is the patient's, to the right, anterior and superior; else it is the file's own.
"""

import meshio
import nibabel
import nrrd
import numpy as np
import vtk
from common import full_tensors, turned
from vtk.util.numpy_support import vtk_to_numpy

# What leads from the worlds of NRRD files to the right, anterior and superior.
SPACES = {
    "right-anterior-superior": (1.0, 1.0, 1.0),
    "left-anterior-superior": (-1.0, 1.0, 1.0),
    "left-posterior-superior": (-1.0, -1.0, 1.0),
    None: (1.0, 1.0, 1.0),
}


def points_of(data):
    return np.array([data.GetPoint(i) for i in range(data.GetNumberOfPoints())])


def _vtk(reader, file):
    reader.SetFileName(str(file))
    reader.Update()
    data = reader.GetOutput()
    active = data.GetPointData().GetTensors()
    if active is None:
        raise AssertionError(f"{file.name}: VTK finds no tensors")
    return points_of(data), vtk_to_numpy(active).reshape(-1, 3, 3), False


def read_vti(file):
    return _vtk(vtk.vtkXMLImageDataReader(), file)


def read_vtp(file):
    return _vtk(vtk.vtkXMLPolyDataReader(), file)


def read_vtk(file):
    return _vtk(vtk.vtkDataSetReader(), file)


def read_meshio(file):
    """meshio takes a structured file apart into points and cells; it has no `.vti`."""
    found = meshio.read(file, file_format="vtk")
    return found.points, found.point_data["Tensors"].reshape(-1, 3, 3), False


def positions_of_affine(size, affine):
    """(nx, ny, nz, 3)"""
    return np.moveaxis(np.indices(size), 0, -1) @ affine[:3, :3].T + affine[:3, 3]


def read_nii(file):
    """tigereye writes the standard's matrices, along the voxel axes."""
    found = nibabel.load(file)
    values = np.asarray(found.dataobj)[:, :, :, 0]
    full = full_tensors(values, "dipy") if values.shape[-1] == 6 else values.reshape(*values.shape[:3], 3, 3)
    axes = found.affine[:3, :3] / np.linalg.norm(found.affine[:3, :3], axis=0)
    positions = positions_of_affine(values.shape[:3], found.affine)
    return positions.reshape(-1, 3), turned(full, axes).reshape(-1, 3, 3), True


def read_nrrd(file):
    values, header = nrrd.read(str(file))
    signs = np.array(SPACES[header.get("space")])
    # The first number is the confidence.
    values = np.moveaxis(values[1:], 0, -1)
    full = full_tensors(values, "fsl") if values.shape[-1] == 6 else values.reshape(*values.shape[:3], 3, 3)
    # pynrrd gives the frame's axes as rows.
    frame = np.diag(signs) @ np.asarray(header.get("measurement frame", np.eye(3))).T
    affine = np.eye(4)
    affine[:3, :3] = np.diag(signs) @ np.asarray(header["space directions"])[1:].T
    affine[:3, 3] = signs * header["space origin"]
    positions = positions_of_affine(values.shape[:3], affine)
    return positions.reshape(-1, 3), turned(full, frame).reshape(-1, 3, 3), True


# The ending of a whole volume and who reads it.
OUTPUTS = [
    ("vti", read_vti),
    ("vtp", read_vtp),
    ("vtk", read_vtk),
    ("vtk", read_meshio),
    ("nii", read_nii),
    ("nii.gz", read_nii),
    ("nrrd", read_nrrd),
]
