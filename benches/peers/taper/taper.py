"""A cone to a fifth of its diameter on a parabola, with its tip (A) or its side (B): solvers that users have against vibrissa.

    benches/peers/taper/run

Each solves from the equilibrium at a clamp that is 0.001 L away. The truth are the 30 digits of the reference set; the error is the largest of
reactions and contact point, relative to 1 + |value|. Lengths in L, forces in E I / L^2 at the clamp.
"""

import json
import math
import sys
import time
from pathlib import Path

import numpy as np
from scipy.integrate import solve_bvp, solve_ivp
from scipy.optimize import fsolve

import vibrissa
from mujoco_cable import Cable

MOVED = 1e-3
# A point is repeated until this has passed, seconds, and at least so often.
BUDGET, LEAST = 0.4, 3
DIAMETER = 0.01


class Problem:
    def __init__(self, file):
        entry = json.loads(file.read_text())
        (contact,) = entry["contacts"]
        support = entry["supports"][contact["support"]]
        self.taper, self.tip = entry["rod"]["taper"], contact["hold"] == "tip"
        self.vertex, self.coefficient = support["vertex"], support["coefficient"]
        self.clamp = tuple(entry["clamp"][key] for key in ("x", "y", "phi"))
        t = float(contact["x"]) - self.vertex[0]
        s = [] if self.tip else [float(contact["s"])]
        self.unknowns = np.array([t, float(contact["force"]), *s])
        reactions = [float(entry["reactions"][key]) for key in ("f0x", "f0y", "m0z")]
        self.truth = np.array(reactions + [float(contact["x"]), float(contact["y"])])

    def frame(self, t):
        slope = 2.0 * self.coefficient * t
        return self.vertex[0] + t, self.vertex[1] + self.coefficient * t * t, math.atan(slope)

    def stiffness(self, s):
        return (1.0 - self.taper * s) ** 4

    def force(self, p):
        """A, B and the contact."""
        x, y, alpha = self.frame(p[0])
        return p[1] * math.cos(alpha), p[1] * math.sin(alpha), x, y, alpha

    def length(self, p):
        return 1.0 if self.tip else p[2]

    def moment(self, p, x, y):
        a, b, at_x, at_y, _ = self.force(p)
        return a * (x - at_x) + b * (y - at_y)

    def missed(self, p, x, y, phi):
        """How far the rod's end is from the contact."""
        *_, at_x, at_y, alpha = self.force(p)
        off = [x - at_x, y - at_y]
        return off if self.tip else [*off, phi - alpha - math.pi * round((phi - alpha) / math.pi)]

    def results(self, p):
        a, b, x, y, _ = self.force(p)
        return np.array([-b, a, -self.moment(p, *self.clamp[:2]), x, y])

    def error(self, results):
        return float(np.max(np.abs(results - self.truth) / (1.0 + np.abs(self.truth))))


class Collocation:
    """scipy.integrate.solve_bvp, without Jacobians, as its users call it."""

    name = "scipy solve_bvp"
    settings = [1e-3, 1e-5, 1e-7, 1e-9, 1e-11]

    def solve(self, problem, clamp, start, tol):
        def rates(s, y, p):
            a, b, *_ = problem.force(p)
            length, (_, _, phi, moment) = problem.length(p), y
            cos, sin = np.cos(phi), np.sin(phi)
            return length * np.array([cos, sin, moment / problem.stiffness(length * s), a * cos + b * sin])

        def ends(at_clamp, at_end, p):
            x, y, phi, moment = at_end
            return np.array([*(at_clamp[:3] - clamp), *problem.missed(p, x, y, phi), moment])

        mesh, values, p = start
        found = solve_bvp(rates, ends, mesh, values, p, tol=tol, max_nodes=20_000)
        return (found.x, found.y, found.p) if found.success else None

    def first(self, problem, tol):
        mesh = np.linspace(0.0, 1.0, 11)
        *_, x, y, _ = problem.force(problem.unknowns)
        x0, y0, phi0 = problem.clamp
        values = np.array([x0 + mesh * (x - x0), y0 + mesh * (y - y0), phi0 + 0.0 * mesh, 0.0 * mesh])
        return mesh, values, problem.unknowns

    def results(self, problem, solution):
        return problem.results(solution[2])


class Shooting:
    """solve_ivp from the clamp, and fsolve for force, place and arc length of the contact."""

    name = "scipy solve_ivp (DOP853) + fsolve"
    settings = [1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13]

    def solve(self, problem, clamp, start, tol):
        def end(p):
            a, b, *_ = problem.force(p)

            def rates(s, y):
                cos, sin = math.cos(y[2]), math.sin(y[2])
                return cos, sin, y[3] / problem.stiffness(s), a * cos + b * sin

            first = [*clamp, problem.moment(p, *clamp[:2])]
            return solve_ivp(rates, (0.0, problem.length(p)), first, method="DOP853", rtol=tol, atol=tol).y[:3, -1]

        found, _, flag, _ = fsolve(lambda p: problem.missed(p, *end(p)), start, xtol=max(tol, 1e-14), full_output=True)
        return found if flag == 1 or tol < 1e-10 else None

    def first(self, problem, _):
        return problem.unknowns

    def results(self, problem, solution):
        return problem.results(solution)


class Nodes(Shooting):
    """Links that turn at their nodes by moment over stiffness, as Elastica2D marches; fsolve for the contact."""

    name = "marching over nodes + fsolve"
    settings = [25, 50, 100, 200, 400, 800, 1600]

    def solve(self, problem, clamp, start, nodes):
        def end(p):
            a, b, at_x, at_y, _ = problem.force(p)
            x, y, phi = clamp
            link = problem.length(p) / nodes
            for k in range(nodes):
                phi += link * (a * (x - at_x) + b * (y - at_y)) / problem.stiffness((k + 0.5) * link)
                x += link * math.cos(phi)
                y += link * math.sin(phi)
            return x, y, phi

        found, _, flag, _ = fsolve(lambda p: problem.missed(p, *end(p)), start, full_output=True)
        return found if flag == 1 else None


class Vibrissa:
    """The equilibrium from Python, whose crossing is part of the time."""

    name = "vibrissa, from Python"
    settings = [None]

    def made(self, problem):
        modulus = 64.0 / (math.pi * DIAMETER**4)
        rod = vibrissa.Rod(1.0, diameter=DIAMETER, tip_diameter=DIAMETER * (1.0 - problem.taper), youngs_modulus=modulus)
        return rod, vibrissa.Parabola(problem.vertex, problem.coefficient)

    def solve(self, problem, clamp, start, _):
        rod, shape, contacts = start
        found = vibrissa.equilibrium(rod, shape, clamp, contacts)
        return (rod, shape, found.state.contacts, found.state) if found.solved else None

    def first(self, problem, _):
        rod, shape = self.made(problem)
        a, b, x, y, alpha = problem.force(problem.unknowns)
        kind = "tip" if problem.tip else "tangent"
        s = problem.length(problem.unknowns)
        contact = vibrissa.Contact(kind, s=s, x=x, y=y, alpha=alpha, force=float(problem.unknowns[1]))
        return rod, shape, [contact]

    def results(self, problem, solution):
        state = solution[3]
        (contact,) = state.contacts
        return np.array([*state.reactions, contact.x, contact.y])


def least(act):
    """Least time of several repetitions, seconds."""
    best, spent, done = math.inf, 0.0, 0
    while spent < BUDGET or done < LEAST:
        start = time.perf_counter()
        act()
        took = time.perf_counter() - start
        best, spent, done = min(best, took), spent + took, done + 1
    return best


def main():
    folder = Path(sys.argv[1])
    print("| phase | method | setting | error | ms | times vibrissa |\n|---|---|---|---|---|---|")
    for phase, name in (("A", "cone-a-parabola"), ("B", "cone-b-parabola")):
        problem, ours = Problem(folder / f"{name}.json"), None
        x, y, phi = problem.clamp
        for solver in (Vibrissa(), Collocation(), Shooting(), Nodes(), Cable()):
            for setting in solver.settings:
                beside = solver.solve(problem, (x + MOVED, y, phi), solver.first(problem, setting), setting)
                start = beside[:3] if isinstance(beside, tuple) else beside
                found = None if beside is None else solver.solve(problem, problem.clamp, start, setting)
                told = "" if setting is None else f"{setting:g}"
                if found is None:
                    print(f"| {phase} | {solver.name} | {told} | no solution | | |")
                    continue
                seconds = least(lambda: solver.solve(problem, problem.clamp, start, setting))
                ours = seconds if ours is None else ours
                error = problem.error(solver.results(problem, found))
                print(f"| {phase} | {solver.name} | {told} | {error:.1e} | {1e3 * seconds:.3g} | {seconds / ours:.3g} |")


if __name__ == "__main__":
    main()
