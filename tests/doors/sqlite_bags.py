"""Bags of ROS 2 in SQLite: databases that are broken, lie about their tables or compute without end."""

import math
import os
import random
import shutil
import sqlite3

import harness
from joint_state import KIND, crowd, each, message, motion
from logs import READERS, read_by_all

CASES = harness.Cases()
SCHEMA = (
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
    "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
    "data BLOB NOT NULL);"
)
INDEX = "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
UNTYPED = (
    "CREATE TABLE topics(id,name,type,serialization_format,q);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id,timestamp,data);"
)
TOPIC = (1, "/joint_states", KIND, "cdr", "")
TWO_TOPICS = ((1, "/a", KIND, "cdr", ""), (2, "/b", KIND, "cdr", ""))
OTHER = "an_other/msg/Type"
IDENTIFY = {"identify": READERS["identify"]}


def bag(path, messages=None, topics=(TOPIC,), schema=SCHEMA + INDEX, after="", page=None):
    """Writes a bag: times in s or stamps in ns, data, and where given the number of the topic."""
    database = sqlite3.connect(path)
    if page:
        database.execute(f"PRAGMA page_size={page}")
    database.executescript(schema)
    database.executemany("INSERT INTO topics VALUES (?,?,?,?,?)", topics)
    rows = [
        (row[2] if len(row) > 2 else 1, int(row[0] * 1e9) if isinstance(row[0], float) else row[0], row[1])
        for row in (motion() if messages is None else messages)
    ]
    database.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES (?,?,?)", rows)
    database.executescript(after)
    database.commit()
    database.close()


def script(path, text):
    """Writes a database by a script of SQL."""
    database = sqlite3.connect(path)
    database.executescript(text)
    database.close()


def case(name, write, expected="any", says=(), options=(), everywhere=False, **more):
    CASES.add(
        name,
        lambda trial: read_by_all(
            trial, "log.db3", write, expected, says, options=options, everywhere=everywhere, readers=IDENTIFY, **more
        ),
    )


def sqlite(name, expected="any", says=(), options=(), everywhere=False, messages=None, **more):
    """A case of a bag whose messages are given, or made by a function."""

    def write(path):
        bag(path, messages() if callable(messages) else messages, **more)

    case(name, write, expected, says, options, everywhere)


def overwritten(at, data):
    """A good bag with some bytes overwritten."""

    def write(path):
        bag(path)
        with open(path, "r+b") as file:
            file.seek(at)
            file.write(data)

    return write


def cut(keep):
    """A good bag of which only a part is there."""

    def write(path):
        bag(path)
        os.truncate(path, keep(path.stat().st_size))

    return write


# Topics and tables.
sqlite("good", "taken")
sqlite("no index", "taken", schema=SCHEMA)
sqlite("no message", "bad", messages=[])
sqlite("no topic", "bad", topics=())
sqlite("two topics", "refused", ["--topic"], topics=TWO_TOPICS)
sqlite("topic by option", "taken", options=["--topic", "/a"], topics=TWO_TOPICS)
sqlite(
    "topic by option, of another type",
    "refused",
    options=["--topic", "/b"],
    topics=((1, "/a", KIND, "cdr", ""), (2, "/b", OTHER, "cdr", "")),
)
sqlite("one topic twice", topics=((1, "/a", KIND, "cdr", ""), (2, "/a", KIND, "cdr", "")))
sqlite("encoding protobuf", "bad", topics=((1, "/a", KIND, "protobuf", ""),))
sqlite("another type", "bad", topics=((1, "/a", OTHER, "cdr", ""),))
sqlite("topic of codes of terminals", topics=((1, "\x1b]0;x\x07\x1b[2J", "\x1b[31mtype", "cdr", ""),))
sqlite("topic of codes of colours", topics=((1, "\x1b[8mhidden", KIND, "cdr", ""),))
sqlite("topic of 1 MB", topics=((1, "a" * 1_000_000, "x", "cdr", ""),))
sqlite("10000 topics", topics=tuple((i, f"/t{i}", "x", "cdr", "") for i in range(10_000)))
sqlite("topic of NULL", schema=UNTYPED, topics=((1, None, None, None, None),))
sqlite("number of a topic a text", schema=UNTYPED, topics=(("x", "/a", KIND, "cdr", ""),))
sqlite("a column is missing", "bad", schema=UNTYPED, after="ALTER TABLE messages RENAME COLUMN data TO other;")
case("other tables", lambda path: script(path, "CREATE TABLE x(y);"), "bad")
case("empty database", lambda path: script(path, "CREATE TABLE x(y);DROP TABLE x;VACUUM;"), "bad")
case(
    "views for tables",
    lambda path: script(path, "CREATE VIEW topics AS SELECT 1; CREATE VIEW messages AS SELECT 1;"),
    "bad",
)


def on_a_terminal(trial):
    """A colour code in the name of a topic conceals nothing of what stands after it."""
    topics = ((1, "\x1b[8mhidden", KIND, "cdr", ""), (2, "/b", KIND, "cdr", ""))
    trial.write("log.db3", lambda path: bag(path, topics=topics))
    trial.rne("log", "log.db3", never=["\x1b[8m"], colours=True)


CASES.add("topic of codes of colours, on a terminal", on_a_terminal)

# Data of messages.
NULLABLE = SCHEMA.replace("BLOB NOT NULL", "BLOB")
sqlite("data NULL", schema=NULLABLE, messages=[(0, None), (1, None)])
sqlite("data a text", "bad", ["not bytes"], messages=[(0, "abc")])
sqlite("data a number", "bad", messages=[(0, 5)])
for size in (0, 3, 4):
    sqlite(f"data of {size} bytes", "bad", messages=[(0, b"\0\1\0\0"[:size])])
for megabytes in (2, 300):
    sqlite(f"data of {megabytes} MB", "bad", messages=lambda size=megabytes: [(0, b"\0\1\0\0" * (size << 18))])
for mark in (0, 7, 3):
    sqlite(f"encoding {mark} of messages", "bad", messages=motion(mark=bytes([0, mark, 0, 0])))
sqlite("messages cut", "bad", messages=each(lambda i, t: message(t)[:-3]))
sqlite("messages that go on", messages=each(lambda i, t: message(t) + b"x" * 100))

# Times.
sqlite("receive time a text", messages=[("abc", message(0.0)), ("abd", message(0.1))])
sqlite(
    "receive time NULL",
    schema=SCHEMA.replace("timestamp INTEGER NOT NULL", "timestamp INTEGER") + INDEX,
    messages=[(None, message(i * 0.01)) for i in range(400)],
)
sqlite(
    "receive time a fraction",
    schema=SCHEMA.replace("timestamp INTEGER", "timestamp REAL") + INDEX,
    messages=[(i + 0.5, message(i * 0.01)) for i in range(400)],
)
LEAST, MOST = -(1 << 63), (1 << 63) - 1
sqlite("receive time the least", messages=[(LEAST, message(i * 0.01)) for i in range(400)])
sqlite(
    "receive time from the least to the largest",
    messages=[(LEAST, message(0.0))] + [(MOST, message(i * 0.01)) for i in range(400)],
)
sqlite("3000 messages of one receive time", "taken", messages=[(5, message(i * 0.01)) for i in range(3000)])
sqlite("3000 messages of one stamp", messages=each(lambda i, t: message(0.0, q=[math.sin(i), math.cos(i)]), 3000))
sqlite("receive times", "taken", options=["--recorded"])
sqlite("a rate", "refused", options=["--rate", "5"])
for name, sec, nanosec in (
    ("stamp the largest", lambda i: 0x7FFFFFFF, lambda i: 0xFFFFFFFF - 400 + i),
    ("stamp the least", lambda i: 0x80000000, lambda i: i * 10_000_000),
    (
        "stamp from the least to the largest",
        lambda i: 0x80000000 if i < 5 else 0x7FFFFFFF,
        lambda i: i * 10_000_000 % 10**9,
    ),
    ("nanoseconds beyond a second", lambda i: 0, lambda i: 3_000_000_000 + i * 1_000_000),
):
    sqlite(name, messages=each(lambda i, t, sec=sec, nanosec=nanosec: message(0.0, sec=sec(i), nanosec=nanosec(i))))
sqlite("backwards", messages=each(lambda i, t: message(4 - t)))
sqlite("backwards once", "taken", messages=each(lambda i, t: message(t if i < 200 else t - 1.5)))


# Names of joints.
def swapped(i, t):
    order = 1 if i % 2 else -1
    return message(t, names=("a", "b")[::order], q=[1.0, 2.0][::order], qd=[0, 0], tau=[3.0, 4.0][::order])


sqlite("joints change their order", "taken", messages=each(swapped))
sqlite("joints missing in some", "taken", messages=each(lambda i, t: message(t, names=("a", "b") if i % 3 else ("a",))))
sqlite("joints alternate", messages=each(lambda i, t: message(t, names=("a",) if i % 2 else ("b",))))
sqlite("joint twice", "bad", messages=motion(names=("a", "a")))
sqlite("joint twice later", messages=each(lambda i, t: message(t, names=("a", "b") if i < 100 else ("a", "b", "b"))))
sqlite("no names", "bad", messages=motion(names=()))
for what, names in {
    "empty": ("", "x"),
    "of codes of terminals": ("\x1b]0;owned\x07", "\x1b[8mx\ny"),
    "of codes of colours": ("\x1b[8mhidden", "\x1b[31mred"),
    "that are no UTF-8": (b"\xff\xfe", b"\xc3"),
    "with a zero byte": ("a\0b", "c"),
}.items():
    sqlite(f"names {what}", messages=motion(names=names))
sqlite("name of length 0", messages=motion(lengths={"text": 0}))
sqlite("name of length 2^32-1", "bad", messages=motion(lengths={"text": 0xFFFFFFFF}))
sqlite("2^32-1 names", "bad", messages=motion(1, lengths={"names": 0xFFFFFFFF}))
sqlite(
    "20000 joints",
    "refused",
    messages=lambda: motion(70, names=[f"j{k}" for k in range(20_000)], q=[0.0] * 20_000, qd=[], tau=[]),
    everywhere=True,
)
sqlite("20000 joints, others in each message", "refused", messages=crowd, everywhere=True)
sqlite("20000 joints, two of them asked for", options=["--joints", "a,b"], messages=lambda: crowd(asked=("a", "b")))

# Positions, velocities and torques.
for key in ("q", "qd", "tau"):
    for length in (0xFFFFFFFF, 0x80000000, 0x20000000, 131072, 3):
        zeros = {"q": [0.0, 0.0], "qd": [0.0, 0.0], "tau": [0.0, 0.0], "lengths": {key: length}}
        sqlite(
            f"{length} numbers of {key} in one message",
            messages=each(lambda i, t, zeros=zeros: message(t, **zeros) if i == 5 else message(t)),
        )
sqlite("three positions of two joints", messages=motion(q=[1.0, 2.0, 3.0]))
sqlite("no positions", "bad", messages=motion(q=[]))
sqlite("no positions in some", "taken", messages=each(lambda i, t: message(t, q=None if i % 5 else [])))
sqlite("no torques", "taken", messages=motion(tau=[]))
sqlite("no velocities", "taken", messages=motion(qd=[]))
sqlite("positions NaN", "bad", messages=motion(q=[math.nan] * 2))
sqlite("positions NaN in some", "taken", messages=each(lambda i, t: message(t, q=None if i % 50 else [math.nan, 0.0])))
sqlite(
    "torques infinite in some", "taken", messages=each(lambda i, t: message(t, tau=None if i % 50 else [math.inf, 0.0]))
)

# Files.
for page in (512, 65536):
    sqlite(f"pages of {page} bytes", "taken", page=page)
case("cut in the middle", cut(lambda size: size // 2), "bad")
case("cut by a byte", cut(lambda size: size - 1), "bad")
case("magic alone", b"SQLite format 3\0", "bad")
case("magic and noise", b"SQLite format 3\0" + random.Random(1).randbytes(5000), "bad")
case("noise in the middle", overwritten(8192, b"\xaa" * 4096))
case("pages of size 0", overwritten(16, b"\0\0"))
case("2^32-1 pages", overwritten(28, b"\xff\xff\xff\xff"), "bad")
case("zeros in the middle", overwritten(4096, b"\0" * 8192), "bad")


def flipped(seed):
    def write(path):
        bag(path)
        data, draw = bytearray(path.read_bytes()), random.Random(seed)
        for _ in range(40):
            data[draw.randrange(100, len(data))] = draw.randrange(256)
        path.write_bytes(data)

    return write


for seed in range(12):
    case(f"40 bytes of noise {seed}", flipped(seed))


# Schemas that lie.
def disguised(name, text):
    """A good bag in which one table is something else that says it is a table."""

    def write(path):
        bag(path)
        database = sqlite3.connect(path)
        database.execute("PRAGMA writable_schema=ON")
        database.execute("DELETE FROM sqlite_schema WHERE name=?", (name,))
        database.execute("INSERT INTO sqlite_schema VALUES('table',?,?,0,?)", (name, name, text))
        database.commit()
        database.close()

    return write


ENDLESS = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x+1 FROM c) "
NO_ROW = "SELECT x AS id, 1 AS topic_id, 1 AS timestamp, x'00' AS data FROM c WHERE x < 0"
ROWS = f"SELECT x AS id, 1 AS topic_id, x AS timestamp, x'{message(0.0).hex()}' AS data FROM c"
TOPICS = "SELECT x AS id, 'a' AS name, 'b' AS type, 'cdr' AS serialization_format FROM c"
case("endless view of no messages", disguised("messages", f"CREATE VIEW messages AS {ENDLESS}{NO_ROW}"), "bad")
case("endless view of topics", disguised("topics", f"CREATE VIEW topics AS {ENDLESS}{TOPICS}"), "bad")
case("endless view of messages", disguised("messages", f"CREATE VIEW messages AS {ENDLESS}{ROWS}"))
case("virtual table", disguised("messages", "CREATE VIRTUAL TABLE messages USING fts5(topic_id,timestamp,data)"))


def computed(data, stamp="id"):
    """A bag whose data and receive times are computed by SQLite for each row."""

    def write(path):
        topics = SCHEMA.split("CREATE TABLE messages")[0]
        script(
            path,
            f"{topics}CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
            f"timestamp INTEGER AS ({stamp}), data BLOB AS ({data}));"
            f"INSERT INTO topics VALUES (1,'/a','{KIND}','cdr','');"
            "INSERT INTO messages(id,topic_id) VALUES (0,1),(1,1),(2,1),(3,1),(4,1);",
        )

    return write


case("data computed, 900 MB of zeros", computed("zeroblob(900000000)"), "bad")
case("data computed, 900 kB", computed("CAST(replace(hex(zeroblob(30000)),'0','aaaaaaaaaaaaaaa') AS BLOB)"), "bad")
case("receive time computed", computed("x'00'", "id*10000000"))
BESIDE = (
    "CREATE VIEW v AS SELECT load_extension('x');"
    "CREATE TRIGGER t AFTER INSERT ON messages BEGIN DELETE FROM messages; END;"
)
sqlite("view and trigger beside", "taken", after=BESIDE)
sqlite("index of an expression", schema=SCHEMA, after="CREATE INDEX i ON messages(timestamp, abs(id));")
sqlite("index of a part", schema=SCHEMA, after="CREATE INDEX i ON messages(timestamp) WHERE id < 10;")
LIE = (
    "UPDATE sqlite_schema SET sql='CREATE INDEX timestamp_idx ON messages (timestamp DESC)' WHERE name='timestamp_idx';"
)
sqlite("index that lies", after="PRAGMA writable_schema=ON;" + LIE)


# Folders of bags, and what lies beside one.
def folder_of_bags(trial):
    folder = trial.folder / "bags"
    folder.mkdir()
    (folder / "metadata.yaml").write_text(
        "rosbag2_bagfile_information: {relative_file_paths: [../../../../etc/passwd]}\n"
    )
    bag(folder / "a_0.db3")
    bag(folder / "a_1.db3", each(lambda i, t: message(4 + t)))
    return folder


def empty_folder(trial):
    (trial.folder / "bags").mkdir()
    trial.rne("log", trial.folder / "bags", expected="bad", says=["no rosbag2 bag"])


def pipe_in_a_folder(trial):
    folder = folder_of_bags(trial)
    os.mkfifo(folder / "pipe.db3")
    trial.rne("log", folder, expected="bad", says=["pipe"])


def link_in_a_folder(trial):
    folder = folder_of_bags(trial)
    (folder / "link.db3").symlink_to(folder / "a_0.db3")
    trial.rne("log", folder, expected="refused", says=["twice"])


def folder_in_a_folder(trial):
    folder = folder_of_bags(trial)
    (folder / "folder.db3").mkdir()
    trial.rne("log", folder)


def write_ahead_log(trial):
    """The messages are in a file beside the bag, as where a recorder was killed. Reading leaves nothing there."""
    original = trial.folder / "original.db3"
    database = sqlite3.connect(original)
    database.execute("PRAGMA journal_mode=WAL")
    database.executescript(SCHEMA)
    database.execute("INSERT INTO topics VALUES (1,'/a',?,'cdr','')", (KIND,))
    rows = [(int(t * 1e9), data) for t, data in motion()]
    database.executemany("INSERT INTO messages(topic_id,timestamp,data) VALUES (1,?,?)", rows)
    database.commit()
    for end in ("", "-wal"):
        shutil.copy(f"{original}{end}", trial.folder / f"log.db3{end}")
    database.close()
    trial.rne("log", trial.folder / "log.db3", expected="taken", says=["400 of 400"])


CASES.add("folder without bags", empty_folder)
CASES.add("folder of two bags", lambda trial: trial.rne("log", folder_of_bags(trial), expected="taken"))
CASES.add(
    "folder and its bag",
    lambda trial: trial.rne("log", folder_of_bags(trial), "bags/a_0.db3", expected="refused", says=["twice"]),
)
CASES.add("folder with a link to its bag", link_in_a_folder)
CASES.add("folder with a folder called db3", folder_in_a_folder)
CASES.add("folder with a pipe called db3", pipe_in_a_folder)
CASES.add("messages in the file beside", write_ahead_log)

if __name__ == "__main__":
    harness.main(CASES)
