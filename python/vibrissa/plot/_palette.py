"""Colours, those of the command's figures: a phase has the same one in all figures, and nothing else has it."""

from __future__ import annotations

__all__ = ["FAINT", "FIRST", "INK", "MUTED", "OTHERS", "SOLID", "TRANSITION", "phase_color"]

INK = "#000000"
MUTED = "#5a5a5a"
FAINT = "#cdcdcd"
SOLID = "#e6e6e6"
# Shapes and poses at a transition.
TRANSITION = "#332288"
# Passes, branches, contacts of a contour: things that are no phases. The first ones of the muted colours of Tol (2021).
OTHERS = ["#332288", "#999933", "#882255", "#44aa99"]

# The first of two contacts: told from the greys and the phases with red-green blindness, too.
FIRST = "#7733ee"

_FREE = "#969696"
# Okabe and Ito (2008): the number of contacts, and whether the last one is at the tip.
_COLORS = {
    (1, True): "#009e73",
    (1, False): "#0072b2",
    (2, True): "#e69f00",
    (2, False): "#d55e00",
    (3, True): "#cc79a7",
    (3, False): "#56b4e9",
}


def phase_color(phase: str) -> str:
    """The colour of a phase; those of more than three contacts share colours.

    Parameters
    ----------
    phase : str
        Such as ``"free"``, ``"A"`` or ``"BBA"``.

    Returns
    -------
    str
        ``#rrggbb``.
    """
    return _FREE if phase == "free" else _COLORS[min(len(phase), 3), phase.endswith("A")]
