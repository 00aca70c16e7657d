"""Closed loops: `close` finds what closes them, and torques cause the motion that they were computed for."""

import runpy
from pathlib import Path

import numpy as np
import rne

ROOT = Path(__file__).parents[3]


def test_a_four_bar_closes_and_moves():
    arm = rne.load(ROOT / "docs/four_bar.yaml")
    assert arm.passive_joints == ["coupler", "rocker"]
    q, guess = arm.closures[0]
    passive, residual = arm.close(q, {name: at + 0.05 for name, at in zip(arm.passive_joints, guess)})
    assert np.allclose(passive, guess, atol=1e-12) and abs(residual).max() < 1e-12
    tau = arm.inverse_dynamics_of_loops(q, passive, [1.5], [-2.0])
    assert np.allclose(arm.forward_dynamics_of_loops(q, passive, [1.5], tau), [-2.0])
    many = np.repeat([q], 3, axis=0)
    assert arm.close(many, np.repeat([guess], 3, axis=0))[1].shape == (3, 5)


def test_the_examples_run(monkeypatch):
    monkeypatch.chdir(ROOT)
    for name in ["ankle", "standing_quadruped"]:
        runpy.run_path(f"examples/{name}.py")
