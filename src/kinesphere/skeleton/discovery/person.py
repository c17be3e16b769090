"""A way to see a tree as a person."""

from dataclasses import dataclass

import numpy as np

from kinesphere.geometry.length_units import SIZES, STATURE, times_too_large

LIKELY = 2.0
"""Most cost for each length that is judged, in squared standard deviations: of a person 1 at most
is expected, of what is none far more."""


Arm = tuple[int, tuple[int, ...]]
"""What an arm hangs from, and its bodies."""


@dataclass(frozen=True)
class Person:
    """One reading of a tree as a person, left and right not yet told apart."""

    trunk: int
    pelvis: int | None
    """None where trunk and pelvis are one body."""
    legs: tuple[tuple[int, ...], ...]
    """Two: thigh, shank and, if there is one, foot; the bodies beyond stay out. None at all of an
    upper half."""
    arms: tuple[Arm, ...]
    """What each arm hangs from, the trunk or a shoulder blade of its own; and upper arm, forearm
    and, if there is one, hand. Upper arm alone where no forearm moves by itself: the elbow stays as
    it is, or nothing below it has markers."""
    head: int | None
    cost: float = np.inf
    """Squared standard deviations of the proportions, and of what is missing or too much; of a
    person of any size."""
    lengths: int = 0
    """How many lengths were judged."""
    stature: float = np.nan
    """m, what the legs are the legs of; of an upper half, the arms."""

    @property
    def nobody(self) -> float:
        """What it costs to see no person at all."""
        return LIKELY * self.lengths

    @property
    def size(self) -> float:
        """What the stature alone costs."""
        return off(self.stature, STATURE, SIZES) ** 2

    @property
    def convincing(self) -> bool:
        """Whether the proportions are those of a person, of any size."""
        return self.cost <= self.nobody

    @property
    def of_human_size(self) -> bool:
        """Whether proportions and size together are those of a person."""
        return self.cost + self.size <= self.nobody

    @property
    def times_too_large(self) -> float:
        """The factor between units that makes the stature likeliest, 1 where it is a doll's."""
        return times_too_large(self.stature)

    @property
    def hips_at(self) -> int:
        """The body the legs hang from."""
        return self.trunk if self.pelvis is None else self.pelvis

    @property
    def limbs(self) -> dict[int, str]:
        """Body → kind of limb."""
        kinds = {self.trunk: "trunk"}
        if self.pelvis is not None:
            kinds[self.pelvis] = "pelvis"
        for leg in self.legs:
            kinds |= dict(zip(leg, ("thigh", "shank", "foot"), strict=False))
        for _, arm in self.arms:
            kinds |= dict(zip(arm, ("upper_arm", "forearm", "hand"), strict=False))
        if self.head is not None:
            kinds[self.head] = "head"
        return kinds


def off(found: float, expected: float, deviation: float) -> float:
    """Return how many deviations of its logarithm a length is off."""
    if not (found > 0 and expected > 0):
        return np.nan
    return float(np.log(found / expected) / deviation)
