#!/usr/bin/env bash
# Believed: MRtrix reads a tensor image that follows the NIfTI standard (five axes, intent SYMMATRIX), or refuses what is not six volumes.
# So:       tensor2metric takes the fourth axis for the components, which has length 1 there, computes with the first component and
#           nothing for the others, and succeeds.
# Matters:  wherever xx is positive FA is 1 and the fibre runs along x. Such files are written by ITK and ANTs, so the maps look like
#           maps of something.
set -euo pipefail
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
# The libraries are those of the same release of Debian.
apt-get download -q mrtrix3=3.0.3-3+b1 libtiff6 libwebp7 libzstd1 liblzma5 liblerc4 libjbig0 libjpeg62-turbo libdeflate0 \
    libpng16-16 libgomp1 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in *.deb; do dpkg -x "$package" debian; done
export LD_LIBRARY_PATH="$place/debian/usr/lib/x86_64-linux-gnu"
export PATH="$place/debian/usr/lib/mrtrix3/bin:$place/debian/usr/bin:$PATH"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check nibabel==5.4.2 numpy==2.4.6
env/bin/python - <<'PY'
import subprocess
import sys
import nibabel
import numpy as np

version = subprocess.run(["tensor2metric", "--version"], capture_output=True, text=True, check=True).stdout.split("\n")[0]
values = np.array([0.3e-3, 0.3e-3, 1.7e-3])
fraction = float(np.sqrt(1.5 * ((values - values.mean()) ** 2).sum() / (values**2).sum()))
print(version, "- nibabel", nibabel.__version__, f"- a fibre along z: FA {fraction:.3f}, mean diffusivity {values.mean():.3g}")
xx, yy, zz = values
found = {}
for name, numbers, axes, intent in [
    ("four axes, MRtrix's order", [xx, yy, zz, 0, 0, 0], (6,), None),
    ("five axes, the standard's order", [xx, 0, yy, 0, 0, zz], (1, 6), (1005, (3,))),
]:
    image = nibabel.Nifti1Image(np.tile(np.float32(numbers).reshape(axes), (3, 3, 3, *[1] * len(axes))), np.eye(4))
    if intent:
        image.header.set_intent(*intent)
    case = name[:4]
    nibabel.save(image, f"{case}.nii")
    maps = {measure: f"{case}-{measure}.nii" for measure in ("fa", "adc", "vector")}
    command = ["tensor2metric", *(word for m, file in maps.items() for word in (f"-{m}", file)), "-modulate", "none", f"{case}.nii"]
    done = subprocess.run(command, capture_output=True, text=True)
    print(f"{name}: exit {done.returncode}")
    if done.returncode != 0 or "WARNING" in done.stderr:
        sys.exit(f"it says: {done.stderr}")
    found[case] = [np.asarray(nibabel.load(file).dataobj)[1, 1, 1] for file in maps.values()]
    fa, mean, vector = found[case]
    print(f"    FA {fa:.3f}, mean diffusivity {mean:.3g}, vector {np.abs(vector).tolist()}")
right = np.allclose([*found["four"][:2], found["four"][2][2] ** 2], [fraction, values.mean(), 1.0], atol=1e-6)
wrong = np.allclose([*found["five"][:2], found["five"][2][0] ** 2], [1.0, xx / 3, 1.0], atol=1e-6)
sys.exit(0 if right and wrong else 1)
PY
