"""Rotations, rigid fits, planes, spheres, chains: arrays in, arrays out."""
