"""from_python.py: torques of many states from Python, numpy in and out, one thread: rne beside what can be installed of
Pinocchio and the Robotics Toolbox; `cargo xtask performance python` has both installed.

Pinocchio: `rneaInParallel` with one thread, its fastest entry for many states, on the URDFs of example-robot-data, which
both read. It takes a column for each state: a transposed view of the rows, which costs nothing. Its result is written
into an array that is there, and so is that of rne in the column `out=`.

Robotics Toolbox: `_frne_c.frne`, its C function, which loops over the rows, called without the checks around it; on tables
of models/, which both read.

Microseconds are minima over repetitions that alternate; no input is in another layout than the user's rows (N, n).
"""

import argparse
import os
import pathlib
import sys
import time
import warnings

os.environ["RAYON_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # before they are read
import numpy as np

import rne

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE), str(HERE.parents[2] / "tests/reference")]
warnings.filterwarnings("ignore")

# below the packages' folder; what of the URDF is the arm
URDFS = {
    "panda": ("panda_description/urdf/panda.urdf", dict(tip="panda_link8", lock_others=True)),
    "ur5": ("ur_description/urdf/ur5_robot.urdf", dict(tip="ee_link")),
}
TABLES = ["puma560", "panda", "iiwa14", "dense7"]


def fastest(calls, repetitions):
    """Seconds of the fastest of each of some calls, which alternate."""
    best = [float("inf")] * len(calls)
    for _ in range(repetitions):
        for index, call in enumerate(calls):
            start = time.perf_counter()
            call()
            best[index] = min(best[index], time.perf_counter() - start)
    return best


def row(peer, name, n, states, ours, ours_out, theirs, error):
    ours, ours_out, theirs = (seconds / states * 1e9 for seconds in (ours, ours_out, theirs))
    print(f"{peer:<18} {name:<8} {n:>6} {states:>6} {theirs:>8.1f} {ours:>8.1f} {ours_out:>8.1f} "
          f"{theirs / ours:>6.1f} {theirs / ours_out:>6.1f} {error:>9.1e}", flush=True)


def compare(peer, name, arm, states, theirs, repetitions):
    """`theirs` makes of rows a call and a function that gives its torques as rows."""
    random = np.random.default_rng(77)
    q, qd, qdd = (random.uniform(-high, high, (states, arm.dof)) for high in (np.pi, 2.0, 5.0))
    out = np.empty((states, arm.dof))
    call, torques = theirs(q, qd, qdd)
    times = fastest([lambda: arm.inverse_dynamics(q, qd, qdd), lambda: arm.inverse_dynamics(q, qd, qdd, out=out), call],
                    repetitions)
    expected = torques()
    assert np.array_equal(out, arm.inverse_dynamics(q, qd, qdd))
    error = np.abs(out - expected).max() / np.abs(expected).max()
    row(peer, name, arm.dof, states, *times, error)
    return error


def pinocchio_of(path, arm, tip):
    import pinocchio
    import urdf

    model = urdf.Reference(path, arm.joints, arm.held, tip).model
    assert model.nq == model.nv == arm.dof
    pool = pinocchio.ModelPool(model, 1)

    def calls(q, qd, qdd):
        columns = [x.T for x in (q, qd, qdd)]
        assert all(x.flags.f_contiguous for x in columns)
        out = np.empty(columns[0].shape, order="F")
        return lambda: pinocchio.rneaInParallel(1, pool, *columns, out), lambda: out.T

    return calls


def toolbox_of(name):
    from roboticstoolbox.robot.frne import frne

    import rtb
    from arm import load

    robot = rtb.build(load(name))

    def calls(q, qd, qdd):
        robot.rne(q[:1], qd[:1], qdd[:1])  # which makes what the C function reads
        still, gravity, force = np.eye(3), np.array(robot.gravity, dtype=float), np.zeros(6)
        call = lambda: frne(robot._frne, q, qd, qdd, gravity, still, force)
        return call, lambda: np.asarray(call()[0]).reshape(q.shape)

    return calls


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--repetitions", type=int, default=200)
    arguments.add_argument("--states", type=int, nargs="+", default=[1_000])
    given = arguments.parse_args()
    header = f"{'peer':<18} {'arm':<8} {'joints':>6} {'states':>6} {'peer':>8} {'rne':>8} {'out=':>8} "
    print(header + f"{'times':>6} {'out=':>6} {'difference':>9}")
    worst = 0.0
    for states in given.states:
        repetitions = max(5, given.repetitions * 1_000 // states)
        try:
            import urdf
        except ImportError as error:
            print(f"Pinocchio: skipped, {error}", file=sys.stderr)
        else:
            for name, (file, options) in URDFS.items():
                path = urdf.find(file)
                arm = rne.load(path, snap=False, **options)
                theirs = pinocchio_of(path, arm, options["tip"])
                worst = max(worst, compare("rneaInParallel, 1", name, arm, states, theirs, repetitions))
        try:
            import roboticstoolbox
        except ImportError as error:
            print(f"Robotics Toolbox: skipped, {error}", file=sys.stderr)
        else:
            models = pathlib.Path(__file__).parent.parent / "models"
            for name in TABLES:
                arm = rne.load(models / f"{name}.yaml")
                label = f"frne {roboticstoolbox.__version__}"
                worst = max(worst, compare(label, name, arm, states, toolbox_of(name), repetitions))
    sys.exit(int(worst > 1e-9))


if __name__ == "__main__":
    main()
