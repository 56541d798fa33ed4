"""IEC 61131-3 structured text: a function block for CODESYS, TwinCAT and their relatives."""

from preshape.export.st.target import ST

__all__ = ["ST"]
