"""Way 1 along a cone: Taylor series of the differential equation.

With v = 1 / (1 - taper s), v' = taper v^2, the equation is polynomial in (x, y, phi, m, cos, sin, v, s): phi' = m v^4 + c0 + c1 s.
Fixed-point arithmetic, as in taylor.py.
"""

from operator import mul

from mpmath import mp, mpf

from taylor import BITS, REACH, TERMS, _fixed

# Step over the distance to the apex of the cone: the series of v converges like REACH_OF_APEX^n.
REACH_OF_APEX = mpf("0.12")


def _product(one, other):
    """The last term of the product of two series of the same length."""
    return sum(map(mul, one, reversed(other))) >> BITS


def _step(state, a, b, taper, curvature, h):
    x, y, phi, m, cos, sin, v = ([value] for value in state)
    square, fourth, kappa = [], [], []
    for n in range(TERMS - 1):
        square.append(_product(v, v))
        fourth.append(_product(square, square))
        # the series of c0 + c1 s have two terms
        kappa.append(_product(m, fourth) + (curvature[n] if n < 2 else 0))
        cos_kappa, sin_kappa = _product(cos, kappa), _product(sin, kappa)
        bend = (a * cos[n] + b * sin[n]) >> BITS
        grow = (taper * square[n]) >> BITS
        over = (n + 1) << BITS
        rates = (cos[n], sin[n], kappa[n], bend, -sin_kappa, cos_kappa, grow)
        for series, rate in zip((x, y, phi, m, cos, sin, v), rates):
            series.append(rate * h // over)
    return [sum(series) for series in (x, y, phi, m, cos, sin, v)]


def advance(cut, a, b, start, end, taper, curvature):
    """(x, y, phi, m) at `end` along a segment that carries the force (A, B)."""
    with mp.workprec(BITS + 40):
        x, y, phi, m = map(mpf, cut)
        a, b = mpf(a), mpf(b)
        force = mp.hypot(a, b)
        s = mpf(start)
        now = [*map(_fixed, (x, y, phi, m, mp.cos(phi), mp.sin(phi)))]
        while s != end:
            # within a step the stiffness falls to 0.6 of that at its beginning at most
            soft = 1 / (mpf("0.6") * (1 - taper * s) ** 4)
            bent = abs(mp.ldexp(mpf(now[3]), -BITS)) * soft + abs(curvature[0] + curvature[1] * s) + abs(curvature[1])
            rate = bent + 2 * mp.sqrt(force * soft)
            longest = REACH / max(rate, mpf(1))
            if taper != 0:
                longest = min(longest, REACH_OF_APEX * (1 / taper - s))
            h = end - s
            if abs(h) > longest:
                h = longest if h > 0 else -longest
            series = [_fixed(curvature[0] + curvature[1] * s), _fixed(curvature[1] * h)]
            *now, _ = _step([*now, _fixed(1 / (1 - taper * s))], _fixed(a), _fixed(b), _fixed(taper), series, _fixed(h))
            s = end if h == end - s else s + h
        found = [mp.ldexp(mpf(value), -BITS) for value in now[:4]]
    return [+value for value in found]
