"""Equilibria by scipy.integrate.solve_bvp: collocation on all segments at once, each mapped to [0, 1].

States x, y, phi, kappa of every segment; parameters t, f, s of every contact (t, f at the tip). Jacobians are given: without
them solve_bvp takes differences, which takes longer. A solve starts from the mesh and
the values of the solution next to it.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_bvp

from problems import Solution, Unknowns, ahead

MESH = 11  # nodes where there is no mesh yet
MAX_NODES = 20_000


class _Layout:
    """Where the parameters of every contact are in the vector p."""

    def __init__(self, contacts, fixed):
        self.contacts, self.fixed, self.n = contacts, fixed, len(contacts)
        at, self.t, self.f, self.s = 0, [], [], []
        for contact in contacts:
            self.t.append(at)
            self.f.append(at + 1)
            self.s.append(None if contact.tip else at + 2)
            at += 2 if contact.tip else 3
        self.x0 = None if fixed is None else at
        self.count = at + (fixed is not None)

    def unknowns(self, p, phi1):
        s = tuple(1.0 if i is None else p[i] for i in self.s)
        return Unknowns(tuple(p[self.t]), tuple(p[self.f]), s, phi1)

    def pack(self, unknowns, x0):
        p = np.empty(self.count)
        p[self.t], p[self.f] = unknowns.t, unknowns.f
        for i, s in zip(self.s, unknowns.s):
            if i is not None:
                p[i] = s
        if self.x0 is not None:
            p[self.x0] = x0
        return p

    def forces(self, p):
        """A, B and length of every segment, as columns, and the frames."""
        unknowns = self.unknowns(p, 0.0)
        a, b, frames = ahead(self.contacts, unknowns.t, unknowns.f)
        lengths = np.diff((0.0, *unknowns.s))
        return a[:, None], b[:, None], lengths[:, None], frames


def _functions(layout, clamp):
    contacts, n, k = layout.contacts, layout.n, layout.count

    def fun(_, y, p):
        a, b, lengths, _ = layout.forces(p)
        y = y.reshape(n, 4, -1)
        c, s = np.cos(y[:, 2]), np.sin(y[:, 2])
        rates = np.stack((c, s, y[:, 3], a * c + b * s), axis=1)
        return (lengths[:, None] * rates).reshape(4 * n, -1)

    def fun_jac(_, y, p):
        a, b, lengths, frames = layout.forces(p)
        m = y.shape[1]
        y = y.reshape(n, 4, m)
        c, s = np.cos(y[:, 2]), np.sin(y[:, 2])
        turning = a * c + b * s
        dy, dp = np.zeros((4 * n, 4 * n, m)), np.zeros((4 * n, k, m))
        for j in range(n):
            x, length = 4 * j, lengths[j, 0]
            dy[x, x + 2], dy[x + 1, x + 2], dy[x + 2, x + 3] = -length * s[j], length * c[j], length
            dy[x + 3, x + 2] = length * (b[j] * c[j] - a[j] * s[j])
            rates = (c[j], s[j], y[j, 3], turning[j])
            if layout.s[j] is not None:
                dp[x : x + 4, layout.s[j]] += rates
            if j:
                dp[x : x + 4, layout.s[j - 1]] -= rates
            for i in range(j, n):
                frame, f = frames[i], p[layout.f[i]]
                ci, si = math.cos(frame.alpha), math.sin(frame.alpha)
                dp[x + 3, layout.f[i]] = length * (ci * c[j] + si * s[j])
                dp[x + 3, layout.t[i]] = length * f * frame.dalpha * (ci * s[j] - si * c[j])
        return dy, dp

    def bc(ya, yb, p):
        _, _, _, frames = layout.forces(p)
        ya, yb = ya.reshape(n, 4), yb.reshape(n, 4)
        residual = [ya[0, 0] - (clamp[0] if layout.x0 is None else p[layout.x0]), ya[0, 1] - clamp[1], ya[0, 2] - clamp[2]]
        for j, (contact, frame) in enumerate(zip(contacts, frames)):
            residual += [yb[j, 0] - frame.x, yb[j, 1] - frame.y]
            if not contact.tip:
                residual.append(yb[j, 2] - frame.alpha - contact.offset)
            if j + 1 < n:
                residual += list(ya[j + 1] - yb[j])
        residual.append(yb[-1, 3])
        if layout.x0 is not None:
            residual.append(yb[-1, 2] - layout.fixed)
        return np.array(residual)

    # Rows do not change, but for the rates of the frames.
    rows = 4 * n + k
    start, end = np.zeros((rows, 4 * n)), np.zeros((rows, 4 * n))
    start[0, 0] = start[1, 1] = start[2, 2] = 1.0
    row, of_contact = 3, []
    for j, contact in enumerate(contacts):
        of_contact.append(row)
        for i in range(2 if contact.tip else 3):
            end[row, 4 * j + i] = 1.0
            row += 1
        if j + 1 < n:
            for i in range(4):
                start[row, 4 * j + 4 + i], end[row, 4 * j + i] = 1.0, -1.0
                row += 1
    end[row, 4 * n - 1] = 1.0
    if layout.x0 is not None:
        end[row + 1, 4 * n - 2] = 1.0

    def bc_jac(ya, yb, p):
        _, _, _, frames = layout.forces(p)
        dp = np.zeros((rows, k))
        if layout.x0 is not None:
            dp[0, layout.x0] = -1.0
        for j, (contact, frame, at) in enumerate(zip(contacts, frames, of_contact)):
            dp[at, layout.t[j]], dp[at + 1, layout.t[j]] = -frame.dx, -frame.dy
            if not contact.tip:
                dp[at + 2, layout.t[j]] = -frame.dalpha
        return start, end, dp

    return fun, bc, fun_jac, bc_jac


@dataclass
class Collocated(Solution):
    found: object  # of solve_bvp

    def note(self):
        return f"{len(self.found.x)} nodes a segment"

    def segments(self):
        def segment(j, start, end):
            return lambda s: self.found.sol((s - start) / (end - start))[4 * j : 4 * j + 4]

        ends = (0.0, *self.unknowns.s)
        return [segment(j, start, end) for j, (start, end) in enumerate(zip(ends, ends[1:]))]


def _values(contacts, clamp, unknowns, mesh):
    """Straight from the clamp to the first contact and on to the next."""
    ends = [clamp[:2]] + [
        (frame.x, frame.y) for frame in (contact.support.frame(t) for contact, t in zip(contacts, unknowns.t))
    ]
    values = []
    for (x0, y0), (x1, y1) in zip(ends, ends[1:]):
        phi = math.atan2(y1 - y0, x1 - x0)
        values += [x0 + mesh * (x1 - x0), y0 + mesh * (y1 - y0), np.full(len(mesh), phi), np.zeros(len(mesh))]
    return np.array(values)


class Collocation:
    """Solves at one tolerance."""

    name = "scipy solve_bvp"

    def __init__(self, tol, jacobians=True):
        self.tol = tol
        self.jacobians = jacobians

    def solve(self, contacts, clamp, guess, fixed=None, shape=None):
        """The solution near a guess, or None: a solution, or unknowns, with the rod straight or in a given shape.

        `fixed`: phi1 is given and x0 of the clamp unknown.
        """
        layout = _Layout(contacts, fixed)
        if isinstance(guess, Collocated):
            mesh, values, unknowns, x0 = guess.found.x, guess.found.y, guess.unknowns, guess.clamp[0]
        else:
            mesh, unknowns, x0 = np.linspace(0.0, 1.0, MESH), guess, clamp[0]
            if shape is None:
                values = _values(contacts, clamp, unknowns, mesh)
            else:
                s = (0.0, *unknowns.s)
                values = np.vstack([shape(s0 + mesh * (s1 - s0)) for s0, s1 in zip(s, s[1:])])
        fun, bc, fun_jac, bc_jac = _functions(layout, clamp)
        given = {"fun_jac": fun_jac, "bc_jac": bc_jac} if self.jacobians else {}
        p = layout.pack(unknowns, x0)
        with np.errstate(all="ignore"):  # a guess may lead anywhere
            found = solve_bvp(fun, bc, mesh, values, p, tol=self.tol, max_nodes=MAX_NODES, **given)
        if not found.success:
            # Meshes only grow from one solution to the next: at last they are too large, and a fresh one will do.
            return self.solve(contacts, clamp, guess.unknowns, fixed, guess.shape()) if isinstance(guess, Collocated) else None
        known = layout.unknowns(found.p, found.y[-2, -1])
        if not all(length > 0 for length in np.diff((0.0, *known.s))):
            return None
        pose = clamp if fixed is None else (found.p[layout.x0], *clamp[1:])
        return Collocated(contacts, pose, known, found.y[3, 0], found)
