"""Settings that a firmware would refuse are refused in a sentence."""

from __future__ import annotations

import pytest
from tests.export.exports import executed

from preshape.errors import InputError


@pytest.mark.parametrize(
    ("target", "version", "text", "sentence"),
    [
        ("klipper", None, "shaper_type_x: zvx\nshaper_freq_x: 50", "has no shaper 'zvx': it has zv, mzv"),
        ("klipper", "old", "shaper_type_x: mzv(n=4,t=0.9)\nshaper_freq_x: 50", "mzv takes no parameters in this"),
        ("klipper", None, "shaper_type_x: mzv(n=5.0,t=1.1)\nshaper_freq_x: 50", "whole numbers from 3 to 10"),
        ("klipper", None, "shaper_type_x: mzv(n=5,t=1.1,tau=2.0)\nshaper_freq_x: 50", "t or tau, not both"),
        ("klipper", None, "shaper_type_x: mzv(m=5)\nshaper_freq_x: 50", "takes n and t and tau, each once"),
        ("klipper", None, "shaper_type_x: mzv(n=-5)\nshaper_freq_x: 50", "is not understood"),
        ("klipper", None, "shaper_type_x: zv\nshaper_freq_x: fast", "shaper_freq_x holds 'fast': give a number"),
        ("klipper", None, "shaper_type_x: zv", "no shaper is set"),
        ("klipper", None, "shaper_type_x: 3hump_ei\nshaper_freq_x: 50\ndamping_ratio_x: 0.25", "above 0.2"),
        ("klipper", None, "[printer]\nkinematics: corexy", "no section \\[input_shaper\\]"),
        ("klipper", None, "[[[", "no Klipper configuration|no section"),
        (
            "kalico",
            None,
            "shaper_type_x: smooth_mzv\nsmoother_freq_x: 50",
            "axis x has a smoother, smooth_mzv",
        ),
        (
            "kalico",
            None,
            "shaper_type: smoother\nsmooth_time_x: 0.02\ncoeffs_x: 1,2",
            "has a smoother, smoother: only",
        ),
        ("kalico", None, "shaper_type_x: custom\nshaper_a_x: 0.5,0.5\nshaper_t_x: 0", "give as many, up to 5"),
        ("kalico", None, "shaper_type_x: custom\nshaper_a_x: 1\nshaper_t_x:", "1 amplitudes and 0 times"),
        ("kalico", None, "shaper_type_x: custom\nshaper_a_x: 0.5,0.5\nshaper_t_x: 0,0.3", "0.001 to 0.2 s"),
        (
            "kalico",
            None,
            "shaper_type_x: custom\nshaper_a_x: 0.5,0.0005,0.4995\nshaper_t_x: 0,0.01,0.02",
            "0.001 or more",
        ),
        ("kalico", None, "shaper_type_x: custom\nshaper_a_x: 0.5,0.5\nshaper_t_x: 0.01,0", "does not increase"),
        ("klipper-plugin", "old", "amplitudes_x: 1,1,1,1,1,1\ntimes_x: 0,1,2,3,4,5", "give as many, up to 5"),
        ("klipper-plugin", None, "amplitudes_x: 1,1\ntimes_x: 0,0", "do not increase"),
        ("klipper-plugin", None, "[preshape_shaper]", "amplitudes_x and times_x are missing"),
        ("rrf", None, "M593", "no shaper is set"),
        ("rrf", None, 'M593 P"zv"', "has no shaper 'zv': it has zvd"),
        ("rrf", None, "M593 F3", "F3: this RepRapFirmware takes 4 to 1000"),
        ("rrf", "3.5", "M593 F5", "takes 5.72 to 1000"),
        ("rrf", "later", 'M593 P"ei3" F40 S0.25', "from 0 to 0.2 for ei3"),
        ("rrf", None, 'M593 P"custom"', "needs H"),
        ("rrf", None, 'M593 P"custom" H.1:.1:.1:.1:.1', "H holds 5 values"),
        ("rrf", None, 'M593 P"custom" H0.4:0.3 T0.01', "H holds 2 values and T 1"),
        ("rrf", None, 'M593 P"custom" H0.4:0.3 T0.02:0.01', "above 0 and increase"),
        ("rrf", None, 'M593 P"custom" H0.4:x', "is followed by"),
        ("rrf", None, "G1 X4", "no line with M593"),
        ("marlin", None, "M593 F0", "F is 0 or missing"),
        ("marlin", None, "M593 F40 D1.5", "from 0 to 1"),
        ("marlin-ft", None, "M493 C9 A40", "C9: Marlin has 0 to 8"),
        ("marlin-ft", None, "M493 C1", "no frequency: give A"),
        ("marlin-ft", None, "M493 C1 A40 I0.3", "from 0.01 to 0.25"),
        ("marlin-ft", None, "M493 S0 C1 A40", "S0 switches fixed-time motion off"),
        ("prusa", None, "M593 T6 F40", "T6: Prusa's firmware has 0 to 5"),
        ("prusa", None, "M593 T3 F40 R1", "give a reduction above 1"),
        ("prusa", None, "M593 T3 F40 D1", "a damping below 1"),
    ],
)
def test_what_a_firmware_refuses_is_refused_in_a_sentence(
    target: str, version: str | None, text: str, sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        executed(target, text, version)
