"""Property tests of the readers of NIfTI and NRRD: random fields written by nibabel, ITK, pynrrd and teem."""

import dataclasses
import shutil
import unittest
import warnings

import nibabel
import nrrd
import numpy as np
from common import ORDERS, six, turned
from random_fields import (
    SINGLE,
    RandomChecks,
    Written,
    compare_places,
    lattice,
    nearest,
    picture,
    random_tensors,
    run_other,
    run_program,
    turn,
)
from read_back import SPACES, positions_of_affine

with warnings.catch_warnings():
    # The tool that makes ITK's bindings is older than the interpreter's newest wishes.
    warnings.simplefilter("ignore")
    import itk

LPS = (-1.0, -1.0, 1.0)
# Scaling of whole numbers: exact, because random tensors are multiples of 1/128.
SCALE, SHIFT = 1.0 / 128.0, 0.5
# What becomes of a voxel axis.
WHOLE, BACKWARDS, WITHOUT_FIRST = slice(None), slice(None, None, -1), slice(1, None)


def fsl_axes(directions):
    """The axes of FSL's gradient tables: the voxel axes, x reversed where they are right-handed."""
    return directions @ np.diag([-1.0, 1.0, 1.0]) if np.linalg.det(directions) > 0.0 else directions


def put_place(generator, image, place):
    """Puts a lattice into the header of an image by sform, qform or both; returns the words."""
    other = np.diag([7.0, 8.0, 9.0, 1.0])
    how = str(generator.choice(["sform", "qform", "both", "sform beside another qform"]))
    affine = place.affine()
    image.set_sform(affine if how != "qform" else None, 0 if how == "qform" else int(generator.integers(1, 5)))
    if how == "sform":
        image.set_qform(None, 0)
    else:
        image.set_qform(other if "another" in how else affine, 1)
    return how


# What a NIfTI file may hold: the order of the numbers, the intent, the options.
NIFTI = {
    "lower triangle, stated": ("dipy", (1005, (3,)), []),
    "lower triangle, stated without its size": ("dipy", (1005, (0,)), []),
    "rows, stated": ("rows", (1004, (3, 3)), []),
    "2 x 2, stated": ("rows2", (1004, (2, 2)), []),
    "dipy, as usual": ("dipy", None, []),
    "dipy": ("dipy", None, ["--order", "dipy"]),
    "fsl": ("fsl", None, ["--order", "fsl"]),
    "mrtrix": ("mrtrix", None, ["--order", "mrtrix"]),
    "listed": ("vtk", None, ["--order", "xx,yy,zz,xy,yz,xz"]),
}


def components(full, order):
    if order == "rows":
        return full.reshape(*full.shape[:3], 9)
    if order == "rows2":
        return full[..., :2, :2].reshape(*full.shape[:3], 4)
    return six(full, order)


def frame_of(generator, kind, directions):
    """The axes of the components in the world (columns), and the options that say so."""
    usual = {"fsl": "fsl", "mrtrix": "world"}.get(kind, "voxel")
    axes = {"voxel": directions, "world": np.eye(3), "fsl": fsl_axes(directions)}
    if generator.random() < 0.5:
        return axes[usual], [], f"usual frame {usual}"
    frame = str(generator.choice(list(axes)))
    return axes[frame], ["--frame", frame], f"frame {frame}"


def save_mask(generator, folder, place, words):
    """A mask file of the same place, some of its axes the other way round; returns what is kept."""
    kept = generator.random(place.size) < 0.7
    index = [WHOLE if generator.random() < 0.5 else BACKWARDS for _ in range(3)]
    there = Written("", place, np.zeros((*place.size, 3, 3)), [], kept=kept).taken(index)
    mask = nibabel.Nifti1Image(there.kept.astype("u1"), there.lattice.affine())
    nibabel.save(mask, folder / "mask.nii")
    words.append(f"mask, reversed along {[i for i in range(3) if index[i] is BACKWARDS]}")
    return kept


def write_nifti(generator, folder):
    place, turned_by = lattice(generator, ("upright", "signed", "signed", "signed", "oblique"))
    kind = str(generator.choice(list(NIFTI)))
    order, intent, options = NIFTI[kind]
    stored = random_tensors(generator, place.size, symmetric=order not in ("rows", "rows2"))
    if order == "rows2":
        stored[..., 2, :] = stored[..., :, 2] = 0.0
    words = [kind, turned_by]
    values = components(stored, order)
    if intent or generator.random() < 0.3:
        values = values[:, :, :, None, :]
        words.append("five axes")
    dtype = str(generator.choice(["f4", "f8", "i2", "i4"]))
    header = nibabel.Nifti1Header(endianness=str(generator.choice(["<", ">"])))
    header.set_data_dtype(np.dtype(dtype).newbyteorder(header.endianness))
    # A scaled file holds whole numbers, and nibabel wants these, not their product, where the scaling is set by hand.
    raw = values.astype(dtype) if dtype[0] == "f" else np.rint((values - SHIFT) / SCALE).astype(dtype)
    image = nibabel.Nifti1Image(raw, None, header)
    if dtype[0] == "i":
        image.header.set_slope_inter(SCALE, SHIFT)
    if intent:
        image.header.set_intent(*intent)
    how = put_place(generator, image, place)
    frame, more, said = frame_of(generator, kind, place.directions())
    name = str(generator.choice(["in.nii", "in.nii.gz"]))
    nibabel.save(image, folder / name)
    words += [dtype, how, said]
    # nibabel's own word about both.
    again = nibabel.load(folder / name)
    nearest(place.positions(), positions_of_affine(place.size, again.affine), place.spacing().min())
    assert np.array_equal(np.asarray(again.dataobj).reshape(values.shape), values), "nibabel reads other numbers"
    kept = None
    if generator.random() < 0.25:
        kept = save_mask(generator, folder, place, words)
        more = [*more, "--mask", "mask.nii"]
    return Written(name, place, turned(stored, frame), words, [*options, *more], kept)


def itk_image(kind, place, values, dtype):
    """ITK's writer of a format, with six numbers a voxel as a tensor or as a vector: what its C++ writers do."""
    writer = itk.NiftiImageIO.New() if kind == "nii" else itk.NrrdImageIO.New()
    writer.SetNumberOfDimensions(3)
    region = itk.ImageIORegion(3)
    directions, spacing = place.directions(), place.spacing()
    for a in range(3):
        writer.SetDimensions(a, place.size[a])
        writer.SetSpacing(a, float(spacing[a]))
        writer.SetOrigin(a, float(place.origin[a]))
        writer.SetDirection(a, directions[:, a].tolist())
        region.SetIndex(a, 0)
        region.SetSize(a, place.size[a])
    writer.SetIORegion(region)
    writer.SetNumberOfComponents(values.shape[-1])
    types = itk.CommonEnums
    writer.SetComponentType(types.IOComponent_FLOAT if dtype == "f4" else types.IOComponent_DOUBLE)
    buffer = np.ascontiguousarray(values.transpose(2, 1, 0, 3).astype(dtype))
    image = itk.image_from_array(buffer, ttype=itk.VectorImage[itk.F if dtype == "f4" else itk.D, 3])
    return writer, image


def write_itk(generator, folder):
    """ITK's world runs to the left, posterior and superior; its tensors are the upper triangle by rows."""
    place, turned_by = lattice(generator, ("upright", "signed", "signed", "oblique"))
    kind = str(generator.choice(["nii", "nrrd"]))
    dtype = "f4" if generator.random() < 0.7 else "f8"
    stored = random_tensors(generator, place.size, symmetric=True)
    writer, image = itk_image(kind, place, six(stored, "fsl"), dtype)
    as_tensor = generator.random() < 0.6
    types = itk.CommonEnums
    writer.SetPixelType(types.IOPixel_SYMMETRICSECONDRANKTENSOR if as_tensor else types.IOPixel_VECTOR)
    if kind == "nrrd":
        name = "in.nrrd"
    else:
        name = str(generator.choice(["in.nii", "in.nii.gz"]))
    writer.SetFileName(str(folder / name))
    writer.Write(image.GetBufferPointer())
    words = [turned_by, dtype, "tensors" if as_tensor else "vectors of six"]
    # Vectors keep ITK's order and state none.
    options = [] if as_tensor else ["--order", "nrrd"]
    if kind == "nrrd":
        return Written(name, place, stored, words, options, signs=LPS)
    # NIfTI's world runs to the right and anterior, and the numbers are not turned: ITK leaves their axes to the user.
    there = place.mirrored(LPS)
    again = nibabel.load(folder / name)
    nearest(there.positions(), positions_of_affine(place.size, again.affine), place.spacing().min())
    frame = str(generator.choice(["voxel", "world"]))
    axes = there.directions() if frame == "voxel" else np.eye(3)
    return Written(name, there, turned(stored, axes), [*words, frame], [*options, "--frame", frame])


NRRD = {
    "3D-symmetric-matrix": "fsl",
    "3D-masked-symmetric-matrix": "fsl",
    "3D-matrix": "rows",
    "3D-masked-matrix": "rows",
}


def write_nrrd(generator, folder, kinds=tuple(NRRD), dtypes=("f4", "f8"), name=None, components_last=True):
    place, turned_by = lattice(generator, ("upright", "signed", "signed", "oblique"))
    kind, space = str(generator.choice(kinds)), str(generator.choice([s for s in SPACES if s]))
    stored = random_tensors(generator, place.size, symmetric=NRRD[kind] == "fsl")
    values, words, kept = components(stored, NRRD[kind]), [kind, space, turned_by], None
    if "masked" in kind:
        kept = generator.random(place.size) < 0.7
        values = np.concatenate([kept[..., None], values], -1)
    header = {
        "kinds": [kind, "space", "space", "space"],
        "space": space,
        "space directions": np.vstack([[np.nan] * 3, place.axes.T]),
        "space origin": place.origin,
        "encoding": str(generator.choice(["raw", "gzip", "ascii"])),
    }
    values = np.moveaxis(values, -1, 0)
    if generator.random() < 0.2 and components_last:
        # The format allows the components on any axis.
        values = np.moveaxis(values, 0, -1)
        header["kinds"] = [*header["kinds"][1:], kind]
        header["space directions"] = np.vstack([place.axes.T, [np.nan] * 3])
        words.append("components last")
    frame = np.eye(3)
    if generator.random() < 0.5:
        frame = turn(generator, str(generator.choice(["signed", "oblique"])))
        # The format lists the frame's axes one by one; pynrrd writes each row of the matrix as one of them.
        header["measurement frame"] = frame.T
        words.append("measurement frame")
    dtype = str(generator.choice(["<", ">"])) + str(generator.choice(dtypes))
    name = name or str(generator.choice(["in.nrrd", "in.nhdr"]))
    nrrd.write(str(folder / name), values.astype(dtype), header, detached_header=name.endswith("nhdr"))
    words += [dtype, header["encoding"]]
    return Written(name, place, turned(stored, frame), words, [], kept, SPACES[space])


def tool(name):
    """One of teem's tools: Debian puts the project's name in front."""
    return shutil.which(f"teem-{name}") or shutil.which(name)


TEEM = tool("unu") and tool("tend")


def moved_by_unu(generator, folder, written, number):
    """The same field with axes swapped, reversed or cut by teem, which keeps the places up to date."""
    what = str(generator.choice(["flip", "swap", "crop"]))
    axis = int(generator.integers(3))
    index = [WHOLE] * 3
    if what == "flip":
        arguments = ["-a", axis + 1]
        index[axis] = BACKWARDS
        moved = written.taken(index)
    elif what == "swap":
        arguments = ["-a", axis + 1, (axis + 1) % 3 + 1]
        order = [0, 1, 2]
        order[axis], order[(axis + 1) % 3] = order[(axis + 1) % 3], order[axis]
        moved = written.permuted(order)
    else:
        axis = int(np.argmax(written.lattice.size))
        arguments = ["-min", 0, *(int(a == axis) for a in range(3)), "-max", *"MMMM"]
        index[axis] = WITHOUT_FIRST
        moved = written.taken(index)
    target = f"step{number}.nrrd"
    run_other(folder, tool("unu"), what, *arguments, "-i", written.file, "-o", target)
    return dataclasses.replace(moved, file=target, words=[*written.words, what])


def write_teem(generator, folder):
    """What pynrrd wrote, through teem's tools: its own header, encoding and order of axes."""
    written = write_nrrd(generator, folder, name="first.nrrd", components_last=False)
    for number in range(int(generator.integers(1, 4))):
        written = moved_by_unu(generator, folder, written, number)
    encoding, kind = str(generator.choice(["raw", "gzip", "ascii"])), str(generator.choice(["float", "double"]))
    run_other(folder, tool("unu"), "convert", "-t", kind, "-i", written.file, "-o", "typed.nrrd")
    run_other(folder, tool("unu"), "save", "-f", "nrrd", "-e", encoding, "-i", "typed.nrrd", "-o", "in.nrrd")
    return dataclasses.replace(written, file="in.nrrd", words=[*written.words, kind, encoding])


def anisotropy(full):
    """FA of symmetric tensors; 0 where there is nothing."""
    values = np.linalg.eigvalsh(full)
    mean = values.mean(axis=-1, keepdims=True)
    size = (values**2).sum(axis=-1)
    return np.sqrt(1.5 * ((values - mean) ** 2).sum(axis=-1) / np.where(size > 0.0, size, 1.0))


class RandomVolumes(RandomChecks):
    def test_random_nifti(self):
        self.readings("nibabel", 120, write_nifti)

    def test_random_itk(self):
        self.readings("ITK", 60, write_itk)

    def test_random_nrrd(self):
        self.readings("pynrrd", 100, write_nrrd)

    @unittest.skipUnless(TEEM, "teem's unu and tend are not installed")
    def test_random_teem(self):
        self.readings("teem", 25, write_teem)

    @unittest.skipUnless(TEEM, "teem's unu and tend are not installed")
    def test_random_volumes_for_teem(self):
        """teem's own anisotropy of what tigereye writes is that of the field, at the same places."""

        def one(generator, folder, words):
            written = write_nrrd(generator, folder, ("3D-symmetric-matrix", "3D-masked-symmetric-matrix"), ("f4",))
            words.extend(written.words)
            run_program(folder, "convert", written.file, "out.nrrd", *written.options)
            run_other(folder, tool("tend"), "anvol", "-a", "fa", "-t", "0.5", "-i", "out.nrrd", "-o", "fa.nrrd")
            found, header = nrrd.read(str(folder / "fa.nrrd"))
            affine = np.eye(4)
            signs = np.array(SPACES[header["space"]])
            affine[:3, :3] = np.diag(signs) @ np.asarray(header["space directions"]).T
            affine[:3, 3] = signs * header["space origin"]
            place, full = written.in_patient()
            # As tensors, so that one comparison serves all.
            as_tensor = [np.asarray(v, float)[..., None, None] * np.eye(3) for v in (found, anisotropy(full))]
            positions = positions_of_affine(found.shape, affine)
            compare_places(positions, as_tensor[0], place, as_tensor[1], SINGLE, "FA by teem")

        self.cases("volumes for teem", 20, one)


class Oracle(RandomChecks):
    """What the other checks trust."""

    def test_pictures_do_not_depend_on_the_order_of_voxels(self):
        """A field whose axes are permuted and reversed is the same field, and shows the same picture."""

        def one(generator, _, words):
            place, kind = lattice(generator)
            words.append(kind)
            full = random_tensors(generator, place.size, symmetric=False)
            there = Written("", place, full, [])
            order = [int(a) for a in generator.permutation(3)]
            index = [WHOLE if generator.random() < 0.5 else BACKWARDS for _ in range(3)]
            moved = there.permuted(order).taken(index)
            axis = int(generator.integers(3))
            at = int(generator.integers(moved.lattice.size[axis]))
            back = at if index[axis] is WHOLE else moved.lattice.size[axis] - 1 - at
            a, b = picture(there, order[axis], back), picture(moved, axis, at)
            for name in ("field", "corner", "right", "up", "spacing"):
                assert np.allclose(getattr(a, name), getattr(b, name), rtol=0.0, atol=1e-12), name

        self.cases("pictures", 200, one)

    def test_orders_name_each_component_once(self):
        for order, entries in ORDERS.items():
            self.assertEqual(len({tuple(sorted(e)) for e in entries}), 6, order)
