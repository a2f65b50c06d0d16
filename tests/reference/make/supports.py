"""The curves that hold the rod: (x, y, alpha) at a parameter."""

from mpmath import findroot, mp, mpf


def at(support, t):
    """The point of a support at parameter t, and its tangent angle.

    t is x on a parabola, the tangent angle on a circle and at a vertex, the distance from the point on a line.
    """
    shape = support["shape"]
    if shape == "parabola":
        (xv, yv), c = support["vertex"], support["coefficient"]
        return t, c * (t - xv) ** 2 + yv, mp.atan(2 * c * (t - xv))
    if shape == "circle":
        (x, y), r = support["centre"], support["radius"]
        return x + r * mp.sin(t), y - r * mp.cos(t), t
    if shape == "line":
        (x, y), alpha = support["point"], support["angle"]
        return x + t * mp.cos(alpha), y + t * mp.sin(alpha), alpha
    x, y = support["point"]
    return x, y, t


def notch(first, second, near):
    """The point where two parabolas cross, near this x, as a vertex."""
    (x1, y1), c1 = first["vertex"], first["coefficient"]
    (x2, y2), c2 = second["vertex"], second["coefficient"]
    x = findroot(lambda x: c1 * (x - x1) ** 2 + y1 - c2 * (x - x2) ** 2 - y2, near)
    return {"shape": "vertex", "point": [x, at(first, x)[1]]}


def exact(value):
    """The same description with every double as it is."""
    if isinstance(value, dict):
        return {key: exact(v) for key, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [exact(v) for v in value]
    return mpf(value) if isinstance(value, float) else value
