"""The inner loops: what the rest of the library spends its time in."""

from preshape.kernel.chebyshev_exponentials import chebyshev_derivative, chebyshev_values, orthonormal_series
from preshape.kernel.divided_exponentials import DividedExponentials, near_rates
from preshape.kernel.exponential_sum import exponential_sum, exponential_sum_uniform
from preshape.kernel.sparse_convolution import sparse_convolve

__all__ = [
    "DividedExponentials",
    "chebyshev_derivative",
    "chebyshev_values",
    "exponential_sum",
    "exponential_sum_uniform",
    "near_rates",
    "orthonormal_series",
    "sparse_convolve",
]
