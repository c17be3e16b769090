"""Left and right labels of one part of the body that were exchanged, heels called toes.

A body whose names are all exchanged looks like its mirror image (`find_chirality`). Where only
those of the legs are, trunk, pelvis and feet each look right; but legs do not lie on the other
side of the pelvis, nor elbows on the other side of the trunk, for most of a recording.
"""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, Recording
from kinesphere.quality.body import (
    ENOUGH_FRAMES,
    HEAD,
    HIPS,
    WAIST_BACK,
    WAIST_FRONT,
    Body,
    find_bodies,
    thinned,
)
from kinesphere.quality.chirality import ACROMIA, contradicted_girdles
from kinesphere.quality.feet import exchanged_heel
from kinesphere.quality.findings import Finding

MOST = 0.5
"""Share of frames. Right thighs, knees, elbows and shoulders are on the left in none of the 20,000
frames of 27 recordings, heads in 6 % of one trial, knees in 4 % where an actor's hips go to their
limits."""
NEARLY_ALL = 0.9
"""Share of frames from which on nobody has just crossed their legs, if all thighs and knees say so:
markers at the inside of two knees cross first, and stay so while somebody sits."""
REMEDY = "exchange the two labels of each of these pairs"


class _Part(NamedTuple):
    """Markers of both sides, by how their names begin."""

    name: str
    near: tuple[str, ...]
    """Of the limb that the trunk carries: these decide."""
    beyond: tuple[str, ...]
    """Of the limbs that this one carries: ankles and hands may be crossed, so these do not."""


_PELVIS = (*WAIST_FRONT, *WAIST_BACK, *HIPS)
_PARTS = (
    _Part("pelvis", _PELVIS, ()),
    _Part(
        "legs",
        (*("THI", "TH1", "TH2", "TH3", "TH4", "THP", "THD"), *("KNE", "KNI", "FLE", "FME", "LFC")),
        (
            *("SHN", "SHA", "SHK", "SHP", "SHD", "SK1", "SK2", "SK3", "TIB", "TB", "TTC", "TAM"),
            *("ANK", "ANL", "FAL", "MAL", "LMAL", "MMAL", "HEE", "HEL", "CAL", "FCC", "FT1"),
            *("FT2", "FT3", "FTB", "FTM", "FTF", "FM1", "FM5", "MT", "NAV", "TOE", "BIGTOE"),
            *("SMALLTOE", "MIDFOOT"),
        ),
    ),
    _Part("shoulders", ACROMIA, ()),
    _Part("head", HEAD, ()),
    _Part(
        "arms",
        (
            "UPA",
            "UA1",
            "UA2",
            "UA3",
            "UAP",
            "UAD",
            "BICEP",
            "ELB",
            "IEL",
            "HLE",
            "HME",
            "LEL",
            "MEL",
        ),
        (
            *("FRM", "FA1", "FA2", "FA3", "FAP", "FAD", "FAR", "FAS", "FAU", "WR", "IWR", "OWR"),
            *("RSP", "USP", "RAD", "ULN", "HAND", "IHAND", "OHAND", "HM2", "HM5", "FIN", "MCP"),
        ),
    ),
)


def check_sides(recording: Recording) -> Iterator[Finding]:
    """Find parts of the body whose left and right labels were exchanged, and heels with toes.

    The pelvis tells which way right is; the shoulders where up and front say that the pelvis is
    wrong, the legs where that holds of both. All is told by customary names.
    """
    few = thinned(recording, ENOUGH_FRAMES)
    for body in find_bodies(few):
        yield from _sides(few, body, recording.first_frame)
        yield from _heels(few, body, recording.first_frame)


def _sides(recording: Recording, body: Body, first: int) -> Iterator[Finding]:
    right = _right_of(body)
    if right is None:
        return
    for part in _PARTS:
        shares = {
            columns: share
            for core, columns in body.pairs.items()
            if core.startswith(part.near + part.beyond)
            and (share := _crossed(recording, columns, right)) > MOST
        }
        near = {columns for core, columns in body.pairs.items() if core.startswith(part.near)}
        if not near & shares.keys():
            continue
        pairs = [(recording.labels[left], recording.labels[r]) for left, r in shares]
        share = min(shares[columns] for columns in near & shares.keys())
        told = {columns for columns in near if _seen_together(recording, columns)}
        verb = "are" if share > NEARLY_ALL and told <= shares.keys() else "may be"
        yield Finding(
            "sides",
            "warning",
            f"left and right labels of the {part.name} {verb} exchanged: {_listed(pairs)} lie the "
            f"wrong way round in {share:.0%} of the frames, by what the rest of the body calls "
            "right",
            REMEDY,
            markers=tuple(label for pair in pairs for label in pair),
            frame=first,
            numbers=(("crossed_share", round(share, 4)),),
        )


def _right_of(body: Body) -> Array | None:
    """Return where the body's right is, (n_frames, 3), by the best part that tells it."""
    wrong = contradicted_girdles(body)
    legs = tuple(core for core in body.pairs if core.startswith(_PARTS[1].near))
    for name, cores in (("pelvis", _PELVIS), ("shoulders", ACROMIA), ("legs", legs)):
        right = body.rightwards(cores) if cores else None
        if right is not None and name not in wrong and np.isfinite(right).all(axis=1).any():
            return right
    return None


def _seen_together(recording: Recording, columns: tuple[int, int]) -> bool:
    return bool(recording.seen[:, list(columns)].all(axis=1).any())


def _crossed(recording: Recording, columns: tuple[int, int], right: Array) -> float:
    """Return in which share of the frames that show it the right marker is on the left."""
    left, other = (recording.markers[:, c] for c in columns)
    along = ((other - left) * right).sum(axis=1)
    along = along[np.isfinite(along)]
    return float(np.mean(along < 0)) if len(along) else 0.0


def _heels(recording: Recording, body: Body, first: int) -> Iterator[Finding]:
    exchanged = [pair for side in "LR" if (pair := exchanged_heel(body, side))]
    if exchanged:
        pairs = [(recording.labels[heel], recording.labels[toe]) for heel, toe in exchanged]
        yield Finding(
            "heels",
            "warning",
            f"labels of heel and toe are exchanged: {_listed(pairs)} (what is called toe is nearer "
            "the ankle than what is called heel)",
            REMEDY,
            markers=tuple(label for pair in pairs for label in pair),
            frame=first,
        )


def _listed(pairs: Iterable[tuple[str, str]]) -> str:
    return ", ".join(" and ".join(pair) for pair in pairs)
