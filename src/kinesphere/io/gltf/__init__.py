"""glTF 2.0, the format of 3-D programs and browsers: skeleton, skin, animation, markers."""

from kinesphere.io.gltf.write import write_gltf as write_gltf
from kinesphere.io.gltf.write import write_solution_gltf as write_solution_gltf
