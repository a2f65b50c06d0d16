"""Writes TDMS files with npTDMS, reads each with npTDMS and with a program that prints JSON, and compares.

usage: compare.py PROGRAM CORPUS [FILE ...]
"""

import json
import math
import pathlib
import struct
import subprocess
import sys
import warnings

import numpy as np
from nptdms import ChannelObject, GroupObject, RootObject, TdmsFile, TdmsWriter, types
from nptdms.timestamp import TdmsTimestamp

INTEGERS = [np.int8, np.int16, np.int32, np.int64, np.uint8, np.uint16, np.uint32, np.uint64]


def write_corpus(folder):
    """Files of everything that npTDMS writes, and some of them cut."""
    random = np.random.default_rng(1)
    waveform = {"wf_start_offset": 0.25, "wf_increment": 2e-3, "unit_string": "N", "wf_start_time": np.datetime64("2021-02-28T12:00:00.123456")}

    with TdmsWriter(folder / "types.tdms") as writer:
        channels = []
        for kind in INTEGERS:
            limits = np.iinfo(kind)
            values = np.concatenate([[limits.min, limits.max], random.integers(0, 100, 5)]).astype(kind)
            channels.append(ChannelObject("integers", np.dtype(kind).name, values))
        for kind in (np.float32, np.float64):
            values = np.array([0.0, -0.0, 1e-30, np.inf, -np.inf, np.nan, *random.normal(size=3)], dtype=kind)
            channels.append(ChannelObject("floats", np.dtype(kind).name, values))
        channels.append(ChannelObject("others", "flags", np.array([True, False, True])))
        channels.append(ChannelObject("others", "texts", ["", "kraft", "Kräfte µN", "x" * 300]))
        channels.append(ChannelObject("others", "times", np.array(["1900-01-01", "2021-02-28T12:00:00.123456"], dtype="datetime64[us]")))
        root = RootObject({"name": "all types", "whole": 7, "flag": True, "real": 0.1, "big": types.Uint64(2**64 - 1), "small": types.Int8(-3)})
        writer.write_segment([root, GroupObject("integers", {"gap": math.nan}), *channels])

    with TdmsWriter(folder / "names.tdms") as writer:
        writer.write_segment([ChannelObject("it's a 'group'", "a/b 'c'", np.arange(3.0)), ChannelObject("", "", np.arange(2.0)), GroupObject("empty")])

    names = ["Fx", "Fy", "Mz"]
    with TdmsWriter(folder / "segments.tdms") as writer:
        for length in (100, 100, 37, 1, 250):
            writer.write_segment([ChannelObject("Measured", name, random.normal(size=length), waveform) for name in names])
        writer.write_segment([ChannelObject("Measured", "Fx", random.normal(size=11))])
        writer.write_segment([ChannelObject("Measured", "late", random.integers(-9, 9, 5).astype(np.int16)), ChannelObject("Measured", "Fx", random.normal(size=12))])
        writer.write_segment([GroupObject("Measured", {"operator": "changed later"})])

    with TdmsWriter(folder / "scaled.tdms") as writer:
        counts = random.integers(-(2**15), 2**15, 200).astype(np.int16)
        linear = {"NI_Number_Of_Scales": 1, "NI_Scale[0]_Scale_Type": "Linear", "NI_Scale[0]_Linear_Slope": 3.0519e-4, "NI_Scale[0]_Linear_Y_Intercept": -0.01}
        both = {
            **linear,
            "NI_Number_Of_Scales": 2,
            "NI_Scale[1]_Scale_Type": "Polynomial",
            "NI_Scale[1]_Polynomial_Coefficients_Size": 3,
            **{f"NI_Scale[1]_Polynomial_Coefficients[{i}]": c for i, c in enumerate([0.5, 2.0, -0.125])},
            "NI_Scale[1]_Polynomial_Input_Source": 0,
        }
        added = {
            **both,
            "NI_Number_Of_Scales": 4,
            "NI_Scale[2]_Scale_Type": "Add",
            "NI_Scale[2]_Add_Left_Operand_Input_Source": 0,
            "NI_Scale[2]_Add_Right_Operand_Input_Source": 1,
            "NI_Scale[3]_Scale_Type": "Subtract",
            "NI_Scale[3]_Subtract_Left_Operand_Input_Source": 2,
            "NI_Scale[3]_Subtract_Right_Operand_Input_Source": types.Uint32(0xFFFFFFFF),
        }
        written = {**linear, "NI_Scaling_Status": "scaled"}
        writer.write_segment(
            [GroupObject("inherited", linear)]
            + [ChannelObject("own", name, counts, p) for name, p in [("linear", linear), ("both", both), ("added", added), ("written", written)]]
            + [ChannelObject("inherited", "counts", counts)]
        )

    whole = (folder / "segments.tdms").read_bytes()
    for cut in (40, 500, 1000, 1500, 2222, 3333, 5000, 7000, len(whole) - 1, len(whole) - 30):
        (folder / f"cut_{cut}.tdms").write_bytes(whole[:cut])
    # never finished: the length of the last segment is not filled in
    first = whole.index(b"TDSm", 4)
    (folder / "unfinished.tdms").write_bytes(whole[:12] + b"\xff" * 8 + whole[20 : first - 100])
    # interleaved: the same bytes, another bit in the table of contents
    with TdmsWriter(folder / "contiguous.tdms") as writer:
        for length in (64, 64):
            writer.write_segment([ChannelObject("g", "a", random.normal(size=length)), ChannelObject("g", "b", random.integers(-99, 99, length).astype(np.int16))])
    other = bytearray((folder / "contiguous.tdms").read_bytes())
    at = 0
    while at < len(other):
        other[at + 4] |= 1 << 5
        at += 28 + struct.unpack_from("<Q", other, at + 12)[0]
    (folder / "interleaved.tdms").write_bytes(other)
    (folder / "interleaved_cut.tdms").write_bytes(other[:-7])

    for order, name in (("<", "little"), (">", "big")):
        whole = cards(order, random)
        (folder / f"cards_{name}.tdms").write_bytes(whole)
        (folder / f"cards_{name}_cut.tdms").write_bytes(whole[:-9])
    (folder / "lines.tdms").write_bytes(lines(random))


def described(order, path, header, index, properties):
    """An object of a segment's description."""

    def text(value):
        return struct.pack(order + "I", len(value.encode())) + value.encode()

    parts = [text(path), struct.pack(order + "I", header), index, struct.pack(order + "I", len(properties))]
    for name, value in properties.items():
        kind, packed = (0x20, text(value)) if isinstance(value, str) else (10, struct.pack(order + "d", value)) if isinstance(value, float) else (7, struct.pack(order + "I", value))
        parts += [text(name), struct.pack(order + "I", kind), packed]
    return b"".join(parts)


def daqmx_segment(order, objects, raw):
    """A segment as NI-DAQmx logs it, which npTDMS reads but does not write."""
    description = struct.pack(order + "I", len(objects)) + b"".join(objects)
    contents = 1 << 1 | 1 << 2 | 1 << 3 | 1 << 7 | (1 << 6 if order == ">" else 0)
    return b"TDSm" + struct.pack("<I", contents) + struct.pack(order + "IQQ", 4713, len(description) + len(raw), len(description)) + description + raw


def cards(order, random):
    """Counts of two cards: i16 twice and i32 side by side on one, u16 on the other; two chunks."""
    rows = 10
    widths = struct.pack(order + "III", 2, 8, 2)
    objects = []
    for name, kind, buffer, offset in [("a", 3, 0, 0), ("b", 3, 0, 2), ("c", 5, 0, 4), ("d", 2, 1, 0)]:
        index = struct.pack(order + "IIQI", 0xFFFFFFFF, 1, rows, 1) + struct.pack(order + "IIIII", kind, buffer, offset, 0, 0) + widths
        scale = {"NI_Number_Of_Scales": 2, "NI_Scale[1]_Scale_Type": "Linear", "NI_Scale[1]_Linear_Slope": 3.0519e-4, "NI_Scale[1]_Linear_Y_Intercept": 0.5, "NI_Scale[1]_Linear_Input_Source": 0}
        objects.append(described(order, f"/'cards'/'{name}'", 0x1269, index, {**scale, "wf_increment": 2e-3, "wf_start_offset": 0.0}))
    return daqmx_segment(order, objects, random.bytes(2 * (rows * 8 + rows * 2)))


def lines(random):
    """Lines of a digital port of 16 bits."""
    objects = []
    for line in (0, 3, 7, 8, 15):
        index = struct.pack("<IIQI", 0xFFFFFFFF, 1, 12, 1) + struct.pack("<IIIBI", 0, 0, line, 0, 0) + struct.pack("<II", 1, 2)
        objects.append(described("<", f"/'port'/'line {line}'", 0x126A, index, {"NI_Number_Of_Scales": 1}))
    return daqmx_segment("<", objects, random.bytes(3 * 12 * 2))


def plain(value):
    """A property as the program prints it."""
    if isinstance(value, TdmsTimestamp):
        return [value.seconds, value.second_fractions]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return {"nan": "NaN", "inf": "inf", "-inf": "-inf"}[str(value)]
    return value


def same(ours, theirs, tolerance):
    """Whether numbers are the same, or as near as the order of a sum makes them."""
    ours = np.array([float(value) for value in ours])
    theirs = np.asarray(theirs).astype(float)
    if ours.shape != theirs.shape:
        return False
    equal = (ours == theirs) | (np.isnan(ours) & np.isnan(theirs))
    with np.errstate(invalid="ignore"):
        return bool(np.all(equal | (np.abs(ours - theirs) <= tolerance * np.abs(theirs))))


def compare(program, path):
    """Differences, how many values were compared, and what the program says is missing."""
    ours = json.loads(subprocess.run([program, path], check=True, capture_output=True).stdout)
    try:
        theirs = TdmsFile.read(path, raw_timestamps=True)
    except Exception as error:
        return [f"npTDMS fails: {error!r}"], 0, ours["fault"]
    differences = []
    count = 0

    def check(is_same, what):
        if not is_same:
            differences.append(what)

    def check_properties(found, expected, where):
        check(found == {name: plain(value) for name, value in expected.items()}, f"properties of {where}")

    check_properties(ours["properties"], theirs.properties, "the file")
    groups = {group["name"]: group for group in ours["groups"]}
    check(set(groups) == {group.name for group in theirs.groups()}, "groups")
    for group in theirs.groups():
        mine = groups.get(group.name, {"properties": {}, "channels": []})
        check_properties(mine["properties"], group.properties, group.path)
        channels = {channel["name"]: channel for channel in mine["channels"]}
        check([channel["name"] for channel in mine["channels"]] == [channel.name for channel in group.channels()], f"channels of {group.path}")
        for channel in group.channels():
            if channel.name not in channels:
                continue
            mine = channels[channel.name]
            check_properties(mine["properties"], channel.properties, channel.path)
            check(mine["length"] == len(channel), f"length of {channel.path}: {mine['length']}, not {len(channel)}")
            count += len(channel)
            if len(channel) == 0:
                continue
            if channel.data_type is types.String:
                check(mine["values"] == list(channel[:]), f"texts of {channel.path}")
                continue
            if channel.data_type is types.TimeStamp:
                check(mine["values"] == [[int(t.seconds), int(t.second_fractions)] for t in channel[:]], f"times of {channel.path}")
                continue
            if isinstance(mine["values"], dict):
                differences.append(f"values of {channel.path}: {mine['values']['error']}")
                continue
            check(same(mine["values"], channel[:], 1e-14), f"values of {channel.path}")
            raw = channel.raw_data if not channel.raw_scaler_data else channel.raw_scaler_data[min(channel.raw_scaler_data)]
            check(same(mine["raw"], raw, 0.0), f"raw values of {channel.path}")
            if {"wf_increment", "wf_start_offset"} <= channel.properties.keys() and mine["time"]:
                offset, increment = mine["time"]
                times = offset + increment * np.arange(len(channel))
                check(np.allclose(times, channel.time_track(), rtol=1e-14, atol=1e-12), f"time of {channel.path}")
    return differences, count, ours["fault"]


def main():
    program, corpus, *files = sys.argv[1:]
    folder = pathlib.Path(corpus)
    folder.mkdir(parents=True)
    write_corpus(folder)
    bad = 0
    for path in [*sorted(folder.glob("*.tdms")), *map(pathlib.Path, files)]:
        differences, count, fault = compare(program, path)
        bad += bool(differences)
        print(f"{path.name:24} {count:7} values, {'the same' if not differences else 'DIFFERENT: ' + '; '.join(differences)}")
        if fault:
            print(f"{'':24} {fault}")
    print(f"{bad} files differ")
    sys.exit(bad > 0)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
