"""What numpy makes of the extracts: python golden.py > golden.csv

Independent of the crate: the messages are taken apart with struct, the filter is numpy.sinc times numpy.kaiser by
numpy.convolve, the differences are numpy.convolve with Fornberg's coefficients, the even grid is the cubic of Lagrange
by numpy.polyfit over four samples.
"""

import pathlib
import sqlite3
import struct

import numpy as np

HERE = pathlib.Path(__file__).parent


def string(data, at):
    at = (at + 3) // 4 * 4
    (length,) = struct.unpack_from("<I", data, at)
    return data[at + 4 : at + 3 + length].decode(), at + 4 + length


def message(data):
    data = data[4:]
    sec, nanosec = struct.unpack_from("<iI", data)
    _, at = string(data, 8)
    at = (at + 3) // 4 * 4
    (count,) = struct.unpack_from("<I", data, at)
    at += 4
    for _ in range(count):
        _, at = string(data, at)
    lists = []
    for _ in range(3):
        at = (at + 3) // 4 * 4
        (count,) = struct.unpack_from("<I", data, at)
        at = (at + 11) // 8 * 8 if count else at + 4
        lists.append(struct.unpack_from(f"<{count}d", data, at))
        at += 8 * count
    return sec * 10**9 + nanosec, *lists


def even(times, columns):
    """The cubic through the two samples before and the two behind each time of the grid."""
    step = float(np.median(np.diff(times)))
    grid = np.arange(0, times[-1] - times[0] + 1e-3 * step, step)
    t = (times - times[0]).astype(float)
    rows = []
    for at in grid:
        first = np.searchsorted(t, at, side="right") - 1
        near = slice(first - 1, first + 3)
        if first < 1 or first + 3 > len(t):
            rows.append(np.array([np.interp(at, t, column) for column in columns.T]))
            continue
        x = (t[near] - at) / step
        rows.append(np.polyfit(x, columns[near], 3)[-1])
    return step * 1e-9, grid * 1e-9, np.array(rows)


def low_pass(columns, cutoff, step):
    half = int(np.ceil((66 - 8) / (2.285 * 2 * np.pi * cutoff * step * 2 / 3) / 2))
    k = np.arange(-half, half + 1)
    kernel = np.sinc(2 * cutoff * step * k) * np.kaiser(2 * half + 1, 0.1102 * (66 - 8.7))
    return half, np.stack([np.convolve(c, kernel / kernel.sum(), "valid") for c in columns.T], 1)


def derivative(columns, step):
    weights = np.array([-1 / 280, 4 / 105, -1 / 5, 4 / 5, 0, -4 / 5, 1 / 5, -4 / 105, 1 / 280]) / step
    return np.stack([np.convolve(c, weights, "valid") for c in columns.T], 1)


print("bag,measured,time,joint,q,qd,qdd,tau")
for name, cutoff in [("ur10", 8.0), ("panda", 5.0)]:
    bag = sqlite3.connect(f"file:{HERE / name}.db3?mode=ro", uri=True)
    rows = [message(data) for (data,) in bag.execute("SELECT data FROM messages ORDER BY timestamp")]
    times = np.array([row[0] for row in rows])
    q, qd, tau = (np.array([row[i] for row in rows]) for i in (1, 2, 3))
    n = q.shape[1]
    step, grid, all_even = even(times, np.hstack([q, qd, tau]))
    half, smooth = low_pass(all_even, cutoff, step)
    begin = times[0] * 1e-9
    for measured in [True, False]:
        if measured:
            velocity, first = smooth[4:-4, n : 2 * n], half + 4
            acceleration = derivative(smooth[:, n : 2 * n], step)
        else:
            velocity = derivative(smooth[:, :n], step)
            velocity, acceleration, first = velocity[4:-4], derivative(velocity, step), half + 8
        edge = first - half
        position, torque = smooth[edge : len(smooth) - edge, :n], smooth[edge : len(smooth) - edge, 2 * n :]
        for i in list(range(0, len(position), 31)) + [len(position) - 1]:
            for joint in range(n):
                numbers = position[i, joint], velocity[i, joint], acceleration[i, joint], torque[i, joint]
                time = begin + grid[first + i]
                print(name, int(measured), repr(float(time)), joint, *(repr(float(x)) for x in numbers), sep=",")
