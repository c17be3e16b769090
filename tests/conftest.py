"""Fixtures every test may use."""

import os
from pathlib import Path

import numpy as np
import pytest


@pytest.fixture
def rng(request):
    """Give every test its own generator, the same on every run."""
    return np.random.default_rng(list(request.node.nodeid.encode()))


@pytest.fixture(scope="session")
def recordings():
    """Return the folder of real recordings; skip where it is absent, unless that is forbidden."""
    default = Path(__file__).parents[2] / "shared" / "data"
    folder = Path(os.environ.get("KINESPHERE_DATA", default))
    if folder.is_dir():
        return folder
    if os.environ.get("KINESPHERE_DATA_REQUIRED"):
        pytest.fail(f"real recordings are required but {folder} is no folder")
    return pytest.skip(f"no real recordings at {folder}; set KINESPHERE_DATA")
