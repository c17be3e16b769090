"""What the kernels are given."""

import numpy as np
from numpy.typing import NDArray

Single = NDArray[np.float32]
Indices = NDArray[np.int64]
Signs = NDArray[np.int8]
