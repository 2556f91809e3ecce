"""The package beside the program, and beside the programs that its users have."""

import inspect
import multiprocessing
import os
import pathlib
import re
import signal
import subprocess
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import tigereye as te

PROGRAM = os.environ.get("TIGEREYE")
with_program = pytest.mark.skipif(PROGRAM is None, reason="TIGEREYE names no program to compare with")


def program(*words):
    return subprocess.run([PROGRAM, *words], check=True, capture_output=True, text=True).stdout


def tilted():
    """7 x 9 tensors without any symmetry of the picture: longer towards 30 degrees, stronger to the upper right."""
    rows, columns = np.mgrid[0:7, 0:9]
    angle = np.deg2rad(30.0) + 0.02 * columns - 0.03 * rows
    c, s = np.cos(angle), np.sin(angle)
    strength = 1.0 + 0.1 * columns + 0.05 * (6 - rows)
    long, short = 3.0 * strength, strength
    xx, yy = long * c**2 + short * s**2, long * s**2 + short * c**2
    xy = (long - short) * c * s
    return np.stack([np.stack([xx, xy], -1), np.stack([xy, yy], -1)], -2)


@with_program
def test_propagate_has_the_bits_of_the_program(tmp_path):
    out = tmp_path / "light.npy"
    program("propagate", "inverse:size=21", "--light", "8,12,clip(cos(theta))", "-o", str(out))
    light = te.propagate(te.field("inverse", size=21), (8, 12, "clip(cos(theta))"))
    assert np.load(out).tobytes() == np.asarray(light).tobytes()


@with_program
@pytest.mark.parametrize("scattering", ["joint", "linear"])
def test_ltg_has_the_bits_of_the_program(tmp_path, scattering):
    np.save(tmp_path / "field.npy", tilted())
    out = tmp_path / "ltg.npy"
    words = ["--directions", "16", "--scattering", scattering, "-o", str(out)]
    program("ltg", str(tmp_path / "field.npy"), *words)
    gradient = te.ltg(tilted(), directions=16, scattering=scattering, threads=1)
    assert np.load(out).reshape(gradient.shape).tobytes() == np.asarray(gradient).tobytes()


@with_program
def test_curves_and_samples_are_those_of_the_program(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    field = te.field("inverse", size=21)
    for name, extension in [("lines", "vtp"), ("topology", "vtp"), ("lic", "vti"), ("ftle", "vti"), ("glyphs", "vtp")]:
        ours, theirs = tmp_path / f"ours.{extension}", tmp_path / f"theirs.{extension}"
        getattr(te, name)(field).save(ours)
        program(name, "inverse:size=21", "-o", str(theirs))
        # Everything but the provenance, which names the call.
        read = [pyvista.read(path) for path in (ours, theirs)]
        assert (read[0].points == read[1].points).all() and read[0].n_points > 0
        for kind in ("point_data", "cell_data"):
            one, other = (getattr(data, kind) for data in read)
            assert set(one.keys()) == set(other.keys()), name
            assert all(np.asarray(one[key]).tobytes() == np.asarray(other[key]).tobytes() for key in one.keys()), name


@with_program
@pytest.mark.parametrize(
    "name", ["propagate", "ltg", "lines", "topology", "lic", "ftle", "glyphs", "ridges"]
)
def test_options_have_the_names_and_defaults_of_the_command_line(name):
    text = program(name, "--help")
    found = {}
    starts = list(re.finditer(r"^ {2,6}(?:-\w, )?--([a-z0-9-]+)", text, re.MULTILINE))
    for here, after in zip(starts, [*starts[1:], None]):
        block = text[here.end() : after and after.start()]
        default = re.search(r"\[default:\s+(.*?)\]", block, re.DOTALL)
        found[here.group(1).replace("-", "_")] = default and default.group(1)
    assert len(found) > 5
    parameters = inspect.signature(getattr(te, name)).parameters
    ours = {key: p.default for key, p in parameters.items() if p.kind is p.KEYWORD_ONLY}
    for option, default in ours.items():
        if option in ("progress",) or (option == "threads" and name != "ltg"):
            continue
        assert option in found, f"{option} is no option of `tigereye {name}`"
        if found[option] is None:
            assert default in (None, False, ()), option
        else:
            assert str(default) == found[option] or float(default) == float(found[option]), option


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.int16, ">f8"])
def test_layouts_do_not_matter(dtype):
    plain = np.rint(tilted() * 8).astype(dtype)
    expected = np.asarray(te.Tensors(plain))
    wide = np.zeros((14, 18, 2, 2), dtype=dtype)
    wide[::2, ::2] = plain
    for other in (np.asfortranarray(plain), wide[::2, ::2], plain[::-1][::-1]):
        assert (np.asarray(te.Tensors(other)) == expected).all()
    three = np.stack([plain[..., 0, 0], plain[..., 1, 1], plain[..., 0, 1]], -1)
    assert (np.asarray(te.Tensors(three, order="xx,yy,xy")) == expected).all()
    assert (np.asarray(te.Tensors(plain[::-1], origin="lower")) == expected).all()


def test_masks_become_zero_and_the_first_bad_tensor_is_named():
    bad = tilted()
    bad[2, 5, 0, 1] = np.nan
    with pytest.raises(ValueError, match="row 2, column 5"):
        te.Tensors(bad)
    for field in (te.Tensors(bad, not_finite="zero"), te.Tensors(np.ma.masked_invalid(bad))):
        assert (np.asarray(field)[2, 5] == 0).all() and (np.asarray(field)[2, 4] != 0).any()


def test_pyvista_has_the_same_directions():
    pyvista = pytest.importorskip("pyvista")
    field = tilted()
    image = pyvista.ImageData(dimensions=(9, 7, 1), spacing=(0.5, 0.5, 1.0), origin=(10.0, 20.0, 0.0))
    # Row by row from below, as VTK counts.
    image.point_data["D"] = field[::-1].reshape(-1, 4)
    found = te.from_pyvista(image, "D")
    assert (np.asarray(found) == field).all()
    corner, _, _, spacing = found.geometry
    assert list(corner) == [10.0, 20.0, 0.0] and list(spacing) == [0.5, 0.5]
    back = te.propagate(found, (2, 1)).to_pyvista()
    # The lamp is near the top: at y = 20 + 5 * 0.5.
    assert back.points[np.argmax(back.point_data["Light"])][:2] == pytest.approx([11.0, 22.5])


def test_nibabel_has_the_same_directions():
    nibabel = pytest.importorskip("nibabel")
    field = tilted()
    data = np.zeros((9, 7, 3, 6))
    # x to the right, y up; dipy's order.
    for component, (i, j) in {0: (0, 0), 1: (0, 1), 2: (1, 1)}.items():
        data[:, :, 1, component] = field[::-1, :, i, j].T
    image = nibabel.Nifti1Image(data, np.diag([2.0, 2.0, 3.0, 1.0]))
    found = te.from_nibabel(image, slice=1)
    assert (np.asarray(found) == field).all()
    assert list(found.geometry[0]) == [0.0, 0.0, 3.0]


def test_xarray_has_the_same_directions():
    xarray = pytest.importorskip("xarray")
    field = tilted()
    up = xarray.DataArray(
        field[::-1], dims=("y", "x", "i", "j"), coords={"y": np.arange(7.0), "x": np.arange(9.0)}
    )
    down = up.isel(y=slice(None, None, -1))
    for array in (up, down, up.transpose("x", "y", "i", "j")):
        assert (np.asarray(te.from_xarray(array)) == field).all()
    light = te.propagate(te.from_xarray(up), (2, 1)).to_xarray()
    assert float(light.y[0]) == 6.0 and light.dims == ("y", "x", "theta")


def test_results_show_themselves(tmp_path):
    light = te.propagate(tilted(), (4, 3))
    gradient = te.ltg(tilted(), directions=8)
    for result in (light, gradient, te.lines(tilted()), te.lic(tilted()), te.ftle(tilted()), te.glyphs(tilted())):
        assert result._repr_png_().startswith(b"\x89PNG")
        assert result._repr_html_().startswith("<img")
        assert result.provenance["version"] == te.__version__
        with pytest.raises(ValueError, match="expected one of"):
            result.save(tmp_path / "x.doc")
    assert np.asarray(gradient) is gradient.values
    assert not list(tmp_path.iterdir())


def test_plots_are_upright():
    pytest.importorskip("matplotlib").use("Agg")
    import matplotlib.pyplot as plt

    for result in (te.propagate(tilted(), (4, 1)), te.ltg(tilted(), directions=8), te.lines(tilted())):
        axes = result.plot(plt.figure().subplots())
        bottom, top = axes.get_ylim()
        assert bottom > top
        plt.close("all")


def test_ridges_follow_a_crest():
    rows, columns = np.mgrid[0:21, 0:25]
    found = te.ridges(np.exp(-(((rows - 7.0) / 2.0) ** 2)) + 0 * columns)
    assert found and all(abs(ridge.points[:, 1] - 7.0).max() < 0.05 for ridge in found)


def test_interrupts_end_a_sweep_and_leave_everything_in_order():
    field = te.field("inverse", size=151)
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        te.ltg(field, directions=64)
    assert te.ltg(te.field("inverse", size=7), directions=8).shape == (8, 7, 7)


def test_other_threads_run_meanwhile():
    counted = []

    def count():
        while not done.is_set():
            counted.append(time.monotonic())
            time.sleep(0.001)

    done = threading.Event()
    thread = threading.Thread(target=count)
    thread.start()
    te.ltg(te.field("inverse", size=31), directions=16)
    done.set()
    thread.join()
    assert len(counted) > 5


def _mean(size):
    return float(te.ltg(te.field("inverse", size=size), directions=8, threads=2).mean().sum())


def test_threads_and_forks_agree():
    te.lic(te.field("inverse", size=11))
    expected = [_mean(n) for n in (7, 9, 11)]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(_mean, (7, 9, 11))) == expected
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map(_mean, (7, 9, 11)) == expected


def test_progress_is_told_and_its_faults_end_the_work():
    told = []
    te.ltg(te.field("inverse", size=31), directions=16, progress=lambda done, total: told.append((done, total)))
    assert told[-1][0] == told[-1][1] > 0

    def fault(done, total):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        te.ltg(te.field("inverse", size=51), directions=32, progress=fault)


def test_too_little_memory_is_told():
    with pytest.raises(MemoryError, match="memory"):
        te.ltg(te.field("inverse", size=51), memory=1000)


def test_files_that_are_not_there():
    with pytest.raises(OSError, match="nowhere.npy"):
        te.read("nowhere.npy")


def test_the_lines_of_the_readme_and_of_the_guide_work(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    root = pathlib.Path(__file__).parents[3]
    for page in (root / "README.md", root / "docs/guide/python.md"):
        (lines,) = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
        exec(compile(lines, str(page), "exec"), {})
        for name in ("light.png", "gradient.png"):
            picture = tmp_path / name
            assert picture.read_bytes().startswith(b"\x89PNG")
            picture.unlink()


anything = st.none() | st.integers() | st.floats() | st.text(max_size=8) | st.booleans()
FUNCTIONS = [te.propagate, te.ltg, te.lines, te.topology, te.lic, te.ftle, te.glyphs]


@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_no_argument_makes_it_panic(data):
    function = data.draw(st.sampled_from(FUNCTIONS))
    parameters = inspect.signature(function).parameters
    names = [key for key, p in parameters.items() if p.kind is p.KEYWORD_ONLY and key != "progress"]
    # Values that are allowed, but take long.
    slow = {"samples", "half_length", "length", "steps", "max_iterations", "threads", "directions", "separation", "step"}
    options = data.draw(st.dictionaries(st.sampled_from([n for n in names if n not in slow]), anything, max_size=3))
    shape = data.draw(st.sampled_from([(4, 5, 2, 2), (4, 4, 3), (1, 1, 2, 2), (3, 3, 4), (2, 2), (0, 3, 3)]))
    array = data.draw(arrays.arrays(np.float64, shape, elements=st.floats(width=64)))
    lamps = [(data.draw(st.integers(-1, 5)), 1)] if function is te.propagate else []
    try:
        function(array, *lamps, **options)
    except (ValueError, TypeError, OverflowError, MemoryError):
        pass
