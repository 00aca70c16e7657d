"""The stubs say what the class has: its methods, and what they take."""

import ast
import copy
import inspect
import pickle
from pathlib import Path

import numpy as np

import rne

STUBS = ast.parse(Path(rne.__file__).with_suffix(".pyi").read_text())
ARM = next(node for node in STUBS.body if isinstance(node, ast.ClassDef) and node.name == "Arm")
METHODS = {node.name: node for node in ARM.body if isinstance(node, ast.FunctionDef) and not node.decorator_list}


def test_methods_are_those_of_the_stubs():
    def is_method(name):
        return not name.startswith("_") and callable(getattr(rne.Arm, name))

    assert {name for name in dir(rne.Arm) if is_method(name)} == {name for name in METHODS if not name.startswith("_")}


def test_signatures_are_those_of_the_stubs():
    for name, stub in METHODS.items():
        parameters = inspect.signature(getattr(rne.Arm, name)).parameters.values()
        positional = [one.name for one in parameters if one.kind is not inspect.Parameter.KEYWORD_ONLY]
        keywords = [one.name for one in parameters if one.kind is inspect.Parameter.KEYWORD_ONLY]
        assert positional == [one.arg for one in stub.args.posonlyargs + stub.args.args], name
        assert keywords == [one.arg for one in stub.args.kwonlyargs], name


def test_methods_say_what_they_compute():
    for name, stub in METHODS.items():
        words, summary = inspect.getdoc(getattr(rne.Arm, name)), ast.get_docstring(stub)
        if not name.startswith("_"):
            assert words and words.startswith(summary or ""), name
    assert "Returns shape (n, n) or (N, n, n)." in rne.Arm.mass_matrix.__doc__
    assert "`rne.payload`" in rne.Arm.inverse_dynamics_with_payload.__doc__
    assert "Other names: gravity compensation," in rne.Arm.gravity_torques.__doc__


def test_keywords_are_taken_by_name():
    arm = rne.robots.puma560
    q, qd, qdd = np.random.default_rng(3).normal(size=(3, 6))
    assert np.array_equal(arm.inverse_dynamics(qdd=qdd, q=q, qd=qd), arm.inverse_dynamics(q, qd, qdd))
    wrench = [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]
    named = arm.inverse_dynamics_with_wrench(wrench=wrench, q=q, qd=qd, qdd=qdd)
    assert np.array_equal(named, arm.inverse_dynamics_with_wrench(q, qd, qdd, wrench))


def test_methods_of_a_copy_are_those_of_the_arm():
    arm = rne.robots.puma560
    for other in (copy.copy(arm), pickle.loads(pickle.dumps(arm))):
        assert np.array_equal(other.gravity_torques([0.1] * 6), arm.gravity_torques([0.1] * 6))


def test_functions_of_logs_are_those_of_the_stubs():
    stubs = {node.name: node for node in STUBS.body if isinstance(node, ast.FunctionDef)}
    options = list(inspect.signature(rne.sources.reading).parameters)
    for name in ("log", "identify", "watch", "excite"):
        function, stub = getattr(rne, name), stubs[name]
        parameters = inspect.signature(function).parameters.values()
        positional = [one.name for one in parameters if one.kind is inspect.Parameter.POSITIONAL_OR_KEYWORD]
        keywords = [one.name for one in parameters if one.kind is inspect.Parameter.KEYWORD_ONLY]
        has_options = any(one.kind is inspect.Parameter.VAR_KEYWORD for one in parameters)
        assert positional == [one.arg for one in stub.args.args], name
        assert keywords + options * has_options == [one.arg for one in stub.args.kwonlyargs], name
        assert inspect.getdoc(function).startswith(ast.get_docstring(stub)), name


def test_results_of_logs_are_those_of_the_stubs():
    for name in ("Log", "Verdict", "Identification", "Baseline", "Watch", "Excitation"):
        stub = next(node for node in STUBS.body if isinstance(node, ast.ClassDef) and node.name == name)
        assert inspect.getdoc(getattr(rne, name)).startswith(ast.get_docstring(stub).rstrip(".")), name
        functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
        public = {one for one in vars(getattr(rne, name)) if not one.startswith("_")}
        assert public <= functions, name
        assert functions <= set(vars(getattr(rne, name))), name
