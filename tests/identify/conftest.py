"""One thread for linear algebra: the matrices are small, and test workers already fill the cores."""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
