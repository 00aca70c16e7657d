"""The node rne-ros2 against Eclipse Cyclone DDS: joint states of the PUMA 560 there, torques back.

The script starts the node, publishes joint states at a fixed rate, and reads everything that the node publishes. It
passes if no message is lost and every torque is that of `rne eval`. All participants use the loopback interface and no
multicast: they find each other by unicast. `cargo xtask ros2` runs it.
"""

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

DOMAIN = 77
DEPTH = 4000
GAIN, GAP = 20.0, 1.0  # Hz, the default of the node; s, longer than a busy machine holds up the sender
TOLERANCE = 1e-9  # N m: rounding of the observer in another order, at torques of 100 N m
CONFIGURATION = """
<CycloneDDS><Domain Id="any">
  <General>
    <Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces>
    <AllowMulticast>false</AllowMulticast>
  </General>
  <Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer Address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>
"""
os.environ["CYCLONEDDS_URI"] = CONFIGURATION

from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication, BuiltinTopicDcpsSubscription
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter, Publisher
from cyclonedds.sub import DataReader, Subscriber
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from messages import DiagnosticArray, Header, JointState, Time

# Joints of robots/puma560.yaml in another order, among joints of a gripper; the place of each joint, base to tip.
NAMES = ["j3", "finger", "j1", "j6", "j2", "j5", "thumb", "j4"]
PLACES = [NAMES.index(f"j{joint}") for joint in range(1, 7)]
# At the motors, as in robots/puma560.yaml: gear ratio, viscous friction N m s/rad, Coulomb friction N m of each direction.
MOTORS = np.array([
    [62.6111, 1.48e-3, 0.395, -0.435],
    [107.815, 0.817e-3, 0.126, -0.071],
    [53.7063, 1.38e-3, 0.132, -0.105],
    [76.0364, 71.2e-6, 11.2e-3, -16.9e-3],
    [71.923, 82.6e-6, 9.26e-3, -14.5e-3],
    [76.686, 36.7e-6, 3.96e-3, -10.5e-3],
])


def motion(seconds, rate):
    """Positions, velocities and efforts, (n, 6); the efforts belong to no motion, so external torques are large."""
    t = np.arange(seconds * rate)[:, None] / rate
    pulse = 2 * np.pi * np.array([0.31, 0.43, 0.57, 0.71, 0.83, 0.97])
    size = np.array([1.2, 0.8, 0.9, 1.1, 0.7, 1.3])
    phase = np.arange(6) * 0.7 + 0.2
    q = size * np.sin(pulse * t + phase)
    qd = size * pulse * np.cos(pulse * t + phase)
    tau = np.array([60, 80, 40, 5, 4, 3]) * np.sin(0.6 * pulse * t + 2 * phase)
    return q, qd, tau


def qos(history, reliable=True):
    reliability = Policy.Reliability.Reliable(duration(seconds=1)) if reliable else Policy.Reliability.BestEffort
    return Qos(reliability, Policy.Durability.Volatile, Policy.History.KeepLast(history))


def spelled(found):
    """Reliability and durability of an endpoint, as participants tell each other."""
    policies = [policy for policy in found if policy.__scope__ in ("Reliability", "Durability")]
    return ", ".join(str(policy).removeprefix("Policy.") for policy in policies)


class Exchange:
    def __init__(self, participant):
        self.participant = participant
        topic = lambda name, kind: Topic(participant, f"rt/{name}", kind)
        self.writer = DataWriter(Publisher(participant), topic("joint_states", JointState), qos=qos(DEPTH))
        reader = lambda name, kind: DataReader(Subscriber(participant), topic(name, kind), qos=qos(DEPTH))
        self.gravity = reader("rne/gravity_torques", JointState)
        self.external = reader("rne/external_torques", JointState)
        self.diagnostics = reader("diagnostics", DiagnosticArray)
        self.received = {self.gravity: [], self.external: [], self.diagnostics: []}

    def wait_for_the_node(self, node):
        """Until both directions are connected."""
        limit = time.monotonic() + 30
        while time.monotonic() < limit and node.poll() is None:
            readers = [self.gravity, self.external, self.diagnostics]
            if self.writer.get_matched_subscriptions() and all(r.get_matched_publications() for r in readers):
                # the node needs as long to learn of the readers here
                time.sleep(2)
                return
            time.sleep(0.05)
        sys.exit(f"the node was not found within 30 s by unicast on 127.0.0.1; its exit status is {node.poll()}")

    def print_qos(self):
        for what, kind in (("writer", BuiltinTopicDcpsPublication), ("reader", BuiltinTopicDcpsSubscription)):
            for endpoint in BuiltinDataReader(self.participant, kind).take(200):
                name = endpoint.topic_name
                if name == "rt/joint_states" or name.startswith("rt/rne/") or name == "rt/diagnostics":
                    side = "Cyclone" if endpoint.participant_key == self.participant.guid else "node"
                    print(f"  {side:8}{what:7}{name:26}{endpoint.type_name:45}{spelled(endpoint.qos)}")
        # participants do not tell each other their histories
        print(f"  history of all: KeepLast({DEPTH})")

    def send(self, q, qd, tau, rate):
        """Publishes all states at the rate; returns their stamps, ns."""
        lists = [np.zeros((len(q), len(NAMES))) for _ in range(3)]
        for whole, of_arm in zip(lists, (q, qd, tau)):
            whole[:, PLACES] = of_arm
        lists = [whole.tolist() for whole in lists]
        stamps, begin = [], time.monotonic()
        for tick, (position, velocity, effort) in enumerate(zip(*lists)):
            while (early := begin + tick / rate - time.monotonic()) > 0:
                time.sleep(early)
            stamp = max(time.time_ns(), stamps[-1] + 1 if stamps else 0)
            stamps.append(stamp)
            header = Header(Time(stamp // 10**9, stamp % 10**9), "base")
            self.writer.write(JointState(header, NAMES, position, velocity, effort))
            self.read()
        return np.array(stamps), time.monotonic() - begin

    def read(self):
        for reader, messages in self.received.items():
            messages += reader.take(N=1000)

    def read_the_rest(self):
        """Until nothing has come for a second, which is a diagnostics message at most."""
        quiet = time.monotonic()
        while time.monotonic() < quiet + 2:
            before = [len(self.received[reader]) for reader in (self.gravity, self.external)]
            self.read()
            if before != [len(self.received[reader]) for reader in (self.gravity, self.external)]:
                quiet = time.monotonic()
            time.sleep(0.01)


def evaluated(rne, folder, function, columns, *options):
    """The results of `rne eval` at every state, by way of npy files."""
    states, results = folder / f"{function}.states.npy", folder / f"{function}.npy"
    np.save(states, np.hstack(columns))
    command = [rne, "eval", "puma560", *options, "--function", function, "--states", states, "-o", results]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"rne eval failed: {done.stderr}")
    return np.load(results)


def one_state(rne, q):
    """Gravity torques by `rne eval` at one state, which loops over the links instead of compiling."""
    numbers = ",".join(repr(float(x)) for x in q)
    command = [rne, "eval", "puma560", "--function", "gravity_torques", f"--q={numbers}", "--json"]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["result"]


def observed(stamps, momentum, rate):
    """The momentum observer by hand, and whether it begins at a message, after which there is nothing to publish."""
    period = np.diff(stamps) * 1e-9
    seen, begins = np.zeros_like(momentum), np.ones(len(stamps), dtype=bool)
    for k in range(1, len(stamps)):
        h = period[k - 1]
        if h > GAP:
            continue
        begins[k] = False
        mean = (momentum[k] - momentum[k - 1]) / h - 0.5 * (rate[k] + rate[k - 1])
        seen[k] = seen[k - 1] - np.expm1(-2 * np.pi * GAIN * h) * (mean - seen[k - 1])
    return seen, begins


def compared(name, messages, stamps, expected):
    """Prints what is lost and the largest error; whether both are as they shall be."""
    came = np.array([m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in messages], dtype=np.int64)
    lost = len(np.setdiff1d(stamps, came))
    strange = len(np.setdiff1d(came, stamps)) + len(came) - len(np.unique(came))
    in_order = bool(np.all(np.diff(came) > 0))
    error, shape = np.inf, all(m.name == [f"j{j}" for j in range(1, 7)] and len(m.effort) == 6 for m in messages)
    if lost == 0 and strange == 0 and in_order and shape and len(messages):
        error = float(np.max(np.abs(np.array([m.effort for m in messages]) - expected)))
    largest = float(np.max(np.abs(expected))) if len(expected) else 0.0
    print(f"{name}: expected {len(stamps)}, received {len(came)}, lost {lost}, twice or unknown {strange}, "
          f"in order: {'yes' if in_order else 'no'}; largest torque {largest:.1f} N m, largest error {error:.1e} N m")
    return error <= TOLERANCE


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--node", required=True, help="the program rne-ros2")
    parser.add_argument("--rne", required=True, help="the program rne")
    parser.add_argument("--seconds", type=int, default=60, help="how long joint states are published")
    parser.add_argument("--rate", type=int, default=1000, help="joint states per second")
    arguments = parser.parse_args()
    q, qd, tau = motion(arguments.seconds, arguments.rate)

    command = [arguments.node, "puma560", "--domain", str(DOMAIN), "--interface", "127.0.0.1", "--depth", str(DEPTH)]
    # the processors may be busy with other work for a while: no message is too old
    node = subprocess.Popen([*command, "--gap", str(GAP), "--stale-after", "60"])
    try:
        exchange = Exchange(DomainParticipant(DOMAIN))
        exchange.wait_for_the_node(node)
        exchange.print_qos()
        stamps, took = exchange.send(q, qd, tau, arguments.rate)
        exchange.read_the_rest()
    finally:
        node.send_signal(signal.SIGTERM)
        status = node.wait(timeout=30)
    print(f"joint states: sent {len(stamps)} in {took:.2f} s, {len(stamps) / took:.1f} per second")

    friction = MOTORS[:, 0] ** 2 * MOTORS[:, 1] * qd
    friction += MOTORS[:, 0] * np.where(qd > 0, MOTORS[:, 2], np.where(qd < 0, MOTORS[:, 3], 0.0))
    with tempfile.TemporaryDirectory() as folder:
        gravity = evaluated(arguments.rne, Path(folder), "gravity_torques", [q])
        columns = [q, qd, tau - friction]
        momentum, rate = np.hsplit(evaluated(arguments.rne, Path(folder), "momentum_and_rate", columns, "--rotors"), 2)
    external, begins = observed(stamps, momentum, rate)
    received = exchange.received
    holds = compared("gravity torques", received[exchange.gravity], stamps, gravity)
    holds &= compared("external torques", received[exchange.external], stamps[~begins], external[~begins])
    print(f"the observer began {int(begins.sum())} times (two stamps more than {GAP} s apart, and the first message)")
    some = range(0, len(q), max(1, len(q) // 20))
    alone = max(float(np.max(np.abs(gravity[k] - one_state(arguments.rne, q[k])))) for k in some)
    print(f"rne eval at many states and at {len(some)} single states: largest difference {alone:.1e} N m")

    last = received[exchange.diagnostics][-1] if received[exchange.diagnostics] else DiagnosticArray()
    values = {pair.key: pair.value for part in last.status for pair in part.values}
    counts = {key: values.get(key, "0") for key in ("received", "used", "lost", "computed", "not published")}
    print(f"diagnostics: {len(received[exchange.diagnostics])} messages; the last one: {counts}")
    wanted = {"received": len(stamps), "used": len(stamps), "lost": 0, "computed": int((~begins).sum()), "not published": 0}
    holds &= alone <= TOLERANCE and counts == {key: str(value) for key, value in wanted.items()}
    # a processor that is busy with other work holds up the sender, which the node reports
    time_of = lambda message: message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
    within = [m for m in received[exchange.diagnostics] if stamps[0] + 10**9 < time_of(m) <= stamps[-1]]
    for part in sorted({(p.level, p.name, p.message) for m in within for p in m.status if p.level > 0}):
        print("  diagnostics, level {}: {}: {}".format(*part))
    if status != 0:
        print(f"the node ended with status {status}")
    print("holds" if holds and status == 0 else "fails")
    return 0 if holds and status == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
