"""Way 2 for one segment: Jacobi's elliptic functions and integrals, regime by regime.

With P = hypot(A, B) and delta = phi - atan2(B, A) - pi/2 the segment is a pendulum, delta'' = -P sin delta, of energy
M = (kappa / 2)^2 + P sin(delta / 2)^2: inflectional where M < P, orbit-like where M > P, between them the separatrix.
"""

from mpmath import mp, mpf

NAME = "Jacobi elliptic functions and integrals"


def _amplitude(u, m):
    """am(u | m) with sn, cn, dn."""
    sn, cn, dn = (mp.ellipfun(name, u=u, m=m) for name in ("sn", "cn", "dn"))
    within = mp.atan2(sn, cn)
    turns = mp.nint((mp.pi * u / (2 * mp.ellipk(m)) - within) / (2 * mp.pi))
    return within + 2 * mp.pi * turns, sn, cn, dn


def advance(state, a, b, length):
    """(x, y, phi, kappa) at `length` (negative: backwards) along a segment that carries the force (A, B)."""
    p = mp.hypot(a, b)
    # what is divided by P or by the modulus loses so many digits
    lost = 0 if p == 0 else max(0, -2 * int(mp.floor(mp.log10(p)))) + 15
    with mp.workdps(mp.dps + lost):
        end = _advance([mpf(v) for v in state], mpf(a), mpf(b), mpf(length))
    return [+v for v in end]


def _advance(state, a, b, length):
    x, y, phi, kappa = state
    p = mp.hypot(a, b)
    if p == 0:
        if kappa == 0:
            return [x + length * mp.cos(phi), y + length * mp.sin(phi), phi, kappa]
        end = phi + kappa * length
        return [x + (mp.sin(end) - mp.sin(phi)) / kappa, y - (mp.cos(end) - mp.cos(phi)) / kappa, end, kappa]
    axis = mp.atan2(b, a) + mp.pi / 2
    delta = phi - axis
    turns = mp.nint(delta / (2 * mp.pi))
    delta -= 2 * mp.pi * turns
    sine, q = mp.sin(delta / 2), kappa / 2
    root = mp.sqrt(p)
    energy = q * q + p * sine * sine
    direction = -1 if q < 0 else 1
    if energy == 0 or (q == 0 and abs(sine) == 1):
        return [x + length * mp.cos(phi), y + length * mp.sin(phi), phi, kappa]
    if abs(energy - p) < p * mpf(10) ** (10 - mp.dps):
        u = mp.atanh(sine)
        v = u + direction * root * length
        delta, kappa_end = 2 * mp.atan(mp.sinh(v)), 2 * direction * root * mp.sech(v)
        along = 2 * direction * (mp.tanh(v) - mp.tanh(u)) / root - length
    elif energy < p:
        m = energy / p
        k = mp.sqrt(m)
        amplitude = mp.atan2(sine / k, q / (root * k))
        u = mp.ellipf(amplitude, m)
        end, sn, cn, dn = _amplitude(u + root * length, m)
        delta, kappa_end = 2 * mp.atan2(k * sn, dn), 2 * root * k * cn
        along = 2 * (mp.ellipe(end, m) - mp.ellipe(amplitude, m)) / root - length
    else:
        m, rate = p / energy, direction * mp.sqrt(energy)
        u = mp.ellipf(delta / 2, m)
        end, sn, cn, dn = _amplitude(u + rate * length, m)
        second = (mp.ellipe(end, m) - mp.ellipe(delta / 2, m)) / rate
        delta, kappa_end = 2 * end, 2 * rate * dn
        along = length - 2 * (length - second) / m
    across = -(kappa_end - kappa) / p
    cos, sin = mp.cos(axis), mp.sin(axis)
    return [
        x + along * cos - across * sin,
        y + along * sin + across * cos,
        delta + axis + 2 * mp.pi * turns,
        kappa_end,
    ]
