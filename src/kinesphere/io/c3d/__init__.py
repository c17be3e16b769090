"""C3D files, read and written without loss."""

from kinesphere.io.c3d.read import read_c3d as read_c3d
from kinesphere.io.c3d.write import write_c3d as write_c3d
