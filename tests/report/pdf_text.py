"""The text of a PDF that Typst wrote, read by the specification and by no library, so that tests need none."""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator

ESCAPES = {b"n": b"\n", b"r": b"\r", b"t": b"\t", b"b": b"\b", b"f": b"\f"}


def pdf_pages(pdf: bytes) -> list[str]:
    """The text of each page, in the order it is set, without spaces and line ends."""
    objects = {int(number): body for number, body in re.findall(rb"(\d+) 0 obj\n(.*?)\nendobj", pdf, re.DOTALL)}

    def stream(number: int) -> bytes:
        head, _, body = objects[number].partition(b"stream\n")
        return zlib.decompress(body) if b"/FlateDecode" in head else body

    def reference(name: bytes, body: bytes) -> int:
        found = re.search(rb"/" + name + rb" (\d+) 0 R", body)
        assert found, name
        return int(found.group(1))

    pages = []
    for body in objects.values():
        if not body.startswith(b"<</Type/Page/"):
            continue
        fonts = re.search(rb"/Font<<(.*?)>>", objects[reference(b"Resources", body)])
        assert fonts
        maps = {
            name: _characters(stream(reference(b"ToUnicode", objects[int(number)])))
            for name, number in re.findall(rb"/(f\d+) (\d+) 0 R", fonts.group(1))
        }
        pages.append(_shown(stream(reference(b"Contents", body)), maps))
    return pages


def _characters(table: bytes) -> dict[int, str]:
    return {
        int(code, 16): bytes.fromhex(text.decode()).decode("utf-16-be")
        for code, text in re.findall(rb"<([0-9A-F]{4})> <([0-9A-F]+)>\n", table.split(b"beginbfchar", 1)[1])
    }


def _shown(content: bytes, maps: dict[bytes, dict[int, str]]) -> str:
    text: list[str] = []
    for font, line in re.findall(rb"BT.*?/(f\d+) [\d.]+ Tf(.*?)\nET", content, re.DOTALL):
        for codes in _strings(line):
            text += [maps[font].get(int.from_bytes(codes[i : i + 2]), "?") for i in range(0, len(codes), 2)]
    return re.sub(r"\s", "", "".join(text))


def _strings(line: bytes) -> Iterator[bytes]:
    """The strings in an array of text; parentheses inside are escaped, or come in pairs."""
    found, depth = b"", 0
    for token in re.findall(rb"\\\d{3}|\\.|.", line, re.DOTALL):
        depth -= token == b")"
        if depth > 0:
            found += _unescaped(token) if token[:1] == b"\\" else token
        depth += token == b"("
        if token == b")" and depth == 0:
            yield found
            found = b""


def _unescaped(token: bytes) -> bytes:
    escaped = token[1:]
    return bytes([int(escaped, 8)]) if escaped.isdigit() else ESCAPES.get(escaped, escaped)
