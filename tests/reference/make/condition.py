"""How much the results can move when every input is rounded."""

from mpmath import det, lu_solve, matrix, mpf

import jacobi
from backward import Backward
from newton import jacobian
from precision import STEP
from problem import Problem
from supports import exact

# Lengths and angles: what places the rod and the objects in the plane. A solver rounds them at the scale of the rod at best.
PLACES = {"x", "y", "phi", "vertex", "centre", "point", "angle"}


def _numbers(value, path=(), place=False):
    """All doubles of a description: where they are, what they are, and their scale."""
    if isinstance(value, dict):
        for key, v in value.items():
            yield from _numbers(v, (*path, key), place or key in PLACES)
    elif isinstance(value, list):
        for i, v in enumerate(value):
            yield from _numbers(v, (*path, i), place)
    elif isinstance(value, mpf):
        yield path, max(1, abs(value)) if place else abs(value)


def _moved(value, path, by):
    if not path:
        return value + by
    copy = dict(value) if isinstance(value, dict) else list(value)
    copy[path[0]] = _moved(copy[path[0]], path[1:], by)
    return copy


def _largest(changes, results):
    return max(abs(c) / (1 + abs(r)) for c, r in zip(changes, results))


def of_segment(inputs):
    """Largest relative change of a segment's end per relative change of an input."""
    inputs = exact({key: inputs[key] for key in ("start", "force", "length")})
    end = lambda i: jacobi.advance(
        [i["start"][key] for key in ("x", "y", "phi", "kappa")], i["force"]["a"], i["force"]["b"], i["length"]
    )
    here = end(inputs)
    worst = mpf(0)
    for path, scale in _numbers(inputs):
        if scale > 0:
            there = end(_moved(inputs, path, STEP * scale))
            worst = max(worst, _largest([(v - w) / STEP for v, w in zip(there, here)], here))
    return worst


def of_contacts(inputs, starts, way):
    """The same for a problem with contacts, from the derivatives of its equations at the solution of `way`.

    Of a fold the coefficients of the Jacobian count as inputs too: that it is singular is one of the equations.
    """
    asked = exact({key: inputs[key] for key in ("clamp", "motion", "supports", "rod") if key in inputs})
    rest = {key: v for key, v in inputs.items() if key not in asked}
    u, values = way.u, way.march(way.u)[1].values()
    both = lambda way, u: way.system(u) + way.march(u)[1].values()
    here = both(way, u)
    n = len(u)
    derivatives = jacobian(lambda u: both(way, u), u, here)
    by_u, results_by_u = derivatives[:n, :], derivatives[n:, :]
    worst = mpf(0)

    def change(slopes):
        """Of the results, where the equations and the results at fixed unknowns change so much."""
        return _largest(matrix(slopes[n:]) - results_by_u * lu_solve(by_u, matrix(slopes[:n])), values)

    def moved(problem):
        return change([(v - w) / STEP for v, w in zip(both(Backward(problem), u), here)])

    for path, scale in _numbers(asked):
        if scale > 0:
            worst = max(worst, moved(Problem({**rest, **_moved(asked, path, STEP * scale)}, starts)))
    worst = max(worst, moved(Problem({**rest, **asked}, starts, length=1 + STEP)))
    if way.problem.is_fold:
        slopes = way.slopes(u)
        for i in range(slopes.rows):
            for j in range(slopes.cols):
                doubled = slopes.copy()
                doubled[i, j] *= 2
                # the determinant is linear in every coefficient
                worst = max(worst, change([mpf(0)] * (n - 1) + [det(doubled) - det(slopes)] + [mpf(0)] * len(values)))
    return worst
