"""Light transport through 2D tensor fields, and its gradient.

``field``, ``read`` and the adapters give a :class:`Tensors`; ``propagate``, ``ltg`` and the classical methods take one,
or any array of shape (H, W, 2, 2), (H, W, 3) or (H, W, 4), and give a result that numpy reads and a notebook shows.

Conventions: row 0 on top, x to the right, y up, components along x and y, directions counter-clockwise from +x.
"""

from ._adapters import from_nibabel, from_pyvista, from_xarray
from ._functions import field, fields, ftle, glyphs, lic, lines, ltg, propagate, read, ridges, topology
from ._native import __version__
from ._results import Curves, Drawn, Gradient, Light, Ridge, Sampled
from ._tensors import Tensors

__all__ = [
    "Curves",
    "Drawn",
    "Gradient",
    "Light",
    "Ridge",
    "Sampled",
    "Tensors",
    "__version__",
    "field",
    "fields",
    "from_nibabel",
    "from_pyvista",
    "from_xarray",
    "ftle",
    "glyphs",
    "lic",
    "lines",
    "ltg",
    "propagate",
    "read",
    "ridges",
    "topology",
]
