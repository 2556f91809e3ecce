#!/usr/bin/env bash
# Believed: NRRD's measurement frame M turns a measured tensor D into M D M^T in the world, and the 3 x 3 array that pynrrd gives under
#           "measurement frame" is M.
# So:       the file lists the frame's axes one by one, which are the columns of M, and pynrrd makes each of them a row: the array is M^T.
#           It writes what it reads, so no round trip shows it. teem, whose format it is, turns by the columns.
# Matters:  tensors turn the wrong way round; eigenvalues, FA and every frame that is a reflection or half turn look right.
set -euo pipefail
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
apt-get download -q teem-apps=1.12.0~20160122-5 libteem2=1.12.0~20160122-5 libpng16-16 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in *.deb; do dpkg -x "$package" debian; done
export LD_LIBRARY_PATH="$place/debian/usr/lib:$place/debian/usr/lib/x86_64-linux-gnu"
export PATH="$place/debian/usr/bin:$PATH"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check pynrrd==1.1.3 numpy==2.4.6
env/bin/python - <<'PY'
import subprocess
import sys
import nrrd
import numpy as np

angle = np.radians(30)
array = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
measured = np.diag([3.0, 2.0, 1.0])
ENTRIES = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]
# A confidence of 1 before the six numbers of each of 2 x 2 x 2 voxels; teem wants single precision.
tuples = np.float32([1.0, *(measured[e] for e in ENTRIES)])
header = {
    "kinds": ["3D-masked-symmetric-matrix", "space", "space", "space"],
    "space": "right-anterior-superior",
    "space directions": np.vstack([[np.nan] * 3, np.eye(3)]),
    "space origin": np.zeros(3),
    "measurement frame": array,
}
nrrd.write("measured.nrrd", np.tile(tuples[:, None, None, None], (1, 2, 2, 2)), header)
_, again = nrrd.read("measured.nrrd")
line = next(l for l in open("measured.nrrd", "rb").read().split(b"\n") if l.startswith(b"measurement frame"))
print("pynrrd", nrrd.__version__, "- the same array read again:", np.allclose(again["measurement frame"], array))
print(line.decode())

# teem takes the frame out: its numbers are along the world's axes.
subprocess.run(["teem-tend", "unmf", "-i", "measured.nrrd", "-o", "world.nrrd"], check=True)
said = subprocess.run(["teem-unu", "--version"], capture_output=True, text=True)
values, _ = nrrd.read("world.nrrd")
world = np.zeros((3, 3))
for number, (i, j) in zip(values[1:, 0, 0, 0], ENTRIES):
    world[i, j] = world[j, i] = number
by_array, by_transpose = array @ measured @ array.T, array.T @ measured @ array
print("teem", (said.stdout or said.stderr).strip().splitlines()[:1], "- xx, xy, yy in the world:", world[[0, 0, 1], [0, 1, 1]].round(4).tolist())
print("by pynrrd's array:", by_array[[0, 0, 1], [0, 1, 1]].round(4).tolist(), "- by its transpose:", by_transpose[[0, 0, 1], [0, 1, 1]].round(4).tolist())
close = lambda a: np.allclose(world, a, atol=1e-5)
sys.exit(0 if close(by_transpose) and not close(by_array) and np.allclose(again["measurement frame"], array) else 1)
PY
