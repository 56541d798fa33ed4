"""The HTTP API: what it answers is what the library says, and nothing that is sent makes it fail."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from schemathesis import GenerationMode
from schemathesis.specs.openapi.checks import positive_data_acceptance
from starlette.testclient import TestClient
from tests.identify.valid_files import valid_files

from preshape import Shaper, design
from preshape.export import TARGETS, render
from preshape.identify import find_modes
from preshape.mode import Mode
from preshape.workflow.workbench import AskedDesign, Workbench, from_text, plain_view, to_plain, view_of

GANTRY = Path(__file__).resolve().parents[2] / "examples" / "data" / "gantry_x.csv"
EXAMPLES = 20
"""Requests an operation and kind."""

MODES = [[9.8, 0.02], [31.7, 0.015]]


@pytest.fixture(scope="module")
def client(app: Any) -> TestClient:
    return TestClient(app, raise_server_exceptions=False)


def post(client: TestClient, path: str, body: Any, **query: Any) -> tuple[int, Any]:
    answer = client.post(path, content=json.dumps(body), headers={"content-type": "application/json"}, params=query)
    return answer.status_code, answer.json()


def test_a_design_is_the_library_s(client: TestClient) -> None:
    status, found = post(client, "/api/design", {"modes": MODES, "family": "direct", "options": {"order": 1}})
    expected = design.direct(MODES, 1)
    assert status == 200 and found["proved"]
    assert Shaper.from_dict(found["shaper"]) == expected
    assert [mode["residual"] < 1e-9 for mode in found["modes"]] == [True, True]


def test_a_view_is_the_workbench_s_and_its_link_leads_back(client: TestClient) -> None:
    bench = Workbench(tuple(Mode(*pair) for pair in MODES), (AskedDesign("B", "ei"), AskedDesign("A", "sd_zv")))
    status, found = post(client, "/api/view", to_plain(bench))
    assert status == 200
    assert found == json.loads(json.dumps(plain_view(view_of(bench))))
    assert from_text(found["link"]) == bench


def test_a_trade_off_has_its_optimum(client: TestClient) -> None:
    status, found = post(client, "/api/trade-off", {"modes": MODES, "designs": [{"name": "A", "family": "zvd"}]})
    assert status == 200 and len(found["optimum"]) == 6 and found["designs"][0]["name"] == "A"


def test_a_file_is_identified_as_from_a_disk(client: TestClient) -> None:
    answer = client.post("/api/identify", content=GANTRY.read_bytes()[:290_000], params={"name": "gantry_x.csv"})
    short = GANTRY.read_bytes()[:290_000]
    path_like = find_modes(read_again(short))
    assert answer.status_code == 200
    assert [mode["frequency"] for mode in answer.json()["modes"]] == [one.mode.frequency for one in path_like.modes]


def read_again(content: bytes) -> Any:
    from preshape.identify import read_bytes

    return read_bytes(content, "gantry_x.csv")


def test_every_target_is_exported_and_a_download_is_whole(client: TestClient) -> None:
    targets = {one["name"]: one for one in client.get("/api/targets").json()["targets"]}
    assert list(targets) == list(TARGETS)
    shaper = design.zv((40.0, 0.05))
    impulses = {"times": shaper.times.tolist(), "amplitudes": shaper.amplitudes.tolist()}
    for name, target in targets.items():
        rate = 1000.0 if target["sampled"] else None
        body = {"modes": [[40.0, 0.05]], "design": {"family": "zv"}, "rate": rate}
        status, found = post(client, f"/api/export/{name}", body)
        assert status == 200, found
        expected = render(shaper, name, dt=None if rate is None else 1.0 / rate)
        contents = {key: value.encode() if isinstance(value, str) else value for key, value in expected.files.items()}
        assert {one["name"]: base64.b64decode(one["base64"]) for one in found["files"]} == contents
        assert post(client, f"/api/export/{name}", {"shaper": impulses, "rate": rate})[0] in (200, 422)


@pytest.mark.parametrize(("kind", "start"), [("html", b"<!doctype html>"), ("pdf", b"%PDF-")])
def test_a_report_is_one_file(client: TestClient, kind: str, start: bytes) -> None:
    if kind == "pdf":
        pytest.importorskip("typst")
    body = {"modes": MODES, "design": {"family": "zvd"}, "remarks": ["Of the test bench."]}
    answer = client.post("/api/report", json=body, params={"format": kind})
    assert answer.status_code == 200 and answer.content[: len(start)].lower() == start.lower()
    assert f'filename="preshape.{kind}"' in answer.headers["content-disposition"]


def test_what_there_is_is_listed(client: TestClient) -> None:
    families = client.get("/api/families").json()
    assert {one["name"] for one in families["families"]} >= set(design.FAMILIES)
    known = {one["name"] for one in families["options"]}
    assert all(
        set(one["options"]) <= known and set(one["needed"]) <= set(one["options"]) for one in families["families"]
    )
    assert client.get("/api/version").json()["version"]


BAD: list[tuple[str, Any, str]] = [
    ("/api/design", {"modes": [[k, 0.0] for k in range(1, 1_000)]}, "at most 12"),
    ("/api/design", {"modes": [[-3.0, 0.0]]}, "greater than or equal to 0.001"),
    ("/api/design", {"modes": [[3.0, 1.0]]}, "less than 1"),
    ("/api/design", {"modes": [["ten", 0.0]]}, "number"),
    ("/api/design", {"modes": [[True, 0.0]]}, "number"),
    ("/api/design", {"modes": {}}, "list"),
    ("/api/design", [], "valid dictionary"),
    ("/api/design", {"modes": MODES, "family": "magic"}, "no family 'magic'"),
    ("/api/design", {"modes": MODES, "family": "zv", "options": {"humps": 2}}, "does not take humps"),
    ("/api/design", {"modes": MODES, "family": "ei", "options": {"tolerance": -1.0}}, "outside (0, 1)"),
    ("/api/design", {"modes": MODES, "family": "mesh", "options": {"dt": 1e-30}}, "A"),
    ("/api/design", {"modes": MODES, "more": 1}, "not permitted"),
    ("/api/view", {"modes": MODES, "move": {"distance": 0.0}}, "distance is 0"),
    ("/api/view", {"modes": MODES, "schema": "preshape/workbench/9"}, "preshape/workbench/1"),
    ("/api/view", {"modes": MODES, "designs": [{"name": "A"}, {"name": "A"}]}, "given twice"),
    ("/api/export/c", {"modes": MODES, "design": {"family": "zv"}}, "sample rate"),
    ("/api/export/c", {}, "no shaper was given"),
    ("/api/export/c", {"shaper": {"times": [0.0, 1.0], "amplitudes": [1.0]}, "rate": 100.0}, "amplitudes"),
    ("/api/report", {"shaper": {"times": [0.0], "amplitudes": [1.0]}}, "modes: Field required"),
]


@pytest.mark.parametrize(("path", "body", "sentence"), BAD, ids=str)
def test_wrong_input_is_one_sentence(client: TestClient, path: str, body: Any, sentence: str) -> None:
    status, answer = post(client, path, body)
    assert status == 422, answer
    assert list(answer) == ["detail"] and sentence in answer["detail"] and "\n" not in answer["detail"]


@pytest.mark.parametrize(
    "text", ['{"modes": [[NaN, 0.0]]}', '{"modes": [[Infinity, 0.0]]}', '{"modes": [[1e999, 0.0]]}']
)
def test_what_is_no_number_is_refused(client: TestClient, text: str) -> None:
    answer = client.post("/api/design", content=text, headers={"content-type": "application/json"})
    assert answer.status_code == 422 and "finite" in answer.json()["detail"]


@pytest.mark.parametrize("text", ["", "{", "[" * 100_000, "1" * 10_000, "\x00", '"\\ud800"'])
def test_what_is_no_json_is_refused(client: TestClient, text: str) -> None:
    answer = client.post("/api/design", content=text, headers={"content-type": "application/json"})
    assert answer.status_code in (400, 422) and isinstance(answer.json()["detail"], str)


def test_a_million_modes_are_too_large_a_request(client: TestClient) -> None:
    assert post(client, "/api/design", {"modes": [[float(k), 0.0] for k in range(1, 1_000_000)]})[0] == 413


def test_a_larger_file_is_refused_by_its_word_and_while_it_comes(client: TestClient) -> None:
    assert client.post("/api/identify", content=b"x" * 300_001).status_code == 413
    sent = 0

    def chunks() -> Any:
        nonlocal sent
        for _ in range(100):
            sent += 10_000
            yield b"x" * 10_000

    assert client.post("/api/identify", content=chunks()).status_code == 413


@pytest.mark.parametrize("kind", sorted(valid_files()))
def test_damaged_files_are_refused_in_a_sentence(client: TestClient, kind: str) -> None:
    content = valid_files()[kind]
    rng = np.random.default_rng(3)
    for cut in (0, 10, len(content) // 2, len(content)):
        damaged = bytearray(content[:cut])
        for place in rng.integers(0, max(cut, 1), min(cut, 5)):
            damaged[place] = int(rng.integers(0, 256))
        answer = client.post("/api/identify", content=bytes(damaged), params={"name": f"{kind}.bin"})
        assert answer.status_code in (200, 422), answer.text
        assert answer.status_code == 200 or isinstance(answer.json()["detail"], str)


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/api/nothing", 404),
        ("GET", "/api/design", 405),
        ("POST", "/api/version", 405),
        ("DELETE", "/api/view", 405),
        ("GET", "/api/docs", 404),
        ("POST", "/api/export/nothing", 404),
    ],
)
def test_what_is_not_there_is_said(client: TestClient, method: str, path: str, status: int) -> None:
    body = {"modes": MODES, "design": {"family": "zv"}} if "export" in path else None
    answer = client.request(method, path, json=body)
    assert answer.status_code == status and isinstance(answer.json()["detail"], str)


def test_a_description_loads_nothing_from_elsewhere(client: TestClient) -> None:
    answer = client.get("/api/openapi.json")
    assert answer.status_code == 200 and answer.json()["info"]["title"] == "preshape"


@pytest.fixture(scope="module")
def operations(app: Any) -> dict[str, Any]:
    schema = schemathesis.openapi.from_asgi("/api/openapi.json", app)
    return {found.ok().label: found.ok() for found in schema.get_all_operations()}


LABELS = (
    "GET /version",
    "GET /families",
    "GET /targets",
    "POST /design",
    "POST /view",
    "POST /trade-off",
    "POST /identify",
    "POST /export/{target}",
    "POST /report",
)

CASES = [
    (label, mode)
    for label in LABELS
    for mode in GenerationMode
    if label.startswith("POST") or mode is GenerationMode.POSITIVE  # nothing can be wrong with no parameters
]


def test_every_operation_is_checked(operations: dict[str, Any]) -> None:
    assert sorted(operations) == sorted(LABELS)


@pytest.mark.parametrize(("label", "mode"), CASES, ids=lambda value: getattr(value, "value", value))
def test_the_api_does_what_its_description_says(label: str, mode: GenerationMode, operations: dict[str, Any]) -> None:
    """Whatever fits the description is answered as it says, whatever does not is refused; nothing is a 500."""
    operation = operations[label]

    @settings(
        max_examples=EXAMPLES,
        derandomize=True,
        deadline=None,
        database=None,
        phases=[Phase.explicit, Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(case=operation.as_strategy(generation_mode=mode))
    def run(case: Any) -> None:
        answer = case.call(timeout=120.0)
        if answer.status_code == 503:  # what a test makes up may take minutes: it is stopped, and the answer says so
            assert list(answer.json()) == ["detail"] and answer.json()["detail"].startswith(
                ("this took", "the computer")
            )
            return
        # A request of the right form may ask for what does not exist: then it is answered by 422 and a sentence.
        case.validate_response(answer, excluded_checks=[positive_data_acceptance])

    run()
