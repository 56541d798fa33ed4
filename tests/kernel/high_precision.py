"""Complex numbers of 160 digits, with the exponential: the independent reference of the kernel's own arithmetic.

Power series in the decimal module; slow, and only for tests.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Context, Decimal, localcontext

import numpy as np

DIGITS = 160

CONTEXT = Context(prec=DIGITS, Emin=-999_999, Emax=999_999)

NEGLIGIBLE = Decimal(10) ** -(DIGITS + 5)

Number = "Exact | float | int | complex | Decimal"


@dataclass(frozen=True)
class Exact:
    """re + i im to 160 digits."""

    re: Decimal
    im: Decimal = Decimal(0)

    @classmethod
    def of(cls, value: Number) -> Exact:
        """A Python number, exactly."""
        if isinstance(value, Exact):
            return value
        if isinstance(value, complex):
            return cls(Decimal(value.real), Decimal(value.imag))
        return cls(Decimal(value))

    def __add__(self, other: Number) -> Exact:
        o = Exact.of(other)
        return Exact(CONTEXT.add(self.re, o.re), CONTEXT.add(self.im, o.im))

    def __sub__(self, other: Number) -> Exact:
        o = Exact.of(other)
        return Exact(CONTEXT.subtract(self.re, o.re), CONTEXT.subtract(self.im, o.im))

    def __mul__(self, other: Number) -> Exact:
        o = Exact.of(other)
        with localcontext(CONTEXT):
            return Exact(self.re * o.re - self.im * o.im, self.re * o.im + self.im * o.re)

    def __truediv__(self, other: Number) -> Exact:
        o = Exact.of(other)
        with localcontext(CONTEXT):
            size = o.re * o.re + o.im * o.im
            return Exact(
                (self.re * o.re + self.im * o.im) / size,
                (self.im * o.re - self.re * o.im) / size,
            )

    def exp(self) -> Exact:
        """exp by its power series, the argument halved until it is small."""
        halvings = 0
        small = self
        while abs(small.re) + abs(small.im) > Decimal("0.25"):
            small, halvings = small * Decimal("0.5"), halvings + 1
        term = total = Exact(Decimal(1))
        n = 0
        while abs(term.re) + abs(term.im) > NEGLIGIBLE:
            n += 1
            term = term * small / n
            total = total + term
        for _ in range(halvings):
            total = total * total
        return total

    def __complex__(self) -> complex:
        return complex(float(self.re), float(self.im))


def divided_difference(nodes: list[Exact], values: list[Exact]) -> Exact:
    """f[d_0 ... d_n] by Newton's table; the nodes must differ."""
    table = list(values)
    for level in range(1, len(nodes)):
        table = [(table[i + 1] - table[i]) / (nodes[i + level] - nodes[i]) for i in range(len(table) - 1)]
    return table[0]


def dot(a: list[Decimal], b: list[Decimal]) -> Decimal:
    """sum a_i b_i in 160 digits."""
    with localcontext(CONTEXT):
        return sum((x * y for x, y in zip(a, b, strict=True)), Decimal(0))


def orthonormal(vectors: list[list[Decimal]]) -> tuple[np.ndarray, np.ndarray]:
    """Gram-Schmidt in 160 digits, the largest rest first: the rows, and how much was left of each."""
    rest, basis, left = [list(vector) for vector in vectors], [], []
    with localcontext(CONTEXT):
        while rest:
            sizes = [dot(vector, vector) for vector in rest]
            chosen = max(range(len(rest)), key=sizes.__getitem__)
            length = sizes[chosen].sqrt()
            one = [x / length for x in rest.pop(chosen)]
            shares = [dot(vector, one) for vector in rest]
            rest = [
                [x - share * y for x, y in zip(vector, one, strict=True)]
                for vector, share in zip(rest, shares, strict=True)
            ]
            basis.append([float(x) for x in one])
            left.append(float(length))
    return np.array(basis), np.array(left)
