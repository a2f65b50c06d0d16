"""The share of random guesses from which scipy's `root(method="hybr")` comes to the right equilibrium.

    hybr.py GUESSES

The guesses are those that `cargo bench --bench rough_guesses -- --write GUESSES` writes. The residuals are those of vibrissa: from
each contact back to the one before it, in closed form, unknowns t (or x - vertex), f, s of each contact, and in place of s the slope
angle at the tip. Its first value follows from the chords between the contacts, as in vibrissa; on which side of the rod a contact
lies is taken from the true state. `hybr` gets no Jacobian, as most callers give it none.
"""

import csv
import math
import sys
import time
from collections import Counter, defaultdict
from dataclasses import dataclass

from scipy.optimize import root

COEFFICIENT = 5.0
SAME = 1e-9  # as in rough_guesses.rs
SMALL = 0.008  # of max(P, M) s^2 for which seven terms are exact
ENDS = "right", "other, admissible", "inadmissible", "not solved"


def basis(p, m, s):
    """S, C, D, Z, V of one segment: a short series, doubled."""
    halvings = 0
    while max(p, m) * s * s > SMALL:
        s, halvings = s / 2, halvings + 1
    # S' = C D, C' = -P S D, D' = -M S C, Z' = D^2 by Taylor's coefficients
    coefficients = [[0.0], [1.0], [1.0], [0.0]]
    S, C, D, Z = coefficients

    def product(u, v, k):
        return sum(u[i] * v[k - i] for i in range(k + 1))

    for k in range(14):
        cd, sd, sc, dd = product(C, D, k), product(S, D, k), product(S, C, k), product(D, D, k)
        for series, rate in zip(coefficients, (cd, -p * sd, -m * sc, dd)):
            series.append(rate / (k + 1))
    S, C, D, Z = (sum(c * s**k for k, c in enumerate(series)) for series in coefficients)
    V = S * S / (1 + C)
    for _ in range(halvings):
        e = C * C + p * S * S * D * D
        S2, V2, W2 = 2 * S * C * D / e, 2 * (S * D) ** 2 / e, 2 * (S * C) ** 2 / e
        Z = 2 * Z - m * S * S * S2
        S, V, C, D = S2, V2, 1 - p * V2, 1 - m * W2
    return S, C, D, Z, V


def advance(x, y, phi, kappa, fa, fb, s):
    """The end of a segment of length s under the force (A, B): x' = cos phi, y' = sin phi, kappa' = A cos phi + B sin phi."""
    p = math.hypot(fa, fb)
    beta = math.atan2(fb, fa)
    delta = phi - beta - math.pi / 2
    a, b, q = math.sin(delta / 2), math.cos(delta / 2), kappa / 2
    m = q * q + p * a * a
    S, C, D, Z, V = basis(p, m, s)
    e = 1 - p * a * a * S * S
    a1, b1 = (a * C * D + b * q * S) / e, (b * D - a * q * S * C) / e
    q1 = (q * C - a * b * p * S * D) / e
    along, across = 2 * (Z - a * a1 * S) - s, -2 * (q * (a * a * S * S - V) - a * b * S * D) / e
    c, d = math.cos(beta + math.pi / 2), math.sin(beta + math.pi / 2)
    # whole turns do not come up: a frictionless contact never makes a rod of such scenes coil
    return x + along * c - across * d, y + along * d + across * c, phi + 2 * math.atan2(a1 * b - b1 * a, b1 * b + a1 * a), 2 * q1


@dataclass
class Contact:
    tip: bool
    xv: float
    yv: float
    offset: float
    guess: tuple  # t, f, s
    truth: tuple  # t, f, s
    slope: float  # of the rod at the true contact

    def at(self, t):
        return self.xv + t, self.yv + COEFFICIENT * t * t, math.atan(2 * COEFFICIENT * t)


def residual(u, clamp, contacts):
    """The end of each segment, run backwards, minus where it has to be."""
    nodes, a, b, kappa = [], 0.0, 0.0, 0.0
    for j in reversed(range(len(contacts))):
        contact, (t, f, third) = contacts[j], u[3 * j : 3 * j + 3]
        x, y, alpha = contact.at(t)
        if nodes:
            ahead = nodes[-1]
            kappa += a * (x - ahead[0]) + b * (y - ahead[1])
        phi, s = (third, 1.0) if contact.tip else (alpha + contact.offset, third)
        a, b = a + f * math.cos(alpha), b + f * math.sin(alpha)
        nodes.append((x, y, phi, s, kappa, a, b))
    nodes.reverse()
    off = []
    behind = (*clamp, 0.0)
    for x, y, phi, s, kappa, a, b in nodes:
        end = advance(x, y, phi, kappa, a, b, behind[3] - s)
        off += [end[0] - behind[0], end[1] - behind[1], end[2] - behind[2]]
        behind = x, y, phi, s
    return off


def unknowns(clamp, contacts):
    """The guess; the angle at the tip by chords: an arc turns twice as far as its chord."""
    x, y, phi = clamp
    u = []
    for contact in contacts:
        t, f, s = contact.guess
        px, py, alpha = contact.at(t)
        turn = math.atan2(py - y, px - x) - phi
        phi += 2 * (turn - math.tau * round(turn / math.tau))
        x, y = px, py
        u += [t, f, phi if contact.tip else s]
        if not contact.tip:
            phi = alpha + contact.offset
    return u


def true(contacts):
    return [v for c in contacts for v in (c.truth[0], c.truth[1], c.slope if c.tip else c.truth[2])]


def end(found, contacts):
    if not found.success:
        return "not solved"
    us = [found.x[3 * j : 3 * j + 3] for j in range(len(contacts))]
    same = [
        abs(t - c.truth[0]) <= SAME
        and abs(f - c.truth[1]) <= SAME * (1 + c.truth[1])
        and abs(third - (c.slope if c.tip else c.truth[2])) <= 10 * SAME
        for (t, f, third), c in zip(us, contacts)
    ]
    if all(same):
        return "right"
    # pulls, beyond the tip, out of order; penetration and stability are not looked at
    places = [0.0, *(1.0 if c.tip else third for (_, _, third), c in zip(us, contacts))]
    holds = all(f >= 0 for _, f, _ in us) and places == sorted(places) and places[-1] <= 1
    return "other, admissible" if holds else "inadmissible"


def read(file):
    for spread, phase, x0, y0, phi0, *rest in csv.reader(file):
        numbers = [float(v) for v in rest]
        contacts = []
        for k in range(0, len(numbers), 11):
            tip, xv, yv, offset, *more = numbers[k : k + 11]
            contacts.append(Contact(tip == 1, xv, yv, offset, tuple(more[:3]), tuple(more[3:6]), more[6]))
        yield spread, phase, (float(x0), float(y0), float(phi0)), contacts


def main():
    counts, seconds = defaultdict(Counter), Counter()
    with open(sys.argv[1], newline="") as file:
        for spread, phase, clamp, contacts in read(file):
            # the same equations: the state of the sweep solves them
            assert max(map(abs, residual(true(contacts), clamp, contacts))) < 1e-11, (clamp, contacts)
            start = time.perf_counter()
            found = None
            try:
                found = root(residual, unknowns(clamp, contacts), args=(clamp, contacts), method="hybr", options={"xtol": 1e-13})
            except (OverflowError, ZeroDivisionError, ValueError):
                pass  # it ran away
            seconds[spread, phase] += time.perf_counter() - start
            # xtol may be below rounding: what counts is whether the equations hold
            if found is not None:
                found.success = max(map(abs, found.fun)) < 1e-10
            counts[spread, phase]["not solved" if found is None else end(found, contacts)] += 1
    print("| guesses | phase | method |", " | ".join(ENDS), "| mean time |")
    print("|---" * (4 + len(ENDS)) + "|")
    for (spread, phase), count in counts.items():
        number = count.total()
        shares = " | ".join(f"{100 * count[name] / number:.1f} %" for name in ENDS)
        print(f"| {spread} | {phase} | scipy hybr | {shares} | {1e6 * seconds[spread, phase] / number:.0f} us |")


if __name__ == "__main__":
    main()
