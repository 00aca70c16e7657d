"""rollouts.py: rollouts of an arm from Python, numpy in and out, on one thread: rne's `arm.rollout` beside
`mujoco.rollout`.

Both programs move the same arm of models/ on by semi-implicit Euler with the same step: qd += step * qdd, then
q += step * qd. The MuJoCo model has no geoms, and everything is disabled that a free arm does not need: contacts,
constraints, and the implicit damping of MuJoCo's integrator (`eulerdamp`). Torques are applied as `qfrc_applied`. Both
write their states into arrays that exist before.

Before the measurement the script compares both: one step from each of the initial states, relative to the largest
number. The exit code is 1 if the difference is above 1e-12. Nanoseconds are time of the processor: medians of rounds
that alternate between the programs. In each round a program runs twice, and its second run counts. The ratio is the
median of the ratios of the rounds.

MuJoCo has Coulomb friction only as a constraint, which is another equation. So the second line compares the same
rollout of MuJoCo, without friction, with a rollout of rne that has viscous and Coulomb friction in every joint (smooth
law, width 0.05 rad/s) and all limits.

Needs the packages rne, numpy and mujoco. Example: python benches/peers/python/rollouts.py --samples 1024 --steps 64
"""

import argparse
import os
import pathlib
import re
import statistics
import sys
import time

os.environ["RAYON_NUM_THREADS"] = "1"  # before it is read
import mujoco
import numpy as np
from mujoco import rollout as mujoco_rollout

import rne

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import mujoco_arm
from arm import load

WIDTH = 0.05  # rad/s
MOTOR = "\n    motor: {viscous: 0.5, coulomb: [0.4, -0.4]}\n    limits: {position: [-2.9, 2.9], velocity: 2.2, effort: 87}"


def model_of(name, step):
    model = mujoco_arm.bare(load(name))
    model.opt.timestep = step
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    assert model.ngeom == 0 and model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    return model


class MuJoCo:
    """Rollouts on the calling thread: `nthread=0`."""

    def __init__(self, name, step, q, qd, tau):
        self.model = model_of(name, step)
        self.data = mujoco.MjData(self.model)
        samples, self.steps, n = tau.shape
        self.start = np.hstack([np.zeros((samples, 1)), q, qd])
        self.tau = tau
        self.state = np.empty((samples, self.steps, 1 + 2 * n))
        self.rollout = mujoco_rollout.Rollout(nthread=0)
        self.spec = int(mujoco.mjtState.mjSTATE_QFRC_APPLIED)

    def run(self):
        self.rollout.rollout(self.model, self.data, self.start, self.tau, control_spec=self.spec, nstep=self.steps,
                             state=self.state)

    def states(self):
        n = self.tau.shape[2]
        return self.state[:, :, 1:1 + n], self.state[:, :, 1 + n:]


def with_friction(text):
    """The robot file with a motor and limits in every joint."""
    return re.sub(r"(\n  - .*(?:\n    .*)*)", lambda joint: joint[1] + MOTOR, text)


def seconds(call):
    """Time of the processor, of all threads of this process: other programs do not count."""
    start = time.process_time()
    call()
    return time.process_time() - start


def compare(name, samples, steps, step, rounds):
    path = HERE.parent / f"models/{name}.yaml"  # with its plan file
    arm, rubbing = rne.load(path), rne.load(with_friction(path.read_text()))
    random = np.random.default_rng(77)
    q, qd = (random.uniform(-high, high, (samples, arm.dof)) for high in (np.pi / 2, 1.0))
    tau = arm.gravity_torques(q)[:, None, :] + random.normal(size=(samples, steps, arm.dof))
    peer = MuJoCo(name, step, q, qd, tau)
    out = np.empty((2, samples, steps, arm.dof))
    calls = {
        "mujoco": peer.run,
        "rne": lambda: arm.rollout(q, qd, tau, step, out=out),
        "rne, friction and limits": lambda: rubbing.rollout(q, qd, tau, step, friction=WIDTH, limits=True, out=out),
    }
    calls["mujoco"]()
    calls["rne"]()
    errors = []
    for index in (0, steps - 1):
        ours, theirs = (np.stack([part[:, index] for part in found]) for found in (out, peer.states()))
        errors.append(np.abs(ours - theirs).max() / np.abs(theirs).max())
    print(f"{name}: {samples} samples, {steps} steps of {step} s, difference after one step {errors[0]:.1e}, "
          f"after all {errors[1]:.1e}")
    times = {label: [] for label in calls}
    for _ in range(rounds):
        for label, call in calls.items():
            call()  # not measured: a controller calls one program again and again, with its own data in the caches
            times[label].append(seconds(call) / (samples * steps) * 1e9)
    for label, of_label in times.items():
        ratio = statistics.median(theirs / ours for theirs, ours in zip(times["mujoco"], of_label))
        print(f"{label:<25} {statistics.median(of_label):>8.1f} ns per state {ratio:>6.1f} times as fast as mujoco")
    return errors[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arm", default="panda", help="an arm of models/ (default: panda)")
    parser.add_argument("--samples", type=int, default=1024, help="samples of a rollout (default: 1024)")
    parser.add_argument("--steps", type=int, default=64, help="steps of a sample (default: 64)")
    parser.add_argument("--step", type=float, default=0.002, help="duration of a step in s (default: 0.002)")
    parser.add_argument("--rounds", type=int, default=15, help="rounds (default: 15)")
    given = parser.parse_args()
    print(f"mujoco {mujoco.__version__}, rne {rne.__version__}, one thread each")
    sys.exit(int(compare(given.arm, given.samples, given.steps, given.step, given.rounds) > 1e-12))


if __name__ == "__main__":
    main()
