#!/usr/bin/env python3
"""Predictive control of a Panda by sampling (MPPI) on a graphics card: how many rollouts it computes in a second.

    python3 benches/gpu/mppi.py [--samples 100000] [--steps 50] [--cycles 100]

A cycle draws torques around the last plan, rolls all samples out in one launch (`Arm.gpu().rollout`), weighs them by their
cost, and moves the arm on by one step. Needs PyTorch for CUDA and the package rne. With `--fake LIBRARY` the driver is
that of `cargo build -p fake-driver`, which runs kernels on the processor: the loop runs on any machine, and times mean
nothing.
"""

import argparse
import os
import sys
import time
from pathlib import Path

GOAL = [0.5, 0.2, -0.3, -1.6, 0.2, 1.8, 0.4]  # rad
START = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8]
# Longer steps and larger torques make the light wrist of the Panda diverge: it has neither friction nor rotors here.
STEP = 0.005  # s
NOISE = [3.6, 3.6, 2.4, 2.4, 0.6, 0.6, 0.3]  # standard deviation of a torque, N m
TEMPERATURE = 0.05


class Controller:
    """The plan of MPPI, and what a cycle does with it. All arrays are in columns: the samples are the last axis."""

    def __init__(self, torch, arm, samples, steps, device):
        self.torch, self.gpu = torch, arm.gpu()
        like = {"dtype": torch.float32, "device": device}
        self.noise = torch.tensor(NOISE, **like)[None, :, None]
        self.goal = torch.tensor(GOAL, **like)[None, :, None]
        self.q, self.qd = torch.tensor(START, **like), torch.zeros(7, **like)
        self.plan = torch.zeros((steps, 7), **like)
        self.hold = torch.tensor(arm.gravity_torques(GOAL), **like)
        self.plan += self.hold
        self.samples, self.steps = samples, steps
        self.gpu.prepare(rollout=True)

    def columns(self, array):
        """A view with the samples first of an array that has them last."""
        return self.torch.movedim(array, -1, 0)

    def cycle(self):
        torch = self.torch
        drawn = self.noise * torch.randn((self.steps, 7, self.samples), dtype=self.plan.dtype, device=self.plan.device)
        tau = self.plan[:, :, None] + drawn
        start = [one[:, None].expand(7, self.samples).contiguous() for one in (self.q, self.qd)]
        q, qd = self.gpu.rollout(*map(self.columns, start), self.columns(tau), STEP)
        # back to the samples last, which moves no number
        q, qd = (torch.movedim(one, 0, -1) for one in (q, qd))
        far = ((q - self.goal) ** 2).sum((0, 1)) + 0.01 * (qd**2).sum((0, 1))
        cost = far / self.steps + ((q[-1] - self.goal[0]) ** 2).sum(0)
        # a sample whose arm has turned too fast for a step has no finite cost
        cost = torch.nan_to_num(cost, nan=1e6, posinf=1e6)
        weights = torch.softmax((cost.min() - cost) / TEMPERATURE, 0)
        plan = self.plan + (drawn * weights).sum(-1)
        # the arm: one sample, one step, of the same kernel
        one = [array[None, :].clone() for array in (self.q, self.qd)]
        moved = self.gpu.rollout(*one, plan[None, :1].clone(), STEP)
        self.q.copy_(moved[0][0, 0])
        self.qd.copy_(moved[1][0, 0])
        self.plan.copy_(torch.cat([plan[1:], self.hold[None]]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samples", type=int, default=100_000)
    parser.add_argument("--steps", type=int, default=50)
    parser.add_argument("--cycles", type=int, default=100)
    parser.add_argument("--fake", metavar="LIBRARY", help="the driver that runs kernels on the processor")
    asked = parser.parse_args()
    import torch

    if asked.fake:
        os.environ["RNE_LIBCUDA"] = asked.fake
        sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests/fake_driver"))
        from fake_torch import pretend

        pretend(torch, asked.fake)
    import rne

    device = "cpu" if asked.fake else "cuda"
    torch.manual_seed(1)
    controller = Controller(torch, rne.robots.panda, asked.samples, asked.steps, device)
    distance = lambda: float(((controller.q - controller.goal[0, :, 0]) ** 2).sum() ** 0.5)
    before = distance()
    wait = (lambda: None) if asked.fake else torch.cuda.synchronize

    def timed(what, cycle):
        wait()
        begin = time.perf_counter()
        for _ in range(asked.cycles):
            cycle()
        wait()
        seconds = (time.perf_counter() - begin) / asked.cycles
        print(f"{what}: {1e3 * seconds:.3f} ms per cycle, {asked.samples / seconds:,.0f} rollouts of {asked.steps} steps "
              f"per second, {asked.samples * asked.steps / seconds:,.0f} steps per second", flush=True)

    controller.cycle()  # buffers, kernels of PyTorch
    timed("cycle by cycle", controller.cycle)
    if not asked.fake:
        graph = torch.cuda.CUDAGraph()
        with torch.cuda.graph(graph):
            controller.cycle()
        timed("as a CUDA graph", graph.replay)
    print(f"distance to the goal: {before:.3f} rad, then {distance():.3f} rad")
    print(f"card: {controller.gpu.card}")


if __name__ == "__main__":
    main()
