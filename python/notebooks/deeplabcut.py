# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---

# %% [markdown]
# # From DeepLabCut to base moments
#
# A camera films a whisker that sweeps against a peg. DeepLabCut tracks points along the whisker. Their bend tells the force of the peg, and
# the force and the moment that the follicle feels. Here the film is simulated, so the truth is known; the file takes the place of yours.
#
# ## A film
#
# The whisker is a rat's, with the numbers of docs/whiskers.md; `rat` and `mouse` of `vibrissa.whiskers` have others. It is bent at rest. It turns
# about its follicle, 5 mm behind its base, past a peg with a radius of 1 mm.

# %%
import csv
import math
import tempfile
from collections import Counter
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.patches import Circle

import vibrissa
from vibrissa.tracking import Frames, read_deeplabcut
from vibrissa.whiskers import Whisker

whisker = Whisker(length=40.8e-3, base_diameter=151.7e-6, tip_diameter=8.6e-6, youngs_modulus=3.34e9)  # m, m, m, Pa
L = whisker.length  # m
rod = whisker.rod(natural_curvature=[[0.0, 8.0], [L, 24.0]])  # m, 1/m
PEG, RADIUS = np.array([0.006, 0.026]), 1e-3  # m
peg = vibrissa.CircularArc(tuple(PEG), RADIUS, 0.0, 2.0 * math.pi)
turn = vibrissa.ClampArc((0.0, 0.0, math.radians(100.0)), (0.0, -0.005), math.radians(-46.0))
scan = vibrissa.sweep(rod, peg, turn, 8e-5)
states = [scan.state(k) for k in range(len(scan))]
first_contact = next(k for k, state in enumerate(states) if state.contacts)
print(f"{len(states)} frames; the whisker is {1e3 * L:.1f} mm long and touches the peg from frame {first_contact} on")

# %% [markdown]
# The camera has pixels of 0.04 mm, and y points down in the image. A tracked point is off by 0.5 pixels (standard deviation). One point in
# twenty is lost: it lies somewhere else, and DeepLabCut gives it a low likelihood.

# %%
SCALE = 4e-5  # m/pixel
NOISE = 0.5  # pixels
BASE = np.array([400.0, 1100.0])  # pixels: where x = y = 0 is in the image


def names(n: int) -> list[str]:
    """The body parts, from the base to the tip."""
    return [f"whisker{k}" for k in range(n)]


def write_film(file: Path, n: int, noise: float, seed: int) -> None:
    """A CSV file as DeepLabCut writes it, with n points along the whisker and one on the nose."""
    rng = np.random.default_rng(seed)
    parts = ["nose", *names(n)]
    with file.open("w", newline="") as stream:
        rows = csv.writer(stream)
        rows.writerow(["scorer"] + ["DLC_Resnet50_film"] * (3 * len(parts)))
        rows.writerow(["bodyparts"] + [part for part in parts for _ in range(3)])
        rows.writerow(["coords"] + ["x", "y", "likelihood"] * len(parts))
        for frame, state in enumerate(states):
            points = np.vstack([[0.0, -0.01], state.shape(rod, n)[:, :2]])
            pixels = BASE + points * [1.0, -1.0] / SCALE + rng.normal(0.0, noise, points.shape)
            is_lost = rng.random(len(parts)) < 0.05
            pixels[is_lost] += rng.normal(0.0, 40.0, (is_lost.sum(), 2))
            likelihood = np.where(is_lost, rng.uniform(0.0, 0.5, len(parts)), rng.uniform(0.9, 1.0, len(parts)))
            rows.writerow([frame, *np.column_stack([pixels, likelihood]).ravel().tolist()])


folder = Path(tempfile.mkdtemp())
write_film(folder / "film.csv", 12, NOISE, seed=1)
print(*[line[:78] for line in (folder / "film.csv").read_text().splitlines()[:5]], sep="\n")

# %% [markdown]
# ## Read it
#
# `bodyparts` names the points of the whisker from the base to the tip. Points of a likelihood below `least_likelihood` are left out. The result
# is in m, with y up.
#
# The first point of a frame must be the base, because the arc length counts from there. If the base is lost, the second point takes its place,
# and the forces are wrong by half their size and more, while their verdict is still `determined`. So leave out frames without a base. A file read
# with the first two body parts alone keeps the frames that show both of them, so a lost second point costs the frame, too.


# %%
def read_film(file: Path, n: int) -> dict[int, npt.NDArray[np.float64]]:
    """The points of the frames that show the base, in m."""
    frames: Frames = read_deeplabcut(file, names(n), scale=SCALE, least_likelihood=0.6)
    at_base = read_deeplabcut(file, names(n)[:2], scale=SCALE, least_likelihood=0.6).numbers
    return {int(k): frames.of(int(k)) for k in at_base}


film = read_film(folder / "film.csv", 12)
counts = Counter(len(points) for points in film.values())
print(f"{len(film)} of {len(states)} frames show the base;", *[f"{counts[n]} with {n} points," for n in sorted(counts)])

# %% [markdown]
# ## Forces
#
# The stiffness comes from the diameters and Young's modulus. The shape at rest comes from the film: `rest` takes frames in which nothing touches
# the whisker. In your film you pick them by eye. Take them well before the contact, because a light touch in one of them bends the shape at
# rest. Here they are the frames up to the fourth before the contact. So the rod in this call is straight, and its curvature is found.

# %%
free = {k: points for k, points in film.items() if k < first_contact - 3}
others = {k: points for k, points in film.items() if k not in free}
found = vibrissa.forces(whisker.rod(), others, rest=free)
print(found)
print(f"noise of a point: {found.sigma / SCALE:.2f} pixels, true {NOISE}; frames that cannot be used: {found.faults}")

# %% [markdown]
# The curvature at rest goes from 8 1/m to 24 1/m. The figure shows how far the found one is off, with a band of two standard deviations. All
# frames share this error, so the errors of neighbouring frames below are not independent. More free frames make it smaller.

# %%
assert found.rest is not None
s, curvature, sigma = found.rest.T
figure, ax = plt.subplots(figsize=(6, 3.2), layout="constrained")
off = curvature - (8.0 + 16.0 * s / L)
ax.fill_between(1e3 * s, off - 2.0 * sigma, off + 2.0 * sigma, alpha=0.3, linewidth=0.0)
ax.plot(1e3 * s, off)
ax.axhline(0.0, color="k", linewidth=1.0)
ax.set_xlabel("arc length in mm")
ax.set_ylabel("curvature at rest,\nfound less true, in 1/m")

# %% [markdown]
# `found.frames` has a row for each frame: the verdict, the contact next to the base, the force and moment at the base, and standard
# deviations. `found.contacts` has a row for each contact; explanation 0 is the best one.

# %%
table, contacts = found.frames, found.contacts
for row in table[::4]:
    print(
        f"frame {row['frame']:2d}: {row['verdict']:5s} s = {1e3 * row['s']:4.1f} +- {1e3 * row['sigma_s']:.1f} mm, force "
        f"{1e6 * row['force']:4.1f} +- {1e6 * row['sigma_force']:.1f} uN, m0z {1e6 * row['m0z']:6.3f} uN m, p = {row['p_value']:.2g}"
    )

# %% [markdown]
# Points, and the force of the peg on the whisker.

# %%
figure, ax = plt.subplots(figsize=(7, 7), layout="constrained")
origin = BASE * [1.0, -1.0] * SCALE  # x = y = 0 in m of the image
ax.add_patch(Circle(tuple(1e3 * PEG), 1e3 * RADIUS, color="0.7"))
touching = [k for k in others if k >= first_contact]
shown = touching[:: max(1, len(touching) // 5)]
colors = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, len(shown)))
for k, color in zip(shown, colors):
    x, y = 1e3 * (others[k] - origin).T
    ax.plot(x, y, ".-", color=color, linewidth=0.8, label=f"frame {k}")
    for contact in contacts[(contacts["frame"] == k) & (contacts["explanation"] == 0)]:
        x, y = 1e3 * contact["x"] - 1e3 * origin[0], 1e3 * contact["y"] - 1e3 * origin[1]
        arrow = 0.25e6 * np.array([contact["fx"], contact["fy"]])  # 0.25 mm for 1 uN
        ax.annotate("", (x + arrow[0], y + arrow[1]), (x, y), arrowprops={"arrowstyle": "->", "color": color, "linewidth": 2.0})
ax.annotate("", (-8.0, 2.0), (-13.0, 2.0), arrowprops={"arrowstyle": "->", "linewidth": 2.0})
ax.text(-10.5, 2.8, "20 uN", ha="center")
ax.set_aspect("equal")
ax.set_xlim(-16.0, 26.0)
ax.set_xlabel("x in mm")
ax.set_ylabel("y in mm")
ax.legend(frameon=False, loc="lower right")

# %% [markdown]
# ## Against the truth
#
# Bars are two standard deviations. They are those of the noise of the points and of the shape at rest. They do not have the error of the
# stiffness: all forces and moments are proportional to Young's modulus, whose standard deviation in rats is 44 % (Quist et al. 2011).

# %%
true = {
    "m0z": np.array([state.reactions[2] for state in states]),
    "force": np.array([state.contacts[0].force if state.contacts else 0.0 for state in states]),
    "s": np.array([state.contacts[0].s if state.contacts else math.nan for state in states]),
}
is_determined = table["verdict"] == "determined"
figure, axes = plt.subplots(3, 1, figsize=(7, 8), sharex=True, layout="constrained")
labels = {"m0z": ("moment at the base in uN m", 1e6), "force": ("force of the peg in uN", 1e6), "s": ("place of the contact in mm", 1e3)}
for ax, (name, (label, factor)) in zip(axes, labels.items()):
    ax.plot(factor * true[name], "k-", linewidth=1.0, label="true")
    determined = table[is_determined]
    ax.errorbar(determined["frame"], factor * determined[name], 2.0 * factor * determined[f"sigma_{name}"], fmt=".", capsize=2.0, label="determined")
    if name != "s":
        untouched = table["frame"][table["verdict"] == "free"]
        ax.plot(untouched, np.zeros(len(untouched)), "o", markerfacecolor="none", label="free")
    ax.set_ylabel(label)
axes[0].legend(frameon=False)
axes[-1].set_xlabel("frame")
axes[-1].set_xlim(first_contact - 5.0, None)

# %% [markdown]
# A check. The floors are far below what matters: about one percent of the largest moment and force.

# %%
floors = {"m0z": 5e-9, "force": 5e-7}  # N m, N
for name, floor in floors.items():
    off = np.abs(table[name] - true[name][table["frame"]])[is_determined]
    deviations = table[f"sigma_{name}"][is_determined]
    assert (off < 4.0 * deviations + floor).all(), name
    print(f"{name}: {is_determined.sum()} frames, at most {(off / deviations).max():.1f} standard deviations off")

# %% [markdown]
# ## Verdicts
#
# The verdict says how much a frame tells.
#
# - `free`: no force beyond the noise. The whisker may still be touched lightly.
# - `determined`: contact, force, and force and moment at the base are determined.
# - `uncertain`: there is a contact, but its place is known to no better than a tenth of the length, or its force to no better than half of it.
#   The moment at the base may be known well.
# - `family`: place and force are not determined separately. A weak force far out bends the whisker as a strong one nearby does.
# - `several`: other contacts explain the frame as well. `found.contacts` lists them as explanations 1, 2, ...
# - `not explained`: no shape with up to two contacts fits (probability below 0.001): a point that was tracked on something else, another
#   whisker, a wrong stiffness profile. `fault`: the points cannot be used at all; `found.faults` says why.
#
# Use `determined`. Use the moment of `uncertain` with its standard deviation. Look at the film where it says anything else.
#
# ## How many points?
#
# The same film with 5 and with 20 points along the whisker, and two worse ones with 12 points: with four times the noise, and with the outer
# five points not tracked, so that all points lie on the near side of the contact. The noise is given here, because five points are few to
# find it from: it comes out too small.


# %%
def forces_of(n: int, noise: float, last: int) -> vibrissa.Forces:
    """Forces of a film with n points along the whisker, of which the first ones are used."""
    file = folder / f"film{n}.csv"
    write_film(file, n, noise, seed=2)
    every = read_film(file, last)
    free = {k: points for k, points in every.items() if k < first_contact - 3}
    return vibrissa.forces(whisker.rod(), {k: every[k] for k in every if k >= first_contact}, rest=free, sigma=noise * SCALE)


films = {
    "5 points": forces_of(5, NOISE, 5),
    "12 points": forces_of(12, NOISE, 12),
    "20 points": forces_of(20, NOISE, 20),
    "12 points, 2 pixels": forces_of(12, 4.0 * NOISE, 12),
    "7 inner points of 12": forces_of(12, NOISE, 7),
}
figure, axes = plt.subplots(2, 1, figsize=(7, 6.5), sharex=True, layout="constrained")
for title, result in films.items():
    rows = result.frames
    verdicts = Counter(rows["verdict"].tolist())
    rows = rows[rows["verdict"] == "determined"]
    print(
        f"{title:21s} sigma of m0z {1e9 * np.median(rows['sigma_m0z']):4.1f} nN m, of the force {1e6 * np.median(rows['sigma_force']):.2f} uN, "
        f"of s {1e3 * np.median(rows['sigma_s']):.2f} mm (medians);",
        *[f"{count} {verdict}" for verdict, count in verdicts.most_common()],
    )
    for ax, name, factor in zip(axes, ["m0z", "force"], [1e9, 1e6]):
        ax.semilogy(rows["frame"], factor * rows[f"sigma_{name}"], ".-", linewidth=0.8, label=title)
axes[0].set_ylabel("sigma of m0z in nN m")
axes[1].set_ylabel("sigma of the force in uN")
figure.legend(*axes[0].get_legend_handles_labels(), frameon=False, fontsize="small", ncols=3, loc="outside upper center")
axes[-1].set_xlabel("frame")

# %% [markdown]
# Five points are enough here, because one contact needs few numbers; 20 points halve the standard deviation. It falls about as the root of the
# number of points grows, and grows about in proportion to the noise of a point. Where the points are matters more: those beyond the contact
# show the shape that the force does not bend, and without them the contact must be found from the near side alone. Single frames that stand
# out have lost points.
