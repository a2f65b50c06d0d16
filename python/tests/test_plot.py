"""Figures: what is drawn, and in which colours."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import SCENES, Hump
from matplotlib.colors import to_hex

import vibrissa
import vibrissa.plot


@pytest.fixture(scope="module")
def scan() -> vibrissa.Scan:
    return vibrissa.Scene.read(SCENES / "O1_q40.toml").sweep()


def test_phases_have_the_colours_of_the_command() -> None:
    palette = (SCENES.parent / "cli/src/figure/palette.rs").read_text()
    for phase in ["free", "A", "B", "BA", "BB", "BBA", "BBB", "BBBB"]:
        color = vibrissa.plot.phase_color(phase)
        numbers = ", ".join(str(int(color[k : k + 2], 16)) for k in (1, 3, 5))
        assert f"RGBColor({numbers})" in palette, phase


def test_the_figure_of_a_sweep(scan: vibrissa.Scan) -> None:
    left, *right = vibrissa.plot.sweep(scan)
    # 57 shapes and one for each transition
    assert len(left.lines) == 57 + len(scan.events)
    assert len(left.collections) == len(scan.objects)
    drawn = [line for line in right[0].lines if len(line.get_xdata()) > 2]  # type: ignore[arg-type]
    phases = [phase for _, _, phase in vibrissa.plot._runs(scan.states["phase"])]
    assert [to_hex(line.get_color()) for line in drawn] == [vibrissa.plot.phase_color(phase) for phase in phases]
    lines = [line for line in right[2].lines if len(line.get_xdata()) > 2]  # type: ignore[arg-type]
    moments = np.concatenate([np.asarray(line.get_ydata()) for line in lines])
    np.testing.assert_array_equal(moments, 1e3 * scan.states["m0z"])
    left.figure.canvas.draw()
    plt.close("all")


def test_the_outline_lies_on_the_object(scan: vibrissa.Scan) -> None:
    ax = plt.figure().add_subplot()
    vibrissa.plot.object_outline(ax, scan.objects, (-0.03, 0.06, -0.01, 0.03))
    (lines,) = ax.collections
    points = np.concatenate([path.vertices for path in lines.get_paths()])
    assert np.abs(scan.objects[0].gap(1e-3 * points[:, 0], 1e-3 * points[:, 1])).max() < 1e-4
    plt.close("all")


def test_axes_can_be_passed_in(scan: vibrissa.Scan) -> None:
    _, axes = plt.subplots(2, 3)
    assert vibrissa.plot.criterion(scan, axes[0, 0]) is axes[0, 0]
    assert vibrissa.plot.shapes(scan, axes[0, 1], most=5) is axes[0, 1]
    assert vibrissa.plot.reactions(scan, axes[1])[2] is axes[1, 2]
    with pytest.raises(ValueError, match="there are 2 axes, expected three"):
        vibrissa.plot.reactions(scan, list(axes[0, :2]))
    # the criterion vanishes while the last contact is tangential, and is negative at the tip
    criterion = vibrissa.plot.phase_criterion(scan.states, scan.rod)
    phases = scan.states["phase"]
    scale = np.abs(criterion).max()
    assert np.abs(criterion[np.isin(phases, ["B", "BB"])]).max() < 1e-12 * scale
    assert criterion[np.isin(phases, ["A", "BA"])].max() < 0.0
    plt.close("all")


def test_the_contour_has_a_band_of_two_deviations(scan: vibrissa.Scan) -> None:
    scene = vibrissa.Scene.read(SCENES / "O1_q40.toml")
    samples = vibrissa.simulate(scene, rate=500.0, speed=0.01, noise={"white": {"force": 2.5e-3, "m0z": 6e-5}})
    found = vibrissa.reconstruct(scene.rod, samples)
    ax = vibrissa.plot.contour(found, objects=scene.objects)
    rows = found.contour
    part = rows[rows["stretch"] == rows["stretch"][0]]
    corners = ax.patches[0].get_xy()  # type: ignore[attr-defined]
    width = np.hypot(*(corners[0] - corners[2 * len(part) - 1]))
    assert width == pytest.approx(4e3 * part["sigma"][0])
    assert len(ax.patches) == len(np.unique(rows["stretch"]))
    plt.close("all")


def test_gaps_to_own_shapes_are_exact_where_they_are_drawn() -> None:
    x, y = np.meshgrid(np.linspace(-0.05, 0.05, 95), np.linspace(-0.05, 0.1, 101))
    own = vibrissa.Composite(Hump())
    exact = own.gap(x, y)
    gap = vibrissa.plot._gap_near_zero(own, x, y)
    near = np.abs(exact) <= 2e-3
    assert near.sum() > 100
    np.testing.assert_array_equal(gap[near], exact[near])
    np.testing.assert_array_equal(np.sign(gap), np.sign(exact))


def test_the_notch_has_the_points_of_both_contacts(scan: vibrissa.Scan) -> None:
    fine = vibrissa.sweep(scan.rod, scan.objects, scan.path, 5e-5)
    found = vibrissa.reconstruct(scan.rod, fine.states)
    ax = vibrissa.plot.notches(found, objects=scan.objects)
    one, naive, first, second = ax.lines
    gap = scan.objects[0].gap
    for line, largest in [(first, 1e-6), (second, 1e-6)]:
        x, y = 1e-3 * np.asarray(line.get_xdata()), 1e-3 * np.asarray(line.get_ydata())
        assert len(x) > 10 and np.abs(gap(x, y)).max() < largest
    x, y = 1e-3 * np.asarray(naive.get_xdata()), 1e-3 * np.asarray(naive.get_ydata())
    off = np.abs(gap(x, y))
    assert np.nanmax(off) > 1e-3 and len(one.get_xdata()) > len(x)  # type: ignore[arg-type]
    plt.close("all")
    with pytest.raises(ValueError, match="no point of two contacts"):
        vibrissa.plot.notches(vibrissa.reconstruct(scan.rod, fine.states[: int(np.flatnonzero(found.readings["label"] == "BB")[0])]))


def test_a_sweep_moves(scan: vibrissa.Scan, tmp_path: Path) -> None:
    animation = vibrissa.plot.animate(scan, frames=4)
    file = tmp_path / "sweep.gif"
    animation.save(file, writer="pillow", dpi=40)
    from PIL import Image

    with Image.open(file) as image:
        assert image.n_frames == 4  # type: ignore[attr-defined]
    plt.close("all")
    with pytest.raises(ValueError, match="frames is 0, expected 1 or more"):
        vibrissa.plot.animate(scan, frames=0)


def test_several_legs_are_drawn_over_the_way() -> None:
    whisking = vibrissa.Scene.read(SCENES / "whisking.toml").sweep()
    axes = vibrissa.plot.reactions(whisking)
    assert axes[-1].get_xlabel() == "way of the clamp in mm"
    lines = [np.asarray(line.get_xdata()) for line in axes[0].lines if len(line.get_xdata()) > 2]  # type: ignore[arg-type]
    assert all(np.diff(np.concatenate(lines)) >= 0.0)
    # 10 mm there and back, and two turns of 60 degrees about a pivot 8 mm away
    assert lines[-1][-1] == pytest.approx(20.0 + 2e3 * 0.008 * np.pi / 3, rel=0.01)
    plt.close("all")
