"""The one-page HTML report of a calibration: one file, no external resource, prints on one sheet."""

from __future__ import annotations

from html import escape

from preshape.report.calibration import Calibration
from preshape.report.calibration_figure import calibration_figure
from preshape.report.figures import as_svg
from preshape.report.tables import (
    TextTable,
    candidate_table,
    exclusion_sentence,
    limit_sentence,
    mode_table,
    pick_table,
    time_unit,
)
from preshape.report.trade_off import gain_sentences, robustness_sentence
from preshape.report.trade_off_figure import trade_off_figure

__all__ = ["calibration_page", "klipper_sentence"]

STYLE = """
:root { --ink: #1a1a1a; --soft: #5b5b5b; --line: #dcdcdc; --accent: #0b5fa5; --warn: #9a3b00; }
* { box-sizing: border-box; }
body { font: 15px/1.45 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; color: var(--ink);
  max-width: 62rem; margin: 1.5rem auto; padding: 0 1rem; background: #fff; }
h1 { font-size: 1.45rem; margin: 0 0 .2rem; color: var(--accent); }
h2 { font-size: 1.05rem; margin: 1.4rem 0 .4rem; }
p { margin: .3rem 0; }
.reason { font-size: 1.05rem; }
.trouble { border-left: 5px solid var(--warn); background: #fff4ec; padding: .5rem .8rem; margin: .8rem 0; }
.trouble strong { color: var(--warn); }
.tables { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: .28rem .6rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
th:first-child, td:first-child, .candidates td:nth-child(2), .candidates th:nth-child(2) { text-align: left; }
th { font-weight: 600; color: var(--soft); vertical-align: bottom; }
tr.chosen td { font-weight: 700; color: var(--accent); }
tr.excluded td { color: #8a8a8a; }
tr.fragile td:last-child { color: var(--warn); font-weight: 700; }
svg { width: 100%; height: auto; }
pre { background: #f5f5f5; padding: .4rem .7rem; margin: .2rem 0 .6rem; overflow-x: auto; font-size: .85rem; }
footer { color: var(--soft); font-size: .85rem; margin-top: 1.2rem; border-top: 1px solid var(--line);
  padding-top: .5rem; }
@media print { body { margin: 0; max-width: none; font-size: 11px; } h2 { margin-top: .8rem; } }
"""


def calibration_page(
    calibration: Calibration, version: str, figure: str | None = None, trade_off: str | None = None
) -> str:
    """The report as HTML text.

    Parameters
    ----------
    calibration : Calibration
        From :func:`preshape.workflow.calibrate`.
    version : str
        Of preshape, for the foot of the page.
    figure : str, optional
        The figure as :func:`as_svg` gives it, when it has been drawn already.
    trade_off : str, optional
        The same of :func:`preshape.report.trade_off_figure`.
    """
    names = ", ".join(file.name for file in calibration.files)
    drawn = as_svg(calibration_figure(calibration)) if figure is None else figure
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>preshape: {escape(calibration.chosen.name)} for {escape(names)}</title>",
        f"<style>{STYLE}</style></head><body>",
        f"<h1>{escape(_headline(calibration))}</h1>",
        f'<p class="reason">{escape(calibration.reason)}</p>',
        _trouble(calibration),
        f'<div role="img" aria-label="{escape(_in_words(calibration), quote=True)}">{drawn}</div>',
        "<h2>Candidates, the best first</h2>",
        _candidates(calibration),
        f"<p>{escape(exclusion_sentence(calibration))}</p>" if exclusion_sentence(calibration) else "",
        f"<p>{escape(klipper_sentence(calibration))}</p>" if calibration.klipper else "",
        _trade_off(calibration, trade_off),
        "<h2>Modes</h2>",
        _modes(calibration),
        "<h2>The shaper</h2>",
        _impulses(calibration),
        _texts(calibration),
        f"<footer>Measured: {escape(names)}. Made by preshape {escape(version)}; the same numbers are in shaper.json "
        "beside this page. Vibration left: the root mean square amplitude that remains of "
        f"{_what_is_left(calibration)}, in the worst case of all frequencies up to 5 % off. "
        + _klipper_note(calibration)
        + "</footer>",
        "</body></html>",
    ]
    return "\n".join(part for part in parts if part) + "\n"


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


def _what_is_left(calibration: Calibration) -> str:
    return "the modes after a move" if calibration.clear else "everything loud in the measurement"


def _klipper_note(calibration: Calibration) -> str:
    if calibration.klipper is None:
        return ""
    return (
        "Columns from Klipper on are Klipper's own measures: damping 0.075 to 0.15, 5000 mm/s², 5 mm/s through "
        "corners; smoothing and max_accel mean something for 3D printers only."
    )


def _headline(calibration: Calibration) -> str:
    return f"Use {calibration.chosen.name}" if calibration.clear else "See to the machine first"


def _in_words(calibration: Calibration) -> str:
    modes = "; ".join(str(mode) for mode in calibration.modes) or "no clear mode"
    return f"Measured spectrum with {modes}. {calibration.reason}"


def _trouble(calibration: Calibration) -> str:
    if not calibration.trouble:
        return ""
    rows = "".join(f"<p>{escape(sentence)}</p>" for sentence in calibration.trouble)
    return f'<div class="trouble"><strong>What the measurement says of the machine</strong>{rows}</div>'


def _trade_off(calibration: Calibration, drawn: str | None) -> str:
    """The figure of the trade-off, its picks, and what they gain."""
    trade = calibration.trade_off
    if trade is None:
        return ""
    figure = as_svg(trade_off_figure(trade)) if drawn is None else drawn
    gains = gain_sentences(trade)
    fragile = [one in trade.fragile for one in (trade.stock, *trade.picks)]
    table = _html_table(pick_table(trade), ["fragile" if one else "" for one in fragile])
    sentences = "".join(
        f"<p>{escape(sentence)}</p>" for sentence in (limit_sentence(trade, calibration.maximum_impulses), *gains)
    )
    off = robustness_sentence(trade)
    if off:
        sentences += f'<div class="trouble">{escape(off)}</div>' if trade.fragile else f"<p>{escape(off)}</p>"
    image = f'<div role="img" aria-label="{escape(" ".join(gains), quote=True)}">{figure}</div>'
    return f"<h2>What smoothing buys, by Klipper's measures</h2>\n{image}\n{table}\n{sentences}"


def _texts(calibration: Calibration) -> str:
    """The settings to paste, and who cannot hold the shaper."""
    if not calibration.texts:
        return ""
    parts = ["<h2>Settings to paste</h2>"]
    for one in calibration.texts:
        note = f": {one.note}" if one.note else ""
        body = f"<pre>{escape(one.text)}</pre>" if one.fits else ""
        what = "" if one.fits else "does not fit"
        parts.append(f"<p><strong>{escape(one.target)}</strong> {escape(one.version)} {what}{escape(note)}</p>{body}")
    return "\n".join(parts)


def _candidates(calibration: Calibration) -> str:
    kinds = [
        "chosen" if one is calibration.chosen else "excluded" if one.excluded else "" for one in calibration.candidates
    ]
    return f'<div class="candidates">{_html_table(candidate_table(calibration), kinds)}</div>'


def _modes(calibration: Calibration) -> str:
    if not calibration.modes:
        return "<p>No mode stands out of the measurement.</p>"
    return _html_table(mode_table(calibration), [""] * len(calibration.modes))


def _html_table(table: TextTable, kinds: list[str]) -> str:
    """A table whose rows are of the given kinds, which are classes of the style sheet."""
    head = "".join(f"<th>{'<br>'.join(escape(line) for line in title)}</th>" for title in table.titles)
    rows = "".join(
        f'<tr class="{kind}">' + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>"
        for kind, row in zip(kinds, table.rows, strict=True)
    )
    return f'<div class="tables"><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>'


def _impulses(calibration: Calibration) -> str:
    shaper, unit = calibration.shaper, time_unit(calibration.shaper)
    rows = tuple(
        (f"{i}", f"{unit.per_second * t:.{unit.decimals + 3}f}", f"{a:.6f}")
        for i, (t, a) in enumerate(zip(shaper.times, shaper.amplitudes, strict=True), start=1)
    )
    table = TextTable((("impulse",), (f"time [{unit.name}]",), ("amplitude [-]",)), rows)
    proof = "<p>Proved shortest: the certificate is in shaper.json.</p>" if shaper.design.status == "optimal" else ""
    return proof + _html_table(table, [""] * len(rows))
