"""What is asked: the inputs of every problem, and where the two ways start to look (a few digits)."""

from math import pi

UP = pi / 2  # as a double


def parabola(x, y, coefficient):
    return {"shape": "parabola", "vertex": [float(x), float(y)], "coefficient": float(coefficient)}


def circle(x, y, radius):
    return {"shape": "circle", "centre": [float(x), float(y)], "radius": float(radius)}


def line(x, y, angle):
    return {"shape": "line", "point": [float(x), float(y)], "angle": float(angle)}


def vertex(x, y):
    return {"shape": "vertex", "point": [float(x), float(y)]}


def clamp(x, y, phi):
    return {"x": float(x), "y": float(y), "phi": float(phi)}


def tangent(support, start, turns=0):
    """Start: parameter of the support, force, arc length."""
    return {"support": support, "hold": "tangent", "turns": turns}, start


def tip(support, start):
    """Start: parameter of the support, force, slope angle."""
    return {"support": support, "hold": "tip"}, start


def notch(supports, near, start):
    """Start: angle of the resultant, force, slope angle."""
    return {"supports": supports, "hold": "notch", "near": near}, start


def segment(name, about, start, force, length=1.0):
    x, y, phi, kappa = map(float, start)
    a, b = map(float, force)
    inputs = {"start": {"x": x, "y": y, "phi": phi, "kappa": kappa}, "force": {"a": a, "b": b}, "length": length}
    return name, about, "segment", inputs, None


def cone(taper, curvature=(0, 0)):
    """The natural curvature: its constant and its slope."""
    return {"taper": float(taper), "curvature": [float(c) for c in curvature]}


def sections(*parts):
    """Parts: arc length of the end, stiffness, natural curvature."""
    return {"sections": [dict(zip(("to", "stiffness", "curvature"), map(float, part))) for part in parts]}


def contacts(name, about, pose, supports, held, rod=None):
    inputs = {"clamp": clamp(*pose), "supports": supports, "contacts": [contact for contact, _ in held]}
    kind = "contacts"
    if rod is not None:
        kind, inputs = "rod-contacts", {"rod": rod, **inputs}
    return name, about, kind, inputs, {"contacts": [start for _, start in held]}


def transition(name, about, phases, pose, motion, tau, condition, supports, held, contact=None, rod=None):
    of = {} if contact is None else {"contact": contact}
    inputs = {
        "clamp": clamp(*pose),
        "motion": clamp(*motion),
        "transition": {"condition": condition, **of, "from": phases[0], "to": phases[1]},
        "supports": supports,
        "contacts": [contact for contact, _ in held],
    }
    kind = "transition"
    if rod is not None:
        kind, inputs = "rod-transition", {"rod": rod, **inputs}
    return name, about, kind, inputs, {"tau": tau, "contacts": [start for _, start in held]}


# Objects of Merker et al. (2020), in lengths of the rod.
O1 = [parabola(0, 0, 5), parabola(0.3, 0, 5)]
O2 = [parabola(0, 0, 5), parabola(0.3, 0.1, 5)]
LEFT = (-1, 0, 0)

SEGMENTS = [
    segment("segment-inflectional", "An arc that oscillates about the direction of the force.", (0, 0, 0.3, 1), (4, -2)),
    segment("segment-inflection-passed", "Inflectional, over two inflections.", (0.1, -0.2, 1.0, 3), (30, 20)),
    segment("segment-orbit", "An arc that turns over in one sense, more than once.", (0, 0, 0.3, 9), (3, 1)),
    segment("segment-orbit-clockwise", "Turns over clockwise.", (0.2, 0.1, -0.4, -7), (-5, 4)),
    segment("segment-separatrix", "Exactly on the separatrix: kappa = 2 sqrt P at delta = 0.", (0, 0, 0, 8), (0, -16)),
    segment("segment-below-separatrix", "Next to the separatrix, inside.", (0, 0, 0, 8 - 1e-9), (0, -16)),
    segment("segment-above-separatrix", "Next to the separatrix, outside.", (0, 0, 0, 8 + 1e-9), (0, -16)),
    segment("segment-circle", "No force: a circular arc.", (0.5, -0.5, 0.4, 2), (0, 0)),
    segment("segment-nearly-circle", "A tiny force on a bent rod.", (0, 0, 0.4, 2), (1e-12, -3e-13)),
    segment("segment-nearly-straight", "A tiny force on a straight rod.", (0, 0, 0.7, 0), (1e-12, -3e-13)),
    segment("segment-tiny-curvature", "A tiny curvature under a finite force that hardly turns it.", (0, 0, UP, 1e-9), (0, 3)),
    segment("segment-unstable-rest", "Next to rest in the unstable direction.", (0, 0, 1e-9, 0), (0, 20)),
    segment("segment-coils", "More than six whole turns.", (0, 0, 5, 40), (3, 1)),
    segment("segment-backwards", "Backwards from a point without moment.", (0.3, 0.4, 1.2, 0), (2, 7), -0.8),
    segment("segment-strong", "A strong force, P = 400, nearly three periods.", (0, 0, 1, 5), (-240, 320)),
    segment("segment-strong-orbit", "A strong force, P = 400, outside the separatrix.", (0, 0, 1, 45), (-240, 320), -1.0),
    segment("segment-strong-along-unstable", "P = 400 along the unstable direction: errors grow 5e8 times.", (0, 0, 1e-6, 0), (0, 400)),
]

CONTACTS = [
    contacts("a-parabola", "Phase A on object O1, q = 0.4.", (0.55, -0.4, UP), O1, [tip(1, (0.6448, 0.2894, 1.39))]),
    contacts(
        "a-parabola-before-snap-off",
        "Phase A on object O1, q = 0.4, close to the fold where the rod snaps off.",
        (-0.817, -0.4, UP), O1, [tip(0, (-0.077, 5.7, -0.14))],
    ),
    contacts(
        "a-just-touching",
        "Phase A, the tip about 3e-13 beyond first contact: a tiny force.",
        (0.6464101615134, -0.4, UP), O1, [tip(1, (0.64641, 1e-12, 1.5708))],
    ),
    contacts(
        "a-strong-circle",
        "Phase A, the tip on a disc, the rod coiled by a strong force; the equilibrium is unstable.",
        (0, 0, 0), [circle(0.993, -0.387, 0.1)], [tip(0, (-1.9414, 250, -0.7414))],
    ),
    contacts(
        "a-line", "Phase A on a straight wall.", (0, 0, 0), [line(0.95, 0, -1.2)], [tip(0, (0.13, 1.1, -0.19))],
    ),
    contacts(
        "a-floor", "Phase A on a floor, as other programs can do it.", (0, 0.4, -0.75), [line(0, 0, pi)],
        [tip(0, (-0.9, 1.0, -0.2))],
    ),
    contacts("b-parabola", "Phase B on object O1, q = 0.4.", (0.2, -0.4, UP), O1, [tangent(1, (0.4277, 4.566, 0.5434))]),
    contacts(
        "b-just-touching",
        "Phase B on a disc that a straight rod would just touch: a tiny force.",
        (0, 0, 0), [circle(0.6, 0.05 - 7e-14, 0.05)], [tangent(0, (0.0, 1e-12, 0.6))],
    ),
    contacts(
        "b-strong", "Phase B close to the clamp, with a huge force.",
        (0, 0, 0), [circle(0.024, 0.001, 0.01)], [tangent(0, (-0.593, 3000, 0.02))],
    ),
    contacts(
        "b-disc", "Phase B on a disc.", (0, 0, 0), [circle(0.5, -0.1, 0.08)], [tangent(0, (-0.5, 5, 0.5))],
    ),
    contacts(
        "b-line", "Phase B on a straight wall.",
        (0, -0.2, 1.0), [line(0, 0, 0)], [tangent(0, (0.5, 6, 0.6))],
    ),
    contacts(
        "b-flat-parabola", "Phase B on a nearly flat contour, a parabola of coefficient 1e-6.",
        (0, -0.2, 1.0), [parabola(0, 0, 1e-6)], [tangent(0, (0.5, 6, 0.6))],
    ),
    contacts(
        "b-flat-circle", "Phase B on a nearly flat contour, a circle of radius 1e6.",
        (0, -0.2, 1.0), [circle(0, 1e6, 1e6)], [tangent(0, (0.5e-6, 6, 0.6))],
    ),
    contacts(
        "b-sharp-parabola", "Phase B on a very sharp contour, a parabola of coefficient 1e6.",
        (0, 0, 0.1), [parabola(0.5, -0.03, 1e6)], [tangent(0, (0.4999999, 5, 0.51))],
    ),
    contacts(
        "b-sharp-circle", "Phase B on a very sharp contour, a circle of radius 1e-6.",
        (0, 0, 0), [circle(0.484, -0.318, 1e-6)], [tangent(0, (-0.877, 5, 0.6))],
    ),
    contacts(
        "b-corner", "The rod lies on a corner, tangent angle free.",
        (0, 0, 0), [vertex(0.5, -0.1)], [tangent(0, (-0.4, 4, 0.51))],
    ),
    contacts(
        "a-notch", "The tip in the notch of object O1, held by two forces, given as one.",
        (0.16, -0.85, UP), O1, [notch([0, 1], 0.15, (0.1, 20.3, 2.07))],
    ),
    contacts(
        "bb-two-parabolas", "Phase BB on object O1, q = 0.4.", (-0.47, -0.4, UP), O1,
        [tangent(0, (0.0084, 1.254, 0.6894)), tangent(1, (0.2957, 3.0777, 0.9768))],
    ),
    contacts(
        "bb-two-parabolas-raised", "Phase BB on object O2, q = 0.4.", (-0.3, -0.4, UP), O2,
        [tangent(0, (0.0424, 2.2445, 0.5667)), tangent(1, (0.3288, 2.6503, 0.8687))],
    ),
    contacts(
        "bb-both-sides", "Phase BB between two discs, the second one at the other side of the rod.", (0, 0, 0),
        [circle(0.341, -0.192, 0.05), circle(0.752, -0.305, 0.03)],
        [tangent(0, (-0.6247, 30, 0.4)), tangent(1, (-2.9734, 8, 0.85), turns=1)],
    ),
    contacts(
        "ba-two-parabolas", "Phase BA on object O1, q = 0.4.", (-0.53, -0.4, UP), O1,
        [tangent(0, (0.0064, 3.383, 0.744)), tip(1, (0.2622, 1.7945, -0.1))],
    ),
    contacts(
        "ba-two-parabolas-strong", "Phase BA on object O1, q = 0.6, just after the snap from A.", (-0.43, -0.6, UP), O1,
        [tangent(0, (0.032, 1.7133, 0.8273)), tip(1, (0.1983, 7.4613, -0.1))],
    ),
    contacts(
        "bba-discs", "Phase BBA on three discs, the second one at the other side of the rod.", (0, 0, 0),
        [circle(0.254, -0.121, 0.05), circle(0.516, -0.055, 0.05), circle(0.806, 0.334, 0.1)],
        [tangent(0, (-0.309, 60, 0.3)), tangent(1, (-2.2439, 40, 0.6), turns=1), tip(2, (-0.2817, 6, 0.6183))],
    ),
    contacts(
        "bbb-discs", "Phase BBB on three discs at alternate sides of the rod.", (0, 0, 0),
        [circle(0.214, 0.069, 0.05), circle(0.407, 0.275, 0.05), circle(0.58, 0.512, 0.04)],
        [tangent(0, (0.6334, 60, 0.25)), tangent(1, (-2.0488, 50, 0.55), turns=1), tangent(2, (0.4278, 15, 0.85))],
    ),
    contacts(
        "bbbb-wound", "Phase BBBB, the rod wound around four discs.", (0, 0, 0),
        [circle(0.263, -0.028, 0.05), circle(0.412, 0.17, 0.05), circle(0.175, 0.251, 0.05), circle(0.051, 0.062, 0.05)],
        [
            tangent(0, (-2.8475, 40, 0.25), turns=1), tangent(1, (-1.3829, 40, 0.45), turns=1),
            tangent(2, (0.6075, 40, 0.65), turns=1), tangent(3, (1.2004, 30, 0.85), turns=1),
        ],
    ),
]

# The clamp at (0, -q) moves by tau to -x: x0 = -tau.
Q4, Q6 = (0, -0.4, UP), (0, -0.6, UP)
TRANSITIONS = [
    transition(
        "o1-q40-1-first-contact", "O1, q = 0.4: the tip of the straight rod meets the right parabola.", ("free", "A"),
        Q4, LEFT, -0.6464, "touch", O1, [tip(1, (0.6464, 0, 1.5708))], contact=0,
    ),
    transition(
        "o1-q40-2-a-to-b", "O1, q = 0.4: the tip becomes tangent.", ("A", "B"),
        Q4, LEFT, -0.4514, "arc-length", O1, [tangent(1, (0.6389, 0.578, 1.0))], contact=0,
    ),
    transition(
        "o1-q40-3-b-to-bb", "O1, q = 0.4: the rod touches the left parabola.", ("B", "BB"),
        Q4, LEFT, 0.4305, "touch", O1, [tangent(0, (0.0107, 0, 0.656)), tangent(1, (0.2944, 4.06, 0.9395))], contact=0,
    ),
    transition(
        "o1-q40-4-bb-to-ba", "O1, q = 0.4: the second contact reaches the tip.", ("BB", "BA"),
        Q4, LEFT, 0.4942, "arc-length", O1, [tangent(0, (0.0071, 1.9, 0.71)), tangent(1, (0.2964, 2.55, 1.0))], contact=1,
    ),
    transition(
        "o1-q40-5-ba-to-b", "O1, q = 0.4: the tip is released.", ("BA", "B"),
        Q4, LEFT, 0.5674, "force", O1, [tangent(0, (0.01, 5.1, 0.778)), tip(1, (0.23, 0, 0.0))], contact=1,
    ),
    transition(
        "o1-q40-6-b-to-a", "O1, q = 0.4: the contact reaches the tip.", ("B", "A"),
        Q4, LEFT, 0.7872, "arc-length", O1, [tangent(0, (-0.0125, 3.76, 1.0))], contact=0,
    ),
    transition(
        "o1-q40-7-snap-off", "O1, q = 0.4: the equilibrium ends in a fold, the rod snaps off.", ("A", "free"),
        Q4, LEFT, 0.8173, "fold", O1, [tip(0, (-0.08, 5.4, 0.1))],
    ),
    transition(
        "o1-q60-snap-a-to-ba", "O1, q = 0.6: phase A ends in a fold, the rod snaps to BA.", ("A", "BA"),
        Q6, LEFT, 0.4235, "fold", O1, [tip(1, (0.24, 5, 0.1))],
    ),
    transition(
        "o1-q60-ba-to-b", "O1, q = 0.6: the tip is released.", ("BA", "B"),
        Q6, LEFT, 0.4855, "force", O1, [tangent(0, (0.051, 3.04, 0.861)), tip(1, (0.17, 0, 0.4))], contact=1,
    ),
    transition(
        "o2-q40-b-to-bb", "O2, q = 0.4: the rod touches the left parabola.", ("B", "BB"),
        Q4, LEFT, 0.2624, "touch", O2, [tangent(0, (0.046, 0, 0.542)), tangent(1, (0.3271, 3.9, 0.8395))], contact=0,
    ),
    transition(
        "o2-q40-bb-to-b", "O2, q = 0.4: the second contact is released.", ("BB", "B"),
        Q4, LEFT, 0.4058, "force", O2, [tangent(0, (0.033, 6.3, 0.642)), tangent(1, (0.3335, 0, 0.96))], contact=1,
    ),
]

CONE, CURVED = cone(0.8), sections((1, 1, 0.5))
HALVES = sections((0.5, 1, 0), (1, 0.25, 0))
WHISKER = cone(0.9, (0.3, 0.6))

# Rods that taper, have sections, or are bent at rest.
RODS = [
    contacts(
        "cone-a-parabola", "A cone, tip 1/5 as thick, in phase A on object O1, q = 0.4.", (0.6, -0.4, UP), O1,
        [tip(1, (0.6458, 0.0281, 1.4095))], CONE,
    ),
    contacts(
        "cone-b-parabola", "A cone, tip 1/5 as thick, in phase B on object O1, q = 0.4.", (0.1, -0.4, UP), O1,
        [tangent(1, (0.35718, 3.9295, 0.518))], CONE,
    ),
    contacts(
        "cone-bb-two-parabolas", "A cone, tip 1/5 as thick, in phase BB on object O1, q = 0.4.", (-0.25, -0.4, UP), O1,
        [tangent(0, (0.02514, 3.018, 0.5306)), tangent(1, (0.27965, 0.8123, 0.7877))], CONE,
    ),
    transition(
        "cone-o1-q40-b-to-bb", "A cone, tip 1/5 as thick, O1, q = 0.4: it touches the left parabola.", ("B", "BB"),
        Q4, LEFT, 0.11875, "touch", O1, [tangent(0, (0.0511, 0, 0.468)), tangent(1, (0.267, 3.52, 0.68))], 0, CONE,
    ),
    contacts(
        "curved-ba-parabola", "A rod with the curvature 0.5 at rest in phase BA, both contacts on one parabola of O1, q = 0.4.",
        (0.35, -0.4, UP), O1, [tangent(1, (0.56426, 0.9167, 0.7842)), tip(1, (0.63278, 0.994, 1.2938))], CURVED,
    ),
    transition(
        "curved-o1-q40-ba-to-b", "A rod with the curvature 0.5 at rest, O1, q = 0.4: the tip is released.", ("BA", "B"),
        Q4, LEFT, -0.28861, "force", O1, [tangent(1, (0.5165, 3.38, 0.68)), tip(1, (0.627, 0, 1.3))], 1, CURVED,
    ),
    contacts(
        "halves-bb-two-parabolas", "A rod whose outer half has 1/4 of the stiffness, in phase BB on object O1, q = 0.4.",
        (-0.35, -0.4, UP), O1, [tangent(0, (0.01833, 4.3831, 0.5862)), tangent(1, (0.29023, 1.8764, 0.8591))], HALVES,
    ),
    transition(
        "halves-o1-q40-a-to-b", "A rod whose outer half has 1/4 of the stiffness, O1, q = 0.4: the tip becomes tangent.", ("A", "B"),
        Q4, LEFT, -0.49447, "arc-length", O1, [tangent(1, (0.642, 0.327, 1.0))], 0, HALVES,
    ),
    transition(
        "halves-o1-q40-snap",
        "A rod whose outer half has 1/4 of the stiffness, O1, q = 0.4: phase B ends in a fold, the rod snaps to phase B on the same "
        "parabola.", ("B", "B"),
        Q4, LEFT, 0.567237, "fold", O1, [tangent(0, (-0.06, 5.4, 0.861))], None, HALVES,
    ),
    contacts(
        "whisker-b-disc",
        "A cone, tip 1/10 as thick, whose curvature at rest grows from 0.3 to 0.9, in phase B on a disc.",
        (0, 0, 0), [circle(0.5, 0.0, 0.05)], [tangent(0, (-0.1, 0.5, 0.5))], WHISKER,
    ),
    contacts(
        "whisker-a-line",
        "A cone, tip 1/10 as thick, whose curvature at rest grows from 0.3 to 0.9, in phase A on a wall.", (0, 0, 0),
        [line(0, 0.15, 0.0)], [tip(0, (0.97, 0.02, 0.4))], WHISKER,
    ),
    contacts(
        "whisker-ba-discs",
        "A cone, tip 1/10 as thick, whose curvature at rest grows from 0.3 to 0.9, in phase BA on two discs.", (0, 0, 0),
        [circle(0.5, 0.0, 0.05), circle(1.045, 0.0, 0.1)],
        [tangent(0, (-0.16257, 1.2975, 0.49518)), tip(1, (-0.52466, 0.019588, -0.11721))], WHISKER,
    ),
]

ALL = SEGMENTS + CONTACTS + TRANSITIONS + RODS
