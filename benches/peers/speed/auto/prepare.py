"""Folders in which AUTO-07p runs, one for each branch and setting.

    prepare.py PROBLEMS FOLDER

The start is a transition of the reference set. A folder has AUTO's executable `run`, `fort.2` (constants), `start.dat`, and
`states.txt`: of each state x0, t, f and length of the segment of each contact, and the curvature at the clamp, with all digits.
"""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

HERE = Path(__file__).parent
LIBRARY = Path("/usr/lib/auto-07p/lib")
# constants, start, states
BRANCHES = {"b": ("o1-q40-2-a-to-b", 880), "bb": ("o1-q40-3-b-to-bb", 315)}
# collocation points of a mesh interval: mesh intervals (AUTO crashes with two), tolerance of solutions and parameters
SETTINGS = {
    4: [(3, 1e-4), (4, 1e-5), (5, 1e-6), (7, 1e-7), (10, 1e-8), (15, 1e-9), (20, 1e-10)],
    7: [(3, 1e-6), (4, 1e-8), (5, 1e-9), (7, 1e-10)],
}


def compiled(folder, name, *options):
    """AUTO's library with the equations, as its own makefile links them."""
    program = folder / name
    objects = sorted(str(path) for path in LIBRARY.glob("*.o"))
    command = ["gfortran", "-O3", "-march=native", "-cpp", "-fopenmp", *options, str(HERE / "rod.f90"), *objects, "-o", str(program)]
    subprocess.run(command, check=True, cwd=folder)
    return program


def start(problem):
    """Parameters and mesh values of a transition, by integration from the clamp."""
    clamp, motion, tau = problem["clamp"], problem["motion"], float(problem["tau"])
    x0 = clamp["x"] + tau * motion["x"]
    par, contacts = [x0], problem["contacts"]
    behind = 0.0
    for contact in contacts:
        vertex = problem["supports"][contact["support"]]["vertex"]
        s = float(contact["s"])
        par += [float(contact["x"]) - vertex[0], float(contact["force"]), s - behind]
        behind = s
    ahead = [(float(c["force"]), float(c["alpha"])) for c in contacts]
    state = np.array([x0, clamp["y"], clamp["phi"], -float(problem["reactions"]["m0z"])])
    mesh, columns = np.linspace(0, 1, 201), []
    for j in range(len(contacts)):
        length = par[3 * j + 3]
        a, b = (sum(f * g(alpha) for f, alpha in ahead[j:]) for g in (np.cos, np.sin))

        def rates(_, u):
            c, s = np.cos(u[2]), np.sin(u[2])
            return length * np.array([c, s, u[3], a * c + b * s])

        solved = solve_ivp(rates, (0, 1), state, method="DOP853", rtol=1e-13, atol=1e-13, t_eval=mesh).y
        columns.append(solved)
        state = solved[:, -1]
    return par, np.vstack([mesh, *columns]).T


def constants(branch, par, ncol, ntst, eps, states):
    own = {"NTST": ntst, "NCOL": ncol, "NMX": states, "EPSL": eps, "EPSU": eps, "EPSS": eps * 100, "dat": "'start'"}
    lines = [(HERE / f"c.{branch}").read_text(), ", ".join(f"{key} = {value}" for key, value in own.items())]
    lines.append("PAR = {" + ", ".join(f"{i + 1}: {value!r}" for i, value in enumerate(par)) + "}")
    return "\n".join(lines) + "\n"


def main():
    problems, root = Path(sys.argv[1]), Path(sys.argv[2])
    shutil.rmtree(root, ignore_errors=True)
    root.mkdir(parents=True)
    root = root.resolve()
    quiet, telling = compiled(root, "auto-rod"), compiled(root, "auto-rod-tells", "-DTELL")
    for branch, (name, states) in BRANCHES.items():
        par, mesh = start(json.loads((problems / f"{name}.json").read_text()))
        for ncol, ntst, eps in ((ncol, *setting) for ncol, settings in SETTINGS.items() for setting in settings):
            folder = root / f"{branch}-{ncol}-{ntst}"
            folder.mkdir()
            (folder / "fort.2").write_text(constants(branch, par, ncol, ntst, eps, states))
            np.savetxt(folder / "start.dat", mesh, fmt="%.17e")
            subprocess.run([telling], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            # AUTO asks for the values of a state twice
            lines = (folder / "fort.21").read_text().splitlines()[::2]
            (folder / "states.txt").write_text("\n".join(lines) + "\n")
            (folder / "fort.21").unlink()
            (folder / "run").symlink_to(quiet)
            print(f"{folder.name}: {len(lines)} states", file=sys.stderr)


if __name__ == "__main__":
    main()
