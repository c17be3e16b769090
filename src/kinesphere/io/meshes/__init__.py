"""Meshes that somebody brings: OBJ, PLY, STL, glTF."""
