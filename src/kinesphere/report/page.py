"""One HTML file that shows a solution: it opens offline and carries everything it needs."""

import base64
import hashlib
import json
from typing import Any

from markupsafe import Markup

import kinesphere
from kinesphere.data import Solution
from kinesphere.report.assets_of import asset, environment
from kinesphere.report.bodies import find_bodies
from kinesphere.report.clinical import clinical_section
from kinesphere.report.joint_table import chart_order, joint_rows
from kinesphere.report.limb_table import limb_rows
from kinesphere.report.moments import moment_rows
from kinesphere.report.notices import names_of, notices
from kinesphere.report.scene import scene_from_solution
from kinesphere.report.step_cards import step_cards
from kinesphere.report.tiles import tiles

SCRIPTS = (
    "unpack.js",
    "space.js",
    "figure.js",
    "mesh.js",
    "pick.js",
    "hand.js",
    "player.js",
    "curves.js",
    "track.js",
    "heat.js",
    "selection.js",
    "paper.js",
    "page.js",
)
"""The page's own program, in the order in which the parts build on each other."""
_NOTHING = Markup()


def report_html(solution: Solution, title: str = "", extra: Markup = _NOTHING) -> str:
    """Return the report of a solution as one self-contained HTML page.

    The page holds a player of the motion, the curve of every angle and residual, and a table a
    stage. Trials above 60 Hz or beyond 24,000 frames are thinned for display, which the page
    says; figures in tables are of every frame.

    Parameters
    ----------
    solution
        As ``kinesphere.solve`` returns it.
    title
        A name for the recording; its model and length, if empty.
    extra
        A further section: `tracking_section` of a motion without markers.
    """
    joints = joint_rows(solution)
    scene = scene_from_solution(solution)
    moments, more = moment_rows(solution)
    script = Markup("\n".join(asset(name) for name in SCRIPTS))
    page = environment().from_string(asset("page.html.j2"))
    return page.render(
        title=title or "Solved motion",
        version=kinesphere.__version__,
        tiles=tiles(solution),
        warnings=notices(solution.warnings, names_of(solution.skeleton)),
        joints=joints,
        charts=chart_order(joints),
        limbs=limb_rows(solution),
        steps=step_cards(solution),
        bodies=bodies_section(solution),
        moments=moments,
        moments_more=more,
        extra=extra,
        clinical=clinical_section(solution),
        stride=scene["stride"],
        shown_rate=f"{scene['rate']:g}",
        style=Markup(asset("page.css")),
        script=script,
        # Only this very script may run: whatever a label smuggles in stays text.
        script_hash=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
        scene=Markup(_json_for_script(scene)),
    )


def bodies_section(solution: Solution) -> Markup:
    """Return what was found from motion alone as HTML; empty where a model was given."""
    bodies = find_bodies(solution)
    if bodies is None:
        return Markup()
    return Markup(environment().from_string(asset("bodies.html.j2")).render(found=bodies))


def _json_for_script(found: Any) -> str:
    """Return JSON that cannot close the script element it stands in."""
    text = json.dumps(found, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
