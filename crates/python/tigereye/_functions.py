"""The functions of the package. Their options have the names and defaults of the command line."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._results import Curves, Gradient, Light, Ridge, Sampled
from ._tensors import Tensors, as_tensors

Progress = bool | Callable[[int, int], object]
Lamp = Sequence[Any]


def fields() -> dict[str, str]:
    """The built-in fields: names and summaries."""
    return {name: summary for name, summary, _ in _native.generators()}


def field(name: str, **parameters: object) -> Tensors:
    """A built-in field, see `fields`; ``field("inverse", size=51)``.

    Raises
    ------
    ValueError
        A name or parameter that does not exist; the message names those that do.
    """
    words = ",".join(f"{key}={_word(value)}" for key, value in parameters.items())
    spec = name if not words else f"{name}{',' if ':' in name else ':'}{words}"
    return Tensors._of(_native.generated(spec, {}))


def read(path: str | os.PathLike[str], **options: object) -> Tensors:
    """A tensor field of a file, in any format of the program.

    Parameters
    ----------
    path : path_like
        The file.
    **options
        Those of the command line with underscores, such as ``order="fsl"``, ``slice="z=30"``, ``crop="20:90,10:80"``.

    Returns
    -------
    Tensors
        With what was found and assumed in `found` and `remarks`.
    """
    words = {key: _word(value) for key, value in options.items() if value is not None}
    return Tensors._of(_native.read(os.fspath(path), words))


def propagate(
    input: Tensors | ArrayLike,
    light: Lamp | Sequence[Lamp],
    *,
    impulse: bool = False,
    steps: int | None = None,
    directions: int = 32,
    scattering: str = "joint",
    threshold: float | None = None,
    max_iterations: int | None = None,
    stop: str | None = None,
    normalization: str | None = None,
    total_anisotropy: str | None = None,
    picture: str = "overlay",
    progress: Progress = False,
) -> Light:
    """One light distribution.

    Parameters
    ----------
    input : Tensors or array_like
        The field.
    light : (column, row[, profile]) or a sequence of these
        Lamps; a profile is an expression in ``theta`` or a value for every direction, in W/rad, 1 by default.
    picture : {"overlay", "energy"}
        What pictures show.
    progress : bool or callable
        A bar (tqdm where it is installed), or a function of the steps done and in all (0: unknown).

    Returns
    -------
    Light
        Intensity, shape (H, W, S), W/rad.
    """
    tensors = as_tensors(input)
    lamps = [light] if len(light) > 0 and isinstance(light[0], (int, np.integer)) else list(light)
    options = _scheme(directions, scattering, threshold, max_iterations, stop, normalization, total_anisotropy)
    if picture not in ("overlay", "energy"):
        raise ValueError(f"picture: {picture!r}: expected overlay or energy")
    with _Bar(progress) as told:
        native = _native.propagate(tensors._plane, [_lamp(lamp) for lamp in lamps], impulse, steps, options, told)
    return Light(tensors, native, picture)


def ltg(
    input: Tensors | ArrayLike,
    *,
    directions: int = 32,
    scattering: str = "joint",
    threshold: float | None = None,
    max_iterations: int | None = None,
    stop: str | None = None,
    normalization: str | None = None,
    total_anisotropy: str | None = None,
    omega_step: int | None = None,
    slices: Sequence[int] | None = None,
    slices_deg: Sequence[float] | None = None,
    precision: str | None = None,
    threads: int | None = None,
    memory: int | None = None,
    progress: Progress = False,
) -> Gradient:
    """The light transport gradient.

    Parameters
    ----------
    input : Tensors or array_like
        The field.
    threads : int, optional
        All processors by default; the result does not depend on it.
    memory : int, optional
        Upper bound on the memory of the sweep, bytes; 4 GiB by default.
    progress : bool or callable
        A bar (tqdm where it is installed), or a function of the pulses done and in all.

    Returns
    -------
    Gradient
        Shape (T, H, W), W/rad.

    Raises
    ------
    MemoryError
        A sweep that does not fit into `memory`.
    """
    tensors = as_tensors(input)
    options = _scheme(directions, scattering, threshold, max_iterations, stop, normalization, total_anisotropy)
    sweep = {
        "omega_step": omega_step,
        "slices": None if slices is None else [int(t) for t in slices],
        "slices_deg": None if slices_deg is None else [float(a) for a in slices_deg],
        "precision": precision,
        "threads": threads,
        "memory": 4 << 30 if memory is None else memory,
    }
    with _Bar(progress) as told:
        return Gradient(tensors, _native.ltg(tensors._plane, options, sweep, told))


def lines(
    input: Tensors | ArrayLike,
    *,
    family: str = "major",
    separation: float | None = None,
    seed: Sequence[tuple[float, float]] = (),
    method: str = "rk4",
    step: float = 0.1,
    tolerance: float | None = None,
    length: float | None = None,
    least_anisotropy: float = 0.001,
    inertia: float | None = None,
    ribbon: float | None = None,
    axes: str | None = None,
    major: str | None = None,
    threads: int | None = None,
) -> Curves:
    """Tensor lines and hyperstreamlines; lengths in cells, seeds as column and row."""
    tensors = as_tensors(input)
    options = {
        "family": family,
        "separation": separation,
        "seeds": [(float(x), float(y)) for x, y in seed],
        "method": method,
        "step": step,
        "tolerance": tolerance,
        "length": length,
        "least_anisotropy": least_anisotropy,
        "inertia": inertia,
        "ribbon": ribbon,
        "axes": axes,
        "major": major,
        "threads": threads,
    }
    return Curves(tensors, _native.lines(tensors._plane, options))


def topology(
    input: Tensors | ArrayLike,
    *,
    family: str = "major",
    step: float = 0.1,
    length: float | None = None,
    axes: str | None = None,
    major: str | None = None,
    threads: int | None = None,
) -> Curves:
    """Degenerate points (in `summary`) and their separatrices."""
    tensors = as_tensors(input)
    return Curves(tensors, _native.topology(tensors._plane, family, step, length, axes, major, threads))


def lic(
    input: Tensors | ArrayLike,
    *,
    hyper: bool = False,
    family: str = "major",
    half_length: float = 5.0,
    samples: int = 4,
    seed: int = 1,
    tint: bool = False,
    axes: str | None = None,
    major: str | None = None,
    threads: int | None = None,
) -> Sampled:
    """Noise smeared along the axes (line integral convolution), row 0 on top, numbers without unit."""
    tensors = as_tensors(input)
    native = _native.lic(
        tensors._plane, hyper, family, half_length, samples, seed, tint, axes, major, threads
    )
    return Sampled(tensors, native, "1")


def ftle(
    input: Tensors | ArrayLike,
    *,
    family: str = "major",
    length: float = 10.0,
    samples: int = 2,
    step: float = 1.0,
    tolerance: float = 1e-5,
    axes: str | None = None,
    major: str | None = None,
    threads: int | None = None,
) -> Sampled:
    """Finite-time Lyapunov exponent of the tensor lines, row 0 on top, per cell; NaN where lines are too short."""
    tensors = as_tensors(input)
    native = _native.ftle(tensors._plane, family, length, samples, step, tolerance, axes, major, threads)
    return Sampled(tensors, native, "1/cell")


def glyphs(
    input: Tensors | ArrayLike,
    *,
    kind: str = "ellipse",
    gamma: float | None = None,
    scale: str = "field",
    colour: str | None = None,
    every: int | None = None,
) -> Curves:
    """A glyph for every tensor: a picture and outlines (``save("glyphs.vtp")``)."""
    tensors = as_tensors(input)
    return Curves(tensors, _native.glyphs(tensors._plane, kind, gamma, scale, colour, every))


def ridges(
    values: ArrayLike,
    *,
    contour: float | None = None,
    least_value: float = 0.0,
    least_strength: float = 0.05,
    least_length: float = 2.0,
    samples: int | None = None,
    threads: int | None = None,
) -> list[Ridge]:
    """Height ridges, or contours where `contour` is a value, of an image of shape (H, W), row 0 on top.

    Borders without values are NaN. Lengths are in cells.
    """
    image = np.ascontiguousarray(values, dtype=np.float64)
    if image.ndim != 2:
        raise ValueError(f"shape {image.shape}: expected (H, W), such as Gradient.mean() or a slice")
    found = _native.ridges(image, contour, least_value, least_strength, least_length, samples, threads)
    return [Ridge(points, closed, np.array(v), np.array(s)) for points, closed, v, s in found]


def _word(value: object) -> str:
    return str(value).lower() if isinstance(value, (bool, np.bool_)) else str(value)


def _lamp(lamp: Lamp) -> tuple[int, int, str | list[float] | None]:
    if len(lamp) not in (2, 3):
        raise ValueError(f"light {lamp!r}: expected (column, row) or (column, row, profile)")
    profile = lamp[2] if len(lamp) == 3 else None
    if profile is not None and not isinstance(profile, str):
        profile = [float(v) for v in profile]
    return int(lamp[0]), int(lamp[1]), profile


def _scheme(
    directions: int,
    scattering: str,
    threshold: float | None,
    max_iterations: int | None,
    stop: str | None,
    normalization: str | None,
    total_anisotropy: str | float | None,
) -> dict[str, object]:
    return {
        "directions": directions,
        "scattering": scattering,
        "threshold": threshold,
        "max_iterations": max_iterations,
        "stop": stop,
        "normalization": normalization,
        "total_anisotropy": None if total_anisotropy is None else str(total_anisotropy),
    }


class _Bar:
    """What is told of progress: nothing, a bar, or whatever a function makes of it."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._bar: Any = None

    def __enter__(self) -> Callable[[int, int], object] | None:
        if callable(self._progress):
            return self._progress
        if not self._progress:
            return None
        try:
            from tqdm.auto import tqdm
        except ImportError:
            return lambda done, total: print(f"\r{done} of {total or '?'}", end="", flush=True)
        self._bar = tqdm()
        return self._told

    def _told(self, done: int, total: int) -> None:
        self._bar.total = total or None
        self._bar.update(done - self._bar.n)

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
        elif self._progress is True:
            print()
