"""Has programs that others wrote read our fake sensors, over pseudo-terminals.

    pip install gsv86lib optoforce pyserial
    cargo build -p rod-fake-sensor --features pty --example fake_serial
    python3 hw/peers/framed_serial.py target/debug/examples/fake_serial
"""

import contextlib
import os
import struct
import subprocess
import sys
import time

FRAMES = 500


@contextlib.contextmanager
def fake(program, *arguments):
    process = subprocess.Popen([program, *arguments], stdout=subprocess.PIPE, text=True)
    try:
        yield process.stdout.readline().strip()
    finally:
        process.kill()


def follows(numbers):
    """Each is one more than the last, from 0 again after 999."""
    return all(b == (a + 1) % 1000 for a, b in zip(numbers, numbers[1:]))


def gsv(path):
    """ME-Messsysteme's own library: it stops, asks for floats, zeroes, starts and reads."""
    from gsv86lib import gsv86

    device = gsv86(path, 115200)
    device.setTXmodefloat()
    device.writeDataRate(400.0)
    one = device.ReadValue()
    device.SetZero(2)
    device.ReadMultiple()
    device.StartTransmission()
    time.sleep(FRAMES / 400.0 + 0.3)
    device.StopTransmission()
    # [time, values by channel, overload, error of six axes]
    frames = device.ReadMultiple()
    numbers = [values["channel0"] for _, values, _, _ in frames]
    others = {(values["channel1"], values["channel5"], *flags) for _, values, *flags in frames}
    assert len(numbers) >= FRAMES and follows(numbers), numbers[:5]
    assert others == {(0.0, 5.0, False, False)}, others
    return f"{len(numbers)} frames at 400 Hz; one by itself: {one.getChannel1()}, {one.getChannel2()}, .."


def optoforce(path):
    from optoforce import OptoForce22
    from optoforce.reading import FX_SCALE

    with OptoForce22(path, speed_hz=1000, filter_hz=15) as sensor:
        readings = [sensor.read(only_latest_data=False) for _ in range(FRAMES)]
    good = [reading for reading in readings if reading.valid_checksum]
    assert len(good) == FRAMES and follows([round(reading.Fx / FX_SCALE) for reading in good])
    assert all((b.count - a.count) % 65536 == 1 for a, b in zip(good, good[1:]))
    return f"{len(good)} frames"


def bota(path):
    """The published layout, by struct, with a CRC that is written out bit by bit."""
    import serial

    def x25(data):
        crc = 0xFFFF
        for byte in data:
            crc ^= byte
            for _ in range(8):
                crc = crc >> 1 ^ 0x8408 if crc & 1 else crc >> 1
        return crc ^ 0xFFFF

    with serial.Serial(path, 460800, timeout=1) as port:
        data = port.read(37 * (FRAMES + 1))
    start = next(i for i in range(37) if data[i] == 0xAA and x25(data[i + 1 : i + 35]) == struct.unpack_from("<H", data, i + 35)[0])
    frames = [data[i : i + 37] for i in range(start, len(data) - 36, 37)]
    told = [struct.unpack("<BH6fIfH", frame) for frame in frames]
    assert all(x25(frame[1:35]) == values[-1] for frame, values in zip(frames, told))
    assert len(told) >= FRAMES and follows([values[2] for values in told])
    assert all((b[8] - a[8]) % 2**32 == 1250 for a, b in zip(told, told[1:]))
    return f"{len(told)} frames at 800 Hz"


def robotiq(path):
    """Started by a Modbus request, with its CRC written out, too."""
    import serial

    def modbus(data):
        crc = 0xFFFF
        for byte in data:
            crc ^= byte
            for _ in range(8):
                crc = crc >> 1 ^ 0xA001 if crc & 1 else crc >> 1
        return crc

    with serial.Serial(path, 19200, timeout=1) as port:
        request = bytes.fromhex("0910019A0001020200")
        port.write(request + struct.pack("<H", modbus(request)))
        answer = port.read(8)
        data = port.read(16 * 100)
        port.write(b"\xff" * 50)
    assert modbus(answer) == 0 and modbus(data[:16]) == 0
    told = [struct.unpack("<2s6hH", data[i : i + 16]) for i in range(0, 1600, 16)]
    assert [values[1] for values in told] == [100 * i for i in range(100)]
    return f"{len(told)} frames"


if __name__ == "__main__":
    program = sys.argv[1]
    for name, peer, rate in [("gsv8", gsv, []), ("optoforce", optoforce, []), ("bota", bota, ["800"]), ("robotiq", robotiq, [])]:
        with fake(program, name, *rate) as path:
            print(f"{name}: {peer(path)}", flush=True)
    # the threads of gsv86lib do not end
    os._exit(0)
