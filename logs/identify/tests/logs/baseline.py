"""A textbook's identification in NumPy, on the first 70 % of each log here and judged on the rest: python baseline.py

Velocities behind a Hann window of 80 ms, central differences, viscous and tanh Coulomb friction and an offset, base
parameters by the singular values, rows over each joint's deviation, least squares with a small ridge. Prints the root
mean square of measured - predicted over the deviation of the measured effort, in percent, joint by joint.
"""

import pathlib

import numpy as np

HERE = pathlib.Path(__file__).parent
PI = np.pi
ARMS = {  # alpha, a, d of modified rows
    "ur10": ([0, PI / 2, 0, 0, PI / 2, -PI / 2], [0, 0, -0.612, -0.5723, 0, 0],
             [0.1273, 0, 0, 0.163941, 0.1157, 0.0922]),
    "panda": ([0, -PI / 2, PI / 2, PI / 2, -PI / 2, PI / 2, PI / 2], [0, 0, 0, 0.0825, -0.0825, 0, 0.088],
              [0.333, 0, 0.316, 0, 0.384, 0, 0]),
}


def cross(v):
    x, y, z = v
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def times_inertia(w):
    x, y, z = w
    return np.array([[x, y, z, 0, 0, 0], [0, x, 0, y, z, 0], [0, 0, x, 0, y, z]])


def regressor(arm, q, qd, qdd):
    alpha, a, d = ARMS[arm]
    n, z = len(q), np.array([0.0, 0.0, 1.0])
    w, dw, dv, turns, places, wrenches = np.zeros(3), np.zeros(3), 9.81 * z, [], [], []
    for i in range(n):
        (c, s), (ca, sa) = (np.cos(q[i]), np.sin(q[i])), (np.cos(alpha[i]), np.sin(alpha[i]))
        turn = np.array([[c, -s, 0], [s * ca, c * ca, -sa], [s * sa, c * sa, ca]])
        place = np.array([a[i], -sa * d[i], ca * d[i]])
        dv = turn.T @ (dv + np.cross(dw, place) + np.cross(w, np.cross(w, place)))
        before = turn.T @ w
        dw = turn.T @ dw + np.cross(before, z * qd[i]) + z * qdd[i]
        w = before + z * qd[i]
        wrench = np.zeros((6, 10))
        wrench[:3, 0], wrench[:3, 1:4] = dv, cross(dw) + cross(w) @ cross(w)
        wrench[3:, 1:4], wrench[3:, 4:] = -cross(dv), times_inertia(dw) + cross(w) @ times_inertia(w)
        turns.append(turn), places.append(place), wrenches.append(wrench)
    rows = np.zeros((n, 10 * n))
    for link in range(n):
        wrench = wrenches[link]
        for joint in range(link, -1, -1):
            rows[joint, 10 * link : 10 * link + 10] = wrench[5]
            force = turns[joint] @ wrench[:3]
            wrench = np.vstack([force, turns[joint] @ wrench[3:] + cross(places[joint]) @ force])
    return rows


def errors(arm):
    log = np.loadtxt(HERE / f"{arm}.csv", delimiter=",", skiprows=1)
    time, (q, qd, tau) = log[:, 0], np.split(log[:, 1:], 3, axis=1)
    n, half = q.shape[1], int(round(0.08 / np.median(np.diff(time)))) // 2
    window = np.hanning(2 * half + 3)[1:-1]
    smooth = lambda x: np.convolve(np.pad(x, half, mode="edge"), window / window.sum(), "valid")
    qd = np.apply_along_axis(smooth, 0, qd)
    qdd = np.gradient(qd, time, axis=0)
    random = np.random.default_rng(0)
    anywhere = np.vstack([regressor(arm, *random.uniform(-2, 2, (3, n))) for _ in range(100)])
    values, vectors = np.linalg.svd(anywhere, full_matrices=False)[1:]
    base = vectors[values > 1e-9 * values[0]].T
    rows = np.stack([regressor(arm, *state) @ base for state in zip(q, qd, qdd)])
    friction = np.zeros((len(time), n, 3 * n))
    for joint in range(n):
        v = qd[:, joint]
        friction[:, joint, 3 * joint : 3 * joint + 3] = np.stack([v, np.tanh(v / 0.05), np.ones_like(v)], 1)
    rows = np.concatenate([rows, friction], 2)
    until = int(0.7 * len(time))
    scale = tau[:until].std(0)
    lhs = (rows[:until] / scale[:, None]).reshape(-1, rows.shape[2])
    unknowns = np.linalg.solve(lhs.T @ lhs + 1e-3 * np.eye(lhs.shape[1]), lhs.T @ (tau[:until] / scale).ravel())
    left = tau[until:] - rows[until:] @ unknowns
    return base.shape[1], 100 * np.sqrt((left**2).mean(0)) / tau[until:].std(0)


if __name__ == "__main__":
    for arm in ARMS:
        rank, percent = errors(arm)
        errors_of_joints = " ".join(f"{error:.1f}" for error in percent)
        print(f"{arm} {rank} base parameters: {errors_of_joints} median {np.median(percent):.1f}")
