"""The figure of a sweep, still and moving."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes

from .._core import Scan
from ._along import reactions
from ._course import course
from ._palette import INK, phase_color
from ._plane import Window, _curves, shapes
from ._style import LINE, PAGE, legend, new_figure, style


def sweep(scan: Scan) -> list[Axes]:
    """The figure of a sweep: shapes on the left, reactions on the right; two columns of a journal wide.

    Parameters
    ----------
    scan : Scan
        What to draw.

    Returns
    -------
    list of matplotlib.axes.Axes
        That of the shapes, and those of f0x, f0y and m0z. ``axes[0].figure.savefig(file)`` writes the figure.
    """
    left, *right = _beside_each_other(_curves(scan, 60)[1])
    shapes(scan, left)
    reactions(scan, right)
    legend(left)
    return [left, *right]


def _beside_each_other(window: Window) -> list[Axes]:
    """Axes for shapes on the left, as wide as these need, and three for the reactions on the right."""
    ratio = (window[1] - window[0]) / (window[3] - window[2])
    width = min(max(80.0 * ratio, 40.0), 85.0)
    with style():
        figure = new_figure(PAGE, min(max(width / ratio, 65.0), 80.0) + 20.0)
        grid = figure.add_gridspec(3, 2, width_ratios=[width, PAGE - 32.0 - width])
        top = figure.add_subplot(grid[0, 1])
        right = [top, *(figure.add_subplot(grid[row, 1], sharex=top) for row in (1, 2))]
        for ax in right[:2]:
            ax.tick_params(labelbottom=False)
        return [figure.add_subplot(grid[:, 0]), *right]


def animate(scan: Scan, *, frames: int = 120, interval: float = 50.0) -> FuncAnimation:
    """A moving figure of a sweep: the rod at its objects on the left, the reactions up to now on the right.

    Parameters
    ----------
    scan : Scan
        What to draw.
    frames : int, optional
        Largest number of frames, equally far apart in the states of the scan; the last one is its last state.
    interval : float, optional
        Time of a frame in ms.

    Returns
    -------
    matplotlib.animation.FuncAnimation
        ``animation.save("sweep.gif", writer="pillow")`` writes it; ``.mp4`` needs ffmpeg. In a notebook,
        ``IPython.display.HTML(animation.to_jshtml())`` shows it.

    Raises
    ------
    ValueError
        The scan has no states, or ``frames`` is less than 1.
    """
    if not len(scan):
        raise ValueError("the scan has 0 states, expected one or more")
    if frames < 1:
        raise ValueError(f"frames is {frames}, expected 1 or more")
    chosen = np.unique(np.linspace(len(scan) - 1, 0, min(frames, len(scan))).round().astype(int))
    # the axes are those of the whole scan, which then fades
    left, *right = sweep(scan)
    for line in [line for ax in (left, *right) for line in ax.lines]:
        line.set_alpha(0.15)
    found = course(scan)
    along = found.over()[0][found.states]
    (rod,) = left.plot([], [], linewidth=LINE)
    (touches,) = left.plot([], [], "o", color=INK, markersize=2.5)
    dots = [ax.plot([], [], "o", markersize=3.0)[0] for ax in right]
    title = left.set_title(" ")

    def draw(i: int) -> list[Any]:
        state = scan.state(int(i))
        color = phase_color(state.phase)
        shape = scan.shape(int(i), 200)
        rod.set_data(shape[:, 0], shape[:, 1])
        rod.set_color(color)
        touches.set_data([one.x for one in state.contacts], [one.y for one in state.contacts])
        for dot, value in zip(dots, state.reactions):
            dot.set_data([along[i]], [value])
            dot.set_color(color)
        title.set_text(state.phase)
        return [rod, touches, *dots, title]

    return FuncAnimation(left.get_figure(root=True), draw, frames=chosen, interval=interval)  # type: ignore[arg-type]
