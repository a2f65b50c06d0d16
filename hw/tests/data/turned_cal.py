"""Writes turned.cal, a calibration file of ATI's shape for a sensor that there is not, and prints forces for volts.

The tests of the reader compare with both. UserAxis is worked out by another way than there: forces and lever arms as
vectors, turned about one axis after the other.
"""

import math
import random

DRAW = random.Random(7)
AXES = ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"]
SCALE = [2.34, 2.34, 0.748, 0.0448, 0.0448, 0.0431]
MAX = [12, 12, 17, 120, 120, 120]
SHIFT = (1.5, -2.25, 12.0142)  # mm
TURN = (10, -20, 30)  # degrees

printed = [[f"{DRAW.uniform(-40, 40):.5f}" for _ in range(6)] for _ in range(6)]
basic = [[float(v) / scale for v in row] for row, scale in zip(printed, SCALE)]


def turn(axis, degrees, v):
    """The components of v in axes that are turned by so much about one of them."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    a, b = v[(axis + 1) % 3], v[(axis + 2) % 3]
    out = list(v)
    out[(axis + 1) % 3], out[(axis + 2) % 3] = c * a + s * b, c * b - s * a
    return out


def cross(a, b):
    return [a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for i in range(3)]


def moved(wrench):
    force, torque = wrench[:3], wrench[3:]
    torque = [m - x for m, x in zip(torque, cross(SHIFT, force))]
    for axis, degrees in enumerate(TURN):
        force, torque = turn(axis, degrees, force), turn(axis, degrees, torque)
    return force + torque


user = list(zip(*(moved([row[j] for row in basic]) for j in range(6))))

lines = ['<?xml version="1.0" encoding="utf-8"?>', "<!-- written by turned_cal.py: of no real sensor -->"]
lines += ['<FTSensor Serial="FT00000" BodyStyle="None" Family="DAQ" NumGages="6" CalFileVersion="1.1">']
lines += [
    '\t<Calibration PartNumber="SI-12-0.12" CalDate="1/2/2003" ForceUnits="N" TorqueUnits="N-mm" DistUnits="mm" '
    'OutputMode="Ground Referenced Differential" OutputRange="20" HWTempComp="True" OutputBipolar="True">'
]
for name, row, largest, scale in zip(AXES, printed, MAX, SCALE):
    lines += [f'\t\t<Axis Name="{name}" values=" {"  ".join(row)} " max="{largest}" scale="{scale}"/>']
d, r = SHIFT, TURN
lines += [f'\t\t<BasicTransform Dx="{d[0]}" Dy="{d[1]}" Dz="{d[2]}" Rx="{r[0]}" Ry="{r[1]}" Rz="{r[2]}"/>']
for name, row, largest in zip(AXES, user, MAX):
    values = "  ".join(f"{v:.5f}" for v in row)
    lines += [f'\t\t<UserAxis Name="{name}" values=" {values} " max="{largest}"/>']
lines += ["\t</Calibration>", "</FTSensor>", ""]
with open("turned.cal", "w", encoding="utf-8") as file:
    file.write("\n".join(lines))

volts = [0.1, -0.2, 0.3, -0.4, 0.5, -0.6]
found = [sum(a * v for a, v in zip(row, volts)) for row in user]
print([float(f"{f:.12g}") for f in found[:3]], "N", [float(f"{f * 1e-3:.12g}") for f in found[3:]], "N m")
