# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---

# %% [markdown]
# # The nine scans of the paper
#
# Merker, Scharff and Behn (2020) drag a steel wire past three objects at three distances. `scenes/` has these nine scans. Here each is
# swept, and drawn as in the paper: the shapes of the rod, the reactions at the clamp, and the criterion that tells contact at the tip
# from contact along the rod. Run it in the folder `python/notebooks`.

# %%
from pathlib import Path

import matplotlib.pyplot as plt

import vibrissa
import vibrissa.plot

scenes = Path("../../scenes")
names = [f"O{number}_q{distance}" for number in (1, 2, 3) for distance in (20, 40, 60)]
scans = {name: vibrissa.Scene.read(scenes / f"{name}.toml").sweep() for name in names}

# %% [markdown]
# The phases: A is one contact at the tip, B one along the rod, and two letters are two contacts.

# %%
for name, scan in scans.items():
    print(name, " ".join(scan.phases))

# %% [markdown]
# ## Shapes
#
# Rows are objects, columns are distances of the clamp. Dark shapes are those just before a transition. Figures with several panels are yours: give each
# function its axes. `style` has fonts and sizes for a journal.

# %%
with vibrissa.plot.style():
    figure, grid = plt.subplots(3, 3, figsize=(8, 6.5), layout="constrained")
    for (name, scan), ax in zip(scans.items(), grid.flat):
        vibrissa.plot.shapes(scan, ax, most=30)
        ax.set_title(name)

# %% [markdown]
# ## Reactions

# %%
with vibrissa.plot.style():
    for number in (1, 2, 3):
        figure, grid = plt.subplots(3, 3, figsize=(8, 5), sharex="col", layout="constrained")
        for column, distance in zip(grid.T, (20, 40, 60)):
            name = f"O{number}_q{distance}"
            vibrissa.plot.reactions(scans[name], list(column))
            column[0].set_title(name, pad=22)

# %% [markdown]
# ## Criterion
#
# It is zero while the last contact is along the rod, and negative while it is at the tip.

# %%
with vibrissa.plot.style():
    figure, grid = plt.subplots(3, 3, figsize=(8, 6), layout="constrained")
    for (name, scan), ax in zip(scans.items(), grid.flat):
        vibrissa.plot.criterion(scan, ax)
        ax.set_title(name, pad=22)
