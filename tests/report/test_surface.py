"""The surface in the page: what comes back is what was bound."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import default_origins
from kinesphere.editing import attach_surface
from kinesphere.pipeline import solve
from kinesphere.report.packing import unpack
from kinesphere.report.scene import scene_from_solution
from kinesphere.report.surface import MOST_VERTICES, pack_surface
from kinesphere.synthetic import make_performance

TENTH_MM = 1e-4


@pytest.fixture(scope="module")
def solved():
    true = make_performance(np.random.default_rng(3), rate=10.0, calibration_s=12.0, free_s=2.0)
    return solve(true.recording, true.model, calibration=true.calibration)


def test_it_comes_back(solved):
    surface = attach_surface(solved.motion)
    mesh, arrays = pack_surface(surface, solved.skeleton)
    back = {name: unpack(packed) for name, packed in arrays.items()}
    assert_allclose(back["mesh_vertices"], surface.vertices, atol=TENTH_MM)
    assert_array_equal(np.round(back["mesh_faces"]), surface.faces)
    assert_array_equal(np.round(back["mesh_limbs"]), surface.weight_limbs)
    assert_allclose(back["mesh_weights"].sum(axis=1), 1.0, atol=2e-3)
    assert_allclose(back["mesh_weights"], surface.weight_shares, atol=3e-3)
    assert_allclose(mesh["rest"], default_origins(solved.skeleton), atol=1e-6)


def test_a_solution_with_a_surface_has_it_in_its_scene(solved):
    scene = scene_from_solution(solved)
    assert "mesh_vertices" in scene["arrays"]
    assert [limb["parent"] for limb in scene["limbs"]] == list(solved.skeleton.parents)


def test_none_and_too_fine_ones_stay_out(solved, solution):
    assert pack_surface(None, solved.skeleton) == (None, {})
    assert scene_from_solution(solution)["mesh"] is None

    class Fine:
        n_vertices = MOST_VERTICES + 1

    assert pack_surface(Fine(), solved.skeleton) == (None, {})
