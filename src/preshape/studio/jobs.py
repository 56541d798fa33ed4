"""What the workers do for the API: from what was asked to the bytes of the answer, so that nothing is encoded twice."""

from __future__ import annotations

import base64
from typing import Any

import msgspec

from preshape.mode import Modes
from preshape.shaper import Shaper
from preshape.workflow.workbench import (
    ExportFile,
    Workbench,
    measured,
    packaged,
    plain_measured,
    plain_trade_off,
    plain_view,
    shaper_named,
    trade_off_of,
    view_of,
)

__all__ = ["design_job", "export_job", "identify_job", "report_job", "trade_off_job", "view_job"]


def design_job(workbench: Workbench) -> bytes:
    """The shaper of design A."""
    shaper = shaper_named(workbench, "A")
    drawn = plain_view(view_of(workbench))["designs"][0]["drawn"]
    return msgspec.json.encode({"shaper": shaper.to_dict(), "proved": drawn["proved"], "modes": drawn["modes"]})


def view_job(workbench: Workbench) -> bytes:
    """Everything that is drawn."""
    return msgspec.json.encode(plain_view(view_of(workbench)))


def trade_off_job(workbench: Workbench) -> bytes:
    """The trade-off."""
    return msgspec.json.encode(plain_trade_off(trade_off_of(workbench)))


def identify_job(content: bytes, name: str, wishes: dict[str, Any]) -> bytes:
    """A measurement's spectrum and modes."""
    return msgspec.json.encode(plain_measured(measured(content, name, **wishes)))


def export_job(chosen: Workbench | Shaper, target: str, settings: dict[str, Any]) -> bytes:
    """A shaper in a target's words."""
    package = packaged(_shaper(chosen), target, **settings)
    return msgspec.json.encode(
        {
            "files": [_file(one) for one in package.files],
            "download": _file(ExportFile(package.name, package.content, _only_text(package.files))),
            "duration": package.shaper.duration,
            "notes": list(package.notes),
            "next_step": list(package.next_step),
        }
    )


def report_job(modes: Modes, chosen: Workbench | Shaper, remarks: list[str], kind: str) -> bytes:
    """The report of a shaper as HTML or PDF."""
    from preshape.export import paste_ready
    from preshape.report import as_html, as_pdf
    from preshape.workflow import design_report

    shaper = _shaper(chosen)
    document = design_report(modes, shaper, exports=paste_ready(shaper), remarks=remarks)
    return as_pdf(document) if kind == "pdf" else as_html(document).encode()


def _shaper(chosen: Workbench | Shaper) -> Shaper:
    return chosen if isinstance(chosen, Shaper) else shaper_named(chosen, "A")


def _only_text(files: tuple[ExportFile, ...]) -> str:
    return files[0].text if len(files) == 1 else ""


def _file(one: ExportFile) -> dict[str, Any]:
    return {"name": one.name, "text": one.text or None, "base64": base64.b64encode(one.content).decode()}
