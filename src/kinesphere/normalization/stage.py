"""Normalization, from the search for the default position to the new frames (paper section 3)."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Motion, Step, settings_as_json
from kinesphere.normalization.account import findings_of, warnings_of
from kinesphere.normalization.alignment import align_limbs
from kinesphere.normalization.body_frame import TURNED_ROUND
from kinesphere.normalization.default_frames import find_default_frames
from kinesphere.normalization.facing import Facing, find_facing
from kinesphere.normalization.propagation import propagate
from kinesphere.normalization.proposal import propose_bodies
from kinesphere.normalization.samples import take_samples
from kinesphere.normalization.settings import NormalizationSettings


def normalize(
    motion: Motion,
    settings: NormalizationSettings | None = None,
    facing: Facing | None = None,
) -> Motion:
    """Align the frame of every limb with the body (Sar Dessai et al. 2006, section 3).

    The frames in which the person stands in the default position give the body's own axes; from
    them and from where each limb points follows a frame per limb, which is carried to all frames.
    The motion itself does not change, only the coordinates that tell it: markers, joint centres
    and covariances of the skeleton move into the new frames with it.

    Parameters
    ----------
    motion
        In the world, y up, with limb frames of any orientation.
    settings
    facing
        The world direction the person faces in the default position (``"+x"``…), or the one
        witness to believe (``"feet"``); by default names of left and right decide, else a vote.

    Raises
    ------
    AmbiguousFacing
        If nothing tells front from back.
    DegenerateMotion
        If the joints do not span a body frame in any frame.
    BadSetting
        If ``facing`` is no known word.
    """
    settings = settings or NormalizationSettings()
    samples = take_samples(motion, settings.sampling, settings.speed_window, settings.fewest)
    proposal = propose_bodies(samples, settings, facing)
    default = find_default_frames(samples, proposal, settings)
    world_from_root = samples.rotations[:, 0]
    verdict = find_facing(
        samples,
        world_from_root @ default.root_from_body,
        default.chosen,
        default.best,
        named=proposal.named,
        facing=facing,
    )
    turn = TURNED_ROUND if verdict.turn_round else np.eye(3)
    bodies = world_from_root @ proposal.root_from_body @ turn
    alignment = align_limbs(samples, bodies, default.chosen, settings.limbs)
    step = Step(
        name="normalization",
        settings=settings_as_json(settings),
        findings=findings_of(samples, default, verdict, alignment),
        warnings=warnings_of(samples, default, alignment, settings.template) + verdict.warnings,
    )
    moved = propagate(motion, alignment.turns, alignment.shifts, alignment.along, alignment.lengths)
    return replace(moved, history=(*motion.history, step))
