"""The scan past O1 at q = 0.4 by a solver of boundary-value problems: two parabolas, the clamp moves to -x, seven events.

Poses at equal steps, every one solved from the one before. Between two poses the contacts may change: what must stay positive
(forces, what is left of the rod behind a contact, the angle at the tip, the gap to the parabola that is not touched) is looked
at, and the clamp's position at its zero found by brentq, each value a solve. The scan ends at the fold, where no equilibrium
is near: there x0 is minimised along the equilibria of given angle at the tip.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from problems import Contact, Parabola, Unknowns, transition

Y0, PHI0, START, END = -0.4, math.pi / 2, 0.8, -0.9
OBJECT = (Parabola((0.0, 0.0), 5.0), Parabola((0.3, 0.0), 5.0))
# Phases that are entered, and where the reference set has it.
EVENTS = (
    ("A", "o1-q40-1-first-contact"),
    ("B", "o1-q40-2-a-to-b"),
    ("BB", "o1-q40-3-b-to-bb"),
    ("BA", "o1-q40-4-bb-to-ba"),
    ("B", "o1-q40-5-ba-to-b"),
    ("A", "o1-q40-6-b-to-a"),
    ("free", "o1-q40-7-snap-off"),
)
SAMPLES = np.linspace(0.0, 1.0, 101)


@dataclass
class Event:
    x0: float
    to: str


class Lost(Exception):
    """No solution, and no event that explains it."""


def smallest_gap(at, support):
    """The smallest gap between a rod and a support, and where along the rod."""
    x, y, _, _ = at(SAMPLES)
    gaps = support.gap(x, y)
    i = int(np.argmin(gaps))
    # A minimum between samples h apart is at most rate' h^2 / 8 below them: far ones need no look.
    if 0 < i < len(SAMPLES) - 1 and gaps[i] < 0.01:

        def rate(s):
            ((x,), (y,), (phi,), _) = at(s)
            return support.gap_rate(x, y, phi)

        low, high = SAMPLES[i - 1], SAMPLES[i + 1]
        if rate(low) < 0 < rate(high):
            s = brentq(rate, low, high, xtol=1e-9)
            ((x,), (y,), _, _) = at(s)
            return float(support.gap(x, y)), s
    return float(gaps[i]), float(SAMPLES[i])


def _phase(contacts):
    return "".join("A" if contact.tip else "B" for contact in contacts) or "free"


class Scan:
    def __init__(self, solver):
        self.solver = solver
        self.events = []
        self.poses = 0

    def at(self, contacts, x0, guess):
        """The equilibrium at x0, from one nearby, which must be so near that it is the same branch."""
        found = self.solver.solve(contacts, (x0, Y0, PHI0), guess)
        if found is None:
            return None
        known = guess.unknowns
        far = max(abs(u - v) for u, v in zip((*found.unknowns.t, found.unknowns.phi1), (*known.t, known.phi1)))
        return None if far > 0.3 else found

    def watched(self, found):
        """What must stay positive, with what happens where it does not."""
        contacts, known = found.contacts, found.unknowns
        watched = []
        for j, contact in enumerate(contacts):
            if len(contacts) > 1:
                watched.append((("release", j), known.f[j]))
            if contact.tip:
                alpha = contact.support.frame(known.t[j]).alpha
                watched.append((("tangent", j), math.sin(known.phi1 - alpha)))
            elif j + 1 == len(contacts):
                watched.append((("end", j), 1.0 - known.s[j]))
        at = found.shape()
        touched = [contact.support for contact in contacts]
        for support in OBJECT:
            if support not in touched:
                watched.append((("touch", support), smallest_gap(at, support)[0]))
        return watched

    def changed(self, found, event):
        """The equilibrium at an event, with the contacts behind it."""
        what, where = event
        contacts, known = list(found.contacts), found.unknowns
        t, f, s, phi1 = list(known.t), list(known.f), list(known.s), known.phi1
        if what == "release":
            for of in (contacts, t, f, s):
                del of[where]
        elif what == "end":
            contacts[where] = replace(contacts[where], tip=True)
            s[where] = 1.0
        elif what == "tangent":
            alpha = contacts[where].support.frame(t[where]).alpha
            contacts[where] = Contact(contacts[where].support, False, math.pi * round((phi1 - alpha) / math.pi))
        else:
            at = found.shape()
            _, along = smallest_gap(at, where)
            ((x,), (y,), (phi,), _) = at(along)
            j = int(np.searchsorted(s, along))
            touch = where.parameter(x, y, phi)
            contacts.insert(j, Contact(where, False, math.pi * round((phi - where.frame(touch).alpha) / math.pi)))
            t.insert(j, touch)
            f.insert(j, 0.0)
            s.insert(j, along)
        contacts, unknowns = tuple(contacts), Unknowns(tuple(t), tuple(f), tuple(s), phi1)
        return self.restart(contacts, found, unknowns)

    def restart(self, contacts, found, unknowns):
        """The same rod as the start of a phase with other contacts."""
        again = self.solver.solve(contacts, found.clamp, unknowns, shape=found.shape())
        if again is None:
            raise Lost(f"behind the event at {found.clamp[0]}")
        return again

    def locate(self, before, x1, index):
        """The position between an equilibrium and x1 at which the watched value of this index vanishes."""
        nearest = [before]

        def value(x0):
            found = self.at(before.contacts, x0, nearest[0])
            if found is None:
                raise Lost(f"at {x0}")
            nearest[0] = found
            return self.watched(found)[index][1]

        x0 = brentq(value, before.clamp[0], x1, xtol=max(0.01 * self.solver.tol, 1e-14), rtol=1e-14)
        return x0, self.at(before.contacts, x0, nearest[0])

    def first_contact(self):
        """Of the straight rod's tip, moving to -x, with the right-hand parabola."""
        contact = Contact(OBJECT[1], True)
        tip = Y0 + 1.0
        x0 = brentq(lambda x: OBJECT[1].gap(x, tip), START, OBJECT[1].vertex[0], xtol=1e-14, rtol=1e-14)
        unknowns = Unknowns((x0 - OBJECT[1].vertex[0],), (0.0,), (1.0,), PHI0)
        found = self.solver.solve((contact,), (x0, Y0, PHI0), unknowns)
        if found is None:
            raise Lost("at the first contact")
        self.events.append(Event(x0, "A"))
        return found

    def fold(self, before):
        """Where x0 turns round, along the equilibria of given phi1."""
        if not before.contacts[-1].tip:
            raise Lost(f"behind {before.clamp[0]} in phase {_phase(before.contacts)}")

        def along(phi1, guess):
            found = self.solver.solve(before.contacts, before.clamp, guess, fixed=phi1)
            if found is None:
                raise Lost(f"on the way to the fold, phi1 = {phi1}")
            return found

        # To the side on which x0 falls, until it rises.
        step = 1e-4
        ahead = along(before.unknowns.phi1 + step, before)
        step = 0.01 if ahead.clamp[0] < before.clamp[0] else -0.01
        walk = [before]
        while len(walk) < 3 or walk[-1].clamp[0] < walk[-2].clamp[0]:
            walk.append(along(walk[-1].unknowns.phi1 + step, walk[-1]))
        nearest = [walk[-2]]

        def position(phi1):
            nearest[0] = along(phi1, nearest[0])
            return nearest[0].clamp[0]

        ends = sorted((walk[-3].unknowns.phi1, walk[-1].unknowns.phi1))
        # The minimum is flat: its value is far better than its place.
        return minimize_scalar(position, bounds=ends, method="bounded", options={"xatol": 1e-7}).fun

    def run(self, poses):
        xs = np.linspace(START, END, poses)
        found = self.first_contact()
        for x1 in xs[xs < found.clamp[0]]:
            while True:
                after = self.at(found.contacts, x1, found)
                if after is None:
                    x0 = self.fold(found)
                    if x0 < x1:
                        raise Lost(f"at {x1}, before the fold")
                    self.events.append(Event(x0, "free"))
                    return self
                crossed = [i for i, (_, value) in enumerate(self.watched(after)) if value < 0]
                if not crossed:
                    break
                where = [self.locate(found, x1, i) for i in crossed]
                i, (x0, at) = max(zip(crossed, where), key=lambda each: each[1][0])
                found = self.changed(at, self.watched(at)[i][0])
                self.events.append(Event(x0, _phase(found.contacts)))
            found = after
            self.poses += 1
        raise Lost("at the end of the path without a fold")

    def error(self, folder):
        """The largest error of the events' positions, relative to 1 + |x0|."""
        if [event.to for event in self.events] != [to for to, _ in EVENTS]:
            raise Lost(f"phases {[event.to for event in self.events]}")
        truth = [transition(folder, name) for _, name in EVENTS]
        return max(abs(event.x0 - true) / (1 + abs(true)) for event, true in zip(self.events, truth))
