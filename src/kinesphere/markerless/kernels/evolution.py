"""A contour moves: gradient descent of Φ in a narrow band about its zero level."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Phi = NDArray[np.float32]
Runs = NDArray[np.int32]

_MOST = 6.0  # nats; a pixel's say is cut there, as both densities are guesses
_SIXTEENTH = 16.0  # e^-y is the sixteenth power of e^(-y/16), which a short series gives


@kernel
def band_runs_kernel(phi: Phi, band: float) -> Runs:
    """Return the narrow band as runs, (n_runs, 3): row, first column, the one after the last.

    Parameters
    ----------
    phi : (height, width) px
    band
        px to either side of the contour. The image's outermost pixels are left out.
    """
    height, width = phi.shape
    runs = np.empty((max(0, height - 2) * (width // 2), 3), dtype=np.int32)
    count = 0
    for row in range(1, height - 1):
        line = phi[row]
        before = False
        for col in range(1, width - 1):
            now = abs(line[col]) < band
            if now and not before:
                runs[count, 0] = row
                runs[count, 1] = col
            elif before and not now:
                runs[count, 2] = col
                count += 1
            before = now
        if before:
            runs[count, 2] = width - 1
            count += 1
    return runs[:count].copy()


@kernel
def _changes(
    above: Phi,
    here: Phi,
    below: Phi,
    force: Phi,
    prior: Phi,
    length: np.float32,
    shape: np.float32,
    inside_delta: bool,
    width_px: np.float32,
    rate: np.float32,
    change: Phi,
) -> None:
    """Write the changes along one run; single precision and no branch, so that it vectorises."""
    half, quarter, one, two = np.float32(0.5), np.float32(0.25), np.float32(1), np.float32(2)
    third, tiny, most = np.float32(1 / 3), np.float32(1e-6), np.float32(_MOST)
    fifth = np.float32(1 / 5)
    peak = np.float32(1 / np.sqrt(2 * np.pi)) / width_px
    narrow = np.float32(0.5 / _SIXTEENTH) / (width_px * width_px)
    for i in range(len(change)):
        c = here[i + 1]
        px, py = half * (here[i + 2] - here[i]), half * (below[i + 1] - above[i + 1])
        pxx, pyy = here[i + 2] - two * c + here[i], below[i + 1] - two * c + above[i + 1]
        pxy = quarter * (below[i + 2] - below[i] - above[i + 2] + above[i])
        slope = px * px + py * py + tiny
        curvature = (pxx * py * py - two * px * py * pxy + pyy * px * px) / (slope * np.sqrt(slope))
        curvature = min(max(curvature, -one), one)
        z = min(narrow * c * c, one)
        root = one - z * (
            one - half * z * (one - third * z * (one - quarter * z * (one - fifth * z)))
        )
        root *= root
        root *= root
        root *= root
        delta = peak * root * root
        drive = min(max(force[i], -most), most) + length * curvature
        to_prior = two * shape * (prior[i] - c)
        if inside_delta:
            change[i] = rate * delta * (drive + to_prior)
        else:
            change[i] = rate * (delta * drive + to_prior)


@kernel
def evolve_kernel(
    phi: Phi,
    runs: Runs,
    force: Phi,
    length: float,
    shape: float,
    prior: Phi,
    inside_delta: bool,
    width_px: float,
    rate: float,
    steps: int,
) -> float:
    """Move Φ by ``steps`` of gradient descent in a narrow band about its zero level.

    Equation 2; with ``shape`` > 0 equation 4, whose last term is by the energy's own derivative
    outside H'(Φ)(…), and inside it as printed where ``inside_delta`` is set.

    Parameters
    ----------
    phi : (height, width) px
        Positive inside. Changed.
    runs : (n_runs, 3)
        The band, as `band_runs_kernel` gives it.
    force : (height, width)
        log p₁/p₂ of each pixel of the band.
    length
        ν, weight of the contour's length.
    shape
        λ, in 1/px: weight of staying near ``prior``, Φ₀ of the projected surface.
    width_px
        Standard deviation of H', in px.
    rate
        Time step.
    steps

    Returns
    -------
    float
        Mean change of Φ in the last step, in px, over the band.
    """
    count = 0
    for k in range(len(runs)):
        count += runs[k, 2] - runs[k, 1]
    change = np.zeros(count, dtype=np.float32)
    for _ in range(steps):
        at = 0
        for k in range(len(runs)):
            row, first, end = runs[k, 0], runs[k, 1], runs[k, 2]
            _changes(
                phi[row - 1, first - 1 : end + 1],
                phi[row, first - 1 : end + 1],
                phi[row + 1, first - 1 : end + 1],
                force[row, first:end],
                prior[row, first:end],
                np.float32(length),
                np.float32(shape),
                inside_delta,
                np.float32(width_px),
                np.float32(rate),
                change[at : at + end - first],
            )
            at += end - first
        at = 0
        for k in range(len(runs)):
            line = phi[runs[k, 0], runs[k, 1] : runs[k, 2]]
            for i in range(len(line)):
                line[i] += change[at + i]
            at += len(line)
    moved = 0.0
    for i in range(count):
        moved += abs(change[i])
    return moved / max(count, 1)
