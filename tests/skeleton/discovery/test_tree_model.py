"""What the model of a tree expects at its joints."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from kinesphere.geometry.rigid import into_frame
from kinesphere.skeleton import discover, fit_skeleton
from kinesphere.synthetic import make_performance, spoil_with_noise

POOR = ("head", "left_foot", "right_foot")


@pytest.mark.slow
def test_a_limb_of_two_markers_that_arms_hang_from_by_doubtful_joints_holds_no_marker():
    """The neck was put where two of the trunk's markers are, 303 mm off and told ± 79."""
    performance = make_performance(np.random.default_rng(508))
    recording = spoil_with_noise(
        performance.recording, np.random.default_rng([508, 3]), deviation=1e-3
    )
    owner = {label: limb.name for limb in performance.skeleton.limbs for label in limb.markers}
    worn: Counter[str] = Counter()
    kept = []
    for at, label in enumerate(recording.labels):
        worn[owner[label]] += 1
        if owner[label] not in POOR or worn[owner[label]] <= 2:
            kept.append(at)
    hidden = tuple(f"*{i}" for i in range(len(kept)))
    unknown = replace(
        recording, markers=recording.markers[:, kept], labels=hidden, residuals=None, history=()
    )
    model = discover(unknown).model
    limb = {h: owner[recording.labels[at]] for h, at in zip(hidden, kept, strict=True)}
    name = {
        s.name: Counter(limb[m] for m in s.markers).most_common(1)[0][0] for s in model.segments
    }
    skeleton = (motion := fit_skeleton(unknown, model)).skeleton
    (neck,) = (j for j in skeleton.joints if {name[j.parent], name[j.child]} == {"trunk", "head"})
    parent = skeleton.limb_names.index(neck.parent)
    at = [frozenset((joint.parent, joint.child)) for joint in performance.skeleton.joints].index(
        frozenset(("trunk", "head"))
    )
    true = into_frame(
        motion.rotations[:, parent],
        motion.origins[:, parent],
        performance.joint_centres[:, at][:, None],
    )
    off = np.linalg.norm(neck.centre_in_parent - np.nanmean(true[:, 0], axis=0))
    assert off < 2 * np.sqrt(np.trace(neck.covariance))
