"""Whether modes at integer multiples m_i of a common frequency have an antiperiod: two tests that agree.

An antiperiod T is an odd number of half periods of every mode, T = (2 v_i + 1) pi / (m_i w_c) for whole v_i. With
greatest common divisor 1 this needs all m_i odd, and then v_i = (m_i - 1) / 2 solves it: T = pi / w_c. (The paper
calls odd m_i necessary but not sufficient; they are both.)

The paper asks instead whether the Diophantine system 2 m_j v_i - 2 m_i v_j = m_i - m_j has a solution: the greatest
common divisor of the largest minors of its coefficient matrix must equal that of the augmented matrix. Of the
N (N - 1) / 2 equations N - 1 are independent; of those that hold v_1 and one other unknown the minors are, up to sign,

    (2 m_1)^(N-2) 2 m_j          leaving out column j of the coefficients,
    (2 m_1)^(N-2) (m_j - m_k)    leaving out columns j and k, the right-hand side instead,

so both divisors are known without a determinant, and they are equal exactly if 2 divides every m_j - m_k.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from preshape.checks import whole_number
from preshape.errors import InputError

__all__ = ["all_odd", "diophantine_divisors"]

LARGEST = 10**9


def all_odd(integers: Iterable[int]) -> bool:
    """Whether all are odd after division by their greatest common divisor: then, and only then, an antiperiod exists.

    Parameters
    ----------
    integers : iterable of int
        m_i, the modes' frequencies as multiples of a common one, each at least 1.

    Raises
    ------
    InputError
        If there is none, or one is not a whole number above zero.

    Examples
    --------
    >>> all_odd([6, 21, 77]), all_odd([21, 77]), all_odd([2, 6])
    (False, True, True)
    """
    multiples = _checked(integers)
    divisor = math.gcd(*multiples)
    return all((m // divisor) % 2 == 1 for m in multiples)


def diophantine_divisors(integers: Iterable[int]) -> tuple[int, int]:
    """The paper's two greatest common divisors: of the coefficient matrix' minors, and of the augmented matrix'.

    The system has a solution, and an antiperiod exists, if they are equal. The equations used are those that hold the
    first integer and one other (in the paper's example the first two rows); with another choice both divisors change,
    what they say does not.

    Parameters
    ----------
    integers : iterable of int
        m_i, the modes' frequencies as multiples of a common one, each at least 1.

    Returns
    -------
    (int, int)
        Both 1 for a single mode, which has no equation to satisfy.

    Raises
    ------
    InputError
        If there is none, or one is not a whole number above zero.

    References
    ----------
    Singh & Heppler (1993), eq. 12-20.

    Examples
    --------
    >>> diophantine_divisors([6, 21, 77])
    (24, 12)
    """
    multiples = _checked(integers)
    if len(multiples) == 1:
        return 1, 1
    power = (2 * multiples[0]) ** (len(multiples) - 2)
    coefficients = 2 * math.gcd(*multiples)
    return power * coefficients, power * math.gcd(coefficients, *(m - multiples[0] for m in multiples[1:]))


def _checked(integers: Iterable[int]) -> list[int]:
    multiples = [whole_number("an integer multiple", value, 1, LARGEST) for value in integers]
    if not multiples:
        raise InputError("no integer was given: give one a mode, such as (1, 7).")
    return multiples
