"""Axes from another recording that do not serve here: doubtful ones, and those that do not fit."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kinesphere.parameterization.joined import doubted
from kinesphere.parameterization.joint_angles import solve_joint
from kinesphere.parameterization.joint_fit import JointFit
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.third_axis import fit_axes
from kinesphere.parameterization.view import JointView
from kinesphere.parameterization.zero import OUT_OF_REACH

WORSE = 2.0  # times: so much farther off, or less sure, than the recording's own axes, at least
FAR = np.deg2rad(2.0)  # rms, and farther than they by as much: less is how a limb is dressed
LARGELY = 0.5  # of the frames, and
WRONG = np.deg2rad(10.0)  # rms: no skin and no marker put on anew keeps a limb so far from its axes
NEAR = np.deg2rad(5.0)  # rms: own axes from which a limb stays farther away are not worth more


class _Miss(NamedTuple):
    """How a limb stays away from where its axes can take it."""

    share: float
    """Of the frames in which it is seen: out of reach."""
    rms: float
    """rad; NaN where it is never seen."""


def there_or_own(
    there: JointFit,
    own: JointFit | None,
    view: JointView,
    settings: ParameterizationSettings,
    *,
    give_way: bool,
) -> JointFit:
    """Return axes from another recording, or those from here where the former had better not serve.

    A functional trial is made for its axes to serve elsewhere, so they do where nothing was
    doubted of them, unless that is plainly wrong: out of reach in half of the frames and 10° rms
    off, where this recording's own axes keep the limb within 5° rms. Where they are doubted, or one
    was put across another, they give way to own axes that are not doubted or that suit clearly
    better.

    A limb may leave the reach of any axes a little (a hinge's cone above all); so where it does
    often, the recording's own axes, found as if none were reused, are the measure.

    Parameters
    ----------
    there
        From another recording, in the frames of this one.
    own
        As this recording tells them; None to have them found, if they are needed.
    give_way
        False for those from there in any case; where they do not fit, they say so (``misfit``).
    """
    doubtful = give_way and (there.half_told or _doubted(there))
    theirs = _miss(there, view, settings)
    if not doubtful and theirs.share <= OUT_OF_REACH:
        return there
    own = fit_axes(view, settings) if own is None else own
    ours = _miss(own, view, settings)
    often = theirs.share > OUT_OF_REACH
    far = often and theirs.rms >= max(WORSE * ours.rms, ours.rms + FAR)
    off = (
        f"out of their reach in {theirs.share:.0%} of the frames and "
        f"{np.rad2deg(theirs.rms):.1f}° rms off instead of {np.rad2deg(ours.rms):.1f}° by its own"
    )
    wrong = give_way and far and theirs.share > LARGELY and theirs.rms > WRONG and ours.rms <= NEAR
    why = []
    if doubtful and (far or _surer(own, there)):
        why.append("doubtful where they come from")
    if far and (doubtful or wrong):
        why.append(off)
    if not why:
        return replace(there, misfit=off) if far else there
    said = f"{_names(there)}{', '.join(why)}"
    return replace(own, gave_way=said, findings={**own.findings, "not_reused": said})


def _doubted(fit: JointFit) -> bool:
    return bool(fit.loose) or any(doubted(fit, k) for k in range(len(fit.axes)))


def _surer(own: JointFit, there: JointFit) -> bool:
    """Return whether a movement tells as much here, and without doubt or clearly better."""
    if own.n_told < there.n_told:
        return False
    return not (own.doubts or own.loose) or WORSE * _largest(own) <= _largest(there)


def _largest(fit: JointFit) -> float:
    known = fit.uncertainty[np.isfinite(fit.uncertainty)]
    return float(known.max()) if len(known) else np.nan


def _names(fit: JointFit) -> str:
    names = [name for name in dict.fromkeys(fit.reused_from) if name]
    return f"from {' and '.join(names)}: " if names else ""


def _miss(fit: JointFit, view: JointView, settings: ParameterizationSettings) -> _Miss:
    excess = solve_joint(view, fit.axes, fit.rest, settings).excess
    excess = excess[np.isfinite(excess)]
    if not len(excess):
        return _Miss(0.0, np.nan)
    limit = np.deg2rad(settings.angles.unreachable)
    return _Miss(float((excess > limit).mean()), float(np.sqrt((excess**2).mean())))
