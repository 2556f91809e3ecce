"""The pages that are opened: a report and two reviews, of experiments made up so that every part of a page is there."""

import os
import pathlib
import subprocess

EXPERIMENT = """(
    format: 1, title: "{title}", source: "here", section: "1", claim: "A claim.", look_for: "Something to see.",
    fields: {{
        "f": Generator(name: "inverse", parameters: {{"size": {size}, "anisotropy": {anisotropy}}}),
        "g": Generator(name: "inverse", parameters: {{"size": 9}}),
    }},
    runs: {{ "light": Light(field: "f", directions: 16, lights: [()], stop: FluxChange(threshold: 0.05)) }},
    figures: [
        (name: "moving", caption: "A figure that moves.", panels: [Glyphs(field: "f", title: "tensors")]),
        (name: "wide", caption: "A wide one.", panels: [
            Glyphs(field: "f", title: "tensors"), Energy(run: "light", decades: 3, title: "light"),
            Glyphs(field: "g", title: "more tensors"),
        ]),
        (name: "still", caption: "One that stays.", panels: [Glyphs(field: "g", title: "tensors")]),
    ],
    checks: [
        (name: "longest semi-axis", quantity: LargestAxis(field: "f"), expect: AtMost(3.2), basis: "semi-axes are roots"),
        (name: "energy at the end", quantity: TotalEnergy(run: "light"), expect: AtLeast(0), basis: "light is not negative"),
    ],
)
"""

SNAPSHOT = """---
source: a.rs
---
Digest(
  slug: "a",
  mean: "{mean}",
  figures: [
    "f {size}",
  ],
)
"""


def tigereye(folder, *arguments, codes=(0,)):
    run = subprocess.run([os.environ["TIGEREYE"], *arguments], cwd=folder, capture_output=True, text=True)
    if run.returncode not in codes:
        raise RuntimeError(f"tigereye {' '.join(arguments)}: {run.returncode}\n{run.stdout}{run.stderr}")


def experiments(folder, side, files):
    """Runs made-up experiments; their results lie in the folder `side`."""
    place = folder / f"{side}-files"
    place.mkdir()
    for slug, values in files.items():
        values = {"title": slug.capitalize(), "size": 11, "anisotropy": 8, **values}
        (place / f"{slug}.ron").write_text(EXPERIMENT.format(**values))
    tigereye(folder, "reproduce", "--experiments", place.name, "--out", side, codes=(0, 1))


def make(folder):
    """The pages by what they are, and the number of dividers on each."""
    folder = pathlib.Path(folder)
    experiments(folder, "before", {"turning": {}, "growing": {}, "constant": {}, "leaving": {}})
    experiments(folder, "after", {"turning": {"anisotropy": 12}, "growing": {"size": 13}, "constant": {}, "coming": {}})
    tigereye(folder, "review", "before", "after", codes=(1,))
    snapshots = folder / "snapshots"
    snapshots.mkdir()
    (snapshots / "digest@a.snap").write_text(SNAPSHOT.format(mean="1.00000000e0", size="10x10"))
    (snapshots / "digest@a.snap.new").write_text(SNAPSHOT.format(mean="1.50000000e0", size="10x20"))
    (snapshots / "digest@b.snap.new").write_text(SNAPSHOT.format(mean="1.00000000e0", size="10x10"))
    tigereye(folder, "review", "--snapshots", "snapshots", "--out", "pending", codes=(1,))
    return {
        "report": folder / "after" / "index.html",
        "review": folder / "review" / "review.html",
        "pending": folder / "pending" / "review.html",
    }
