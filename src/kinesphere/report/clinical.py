"""The page's table of clinical joint angles after the ISB."""

import numpy as np
from markupsafe import Markup

from kinesphere.data import Solution
from kinesphere.data.isb import GIMBAL_MARGIN_DEG, IsbAngles, isb_angles
from kinesphere.report.assets_of import asset, environment
from kinesphere.report.wording import degrees_span, in_words

_OFTEN = 0.01  # share of frames from which a warning catches the eye


def clinical_section(solution: Solution) -> Markup:
    """Return the clinical angles of every named joint as HTML; empty where no joint has a name."""
    found = isb_angles(solution.motion, solution.skeleton)
    if not found.joints:
        return Markup()
    page = environment().from_string(asset("clinical.html.j2"))
    return Markup(page.render(rows=_rows(found), margin=f"{GIMBAL_MARGIN_DEG:g}"))


def _rows(found: IsbAngles) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for j, joint in enumerate(found.joints):
        seen = np.isfinite(found.margins[:, j])
        near = float(found.gimbal[seen, j].mean()) if seen.any() else 0.0
        spans = [degrees_span(np.rad2deg(values)) for values in found.angles[:, j].T]
        turn = f"{np.rad2deg(joint.turn):+.0f}° {joint.turn_from}" if joint.turn else "body"
        rows.append(
            {
                "name": in_words(joint.name),
                "sequence": joint.convention.sequence,
                "angles": [
                    (in_words(name), span)
                    for name, span in zip(joint.angle_names, spans, strict=True)
                ],
                "axis": turn,
                "near": f"{near:.1%}" if near else "never",
                "often": near >= _OFTEN,
            }
        )
    return rows
