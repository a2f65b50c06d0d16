"""The errors of three ways to estimate forces from the shape of a whisker, on the same frames.

    python studies/forces_from_shapes.py

Needs the package vibrissa (pip install ./python), numpy and scipy. Prints tables in Markdown, takes a minute, and prints the same numbers
each time but for the times per frame. Lengths in m, forces in N.

Frames
    `vibrissa.sweep` pushes the rat's whisker of docs/whiskers.md, straight or bent at rest, against a peg of 0.5 mm radius that it first touches
    at 30, 50, 70 or 85 % of its length. Of each sweep four states: at 1, 10, 50 and 90 % of the way on which the peg is touched. A frame is 40
    points on the rod, the same arc length apart, with Gaussian noise of 0, 0.0002 L or 0.001 L in x and y; 20 repeats. Sweep and (a) have the
    same model of a rod: without noise (a) shows that it inverts the model, and (b) and (c) show what they leave out.

(a) `vibrissa.forces`
    The elastica with the fewest contacts that explains the whole shape. Given: the points, the rod and its curvature at rest. Not given: the
    point of contact, the base and its angle, the noise; in the row `base given` base and angle are given to 1e-9 L and 1e-9 rad.

(b) Curvature at one point
    Pammer, O'Connor, Hires, Clack, Huber, Myers, Svoboda, J. Neurosci. 33, 6726 (2013). The text of its methods was not at hand; this follows
    public code of that group (`calc_M0_Faxial` of `WhiskerSignalTrial`, 2010), written anew. A pair of polynomials x(q), y(q) of degree 2 in the
    chord length q fits the part around one place near the base. The change of curvature there times E I there is the moment there; over the
    lever arm of the normal at the contact it is the force, and the force has a moment about the base. Given besides the points: the true point
    of contact, the rod, the same fit to the exact points of the whisker at rest. The code takes a place of 2.33 mm on a whisker of 16 mm, 0.15
    L, a part that its user chooses, and base and normal from polynomials of the whole whisker. Of degree 5 (that of the code is not known) those
    turn the base by up to 0.2 rad on these frames. Here base and normal are from polynomials of degree 2 too, of the first 0.2 L and of 0.1 L to
    either side of the contact. The part, from 0 to 0.4 L with the place in its middle, has the least 90 % quantiles at a noise of 0.0002 L among
    nine choices with degrees 2 and 3 and parts of 0.2 L to 0.4 L.

(c) Chain of rigid links
    Quist and Hartmann, J. Neurophysiol. 107, 2298 (2012). The text was not at hand; this follows the authors' public code `elastica2D` (2012),
    written anew. Links of one length are joined by springs of stiffness E I over length; the first does not turn. From the contact to the base
    each joint turns by the moment of a force that is normal to the last link. The simplex search of Nelder and Mead, from the code's guess,
    varies force and arc length until the chain ends in the point of contact. The number of links is the user's: here 100. Given: the true point
    of contact, the rod, the exact shape at rest. The base and its angle are those of (b), of which part and degree have the least errors of
    (c) at a noise of 0.0002 L among six choices. In the row `base given` they are exact: the points of a frame are not used there at all.

"Error of force" is that of the magnitude of the contact's force, "error of moment" that of m0z; both are relative to the true number. A frame
for which (a) tells no force, such as one with the verdict free, has an infinite error.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize

import vibrissa
from vibrissa.whiskers import Whisker

Array = npt.NDArray[np.float64]

# That of scenes/whisker.toml; the tip of the regression with one more digit.
WHISKER = Whisker(40.8e-3, 151.7e-6, 8.5736e-6, 3.34e9, "docs/whiskers.md")
LENGTH = WHISKER.length
PEG = 0.5e-3
PLACES = [0.3, 0.5, 0.7, 0.85]
PARTS_OF_WAY = [0.01, 0.1, 0.5, 0.9]
NOISES = [0.0, 0.0002, 0.001]
REPEATS = 20
POINTS = 40
SEED = 2013

CURVATURE_PLACE = 0.2
CURVATURE_PART = 0.4
BASE_PART = 0.2
CONTACT_PART = 0.1
LINKS = 100


@dataclass(frozen=True)
class Case:
    """A state of a sweep: what is true, and what (b) and (c) are given."""

    whisker: str
    place: float
    part_of_way: float
    rod: vibrissa.Rod
    rest: Array
    pose: Array
    points: Array
    contact: Array
    s: float
    tip: bool
    force: float
    moment: float


@dataclass
class Estimates:
    """Force, moment and seconds per frame of one way, in the order of the frames."""

    force: list[float] = field(default_factory=list)
    moment: list[float] = field(default_factory=list)
    seconds: float = math.nan


# The frames


def rest_shape(rod: vibrissa.Rod, points: int) -> Array:
    """x, y, phi of the rod at rest with its base at the origin, by a state of a sweep that touches nothing."""
    far = vibrissa.CircularArc((0.0, 10.0 * rod.length), PEG, 0.0, 2.0 * math.pi)
    scan = vibrissa.sweep(rod, far, vibrissa.ClampPath((0.0, 0.0, 0.0), (1e-3, 0.0, 0.0)), 1e-3)
    return scan.state(0).shape(rod, points)


def pushed(rod: vibrissa.Rod, place: float) -> list[vibrissa.State]:
    """The states that touch the peg, on the way of the clamp along the normal at the place until the whisker slips off or 0.4 L."""
    x, y, phi = rest_shape(rod, 1001)[round(1000 * place)]
    normal = np.array([-math.sin(phi), math.cos(phi)])
    centre = np.array([x, y]) + normal * (PEG + 1e-5)
    peg = vibrissa.CircularArc(tuple(centre), PEG, 0.0, 2.0 * math.pi)
    end = 0.4 * rod.length * normal
    try:
        scan = vibrissa.sweep(rod, peg, vibrissa.ClampPath((0.0, 0.0, 0.0), (end[0], end[1], 0.0)), 1e-4)
    except vibrissa.SweepStopped as stopped:
        if stopped.scan is None:
            raise
        scan = stopped.scan
    touching = [number for number in range(len(scan)) if scan.states["phase"][number] != "free"]
    # the first time that the peg is touched
    last = next((i for i in range(1, len(touching)) if touching[i] != touching[i - 1] + 1), len(touching))
    return [scan.state(number) for number in touching[:last]]


def case(whisker: str, place: float, part: float, rod: vibrissa.Rod, states: list[vibrissa.State]) -> Case:
    state = states[round(part * (len(states) - 1))]
    (contact,) = state.contacts
    return Case(
        whisker, place, part, rod, rest_shape(rod, POINTS)[:, :2], np.array(state.pose), state.shape(rod, POINTS)[:, :2],
        np.array([contact.x, contact.y]), contact.s, contact.kind == "tip", contact.force, state.reactions[2],
    )  # fmt: skip


def cases() -> list[Case]:
    rods = {"straight": WHISKER.rod(), "bent at rest": WHISKER.rod([[0.0, 8.0], [LENGTH, 24.0]])}
    found = []
    for name, rod in rods.items():
        for place in PLACES:
            states = pushed(rod, place)
            found += [case(name, place, part, rod, states) for part in PARTS_OF_WAY]
    return found


def noisy(truth: list[Case], noise: float) -> tuple[list[Case], list[Array]]:
    """The case of each frame, and the frames; one of each case without noise."""
    rng = np.random.default_rng([SEED, round(1e6 * noise)])
    repeats = REPEATS if noise > 0.0 else 1
    of_frame = [one for one in truth for _ in range(repeats)]
    return of_frame, [one.points + rng.normal(0.0, noise * LENGTH, one.points.shape) for one in of_frame]


# What (b) and (c) have in common


def radius(s: float) -> float:
    return 0.5 * (WHISKER.base_diameter + (WHISKER.tip_diameter - WHISKER.base_diameter) * s / LENGTH)


def stiffness(s: float) -> float:
    return WHISKER.youngs_modulus * math.pi / 4.0 * radius(s) ** 4


def chord_length(points: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])


def polynomials(points: Array, q: Array, part: npt.NDArray[np.bool_]) -> Array:
    """Coefficients, highest power first, of x and y, of degree 2 in q, of a part of the points."""
    return np.polyfit(q[part], points[part], 2).T


def derivative(fit: Array, q: float, order: int = 1) -> Array:
    return np.array([float(np.polyval(np.polyder(one, order), q)) for one in fit])


def angle_of(vector: Array) -> float:
    return math.atan2(vector[1], vector[0])


def base(points: Array) -> tuple[Array, float]:
    """Base and its angle as the points near it have them."""
    q = chord_length(points)
    fit = polynomials(points, q, q <= BASE_PART * LENGTH)
    return fit[:, -1], angle_of(derivative(fit, 0.0))


def cross(a: Array, b: Array) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


# (b)


def curvature(points: Array) -> tuple[float, Array]:
    """Curvature at the place near the base, and the point there."""
    q = chord_length(points)
    fit = polynomials(points, q, q <= CURVATURE_PART * LENGTH)
    place = CURVATURE_PLACE * LENGTH
    first = derivative(fit, place)
    return cross(first, derivative(fit, place, 2)) / float(np.hypot(*first)) ** 3, np.array([np.polyval(one, place) for one in fit])


def normal_at(points: Array, contact: Array) -> Array:
    """Normal, to the left, where the polynomials of the points around the contact are nearest to it."""
    q = chord_length(points)
    nearest = q[np.argmin(np.hypot(*(points - contact).T))]
    fit = polynomials(points, q, abs(q - nearest) <= CONTACT_PART * LENGTH)
    fine = nearest + LENGTH / POINTS * np.linspace(-1.0, 1.0, 201)
    along = np.column_stack([np.polyval(one, fine) for one in fit])
    x, y = derivative(fit, fine[np.argmin(np.hypot(*(along - contact).T))])
    return np.array([-y, x]) / math.hypot(x, y)


def by_curvature(points: Array, contact: Array, curvature_at_rest: float) -> tuple[float, float]:
    """Force and moment m0z by (b)."""
    kappa, at = curvature(points)
    moment = stiffness(CURVATURE_PLACE * LENGTH) * (kappa - curvature_at_rest)
    normal = normal_at(points, contact)
    force = moment / cross(contact - at, normal)
    return abs(force), -force * cross(contact - base(points)[0], normal)


# (c)


@dataclass(frozen=True)
class Chain:
    """Links of one length of a rod at rest, in the axes of its base."""

    link: float
    turns: list[float]
    stiffness: list[float]
    first: float

    @staticmethod
    def of(rod: vibrissa.Rod) -> Chain:
        shape = rest_shape(rod, LINKS + 1)[:, :2]
        angles = np.arctan2(*np.diff(shape, axis=0).T[::-1])
        at = np.linspace(0.0, LENGTH, LINKS + 1)
        return Chain(LENGTH / LINKS, np.diff(angles).tolist(), [stiffness(s) for s in at], float(angles[0]))

    def bent(self, force: float, s: float) -> tuple[float, float, float]:
        """End of the chain, in the axes of the base, and the angle of its last link, for a force at the arc length s."""
        s = min(max(s, 1.5 * self.link), LINKS * self.link)
        whole = min(int(s / self.link), LINKS - 1)
        length = s - whole * self.link
        # from the contact, in the origin, to the base; the last link is along x, the force along y
        x, y, phi = -length, 0.0, 0.0
        for joint in range(whole, 0, -1):
            phi += x * force / self.stiffness[joint] * self.link - self.turns[joint - 1]
            x -= self.link * math.cos(phi)
            y -= self.link * math.sin(phi)
        turn = self.first - phi
        cos, sin = math.cos(turn), math.sin(turn)
        return -(cos * x - sin * y), -(sin * x + cos * y), turn

    def guess(self, rest: Array, end: Array) -> tuple[float, float]:
        """Force and arc length from which the search starts, as in the code."""
        distance, reach = float(np.hypot(*end)), np.hypot(*rest.T)
        nearest = int(np.argmin(abs(reach - distance)))
        deflection = float(np.hypot(*(rest[nearest] - end)))
        force = -3.0 * self.stiffness[0] * deflection * (reach[-1] - distance) / (reach[-1] * distance**3)
        return float(force), LENGTH * nearest / (len(rest) - 1)


def by_chain(chain: Chain, rest: Array, origin: Array, angle: float, contact: Array) -> tuple[float, float, float]:
    """Force and moment m0z by (c), and the distance that is left, m."""
    cos, sin = math.cos(angle), math.sin(angle)
    end = np.array([[cos, sin], [-sin, cos]]) @ (contact - origin)
    force, s = chain.guess(rest, end)

    def distance(q: Array) -> float:
        x, y, _ = chain.bent(force * q[0], s * q[1])
        return math.hypot(x - end[0], y - end[1])

    found = minimize(distance, [1.0, 1.0], method="Nelder-Mead", options={"xatol": 1e-12, "fatol": 1e-12, "maxfev": 2000})
    x, y, last = chain.bent(force * found.x[0], s * found.x[1])
    normal = np.array([-math.sin(last), math.cos(last)])
    applied = force * found.x[0]
    return abs(applied), -applied * cross(np.array([x, y]), normal), float(found.fun)


# The tables


def all_curvatures(of_frame: list[Case], frames: list[Array]) -> Estimates:
    found = Estimates()
    at_rest = {one.whisker: curvature(one.rest)[0] for one in of_frame}
    start = time.perf_counter()
    for one, points in zip(of_frame, frames, strict=True):
        force, moment = by_curvature(points, one.contact, at_rest[one.whisker])
        found.force.append(force)
        found.moment.append(moment)
    found.seconds = (time.perf_counter() - start) / len(frames)
    return found


def all_chains(of_frame: list[Case], frames: list[Array], given: bool) -> tuple[Estimates, float]:
    """Also the share of frames in which the search ends more than 1e-6 L beside the contact."""
    found, beside = Estimates(), 0
    chains = {one.whisker: Chain.of(one.rod) for one in of_frame}
    start = time.perf_counter()
    for one, points in zip(of_frame, frames, strict=True):
        origin, angle = (one.pose[:2], float(one.pose[2])) if given else base(points)
        force, moment, left = by_chain(chains[one.whisker], one.rest, origin, angle, one.contact)
        found.force.append(force)
        found.moment.append(moment)
        beside += left > 1e-6 * LENGTH
    found.seconds = (time.perf_counter() - start) / len(frames)
    return found, beside / len(frames)


def given_base(of_frame: list[Case]) -> dict[str, Array]:
    """The pose of the base as channels of (a)."""
    channels = dict(zip(("x0", "y0", "phi0"), np.array([one.pose for one in of_frame]).T, strict=True))
    exact = {"x0": 1e-9 * LENGTH, "y0": 1e-9 * LENGTH, "phi0": 1e-9}
    return channels | {f"sigma_{name}": np.full(len(of_frame), sigma) for name, sigma in exact.items()}


def all_forces(of_frame: list[Case], frames: list[Array], given: bool) -> tuple[npt.NDArray[np.void], float]:
    """The table of (a), one call for each whisker, and seconds per frame."""
    tables = []
    start = time.perf_counter()
    for whisker in dict.fromkeys(one.whisker for one in of_frame):
        own = [(one, points) for one, points in zip(of_frame, frames, strict=True) if one.whisker == whisker]
        film, channels = [points for _, points in own], given_base([one for one, _ in own]) if given else None
        tables.append(vibrissa.forces(own[0][0].rod, film, channels=channels).frames)
    return np.concatenate(tables), (time.perf_counter() - start) / len(frames)


def percent(values: Array) -> str:
    """Median and 90 % quantile; where there is no number the error is infinite."""
    values = np.where(np.isnan(values), np.inf, values)
    return " | ".join(f"{100.0 * value:.2g}" for value in np.quantile(values, [0.5, 0.9], method="higher"))


def row(name: str, noise: float, of_frame: list[Case], force: Array, moment: Array, seconds: float) -> str:
    true_force, true_moment = (np.array([getattr(one, which) for one in of_frame]) for which in ("force", "moment"))
    errors = percent(abs(force / true_force - 1.0)), percent(abs(moment / true_moment - 1.0))
    return f"| {name} | {noise:g} | {errors[0]} | {errors[1]} | {1e3 * seconds:.2g} |"


def by_way(name: str, noise: float, of_frame: list[Case], force: Array) -> str:
    """Median and 90 % quantile of the error of force at each part of the way."""
    errors = abs(force / np.array([one.force for one in of_frame]) - 1.0)
    parts = np.array([one.part_of_way for one in of_frame])
    return f"| {name} | {noise:g} | {' | '.join(percent(errors[parts == part]) for part in PARTS_OF_WAY)} |"


def within(of_frame: list[Case], table: npt.NDArray[np.void]) -> str:
    """Shares of errors within 1, 2, 3 standard deviations of arc length, force and moment, where the verdict is determined."""
    determined = table["verdict"] == "determined"
    cells = []
    for column, which in (("s", "s"), ("force", "force"), ("m0z", "moment")):
        true = np.array([getattr(one, which) for one in of_frame])
        error, sigma = abs(table[column] - true)[determined], table[f"sigma_{column}"][determined]
        cells.append(" / ".join(f"{100.0 * np.mean(error <= n * sigma):.0f}" for n in (1, 2, 3)))
    return " | ".join(cells)


def verdict_row(name: str, noise: float, of_frame: list[Case], table: npt.NDArray[np.void]) -> str:
    names, counts = np.unique(table["verdict"], return_counts=True)
    others = ", ".join(f"{verdict} {100.0 * n / len(table):.3g}" for verdict, n in zip(names, counts, strict=True) if verdict != "determined")
    place = percent(abs(table["s"] - np.array([one.s for one in of_frame])) / LENGTH)
    coverage = within(of_frame, table) if noise > 0.0 else "- | - | -"
    return f"| {name} | {noise:g} | {100.0 * np.mean(table['verdict'] == 'determined'):.3g} | {others or '-'} | {place} | {coverage} |"


def cone() -> str:
    """A full cone bent by a small force, against the closed form of its deflection."""
    length, at, base_radius, modulus = 16e-3, 5e-3, 33.5e-6, 5e9
    rod = vibrissa.Rod(length, diameter=2.0 * base_radius, tip_diameter=0.02 * base_radius, youngs_modulus=modulus)
    small = 1e-6
    peg = vibrissa.CircularArc((at, small), small, 0.0, 2.0 * math.pi)
    scan = vibrissa.sweep(rod, peg, vibrissa.ClampPath((0.0, -small, 0.0), (0.0, small, 0.0)), 0.5 * small)
    state = scan.state(len(scan) - 1)
    (contact,) = state.contacts

    def deflection(whole: float) -> float:
        return 4.0 * contact.force * whole * contact.s**3 / (3.0 * math.pi * modulus * base_radius**4 * (whole - contact.s))

    true = state.pose[1] - contact.y
    full, cut = (true / deflection(whole) - 1.0 for whole in (length, length / 0.99))
    return (
        f"Cone of 16 mm, base radius 33.5 um, E = 5 GPa, force of {1e9 * contact.force:.4g} nN at {1e3 * contact.s:.6g} mm: deflection "
        f"{1e6 * true:.6g} um. 4 F L a^3 / (3 pi E r^4 (L - a)) differs by {full:+.3g} with L = 16 mm, the full cone, and by {cut:+.1e} with "
        "L = 16 mm / 0.99, the length at which the cone with a tip of 1/100 of the base would have a sharp tip."
    )


def main() -> None:
    truth = cases()
    print("| whisker | place at first touch | part of way | contact at s / L | force uN | m0z uN m |\n|---|---|---|---|---|---|")
    for one in truth:
        kind = " (tip)" if one.tip else ""
        reactions = f"{1e6 * one.force:.3g} | {1e6 * one.moment:.3g}"
        print(f"| {one.whisker} | {one.place:g} | {one.part_of_way:g} | {one.s / LENGTH:.3f}{kind} | {reactions} |")
    print("\n| way | noise / L | error of force, %: median | 90 % | error of moment, %: median | 90 % | ms a frame |\n|---|---|---|---|---|---|---|")
    parts: list[str] = []
    verdicts: list[str] = []
    besides: list[str] = []

    def add(name: str, noise: float, of_frame: list[Case], force: npt.ArrayLike, moment: npt.ArrayLike, seconds: float) -> None:
        print(row(name, noise, of_frame, np.asarray(force), np.asarray(moment), seconds))
        parts.append(by_way(name, noise, of_frame, np.asarray(force)))

    for noise in NOISES:
        of_frame, frames = noisy(truth, noise)
        for given, name in ((False, "(a) forces"), (True, "(a) forces, base given")):
            table, seconds = all_forces(of_frame, frames, given)
            verdicts.append(verdict_row(name, noise, of_frame, table))
            add(name, noise, of_frame, table["force"], table["m0z"], seconds)
        found = all_curvatures(of_frame, frames)
        add("(b) curvature", noise, of_frame, found.force, found.moment, found.seconds)
        for given, name in ((False, "(c) chain"), (True, "(c) chain, base given")):
            if given and noise > 0.0:
                continue
            found, beside = all_chains(of_frame, frames, given)
            add(name, noise, of_frame, found.force, found.moment, found.seconds)
            besides.append(f"{100.0 * beside:.2g}")
    print(f"\nFrames in which the search of (c) ends more than 1e-6 L beside the contact, %, row by row: {', '.join(besides)}.")
    heads = " | ".join(f"{100.0 * part:g} % of way: median | 90 %" for part in PARTS_OF_WAY)
    print(f"\nError of force, %:\n\n| way | noise / L | {heads} |\n|{'---|' * (2 + 2 * len(PARTS_OF_WAY))}")
    print("\n".join(parts))
    print("\n| way | noise / L | determined, % | other verdicts, % | error of place, % of L: median | 90 % | s within 1 / 2 / 3 sigma, % | force | m0z |")
    print("|---|---|---|---|---|---|---|---|---|")
    print("\n".join(verdicts))
    print(f"\n{cone()}")


if __name__ == "__main__":
    main()
