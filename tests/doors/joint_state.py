"""Messages `sensor_msgs/msg/JointState` in CDR, also ones that lie about their lengths."""

import math
import struct

KIND = "sensor_msgs/msg/JointState"
LITTLE_ENDIAN = b"\0\1\0\0"


class Cdr:
    """The encoding of ROS 2: numbers stand at multiples of their size."""

    def __init__(self):
        self.bytes = bytearray()

    def pad(self, size):
        self.bytes += bytes(-len(self.bytes) % size)

    def integer(self, number):
        self.pad(4)
        self.bytes += struct.pack("<I", number & 0xFFFFFFFF)

    def text(self, text, length=None):
        data = text if isinstance(text, bytes) else text.encode()
        self.integer(len(data) + 1 if length is None else length)
        self.bytes += data + b"\0"

    def doubles(self, numbers, length=None):
        self.integer(len(numbers) if length is None else length)
        if numbers:
            self.pad(8)
            self.bytes += struct.pack(f"<{len(numbers)}d", *numbers)


def message(
    t, names=("joint1", "joint2"), q=None, qd=None, tau=None, sec=None, nanosec=None, mark=LITTLE_ENDIAN, lengths=None
):
    """A message at time `t`. `lengths` says what the lengths of names, text, q, qd and tau are said to be."""
    lengths = lengths or {}
    cdr = Cdr()
    cdr.integer(int(t // 1) if sec is None else sec)
    cdr.integer(round(t % 1 * 1e9) if nanosec is None else nanosec)
    cdr.text("")
    cdr.integer(lengths.get("names", len(names)))
    for name in names:
        cdr.text(name, lengths.get("text"))
    joints = range(len(names))
    cdr.doubles([math.sin(t + i) for i in joints] if q is None else q, lengths.get("q"))
    cdr.doubles([math.cos(t + i) for i in joints] if qd is None else qd, lengths.get("qd"))
    cdr.doubles([5 + math.sin(2 * t) for _ in joints] if tau is None else tau, lengths.get("tau"))
    return mark + bytes(cdr.bytes)


def motion(count=400, dt=0.01, **more):
    """Times and messages of a motion."""
    return [(i * dt, message(i * dt, **more)) for i in range(count)]


def each(make, count=400):
    """Times and messages, made from number and time: 100 a second."""
    return [(i * 0.01, make(i, i * 0.01)) for i in range(count)]


def crowd(count=70, joints=20_000, asked=()):
    """Few messages of many joints, each message with other names."""
    return each(
        lambda i, t: message(
            t, [*asked, *(f"j{k}_{i}" for k in range(joints))], q=[0.0] * (joints + len(asked)), qd=[], tau=[]
        ),
        count,
    )
