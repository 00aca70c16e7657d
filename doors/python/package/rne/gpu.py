"""Functions of an arm on a graphics card of NVIDIA, for arrays that are on it: `Arm.gpu`."""

import difflib
import functools
import math
import operator

from ._rne import GpuArm
from .device_arrays import DeviceArray, empty, library_of, moved, stream_of


class Gpu:
    """The functions of an arm on a graphics card, as attributes: `inverse_dynamics(q, qd, qdd)` and so on.

    Arguments are arrays of one library, of one number type, on this card, with a row for each of N states: shape
    (N, n). They are contiguous (rows), or views that have the axis of the states last in memory (columns, such as
    `torch.empty(n, N).T`), which is the faster order; the results have the order of the arguments. A pose is twelve
    numbers, the rows of the rotation, then the origin. Several results are a tuple.

    Keywords of each function: `payload` and `parameters`, arrays with a row for each state; `out`, an array for the
    results, which has all numbers of a state side by side; `stream`, a number or an object of a stream in place of the
    current stream of the library. A call does not wait, so that a CUDA graph can contain it; the first call of a
    function translates it, so make this call, or call `prepare`, before the capture. Arrays of JAX have no stream that
    others may use: a call with them waits for the arguments and for the results.
    """

    def __init__(self, arm, device=0):
        self.device = _whole("device", device)
        if self.device < 0:
            raise ValueError(f"`device` is {device}, but it must be the number of a graphics card, counted from 0")
        self._arm, self._gpu = arm, GpuArm(arm, self.device)
        self._names, self._descriptions = set(self._gpu.functions), {}

    @property
    def card(self):
        """The name of the card."""
        return self._gpu.card

    def __repr__(self):
        return f"<functions of {self._arm.name} on {self.card}>"

    def __dir__(self):
        return [*super().__dir__(), *self._names]

    def __getattr__(self, name):
        if name.startswith("_") or name not in self._names:
            raise AttributeError(self._unknown(name))
        return functools.partial(self._call, name)

    def _unknown(self, name):
        known = self.__dict__.get("_names", ())
        meant = "".join(f"; did you mean `{word}`?" for word in difflib.get_close_matches(str(name), known, 1))
        return f"`{self.__dict__.get('_arm')!r}` has no function `{name}` on a graphics card{meant or '; `dir` lists those it has'}"

    def _told(self, function):
        if function not in self._descriptions:
            self._descriptions[function] = self._gpu.told(function)
        return self._descriptions[function]

    def prepare(self, *functions, dtype="float32", rollout=False, payload=False):
        """Translates functions, with `rollout=True` rollouts by forward dynamics, before a CUDA graph is captured.

        payload: whether the calls will have the keyword `payload`.
        """
        is_double = _kind("`dtype` is", getattr(dtype, "__name__", str(dtype).rpartition(".")[2])) == "float64"
        names = list(functions or ([] if rollout else ["inverse_dynamics"]))
        work = [(name, False) for name in names] + [("forward_dynamics", True)] * bool(rollout)
        work = [(f"{name}_with_payload" if payload else name, is_rollout) for name, is_rollout in work]
        for name, is_rollout in work:
            if name not in self._names and not is_rollout:
                raise ValueError(self._unknown(name))
            self._gpu.prepare(name, is_double, is_rollout)

    def _call(self, function, *arguments, payload=None, out=None, stream=None, **keywords):
        if payload is not None:
            if f"{function}_with_payload" not in self._names:
                raise TypeError(f"`{function}` takes no payload")
            function, keywords = f"{function}_with_payload", {**keywords, "payload": payload}
        told, results = self._told(function)
        given = _given(function, [name for name, _ in told], arguments, keywords)
        batch = _Batch(self.device, {name: (given[name], (elements,)) for name, elements in told})
        sizes = [math.prod(shape) * (12 if is_pose else 1) for shape, is_pose in results]
        (room,) = batch.room([("out", (sum(sizes),))], None if out is None else [out])
        self._launch(batch, function, [room], stream)
        if len(results) == 1:
            shape, is_pose = results[0]
            return batch.shaped(room, 0, sizes[0], (*shape, 12) if is_pose else shape)
        ends = [sum(sizes[: index + 1]) for index in range(len(sizes))]
        return tuple(
            batch.shaped(room, end - size, end, (*shape, 12) if is_pose else shape)
            for end, size, (shape, is_pose) in zip(ends, sizes, results)
        )

    def rollout(self, q, qd, tau, step, *, every=1, payload=None, parameters=None, out=None, stream=None, **others):
        """States of N samples after each of T steps under torques, by semi-implicit Euler, in one launch.

        The steps are those of `Arm.rollout` without friction and limits, with the same bits. q, qd: shape (N, n). tau:
        shape (N, T, n). every: the states after the steps every, 2 every, … are returned: 1 for all, T for the last
        state alone. out: two arrays for the positions and velocities. Returns q and qd, of shape (N, T // every, n). As
        columns, tau is a view such as `torch.empty(T, n, N).movedim(-1, 0)`.
        """
        if others:
            raise TypeError(
                f"`rollout` on a graphics card has no argument `{next(iter(others))}`: it has neither friction nor limits, "
                "and `Arm.rollout` on the processor has both"
            )
        function = "forward_dynamics" if payload is None else "forward_dynamics_with_payload"
        given = {"q": q, "qd": qd, "tau": tau, "payload": payload, "parameters": parameters}
        given = {name: value for name, value in given.items() if value is not None}
        told, results = self._told(function)
        given = _given("rollout", [name for name, _ in told], (), given)
        shape = tuple(getattr(tau, "shape", ()))
        (dof,) = results[0][0]
        if len(shape) != 3 or shape[2] != dof or 0 in shape[1:]:
            raise ValueError(f"`tau` has the shape {shape}, but it must be (N, T, {dof}), with at least one step")
        steps, every = shape[1], _whole("every", every)
        if not 1 <= every <= steps:
            raise ValueError(f"`every` is {every}, but it must be from 1 to the number of steps, {steps}")
        shapes = {name: (given[name], (steps, dof) if name == "tau" else (elements,)) for name, elements in told}
        batch = _Batch(self.device, shapes)
        part = (steps // every, dof)
        rooms = batch.room([("out[0]", part), ("out[1]", part)], out)
        self._launch(batch, function, rooms, stream, (steps, _real("step", step), every))
        return tuple(batch.shaped(room, 0, part[0], part) for room in rooms)

    def _launch(self, batch, function, rooms, stream, rollout=None):
        handle, waits = stream_of(batch.library, batch.first, stream, self.device)
        addresses = [array.address for array in batch.arrays.values()], [room.address for room in rooms]
        is_double = batch.kind == "float64"
        self._gpu.launch(function, is_double, batch.is_columns, batch.states, *addresses, handle, rollout)
        if waits:
            self._gpu.wait(handle)


def _given(function, names, arguments, keywords):
    """The arguments by their names."""
    given = dict(zip(names, arguments))
    unknown = [name for name in keywords if name not in names]
    if unknown[:1] == ["parameters"]:
        raise TypeError("this arm has no run-time parameters; `rne.load(…, run_time=[…])` leaves some free")
    if unknown:
        raise TypeError(f"`{function}` has no argument `{unknown[0]}`; it takes {', '.join(names)}")
    if len(arguments) > len(names) or given.keys() & keywords.keys():
        raise TypeError(f"`{function}` takes {', '.join(names)}, each once")
    given.update(keywords)
    missing = [name for name in names if name not in given]
    if missing:
        remedy = ", an array with a row for each state" if missing[0] == "parameters" else ""
        raise TypeError(f"`{function}` needs `{missing[0]}`{remedy}; it takes {', '.join(names)}")
    return given


def _kind(what, kind):
    if kind not in ("float32", "float64"):
        raise TypeError(f"{what} {kind}, but it must be float32 or float64")
    return kind


def _whole(name, value):
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"`{name}` is {value!r}, but it must be a whole number") from None


def _real(name, value):
    try:
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"`{name}` is {value!r}, but it must be a number") from None


class _Batch:
    """The arrays of a call: of one library, one number type, one order and one card."""

    def __init__(self, device, given):
        self.device, self.arrays = device, {}
        self.first = next(value for value, _ in given.values())
        self.library = library_of(self.first)
        for name, (value, shape) in given.items():
            if library_of(value) == "jax":
                value.block_until_ready()
            array = DeviceArray.of(name, value)
            if library_of(value) != self.library:
                raise TypeError(f"`{name}` is of {library_of(value)}, but others are of {self.library}: use one library")
            self.arrays[name] = self._checked(name, array, shape)
        self.kind = next(iter(self.arrays.values())).kind
        self.states = next(iter(self.arrays.values())).shape[0]
        orders = {name: array.orders() for name, array in self.arrays.items()}
        for name, array in self.arrays.items():
            if array.kind != self.kind:
                first = next(iter(self.arrays))
                raise TypeError(f"`{name}` is of {array.kind}, but `{first}` is of {self.kind}: use one number type")
            if array.shape[0] != self.states:
                first = next(iter(self.arrays))
                raise ValueError(f"`{name}` has {array.shape[0]} rows, but `{first}` has {self.states}: one for each state")
            if not orders[name]:
                raise ValueError(f"`{name}` is not contiguous; make a copy that is, in the order of the other arrays")
        common = set.intersection(*orders.values())
        if not common:
            named = ", ".join(f"`{name}` in {'/'.join(sorted(order))}" for name, order in orders.items())
            raise ValueError(f"the arrays are in rows and in columns ({named}); give all of them in one order")
        self.is_columns = "rows" not in common

    def _checked(self, name, array, shape):
        _kind(f"`{name}` is of", array.kind)
        if array.device is not None and array.device != self.device:
            raise ValueError(f"`{name}` is on graphics card {array.device}, but the arm is on card {self.device}")
        wanted = f"(N, {', '.join(map(str, shape))})"
        if len(array.shape) < 2 or math.prod(array.shape[1:]) != math.prod(shape):
            raise ValueError(f"`{name}` has the shape {array.shape}, but it must be {wanted}")
        if array.address % array.size:
            raise ValueError(
                f"`{name}` begins at the address {array.address:#x}, but it must be a multiple of {array.size} bytes: make a copy"
            )
        return array

    def room(self, parts, out):
        """Arrays for results: those of the caller, or new ones of the library."""
        count = len(parts) if out is None else len(out) if hasattr(out, "__len__") else 1
        if count != len(parts):
            raise ValueError(f"`out` has {count} arrays, but it must have {len(parts)}: for positions and for velocities")
        rooms = []
        for index, (name, shape) in enumerate(parts):
            axes = (*shape, self.states) if self.is_columns else (self.states, *shape)
            value = empty(self.library, self.first, axes) if out is None else out[index]
            array = DeviceArray.of(name, value)
            if out is None:
                array.value = moved(self.library, value) if self.is_columns else value
                rooms.append(array)
                continue
            self._checked(name, array, shape)
            if array.is_read_only:
                raise ValueError(f"`{name}` can only be read")
            order = "columns" if self.is_columns else "rows"
            if array.shape[0] != self.states or array.kind != self.kind or order not in array.orders():
                raise ValueError(
                    f"`{name}` has the shape {array.shape} and is of {array.kind}; it must have {self.states} states of "
                    f"{self.kind}, and be contiguous in {order} as the arguments are"
                )
            taken = [*self.arrays.items(), *((one.name, one) for one in rooms)]
            for other, argument in taken:
                if array.overlaps(argument):
                    raise ValueError(f"`{name}` shares memory with `{other}`; use an array of its own")
            rooms.append(array)
        return rooms

    def shaped(self, room, start, end, shape):
        """Some results of each state, in their shape."""
        part = room.value
        if len(part.shape) == 2 and part.shape[1] != end - start:
            part = part[:, start:end]
        return part if tuple(part.shape[1:]) == tuple(shape) else part.reshape(self.states, *shape)
