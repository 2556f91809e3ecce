"""Results: small objects with an array, axes, provenance and a picture."""

from __future__ import annotations

import base64
import json
import os
import tempfile
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _native

if TYPE_CHECKING:
    from ._tensors import Tensors

_PICTURES = ("png", "svg", "pdf")


def write(path: str | os.PathLike[str], contents: bytes) -> None:
    """Replaces a file as a whole: at any time there is either the older one or the whole new one."""
    folder = os.path.dirname(os.path.abspath(path))
    handle, name = tempfile.mkstemp(dir=folder, prefix=".tigereye-")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(contents)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)
        os.replace(name, path)
    except BaseException:
        os.unlink(name)
        raise


class Drawn:
    """What all results have in common: a picture, files and a provenance."""

    _formats: tuple[str, ...] = _PICTURES

    def __init__(self, tensors: Tensors | None, story: str) -> None:
        self.tensors = tensors
        self._story = story

    def _encoded(self, format: str) -> bytes:
        raise NotImplementedError

    @property
    def provenance(self) -> dict[str, Any]:
        """Version, call, parameters and hash of the input."""
        found: dict[str, Any] = json.loads(self._story) if self._story else {}
        return found

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a file; its extension chooses the format.

        Parameters
        ----------
        path : path_like
            The file, which is replaced as a whole.

        Raises
        ------
        ValueError
            An extension of no format that the result has.
        OSError
            A file that cannot be written.
        """
        format = os.path.splitext(os.fspath(path))[1].lstrip(".").lower()
        if format not in self._formats:
            known = ", ".join(f".{name}" for name in self._formats)
            raise ValueError(f"{os.fspath(path)}: unknown extension: expected one of {known}")
        write(path, self._encoded(format))

    def _repr_png_(self) -> bytes:
        return self._encoded("png")

    def _repr_html_(self) -> str:
        picture = base64.b64encode(self._encoded("png")).decode("ascii")
        return f'<img alt="{type(self).__name__}" src="data:image/png;base64,{picture}">'

    def plot(self, ax: Any = None) -> Any:
        """Draw the result with matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; the current axes by default.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, in cells, row 0 on top.
        """
        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.gca()
        self._draw(ax)
        return ax

    def _draw(self, ax: Any) -> None:
        raise NotImplementedError


class _WithArray(Drawn):
    """A result with one array, which numpy reads without copying."""

    dims: tuple[str, ...] = ()
    unit: str = ""

    def __init__(self, tensors: Tensors | None, story: str, values: NDArray[np.float64]) -> None:
        super().__init__(tensors, story)
        values.flags.writeable = False
        #: The numbers, read-only.
        self.values = values

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        if copy:
            return np.array(self.values, dtype=dtype)
        return self.values if dtype is None else self.values.astype(dtype, copy=False)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the array."""
        return self.values.shape

    def coords(self) -> dict[str, NDArray[np.float64]]:
        """Coordinates of the axes: degrees of directions, positions of cells (y up)."""
        height, width = (self.shape[self.dims.index(d)] for d in ("y", "x"))
        geometry = self.tensors.geometry if self.tensors is not None else None
        dx, dy = geometry[3] if geometry is not None else (1.0, 1.0)
        x0, y0 = 0.0, 0.0
        if geometry is not None:
            corner, right, up, _ = geometry
            x0 = float(np.dot(corner, right))
            y0 = float(np.dot(corner, up))
        x = x0 + dx * np.arange(width, dtype=np.float64)
        y = y0 + dy * np.arange(height, dtype=np.float64)[::-1]
        return {"y": y, "x": x}

    def to_xarray(self) -> Any:
        """The array with its axes as an ``xarray.DataArray``; y is in the order of the rows, from top to bottom."""
        import xarray

        attrs = {"units": self.unit, "provenance": self._story}
        coords = {name: (name, values) for name, values in self.coords().items()}
        return xarray.DataArray(self.values, dims=self.dims, coords=coords, name=type(self).__name__, attrs=attrs)

    def _layers(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Layers as (T, H, W) and the third coordinate of each."""
        return self.values[np.newaxis], np.zeros(1)

    def to_pyvista(self) -> Any:
        """The array as a ``pyvista.ImageData``, y upwards, placed as the input; layers lie along its third axis."""
        import pyvista

        layers, _ = self._layers()
        count, height, width = layers.shape
        geometry = self.tensors.geometry if self.tensors is not None else None
        image = pyvista.ImageData(dimensions=(width, height, count))
        if geometry is not None:
            corner, right, up, (dx, dy) = geometry
            image.spacing = (dx, dy, 1.0)
            image.origin = corner
            image.direction_matrix = np.column_stack([right, up, np.cross(right, up)])
        image.point_data[type(self).__name__] = layers[:, ::-1].ravel()
        return image

    def _draw(self, ax: Any) -> None:
        layers, _ = self._layers()
        drawn = ax.imshow(layers.mean(axis=0), origin="upper")
        ax.figure.colorbar(drawn, ax=ax, label=self.unit)


class Light(_WithArray):
    """Light of lamps: intensity, shape (H, W, S), in W/rad, for S directions counter-clockwise from +x."""

    dims = ("y", "x", "theta")
    unit = "W/rad"
    _formats = ("vti", "npy", *_PICTURES)

    def __init__(self, tensors: Tensors, native: _native.Light, picture: str) -> None:
        super().__init__(tensors, native.story, native.samples())
        self._native, self._picture = native, picture

    @property
    def energy(self) -> NDArray[np.float64]:
        """Energy of every cell, shape (H, W), in W."""
        return self._native.energy()

    @property
    def steps(self) -> int:
        """Steps taken."""
        return self._native.steps

    @property
    def converged(self) -> bool:
        """Whether the stopping rule was met, and not the limit on steps."""
        return self._native.converged

    @property
    def directions_deg(self) -> NDArray[np.float64]:
        """Directions of the last axis, degrees."""
        degrees: NDArray[np.float64] = np.arange(self.shape[2], dtype=np.float64) * (360.0 / self.shape[2])
        return degrees

    def coords(self) -> dict[str, NDArray[np.float64]]:
        return {**super().coords(), "theta": self.directions_deg}

    def _layers(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return self.energy[np.newaxis], np.zeros(1)

    def _encoded(self, format: str) -> bytes:
        return self._native.encoded(format, self._picture)

    def _draw(self, ax: Any) -> None:
        from matplotlib.colors import LogNorm

        energy = np.ma.masked_less_equal(self.energy, 0.0)
        norm = LogNorm() if energy.count() > 0 else None
        drawn = ax.imshow(energy, origin="upper", norm=norm)
        ax.figure.colorbar(drawn, ax=ax, label="energy of a cell / W")


class Gradient(_WithArray):
    """The light transport gradient, shape (T, H, W), in W/rad, for T directions."""

    dims = ("theta", "y", "x")
    unit = "W/rad"
    _formats = ("vti", "npy", *_PICTURES)

    def __init__(self, tensors: Tensors, native: _native.Gradient) -> None:
        super().__init__(tensors, native.story, native.values())
        self._native = native

    @property
    def slices(self) -> list[int]:
        """Sample indices of the first axis."""
        return self._native.slices

    @property
    def directions_deg(self) -> NDArray[np.float64]:
        """Directions of the first axis, degrees."""
        return np.array(self.slices) * (360.0 / self._native.directions)

    @property
    def sources(self) -> int:
        """Pulses solved."""
        return self._native.sources

    def mean(self) -> NDArray[np.float64]:
        """Mean over the slices, shape (H, W), in W/rad."""
        mean: NDArray[np.float64] = self.values.mean(axis=0)
        return mean

    def coords(self) -> dict[str, NDArray[np.float64]]:
        return {"theta": self.directions_deg, **super().coords()}

    def _layers(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return self.values, self.directions_deg

    def _encoded(self, format: str) -> bytes:
        return self._native.encoded(format)


class Sampled(_WithArray):
    """Samples of `lic` or `ftle`, shape (H n, W m); the first array is that of the result, `arrays` has all."""

    dims = ("y", "x")

    def __init__(self, tensors: Tensors, native: _native.Drawing, unit: str) -> None:
        arrays = native.arrays()
        super().__init__(tensors, native.story, arrays[0][1])
        self.unit = unit
        self._native = native
        self._formats = (native.extension, *_PICTURES)
        #: All arrays by name.
        self.arrays: dict[str, NDArray[np.float64]] = dict(arrays)
        #: Numbers about the result.
        self.summary: dict[str, Any] = json.loads(native.summary)

    def coords(self) -> dict[str, NDArray[np.float64]]:
        assert self.tensors is not None
        height, width = self.shape
        rows, columns = self.tensors.shape[:2]
        geometry = self.tensors.geometry
        dx, dy = geometry[3] if geometry is not None else (1.0, 1.0)
        x0, y0 = (0.0, 0.0)
        if geometry is not None:
            x0, y0 = float(np.dot(geometry[0], geometry[1])), float(np.dot(geometry[0], geometry[2]))
        x = x0 + dx * (columns - 1) * np.linspace(0.0, 1.0, width)
        y = y0 + dy * (rows - 1) * np.linspace(0.0, 1.0, height)[::-1]
        return {"y": y, "x": x}

    def _encoded(self, format: str) -> bytes:
        return self._native.encoded(format)


class Curves(Drawn):
    """Lines of `lines`, `topology` or outlines of `glyphs`."""

    def __init__(self, tensors: Tensors, native: _native.Drawing) -> None:
        super().__init__(tensors, native.story)
        self._native = native
        self._formats = (native.extension, *_PICTURES)
        #: Numbers about the result.
        self.summary: dict[str, Any] = json.loads(native.summary)

    @property
    def lines(self) -> list[NDArray[np.float64]]:
        """Points of each line, shape (N, 2): column and row in cells, row 0 on top."""
        return [points for points, _ in self._native.lines()]

    @property
    def families(self) -> list[str]:
        """The axis that each line follows."""
        return [family for _, family in self._native.lines()]

    def __len__(self) -> int:
        return len(self._native.lines())

    def _encoded(self, format: str) -> bytes:
        return self._native.encoded(format)

    def _draw(self, ax: Any) -> None:
        for points in self.lines:
            ax.plot(points[:, 0], points[:, 1], color="black", linewidth=0.7)
        assert self.tensors is not None
        height, width = self.tensors.shape[:2]
        ax.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5), aspect="equal")


class Ridge:
    """A ridge or contour.

    Attributes
    ----------
    points : ndarray, shape (N, 2)
        Column and row, cells, row 0 on top.
    closed : bool
        Whether the last point is connected with the first.
    value, strength : ndarray, shape (N,)
        Value and strength at every point; contours have no strength.
    """

    def __init__(
        self, points: NDArray[np.float64], closed: bool, value: NDArray[np.float64], strength: NDArray[np.float64]
    ) -> None:
        self.points, self.closed, self.value, self.strength = points, closed, value, strength

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self.points, dtype=dtype) if copy else np.asarray(self.points, dtype=dtype)

    def __repr__(self) -> str:
        return f"<tigereye.Ridge of {len(self.points)} points>"
