"""A problem with contacts as the two ways see it: its inputs as exact numbers, and where to start."""

from dataclasses import dataclass

from mpmath import mp, mpf

import rods
import supports

POSE = ("x", "y", "phi")
CONTACT = ("x", "y", "alpha", "force", "s", "phi")
REACTIONS = ("f0x", "f0y", "m0z")


@dataclass
class Contact:
    """What touches, how (phi = alpha + turns pi where it is tangential), and start values of parameter, force and arc
    length (at the tip: slope angle)."""

    support: dict
    hold: str
    turns: int
    start: tuple

    @property
    def at_tip(self):
        return self.hold != "tangent"


class Problem:
    """Of the fields of a file those that say what is asked, with numbers instead of doubles, and with start values."""

    def __init__(self, inputs, starts, length=mpf(1)):
        inputs = supports.exact(inputs)
        self.length = length
        self.rod = rods.of(inputs.get("rod"))
        self.clamp = [inputs["clamp"][key] for key in POSE]
        self.motion = [inputs["motion"][key] for key in POSE] if "motion" in inputs else None
        self.transition = inputs.get("transition")
        self.tau = mpf(starts["tau"]) if self.motion else None
        self.contacts = []
        for contact, start in zip(inputs["contacts"], starts["contacts"]):
            if contact["hold"] == "notch":
                support = supports.notch(*(inputs["supports"][i] for i in contact["supports"]), near=contact["near"])
            else:
                support = inputs["supports"][contact["support"]]
            self.contacts.append(Contact(support, contact["hold"], contact.get("turns"), start))

    def pose(self, tau):
        return self.clamp if tau is None else [c + tau * m for c, m in zip(self.clamp, self.motion)]

    def at(self, j, t):
        return supports.at(self.contacts[j].support, t)

    def is_given(self, condition, j):
        """Whether it is the condition of the transition that this vanishes (or is at the tip) at contact j."""
        t = self.transition
        same = {"touch": "force"}
        return t is not None and t.get("contact") == j and same.get(t["condition"], t["condition"]) == condition

    @property
    def is_fold(self):
        return self.transition is not None and self.transition["condition"] == "fold"


def reactions_of(pose, found):
    """(f0x, f0y, m0z) by balance of the contact forces: (x, y, alpha, force) of each."""
    f0x = -mp.fsum(f * mp.sin(alpha) for _, _, alpha, f in found)
    f0y = mp.fsum(f * mp.cos(alpha) for _, _, alpha, f in found)
    m0z = mp.fsum(f * ((x - pose[0]) * mp.cos(alpha) + (y - pose[1]) * mp.sin(alpha)) for x, y, alpha, f in found)
    return [f0x, f0y, m0z]


@dataclass
class Found:
    """A solution: the contacts with their (x, y, alpha, force, s, phi), the reactions, and tau where it is asked for."""

    contacts: list
    reactions: list
    tau: mpf = None

    def values(self):
        """All numbers in the order of the files."""
        tau = [] if self.tau is None else [self.tau]
        return tau + [v for contact in self.contacts for v in contact] + list(self.reactions)
