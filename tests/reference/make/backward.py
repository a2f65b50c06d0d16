"""Way 2: shooting from the last contact to the clamp, segments by Jacobi's elliptic functions.

Unknown are of each contact its parameter, force and arc length (at the tip: the slope angle), but for what a transition
gives, and tau where the clamp is found too. That there is no moment at the last contact, and the balance of forces, hold by
construction; each inner contact asks for its place and angle, and so does the clamp. The reactions follow from the balance
of the contact forces. A fold is where det J = 0.
"""

from mpmath import det, matrix, mp, mpf

from newton import slope, solve
from problem import Found, reactions_of

NAME = "shooting from the last contact by {}"


class Backward:
    def __init__(self, problem):
        self.problem = problem
        # None where it is unknown
        self.given = []
        for j in range(len(problem.contacts)):
            force = mpf(0) if problem.is_given("force", j) else None
            s = problem.length if problem.is_given("arc-length", j) else None
            self.given.append((None, force, s))

    def start(self):
        p = self.problem
        pairs = [pair for contact, given in zip(p.contacts, self.given) for pair in zip(contact.start, given)]
        return [mpf(v) for v, given in pairs if given is None] + ([p.tau] if p.motion else [])

    def march(self, u):
        """Residuals, and what was found on the way."""
        p = self.problem
        tau = u[-1] if p.motion else None
        pose = p.pose(tau)
        rest = iter(u)
        contacts = []
        for j, (contact, given) in enumerate(zip(p.contacts, self.given)):
            t, force, third = (next(rest) if g is None else g for g in given)
            x, y, alpha = p.at(j, t)
            s, phi = (p.length, third) if contact.at_tip else (third, alpha + contact.turns * mp.pi)
            contacts.append((x, y, alpha, force, s, phi))
        residual = []
        a = b = m = mpf(0)
        for j, (x, y, alpha, force, s, phi) in reversed(list(enumerate(contacts))):
            a, b = a + force * mp.cos(alpha), b + force * mp.sin(alpha)
            xb, yb, _, _, sb, phib = contacts[j - 1] if j else (*pose[:2], None, None, mpf(0), pose[2])
            *end, m = p.rod.by_other([x, y, phi, m], a, b, s, sb)
            residual += [v - w for v, w in zip(end, (xb, yb, phib))]
        return residual, Found(contacts, reactions_of(pose, [c[:4] for c in contacts]), tau)

    def system(self, u):
        residual = self.march(u)[0]
        return residual + [det(self.slopes(u))] if self.problem.is_fold else residual

    def slopes(self, u):
        """The transposed Jacobian of the equations at a pose, tau being the last of u."""
        n = len(u) - 1
        unit = lambda j: [mpf(int(i == j)) for i in range(n + 1)]
        return matrix([slope(lambda u: self.march(u)[0], u, unit(j)) for j in range(n)])

    def solve(self):
        self.u = solve(self.system, self.start())
        return self.march(self.u)[1]
