"""Way 2 along a rod whose stiffness or natural curvature is a function: collocation at Gauss points.

The angles at the points of an element are found by fixed-point iteration; order 2 POINTS.
"""

from mpmath import mp, mpf

from precision import WORKING

NAME = "Gauss collocation"
POINTS = 48
# Longest element: h sqrt(P / stiffness) and h times the rate of the stiffness.
REACH = mpf("0.5")

_tableau = None


def _legendre(n, x):
    """P_0 ... P_n at x, by recurrence."""
    values = [mpf(1), x]
    for k in range(1, n):
        values.append(((2 * k + 1) * x * values[k] - k * values[k - 1]) / (k + 1))
    return values[: n + 1]


def tableau():
    """Points and weights on [0, 1], and the weights of integrals from 0 to each point."""
    global _tableau
    if _tableau is None:
        with mp.workdps(WORKING + 25):
            nodes, weights = [], []
            for i in range(POINTS):
                x = mp.cos(mp.pi * (i + mpf("0.75")) / (POINTS + mpf("0.5")))
                for _ in range(12):
                    p = _legendre(POINTS, x)
                    slope = POINTS * (x * p[POINTS] - p[POINTS - 1]) / (x * x - 1)
                    x -= p[POINTS] / slope
                nodes.append(x)
                weights.append(2 / ((1 - x * x) * slope * slope))
            order = sorted(range(POINTS), key=lambda i: nodes[i])
            nodes, weights = [nodes[i] for i in order], [weights[i] / 2 for i in order]
            polynomials = [_legendre(POINTS, x) for x in nodes]
            table = []
            for i in range(POINTS):
                p = polynomials[i]
                # integrals of P_k(2 c - 1) from 0 to the point
                integrals = [(1 + nodes[i]) / 2]
                integrals += [(p[k + 1] - p[k - 1]) / (2 * (2 * k + 1)) for k in range(1, POINTS)]
                table.append(
                    [weights[j] * mp.fsum((2 * k + 1) * polynomials[j][k] * integrals[k] for k in range(POINTS)) for j in range(POINTS)]
                )
            _tableau = [(1 + x) / 2 for x in nodes], weights, table
    return _tableau


def _element(cut, a, b, s, h, stiffness, curvature):
    points, weights, table = tableau()
    x, y, phi, m = cut
    soft = [1 / stiffness(s + c * h) for c in points]
    bent = [curvature(s + c * h) for c in points]
    angles = [phi + c * h * (m * soft[0] + bent[0]) for c in points]
    for _ in range(400):
        bends = [a * mp.cos(angle) + b * mp.sin(angle) for angle in angles]
        moments = [m + h * mp.fdot(row, bends) for row in table]
        turns = [moment * w + k for moment, w, k in zip(moments, soft, bent)]
        there = [phi + h * mp.fdot(row, turns) for row in table]
        moved = max(abs(one - other) for one, other in zip(there, angles))
        angles = there
        if moved < mpf(10) ** -(WORKING + 8):
            break
    else:
        raise ArithmeticError("the angles of an element do not converge")
    bends = [a * mp.cos(angle) + b * mp.sin(angle) for angle in angles]
    moments = [m + h * mp.fdot(row, bends) for row in table]
    turns = [moment * w + k for moment, w, k in zip(moments, soft, bent)]
    whole = lambda values: h * mp.fdot(weights, values)
    return [x + whole(map(mp.cos, angles)), y + whole(map(mp.sin, angles)), phi + whole(turns), m + whole(bends)]


def advance(cut, a, b, start, end, stiffness, curvature):
    """(x, y, phi, m) at `end` (before or behind `start`) along a segment that carries the force (A, B)."""
    with mp.workdps(WORKING + 15):
        cut, a, b, s, end = [mpf(value) for value in cut], mpf(a), mpf(b), mpf(start), mpf(end)
        force = mp.hypot(a, b)
        while s != end:
            way = end - s
            for _ in range(60):
                there = stiffness(s + way)
                least = min(stiffness(s), there)
                grows = abs(mp.log(there / stiffness(s)))
                if abs(way) * mp.sqrt(force / least) <= REACH and grows <= 2 * REACH:
                    break
                way /= 2
            to = end if way == end - s else s + way
            cut = _element(cut, a, b, s, to - s, stiffness, curvature)
            s = to
    return [+value for value in cut]
