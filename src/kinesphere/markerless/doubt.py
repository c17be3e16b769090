"""Whether a start that was found is to be believed: by what it was not found by.

Where silhouettes are cut out of the images themselves, the colours that cut them are the colours
that follow the person, and a limb that begins wrong teaches its own. Edges in the image were asked
for nothing: a body that is where it is said to be has one along nearly all of its rim.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.errors import BadScene
from kinesphere.markerless.fit import Fitter
from kinesphere.markerless.hull import largest_piece_of_space
from kinesphere.markerless.kernels.contour import NOWHERE, project_kernel
from kinesphere.markerless.pose import Pose, posed
from kinesphere.markerless.silhouettes import Silhouettes

Picture = NDArray[np.uint8]

_REACH = 2
"""px to either side of the rim in which an edge counts."""
_COUNTED = 37
"""One in so many pixels is ranked: a prime, so that no pattern is met in step."""
_SIDE = 0.04
"""m, of the cubes of space that nobody explains."""
_ASIDE = 0.04
"""m beyond the model from which on a pixel is not explained by it."""

_SURE_EDGES, _NO_EDGES = 0.96, 0.75
_SURE_OVERLAP, _NO_OVERLAP = 0.86, 0.60
_SURE_BARE = 0.5e-3
"""m³. Starts found right and wrong on rendered films: docs/decisions.md has the table."""
_GIVEN_OVERLAP = 0.75
"""With masks or plates, which know nothing of the start's colours."""
_REMEDY = (
    "give plates of the empty room, a mask of that frame for every camera, a pose estimator's "
    "keypoints, or the pose ([start] in docs/markerless.md)"
)


@dataclass(frozen=True)
class Evidence:
    """What speaks for a start."""

    edges: float
    """0–1: mean rank, among all pixels of its image, of the contrast along the rim."""
    overlap: float
    """0–1, of the model with the silhouettes, mean over the cameras."""
    bare: float
    """m³ of the largest piece of space that the silhouettes show and the model leaves bare."""

    cut_out: bool
    """Whether the silhouettes were cut out of the images, not given or told by plates."""
    moved: bool = True
    """Whether something moved about the frame, so that bare arms are in them."""

    @property
    def against(self) -> tuple[str, ...]:
        """What speaks against the start, in words; nothing where it is to be believed."""
        said = []
        least = _SURE_OVERLAP if self.cut_out else _GIVEN_OVERLAP
        if not self.overlap >= least:
            said.append(f"overlap with the silhouettes {self.overlap:.2f}, less than {least:g}")
        if self.cut_out and not self.edges >= _SURE_EDGES:
            said.append(
                f"edges of the image along the body's rim {self.edges:.2f}, less than {_SURE_EDGES}"
            )
        if self.cut_out and self.bare > _SURE_BARE:
            said.append(f"{self.bare * 1e3:.1f} litres of somebody are left bare")
        if self.cut_out and not self.moved:
            said.append("nothing moves about that frame: bare arms may have been missed")
        return tuple(said)

    @property
    def nobody(self) -> bool:
        """Whether next to nothing speaks for the start."""
        return self.cut_out and not (self.edges >= _NO_EDGES and self.overlap >= _NO_OVERLAP)


def doubt_of(evidence: Evidence, frame: int) -> str:
    """Return what is to be said of a start found in a frame, as people count; or nothing.

    Raises
    ------
    BadScene
        If next to nothing speaks for it.
    """
    if not evidence.against:
        return ""
    why = "; ".join(evidence.against)
    if evidence.nobody:
        raise BadScene(f"the person was not found in frame {frame} ({why}); {_REMEDY}")
    return (
        f"the start is doubtful, arms or more may be elsewhere from the first frame on ({why}): "
        f"look at frame {frame} in the overlays; if it is wrong, {_REMEDY}"
    )


def evidence_of(
    fitter: Fitter,
    pose: Pose,
    pictures: Sequence[Picture | None],
    shown: Silhouettes,
    overlap: float,
) -> Evidence:
    """Return what speaks for a start.

    Parameters
    ----------
    fitter
        Of the body as it was found.
    pictures
        At the views' sizes; None where a camera has none.
    shown
        The silhouettes in which it was found.
    overlap
        Of the model with them.
    """
    edges, bare = _edges(fitter, pose, pictures), _bare(fitter, pose, shown.masks)
    return Evidence(edges, overlap, bare, shown.cut_out, shown.moved)


def contrast(picture: Picture) -> NDArray[np.float32]:
    """Return how strong the strongest edge near each pixel is, as a rank in the image, 0–1."""
    soft = cv2.GaussianBlur(picture, (0, 0), 1.0)
    lab = cv2.cvtColor(soft, cv2.COLOR_RGB2LAB).astype(np.float32)
    slopes = [cv2.Sobel(lab, cv2.CV_32F, *d) for d in ((1, 0), (0, 1))]
    strength = np.sqrt(sum((s * s).sum(axis=2) for s in slopes))
    strength = cv2.dilate(strength, np.ones((2 * _REACH + 1, 2 * _REACH + 1)))
    others = np.sort(strength.ravel()[::_COUNTED])
    return np.asarray(np.searchsorted(others, strength) / len(others), dtype=np.float32)


def _edges(fitter: Fitter, pose: Pose, pictures: Sequence[Picture | None]) -> float:
    points = fitter.body.skinned(posed(fitter.body.chain, pose))
    normals = fitter.body.normals(points)
    total, count = 0.0, 0
    for eye, picture in zip(fitter.eyes, pictures, strict=True):
        if picture is None:
            continue
        rim = eye.canvas.rim(points, normals, eye.canvas.draw(points))
        ranks = contrast(picture)
        col, row = np.rint(rim.pixels).astype(int).T
        shown = (col >= 0) & (col < ranks.shape[1]) & (row >= 0) & (row < ranks.shape[0])
        total += float(ranks[row[shown], col[shown]].sum())
        count += int(shown.sum())
    return total / count if count else float("nan")


def _bare(fitter: Fitter, pose: Pose, masks: Sequence[Picture | None]) -> float:
    """Return how much space in one piece all cameras but one show, and two show bare."""
    points = fitter.body.skinned(posed(fitter.body.chain, pose))
    low, high = points.min(axis=0) - 0.6, points.max(axis=0) + 0.6
    axes = [np.arange(a, b, _SIDE) for a, b in zip(low, high, strict=True)]
    grid: Array = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    shown_by, person_in, bare_in = (np.zeros(len(grid), dtype=int) for _ in range(3))
    pixels, depths = np.empty((len(grid), 2)), np.empty(len(grid))
    for eye, mask in zip(fitter.eyes, masks, strict=True):
        if mask is None:
            continue
        view = eye.canvas.view
        project_kernel(grid, view.rotation, view.shift, view.lens, pixels, depths)
        col, row = np.nan_to_num(np.rint(pixels), nan=-1).clip(-1, 1e6).astype(int).T
        shown = (row >= 0) & (row < view.height) & (col >= 0) & (col < view.width)
        reach = max(1, round(_ASIDE * view.lens[0] / max(float(np.median(depths)), 0.1)))
        model = (eye.canvas.draw(points).limbs != NOWHERE).astype(np.uint8)
        near = cv2.dilate(model, np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)) > 0
        shown_by += shown
        person = mask[row[shown], col[shown]] > 127
        person_in[shown] += person
        bare_in[shown] += person & ~near[row[shown], col[shown]]
    left = grid[(shown_by - person_in <= (shown_by > 3)) & (person_in > 1) & (bare_in > 1)]
    return len(largest_piece_of_space(left, _SIDE)) * _SIDE**3 if len(left) else 0.0
