"""Turn a recording into the world: y up, right-handed; say who decided it."""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from kinesphere.data import (
    DIRECTIONS,
    Array,
    Json,
    Recording,
    Step,
    TopologicalModel,
    check_settings,
    given_away,
    setting,
    settings_as_json,
)
from kinesphere.data.directions import world_from_up
from kinesphere.quality.body import ENOUGH_FRAMES, find_bodies, find_long_axes, thinned
from kinesphere.quality.chirality import Chirality, find_chirality
from kinesphere.quality.up_axis import judge_up
from kinesphere.quality.upright import find_evidence

MIRRORED = 0.2
"""At most this share of the body parts is the right way round in a mirrored recording: the
recordings at hand have 1.00."""


@dataclass(frozen=True)
class OrientationSettings:
    """How the file's axes become the world's."""

    up: Literal["auto", "+x", "-x", "+y", "-y", "+z", "-z"] = setting(
        "auto",
        "Direction that is up in the file's axes; auto asks the body, then the file, then the "
        "scene",
        choices=("auto", *DIRECTIONS),
    )
    mirrored: Literal["auto", "yes", "no"] = setting(
        "auto",
        "Whether the file shows a mirror image (a left-handed export); auto asks the body",
        choices=("auto", "yes", "no"),
    )

    def __post_init__(self) -> None:
        check_settings(self)


def orient(
    recording: Recording,
    model: TopologicalModel | None = None,
    settings: OrientationSettings | None = None,
) -> Recording:
    """Return the recording in the world: y up, right-handed, and the matrix that took it there.

    Markers are permuted and negated, never turned by an angle or moved: undoing it is exact. Up is
    decided by the user, the body (the head is above the feet), the file's field, the scene, in
    this order; but a body that lies across the file's up, or turns over most of the time, does not
    overrule it. Where left, right, up and front of the body do not fit together, the recording is
    a mirror image and reflected along z. Whatever is overruled or guessed is a warning of the step.

    Parameters
    ----------
    recording
        Positions in any unit; NaN where not seen. Outputs and analog stay as the file has them.
    model
        Whose ``head`` and ``foot`` segments show the body; without it, or where the labels are not
        its own, customary labels do.
    """
    settings = settings or OrientationSettings()
    few = thinned(recording, ENOUGH_FRAMES)
    bodies = find_bodies(few)
    evidence = find_evidence(few, find_long_axes(few, model, bodies))
    wanted = None if settings.up == "auto" else settings.up
    judgement = judge_up(evidence, recording.up, wanted)
    chirality = find_chirality(bodies)
    mirrored, doubts = _judge_mirror(chirality, settings.mirrored)
    turn = world_from_up(judgement.up, mirrored)
    step = Step(
        name="orientation",
        settings=settings_as_json(settings),
        findings={
            "up": judgement.up,
            "up_from": judgement.source,
            "up_of_file": recording.up,
            "upright_share": _by_direction(evidence.upright),
            "floor_sway": _by_direction(evidence.sway),
            "mirrored": mirrored,
            "right_handed_share": _number(chirality.right),
            "world_from_file": (turn @ recording.world_from_file).tolist(),
        },
        warnings=(*judgement.warnings, *doubts),
    )
    return replace(
        recording,
        markers=_turned(recording.markers, turn),
        up="+y",
        world_from_file=turn @ recording.world_from_file,
        history=(*recording.history, step),
    )


def right_handed(recording: Recording, settings: OrientationSettings | None = None) -> Recording:
    """Return the recording, reflected along z where `orient` will say that it is a mirror image.

    For what has to tell left from right before a recording is oriented.
    """
    settings = settings or OrientationSettings()
    bodies = find_bodies(thinned(recording, ENOUGH_FRAMES))
    mirrored, _ = _judge_mirror(find_chirality(bodies), settings.mirrored)
    if not mirrored:
        return recording
    return replace(recording, markers=_turned(recording.markers, np.diag([1.0, 1.0, -1.0])))


def _turned(markers: Array, turn: Array) -> Array:
    """Permute and negate coordinates: exact, where a matrix product would turn -0 and NaN."""
    source = np.abs(turn).argmax(axis=1)
    if (turn == np.eye(3)).all():
        return markers
    turned: Array = np.take(markers, source, axis=-1)
    turned *= turn[np.arange(3), source]
    return given_away(turned)


def _judge_mirror(chirality: Chirality, wanted: str) -> tuple[bool, tuple[str, ...]]:
    looks = chirality.n > 0 and chirality.right <= MIRRORED
    fits = chirality.n > 0 and chirality.right >= 1 - MIRRORED
    found = (
        f"in {chirality.right:.0%} of what shows it, left, up and front of the body fit together"
    )
    if wanted != "auto":
        mirrored = wanted == "yes"
        doubt = fits if mirrored else looks
        return mirrored, (f"mirrored is {wanted} as asked, although {found}",) if doubt else ()
    if looks:
        said = (
            f"only {found}: the recording is a mirror image (or left and right labels are "
            "exchanged) and was reflected; set orientation.mirrored to no if it is not"
        )
        return True, (said,)
    if chirality.n > 0 and not fits:
        said = f"{found}; labels of left and right, or of front and back, may be mixed up"
        return False, (said,)
    return False, ()


def _by_direction(values: Array) -> dict[str, Json]:
    return {d: _number(v) for d, v in zip(DIRECTIONS, values, strict=True)}


def _number(value: float) -> float | None:
    return round(float(value), 4) if np.isfinite(value) else None
