"""Functions of an arm for JAX, computed by the machine inside the programs that XLA compiles: `Arm.jax`."""

import functools
import math
import pathlib
import re
import warnings

import numpy as np

from ._rne import xla_handler
from .derivatives import Point, derivatives
from .names import of_content
from .signatures import of_arm, title

#: The name of the machine in the programs of XLA.
TARGET = "rne"


def functions(arm, frame):
    """The functions of an arm, of the tip or of a frame; the same object for the same arm, so that JAX compiles once."""
    try:
        import jax
        import jax.ffi
    except ImportError as error:
        raise ImportError("`Arm.jax` needs the package jax, 0.5 or later: pip install jax") from error
    _register()
    # a compiled program may outlive this process in JAX's cache
    name = of_content(arm, frame)
    found = _KNOWN.get(name)
    if found is None:
        found = _KNOWN.setdefault(name, Functions(arm, frame, name))
    return found


#: Arms are kept by XLA's programs anyway, as long as the process lives.
_KNOWN = {}


@functools.cache
def _register():
    import jax

    jax.ffi.register_ffi_target(TARGET, xla_handler(*version()), platform="cpu")


def version():
    """The version of XLA's foreign-function interface, as the header says that JAX brings."""
    import jax

    header = pathlib.Path(jax.ffi.include_dir(), "xla/ffi/api/c_api.h").read_text(encoding="utf-8")
    return [int(re.search(rf"#define XLA_FFI_API_{part} (\d+)", header)[1]) for part in ("MAJOR", "MINOR")]


class Functions:
    """The functions of an arm for JAX, as attributes: `inverse_dynamics(q, qd, qdd)` and so on."""

    def __init__(self, arm, frame, name):
        arm._for_xla(name, frame)
        self._title = title(arm, frame)
        # those that have none at a frame are those of the tip, with its derivatives
        self._all = {} if frame is None else dict(functions(arm, None)._all)
        for signature in of_arm(arm, frame):
            self._all[signature.name] = _Function(self._all, name, signature, frame is None)
        vars(self).update({method: one.call for method, one in self._all.items()})

    def __repr__(self):
        import jax

        precision = "float32 and float64" if jax.config.jax_enable_x64 else "float32, for jax_enable_x64 is off"
        return f"<functions of {self._title} for JAX: {precision}>"


class _Function:
    """A function: `call` as users call it, `derived` on arrays of one type and as many leading axes."""

    def __init__(self, others, arm, signature, at_tip):
        import jax

        self.others, self.arm, self.signature, self.at_tip = others, arm, signature, at_tip
        self.derived = jax.custom_jvp(self.computed)
        self.derived.defjvp(self.tangent, symbolic_zeros=True)
        self.call = signature.entitled(self._call(), "JAX")

    def _call(self):
        import jax
        import jax.numpy as jnp

        def call(*arguments, **keywords):
            given = self.signature.given(arguments, keywords)
            if not jax.config.jax_enable_x64 and any(getattr(one, "dtype", None) == np.float64 for one in given):
                warnings.warn(
                    "arrays of float64 are computed in float32, because JAX's option jax_enable_x64 is off; "
                    'jax.config.update("jax_enable_x64", True) turns it on',
                    stacklevel=2,
                )
            arrays = [jnp.asarray(one) for one in given]
            kinds = [array.dtype for array in arrays]
            for name, kind in zip(self.signature.shapes, kinds):
                if not (jnp.issubdtype(kind, jnp.floating) or jnp.issubdtype(kind, jnp.integer)):
                    raise TypeError(f"`{name}` is an array of {kind}, but it must be one of real numbers")
            floats = [kind for kind in kinds if jnp.issubdtype(kind, jnp.floating)]
            kind = jnp.result_type(*floats, jnp.float32) if floats else jnp.result_type(float)
            flat = []
            for (name, shape), array in zip(self.signature.shapes.items(), self.signature.aligned(arrays)):
                leading, size = array.shape[: array.ndim - len(shape)], math.prod(shape)
                if name == "pose":
                    size = 12
                    array = jnp.concatenate([array[..., :3, :3].reshape(*leading, 9), array[..., :3, 3]], -1)
                flat.append(array.astype(kind).reshape(*leading, size))
            return self.derived(*flat)

        return call

    def computed(self, *arrays):
        """The results by one call of the machine."""
        import jax
        import jax.numpy as jnp

        leading = jnp.broadcast_shapes(*(array.shape[:-1] for array in arrays))
        shapes = [(shape[:-2], True) if is_pose else (shape, False) for shape, is_pose in self.signature.results]
        sizes = [math.prod(shape) * (12 if is_pose else 1) for shape, is_pose in shapes]
        result = jax.ShapeDtypeStruct((*leading, sum(sizes)), arrays[0].dtype)
        call = jax.ffi.ffi_call(TARGET, result, vmap_method="expand_dims")
        numbers = call(*arrays, arm=self.arm, function=self.signature.function)
        parts, start = [], 0
        for (shape, is_pose), size in zip(shapes, sizes):
            part = numbers if size == result.shape[-1] else numbers[..., start : start + size]
            start += size
            if is_pose:
                part = part.reshape(*leading, *shape, 12)
                turn = part[..., :9].reshape(*leading, *shape, 3, 3)
                above = jnp.concatenate([turn, part[..., 9:, None]], -1)
                last = jnp.broadcast_to(jnp.array([0, 0, 0, 1], part.dtype), (*leading, *shape, 1, 4))
                parts.append(jnp.concatenate([above, last], -2))
            else:
                parts.append(part.reshape(*leading, *shape))
        return parts[0] if len(parts) == 1 else tuple(parts)

    def tangent(self, primals, tangents):
        """The product of the derivatives and the tangents, which XLA transposes."""
        import jax
        import jax.numpy as jnp

        def compute(name, arguments):
            other = self.others[name]
            return other.derived(*[arguments[argument] for argument in other.signature.shapes])

        name, names = self.signature.name, list(self.signature.shapes)
        point = Point(compute, dict(zip(names, primals)), jnp, self.at_tip)
        results = point.of(name)
        parts = list(results) if isinstance(results, tuple) else [results]
        totals = [jnp.zeros_like(part) for part in parts]
        for argument, tangent in zip(names, tangents):
            if isinstance(tangent, jax.custom_derivatives.SymbolicZero):
                continue
            for index, derivative in enumerate(derivatives(name, argument, point)):
                if derivative is not None:
                    matrix = self.signature.matrix(derivative, index)
                    product = jnp.einsum("...ij,...j->...i", matrix, tangent)
                    whole = (*parts[index].shape[: primals[0].ndim - 1], matrix.shape[-2])
                    totals[index] += jnp.broadcast_to(product, whole).reshape(parts[index].shape)
        return results, tuple(totals) if isinstance(results, tuple) else totals[0]
