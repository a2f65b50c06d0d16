"""How many digits are carried, and how a number is rounded for a file."""

from mpmath import mp, mpf, nstr

# Decimal digits of all arithmetic. The files claim 30: the rest is for what cancels.
WORKING = 75
# Steps of difference quotients: their error, and that of Newton's method with them, is of this order.
STEP = mpf(10) ** -30
# Decimal digits written.
WRITTEN = 36
# Results below this are zero: a sum that cancels exactly.
ZERO = mpf(10) ** -50

mp.dps = WORKING


def written(value):
    return "0" if abs(value) < ZERO else nstr(value, WRITTEN, strip_zeros=False, min_fixed=-4, max_fixed=12)
