"""A call of one state with plain arrays does no work in Python: no function of Python runs, and none of numpy."""

import inspect
import sys
import types
import warnings

import numpy as np
import pytest
from one_state_calls import all_calls

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    CALLS = list(all_calls())


@pytest.fixture(name="visible")
def fixture_visible(monkeypatch):
    """Functions of numpy in C as functions of Python, so that a profile sees who calls them."""
    for module in (np, np.ma, np.linalg):
        for name, function in vars(module).items():
            if callable(function) and not isinstance(function, (type, types.FunctionType)) and not name.startswith("_"):
                monkeypatch.setattr(module, name, lambda *a, function=function, **k: function(*a, **k))


def entered(call):
    """The functions of Python that a call enters, itself not among them."""
    names = []

    def profile(frame, event, _):
        if event == "call" and frame.f_code is not call.__code__:
            names.append(f"{frame.f_globals.get('__name__')}.{frame.f_code.co_name}")

    sys.setprofile(profile)
    try:
        call()
    finally:
        sys.setprofile(None)
    return names


@pytest.mark.filterwarnings("ignore")
def test_plain_arrays_of_one_state_go_to_rust_unseen(visible):
    assert len(CALLS) > 200 and inspect.isfunction(np.asarray)
    found = {" ".join(label): names for *label, call in CALLS if (names := entered(call))}
    assert not found, found


def test_the_profile_sees_what_python_does(visible):
    assert entered(lambda: np.ma.stack([np.zeros(3)]))
    arm = CALLS[0][-1]
    assert entered(lambda: np.asarray([1.0])) and not entered(arm)
