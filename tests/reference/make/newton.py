"""Newton's method with difference quotients, in as many digits as are carried."""

from mpmath import lu_solve, matrix, mp, mpf

from precision import STEP


def jacobian(system, u, here):
    """Columns of the derivatives of `system` at u, where it is `here`."""
    columns = []
    for j in range(len(u)):
        h = STEP * max(1, abs(u[j]))
        moved = list(u)
        moved[j] += h
        columns.append([(f - g) / h for f, g in zip(system(moved), here)])
    return matrix([[column[i] for column in columns] for i in range(len(here))])


def solve(system, u, steps=60):
    """The root near u. Steps are halved until the residual falls; the last one is full and moves nothing."""
    u = [mpf(v) for v in u]
    here = system(u)
    for _ in range(steps):
        correction = lu_solve(jacobian(system, u, here), matrix(here))
        moved = max(abs(c) / (1 + abs(v)) for c, v in zip(correction, u))
        damping = mpf(1)
        while True:
            trial = [v - damping * c for v, c in zip(u, correction)]
            there = system(trial)
            if moved < mpf(10) ** -20 or mp.norm(there) < mp.norm(here):
                break
            damping /= 2
            if damping < mpf(10) ** -6:
                raise ArithmeticError("no descent, residual %s" % mp.nstr(mp.norm(here), 3))
        u, here = trial, there
        if moved < mpf(10) ** -55:
            return u
    raise ArithmeticError("no convergence, last step %s" % mp.nstr(moved, 3))


def slope(system, u, v):
    """The derivative of `system` at u in direction v, by differences of fourth order: 1e-48, which can be differenced on."""
    h = mpf(10) ** -13
    at = lambda k: system([x + k * h * y for x, y in zip(u, v)])
    return [(8 * (p - m) - (q - l)) / (12 * h) for p, m, q, l in zip(at(1), at(-1), at(2), at(-2))]
