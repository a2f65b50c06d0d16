#!/usr/bin/env python3
"""Solves every problem in two ways and writes problems/*.json and the table in README.md.

    make.py             all problems
    make.py NAME...     some problems
    make.py --check     solves all and compares with the files, writes nothing

It fails where the two ways agree on fewer digits than the files claim, or where a file differs.
"""

import json
import sys
from pathlib import Path

import mpmath
from mpmath import log10, mp, nstr

import backward
import condition
import forward
import jacobi
import precision
import problems
import taylor
from problem import CONTACT, REACTIONS, Problem
from precision import written
from supports import exact

FOLDER = Path(__file__).resolve().parent.parent
# Digits that the two ways must agree on, of every number relative to its own size.
CLAIMED = 30
VERSION = f"mpmath {mpmath.__version__}, {precision.WORKING} digits"
END = ("x", "y", "phi", "kappa")
# What of a file may depend on the versions of the tools.
MAKING = ("methods", "agreement")
TABLE = ("<!-- table: make.py -->\n", "<!-- end of table -->\n")


def agreement(first, second):
    """Largest difference of two lists of results, each relative to the result itself."""
    apart = lambda v, w: 0 if max(abs(v), abs(w)) < precision.ZERO else abs(v - w) / max(abs(v), abs(w))
    return max(apart(v, w) for v, w in zip(first, second))


def segment(inputs):
    given = exact(inputs)
    start, force = [given["start"][key] for key in END], [given["force"][key] for key in "ab"]
    ends = [way.advance(start, *force, given["length"]) for way in (taylor, jacobi)]
    results = {"end": dict(zip(END, map(written, ends[0])))}
    return (taylor.NAME, jacobi.NAME), ends, condition.of_segment(inputs), results


def contacts(inputs, starts):
    problem = Problem(inputs, starts)
    shot, back = forward.Forward(problem), backward.Backward(problem)
    found = [shot.solve(), back.solve()]
    held = [{**asked, **dict(zip(CONTACT, map(written, v)))} for asked, v in zip(inputs["contacts"], found[0].contacts)]
    tau = {} if found[0].tau is None else {"tau": written(found[0].tau)}
    results = {**tau, "contacts": held, "reactions": dict(zip(REACTIONS, map(written, found[0].reactions)))}
    how = condition.of_contacts(inputs, starts, back)
    return (forward.NAME, backward.NAME.format(problem.rod.OTHER)), [f.values() for f in found], how, results


def solved(name, about, kind, inputs, starts):
    """The content of a file."""
    methods, found, how, results = segment(inputs) if kind == "segment" else contacts(inputs, starts)
    difference = agreement(*found)
    digits = mp.dps if difference == 0 else int(-log10(difference))
    if digits < CLAIMED:
        raise ArithmeticError(f"{name}: the two ways agree on {digits} digits only")
    made = {"digits": CLAIMED, "methods": [f"{m}; {VERSION}" for m in methods], "agreement": float(nstr(difference, 2))}
    return {"name": name, "about": about, "kind": kind, **made, "condition": float(nstr(how, 4)), **inputs, **results}


def laid_out(problem):
    """JSON with a line for each field, and for each support and contact."""

    def lines(value):
        if isinstance(value, list) and value and isinstance(value[0], dict):
            return "[\n    " + ",\n    ".join(map(json.dumps, value)) + "\n  ]"
        return json.dumps(value)

    return "{\n" + ",\n".join(f"  {json.dumps(key)}: {lines(value)}" for key, value in problem.items()) + "\n}\n"


def table():
    """Of all files, in the order in which they are asked."""
    files = [FOLDER / "problems" / f"{name}.json" for name, *_ in problems.ALL]
    found = [json.loads(file.read_text()) for file in files if file.exists()]
    rows = [f"| [{p['name']}](problems/{p['name']}.json) | {p['about']} | {p['condition']:.2g} | {p['digits']} |" for p in found]
    return "\n".join(["| name | about | condition | digits |", "|---|---|---|---|", *rows]) + "\n"


def same(new, old):
    return {k: v for k, v in new.items() if k not in MAKING} == {k: v for k, v in old.items() if k not in MAKING}


def main(arguments):
    check, names = "--check" in arguments, [a for a in arguments if not a.startswith("--")]
    differing = []
    for asked in problems.ALL:
        if names and asked[0] not in names:
            continue
        result = solved(*asked)
        print(f"{result['name']:32} agreement {result['agreement']:8.1e}  condition {result['condition']:.4g}", flush=True)
        file = FOLDER / "problems" / f"{result['name']}.json"
        if not check:
            file.write_text(laid_out(result))
        elif not same(result, json.loads(file.read_text())):
            differing.append(file.name)
    readme = FOLDER / "README.md"
    before, rest = readme.read_text().split(TABLE[0])
    old, after = rest.split(TABLE[1])
    new = table()
    if not check:
        readme.write_text(before + TABLE[0] + new + TABLE[1] + after)
    elif old != new:
        differing.append(readme.name)
    known = {f"{name}.json" for name, *_ in problems.ALL}
    differing += [file.name for file in (FOLDER / "problems").iterdir() if check and file.name not in known]
    if differing:
        print("different:", ", ".join(differing))
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
