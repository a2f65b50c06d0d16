"""Way 1: shooting from the clamp, segments by Taylor series.

Unknown are the reactions f0x, f0y, m0z, of each contact its parameter, force and arc length, and tau where the clamp is
found too. Every contact asks for its place (and, tangential, its angle); behind the last one no force and no moment is
left. A notch has no unknown of its own: its force is what the segment before it carries. A fold is where the unknowns can
move in a direction v with the clamp at rest, J v = 0 with |v| = 1, all solved for at once.
"""

from mpmath import lu_solve, matrix, mp, mpf, norm

from newton import jacobian, slope, solve
from problem import Found, reactions_of

NAME = "shooting from the clamp by Taylor series"


class Forward:
    def __init__(self, problem):
        self.problem = problem

    def start(self):
        p = self.problem
        found = [(*p.at(j, c.start[0]), mpf(c.start[1])) for j, c in enumerate(p.contacts)]
        u = reactions_of(p.pose(p.tau), found)
        for contact in p.contacts:
            u += {"notch": (), "tip": contact.start[:2], "tangent": contact.start}[contact.hold]
        return [mpf(v) for v in u] + ([p.tau] if p.motion else [])

    def march(self, u):
        """Residuals, and what was found on the way."""
        p = self.problem
        rest = iter(u[3:])
        tau = u[-1] if p.motion else None
        f0x, f0y, m0z = u[:3]
        a, b, s = f0y, -f0x, mpf(0)
        state = [*p.pose(tau), -m0z]
        residual, contacts = [], []
        for j, contact in enumerate(p.contacts):
            if contact.hold == "notch":
                force, alpha, to = mp.hypot(a, b), mp.atan2(b, a), p.length
                t = alpha
            else:
                t, force = next(rest), next(rest)
                to = p.length if contact.at_tip else next(rest)
            state = p.rod.by_taylor(state, a, b, s, to)
            s = to
            x, y, alpha = p.at(j, t)
            phi = state[2] if contact.at_tip else alpha + contact.turns * mp.pi
            residual += [state[0] - x, state[1] - y]
            if not contact.at_tip:
                residual.append(state[2] - phi)
            if p.is_given("force", j):
                residual.append(force)
            if p.is_given("arc-length", j):
                residual.append(s - p.length)
            # no error grows from one segment to the next
            state = [x, y, phi, state[3]]
            a, b = a - force * mp.cos(alpha), b - force * mp.sin(alpha)
            contacts.append((x, y, alpha, force, s, phi))
        residual.append(state[3])
        if p.contacts[-1].hold != "notch":
            residual += [a, b]
        return residual, Found(contacts, u[:3], tau)

    def solve(self):
        system = lambda u: self.march(u)[0]
        u = self._fold() if self.problem.is_fold else solve(system, self.start())
        return self.march(u)[1]

    def _fold(self):
        start = self.start()
        n = len(start) - 1

        def system(w):
            u, v = w[: n + 1], w[n + 1 :]
            return self.march(u)[0] + slope(lambda u: self.march(u)[0], u, [*v, mpf(0)]) + [mp.fsum(x * x for x in v) - 1]

        inner = lambda u: self.march([*u, start[n]])[0]
        flat = jacobian(inner, start[:n], inner(start[:n]))
        # the flattest direction at the start, by inverse iteration
        v = matrix([1] * n)
        for _ in range(5):
            v = lu_solve(flat, lu_solve(flat.T, v))
            v /= norm(v)
        return solve(system, [*start, *v])[: n + 1]
