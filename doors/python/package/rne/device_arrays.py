"""Arrays on a graphics card: what they are, new ones, and the streams of their libraries.

An array is read by the interface of CUDA's arrays (`__cuda_array_interface__`: PyTorch, CuPy, JAX, Numba) or else by
DLPack. Neither copies it.
"""

import ctypes
import math

#: The kinds of memory of DLPack that a card reaches: its own, and managed memory.
_ON_CARD = (2, 13)
_KINDS = {"<f4": "float32", "<f8": "float64"}
#: PyTorch's, CuPy's and numpy's own default stream has this number.
DEFAULT_STREAM = 0


class DeviceArray:
    """An array on a card: its address, shape, strides in numbers, number type, and card where it is known."""

    def __init__(self, name, value, address, shape, strides, kind, device, is_read_only=False):
        self.name, self.value, self.address, self.shape = name, value, address, shape
        self.strides, self.kind, self.device, self.is_read_only = strides, kind, device, is_read_only

    @classmethod
    def of(cls, name, value):
        """Reads an array, or says why it is none."""
        place = getattr(value, "__dlpack_device__", lambda: None)()
        if place is not None and int(place[0]) not in _ON_CARD:
            raise ValueError(f"`{name}` is not on a graphics card of NVIDIA: copy it there, or call the function of the arm")
        device = None if place is None else int(place[1])
        try:
            interface = getattr(value, "__cuda_array_interface__", None)
        except Exception as error:  # PyTorch: of a tensor that requires a gradient
            raise ValueError(f"`{name}`: {error}") from None
        if interface is not None:
            kind, shape = interface["typestr"], tuple(interface["shape"])
            kind = _KINDS.get(kind, kind)
            address, is_read_only = interface["data"]
            strides = interface.get("strides")
            # a stride that is no whole number of numbers stays a fraction, which no contiguous array has
            size = _bytes_of(kind)
            strides = _contiguous(shape) if strides is None else tuple(stride / size for stride in strides)
            return cls(name, value, address or 0, shape, strides, kind, device, is_read_only)
        if place is not None and hasattr(value, "__dlpack__"):
            return cls(name, value, *_of_dlpack(value), device)
        raise TypeError(
            f"`{name}` is a {type(value).__name__}, but it must be an array on a graphics card: of PyTorch, CuPy, JAX or "
            "another library with DLPack"
        )

    def orders(self):
        """The orders in which the numbers lie without gaps: rows, columns, both or none."""
        axes = [(size, stride) for size, stride in zip(self.shape, self.strides)]
        found = set()
        for order, axes in (("rows", axes), ("columns", axes[1:] + axes[:1])):
            shape, strides = zip(*axes)
            pairs = zip(shape, strides, _contiguous(shape))
            if 0 in shape or all(size == 1 or stride == wanted for size, stride, wanted in pairs):
                found.add(order)
        return found

    @property
    def size(self):
        """The bytes of a number."""
        return _bytes_of(self.kind)

    def overlaps(self, other):
        """Whether memory is shared; both are contiguous."""
        (start, end), (begin, finish) = self._memory(), other._memory()
        return start < finish and begin < end

    def _memory(self):
        return self.address, self.address + math.prod(self.shape) * self.size


def _bytes_of(kind):
    return 8 if kind == "float64" else 4


def _contiguous(shape):
    return tuple(math.prod(shape[axis + 1 :]) for axis in range(len(shape)))


class _Tensor(ctypes.Structure):
    """DLPack's DLTensor."""

    _fields_ = [
        ("data", ctypes.c_void_p),
        ("device_type", ctypes.c_int32),
        ("device_id", ctypes.c_int32),
        ("ndim", ctypes.c_int32),
        ("code", ctypes.c_uint8),
        ("bits", ctypes.c_uint8),
        ("lanes", ctypes.c_uint16),
        ("shape", ctypes.POINTER(ctypes.c_int64)),
        ("strides", ctypes.POINTER(ctypes.c_int64)),
        ("byte_offset", ctypes.c_uint64),
    ]


def _of_dlpack(value):
    """Address, shape, strides and number type; the capsule frees what it holds, and `value` lives on."""
    capsule = value.__dlpack__()
    pointer = ctypes.pythonapi.PyCapsule_GetPointer
    pointer.restype, pointer.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    tensor = _Tensor.from_address(pointer(capsule, b"dltensor"))
    shape = tuple(tensor.shape[: tensor.ndim])
    strides = tuple(tensor.strides[: tensor.ndim]) if tensor.strides else _contiguous(shape)
    kind = f"float{tensor.bits}" if (tensor.code, tensor.lanes) == (2, 1) else f"type {tensor.code}, {tensor.bits} bits"
    return (tensor.data or 0) + tensor.byte_offset, shape, strides, kind


def library_of(value):
    """The name of the package of an array."""
    name = type(value).__module__.partition(".")[0]
    return "jax" if name == "jaxlib" else name


def _namespace(library, value):
    if library in ("torch", "cupy"):
        return __import__(library)
    if library == "jax":
        return __import__("jax").numpy
    if hasattr(value, "__array_namespace__"):
        return value.__array_namespace__()
    raise TypeError(f"rne cannot make arrays of {library}: give `out=`, and all arrays in rows")


def empty(library, value, shape):
    """A new array beside `value`, of its number type."""
    space = _namespace(library, value)
    if library == "cupy":
        with value.device:
            return space.empty(shape, dtype=value.dtype)
    made = space.empty(shape, dtype=value.dtype, device=value.device)
    return made.block_until_ready() if library == "jax" else made


def moved(library, value):
    """The same numbers with the last axis first."""
    space = _namespace(library, value)
    return space.movedim(value, -1, 0) if library == "torch" else space.moveaxis(value, -1, 0)


def stream_of(library, value, stream, device):
    """The handle of the stream of a call, and whether the call waits."""
    if stream is not None:
        if hasattr(stream, "__cuda_stream__"):
            return int(stream.__cuda_stream__()[1]), False
        handle = getattr(stream, "cuda_stream", getattr(stream, "ptr", stream))
        if not isinstance(handle, int) or handle < 0:
            raise TypeError(f"`stream` is {stream!r}, but it must be a stream of PyTorch or CuPy, or its number")
        return handle, False
    if library == "torch":
        import torch

        return torch.cuda.current_stream(device).cuda_stream, False
    if library == "cupy":
        import cupy

        return cupy.cuda.get_current_stream().ptr, False
    if library == "jax":
        return DEFAULT_STREAM, True
    interface = getattr(value, "__cuda_array_interface__", None) or {}
    return interface.get("stream") or DEFAULT_STREAM, False
