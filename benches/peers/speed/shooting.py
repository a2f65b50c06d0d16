"""Equilibria by shooting: scipy.integrate.solve_ivp (DOP853) and scipy.optimize.root, from the last contact to the clamp.

Started at the last contact, where position, force and zero curvature are known from its unknowns, one contact has three
unknowns and three residuals at the clamp; every contact more adds three of each. The Jacobian comes from the variational
equations, integrated beside the rod: this was faster than differences, which cost an integration for each unknown.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

from problems import Solution, Unknowns, ahead

COLUMNS = 4  # of the sensitivities: to phi and kappa at the start, and to A and B


def _backwards(_, y, a, b):
    phi, kappa = y[2], y[3]
    c, s = math.cos(phi), math.sin(phi)
    return -c, -s, -kappa, -(a * c + b * s)


def _with_sensitivities(_, y, a, b):
    phi, kappa = y[2], y[3]
    c, s = math.cos(phi), math.sin(phi)
    rates = np.empty((4, COLUMNS + 1))
    rates[:, 0] = (-c, -s, -kappa, -(a * c + b * s))
    dphi, dkappa = y[4:].reshape(4, COLUMNS)[2:]
    rates[0, 1:], rates[1, 1:], rates[2, 1:] = s * dphi, -c * dphi, -dkappa
    rates[3, 1:] = (a * s - b * c) * dphi
    rates[3, 3] -= c
    rates[3, 4] -= s
    return np.concatenate((rates[:, 0], rates[:, 1:].ravel()))


def integrate(rates, start, length, a, b, tol, dense=False):
    return solve_ivp(rates, (0.0, length), start, method="DOP853", rtol=tol, atol=tol, args=(a, b), dense_output=dense)


_DIRECTIONS = np.zeros((4, COLUMNS))
_DIRECTIONS[2, 0] = _DIRECTIONS[3, 1] = 1.0


@dataclass
class Shot(Solution):
    tol: float

    def segments(self):
        def segment(piece, end):
            return lambda s: piece.sol(end - s)

        _, _, pieces = _segments(self.contacts, self.unknowns, self.tol, dense=True)
        return [segment(piece, end) for piece, end in zip(pieces, self.unknowns.s)]


def _angle(contacts, unknowns, frames, j):
    return unknowns.phi1 if contacts[j].tip else frames[j].alpha + contacts[j].offset


def _segments(contacts, unknowns, tol, dense=False, rates=_backwards):
    """All segments, integrated from their contacts backwards."""
    a, b, frames = ahead(contacts, unknowns.t, unknowns.f)
    pieces, kappa = [None] * len(contacts), 0.0
    for j in reversed(range(len(contacts))):
        start = np.array([frames[j].x, frames[j].y, _angle(contacts, unknowns, frames, j), kappa])
        if rates is _with_sensitivities:
            start = np.concatenate((start, _DIRECTIONS.ravel()))
        length = unknowns.s[j] - (unknowns.s[j - 1] if j else 0.0)
        pieces[j] = integrate(rates, start, length, a[j], b[j], tol, dense)
        kappa = pieces[j].y[3, -1]
    return a, b, pieces


def _unpack(contacts, u, fixed):
    """Unknowns from a vector: t, f, s of every contact, phi1 for s at the tip; `fixed` holds phi1 instead, and u[-1] is x0."""
    t, f, third = u[0 : 3 * len(contacts) : 3], u[1 : 3 * len(contacts) : 3], list(u[2 : 3 * len(contacts) : 3])
    last = contacts[-1]
    if last.tip:
        phi1 = third[-1] if fixed is None else fixed
        third[-1] = 1.0
    else:
        phi1 = last.support.frame(t[-1]).alpha + last.offset
    return Unknowns(tuple(t), tuple(f), tuple(third), phi1)


def _pack(contacts, unknowns, x0=None):
    third = list(unknowns.s)
    if contacts[-1].tip:
        third[-1] = unknowns.phi1 if x0 is None else x0
    return np.column_stack((unknowns.t, unknowns.f, third)).ravel()


def _targets(contacts, unknowns, clamp):
    """Position and angle at which every segment must end: the contact before it, or the clamp."""
    frames = [contact.support.frame(tj) for contact, tj in zip(contacts, unknowns.t)]
    return [np.array(clamp)] + [
        np.array([frames[j].x, frames[j].y, _angle(contacts, unknowns, frames, j)]) for j in range(len(contacts) - 1)
    ]


def _jacobian(contacts, unknowns, tol, fixed):
    n = len(contacts)
    a, b, pieces = _segments(contacts, unknowns, tol, rates=_with_sensitivities)
    _, _, frames = ahead(contacts, unknowns.t, unknowns.f)
    jacobian, dkappa = np.zeros((3 * n, 3 * n)), np.zeros(3 * n)
    da, db = np.zeros(3 * n), np.zeros(3 * n)
    for j in reversed(range(n)):
        frame, f = frames[j], unknowns.f[j]
        c, s = math.cos(frame.alpha), math.sin(frame.alpha)
        da[3 * j] -= f * s * frame.dalpha
        da[3 * j + 1] += c
        db[3 * j] += f * c * frame.dalpha
        db[3 * j + 1] += s
        end = pieces[j].y[:4, -1]
        by = pieces[j].y[4:, -1].reshape(4, COLUMNS)
        rate = np.array(_backwards(0.0, end, a[j], b[j]))
        dphi = np.zeros(3 * n)
        if not contacts[j].tip:
            dphi[3 * j] = frame.dalpha
        elif fixed is None:
            dphi[3 * j + 2] = 1.0
        rows = by @ np.array([dphi, dkappa, da, db])
        rows[0, 3 * j] += frame.dx
        rows[1, 3 * j] += frame.dy
        if not contacts[j].tip:
            rows[:, 3 * j + 2] += rate
        if j:  # the segment begins at the contact before
            rows[:, 3 * j - 1] -= rate
            before = frames[j - 1]
            jacobian[3 * j : 3 * j + 3] = rows[:3]
            jacobian[3 * j : 3 * j + 3, 3 * j - 3] -= (before.dx, before.dy, before.dalpha)
        else:
            jacobian[:3] = rows[:3]
            if fixed is not None:
                jacobian[0, -1] -= 1.0
        dkappa = rows[3]
    return jacobian


class Shooting:
    """Solves at one tolerance of the integrator."""

    name = "scipy solve_ivp shooting (DOP853)"

    def __init__(self, tol):
        self.tol = tol

    def solve(self, contacts, clamp, guess, fixed=None, shape=None):
        """The solution near a guess (unknowns or a solution), or None. `fixed`: phi1 is given and x0 of the clamp unknown.

        The shape of the rod, which collocation starts from, is none of its unknowns.
        """
        if isinstance(guess, Shot):
            unknowns, x0 = guess.unknowns, guess.clamp[0]
        else:
            unknowns, x0 = guess, clamp[0]
        tol = self.tol

        def residual(u):
            known = _unpack(contacts, u, fixed)
            if not _possible(known, u):
                return np.full(3 * len(contacts), 1e3)
            pose = clamp if fixed is None else (u[-1], *clamp[1:])
            _, _, pieces = _segments(contacts, known, tol)
            targets = _targets(contacts, known, pose)
            return np.concatenate([piece.y[:3, -1] - target for piece, target in zip(pieces, targets)])

        def jacobian(u):
            return _jacobian(contacts, _unpack(contacts, u, fixed), tol, fixed)

        start = _pack(contacts, unknowns, None if fixed is None else x0)
        found = root(residual, start, jac=jacobian, method="hybr", tol=max(0.1 * tol, 1e-14))
        # hybr calls it a failure when rounding is reached: the residual tells.
        if not np.max(np.abs(found.fun)) < max(10 * tol, 1e-12):
            return None
        known = _unpack(contacts, found.x, fixed)
        pose = clamp if fixed is None else (found.x[-1], *clamp[1:])
        _, _, pieces = _segments(contacts, known, tol)
        return Shot(contacts, pose, known, pieces[0].y[3, -1], tol)


def _possible(unknowns, u):
    """Segments have lengths, not too long ones, and forces are such that an integration ends."""
    lengths = np.diff((0.0, *unknowns.s))
    return bool(np.all(lengths > 0) and np.all(lengths < 5) and np.all(np.abs(unknowns.f) < 1e3) and np.all(np.isfinite(u)))
