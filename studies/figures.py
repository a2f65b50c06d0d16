"""The figures and numbers of docs/limit-distance.md, from the tables of the five studies.

    for study in right_higher left_higher circles notch hollow; do vibrissa study studies/$study.toml; done
    python3 studies/figures.py out docs

Needs numpy and matplotlib.
"""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

PARAMETERS = {
    "right_higher": ("spacing", "coefficient", "rise"),
    "left_higher": ("spacing", "coefficient", "rise"),
    "circles": ("radius", "gap"),
    "notch": ("half_width", "depth"),
    "hollow": ("half_width", "depth"),
}
# A point of the contour wrong by more than this, in lengths of the rod, is an error that matters.
MATTERS = 0.01
# An interval that grows by less than a fifth of a step of the scenes, in lengths of the rod, is taken to be as long.
SAME = 2e-3
KINDS = ["single contact", "C1", "C2", "C3", "others with two contacts"]
COLOURS = ["#f2f2f2", "#4477aa", "#66ccee", "#ee6677", "#ccbb44"]


def rows(file):
    with open(file, newline="") as table:
        return [row for row in csv.DictReader(table) if row["status"] == "done"]


def families(name, table):
    """The rows of each combination of the other parameters, by distance; those with a refused or stopped scene left out."""
    found = {}
    for row in table:
        found.setdefault(tuple(float(row[key]) for key in PARAMETERS[name]), []).append(row)
    most = max(len(rows) for rows in found.values())
    return {key: sorted(rows, key=lambda row: float(row["distance"])) for key, rows in found.items() if len(rows) == most}


def column(rows, name):
    return np.array([float(row[name] or 0.0) for row in rows])


def kind(row):
    if float(row["several"]) <= 0.0:
        return 0
    return KINDS.index(row["cycle"]) if row["cycle"] else 4


def numbers(name, table):
    longest, falls, limits, naive = [], [], [], []
    for rows_of in families(name, table).values():
        distance, several, error = (column(rows_of, key) for key in ("distance", "several", "naive_error"))
        top = int(several.argmax())
        longest.append(distance[top])
        falls.append(bool((np.diff(several[top:]) <= SAME).all()))
        limits.append(distance[several > 0.0].max(initial=0.0))
        naive.append(distance[error > MATTERS].max(initial=0.0))
    spread = lambda values: " to ".join(f"{value:.3f}" for value in np.quantile(values, [0.0, 0.5, 1.0]))
    print(
        f"{name}: {len(table)} scenes, {len(limits)} families; longest interval at q = {spread(longest)}, "
        f"falls beyond in {100 * np.mean(falls):.0f} %; last two contacts at q = {spread(limits)}; "
        f"last error above {MATTERS} L at q = {spread(naive)}"
    )


def planes(tables, out):
    panels = [
        ("right_higher", 0.0, "both as high (O1)"),
        ("right_higher", 0.1, "right one 0.1 L higher (O2)"),
        ("left_higher", 0.1, "left one 0.1 L higher (O3)"),
    ]
    figure, axes = plt.subplots(1, 3, figsize=(10.5, 3.6), sharey=True, layout="constrained")
    for axis, (name, rise, title) in zip(axes, panels):
        of = [r for r in tables[name] if float(r["rise"]) == rise and float(r["coefficient"]) == 5.0]
        xs, ys = (sorted({float(row[key]) for row in of}) for key in ("distance", "spacing"))
        plane = np.full((len(ys), len(xs)), np.nan)
        for row in of:
            plane[ys.index(float(row["spacing"])), xs.index(float(row["distance"]))] = kind(row)
        edges = [side for of in (xs, ys) for side in (1.5 * of[0] - 0.5 * of[1], 1.5 * of[-1] - 0.5 * of[-2])]
        look = {"cmap": ListedColormap(COLOURS), "vmin": -0.5, "vmax": 4.5, "interpolation": "nearest"}
        axis.imshow(plane, origin="lower", extent=edges, aspect="auto", **look)
        axis.plot([0.2, 0.4, 0.6], [0.3] * 3, "k+", markersize=8)
        axis.set(title=title, xlabel="distance q (L)")
    axes[0].set_ylabel("spacing of the vertices (L)")
    keys = [Patch(facecolor=colour, edgecolor="grey", label=label) for colour, label in zip(COLOURS, KINDS)]
    figure.legend(handles=keys, loc="outside lower center", ncols=5, frameon=False)
    figure.savefig(out / "limit-distance-cycles.svg", metadata={"Date": None})


def lengths(tables, out):
    figure, axes = plt.subplots(1, 3, figsize=(10.5, 3.4), layout="constrained")
    of = families("right_higher", tables["right_higher"])
    for spacing, colour in zip([0.2, 0.3, 0.4, 0.6], ["#332288", "#117733", "#cc6677", "#ddaa33"]):
        key = min(of, key=lambda key: abs(key[0] - spacing) + abs(key[1] - 5.0) + abs(key[2]))
        distance = column(of[key], "distance")
        axes[0].plot(distance, column(of[key], "several"), color=colour, label=f"spacing {spacing} L")
        axes[1].plot(distance, column(of[key], "naive_error"), color=colour)
    axes[0].set(title="two parabolas: interval with two contacts (L)", xlabel="distance q (L)")
    axes[1].set(title="largest naive error (L)", xlabel="distance q (L)")
    axes[0].legend(frameon=False)
    limits = {}
    for name, table in tables.items():
        limits[name] = [column(f, "distance")[column(f, "several") > 0.0].max(initial=0.0) for f in families(name, table).values()]
    axes[2].boxplot(list(limits.values()), tick_labels=[name.replace("_", "\n") for name in limits], whis=(0, 100))
    axes[2].set(title="largest q with two contacts (L)", ylim=(0, 1))
    figure.savefig(out / "limit-distance-intervals.svg", metadata={"Date": None})


def main():
    source, out = (Path(argument) for argument in sys.argv[1:3])
    matplotlib.rcParams.update({"svg.hashsalt": "vibrissa", "font.size": 9, "axes.titlesize": 9})
    tables = {name: rows(source / name / "rows.csv") for name in PARAMETERS}
    for name, table in tables.items():
        numbers(name, table)
    planes(tables, out)
    lengths(tables, out)


main()
