# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---

# %% [markdown]
# # A shape of one's own
#
# Points are enough for a first look: a closed spline through them.

# %%
import math

import numpy as np
import numpy.typing as npt

import vibrissa
import vibrissa.plot

rod = vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9)  # m, m, Pa
path = vibrissa.ClampPath((0.08, -0.03, math.pi / 2), (-0.05, -0.03, math.pi / 2))
pear = vibrissa.Spline([(0.0, 0.0), (0.02, 0.02), (0.01, 0.05), (-0.01, 0.05), (-0.02, 0.02)], end="periodic")
axes = vibrissa.plot.sweep(vibrissa.sweep(rod, pear, path, step=1e-3))

# %% [markdown]
# ## A formula
#
# Any object with a method `frame` is a shape: for parameters t it gives x, y, the angle of the tangent, the speed along the curve,
# and the rate of that angle. The solid lies on the left. This is a wave. It is asked point by point, so the step is larger.


# %%
class Wave:
    range = (-1.0, 1.0)

    def frame(self, t: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        x, k, height = 0.1 * t, 60.0, 6e-3
        y = 0.02 + 8.0 * x**2 + height * np.cos(k * x)
        slope, bend = 16.0 * x - height * k * np.sin(k * x), 16.0 - height * k**2 * np.cos(k * x)
        return np.array([x, y, np.arctan(slope), 0.1 * np.hypot(1.0, slope), 0.1 * bend / (1.0 + slope**2)])


# %% [markdown]
# `check_contract` compares the rates with differences of the points, and says what is wrong.

# %%
vibrissa.check_contract(Wave())
scan = vibrissa.sweep(rod, Wave(), path, step=4e-3)
print(" ".join(scan.phases))
axes = vibrissa.plot.sweep(scan)
