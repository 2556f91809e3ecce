"""Fields of nibabel, pyvista and xarray, which count rows from below."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._tensors import Tensors

__all__ = ["from_nibabel", "from_pyvista", "from_xarray"]


def from_nibabel(image: Any, *, slice: int, order: str = "xx,xy,yy,xz,yz,zz", name: str = "nibabel") -> Tensors:
    """An axial slice of a tensor image of nibabel, with its affine.

    Parameters
    ----------
    image : nibabel image, shape (X, Y, Z, 6) or (X, Y, Z, 1, 6)
        Six components a voxel along the voxel axes; dipy's lower triangle by default.
    slice : int
        Index along the third voxel axis.
    order : str
        Names of the six components.
    name : str
        Title of pictures.

    Returns
    -------
    Tensors
        The tensors' x and y parts: the first voxel axis to the right, the second one up.
    """
    data: NDArray[Any] = np.asanyarray(image.dataobj)
    if data.ndim == 5 and data.shape[3] == 1:
        data = data[:, :, :, 0]
    names = [part.strip() for part in order.split(",")]
    if data.ndim != 4 or data.shape[3] != len(names) or not {"xx", "xy", "yy"} <= set(names):
        raise ValueError(f"shape {data.shape}, order {order!r}: expected (X, Y, Z, N) and N names with xx, xy and yy")
    affine: NDArray[np.float64] = np.asarray(image.affine, dtype=float)
    plane = data[:, :, slice][:, :, [names.index(c) for c in ("xx", "xy", "yy")]].swapaxes(0, 1)
    spacing = np.linalg.norm(affine[:3, :2], axis=0)
    corner = affine[:3, 3] + affine[:3, 2] * (slice % data.shape[2])
    right, up = affine[:3, 0] / spacing[0], affine[:3, 1] / spacing[1]
    geometry: Any = (tuple(corner), tuple(right), tuple(up), tuple(spacing))
    return Tensors(plane, order="xx,xy,yy", origin="lower", name=name, geometry=geometry)


def from_pyvista(image: Any, array: str, *, name: str = "pyvista") -> Tensors:
    """A flat image of pyvista, with origin and spacing.

    Parameters
    ----------
    image : pyvista.ImageData, dimensions (W, H, 1)
        Point data; y runs upwards.
    array : str
        A point array of 3 (xx, xy, yy), 4 (xx, xy, yx, yy), 6 (VTK's xx, yy, zz, xy, yz, xz) or 9 components.
    name : str
        Title of pictures.

    Returns
    -------
    Tensors
        The x and y parts.
    """
    width, height, depth = image.dimensions
    if depth != 1:
        raise ValueError(f"dimensions {image.dimensions}: expected one layer, see ImageData.slice or extract_subset")
    values: NDArray[Any] = np.asarray(image.point_data[array])
    places = {3: [0, 1, 1, 2], 4: [0, 1, 2, 3], 6: [0, 3, 3, 1], 9: [0, 1, 3, 4]}
    count = values.shape[1] if values.ndim == 2 else 1
    if count not in places:
        raise ValueError(f"{array}: {count} components: expected 3, 4, 6 or 9")
    plane = values.reshape(height, width, count)[:, :, places[count]]
    matrix: NDArray[np.float64] = np.asarray(image.direction_matrix, dtype=float)
    geometry: Any = (tuple(image.origin), tuple(matrix[:, 0]), tuple(matrix[:, 1]), tuple(image.spacing[:2]))
    return Tensors(plane, order="xx,xy,yx,yy", origin="lower", name=name, geometry=geometry)


def from_xarray(array: Any, *, x: str = "x", y: str = "y", order: str | None = None, name: str | None = None) -> Tensors:
    """A labelled array, with its coordinates.

    Parameters
    ----------
    array : xarray.DataArray
        Dimensions `y`, `x` and the components, one dimension of 3 or 4 or two of 2, in any order of the first two.
        Where the coordinate `y` grows, its first row is the lower one; where it falls, the upper one. Without it, row 0
        is on top.
    x, y : str
        Names of the dimensions.
    order : str, optional
        As that of :class:`Tensors`.
    name : str, optional
        Title of pictures.

    Returns
    -------
    Tensors
        The field, x to the right and y up.
    """
    others = [dim for dim in array.dims if dim not in (x, y)]
    plane = array.transpose(y, x, *others)
    values: NDArray[Any] = plane.values
    origin, geometry = "upper", None
    if x in plane.coords and y in plane.coords:
        xs, ys = np.asarray(plane[x], dtype=float), np.asarray(plane[y], dtype=float)
        dx, dy = _step(xs, x), _step(ys, y)
        origin = "lower" if dy > 0 else "upper"
        if dx < 0:
            values = values[:, ::-1]
        geometry = ((xs.min(), ys.min(), 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (abs(dx), abs(dy)))
    title = name or str(array.name or "xarray")
    return Tensors(values, order=order, origin=origin, name=title, geometry=geometry)


def _step(values: NDArray[np.float64], name: str) -> float:
    """Distance of equidistant coordinates."""
    steps = np.diff(values)
    if len(steps) == 0:
        return 1.0
    if steps[0] == 0 or not np.allclose(steps, steps[0], rtol=1e-6, atol=0.0):
        raise ValueError(f"{name}: expected coordinates at equal distances")
    return float(steps[0])
