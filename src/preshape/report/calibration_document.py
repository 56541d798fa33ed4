"""The report of a calibration: measurement, modes, candidates, the choice and why, what it does, settings, origin."""

from __future__ import annotations

from preshape.report.calibration import Calibration
from preshape.report.calibration_figure import calibration_figure
from preshape.report.document import Document, Heading, Paragraph, Part, Picture, RowKind, Table
from preshape.report.figures import as_svg
from preshape.report.record import Record
from preshape.report.sections import (
    export_parts,
    impulse_parts,
    prediction_parts,
    provenance_parts,
    robustness_parts,
)
from preshape.report.tables import (
    TextTable,
    candidate_table,
    exclusion_sentence,
    limit_sentence,
    mode_table,
    pick_table,
)
from preshape.report.trade_off import gain_sentences, robustness_sentence
from preshape.report.trade_off_figure import trade_off_figure

__all__ = ["calibration_document", "klipper_sentence"]


def calibration_document(
    calibration: Calibration, record: Record, figure: str | None = None, trade_off: str | None = None
) -> Document:
    """The report of a calibration.

    Parameters
    ----------
    calibration : Calibration
        From :func:`preshape.workflow.calibrate`.
    record : Record
        What it was made from.
    figure : str, optional
        The figure as :func:`as_svg` gives it, when it has been drawn already.
    trade_off : str, optional
        The same of :func:`preshape.report.trade_off_figure`.
    """
    names = ", ".join(file.name for file in calibration.files)
    drawn = as_svg(calibration_figure(calibration)) if figure is None else figure
    modes = [mode.mode for mode in calibration.modes]
    parts: list[Part] = [Paragraph(calibration.reason, "lead")]
    if calibration.trouble:
        parts.append(Paragraph("What the measurement says of the machine", "label"))
        parts += [Paragraph(sentence, "warning") for sentence in calibration.trouble]
    parts.append(Picture(drawn, _in_words(calibration)))
    parts += _measurement(calibration)
    parts += _candidates(calibration)
    parts += _trade_off(calibration, trade_off)
    parts += impulse_parts(calibration.shaper)
    parts += prediction_parts(calibration.move)
    parts += robustness_parts(calibration.shaper, modes, calibration.tolerance) if modes else ()
    parts += export_parts(calibration.texts)
    parts += provenance_parts(record)
    return Document(
        title=f"Use {calibration.chosen.name}" if calibration.clear else "See to the machine first",
        subject=f"preshape: {calibration.chosen.name} for {names}",
        parts=tuple(parts),
        foot=_foot(calibration, record),
        record=record,
    )


def klipper_sentence(calibration: Calibration) -> str:
    """What Klipper itself would choose, for comparison; empty where Klipper has nothing to say."""
    fit = calibration.klipper
    if fit is None:
        return ""
    return (
        f"For comparison, Klipper itself would choose {fit.name} at {fit.frequency:.1f} Hz. By its own measure, which "
        f"assumes damping 0.075 to 0.15, that leaves {100.0 * fit.score.remaining_vibration:.1f} % of the vibration; "
        f"smoothing {fit.score.smoothing:.3f} mm, max_accel {fit.score.maximum_acceleration:.0f} mm/s²."
    )


def _measurement(calibration: Calibration) -> list[Part]:
    """The files, and the modes found in them."""
    titles = (("file",), ("format",), ("modes found by",), ("size [kB]",))
    rows = tuple(
        (file.name, file.format, file.identification.method, f"{source.size / 1e3:.1f}")
        for file, source in zip(calibration.files, calibration.inputs, strict=True)
    )
    parts: list[Part] = [Heading("Measurement and modes"), Table(TextTable(titles, rows), left=3)]
    if calibration.modes:
        return [*parts, Table(mode_table(calibration))]
    return [*parts, Paragraph("No mode stands out of the measurement.")]


def _candidates(calibration: Calibration) -> list[Part]:
    kinds: list[RowKind] = [
        "chosen" if one is calibration.chosen else "excluded" if one.excluded else "" for one in calibration.candidates
    ]
    sentences = [exclusion_sentence(calibration), klipper_sentence(calibration)]
    return [
        Heading("Candidates, the best first"),
        Table(candidate_table(calibration), tuple(kinds), left=2),
        *[Paragraph(sentence) for sentence in sentences if sentence],
    ]


def _trade_off(calibration: Calibration, drawn: str | None) -> list[Part]:
    """The figure of the trade-off, its picks, and what they gain."""
    trade = calibration.trade_off
    if trade is None:
        return []
    gains, off = gain_sentences(trade), robustness_sentence(trade)
    kinds: list[RowKind] = ["fragile" if one in trade.fragile else "" for one in (trade.stock, *trade.picks)]
    parts: list[Part] = [
        Heading("What smoothing buys, by Klipper's measures"),
        Picture(as_svg(trade_off_figure(trade)) if drawn is None else drawn, " ".join(gains)),
        Table(pick_table(trade), tuple(kinds)),
        Paragraph(limit_sentence(trade, calibration.maximum_impulses)),
        *[Paragraph(sentence) for sentence in gains],
    ]
    return [*parts, Paragraph(off, "warning" if trade.fragile else "plain")] if off else parts


def _in_words(calibration: Calibration) -> str:
    modes = "; ".join(str(mode) for mode in calibration.modes) or "no clear mode"
    return f"Measured spectrum with {modes}. {calibration.reason}"


def _foot(calibration: Calibration, record: Record) -> str:
    left = "the modes after a move" if calibration.clear else "everything loud in the measurement"
    sentences = [
        f"Made by preshape {record.versions['preshape']}; the same numbers are in shaper.json beside this page. "
        f"Vibration left: the root mean square amplitude that remains of {left}, in the worst case of all frequencies "
        "up to 5 % off."
    ]
    if calibration.klipper is not None:
        sentences.append(
            "Columns from Klipper on are Klipper's own measures: damping 0.075 to 0.15, 5000 mm/s², 5 mm/s through "
            "corners; smoothing and max_accel mean something for 3D printers only."
        )
    return " ".join(sentences)
