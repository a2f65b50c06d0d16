"""Writes MCAP files with Python, has a program read them that prints JSON, and compares with what went in.

usage: compare.py PROGRAM CORPUS, or compare.py vectors FOLDER

Messages of ROS 2 are serialized by mcap-ros2-support and, in both byte orders, by rosbags: two implementations of CDR.
"""

import json
import math
import pathlib
import subprocess
import sys

import numpy as np
from mcap.writer import CompressionType, Writer
from mcap_ros1.writer import Writer as Ros1Writer
from mcap_ros2.writer import Writer as Ros2Writer
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_HUMBLE)
STORE1 = get_typestore(Stores.ROS1_NOETIC)
START = 1_700_000_000_000_000_000

SEPARATOR = "\n" + "=" * 80 + "\nMSG: "
VECTOR = "geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z"
HEADER = "std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id" + SEPARATOR + "builtin_interfaces/Time\nint32 sec\nuint32 nanosec"
TYPES = {
    "geometry_msgs/msg/WrenchStamped": "std_msgs/Header header\ngeometry_msgs/Wrench wrench" + SEPARATOR + HEADER + SEPARATOR + "geometry_msgs/Wrench\ngeometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque" + SEPARATOR + VECTOR,
    "geometry_msgs/msg/PoseStamped": "std_msgs/Header header\ngeometry_msgs/Pose pose" + SEPARATOR + HEADER + SEPARATOR + "geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation" + SEPARATOR + "geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z" + SEPARATOR + "geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w",
    "sensor_msgs/msg/JointState": "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort" + SEPARATOR + HEADER,
}
WRENCH, POSE, JOINTS = TYPES
TOPICS = {WRENCH: "/ft_sensor/wrench", POSE: "/stage", JOINTS: "/joints"}


def header(log_time, frame, seq=None):
    """One microsecond before the log; every third without a time."""
    stamp = 0 if log_time // 1_000_000 % 3 == 2 else log_time - 1000
    time = {"sec": stamp // 10**9, ("nanosec" if seq is None else "nsec"): stamp % 10**9}
    return {"stamp": time, "frame_id": frame, **({} if seq is None else {"seq": seq})}


def messages(count):
    """Type, log time, header's frame and the numbers or lists of each message."""
    random = np.random.default_rng(2)
    for i in range(count):
        # names of all lengths, as these move what follows
        frame = "tool0_frame"[: i % 12]
        yield WRENCH, START + i * 1_000_000, frame, [0.1, -0.2, 0.3, 0.0, 0.0, 0.0125] if i == 0 else random.normal(size=6).tolist()
        angle = 0.1 * i
        yield POSE, START + i * 1_000_000 + 1_001_000, frame + "/base", [0.08 + i, -0.04, 0.0, 0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2)]
        yield JOINTS, START + i * 1_000_000 + 500, frame, [["x", "yaw_joint"][: i % 3], random.normal(size=i % 3).tolist(), [0.5] * (i % 2), []]


def fields(kind, head, values):
    """As mcap-ros2-support takes it."""
    xyz = lambda v: dict(zip("xyz", v))
    if kind == WRENCH:
        return {"header": head, "wrench": {"force": xyz(values[:3]), "torque": xyz(values[3:])}}
    if kind == POSE:
        return {"header": head, "pose": {"position": xyz(values[:3]), "orientation": dict(zip("xyzw", values[3:]))}}
    return {"header": head, **dict(zip(("name", "position", "velocity", "effort"), values))}


def instance(store, kind, value):
    """The same as an object of rosbags."""
    if not isinstance(value, dict):
        return np.array(value, dtype=float) if isinstance(value, list) and not any(isinstance(v, str) for v in value) else value
    members = {name: subtype for name, subtype in store.fielddefs[kind][1]}
    converted = {}
    for name, member in value.items():
        node, args = members[name]
        converted[name] = instance(store, args, member) if int(node) == 2 else list(member) if name == "name" else instance(store, None, member)
    return store.types[kind](**converted)


def ros2(path, count, **options):
    with open(path, "wb") as file, Ros2Writer(file, **options) as writer:
        schemas = {kind: writer.register_msgdef(kind, text) for kind, text in TYPES.items()}
        for kind, log_time, frame, values in messages(count):
            writer.write_message(TOPICS[kind], schemas[kind], fields(kind, header(log_time, frame), values), log_time=log_time)


def raw(path, count, serialize, encoding, name=lambda kind: kind, seq=None, **options):
    """Messages that something else serializes."""
    with open(path, "wb") as file:
        writer = Writer(file, **options)
        writer.start()
        channels = {}
        for kind in TYPES:
            schema = writer.register_schema(name(kind), "ros2msg", TYPES[kind].encode())
            channels[kind] = writer.register_channel(topic=TOPICS[kind], message_encoding=encoding, schema_id=schema)
        for kind, log_time, frame, values in messages(count):
            data = bytes(serialize(kind, fields(kind, header(log_time, frame, seq), values)))
            writer.add_message(channel_id=channels[kind], log_time=log_time, publish_time=log_time, data=data)
        writer.finish()


def by_rosbags(is_little):
    return lambda kind, value: STORE.serialize_cdr(instance(STORE, kind, value), kind, little_endian=is_little)


def ros1_by_rosbags(kind, value):
    value["header"]["stamp"]["nanosec"] = value["header"]["stamp"].pop("nsec")
    return STORE1.serialize_ros1(instance(STORE1, kind, value), kind)


def write_vectors(folder):
    """The files of the tests in Rust."""
    plain = {"compression": CompressionType.NONE}
    ros2(folder / "wrench.mcap", 2, **plain)
    raw(folder / "big_endian.mcap", 2, by_rosbags(False), "cdr", **plain)
    raw(folder / "ros1.mcap", 2, ros1_by_rosbags, "ros1", lambda kind: kind.replace("/msg/", "/"), seq=7, **plain)
    ros2(folder / "zstd.mcap", 2, compression=CompressionType.ZSTD)


def write_corpus(folder):
    for compression in CompressionType:
        for size in (1000, 1 << 20):
            ros2(folder / f"ros2_{compression.name.lower()}_{size}.mcap", 60, compression=compression, chunk_size=size)
    raw(folder / "little.mcap", 60, by_rosbags(True), "cdr")
    raw(folder / "big.mcap", 60, by_rosbags(False), "cdr")
    raw(folder / "no_chunks.mcap", 60, by_rosbags(True), "cdr", use_chunking=False)
    raw(folder / "ros1.mcap", 60, ros1_by_rosbags, "ros1", lambda kind: kind.replace("/msg/", "/"), seq=7)
    for name in ("ros2_none_1000", "ros2_none_1048576", "ros2_lz4_1000", "ros2_zstd_1000", "ros2_zstd_1048576", "no_chunks"):
        whole = (folder / f"{name}.mcap").read_bytes()
        for share in (0.3, 0.6):
            (folder / f"{name}_cut_{int(10 * share)}.mcap").write_bytes(whole[: int(len(whole) * share)])


def compare(program, path):
    """Differences, how many messages were compared, what the program says is missing."""
    ours = json.loads(subprocess.run([program, path], check=True, capture_output=True).stdout)
    is_cut = "_cut_" in path.name
    differences, count = [], 0
    for kind, topic in [(WRENCH, TOPICS[WRENCH])]:
        expected = [entry for entry in messages(60) if entry[0] == kind]
        found = ours["topics"].get(topic, [])
        if len(found) != len(expected) and not is_cut:
            differences.append(f"{len(found)} messages of {topic}, not {len(expected)}")
        for mine, (_, log_time, _, values) in zip(found, expected):
            count += 1
            stamp = None if log_time // 1_000_000 % 3 == 2 else (log_time - 1000 - START) / 1e9
            if mine != {"log": (log_time - START) / 1e9, "stamp": stamp, "values": values}:
                differences.append(f"{topic}: {mine}, not {(log_time - START) / 1e9, stamp, values}")
    if is_cut != (ours["fault"] is not None):
        differences.append(f"fault {ours['fault']}")
    return differences, count, ours["fault"]


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    if program == "vectors":
        write_vectors(folder)
        return
    write_corpus(folder)
    bad = 0
    for path in sorted(folder.glob("*.mcap")):
        differences, count, fault = compare(program, path)
        bad += bool(differences)
        print(f"{path.name:30} {path.stat().st_size:6} bytes {count:4} messages, {'the same' if not differences else 'DIFFERENT: ' + differences[0]}")
        if fault:
            print(f"{'':30} {fault}")
    print(f"{bad} files differ")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
