"""What the person wears: colours, patterns, and cloth that does not follow the skin."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.data.surface import Surface

_WORN = {
    "shirt": ("trunk", "upper_arm", "clavicle"),
    "trousers": ("pelvis", "thigh", "shank"),
    "shoes": ("foot",),
}
_LOOSE = ("pelvis", "trunk", "upper_arm", "thigh", "shank")
_SKIN = (196.0, 152.0, 128.0)
_HAIR = (52.0, 40.0, 34.0)
_SUITS = (
    {"shirt": (58.0, 66.0, 92.0), "trousers": (46.0, 48.0, 54.0), "shoes": (30.0, 30.0, 32.0)},
    {"shirt": (150.0, 52.0, 48.0), "trousers": (44.0, 58.0, 96.0), "shoes": (60.0, 58.0, 56.0)},
    {"shirt": (64.0, 104.0, 70.0), "trousers": (92.0, 84.0, 72.0), "shoes": (34.0, 34.0, 38.0)},
)


@dataclass(frozen=True, eq=False)
class Clothes:
    """Colour and looseness of every vertex."""

    colours: Array
    """(n_vertices, 3), 0–255."""
    patterned: Array
    """(n_vertices,) 0–1."""
    looseness: Array
    """(n_vertices,) 0–1, how far cloth stands off at most."""
    phases: Array
    """(3, 3) of the waves it moves in."""


def dressed(surface: Surface, rng: np.random.Generator, *, pattern: float) -> Clothes:
    """Return clothes for a surface.

    Parameters
    ----------
    pattern
        0–1: contrast of the pattern on shirt and trousers.
    """
    suit = _SUITS[int(rng.integers(len(_SUITS)))]
    colours = np.tile(np.array(_SKIN), (surface.n_vertices, 1))
    patterned = np.zeros(surface.n_vertices)
    loose = np.zeros(surface.n_vertices)
    for i, limb in enumerate(surface.limbs):
        share = surface.weights[:, i]
        kind = limb.split("_", 1)[-1]
        for piece, limbs in _WORN.items():
            if kind in limbs:
                colours += share[:, None] * (np.array(suit[piece]) - np.array(_SKIN))
                patterned += share * pattern * (piece != "shoes")
        if kind in _LOOSE:
            loose += share
    head = surface.limbs.index("head")
    top = surface.ends[head, 1]
    neck = surface.joint_centres[head, 1]
    height = (surface.vertices[:, 1] - neck) / (top - neck)
    behind = surface.vertices[:, 0] < surface.joint_centres[head, 0] + 0.03
    hair = (surface.weights[:, head] > 0.6) & ((height > 0.78) | (behind & (height > 0.35)))
    colours[hair] = _HAIR
    return Clothes(colours, patterned, np.clip(loose, 0, 1), rng.uniform(0, 2 * np.pi, (3, 3)))


def cloth_offsets(surface: Surface, clothes: Clothes, amplitude: float, time: float) -> Array:
    """Return how far cloth stands off the skin, (n_vertices,) m: never inward, and waving.

    Parameters
    ----------
    amplitude
        m, the most.
    time
        s.
    """
    waves = np.zeros(surface.n_vertices)
    for k, (scale, pace) in enumerate(((9.0, 5.0), (17.0, 8.0), (31.0, 11.0))):
        phases = surface.vertices * scale + clothes.phases[k]
        waves += np.sin(phases + pace * time).prod(axis=1) / (k + 1)
    offsets: Array = amplitude * clothes.looseness * np.clip(0.5 + 0.6 * waves, 0.0, 1.0)
    return offsets
