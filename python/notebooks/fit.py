# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---

# %% [markdown]
# # Fit a rod to measured reactions
#
# A rod was dragged past a known object. How stiff is it, and how high does the object really lie? Least squares by Gauss and Newton, with
# the exact derivatives of the equilibria. The measurement is simulated, so the answer is known.

# %%
import math

import numpy as np
import numpy.typing as npt

import vibrissa
import vibrissa.plot

LENGTH, STEP = 0.1, 1e-3  # m
SIGMA = np.array([2.5e-3, 2.5e-3, 6e-5])  # N, N, N m
path = vibrissa.ClampPath((0.04, -0.04, math.pi / 2), (0.0, -0.04, math.pi / 2))


def model(stiffness: float, height: float) -> vibrissa.Scene:
    parabola = vibrissa.Composite(vibrissa.Parabola((0.0, 0.0), 50.0), position=(0.0, height))
    return vibrissa.Scene(vibrissa.Rod(LENGTH, stiffness), parabola, path, STEP)


truth = {"stiffness": 6.3e-4, "height": 1e-3}  # N m^2, m
noise = {"white": {"force": SIGMA[0], "m0z": SIGMA[2]}}
measured = vibrissa.simulate(model(**truth), rate=10.0, speed=0.01, noise=noise, seed=2)

# %% [markdown]
# One step of the fit: sweep with the parameters as they are, and ask each state how its reactions change with them.


# %%
def step(parameters: npt.NDArray[np.float64]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """The residuals, in standard deviations, and their derivatives."""
    scene = model(*parameters)
    scan = scene.sweep()
    residuals, rates = [], []
    for number, sample in enumerate(measured):
        state = scan.state(number)
        if not state.contacts:
            continue
        derivatives = vibrissa.Derivatives(scene.rod, scene.objects, state)
        residuals.append((np.array([sample["f0x"], sample["f0y"], sample["m0z"]]) - state.reactions) / SIGMA)
        by = [derivatives.by("stiffness")[0], derivatives.by("object_y")[0]]
        rates.append(np.column_stack(by) / SIGMA[:, None])
    return np.concatenate(residuals), np.concatenate(rates)


# %%
parameters = np.array([5e-4, 0.0])
for iteration in range(8):
    residuals, rates = step(parameters)
    unit = np.array([1e-4, 1e-3])  # so that the two have the same size
    change = np.linalg.lstsq(rates * unit, residuals, rcond=None)[0] * unit
    parameters = parameters + change
    print(f"{iteration}: E I = {parameters[0]:.4e} N m^2, height = {1e3 * parameters[1]:.4f} mm, chi^2 = {residuals @ residuals:.1f}")
residuals, rates = step(parameters)
deviations = np.sqrt(np.diag(np.linalg.inv(rates.T @ rates)))

# %% [markdown]
# The result, with standard deviations, beside the truth. $\chi^2$ should be near the number of residuals.

# %%
for name, value, deviation in zip(truth, parameters, deviations):
    print(f"{name}: {value:.4e} +- {deviation:.1e}, true {truth[name]:.4e}")
    assert abs(value - truth[name]) < 4 * deviation
print(f"chi^2 = {residuals @ residuals:.1f} of {len(residuals)} residuals")

# %% [markdown]
# The fitted reactions, coloured by phase, and the measured ones as dots.

# %%
axes = vibrissa.plot.reactions(model(*parameters).sweep())
for ax, name in zip(axes, ["f0x", "f0y", "m0z"]):
    ax.plot(measured["x0"], measured[name], ".", color="black", markersize=2, zorder=3)
