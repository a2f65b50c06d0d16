# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---

# %% [markdown]
# # From a recording to the object
#
# A recording is a table with the pose of the clamp and the three reactions: `x0`, `y0` (m), `phi0` (rad), `f0x`, `f0y` (N), `m0z` (N m).
# Here it is simulated, with the noise of an ordinary sensor, and written to a file, which takes the place of yours. Run it in the folder
# `python/notebooks`.

# %%
import tempfile
from pathlib import Path

import numpy as np

import vibrissa
import vibrissa.plot

scene = vibrissa.Scene.read("../../scenes/O1_q40.toml")
noise = {"white": {"force": 2.5e-3, "m0z": 6e-5}}  # standard deviations in N, N m
simulated = vibrissa.simulate(scene, rate=500.0, speed=0.01, noise=noise, seed=1)
file = Path(tempfile.mkdtemp()) / "recording.csv"
columns = ["t", "x0", "y0", "phi0", "f0x", "f0y", "m0z"]
table = np.column_stack([simulated[name] for name in columns])
np.savetxt(file, table, delimiter=",", header=",".join(columns), comments="", fmt="%.17g")

# %% [markdown]
# ## Reconstruct
#
# The rod must be known: its length and stiffness, or diameter and Young's modulus.

# %%
recording = vibrissa.Recording.read(file, scene.rod)
found = vibrissa.reconstruct(scene.rod, recording)
print(found)
print("recording, units and rod fit:", found.fits, *found.findings)

# %% [markdown]
# Each sample has a phase, and a contact point with standard deviations.

# %%
found.to_pandas()[["x0", "label", "probability", "x", "y", "sigma_x", "sigma_y", "reason"]].iloc[::600]

# %% [markdown]
# ## The contour
#
# With a band of two standard deviations. The true objects, which a real recording does not have, are dashed.

# %%
ax = vibrissa.plot.contour(found, objects=scene.objects)

# %% [markdown]
# How far off is it? Here the truth is known. Phase BB, with two contacts along the rod, is short, and in this noise it is sometimes taken
# for a phase with one contact (in 2 of the 12 recordings with seeds 0 to 11; this is one of them). The points of those samples are wrong by
# millimetres, far beyond their standard deviations. So look at the labels and at the figure: where a phase that a neighbouring scan has
# is missing, record again, slower or with less noise.

# %%
known = found.contour[found.contour["sigma"] < 1e-3]
gaps = np.abs(scene.objects[0].gap(known["x"], known["y"]))
off = gaps > 5.0 * known["sigma"]
print("phases", [label for _, _, label in found.runs], "true", [phase for phase in scene.sweep().phases])
print(f"{len(known)} points that are known to 1 mm; distance from the contour: median {1e3 * np.median(gaps):.3f} mm,")
print(f"largest {1e3 * gaps.max():.3f} mm; {off.sum()} of them are off by more than 5 standard deviations")
