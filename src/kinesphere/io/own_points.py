"""Points and outputs of a C3D file that this program computed: results, no measurements."""

import re
from dataclasses import replace

from kinesphere import __version__
from kinesphere.data import Recording, Step
from kinesphere.io.c3d.renew import OURS
from kinesphere.io.c3d.source import KEY, Source

CENTRE = "joint centre between {} and {}"
TURNS = "angles of {} against {}: {}"
"""How `kinesphere.io.joint_points` describes them in the file."""
_CENTRE = re.compile(CENTRE.format(r"\S.*", r"\S.*"))
_TURNS = re.compile(TURNS.format(r"\S.*", r"\S.*", r".+"))
LISTED = 6
"""Names in the warning."""


def without_own_points(recording: Recording) -> Recording:
    """Return the recording without the joint centres and angles that a solution put into its file.

    Told by what the file says of itself: our group of parameters, and the descriptions of its
    points. A label alone, ``left_hip``, says nothing. The history tells what is left out.
    """
    source = recording.details.get(KEY)
    if not isinstance(source, Source):
        return recording
    section = source.layout.section
    if not any(group.name == OURS for group in section.groups):
        return recording
    described = section.texts("POINT", "DESCRIPTIONS")
    told = dict(zip(source.labels, described, strict=False))
    centres = [label for label in recording.labels if _CENTRE.fullmatch(told.get(label, ""))]
    outputs = tuple(o for o in recording.outputs if not _TURNS.fullmatch(told.get(o.label, "")))
    if not centres and len(outputs) == len(recording.outputs):
        return recording
    kept = [i for i, label in enumerate(recording.labels) if label not in set(centres)]
    residuals, sure = recording.residuals, recording.confidence
    listed = ", ".join([*centres[:LISTED], *(["…"] if len(centres) > LISTED else [])])
    step = Step(
        "computed points",
        findings={"left_out": list(centres)},
        warnings=(
            f"{len(centres)} points are joint centres that Kinesphere computed, as the file says, "
            f"no markers, and left out: {listed}",
        )
        if centres
        else (),
        version=__version__,
    )
    return replace(
        recording,
        markers=recording.markers[:, kept],
        labels=tuple(recording.labels[i] for i in kept),
        residuals=None if residuals is None else residuals[:, kept],
        confidence=None if sure is None else sure[kept],
        outputs=outputs,
        history=(*recording.history, step),
    )
