"""Files that cannot say "not seen": what stands in for a gap."""

from kinesphere.data.gaps import held as held
