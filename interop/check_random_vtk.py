"""Property tests of the readers of VTK files: random fields written by VTK and meshio, compared in world coordinates."""

import functools
import itertools

import numpy as np
import vtk
from random_fields import TEXT, Lattice, RandomChecks, Written, lattice, nearest, random_tensors, world_axes_of
from read_back import points_of
from vtk.util.numpy_support import numpy_to_vtk

ROWS = list(itertools.product(range(3), repeat=2))
UPPER = [(i, j) for i, j in ROWS if i <= j]
VTK6 = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]
STRAIN = [(0, 0), (1, 1), (2, 2), (0, 1)]
ROWS2 = [(0, 0), (0, 1), (1, 0), (1, 1)]
UPPER2 = [(0, 0), (0, 1), (1, 1)]
# What programs call a component.
SPELLINGS = {
    "XX": lambda i, j: "XYZ"[i] + "XYZ"[j],
    "xx": lambda i, j: "xyz"[i] + "xyz"[j],
    "11": lambda i, j: f"{i + 1}{j + 1}",
    "00": lambda i, j: f"{i}{j}",
    "S11": lambda i, j: f"S{i + 1}{j + 1}",
    "SXX": lambda i, j: "S" + "XYZ"[i] + "XYZ"[j],
    "sigma_xx": lambda i, j: "sigma_" + "xyz"[i] + "xyz"[j],
    "stress_XX": lambda i, j: "stress_" + "XYZ"[i] + "XYZ"[j],
    "S_XX": lambda i, j: "S_" + "XYZ"[i] + "XYZ"[j],
}
# How components are laid out, and how the reader knows: by names in random order, by `--order`, or by what is usual.
LAYOUTS = {
    "nine": (ROWS, "usual"),
    "nine named": (ROWS, "named"),
    "six": (VTK6, "usual"),
    "six named": (UPPER, "named"),
    "six listed": (UPPER, "listed"),
    "four rows": (ROWS2, "usual"),
    "plane strain named": (STRAIN, "named"),
    "plane strain listed": (STRAIN, "listed"),
    "three named": (UPPER2, "named"),
    "three listed": (UPPER2, "listed"),
    "six arrays": (UPPER, "separate"),
    "three arrays": (UPPER2, "separate"),
}
# Bits of vtkGhostType: a point or cell that is not shown, and one that another piece shows too.
HIDDEN_POINT, HIDDEN_CELL, TWICE = 2, 32, 1


def only_in(entries, full):
    """The tensors that these components can hold."""
    world = np.zeros_like(full)
    for i, j in entries:
        world[..., i, j] = full[..., i, j]
        if (j, i) not in entries:
            world[..., j, i] = full[..., i, j]
    return world


def in_file_order(values):
    """(x, y, z, ...) one a point, x fastest."""
    return values.transpose(2, 1, 0, *range(3, values.ndim)).reshape(-1, *values.shape[3:])


def array_of(values, name, names=None):
    found = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    found.SetName(name)
    for i, word in enumerate(names or []):
        found.SetComponentName(i, word)
    return found


def put_tensors(generator, attributes, full, order=None):
    """Adds random tensors to the attributes of points or cells; returns them, the options that read them, and words.

    `order` says which voxel each tuple belongs to, where it is not the file's usual order.
    """
    kind = str(generator.choice(list(LAYOUTS)))
    entries, known = LAYOUTS[kind]
    dtype = str(generator.choice(["f4", "f8"]))
    if known != "usual":
        entries = [entries[i] for i in generator.permutation(len(entries))]
    world = only_in(entries, full)
    tuples = in_file_order(world)
    tuples = tuples if order is None else tuples[order]
    components = np.stack([tuples[:, i, j] for i, j in entries], -1).astype(dtype)
    spelling = str(generator.choice(list(SPELLINGS)))
    words = [kind, dtype]
    if known == "separate":
        spelling = str(generator.choice(["sigma_xx", "stress_XX", "S_XX", "S11", "SXX"]))
        names = [SPELLINGS[spelling](i, j) for i, j in entries]
        for c, name in enumerate(names):
            attributes.AddArray(array_of(components[:, c], name))
        chosen = ",".join(f"{'XYZ'[i]}{'XYZ'[j]}={name}" for (i, j), name in zip(entries, names, strict=True))
        return world, ["--components", chosen], [*words, spelling]
    names = [SPELLINGS[spelling](i, j) for i, j in entries] if known == "named" else None
    attributes.AddArray(array_of(components, "stress", names))
    options = []
    if known == "named":
        words.append("names " + " ".join(names))
    if known == "listed":
        options = ["--order", ",".join("xyz"[i] + "xyz"[j] for i, j in entries)]
    # VTK itself has tensors of nine and of six components.
    active = len(entries) in (6, 9) and (kind in ("nine", "six") or generator.random() < 0.5)
    if active:
        attributes.SetActiveTensors("stress")
        words.append("active")
    beside = generator.random()
    if beside < 0.2:
        labels = vtk.vtkStringArray()
        labels.SetName("labels")
        for i in range(len(tuples)):
            labels.InsertNextValue(f"point {i}")
        attributes.AddArray(labels)
        words.append("strings beside")
    elif beside < 0.4:
        ids = vtk.vtkIdTypeArray()
        ids.SetName("ids")
        for i in range(len(tuples)):
            ids.InsertNextValue(7 * i)
        attributes.AddArray(ids)
        words.append("ids beside")
    elif beside < 0.6:
        attributes.AddArray(array_of(np.arange(3.0 * len(tuples)).reshape(-1, 3), "velocity"))
        words.append("vectors beside")
    if not active or generator.random() < 0.3:
        options += ["--array", "stress"]
    return world, options, words


def hide(generator, attributes, size, on_cells, words):
    """Sometimes a mask, as VTK has them: where it leaves out, there is nothing. Returns what is kept."""
    draw = generator.random()
    if draw < 0.7:
        return None
    kept = generator.random(size) < 0.7
    if draw < 0.85 or on_cells:
        hidden = HIDDEN_CELL if on_cells else HIDDEN_POINT
        # What several pieces share is shown all the same.
        shared = np.where(generator.random(size) < 0.2, TWICE, 0)
        marks, name = np.where(kept, 0, hidden) | shared, "vtkGhostType"
        words.append("hidden cells" if on_cells else "hidden points")
    else:
        marks, name = kept, "vtkValidPointMask"
        words.append("valid points")
    attributes.AddArray(array_of(in_file_order(marks).astype("u1"), name))
    return kept


def write_xml(generator, writer, data, file, words):
    """One of VTK's ways to write numbers."""
    mode = str(generator.choice(["ascii", "binary", "appended", "encoded"]))
    if mode == "ascii":
        writer.SetDataModeToAscii()
    elif mode == "binary":
        writer.SetDataModeToBinary()
    else:
        writer.SetDataModeToAppended()
        writer.SetEncodeAppendedData(mode == "encoded")
    packing = str(generator.choice(["zlib", "lz4", "none"]))
    {"zlib": writer.SetCompressorTypeToZLib, "lz4": writer.SetCompressorTypeToLZ4}.get(
        packing, writer.SetCompressorTypeToNone
    )()
    end = str(generator.choice(["little", "big"]))
    writer.SetByteOrderToBigEndian() if end == "big" else writer.SetByteOrderToLittleEndian()
    size = int(generator.choice([32, 64]))
    writer.SetHeaderTypeToUInt32() if size == 32 else writer.SetHeaderTypeToUInt64()
    writer.SetFileName(str(file))
    writer.SetInputData(data)
    assert writer.Write() == 1, file
    words.append(f"{mode} {packing} {end} {size}")


def image_of(place, start):
    """Image data whose points are a lattice's; its extent starts at `start`, which VTK's origin does not belong to."""
    data = vtk.vtkImageData()
    data.SetExtent(*(int(v) for s, n in zip(start, place.size, strict=True) for v in (s, s + n - 1)))
    data.SetOrigin(*(place.origin - place.axes @ start))
    data.SetSpacing(*place.spacing())
    data.SetDirectionMatrix(place.directions().ravel().tolist())
    return data


def cells_between(place):
    """The lattice of the cells between points."""
    return Lattice(tuple(n - 1 for n in place.size), place.origin + 0.5 * place.axes.sum(axis=1), place.axes)


def write_image(generator, folder):
    place, kind = lattice(generator)
    words = [kind]
    if generator.random() < 0.15:
        size = list(place.size)
        size[int(generator.integers(3))] = 1
        place = Lattice(tuple(size), place.origin, place.axes)
        words.append("one layer")
    data = image_of(place, generator.integers(-3, 4, 3))
    nearest(place.positions(), points_of(data), place.spacing().min())
    on_cells = min(place.size) > 2 and generator.random() < 0.4
    attributes = data.GetCellData() if on_cells else data.GetPointData()
    place = cells_between(place) if on_cells else place
    world, options, more = put_tensors(generator, attributes, field_for(generator, place.size))
    words += ["cells", *more] if on_cells else more
    kept = hide(generator, attributes, place.size, on_cells, words)
    write_xml(generator, vtk.vtkXMLImageDataWriter(), data, folder / "in.vti", words)
    return Written("in.vti", place, world, words, options, kept)


def field_for(generator, size):
    """Symmetric or not; layouts that hold half of the components keep that half."""
    return random_tensors(generator, size, symmetric=bool(generator.random() < 0.3))


def grid_of(place):
    data = vtk.vtkStructuredGrid()
    data.SetDimensions(*place.size)
    data.SetPoints(points_from(in_file_order(place.positions())))
    return data


def points_from(positions):
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    for position in positions:
        points.InsertNextPoint(*position)
    return points


def write_legacy(generator, folder):
    shape = str(generator.choice(["points", "grid", "rectilinear"]))
    place, kind = lattice(generator, ("upright",) if shape != "grid" else ("upright", "signed", "signed", "oblique"))
    words = [shape, kind]
    if shape == "points":
        data = vtk.vtkImageData()
        data.SetDimensions(*place.size)
        data.SetOrigin(*place.origin)
        data.SetSpacing(*place.spacing())
    elif shape == "grid":
        data = grid_of(place)
    else:
        if generator.random() < 0.4:
            signs = generator.choice([-1.0, 1.0], 3)
            place = Lattice(place.size, place.origin, place.axes * signs)
            words.append(f"signs {signs.astype(int).tolist()}")
        data = vtk.vtkRectilinearGrid()
        data.SetDimensions(*place.size)
        for a, put in enumerate((data.SetXCoordinates, data.SetYCoordinates, data.SetZCoordinates)):
            put(array_of(place.origin[a] + place.axes[a, a] * np.arange(place.size[a]), "xyz"[a]))
    nearest(place.positions(), points_of(data), place.spacing().min())
    world, options, more = put_tensors(generator, data.GetPointData(), field_for(generator, place.size))
    words += more
    kept = hide(generator, data.GetPointData(), place.size, False, words)
    writer = vtk.vtkDataSetWriter()
    writer.SetFileName(str(folder / "in.vtk"))
    writer.SetInputData(data)
    text, version = generator.random() < 0.5, int(generator.choice([42, 51]))
    writer.SetFileTypeToASCII() if text else writer.SetFileTypeToBinary()
    writer.SetFileVersion(version)
    assert writer.Write() == 1
    words.append(f"{'text' if text else 'binary'} {version}")
    return Written("in.vtk", place, world, words, options, kept, tolerance=TEXT if text else 1e-5)


def along_the_world(written):
    """Points have no axes of their own: x, y and z of their planes are the world's that they are nearest to."""
    own = world_axes_of(written.lattice.directions())
    permuted = written.permuted([own.index(world) for world in range(3)])
    return permuted.taken([slice(None, None, -1 if permuted.lattice.axes[a, a] < 0 else 1) for a in range(3)])


def write_points(generator, folder, shuffled=False):
    # Points in no order have to lie along the world's axes.
    place, kind = lattice(generator, ("upright",) if shuffled else ("upright", "signed", "signed", "oblique"))
    words = [kind, "shuffled"] if shuffled else [kind]
    positions = in_file_order(place.positions())
    order = generator.permutation(len(positions)) if shuffled else np.arange(len(positions))
    data = vtk.vtkPolyData()
    data.SetPoints(points_from(positions[order]))
    world, options, more = put_tensors(generator, data.GetPointData(), field_for(generator, place.size), order)
    words += more
    write_xml(generator, vtk.vtkXMLPolyDataWriter(), data, folder / "in.vtp", words)
    return along_the_world(Written("in.vtp", place, world, words, options))


class RandomVtk(RandomChecks):
    def test_random_images(self):
        self.readings("VTK image data", 100, write_image)

    def test_random_legacy_files(self):
        self.readings("legacy VTK", 80, write_legacy)

    def test_random_poly_data(self):
        self.readings("VTK poly data", 40, write_points)

    def test_random_poly_data_in_any_order(self):
        self.readings("VTK poly data in any order", 15, functools.partial(write_points, shuffled=True))
