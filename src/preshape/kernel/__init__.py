"""The inner loops: what the rest of the library spends its time in."""

from preshape.kernel.exponential_sum import exponential_sum, exponential_sum_uniform
from preshape.kernel.sparse_convolution import sparse_convolve

__all__ = ["exponential_sum", "exponential_sum_uniform", "sparse_convolve"]
