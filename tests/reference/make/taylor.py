"""Way 1 for one segment: Taylor series of the differential equation.

x' = cos phi, y' = sin phi, phi' = kappa, kappa' = A cos phi + B sin phi is polynomial in (x, y, phi, kappa, cos, sin) once
cos' = -sin kappa and sin' = cos kappa are added. Fixed-point arithmetic: an integer N stands for N / 2^BITS.
"""

from operator import mul

from mpmath import mp, mpf

NAME = "Taylor series of the differential equation"

BITS = 340  # 1e-102
# Terms of the series and the step |h| * rate: it converges at worst like that of tanh, (2 REACH / pi)^n: 0.127^90 = 1e-80.
TERMS = 90
REACH = mpf("0.2")


def _fixed(value):
    return int(mp.floor(mp.ldexp(value, BITS)))


def _step(state, a, b, h):
    x, y, phi, kappa, cos, sin = ([v] for v in state)
    for n in range(TERMS - 1):
        cos_kappa = sum(map(mul, cos, reversed(kappa))) >> BITS
        sin_kappa = sum(map(mul, sin, reversed(kappa))) >> BITS
        bend = (a * cos[n] + b * sin[n]) >> BITS
        over = (n + 1) << BITS
        for series, rate in ((x, cos[n]), (y, sin[n]), (phi, kappa[n]), (kappa, bend), (cos, -sin_kappa), (sin, cos_kappa)):
            series.append(rate * h // over)
    return [sum(series) for series in (x, y, phi, kappa, cos, sin)]


def advance(state, a, b, length):
    """(x, y, phi, kappa) at `length` (negative: backwards) along a segment that carries the force (A, B)."""
    with mp.workprec(BITS + 40):
        x, y, phi, kappa = map(mpf, state)
        a, b, length = mpf(a), mpf(b), mpf(length)
        rate = abs(kappa) + 2 * mp.sqrt(mp.hypot(a, b))
        steps = max(1, int(mp.ceil(abs(length) * rate / REACH)))
        now = [_fixed(v) for v in (x, y, phi, kappa, mp.cos(phi), mp.sin(phi))]
        a, b, h = _fixed(a), _fixed(b), _fixed(length / steps)
        for _ in range(steps):
            now = _step(now, a, b, h)
        end = [mp.ldexp(mpf(v), -BITS) for v in now[:4]]
    return [+v for v in end]
