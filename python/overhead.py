"""What calling from Python costs beside the program's own work.

One light: the time of a call with one step in 3 x 3 cells, which is nearly all call, and of taking the numbers of 101 x 101
cells out of the compiled part, which are copied; beside them, a call of 101 x 101 cells and 51 steps. A gradient: the whole call beside the time that
`tigereye ltg --json` states for the same sweep. Prints the best of several; asserts nothing, because clocks differ.
"""

import json
import os
import subprocess
import tempfile
import time

import numpy as np
import tigereye as te


def best(call, times):
    found = []
    for _ in range(times):
        start = time.perf_counter()
        call()
        found.append(time.perf_counter() - start)
    return min(found)


def main():
    field = te.field("inverse", size=101)
    array = np.asarray(field)
    tiny = te.field("inverse", size=3)
    one = best(lambda: te.propagate(tiny, (1, 1), steps=1), 200)
    light = te.propagate(field, (50, 50), steps=1)
    copy = best(light._native.samples, 50)
    many = best(lambda: te.propagate(field, (50, 50), steps=51), 20)
    print(f"one light: the call {1e3 * one:.3f} ms, its numbers of 101 x 101 cells {1e3 * copy:.3f} ms")
    print(f"one light, 101 x 101, 51 steps: {1e3 * many:.1f} ms in all")
    print(f"an array of 101 x 101 tensors to Tensors: {1e3 * best(lambda: te.Tensors(array), 20):.2f} ms")
    program = os.environ.get("TIGEREYE")
    if program is None:
        return
    small = te.field("inverse", size=21)
    ours = best(lambda: te.ltg(small, directions=16), 3)
    with tempfile.TemporaryDirectory() as folder:
        words = [program, "ltg", "inverse:size=21", "--directions", "16", "--json", "-o", os.path.join(folder, "ltg.npy")]
        theirs = min(
            json.loads(subprocess.run(words, check=True, capture_output=True).stdout)["seconds"]["total"]
            for _ in range(3)
        )
    print(f"ltg, 21 x 21 x 16: {ours:.3f} s; the program states {theirs:.3f} s")


if __name__ == "__main__":
    main()
