"""Tensor fields: arrays of any layout, and what is known about them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native

if TYPE_CHECKING:
    from ._native import _Geometry

#: Component orders of arrays (H, W, 3) and (H, W, 4) where none is given, as the program assumes them.
USUAL_ORDERS = {3: "xx,xy,yy", 4: "xx,xy,yx,yy"}


class Tensors:
    """A tensor field in the plane.

    Parameters
    ----------
    array : array_like, shape (H, W, 2, 2), (H, W, 3) or (H, W, 4)
        Tensors of any real dtype, memory order and strides. They are copied once, to C-ordered float64.
    order : str, optional
        Components of an array (H, W, 3) or (H, W, 4): names such as ``"xx,yy,xy"``; ``"xx,xy,yy"`` and
        ``"xx,xy,yx,yy"`` by default.
    origin : {"upper", "lower"}
        Whether row 0 is the upper or the lower one. The y axis of the components points up in both cases.
    mask : array_like of bool, shape (H, W), optional
        Where true, tensors become zero, which transmit nothing. The masked samples of a masked array do, too.
    not_finite : {"refuse", "zero"}
        What becomes of tensors with a component that is infinite or not a number.
    name : str
        Title of pictures.
    geometry : tuple, optional
        Position of the lower left cell, unit vectors right and up (all of length 3), and the spacing along both.

    Raises
    ------
    ValueError
        A shape, order or dtype that holds no tensors, or a tensor that is not finite; the message names the first.
    """

    def __init__(
        self,
        array: ArrayLike,
        *,
        order: str | None = None,
        origin: str = "upper",
        mask: ArrayLike | None = None,
        not_finite: str = "refuse",
        name: str = "array",
        geometry: _Geometry | None = None,
    ) -> None:
        tensors = _normal(array, order, origin, mask, not_finite)
        self._plane = _native.of_array(tensors, str(name), geometry)

    @classmethod
    def _of(cls, plane: _native.Plane) -> Tensors:
        made = cls.__new__(cls)
        made._plane = plane
        return made

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        if copy is False:
            raise ValueError("the tensors are kept by the compiled part: expected copy=None or True")
        tensors = self._plane.tensors()
        return tensors if dtype is None else tensors.astype(dtype)

    @property
    def shape(self) -> tuple[int, ...]:
        """Rows, columns, 2, 2."""
        return self._plane.tensors().shape

    @property
    def name(self) -> str:
        """What it is called."""
        return self._plane.name

    @property
    def kind(self) -> str:
        """The file format, ``"generator"`` or ``"array"``."""
        return self._plane.kind

    @property
    def found(self) -> list[str]:
        """What was read, assumed and done, a sentence each."""
        return self._plane.found

    @property
    def remarks(self) -> list[str]:
        """Assumptions that options could replace, and warnings."""
        return self._plane.remarks

    @property
    def unit(self) -> str | None:
        """Unit of the coordinates, where the file states it."""
        return self._plane.unit

    @property
    def blake3(self) -> str:
        """Hash of the file or of the numbers, for provenance."""
        return self._plane.blake3

    @property
    def geometry(self) -> _Geometry | None:
        """Position of the lower left cell, directions right and up, spacing; None where the field lies nowhere."""
        return self._plane.geometry

    def __repr__(self) -> str:
        height, width = self.shape[:2]
        return f"<tigereye.Tensors {self.name!r}: {width} x {height} cells, {self.kind}>"

    def _repr_png_(self) -> bytes:
        return _native.glyphs(self._plane, "ellipse", None, "field", None, None).encoded("png")


def as_tensors(input: Tensors | ArrayLike) -> Tensors:
    """The field itself, or one of an array."""
    return input if isinstance(input, Tensors) else Tensors(input)


def _normal(
    array: ArrayLike, order: str | None, origin: str, mask: ArrayLike | None, not_finite: str
) -> NDArray[np.float64]:
    """C-ordered float64 of shape (H, W, 2, 2), row 0 on top."""
    if origin not in ("upper", "lower"):
        raise ValueError(f"origin: {origin!r}: expected 'upper' or 'lower'")
    if not_finite not in ("refuse", "zero"):
        raise ValueError(f"not_finite: {not_finite!r}: expected 'refuse' or 'zero'")
    given: NDArray[Any] = np.asanyarray(array)
    if given.dtype.kind not in "fiub":
        raise ValueError(f"dtype {given.dtype}: expected real numbers")
    places: list[int] | None
    if given.ndim == 4 and given.shape[2:] == (2, 2):
        if order is not None:
            raise ValueError("order: an array (H, W, 2, 2) has its own: expected none")
        places = None
    elif given.ndim == 3 and given.shape[2] in USUAL_ORDERS:
        places = _places(order or USUAL_ORDERS[given.shape[2]], given.shape[2])
    else:
        raise ValueError(f"shape {given.shape}: expected (H, W, 2, 2), (H, W, 3) or (H, W, 4)")
    hidden = _hidden(given, mask)
    # The only copy: of any dtype, order and strides.
    tensors = np.empty((*given.shape[:2], 2, 2), dtype=np.float64)
    rows = slice(None, None, -1) if origin == "lower" else slice(None)
    source = np.ma.getdata(given)[rows]
    if places is None:
        tensors[...] = source
    else:
        for place, component in enumerate(places):
            tensors[:, :, place // 2, place % 2] = source[:, :, component]
    if hidden is not None:
        tensors[hidden[rows]] = 0.0
    if not_finite == "zero":
        tensors[~np.isfinite(tensors).all(axis=(2, 3))] = 0.0
    return tensors


def _places(order: str, count: int) -> list[int]:
    """Where xx, xy, yx and yy stand."""
    names = [name.strip().lower() for name in order.split(",")]
    expected = {"xx", "xy", "yy"} if count == 3 else {"xx", "xy", "yx", "yy"}
    symmetric = {"xx", "yx", "yy"} if count == 3 else expected
    if len(names) != count or set(names) not in (expected, symmetric):
        raise ValueError(f"order: {order!r}: expected {count} different names of {', '.join(sorted(expected))}")
    other = {"xy": "yx", "yx": "xy"}
    wanted = ("xx", "xy", "yx", "yy")
    return [names.index(name if name in names else other[name]) for name in wanted]


def _hidden(given: NDArray[Any], mask: ArrayLike | None) -> NDArray[np.bool_] | None:
    """Cells without a tensor, as the array counts rows."""
    hidden: NDArray[np.bool_] | None = None
    if isinstance(given, np.ma.MaskedArray) and given.mask is not np.ma.nomask:
        flat: NDArray[np.bool_] = np.ma.getmaskarray(given).reshape(*given.shape[:2], -1)
        hidden = np.logical_or.reduce(flat, axis=2)
    if mask is not None:
        more: NDArray[np.bool_] = np.asarray(mask, dtype=bool)
        if more.shape != given.shape[:2]:
            raise ValueError(f"mask: shape {more.shape}: expected {given.shape[:2]}")
        hidden = more if hidden is None else np.logical_or(hidden, more)
    return hidden
