"""Problems of the reference set, as arrays for scipy: supports, contacts, truth, and the guesses that solvers start from.

Signs and symbols are those of the README at the top: kappa' = A cos phi + B sin phi with A = sum f cos alpha, B = sum
f sin alpha over the contacts ahead; f0x = -B, f0y = A, m0z = -kappa(0).
"""

import json
import math
from dataclasses import dataclass

import numpy as np

# Problems that lose more digits than this, changes of results by those of inputs, tell of themselves more than of a method.
MODERATE = 100.0


@dataclass(frozen=True)
class Frame:
    """A point of a support at its parameter t, its tangent angle, and their rates."""

    x: float
    y: float
    alpha: float
    dx: float
    dy: float
    dalpha: float


@dataclass(frozen=True)
class Parabola:
    vertex: tuple
    coefficient: float

    def frame(self, t):
        c = self.coefficient
        slope = 2 * c * t
        return Frame(self.vertex[0] + t, self.vertex[1] + c * t * t, math.atan(slope), 1.0, slope, 2 * c / (1 + slope**2))

    def parameter(self, x, y, alpha):
        return x - self.vertex[0]

    def gap(self, x, y):
        """Positive outside, negative inside; zero where the gap is."""
        return self.vertex[1] + self.coefficient * (x - self.vertex[0]) ** 2 - y

    def gap_rate(self, x, y, phi):
        """Of `gap` along a rod through (x, y) in the direction phi."""
        return 2 * self.coefficient * (x - self.vertex[0]) * np.cos(phi) - np.sin(phi)


@dataclass(frozen=True)
class Circle:
    centre: tuple
    radius: float

    def frame(self, t):
        dx, dy = -self.radius * math.sin(t), self.radius * math.cos(t)
        return Frame(self.centre[0] + dy, self.centre[1] - dx, t + math.pi / 2, dx, dy, 1.0)

    def parameter(self, x, y, alpha):
        return alpha - math.pi / 2


@dataclass(frozen=True)
class Line:
    point: tuple
    angle: float

    def frame(self, t):
        dx, dy = math.cos(self.angle), math.sin(self.angle)
        return Frame(self.point[0] + t * dx, self.point[1] + t * dy, self.angle, dx, dy, 0.0)

    def parameter(self, x, y, alpha):
        return (x - self.point[0]) * math.cos(self.angle) + (y - self.point[1]) * math.sin(self.angle)


@dataclass(frozen=True)
class Vertex:
    point: tuple

    def frame(self, t):
        return Frame(*self.point, t, 0.0, 0.0, 1.0)

    def parameter(self, x, y, alpha):
        return alpha


def support(entry):
    match entry["shape"]:
        case "parabola":
            return Parabola(tuple(entry["vertex"]), entry["coefficient"])
        case "circle":
            return Circle(tuple(entry["centre"]), entry["radius"])
        case "line":
            return Line(tuple(entry["point"]), entry["angle"])
        case "vertex":
            return Vertex(tuple(entry["point"]))
        case other:
            raise ValueError(f"no such shape: {other}")


@dataclass(frozen=True)
class Contact:
    """What is touched and how: phi = alpha + offset where tangential."""

    support: object
    tip: bool
    offset: float = 0.0


@dataclass(frozen=True)
class Unknowns:
    """Of every contact: parameter on its support, force, arc length; and the rod's angle at its end (of a tip contact)."""

    t: tuple
    f: tuple
    s: tuple
    phi1: float


@dataclass(frozen=True)
class Problem:
    name: str
    phase: str
    clamp: tuple  # x, y, phi
    contacts: tuple
    solution: Unknowns  # nearest doubles
    truth: np.ndarray  # f0x, f0y, m0z, then x, y of every contact

    def error(self, found):
        return float(np.max(np.abs(found - self.truth) / (1 + np.abs(self.truth))))

    def moved(self, way):
        """The clamp's poses that far away in eight directions."""
        x, y, phi = self.clamp
        angles = [k * math.tau / 8 for k in range(8)]
        return [(x + way * math.cos(angle), y + way * math.sin(angle), phi) for angle in angles]


def ahead(contacts, t, f):
    """Force sums A, B of every segment, from the clamp to the tip, and the frames."""
    frames = [contact.support.frame(tj) for contact, tj in zip(contacts, t)]
    a = np.cumsum([fj * math.cos(frame.alpha) for fj, frame in zip(f, frames)][::-1])[::-1]
    b = np.cumsum([fj * math.sin(frame.alpha) for fj, frame in zip(f, frames)][::-1])[::-1]
    return a, b, frames


def results(contacts, t, f, kappa0):
    """What is compared: reactions, then positions of contacts."""
    a, b, frames = ahead(contacts, t, f)
    return np.array([-b[0], a[0], -kappa0] + [value for frame in frames for value in (frame.x, frame.y)])


@dataclass
class Solution:
    """What a solver found for contacts and a pose of the clamp."""

    contacts: tuple
    clamp: tuple
    unknowns: Unknowns
    kappa0: float

    def results(self):
        return results(self.contacts, self.unknowns.t, self.unknowns.f, self.kappa0)

    def note(self):
        return ""

    def segments(self):
        """Of each segment x, y, phi, kappa as a function of arc lengths."""
        raise NotImplementedError

    def shape(self):
        """The rod as a function of arc length, an array of x, y, phi, kappa; straight behind the last contact."""
        ends, segments = np.array(self.unknowns.s), self.segments()
        x, y, phi = segments[-1](ends[-1:])[:3, 0]

        def at(s):
            s = np.atleast_1d(s)
            values = np.empty((4, len(s)))
            piece = np.searchsorted(ends, s)
            for j, segment in enumerate(segments):
                here = piece == j
                if here.any():
                    values[:, here] = segment(s[here])
            behind = piece == len(ends)
            way = s[behind] - ends[-1]
            straight = (x + way * math.cos(phi), y + way * math.sin(phi), np.full(len(way), phi), np.zeros(len(way)))
            values[:, behind] = np.array(straight)
            return values

        return at


def rough(problem):
    """A guess for a cold start: contacts to a tenth of their parameter, forces to a power of two, chords for arc lengths."""
    t = tuple(round(tj, 1) for tj in problem.solution.t)
    f = tuple(2.0 ** round(math.log2(abs(fj))) for fj in problem.solution.f)
    at, s, length = problem.clamp[:2], [], 0.0
    for contact, tj in zip(problem.contacts, t):
        frame = contact.support.frame(tj)
        length += math.hypot(frame.x - at[0], frame.y - at[1])
        at = (frame.x, frame.y)
        s.append(1.0 if contact.tip else length)
    behind = problem.clamp[:2]
    if len(t) > 1:
        frame = problem.contacts[-2].support.frame(t[-2])
        behind = (frame.x, frame.y)
    phi1 = math.atan2(at[1] - behind[1], at[0] - behind[0])
    return Unknowns(t, f, tuple(s), phi1)


def read(folder, name):
    """A problem of kind contacts, without notches."""
    entry = json.loads((folder / f"{name}.json").read_text())
    supports = [support(one) for one in entry["supports"]]
    contacts, t, f, s, positions = [], [], [], [], []
    for given in entry["contacts"]:
        x, y, alpha, phi = (float(given[key]) for key in ("x", "y", "alpha", "phi"))
        touched, tip = supports[given["support"]], given["hold"] == "tip"
        t.append(touched.parameter(x, y, alpha))
        f.append(float(given["force"]))
        s.append(float(given["s"]))
        offset = 0.0 if tip else math.pi * round((phi - touched.frame(t[-1]).alpha) / math.pi)
        contacts.append(Contact(touched, tip, offset))
        positions += [x, y]
    reactions = [float(entry["reactions"][key]) for key in ("f0x", "f0y", "m0z")]
    clamp = tuple(entry["clamp"][key] for key in ("x", "y", "phi"))
    phase = "".join("A" if contact.tip else "B" for contact in contacts)
    solution = Unknowns(tuple(t), tuple(f), tuple(s), float(entry["contacts"][-1]["phi"]))
    return Problem(entry["name"], phase, clamp, tuple(contacts), solution, np.array(reactions + positions))


@dataclass(frozen=True)
class Segment:
    start: np.ndarray  # x, y, phi, kappa
    force: tuple  # A, B
    length: float
    end: np.ndarray

    def error(self, found):
        return float(np.max(np.abs(found - self.end) / (1 + np.abs(self.end))))


def segments(folder):
    """All segments of the set that lose two digits at most."""
    entries = [json.loads(path.read_text()) for path in sorted(folder.glob("*.json"))]
    keys = ("x", "y", "phi", "kappa")
    return [
        Segment(
            np.array([entry["start"][key] for key in keys]),
            (entry["force"]["a"], entry["force"]["b"]),
            entry["length"],
            np.array([float(entry["end"][key]) for key in keys]),
        )
        for entry in entries
        if entry["kind"] == "segment" and entry["condition"] <= MODERATE
    ]


def transition(folder, name):
    """Position x0 of the clamp at a transition."""
    entry = json.loads((folder / f"{name}.json").read_text())
    return entry["clamp"]["x"] + float(entry["tau"]) * entry["motion"]["x"]
