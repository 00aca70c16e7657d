"""Lets PyTorch's tensors of the processor pass for tensors on a card, with the fake driver: for tests of what PyTorch does
with shapes, strides and new tensors."""

import ctypes
import types


def pretend(torch, library):
    """All tensors of this process are on the card 0 of the fake driver from now on."""
    driver = ctypes.CDLL(str(library))

    def interface(tensor):
        size = tensor.element_size()
        address = tensor.data_ptr()
        whole = tensor.untyped_storage()
        driver.fakeMap(ctypes.c_uint64(whole.data_ptr()), ctypes.c_size_t(whole.nbytes()))
        kind = {torch.float32: "<f4", torch.float64: "<f8"}.get(tensor.dtype, str(tensor.dtype))
        strides = tuple(size * stride for stride in tensor.stride())
        return {"shape": tuple(tensor.shape), "typestr": kind, "strides": strides, "data": (address, False), "version": 2}

    torch.Tensor.__cuda_array_interface__ = property(interface)
    torch.Tensor.__dlpack_device__ = lambda tensor: (2, 0)
    torch.cuda.current_stream = lambda device=None: types.SimpleNamespace(cuda_stream=9)
