"""Meshes that somebody brings: OBJ, PLY, STL, glTF."""

from kinesphere.io.meshes.read import read_mesh as read_mesh
