"""Numbers as the three processors of the C3D format wrote them."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Words = NDArray[np.int16]
Floats = NDArray[np.float32]


@dataclass(frozen=True)
class Processor:
    """How 16-bit words and 32-bit floats lie in the bytes of a file."""

    name: str
    code: int
    """Byte 4 of the parameter section."""
    order: str
    """NumPy's sign for the byte order of words."""
    vax_floats: bool = False
    """Whether floats are those of DEC's VAX instead of IEEE's."""

    def words(self, content: bytes) -> Words:
        """Return 16-bit signed words, (n,)."""
        return np.frombuffer(content, self.order + "i2").astype(np.int16, copy=False)

    def floats(self, content: bytes) -> Floats:
        """Return 32-bit floats, (n,)."""
        if self.vax_floats:
            return _floats_from_vax(np.frombuffer(content, "<u2").reshape(-1, 2))
        return np.frombuffer(content, self.order + "f4").astype(np.float32, copy=False)


INTEL = Processor("INTEL", 84, "<")
DEC = Processor("DEC", 85, "<", vax_floats=True)
MIPS = Processor("MIPS", 86, ">")
PROCESSORS = {p.code: p for p in (INTEL, DEC, MIPS)}


def _floats_from_vax(pairs: NDArray[Any]) -> Floats:
    """Convert VAX F floats: the half with sign and exponent first, exponent biased by 128.

    A mantissa is 0.1mmm… in binary against IEEE's 1.mmm…, so the same bits stand for a quarter of
    what they would in IEEE, except where the exponent is 0 (zero) or 255 (an ordinary number).
    """
    bits = (pairs[:, 0].astype(np.uint32) << 16) | pairs[:, 1]
    exponent = (bits >> 23) & 0xFF
    mantissa = (bits & 0x7FFFFF) / 2.0**24 + 0.5
    values = np.ldexp(mantissa, exponent.astype(np.int32) - 128)
    values[exponent == 0] = 0.0
    return np.asarray(np.where(bits >> 31, -values, values), dtype=np.float32)
