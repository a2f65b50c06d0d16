"""Other people's solvers on the problems of the reference set: rows of time and error.

    benches/peers/speed/run

makes an environment of its own and measures vibrissa in the same run. Here: peers.py PROBLEMS ELLIP TABLE [--only TASK ...],
with the folder of the reference problems, the program of ellip/, and the table to write.
"""

import argparse
import csv
import math
import subprocess
import sys
import time
from pathlib import Path

from scipy.integrate import solve_ivp

import cable
import cosserat
import floor
import problems
from bvp import Collocation
from scan import Lost, Scan
from shooting import Shooting

COLUMNS = ("task", "problem", "method", "setting", "error", "seconds", "note")
PHASES = {"A": "a-parabola", "B": "b-parabola", "BA": "ba-two-parabolas", "BB": "bb-two-parabolas"}
TOLERANCES = [10.0**-digits for digits in range(3, 14)]
MOVED = 1e-3  # how far the clamp is moved for a warm start
# Of a scan: its poses, at steps of 0.01 and 0.001, and its tolerances.
SCANS = {171: [1e-4, 1e-6, 1e-8, 1e-10, 1e-12], 1701: [1e-6, 1e-8]}
ELEMENTS = 10, 20, 40, 80
# A point is repeated until this has passed, seconds, and at least so often.
BUDGET, LEAST = 0.4, 3


def setting(tol):
    return f"1e-{round(-math.log10(tol))}"


def least(act, budget=BUDGET, times=LEAST):
    """Least time of several repetitions, seconds, of what was done before; of one where that is longer than the budget."""
    best, spent, done = math.inf, 0.0, 0
    while spent < budget or (done < times and best < budget):
        start = time.perf_counter()
        act()
        took = time.perf_counter() - start
        best, spent, done = min(best, took), spent + took, done + 1
    return best


def segments(folder):
    """solve_ivp on single segments; the time of one of them."""

    def rates(_, y, a, b):
        c, s = math.cos(y[2]), math.sin(y[2])
        return c, s, y[3], a * c + b * s

    of = problems.segments(folder)
    for tol in TOLERANCES:

        def end(segment):
            span = (0.0, segment.length)
            return solve_ivp(rates, span, segment.start, method="DOP853", rtol=tol, atol=tol, args=segment.force).y[:, -1]

        errors = sorted(segment.error(end(segment)) for segment in of)
        seconds = least(lambda: [end(segment) for segment in of]) / len(of)
        for which, error in (("median", errors[len(of) // 2]), ("worst", errors[-1])):
            yield "segment", f"{which} of {len(of)}", "scipy solve_ivp (DOP853)", setting(tol), error, seconds, ""


def solves(folder, solvers):
    """Boundary-value problems, warm and cold."""
    for phase, name in PHASES.items():
        problem = problems.read(folder, name)
        rough, given_up = problems.rough(problem), set()
        for solver in solvers:
            if solver.name in given_up:
                continue
            for task, guesses in ((f"{phase} warm", starts(problem, solver, rough)), (f"{phase} cold", [rough])):
                row = solve(problem, solver, task, guesses)
                if row[4] is None:  # nor will it at tighter tolerances, after a long time
                    given_up.add(solver.name)
                yield row


def starts(problem, solver, rough):
    """Solutions of the same solver with the clamp moved."""
    at = solver.solve(problem.contacts, problem.clamp, rough) or solver.solve(problem.contacts, problem.clamp, problem.solution)
    return [at and solver.solve(problem.contacts, clamp, at) for clamp in problem.moved(MOVED)]


def solve(problem, solver, task, guesses):
    """One problem from some guesses: the worst error, the mean time."""

    def act():
        return [guess and solver.solve(problem.contacts, problem.clamp, guess) for guess in guesses]

    head = (task, problem.name, solver.name, setting(solver.tol))
    found = act()
    if None in found:
        return *head, None, None, "no convergence"
    error = max(problem.error(one.results()) for one in found)
    return *head, error, least(act) / len(guesses), found[0].note()


def scans(folder, makers):
    """The scan past O1 at q = 0.4, as far as the solver goes."""
    for make in makers:
        for poses, tolerances in SCANS.items():
            for tol in tolerances:
                solver = make(tol)
                head = ("scan", "O1, q = 0.4", solver.name, f"{setting(tol)}, {poses} poses")
                try:
                    scan = Scan(solver).run(poses)
                    error = scan.error(folder)
                except Lost as lost:
                    yield *head, None, None, f"lost {lost}"
                    break
                seconds = least(lambda: Scan(solver).run(poses))
                yield *head, error, seconds, f"{scan.poses} in contact, {len(scan.events)} events"


def floors(solvers):
    """The tip on a floor, by programs for dynamics, run to rest, and by scipy from a rough guess."""
    problem = floor.problem()
    for solver in solvers:
        yield solve(problem, solver, "static contact", [problems.rough(problem)])
    for centred in (False, True):
        clamped = "clamp amid the first element" if centred else "clamp at its end"
        for elements in ELEMENTS:
            model = cable.prepare(elements, centred)
            yield rest(problem, "MuJoCo cable", elements, centred, clamped, lambda: cable.run(model))
            yield rest(problem, "PyElastica", elements, centred, clamped, lambda: cosserat.run(elements, centred))


def rest(problem, method, elements, centred, clamped, run):
    head = ("static contact", problem.name, method, f"{elements}{' centred' if centred else ''}")
    try:
        found, steps = run()
    except RuntimeError as error:
        return *head, None, None, str(error)
    return *head, problem.error(found), least(run), f"{steps} steps, {clamped}"


def legendre(program, folder):
    """What the program in ellip/ prints."""
    out = subprocess.run([program, folder], check=True, capture_output=True, text=True).stdout
    for *head, error, seconds, remark in csv.reader(out.splitlines()):
        yield *head, float(error), float(seconds), remark


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("problems", type=Path)
    parser.add_argument("ellip")
    parser.add_argument("table", type=Path)
    parser.add_argument("--only", nargs="+", default=["ellip", "segment", "solve", "static", "scan"])
    parser.add_argument("--differences", action="store_true", help="solve_bvp without analytic Jacobians")
    arguments = parser.parse_args()
    folder = arguments.problems

    def collocation(tol):
        return Collocation(tol, not arguments.differences)

    makers = (collocation, Shooting)
    solvers = [make(tol) for make in makers for tol in TOLERANCES]
    tasks = {
        "ellip": lambda: legendre(arguments.ellip, folder),
        "segment": lambda: segments(folder),
        "solve": lambda: solves(folder, solvers),
        "static": lambda: floors(solvers),
        "scan": lambda: scans(folder, makers),
    }
    with arguments.table.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(COLUMNS)
        for task in arguments.only:
            for *head, error, seconds, remark in tasks[task]():
                numbers = ["" if value is None else f"{value:.4e}" for value in (error, seconds)]
                table.writerow([*head, *numbers, remark])
                file.flush()
                print(*head, *numbers, remark, sep=" | ", file=sys.stderr)


if __name__ == "__main__":
    main()
