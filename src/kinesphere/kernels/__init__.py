"""Numba kernels shared by several rooms: arrays in, arrays out, never raise, never print."""
