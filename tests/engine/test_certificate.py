"""The certificate: what it says holds on the continuum, survives a file, and is refused when anything is changed."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from decimal import Decimal
from pathlib import Path

import numpy as np
import pytest
from tests.kernel.high_precision import Exact, orthonormal

from preshape import Modes, Shaper, design
from preshape.engine import is_proved_shortest
from preshape.engine.basis import Basis
from preshape.engine.certify import exclusion_of
from preshape.engine.verify import basis_of
from preshape.errors import InputError
from preshape.provenance import Certificate

CASES = {
    "one": ([(3.0, 0.1)], 2),
    "linear MACE": ([(9.8, 0.0), (31.7, 0.0), (66.1, 0.0)], 1),
    "mixed orders": ([(1.0, 0.05), (2.3, 0.0), (3.1, 0.2)], (2, 0, 1)),
    "very near": ([(1.0, 0.01), (1.0005, 0.01), (2.0, 0.0)], 1),
    "odd harmonics": ([(1.0, 0.0), (3.0, 0.0), (9.0, 0.0)], 1),
    "dense": ([(1.0 + 0.1 * i, 0.01) for i in range(10)], 1),
    "twenty": ([(float(f), 0.01) for f in range(1, 21)], 1),
}
DENSE = {"dense"}
DEPENDENT = {"very near", "dense"}
"""Their plain functions are dependent to more digits than doubles have."""


def made(name: str) -> tuple[Shaper, Certificate]:
    shaper = design.direct(*CASES[name])
    assert shaper.design.certificate is not None
    return shaper, shaper.design.certificate


def plain(modes: Modes, orders: tuple[int, ...], leads: np.ndarray, duration: float) -> np.ndarray:
    """(u/T)^k exp(-s u), real and imaginary parts, written out anew."""
    rows = []
    for mode, order in zip(modes, orders, strict=True):
        w = 2.0 * math.pi * mode.frequency
        s = complex(mode.damping * w, w * math.sqrt(1.0 - mode.damping**2))
        for k in range(order + 1):
            wave = (leads / duration) ** k * np.exp(-s * leads)
            rows += [wave.real, wave.imag]
    return np.array(rows)


def digits(modes: Modes, orders: tuple[int, ...], leads: np.ndarray) -> np.ndarray:
    """Orthonormal vectors that span u^k exp(-s u) at `leads`, in 160 digits: nothing is too near there."""
    vectors: list[list[Decimal]] = []
    for mode, order in zip(modes, orders, strict=True):
        waves = [(Exact.of(mode.pole.conjugate()) * float(u)).exp() for u in leads]
        for _ in range(order + 1):
            vectors += [[wave.re for wave in waves], [wave.im for wave in waves]]
            waves = [wave * float(u) for wave, u in zip(waves, leads, strict=True)]
    return orthonormal(vectors)[0]


@pytest.mark.parametrize("name", CASES)
def test_its_polynomial_is_made_of_the_constraints_nowhere_negative_and_zero_at_the_impulses(name: str) -> None:
    """Weak duality, checked with the certificate's own data: whatever is shorter would have to live on its zeros."""
    shaper, proof = made(name)
    assert proof.holds and proof.duration == pytest.approx(shaper.duration, rel=1e-12)
    times = np.linspace(0.0, shaper.duration, 40_001)
    p = proof.polynomial(times)
    largest = np.abs(p).max()
    assert p.min() >= -1e-9 * largest
    assert np.abs(proof.polynomial(shaper.times)).max() < 1e-9 * largest
    assert proof.polynomial(0.5 * shaper.duration).shape == () and proof.polynomial([[0.0, 0.1]]).shape == (1, 2)
    if name in DEPENDENT:
        times = np.linspace(0.0, shaper.duration, 60)
        p = proof.polynomial(times)
        rows = digits(Modes(shaper.design.modes), proof.orders, shaper.duration - times)
    else:
        rows = plain(Modes(shaper.design.modes), proof.orders, shaper.duration - times, shaper.duration)
    remainder = p - np.linalg.lstsq(rows.T, p, rcond=1e-17)[0] @ rows
    assert np.abs(remainder).max() < 1e-9 * largest


@pytest.mark.parametrize("name", CASES)
def test_its_zeros_are_named_and_cannot_do_it_without_the_first_impulse(name: str) -> None:
    """No positive weights on the contacts but the first meet the constraints; with it they do. Solver: bounded l.s."""
    from scipy.optimize import lsq_linear

    shaper, proof = made(name)
    contacts = np.array(proof.contacts)
    largest = np.abs(proof.polynomial(np.linspace(0.0, shaper.duration, 1000))).max()
    assert np.abs(proof.polynomial(contacts)).max() < 1e-7 * largest
    for t in shaper.times:
        assert np.abs(contacts - t).min() < 1e-6 * shaper.duration
    basis = Basis(Modes(shaper.design.modes), proof.orders, proof.reference, proof.groups)
    misses = []
    for places in (shaper.duration - shaper.times, (shaper.duration - contacts)[1:]):
        matrix = np.concatenate([basis(places), np.ones((1, places.size))])
        answer = lsq_linear(matrix, np.eye(basis.size + 1)[-1], bounds=(0.0, np.inf), method="bvls", tol=1e-15)
        misses.append(math.sqrt(2.0 * answer.cost))
    assert contacts[0] < 1e-9 * shaper.duration
    assert misses[0] < 1e-10 and misses[1] > 100.0 * basis.rounding
    assert proof.exclusion > 100.0


@pytest.mark.parametrize("name", CASES)
def test_a_proof_survives_a_file_and_is_checked_anew(name: str, tmp_path: Path) -> None:
    shaper, proof = made(name)
    again = Shaper.from_dict(json.loads(json.dumps(shaper.to_dict())))
    assert again.design.certificate == proof
    assert is_proved_shortest(again)
    assert is_proved_shortest(Shaper.load(shaper.save(tmp_path / "shaper.json")))
    assert (proof.groups == ()) == (name in DENSE)


def tampered(shaper: Shaper, **changes: object) -> Shaper:
    """The same impulses with another certificate."""
    assert shaper.design.certificate is not None
    proof = replace(shaper.design.certificate, **changes)
    return Shaper(shaper.times, shaper.amplitudes, replace(shaper.design, certificate=proof))


@pytest.mark.parametrize("name", CASES)
def test_a_certificate_from_elsewhere_is_not_believed(name: str) -> None:
    shaper, proof = made(name)
    first, *others = proof.coefficients
    size = max(abs(value) for value in proof.coefficients)
    assert not is_proved_shortest(tampered(shaper, coefficients=tuple(-value for value in proof.coefficients)))
    assert not is_proved_shortest(tampered(shaper, coefficients=(first + 1e-3 * size, *others)))
    assert not is_proved_shortest(tampered(shaper, coefficients=tuple(0j for _ in proof.coefficients)))
    assert not is_proved_shortest(tampered(shaper, coefficients=tuple(1j * value for value in proof.coefficients)))
    assert not is_proved_shortest(tampered(shaper, duration=1.01 * proof.duration))
    # What the file says of itself changes nothing, nor does another unit of p.
    assert is_proved_shortest(tampered(shaper, minimum=-1.0, exclusion=0.0, contacts=()))
    assert is_proved_shortest(tampered(shaper, coefficients=tuple(3.0 * value for value in proof.coefficients)))


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("stretched", [0.5, 0.999, 1.001, 1.5])
def test_what_is_believed_is_a_proof(name: str, stretched: float) -> None:
    """Another reference is another polynomial, which may be a proof as well (odd harmonics): then it shows."""
    shaper, proof = made(name)
    other = tampered(shaper, reference=stretched * proof.reference)
    assert other.design.certificate is not None
    p = other.design.certificate.polynomial(np.linspace(0.0, shaper.duration, 20_001))
    if is_proved_shortest(other):
        assert p.min() >= -1e-9 * np.abs(p).max()
    else:
        assert p.min() < -1e-9 * np.abs(p).max() or name in DENSE


def test_a_polynomial_that_dips_a_little_between_impulses_is_refused() -> None:
    """From the true one towards one that is negative somewhere, in steps: only rounding is allowed."""
    shaper, proof = made("linear MACE")
    basis = Basis(Modes(shaper.design.modes), proof.orders, proof.reference, proof.groups)
    c = basis.multipliers(np.array(proof.coefficients))
    leads = shaper.duration - shaper.times[::-1]
    touching = np.concatenate([basis(leads).T, basis.slopes(basis.raw(leads), 1).T[1:-1] * basis.duration])
    free = np.random.default_rng(0).normal(size=basis.size)
    for size, accepted in ((1e-13, True), (1e-4, False), (1e-2, False)):
        bent = tuple(basis.coefficients(c + size * free))
        assert is_proved_shortest(tampered(shaper, coefficients=bent)) == accepted
    assert np.linalg.matrix_rank(touching, 1e-9) == basis.size - 1  # no other polynomial touches where this one does


def test_the_modes_of_the_proof_must_be_those_of_the_shaper() -> None:
    shaper, proof = made("linear MACE")
    moved = Modes([(9.8, 0.0), (31.7, 0.0), (66.2, 0.0)])
    assert not is_proved_shortest(tampered(shaper, modes=moved))
    elsewhere = replace(shaper.design, modes=moved, certificate=replace(proof, modes=moved))
    assert not is_proved_shortest(Shaper(shaper.times, shaper.amplitudes, elsewhere))
    assert not is_proved_shortest(Shaper(shaper.times, shaper.amplitudes, replace(shaper.design, certificate=None)))


def test_a_true_certificate_does_not_prove_another_shaper() -> None:
    shaper, proof = made("linear MACE")
    longer = design.zvd(CASES["linear MACE"][0])
    bent = shaper.amplitudes + 1e-6 * np.array([1, -1, 0, 0, 0, 0, 0, 0])
    assert not is_proved_shortest(Shaper(shaper.times, bent, shaper.design))
    assert not is_proved_shortest(Shaper(longer.times, longer.amplitudes, shaper.design))
    assert not is_proved_shortest(Shaper(longer.times, longer.amplitudes, longer.design))
    # One order less is met too, and a shorter shaper meets it: the proof of order 1 is none for it.
    zv = design.direct(CASES["linear MACE"][0], order=0)
    assert not is_proved_shortest(Shaper(zv.times, zv.amplitudes, replace(zv.design, certificate=proof)))
    # The shaper of order 1 meets order 0 as well, but it is not the shortest that does.
    lower = replace(shaper.design, certificate=zv.design.certificate)
    assert not is_proved_shortest(Shaper(shaper.times, shaper.amplitudes, lower))


@pytest.mark.parametrize("apart", [1e-6, 1e-5])
def test_a_shaper_that_misses_what_scaled_rows_hardly_show_is_refused(apart: float) -> None:
    """ZVD for one mode, said to be for that mode and one beside it: 1e-11 of vibration there, and half a second short.

    Everything else is true: its polynomial is in the span of the functions, not negative, zero at the impulses.
    """
    one = design.direct((1.0, 0.0))
    proof, two = one.design.certificate, Modes([(1.0, 0.0), (1.0 + apart, 0.0)])
    assert proof is not None
    basis, leads = Basis(two, (1, 0), proof.reference), np.linspace(0.0, 1.0, 400)
    c = np.linalg.lstsq(basis(leads).T, proof.polynomial(1.0 - leads), rcond=None)[0]
    coefficients = basis.coefficients(c)
    wrong = replace(proof, modes=two, orders=(1, 0), groups=basis.groups, coefficients=coefficients)
    np.testing.assert_allclose(wrong.polynomial(leads), proof.polynomial(leads), rtol=0.0, atol=1e-12)
    assert plain(two, (1, 0), 1.0 - one.times, 1.0)[-2:] @ one.amplitudes == pytest.approx(0.0, abs=1e-9)
    assert not is_proved_shortest(Shaper(one.times, one.amplitudes, replace(one.design, modes=two, certificate=wrong)))
    assert design.direct(two, (1, 0)).duration == pytest.approx(1.5, rel=1e-4)


def test_functions_that_were_left_out_as_dependent_prove_nothing() -> None:
    """42 functions of which doubles see 24: those are met in 6.0 s by what misses the others, met in 10.5 s."""
    near, orders = Modes([(1.0, 0.0), (1.0005, 0.0), (1.001, 0.0)]), (6, 6, 6)
    few = Basis(near, orders, 6.2, ())
    assert few.size < 42
    _, proof = made("linear MACE")
    coefficients = few.coefficients(np.eye(few.size)[0])
    wrong = replace(proof, modes=near, orders=orders, groups=(), coefficients=coefficients, reference=6.2, duration=6.0)
    assert basis_of(wrong) is None


@pytest.mark.parametrize("name", ["linear MACE", "dense"])
@pytest.mark.parametrize("factor", [1e-12, 1e-3, 1e3, 1e300])
def test_a_reference_out_of_all_proportion_is_refused_at_once(name: str, factor: float) -> None:
    """Else a file could ask for a series of a million terms, or for one that overflows."""
    shaper, proof = made(name)
    assert basis_of(proof) is not None
    assert basis_of(replace(proof, reference=factor * proof.reference)) is None
    assert not is_proved_shortest(tampered(shaper, reference=factor * proof.reference))


def test_groups_of_modes_that_are_far_apart_are_refused() -> None:
    """Their divided differences, by power series, would be some other functions."""
    _, proof = made("linear MACE")
    assert basis_of(replace(proof, groups=((0, 1, 2),))) is None
    assert basis_of(replace(proof, groups=((1,), (0, 2)))) is None


def test_only_what_is_proved_counts() -> None:
    _, proof = made("linear MACE")
    assert proof.holds
    assert not replace(proof, minimum=-1e-6).holds
    assert not replace(proof, exclusion=0.0).holds
    assert not replace(proof, exclusion=99.0).holds


@pytest.mark.parametrize("name", ["linear MACE", "very near", "dense"])
def test_contacts_that_could_do_it_earlier_are_found_out(name: str) -> None:
    """On an interval longer than needed the impulses before its end meet the constraints: no exclusion there."""
    shaper, proof = made(name)
    leads = shaper.duration - shaper.times[::-1]
    basis = Basis(Modes(shaper.design.modes), proof.orders, proof.reference, proof.groups)
    longer = 1.02 * shaper.duration
    assert exclusion_of(basis, (), np.append(leads, longer), longer) < 100.0
    assert exclusion_of(basis, (), leads, shaper.duration) > 100.0


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"orders": (1, 1)}, "do not fit 3 modes"),
        ({"orders": (1, 1, -1)}, "do not fit 3 modes"),
        ({"groups": ((0,), (1,))}, "do not name each of the 3 modes once"),
        ({"groups": ((0, 1), (1, 2))}, "do not name each of the 3 modes once"),
        ({"groups": ((0,), (1,), (3,))}, "do not name each of the 3 modes once"),
        ({"coefficients": (1j,)}, "coefficients do not fit"),
        ({"reference": 0.0}, "above 0 s"),
        ({"reference": math.nan}, "above 0 s"),
    ],
)
def test_a_certificate_that_is_none_is_refused(changes: dict[str, object], sentence: str) -> None:
    _, proof = made("linear MACE")
    with pytest.raises(InputError, match=sentence):
        replace(proof, **changes)
