"""The inner loops: what the rest of the library spends its time in."""

from preshape.kernel.active import active_kernel, compiled
from preshape.kernel.box_exponentials import box_exponentials
from preshape.kernel.chebyshev_exponentials import chebyshev_derivative, chebyshev_values, orthonormal_series
from preshape.kernel.divided_exponentials import DividedExponentials, near_rates
from preshape.kernel.driven_extremum import Extremum, extremum
from preshape.kernel.driven_output import DrivenOutput
from preshape.kernel.driven_phasors import DrivenPhasors, driven_phasors, taylor_shifted
from preshape.kernel.driven_settling import last_outside
from preshape.kernel.driven_tail import free_phasors, rested, trend
from preshape.kernel.exponential_sum import exponential_sum, exponential_sum_uniform
from preshape.kernel.modal_scan import scanned_outputs, twice_summed
from preshape.kernel.phi_functions import phi_functions
from preshape.kernel.polynomial_extremum import polynomial_extremum
from preshape.kernel.sparse_convolution import sparse_convolve
from preshape.kernel.stream_reference import EngineLike, ReferenceEngine
from preshape.kernel.stream_rings import Taps

__all__ = [
    "DividedExponentials",
    "DrivenOutput",
    "DrivenPhasors",
    "EngineLike",
    "Extremum",
    "ReferenceEngine",
    "Taps",
    "active_kernel",
    "box_exponentials",
    "chebyshev_derivative",
    "chebyshev_values",
    "compiled",
    "driven_phasors",
    "exponential_sum",
    "exponential_sum_uniform",
    "extremum",
    "free_phasors",
    "last_outside",
    "near_rates",
    "orthonormal_series",
    "phi_functions",
    "polynomial_extremum",
    "rested",
    "scanned_outputs",
    "sparse_convolve",
    "taylor_shifted",
    "trend",
    "twice_summed",
]
