"""Kernels of the markerless tracker: arrays in, arrays out."""
