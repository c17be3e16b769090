"""A skeleton with other limb lengths: all by one factor, or some limbs by their own."""

from collections.abc import Mapping
from dataclasses import replace

from kinesphere import __version__
from kinesphere.data import Skeleton, Step
from kinesphere.errors import BadModel, BadSetting

LEAST, MOST = 0.01, 100.0


def scaled_skeleton(
    skeleton: Skeleton, factor: float = 1.0, limbs: Mapping[str, float] | None = None
) -> Skeleton:
    """Return a skeleton whose limbs are longer or shorter; axes and rest positions stay.

    Everything in a limb's frame is scaled about its origin: joint centres, markers, length.

    Parameters
    ----------
    factor
        Of every limb.
    limbs
        Limb → a further factor of its own.

    Raises
    ------
    BadSetting
        If a factor is not between 0.01 and 100.
    BadModel
        If a limb does not exist.
    """
    own = dict(limbs or {})
    if odd := sorted(set(own) - set(skeleton.limb_names)):
        raise BadModel(
            f"there is no limb {odd[0]!r}; the limbs are {', '.join(skeleton.limb_names)}"
        )
    by = {name: factor * own.get(name, 1.0) for name in skeleton.limb_names}
    if bad := [f for f in by.values() if not LEAST <= f <= MOST]:
        raise BadSetting(
            f"limbs are to be {bad[0]:g} times as long; {LEAST:g} to {MOST:g} are right"
        )
    step = Step("scaling", {"factor": factor, "limbs": dict(own)}, version=__version__)
    return replace(
        skeleton,
        limbs=tuple(
            replace(
                limb,
                length=limb.length * by[limb.name],
                marker_positions=limb.marker_positions * by[limb.name],
            )
            for limb in skeleton.limbs
        ),
        joints=tuple(
            replace(
                joint,
                centre_in_parent=joint.centre_in_parent * by[joint.parent],
                centre_in_child=joint.centre_in_child * by[joint.child],
                covariance=joint.covariance * by[joint.parent] ** 2,
                residual=joint.residual * by[joint.parent],
            )
            for joint in skeleton.joints
        ),
        history=(*skeleton.history, step),
    )
