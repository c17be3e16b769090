"""How well two series of one quantity agree."""

from dataclasses import dataclass

import numpy as np
from scipy.signal import correlate
from scipy.stats import t as student

from kinesphere.data import Array

_NORMAL = 1.96  # standard deviations that hold 95 %


@dataclass(frozen=True)
class Agreement:
    """Two series side by side, the second minus the first; units are theirs."""

    n: int
    """Samples that both have."""
    rmsd: float
    """Root mean square difference."""
    bias: float
    """Mean difference."""
    sd: float
    """Standard deviation of the difference."""
    limits: tuple[float, float]
    """95 % limits of agreement: bias ± 1.96 sd."""
    n_effective: float
    """How many independent samples ``n`` neighbours in time are worth."""
    bias_error: float
    """Half the 95 % confidence interval of the bias, by ``n_effective``; NaN below two."""
    limits_error: float
    """Half the 95 % confidence interval of either limit."""
    slope: float
    """Of the difference against the mean of both; 0 where differences do not grow with size."""
    correlation: float
    """Pearson's; NaN where one of the two is constant."""
    cmc: float
    """Coefficient of multiple correlation; NaN where the two differ more than they vary."""


def agreement(first: Array, second: Array) -> Agreement:
    """Return how well two series agree [1]_, with what neighbours in time are worth [2]_.

    Parameters
    ----------
    first, second : (n,)
        Evenly sampled, of one unit; NaN in either leaves a sample out. Angles unwrapped.

    Returns
    -------
    Agreement
        NaN throughout, with ``n`` 0, where no sample is in both.

    References
    ----------
    .. [1] Bland & Altman (1999), Stat. Methods Med. Res. 8(2), 135-160; the coefficient of multiple
       correlation between protocols: Ferrari, Cutti & Cappello (2010), Gait & Posture 31(4),
       540-542.
    .. [2] Geyer (1992), Statist. Sci. 7(4), 473-483: initial positive sequence.
    """
    difference = second - first
    known = np.isfinite(difference)
    n = int(known.sum())
    if n == 0:
        nan = float("nan")
        return Agreement(0, nan, nan, nan, (nan, nan), nan, nan, nan, nan, nan, nan)
    x, y, d = first[known], second[known], difference[known]
    bias, sd = float(d.mean()), float(d.std(ddof=1)) if n > 1 else float("nan")
    n_effective = effective_samples(difference)
    wide = float(student.ppf(0.975, n_effective - 1)) if n_effective > 2 else float("nan")
    return Agreement(
        n=n,
        rmsd=float(np.sqrt(np.mean(d**2))),
        bias=bias,
        sd=sd,
        limits=(bias - _NORMAL * sd, bias + _NORMAL * sd),
        n_effective=n_effective,
        bias_error=wide * sd / np.sqrt(n_effective),
        limits_error=wide * sd * np.sqrt(3 / n_effective),
        slope=_slope((x + y) / 2, d),
        correlation=_correlation(x, y),
        cmc=_cmc(x, y),
    )


def effective_samples(series: Array) -> float:
    """Return how many independent samples a series is worth, between 1 and its number of values.

    Parameters
    ----------
    series : (n,)
        Evenly sampled; NaN is a gap.
    """
    known = np.isfinite(series)
    n = int(known.sum())
    if n < 3:
        return float(n)
    centred = np.where(known, series - series[known].mean(), 0.0)
    variance = float((centred**2).sum()) / n
    if variance <= np.finfo(float).eps ** 2 * float((series[known] ** 2).mean()):
        return float(n)  # a constant difference: nothing to correlate
    lags = len(series) - 1
    products = correlate(centred, centred, method="fft")[lags:]
    pairs = np.round(correlate(known * 1.0, known * 1.0, method="fft")[lags:])
    rho = np.where(pairs > 0, products / np.maximum(pairs, 1) / variance, 0.0)
    sums = rho[: len(rho) // 2 * 2].reshape(-1, 2).sum(axis=1)
    stop = int(np.argmax(sums <= 0)) if (sums <= 0).any() else len(sums)
    shares = pairs / n  # how many samples have a neighbour so far away
    inefficiency = 2 * float((shares * rho)[: 2 * stop].sum()) - 1 if stop else 1.0
    return float(np.clip(n / max(inefficiency, 1.0), 1.0, n))


def _slope(mean: Array, difference: Array) -> float:
    spread = mean - mean.mean()
    size = float(spread @ spread)
    return float(spread @ difference) / size if size > 0 else float("nan")


def _correlation(x: Array, y: Array) -> float:
    x, y = x - x.mean(), y - y.mean()
    size = float(np.sqrt((x @ x) * (y @ y)))
    return float(x @ y) / size if size > 0 else float("nan")


def _cmc(x: Array, y: Array) -> float:
    n = len(x)
    each = np.stack([x, y])
    between = float(((each - each.mean(axis=0)) ** 2).sum()) / n
    overall = float(((each - each.mean()) ** 2).sum()) / (2 * n - 1)
    share = 1 - between / overall if overall > 0 else float("nan")
    return float(np.sqrt(share)) if share >= 0 else float("nan")
