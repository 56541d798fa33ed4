"""A unit of structured text as TwinCAT 3 keeps it: an XML file with declaration and body apart."""

from __future__ import annotations

import uuid

__all__ = ["tcpou"]

TEXT = """<?xml version="1.0" encoding="utf-8"?>
<TcPlcObject Version="1.1.0.1">
  <POU Name="{name}" Id="{{{number}}}" SpecialFunc="None">
    <Declaration><![CDATA[{declaration}]]></Declaration>
    <Implementation>
      <ST><![CDATA[{body}]]></ST>
    </Implementation>
  </POU>
</TcPlcObject>
"""


def tcpou(name: str, text: str) -> str:
    """The .TcPOU file of a unit, whose body begins after the empty line below its last declaration.

    TwinCAT adds it with "Add existing item". The number that it wants for every unit follows from the text.
    """
    declaration, end, rest = text.rpartition("END_VAR\n\n")
    body = rest[: rest.rindex("END_")]  # of the unit itself, which TwinCAT leaves out
    number = uuid.uuid5(uuid.NAMESPACE_OID, text)
    return TEXT.format(name=name, number=number, declaration=declaration + end.rstrip("\n") + "\n", body=body)
