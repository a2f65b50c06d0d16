"""Kinks of recordings by ruptures, a library for change points, beside those that vibrissa found in the same recordings.

    benches/peers/kinks/run

makes an environment of its own and the recordings, and prints a table. Here: kinks.py DIRECTORY [--levels ...], with the
recordings that `noise_study --write DIRECTORY` wrote.

ruptures is told the true number of kinks. Its model of continuous lines takes the samples at the kinks as they are, with
their noise, and its cost is computed anew for every segment, so that it wants means instead of samples: means of as many
samples as give 5, 10 and 25 a second, each channel divided by its standard deviation over the recording (dividing by its
range or its noise, longer segments at least, or its cost of lines without continuity changed nothing). Scores are those of
vibrissa (`rod_reconstruct::compare::KinkScore`): one to one within 1 mm, nearest pairs first; what is found at a
transition that hardly shows is neither right nor wrong.
"""

import argparse
import json
import time
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import ruptures
from ruptures.exceptions import BadSegmentationParameters

MARGIN = 1e-3  # m
RATE = 500  # samples a second
RATES = [5, 10, 25]  # means a second
# Dynamic programming takes its work from the square of the number of places: every `jump` means only, at the first rate only.
SEARCHES = {
    "BottomUp": lambda means: ruptures.BottomUp(model="clinear", min_size=3, jump=1),
    "Binseg": lambda means: ruptures.Binseg(model="clinear", min_size=3, jump=1),
    "Dynp": lambda means: ruptures.Dynp(model="clinear", min_size=3, jump=max(1, round(means / 425))),
}


def match(found, truth):
    """Pairs (true, found), nearest first, each at most once."""
    pairs = sorted((abs(t - f), t, f) for t in truth for f in found if abs(t - f) <= MARGIN)
    matched, seen_true, seen_found = [], set(), set()
    for _, t, f in pairs:
        if t not in seen_true and f not in seen_found:
            matched.append((t, f))
            seen_true.add(t)
            seen_found.add(f)
    return matched


def score(found, truth, faint):
    """Number right, number false, errors of position (m)."""
    right = match(found, truth)
    rest = set(found) - {f for _, f in right}
    passed = {f for _, f in match(sorted(rest), faint)}
    return len(right), len(rest - passed), [abs(t - f) for t, f in right]


def means(recording, rate):
    """Way of the clamp (m) and reactions, averaged."""
    table = np.loadtxt(recording, delimiter=",", skiprows=1)
    size = RATE // rate
    table = table[: len(table) // size * size].reshape(-1, size, table.shape[1]).mean(axis=1)
    way = np.hypot(table[:, 1] - table[0, 1], table[:, 2] - table[0, 2]) + 0.5 * (size - 1) * 2e-6
    return way, table[:, 4:7] / table[:, 4:7].std(axis=0)


def run(job):
    """One recording, all searches at all rates."""
    directory, entry, rates, searches = job
    truth = entry["truth"]
    rows = [(("vibrissa", RATE), score(entry["found"], truth, entry["faint"]), len(truth), 0.0)]
    for rate in rates:
        way, signal = means(Path(directory) / entry["file"], rate)
        for name in searches:
            if name == "Dynp" and rate != rates[0]:
                continue
            start = time.perf_counter()
            try:
                ends = SEARCHES[name](len(way)).fit(signal).predict(n_bkps=len(truth))
            except BadSegmentationParameters as error:
                print(f"{entry['file']}: {name} at {rate} Hz: {error or 'no such segmentation'}")
                ends = [len(way)]
            took = time.perf_counter() - start
            # a break is the first mean behind it; the line ends at the mean before
            found = [float(way[end - 1]) for end in ends[:-1]]
            rows.append(((name, rate), score(found, truth, entry["faint"]), len(truth), took))
    return (entry["level"], entry["noise"]), rows


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("directory")
    parser.add_argument("--rates", type=int, nargs="+", default=RATES)
    parser.add_argument("--searches", nargs="+", default=list(SEARCHES), choices=list(SEARCHES))
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()
    entries = json.loads((Path(arguments.directory) / "kinks.json").read_text())
    jobs = [(arguments.directory, entry, arguments.rates, arguments.searches) for entry in entries]
    sums = defaultdict(lambda: [0, 0, 0, 0, [], 0.0])
    with ProcessPoolExecutor(arguments.workers) as pool:
        for noise, rows in pool.map(run, jobs):
            for search, (right, false, errors), truth, took in rows:
                total = sums[(*noise, *search)]
                total[0] += 1
                total[1] += right
                total[2] += truth
                total[3] += false
                total[4] += errors
                total[5] += took
    print("| noise | search | means a second | recordings | kinks found | precision | false a scan | kink error | time a scan |")
    print("|---|---|---|---|---|---|---|---|---|")
    for (level, noise, search, rate), (scans, right, truth, false, errors, took) in sums.items():
        precision = f"{100 * right / (right + false):.1f} %" if right + false else "-"
        error = f"{1e3 * float(np.median(errors)):.2g}" if errors else "-"
        seconds = "-" if search == "vibrissa" else f"{took / scans:.2g} s"
        print(
            f"| {level}, {noise} | {search} | {rate} | {scans} | {100 * right / truth:.1f} % ({right} of {truth}) | "
            f"{precision} | {false / scans:.2f} | {error} | {seconds} |"
        )


if __name__ == "__main__":
    main()
