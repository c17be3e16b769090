"""The front door: quick, quiet, and everything behind it by name."""

import os
import subprocess
import sys

import pytest

import kinesphere

QUICK = 0.3  # s; an empty interpreter aside


def python(code, **environment):
    """Run code in a fresh interpreter; return what it printed."""
    ran = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
        check=False,
    )
    assert ran.returncode == 0, ran.stderr
    assert ran.stderr == ""
    return ran.stdout.strip()


def test_importing_is_quick_and_fetches_nothing_heavy():
    told = python(
        "import time; start = time.process_time(); import kinesphere;"
        "took = time.process_time() - start; import sys;"
        "print(took, *({'numpy', 'scipy', 'numba', 'ezc3d', 'rich', 'typer'} & {*sys.modules}))"
    ).split()
    assert float(told[0]) < QUICK
    assert told[1:] == []


def test_what_no_extra_brought_is_not_needed_to_import_and_to_ask_for_help():
    code = (
        "import sys; sys.modules.update(dict.fromkeys(['cv2', 'av', 'viser']));"
        "import kinesphere as ks; [getattr(ks, name) for name in dir(ks)];"
        "import kinesphere.cli.main; print(ks.solve.__name__)"
    )
    assert python(code) == "solve"


def test_importing_everything_touches_nothing(tmp_path):
    home = tmp_path / "home"
    home.mkdir()
    home.chmod(0o500)
    code = (
        "import os, kinesphere as ks; before = set(os.listdir('.'));"
        "[getattr(ks, name) for name in dir(ks)];"
        "assert set(os.listdir('.')) == before; print(os.listdir(os.environ['HOME']))"
    )
    assert python(code, HOME=str(home)) == "[]"


def test_every_name_is_there():
    names = "read write solve Settings report_html Recording Motion Parameters Skeleton Solution"
    more = "TopologicalModel KinesphereError motion_from_parameters Edit apply_edits __version__"
    for name in [*names.split(), *more.split()]:
        assert getattr(kinesphere, name) is not None
        assert name in dir(kinesphere)


def test_a_name_that_is_not_there_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'sovle'"):
        _ = kinesphere.sovle
