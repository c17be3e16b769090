"""How fast: stage by stage, against a twin of the paper's method, as recordings grow."""

import os

# before NumPy is loaded: processor time counts threads of BLAS that only wait
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
