"""A rod whose tip rests on a floor without friction: what programs for dynamics can do too.

The clamp is at (0, y0) and inclined by phi0, the solid below y = 0. The force on the tip is (0, f), so that A = -f, B = 0 and
kappa^2 / 2 = f (sin phi1 - sin phi), phi1 at the tip. The truth is by quadrature, to 25 digits:

    int dphi / kappa = 1,  int sin phi / kappa dphi = -y0,  x1 = kappa(0) / f .
"""

import math

import mpmath
import numpy as np

from problems import Contact, Line, Problem, Unknowns

NAME = "a-floor"
Y0, PHI0 = 0.4, -0.75


def problem():
    with mpmath.workdps(30):
        y0, phi0 = mpmath.mpf(Y0), mpmath.mpf(PHI0)

        def equations(f, phi1):
            # phi = phi1 - u^2 and sin phi1 - sin phi = 2 cos(phi1 - u^2 / 2) sin(u^2 / 2): not singular at the tip
            def per_u(u):
                return 2 / mpmath.sqrt(2 * f * mpmath.cos(phi1 - u * u / 2) * mpmath.sinc(u * u / 2))

            ends = [0, mpmath.sqrt(phi1 - phi0)]
            height = mpmath.quad(lambda u: mpmath.sin(phi1 - u * u) * per_u(u), ends)
            return mpmath.quad(per_u, ends) - 1, height + y0

        f, phi1 = mpmath.findroot(equations, (mpmath.mpf(1), phi0 / 3))
        x1 = mpmath.sqrt(2 * (mpmath.sin(phi1) - mpmath.sin(phi0)) / f)
        truth = results(float(f), float(x1), 0.0)
        solution = Unknowns((-float(x1),), (float(f),), (1.0,), float(phi1))
    contact = Contact(Line((0.0, 0.0), math.pi), True)
    return Problem(NAME, "A", (0.0, Y0, PHI0), (contact,), solution, truth)


def results(f, x1, y1):
    """Reactions and the contact's position, from the force of the floor and where the tip is."""
    return np.array([0.0, -f, -f * x1, x1, y1])


def divided(elements, centred):
    """Length of an element, and how far the first one reaches behind the clamp.

    Both programs hold the first element whole, so that the rod is clamped in its middle, wherever that is.
    """
    length = 1 / (elements - 0.5) if centred else 1 / elements
    return length, 0.5 * length if centred else 0.0
