"""The HTTP API: the workbench's functions, each computed in a worker; described at /api/openapi.json."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import FastAPI, Path, Query, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, Response
from starlette.exceptions import HTTPException

from preshape.design import ASKED_FAMILIES, OPTIONS, needed_by, taken_by
from preshape.errors import InputError
from preshape.export import TARGETS
from preshape.studio import answers, jobs
from preshape.studio.requests import DesignRequest, ExportRequest, ReportRequest, WorkbenchModel
from preshape.studio.workers import Overdue, Workers
from preshape.workflow.workbench import LARGEST_FILE, MOST_MODES, export_targets

__all__ = ["api_app"]

SECONDS = {"design": 20.0, "trade-off": 60.0, "identify": 120.0, "report": 60.0}
"""How long each may take [s]; a design of many modes or wide bands could take minutes."""

LONGEST_DETAIL = 400

WRONG: dict[int | str, dict[str, Any]] = {
    status: {"model": answers.Problem, "description": what}
    for status, what in {
        400: "The body is not JSON.",
        413: "The request is too large.",
        422: "What was asked cannot be done; the sentence says why and what to do.",
        503: "It took too long, or too many requests wait.",
    }.items()
}

RATE = Query(gt=0.0, le=1e9, allow_inf_nan=False, description="Samples per second [Hz], without a time column.")


def api_app(workers: Workers, *, largest_upload: int = LARGEST_FILE) -> FastAPI:
    """The API as an app of its own, to be mounted at /api.

    Parameters
    ----------
    workers : Workers
        Who compute.
    largest_upload : int
        Bytes of a measurement file.
    """
    from importlib.metadata import version

    app = FastAPI(
        title="preshape",
        version=version("preshape"),
        description="Input shapers: design, view, trade-off, identification, export and report. Times are in seconds, "
        "frequencies in hertz (undamped natural frequencies), amplitudes and residual vibration without unit.",
        docs_url=None,
        redoc_url=None,
        openapi_url="/openapi.json",
        servers=[{"url": "/api"}],
        root_path_in_servers=False,
    )
    _problems(app)
    _lists(app)
    _workbench(app, workers)
    _files(app, workers, largest_upload)
    return app


def _lists(app: FastAPI) -> None:
    @app.get("/version", response_model=answers.VersionAnswer)
    async def get_version() -> dict[str, str]:
        """Which preshape this is."""
        from preshape.kernel import active_kernel

        return {"version": app.version, "kernel": active_kernel()}

    @app.get("/families", response_model=answers.FamiliesAnswer)
    async def get_families() -> dict[str, Any]:
        """Every family, the wishes it takes, and what they are."""
        return {
            "families": [
                {"name": name, "options": sorted(taken_by(name)), "needed": sorted(needed_by(name))}
                for name in ASKED_FAMILIES
            ],
            "options": [
                {"name": one.name, "kind": one.kind, "summary": one.summary, "choices": list(one.choices)}
                for one in OPTIONS.values()
            ],
        }

    @app.get("/targets", response_model=answers.TargetsAnswer)
    async def get_targets() -> dict[str, Any]:
        """Every target of the export, with what it can hold."""
        return {"targets": [vars(target) for target in export_targets()]}


def _workbench(app: FastAPI, workers: Workers) -> None:
    @app.post("/design", responses={200: {"model": answers.DesignAnswer}, **WRONG})
    async def post_design(asked: DesignRequest) -> Response:
        """Design a shaper for some modes."""
        return _json(await workers.run(SECONDS["design"], jobs.design_job, asked.workbench()))

    @app.post("/view", responses={200: {"model": answers.ViewAnswer}, **WRONG})
    async def post_view(asked: WorkbenchModel) -> Response:
        """Everything the studio draws of a workbench; a design that has no solution says so in its own place."""
        return _json(await workers.run(SECONDS["design"], jobs.view_job, asked.workbench()))

    @app.post("/trade-off", responses={200: {"model": answers.TradeOffAnswer}, **WRONG})
    async def post_trade_off(asked: WorkbenchModel) -> Response:
        """Duration against the vibration left when every frequency is 5 % off: families, designs and the optimum."""
        return _json(await workers.run(SECONDS["trade-off"], jobs.trade_off_job, asked.workbench()))


def _files(app: FastAPI, workers: Workers, largest_upload: int) -> None:
    file_body = {"content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}}

    @app.post(
        "/identify",
        responses={200: {"model": answers.MeasurementAnswer}, **WRONG},
        openapi_extra={"requestBody": {"required": True, **file_body}},
    )
    async def post_identify(
        request: Request,
        name: Annotated[str, Query(max_length=200, description="Of the file, for messages.")] = "the file",
        sample_rate: Annotated[float | None, RATE] = None,
        part: Annotated[
            str | None, Query(max_length=200, description="Which measurement, of a file that holds several.")
        ] = None,
        damping: Annotated[
            float | None, Query(ge=0.0, lt=1.0, allow_inf_nan=False, description="Of all modes, if known.")
        ] = None,
        maximum: Annotated[int, Query(ge=1, le=MOST_MODES, description="Most modes to find.")] = 4,
    ) -> Response:
        """Find the modes in a measurement file, which is the body itself; it is read in memory, never from a disk."""
        content = await request.body()
        if len(content) > largest_upload:
            raise HTTPException(413, f"the file is larger than {largest_upload / 1e6:g} MB.")
        wishes = {"sample_rate": sample_rate, "part": part, "damping": damping, "maximum": maximum}
        return _json(await workers.run(SECONDS["identify"], jobs.identify_job, content, name, wishes))

    unknown: dict[int | str, dict[str, Any]] = {
        404: {"model": answers.Problem, "description": "There is no such target."}
    }

    @app.post("/export/{target}", responses={200: {"model": answers.ExportAnswer}, **unknown, **WRONG})
    async def post_export(
        asked: ExportRequest,
        target: Annotated[str, Path(max_length=40, description="A name that GET /api/targets lists.")],
    ) -> Response:
        """A shaper as the files that somebody else's controller takes."""
        if target not in TARGETS:
            raise HTTPException(404, f"target {target!r} is not known: it is {', '.join(TARGETS)}.")
        return _json(await workers.run(SECONDS["design"], jobs.export_job, asked.chosen(), target, asked.settings()))

    sheets = {
        "text/html": {"schema": {"type": "string"}},
        "application/pdf": {"schema": {"type": "string", "format": "binary"}},
    }

    @app.post("/report", responses={200: {"content": sheets, "description": "The report."}, **WRONG})
    async def post_report(
        asked: ReportRequest, format: Annotated[Literal["html", "pdf"], Query(description="Of the report.")] = "html"
    ) -> Response:
        """The report of a shaper as one file without external resources."""
        content = await workers.run(
            SECONDS["report"], jobs.report_job, asked.judged_at(), asked.chosen(), asked.remarks, format
        )
        kind = "application/pdf" if format == "pdf" else "text/html; charset=utf-8"
        return Response(
            content, media_type=kind, headers={"Content-Disposition": f'attachment; filename="preshape.{format}"'}
        )


def _problems(app: FastAPI) -> None:
    """Every refusal is a sentence under "detail"."""

    @app.exception_handler(InputError)
    async def refused(_: Request, error: Exception) -> Response:
        return _problem(422, str(error))

    @app.exception_handler(Overdue)
    async def overdue(_: Request, error: Exception) -> Response:
        return _problem(503, str(error))

    @app.exception_handler(RequestValidationError)
    async def invalid(_: Request, error: Exception) -> Response:
        assert isinstance(error, RequestValidationError)
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"] if part not in ("body", "query", "path"))
        more = f" (and {len(error.errors()) - 1} more)" if len(error.errors()) > 1 else ""
        return _problem(422, f"{place or 'the body'}: {first['msg']}{more}.")

    @app.exception_handler(Exception)
    async def fault(_: Request, error: Exception) -> Response:
        return _problem(
            500, "this is a fault of preshape, not yours; the studio's terminal shows it: please report it."
        )


def _problem(status: int, sentence: str) -> Response:
    return JSONResponse({"detail": _sayable(sentence)}, status)


def _sayable(sentence: str) -> str:
    """A sentence that UTF-8 can hold, whatever the request had in it."""
    shown = sentence.encode("utf-8", "replace").decode()
    return shown if len(shown) <= LONGEST_DETAIL else f"{shown[:LONGEST_DETAIL]} ..."


def _json(content: bytes) -> Response:
    return Response(content, media_type="application/json")
