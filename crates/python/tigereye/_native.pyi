from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

__version__: str

_Vector = tuple[float, float, float]
_Geometry = tuple[_Vector, _Vector, _Vector, tuple[float, float]]
_Progress = Callable[[int, int], object] | None
_Lamp = tuple[int, int, str | list[float] | None]

class Plane:
    name: str
    kind: str
    blake3: str
    found: list[str]
    remarks: list[str]
    unit: str | None
    geometry: _Geometry | None
    def tensors(self) -> NDArray[np.float64]: ...

class Light:
    steps: int
    converged: bool
    story: str
    def samples(self) -> NDArray[np.float64]: ...
    def energy(self) -> NDArray[np.float64]: ...
    def encoded(self, format: str, picture: str) -> bytes: ...

class Gradient:
    slices: list[int]
    directions: int
    sources: int
    story: str
    def values(self) -> NDArray[np.float64]: ...
    def encoded(self, format: str) -> bytes: ...

class Drawing:
    extension: str
    summary: str
    story: str
    def encoded(self, format: str) -> bytes: ...
    def arrays(self) -> list[tuple[str, NDArray[np.float64]]]: ...
    def lines(self) -> list[tuple[NDArray[np.float64], str]]: ...

def generated(spec: str, options: Mapping[str, str]) -> Plane: ...
def generators() -> list[tuple[str, str, list[tuple[str, str, str, str]]]]: ...
def read(path: str, options: Mapping[str, str]) -> Plane: ...
def of_array(array: NDArray[np.float64], name: str, geometry: _Geometry | None = None) -> Plane: ...
def propagate(
    plane: Plane,
    lights: Sequence[_Lamp],
    impulse: bool,
    steps: int | None,
    options: Mapping[str, object],
    progress: _Progress,
) -> Light: ...
def ltg(
    plane: Plane, options: Mapping[str, object], sweep: Mapping[str, object], progress: _Progress
) -> Gradient: ...
def lines(plane: Plane, options: Mapping[str, object]) -> Drawing: ...
def topology(
    plane: Plane,
    family: str,
    step: float,
    length: float | None,
    axes: str | None,
    major: str | None,
    threads: int | None,
) -> Drawing: ...
def lic(
    plane: Plane,
    hyper: bool,
    family: str,
    half_length: float,
    samples: int,
    seed: int,
    tint: bool,
    axes: str | None,
    major: str | None,
    threads: int | None,
) -> Drawing: ...
def ftle(
    plane: Plane,
    family: str,
    length: float,
    samples: int,
    step: float,
    tolerance: float,
    axes: str | None,
    major: str | None,
    threads: int | None,
) -> Drawing: ...
def glyphs(
    plane: Plane, kind: str, gamma: float | None, scale: str, colour: str | None, every: int | None
) -> Drawing: ...
def ridges(
    values: NDArray[np.float64],
    contour: float | None,
    least_value: float,
    least_strength: float,
    least_length: float,
    samples: int | None,
    threads: int | None,
) -> list[tuple[NDArray[np.float64], bool, list[float], list[float]]]: ...
