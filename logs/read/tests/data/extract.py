"""Cuts the two extracts from the bags of unisa-acg/inverse-dynamics-solver: python extract.py FOLDER"""

import pathlib
import sqlite3
import sys

HERE = pathlib.Path(__file__).parent

for source, name, count in [
    ("ur10_exciting_trajectory_first70.db3", "ur10.db3", 460),
    ("panda_exciting_trajectory_first70.db3", "panda.db3", 300),
]:
    bag = sqlite3.connect(f"file:{pathlib.Path(sys.argv[1]) / source}?mode=ro&immutable=1", uri=True)
    target = HERE / name
    target.unlink(missing_ok=True)
    extract = sqlite3.connect(target)
    for (statement,) in bag.execute("SELECT sql FROM sqlite_master WHERE sql NOT NULL"):
        extract.execute(statement)
    for table in ["schema", "topics"]:
        rows = bag.execute(f"SELECT * FROM {table}").fetchall()
        for row in rows:
            extract.execute(f"INSERT INTO {table} VALUES ({','.join('?' * len(row))})", row)
    for row in bag.execute("SELECT * FROM messages ORDER BY timestamp LIMIT ?", (count,)):
        extract.execute("INSERT INTO messages VALUES (?, ?, ?, ?)", row)
    extract.commit()
    extract.execute("VACUUM")
