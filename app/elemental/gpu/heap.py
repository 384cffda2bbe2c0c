"""The C library's heap, where the driver runs on the CPU."""

from __future__ import annotations

import ctypes

M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3
"""Parameters of glibc's mallopt()."""
KEPT_BYTES = 256 << 20
"""Free memory at the heap's top that the process keeps."""
HEAP_BLOCK_BYTES = 32 << 20
"""Blocks up to here come from the heap; glibc allows no more."""


def keep_freed_memory() -> None:
    """Keep the heap's size between draws, where the C library is glibc.

    llvmpipe allocates the vertices of each draw and frees them after it. glibc then returns the top
    of the heap to the kernel, and the next draw faults each page in again: half the time of many
    small draws.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(M_TRIM_THRESHOLD, KEPT_BYTES)
        mallopt(M_MMAP_THRESHOLD, HEAP_BLOCK_BYTES)
