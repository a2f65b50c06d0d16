"""Reads the same files with lvm_read or pandas and with the example table_json, and compares all cells."""

import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

import lvm_read
import pandas

READER, DIRECTORY = sys.argv[1], pathlib.Path(sys.argv[2])


def ours(file):
    return json.loads(subprocess.run([READER, str(file)], check=True, capture_output=True, text=True).stdout)


def number(cell):
    return cell if isinstance(cell, (int, float)) else math.nan


def same(a, b):
    return a == b or math.isnan(a) and math.isnan(b)


def without_other_letters(name):
    # lvm_read leaves out bytes that are not UTF-8
    return name.encode("ascii", errors="ignore").decode()


def compare_lvm(file):
    """lvm_read has the columns from the second on where there is no column of x, and no names for those of x."""
    theirs = lvm_read.read(str(file), read_from_pickle=False, dump_file=False)
    tables = ours(file)
    assert len(tables) == theirs["Segments"], f"{file}: {len(tables)} segments, {theirs['Segments']} by lvm_read"
    cells = 0
    for k, table in enumerate(tables):
        segment = theirs[k]
        skip = 1 if theirs.get("X_Columns", "One") == "No" else 0
        rows, expected = table["rows"], segment["data"]
        assert len(rows) == len(expected), f"{file}: {len(rows)} rows, {len(expected)} by lvm_read"
        assert not table["faults"], f"{file}: {table['faults']}"
        names = [column["name"] for column in table["columns"]][skip:]
        for name, other in zip(names, segment["Channel names"]):
            name, other = without_other_letters(name), without_other_letters(other)
            heading = name.split(" of ")[0] if name.startswith("X_Value") else name
            assert other.startswith(heading), f"{file}: {name}, {other} by lvm_read"
        for i, (row, other) in enumerate(zip(rows, expected)):
            for name, value, wanted in zip(names, row[skip:], other):
                assert same(number(value), wanted), f"{file}: row {i}, {name}: {value}, {wanted} by lvm_read"
                cells += 1
        for row, comment in zip(rows, segment.get("comments", [])):
            assert (row[-1] or "") == comment, f"{file}: {row[-1]}, {comment} by lvm_read"
        if skip:
            start, step = segment["X0"][0], segment["Delta_X"][0]
            assert all(row[0] == start + i * step for i, row in enumerate(rows)), f"{file}: x"
    print(f"{file.name}: {cells} cells are those of lvm_read")


def written_lvm(directory, rng):
    """Files of all shapes: separators, decimal marks, columns of x, segments, comments."""
    for separator, mark in (("Tab", "."), ("Tab", ","), ("Comma", ".")):
        for x_columns in ("No", "One", "Multi"):
            s = "\t" if separator == "Tab" else ","
            n, rows, text = 3, 50, lambda value: repr(value).replace(".", mark)
            lines = [f"LabVIEW Measurement{s}", f"Writer_Version{s}2", f"Separator{s}{separator}"]
            lines += [f"Decimal_Separator{s}{mark}", f"X_Columns{s}{x_columns}", f"***End_of_Header***{s}", s]
            pad = lambda cells: s.join(f"{cell}{s}" if x_columns == "Multi" else cell for cell in cells)
            for _ in range(2):
                tail = "" if x_columns == "Multi" else s
                width = 2 * n if x_columns == "Multi" else n + 1
                lines += [f"Channels{s}{n}" + s * (width - 1), f"Y_Unit_Label{s}" + pad(["N", "mN", "V"]) + tail]
                lines += [f"X0{s}" + pad([text(0.5)] * n) + tail, f"Delta_X{s}" + pad([text(1e-3)] * n) + tail]
                lines += ["***End_of_Header***" + s * width]
                names = [f"Force {i}" for i in range(n)]
                head = s.join(f"X_Value{s}{name}" for name in names) if x_columns == "Multi" else f"X_Value{s}" + s.join(names)
                lines += [head + f"{s}Comment"]
                for k in range(rows):
                    x, values = text(0.5 + 1e-3 * k), [text(rng.gauss(0, 10 ** rng.randint(-8, 8))) for _ in range(n)]
                    if k % 7 == 3:
                        values[1] = ""
                    if x_columns == "Multi":
                        row = s.join(f"{x}{s}{value}" for value in values)
                    else:
                        row = ("" if x_columns == "No" else x) + s + s.join(values)
                    lines += [row + (f"{s}LOST" if k % 11 == 5 else "")]
                lines += [""]
            file = directory / f"{separator}_{'comma' if mark == ',' else 'point'}_{x_columns}.lvm"
            file.write_text("\n".join(lines) + "\n")
            yield file


def compare_text(directory, rng):
    """Tables of numbers with gaps, whatever separates cells and fractions."""
    for delimiter, mark in ((",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ","), (" ", "."), (" ", ",")):
        for end, first in (("\n", ""), ("\r\n", "\ufeff")):
            values = [[rng.gauss(0, 10 ** rng.randint(-9, 9)) for _ in range(5)] for _ in range(200)]
            text = [[repr(value).replace(".", mark) for value in row] for row in values]
            if delimiter != " ":
                for row in text[::13]:
                    row[rng.randrange(5)] = rng.choice(["", "NaN", "N/A"])
            lines = [delimiter.join(["t", "Fx", "Fy", "Fz", "Mz"])] + [delimiter.join(row) for row in text]
            file = directory / "table.csv"
            file.write_bytes((first + end.join(lines) + end).encode())
            theirs = pandas.read_csv(file, sep=delimiter, decimal=mark, encoding="utf-8-sig")
            (table,) = ours(file)
            assert [column["name"] for column in table["columns"]] == list(theirs.columns)
            assert not table["faults"] and len(table["rows"]) == len(theirs)
            for row, other in zip(table["rows"], theirs.values.tolist()):
                assert all(same(number(a), b) for a, b in zip(row, other)), f"{row}, {other} by pandas"
            print(f"{delimiter!r} with {mark!r} and {end!r}: {theirs.size} cells are those of pandas")


with tempfile.TemporaryDirectory() as scratch:
    scratch, rng = pathlib.Path(scratch), random.Random(1)
    for file in written_lvm(scratch, rng):
        compare_lvm(file)
    files = sorted(DIRECTORY.glob("*.lvm"))
    for file in files:
        compare_lvm(file)
    if not files:
        print(f"no .lvm files in {DIRECTORY}: only files written here were compared")
    compare_text(scratch, rng)
