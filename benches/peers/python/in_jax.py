"""in_jax.py: torques of many states inside a program of XLA, one thread: `jit(vmap(...))` of `Arm.jax` beside MuJoCo's MJX
and two recursions of jax.numpy, all on the same Panda. `pip install jax==0.6.2 mujoco==3.3.3 mujoco-mjx==3.3.3`; MJX takes
much longer with newer ones of these.

MJX: `mjx.inverse` on a model that has the bodies of the table, its C-like pipeline of positions and velocities included,
without constraints. Recursions: doors/python/tests/jnp_recursion.py, with vectors and matrices, and with a number for each
element. Nanoseconds for each state are medians of repetitions that alternate; all give the same torques to `error`.
"""

import argparse
import os
import pathlib
import statistics
import sys
import time

# before they are read
os.environ["RAYON_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"
os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from mujoco import mjx

import rne

sys.path.append(str(pathlib.Path(__file__).resolve().parents[3] / "doors/python/tests"))
from jnp_recursion import Chain  # noqa: E402


def mjcf(chain):
    """The chain as a model of MuJoCo."""
    def words(numbers):
        return " ".join(repr(float(number)) for number in numbers)

    head, tail = [], []
    for i, ((turn, place), (m, c, inertia)) in enumerate(zip(chain.steps, chain.bodies)):
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, turn.ravel())
        six = words([*np.diag(inertia), inertia[0, 1], inertia[0, 2], inertia[1, 2]])
        head.append(
            f'<body pos="{words(place)}" quat="{words(quaternion)}"><joint name="j{i}" axis="0 0 1"/>'
            f'<inertial pos="{words(c)}" mass="{words([m])}" fullinertia="{six}"/>'
        )
        tail.append("</body>")
    option = f'<option gravity="{words(chain.gravity)}"><flag constraint="disable"/></option>'
    compiler = '<compiler angle="radian" boundmass="0" boundinertia="0" balanceinertia="false"/>'
    return f"<mujoco>{compiler}{option}<worldbody>{''.join(head + tail)}</worldbody></mujoco>"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--states", type=int, default=100_000)
    parser.add_argument("--repetitions", type=int, default=15)
    parser.add_argument("--single", action="store_true", help="float32 in place of float64")
    asked = parser.parse_args()
    jax.config.update("jax_enable_x64", not asked.single)
    arm = rne.robots.panda
    chain = Chain(arm)
    functions = arm.jax()
    model = mujoco.MjModel.from_xml_string(mjcf(chain))
    placed = mjx.put_model(model)
    data = mjx.make_data(placed)

    def of_mjx(q, qd, qdd):
        return mjx.inverse(placed, data.replace(qpos=q, qvel=qd, qacc=qdd)).qfrc_inverse

    calls = {
        "rne": functions.inverse_dynamics,
        "MJX": of_mjx,
        "jnp, matrices": chain.torques,
        "jnp, numbers": chain.torques_by_numbers,
    }
    random = np.random.default_rng(77)
    q, qd, qdd = (random.uniform(-high, high, (asked.states, arm.dof)) for high in (np.pi, 2.0, 5.0))
    expected = arm.inverse_dynamics(q, qd, qdd)
    print(f"jax {jax.__version__}, {asked.states} states of {arm.name}, medians of {asked.repetitions}, one thread")
    kind = np.dtype(np.float32 if asked.single else np.float64)
    states = [jnp.asarray(array, kind) for array in (q, qd, qdd)]
    programs = {name: jax.jit(jax.vmap(call)) for name, call in calls.items()}
    times = {name: [] for name in programs}
    errors = {name: float(abs(np.asarray(one(*states)) - expected).max()) for name, one in programs.items()}
    for _ in range(asked.repetitions):
        for name, program in programs.items():
            start = time.perf_counter()
            program(*states).block_until_ready()
            times[name].append((time.perf_counter() - start) / asked.states * 1e9)
    ours = statistics.median(times["rne"])
    for name, found in times.items():
        median = statistics.median(found)
        print(f"{kind.name:<8} {name:<14} {median:>9.1f} ns {median / ours:>7.1f} times   error {errors[name]:.1e} N m",
              flush=True)


if __name__ == "__main__":
    main()
