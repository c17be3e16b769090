"""Two axes of one joint that are told by different recordings, put together."""

from dataclasses import replace
from itertools import chain

import numpy as np

from kinesphere.data import Array, Json
from kinesphere.parameterization.anatomy import nominal_axes, wanted_n_axes
from kinesphere.parameterization.axis_figures import PER_AXIS
from kinesphere.parameterization.joint_fit import JointFit, angles_between, or_null

OF_THE_PAIR = ("explained", "other_reading_deg", "held_out_deg", "held_out_body_deg")
"""Findings that say nothing about two axes of different recordings."""
SOMEWHERE = "another recording"


def told_axes(fit: JointFit, name: str) -> tuple[int, ...]:
    """Return which axes that move the limb were told by a movement, not put across another."""
    if fit.source == "body":
        return ()
    swings = range(len(fit.axes) - _n_swings(fit, name), len(fit.axes))
    return tuple(k for k in swings if not (fit.assumed and fit.assumed[k]))


def counterpart(fit: JointFit, k: int, other: JointFit, name: str) -> int | None:
    """Return which axis of another fit is the same axis of the joint as axis ``k`` of this one.

    By what anatomy calls them, flexion or abduction; where nobody named the joint, the nearer
    one. None where the other has none of the kind.
    """
    mine, theirs = _n_swings(fit, name), _n_swings(other, name)
    if mine == theirs == 1:
        return len(other.axes) - 1
    kinds, of_others = (_kinds(one.axes[-n:], name) for one, n in ((fit, mine), (other, theirs)))
    alike = np.abs(of_others @ kinds[k - len(fit.axes)])
    nearest = int(alike.argmax())
    if alike[nearest] < np.cos(np.deg2rad(45.0)):
        return None
    return len(other.axes) - theirs + nearest


def doubted(fit: JointFit, k: int) -> list[str]:
    """Return what is doubted of one axis that serves, each a clause."""
    if fit.half_told:
        remark = fit.findings.get("remark")
        return [remark] if isinstance(remark, str) and remark in fit.doubts else []
    clauses = [_split(doubt) for doubt in fit.doubts]
    return [said for axis, said in clauses if axis in (None, k)]


def joined(
    base: JointFit,
    donor: JointFit,
    place: int,
    given: int,
    closest: float,
    turn: Array | None = None,
    unsure: float = 0.0,
) -> JointFit | None:
    """Return a joint of two axes with one of them taken from elsewhere; None if they are too close.

    The rest orientation and the order of the axes are those of ``base``. A proximal axis lies the
    same in the parent wherever the limb is, a distal one turns about it: where it was seen is part
    of the rest orientation, so ``base`` had better be what told the distal axis.

    Parameters
    ----------
    base
        With two axes, at least one of which is told beside ``place``.
    donor
        Axes of the same joint by another movement.
    place
        Which axis of ``base`` is replaced.
    given
        By which axis of ``donor``.
    closest
        rad; two axes closer than this are one.
    turn : (3, 3), optional
        From the donor's parent frame into that of ``base``; the same frame if None.
    unsure
        rad, standard deviation of ``turn``.
    """
    axes, kept = np.array(base.axes), 1 - place
    axis = donor.axes[given] if turn is None else turn @ donor.axes[given]
    if abs(float(axis @ axes[kept])) > np.cos(closest):
        return None
    axes[place] = axis / np.linalg.norm(axis)
    uncertainty = np.array(base.uncertainty)
    uncertainty[place] = np.hypot(donor.uncertainty[given], unsure)
    doubts = {kept: doubted(base, kept), place: doubted(donor, given)}
    said = [f"axis {k + 1}: {doubt}" for k in (0, 1) for doubt in doubts[k]]
    findings: dict[str, Json] = {
        key: value for key, value in base.findings.items() if key not in OF_THE_PAIR
    }
    for key in PER_AXIS:
        figures = [_at(base, key, k) for k in (0, 1)]
        figures[place] = _at(donor, key, given)
        findings[key] = figures
    findings |= {
        "n_axes_by_data": 2,
        "axes_uncertainty_deg": or_null(np.rad2deg(uncertainty)),
        "axes_apart_deg": angles_between(axes),
        "doubts": list(said),
        "remark": "; ".join(dict.fromkeys(chain(*doubts.values()))) or None,
    }
    origins = [_origin(base, kept), _origin(donor, given)]
    return replace(
        base,
        axes=axes,
        uncertainty=uncertainty,
        findings=findings,
        doubts=tuple(said),
        assumed=(),
        half_told=False,
        reused_from=tuple(origins if place == 1 else origins[::-1]),
    )


def _n_swings(fit: JointFit, name: str) -> int:
    return min(len(fit.axes), wanted_n_axes(name))


def _kinds(axes: Array, name: str) -> Array:
    """Return which of the body's axes each is, (n_axes, 3); itself where nobody named the joint."""
    nominal = nominal_axes(name, axes)
    return axes if nominal is None else nominal


def _split(doubt: str) -> tuple[int | None, str]:
    """Return which axis a clause is about, and what it says of it."""
    for k in range(3):
        if doubt.startswith(head := f"axis {k + 1}: "):
            return k, doubt.removeprefix(head)
    return None, doubt


def _at(fit: JointFit, key: str, k: int) -> Json:
    figures = fit.findings.get(key)
    return figures[k] if isinstance(figures, list | tuple) and k < len(figures) else None


def _origin(fit: JointFit, k: int) -> str:
    """Return the recording an axis comes from; empty for the one that is solved."""
    if fit.source != "reused":
        return ""
    return fit.reused_from[k] if fit.reused_from else SOMEWHERE
