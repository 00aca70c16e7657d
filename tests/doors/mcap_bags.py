"""Bags of ROS 2 in MCAP: records and chunks that lie about lengths, sums and compression."""

import random
import struct
import zlib

import lz4.frame
import zstandard

import harness
from joint_state import KIND, message, motion
from logs import READERS, read_by_all

CASES = harness.Cases()
MAGIC = b"\x89MCAP0\r\n"
LONGEST = (1 << 64) - 1


def text(words):
    data = words if isinstance(words, bytes) else words.encode()
    return struct.pack("<I", len(data)) + data


def record(kind, body, length=None):
    return bytes([kind]) + struct.pack("<Q", len(body) if length is None else length) + body


def schema(number=1, name=KIND):
    return record(3, struct.pack("<H", number) + text(name) + text("ros2msg") + text(b""))


def channel(number=1, schema=1, topic="/joint_states", encoding="cdr"):
    return record(4, struct.pack("<HH", number, schema) + text(topic) + text(encoding) + text(b""))


def stored(time, data, channel=1):
    return record(5, struct.pack("<HIQQ", channel, 0, time, time) + data)


def motion_records(count=400):
    return b"".join(stored(int(t * 1e9), data) for t, data in motion(count))


def chunk(data, compression="", check=None, size=None, packed=None, length=None):
    """A chunk of records; what is given besides is said of it, true or not."""
    pack = {"zstd": zstandard.compress, "lz4": lz4.frame.compress}.get(compression, lambda data: data)
    body = pack(data) if packed is None else packed
    head = struct.pack(
        "<QQQI", 0, 10**9, len(data) if size is None else size, zlib.crc32(data) if check is None else check
    )
    return record(6, head + text(compression) + struct.pack("<Q", len(body) if length is None else length) + body)


HEAD = MAGIC + record(1, text("ros2") + text("x"))
END_OF_DATA = record(15, struct.pack("<I", 0))
END = END_OF_DATA + record(2, struct.pack("<QQI", 0, 0, 0)) + MAGIC
NAMES = schema() + channel()
MOTION = motion_records()
GOOD = HEAD + NAMES + MOTION + END
IDENTIFY = {"identify": READERS["identify"]}


def mcap(name, data, expected="any", says=(), options=(), never=()):
    """A case of the bytes of a bag, or of a function that writes it."""
    CASES.add(
        name,
        lambda trial: read_by_all(trial, "log.mcap", data, expected, says, never, options, readers=IDENTIFY),
    )


def large(make):
    return lambda path: path.write_bytes(make())


# Records.
mcap("good", GOOD, "taken")
mcap("no end", HEAD + NAMES + MOTION)
mcap("cut", GOOD[:-3000], "bad", ["cut off"])
mcap("magic alone", MAGIC, "bad")
mcap("magic and one byte", MAGIC + b"\x01", "bad")
mcap("header of 2^63 bytes", MAGIC + record(1, b"", 1 << 63), "bad")
mcap("header of 2^64-1 bytes", MAGIC + record(1, b"", LONGEST), "bad")
mcap("record of 2 GB", HEAD + record(5, b"", 2 << 30), "bad")
mcap("record of 33 MB", large(lambda: HEAD + NAMES + record(5, bytes(33 << 20))), "bad")
mcap("no header", MAGIC + NAMES + MOTION + END)
mcap("messages before their channel", HEAD + MOTION + NAMES + END, "bad")
mcap("channel before its schema", HEAD + channel() + schema() + MOTION + END)
mcap("schema 0", HEAD + channel(schema=0) + MOTION + END, "bad")
for kind in (0, 200):
    mcap(f"record of kind {kind}", HEAD + record(kind, b"x") + NAMES + MOTION + END)
mcap("text longer than its record", HEAD + record(3, struct.pack("<HI", 1, 0xFFFFFFFF) + b"x") + END, "bad")
mcap("names that are no UTF-8", HEAD + schema(name=b"\xff\xfe") + channel(topic=b"\xff") + END, "bad")
LAST = b"".join(stored(LONGEST, data) for _, data in motion())
mcap("receive time the largest", HEAD + NAMES + LAST + END, options=["--recorded"])
mcap("attachment of 40 MB", large(lambda: HEAD + record(9, bytes(40 << 20)) + NAMES + MOTION + END))
LATER = b"".join(stored(int(9e9) + i, message(9 + i * 0.01)) for i in range(100))
mcap("messages after the end of data", HEAD + NAMES + MOTION + END_OF_DATA + LATER + END)

# Topics and channels.
mcap("no topics", HEAD + END, "bad")
mcap("two topics", HEAD + NAMES + channel(2, 1, "/b") + MOTION + END, "refused", ["--topic"])
mcap("second topic late", HEAD + NAMES + MOTION + channel(2, 1, "/b") + END)
mcap("two channels of one topic", HEAD + NAMES + channel(2) + MOTION + END)
mcap("encoding JSON", HEAD + schema() + channel(encoding="json") + MOTION + END, "bad")
mcap(
    "topic by option", HEAD + NAMES + channel(2, 1, "/b") + MOTION + END, "taken", options=["--topic", "/joint_states"]
)
mcap("topic of codes of colours", HEAD + schema() + channel(topic="\x1b[8mhidden") + MOTION + END)
CHANNELS = b"".join(channel(i & 0xFFFF, 2, f"/t{i}") for i in range(2, 60_000))
mcap("60000 channels", HEAD + schema(2, "x") + CHANNELS + NAMES + MOTION + END)
MANY = b"".join(channel(i, 1, f"/t{i}") for i in range(4000))
mcap("4000 topics of joint states", HEAD + schema() + MANY + END, "refused")
# A number of a channel that is defined anew must not join two topics into one log.
HALF = motion_records(200)
for what, again in {
    "another topic": channel(topic="/other"),
    "another encoding": channel(encoding="json"),
    "another type": schema(2, "x") + channel(schema=2),
}.items():
    mcap(f"channel again, {what}", HEAD + NAMES + HALF + again + HALF + END, never=["400 of 400", "400 messages"])


def two_files_in_one(trial):
    """What follows the end of the first file must not be passed over in silence."""
    one, two = trial.write("one.mcap", GOOD), trial.write("log.mcap", GOOD + GOOD)
    first = trial.rne("log", one, expected="taken")
    second = trial.rne("log", two, names="log.mcap")
    if second.status == 0 and second.said.replace("log.mcap", "one.mcap") == first.said:
        trial.fault("rne log: the second of two files in one is passed over without a word")


CASES.add("two files in one", two_files_in_one)

# Chunks.
WHOLE = NAMES + MOTION
mcap("chunk", HEAD + chunk(WHOLE) + END, "taken")
mcap("chunk of a wrong sum", HEAD + chunk(WHOLE, check=5) + END, "bad")
mcap("chunk without a sum", HEAD + chunk(WHOLE, check=0) + END, "taken")
mcap("chunk of nothing", HEAD + chunk(b"") + WHOLE + END)
mcap("chunk in a chunk", HEAD + chunk(chunk(WHOLE)) + END)
deep = WHOLE
for _ in range(200):
    deep = chunk(deep)
mcap("chunks 200 deep", HEAD + deep + END)
mcap("chunk of too large a size", HEAD + chunk(WHOLE, size=1 << 40) + END)
mcap("chunk of size 0", HEAD + chunk(WHOLE, size=0) + END)
mcap("chunk of too large a length", HEAD + chunk(WHOLE, length=1 << 40) + END, "bad")
mcap("chunk with too long a record", HEAD + chunk(WHOLE + record(5, b"x" * 30, 1 << 62)) + END, "bad")
mcap("chunk that ends inside a record", HEAD + chunk(WHOLE[:-7]) + END, "bad")
mcap("chunk of brotli", HEAD + chunk(NAMES, "brotli") + END, "bad")
mcap("chunk of a code of terminals", HEAD + chunk(NAMES, "\x1b[2J") + END, "bad")
for compression, packer in (("zstd", zstandard.compress), ("lz4", lz4.frame.compress)):
    mcap(f"chunk of {compression}", HEAD + chunk(WHOLE, compression) + END, "taken")
    mcap(f"chunk of {compression}, cut", HEAD + chunk(WHOLE, compression, packed=packer(WHOLE)[:-9]) + END, "bad")
    mcap(f"chunk of {compression} that is none", HEAD + chunk(WHOLE, compression, packed=b"abcdefgh") + END, "bad")


def zeros_of_4_gb():
    packer = zstandard.ZstdCompressor(level=1).compressobj()
    packed = b"".join(packer.compress(bytes(1 << 20)) for _ in range(4096)) + packer.flush()
    return HEAD + chunk(b"", "zstd", size=4 << 30, check=0, packed=packed) + END


def other_topic(make):
    """A chunk with another topic before the motion."""
    return large(lambda: HEAD + NAMES + schema(2, "x") + channel(2, 2, "/o") + chunk(make(), "zstd") + MOTION + END)


mcap("chunk of 4 GB of zeros in zstd", large(zeros_of_4_gb), "bad")
mcap("chunk with 900 MB of another topic", other_topic(lambda: stored(0, bytes(30 << 20), 2) * 30))
mcap("chunk with a message of 1 GB", other_topic(lambda: stored(0, bytes(1 << 30), 2)))


def flipped(seed):
    data = bytearray(HEAD + chunk(WHOLE) + END if seed % 2 else GOOD)
    draw = random.Random(seed)
    for _ in range(10):
        data[draw.randrange(8, len(data) if seed % 3 else 200)] = draw.randrange(256)
    return bytes(data)


for seed in range(12):
    mcap(f"10 bytes of noise {seed}", flipped(seed))

if __name__ == "__main__":
    harness.main(CASES)
