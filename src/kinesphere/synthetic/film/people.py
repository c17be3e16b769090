"""People who are not built as the model: other sizes, girths and bone lengths, all known."""

from collections.abc import Mapping

import numpy as np

from kinesphere.data import Array
from kinesphere.data.surface import Surface

_ROUND = ("head", "hand", "foot", "clavicle")
"""Limbs that change in size, not in shape."""


def another_person(
    surface: Surface, rng: np.random.Generator, least: float = 0.03, most: float = 0.08
) -> Surface:
    """Return a body whose size, girths and bone lengths are all off by 3 to 8 %, either way.

    Left and right stay alike. Directions of shape are left behind.

    Parameters
    ----------
    least, most
        Shares by which each measure is off.
    """

    def off() -> float:
        return float(1 + rng.choice([-1.0, 1.0]) * rng.uniform(least, most))

    size = off()
    kinds = dict.fromkeys(_kind(limb) for limb in surface.limbs)
    lengths = {kind: size * off() for kind in kinds}
    girths = {kind: size * off() for kind in kinds}
    return stretched(surface, lengths, girths)


def stretched(
    surface: Surface, lengths: Mapping[str, float], girths: Mapping[str, float]
) -> Surface:
    """Return a surface whose limbs are longer and thicker by known factors.

    Parameters
    ----------
    lengths, girths
        Factor for each kind of limb (``upper_arm``, both sides alike), along it and across it.
        Head, hands, feet and collar bones take their length's factor all round.
    """
    starts, new = surface.joint_centres, np.empty_like(surface.joint_centres)
    shapes = np.empty((len(surface.limbs), 3, 3))
    for i, limb in enumerate(surface.limbs):
        kind, parent = _kind(limb), int(surface.parents[i])
        axis = surface.ends[i] - starts[i]
        axis = axis / np.linalg.norm(axis)
        along = lengths.get(kind, 1.0)
        across = along if kind in _ROUND else girths.get(kind, 1.0)
        shapes[i] = across * np.eye(3) + (along - across) * np.outer(axis, axis)
        arm = starts[i] - starts[parent]
        new[i] = starts[i] if parent < 0 else new[parent] + shapes[parent] @ arm
    limbs, shares = surface.weight_limbs, surface.weight_shares
    moved = np.einsum(
        "vk,vkij,vkj->vi", shares, shapes[limbs], surface.vertices[:, None] - starts[limbs]
    ) + np.einsum("vk,vki->vi", shares, new[limbs])
    ends: Array = new + (shapes @ (surface.ends - starts)[..., None])[..., 0]
    ground = np.array([0.0, moved[:, 1].min() - surface.vertices[:, 1].min(), 0.0])
    return Surface(
        vertices=moved - ground,
        faces=surface.faces,
        limbs=surface.limbs,
        parents=surface.parents,
        joint_centres=new - ground,
        ends=ends - ground,
        weights=surface.weights,
        history=surface.history,
    )


def _kind(limb: str) -> str:
    return limb.removeprefix("left_").removeprefix("right_")
