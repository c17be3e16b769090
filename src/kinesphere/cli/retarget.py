"""``kinesphere retarget``: a motion on other limb lengths, or on the rig of another program."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kinesphere.cli.options import (
    BadArgument,
    JsonOption,
    SetOption,
    SettingsOption,
    settings_from_options,
)

if TYPE_CHECKING:
    from kinesphere.data import Motion, Solution
    from kinesphere.pipeline import Settings


def retarget(
    source: Annotated[
        Path, typer.Argument(metavar="DIR", help="A solved folder; or a motion: .bvh, .amc.")
    ],
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            metavar="OUT",
            help="What to write: for a rig a file of its format (in others its skeleton alone), "
            "else a folder or a file whose suffix says the format.",
        ),
    ],
    onto: Annotated[
        Path | None,
        typer.Option(
            "--onto",
            metavar="RIG",
            help="A rig (.bvh, .glb, .gltf), or a solved folder for its limb lengths.",
        ),
    ] = None,
    height: Annotated[
        float | None,
        typer.Option(
            "--height",
            metavar="M",
            help="The same skeleton, so many metres tall, instead of a rig.",
        ),
    ] = None,
    mapping: Annotated[
        Path | None,
        typer.Option(
            "--map",
            metavar="MAP.toml",
            help='Limbs that names and shape do not tell: left_thigh = "Bein_L" under [rig].',
        ),
    ] = None,
    assignments: SetOption = None,
    settings_file: SettingsOption = None,
    as_json: JsonOption = False,
) -> None:
    """Put a motion on another skeleton: limbs point as they did, feet stand where they stand.

    A rig comes back in its own format with the motion on it, everything else in it untouched; where
    OUT has another suffix, the rig's skeleton alone is written in that format, with the motion on
    it (a BVH rig as .glb: bones without a body).
    Limbs are known by their names (Mixamo, Unity, Unreal, Rigify, CMU…) or by the shape of the
    rest pose, T, A or standing.

    Examples: [bold]kinesphere retarget walk --onto character.glb -o walking.glb[/bold],
    [bold]kinesphere retarget walk --onto actor.bvh -o actor-walking.bvh[/bold],
    [bold]kinesphere retarget walk --height 1.55 -o small[/bold]
    """
    from kinesphere.cli.console import print_json, print_pairs, print_title, print_warnings, stdout
    from kinesphere.cli.files import REPORT, check_apart, check_target
    from kinesphere.data import Motion, Solution
    from kinesphere.io import check_solution_place, read, read_parts

    if (onto is None) == (height is None):
        raise BadArgument("name either --onto RIG or --height M, and not both")
    check_apart(output, source, onto, mapping, settings_file)
    if output.suffix and not output.is_dir():
        check_target(output)
    else:
        check_solution_place(output, [REPORT])
    parts = read_parts(mapping) if mapping is not None else {"rig": {}, "source": {}}
    settings = settings_from_options(assignments, settings_file)
    found = read(source)
    if not isinstance(found, Solution | Motion):
        raise BadArgument(
            f"{source} holds a {type(found).__name__}; a solved folder or a motion is wanted"
        )
    result, notes = _retargeted(found, onto, height, output, parts, settings)
    motion = result.motion if isinstance(result, Solution) else result
    step = next(s for s in reversed(motion.history) if s.name == "retargeting")
    warnings = [*step.warnings, *notes]
    summary: dict[str, Any] = {"output": str(output), **step.findings}
    if as_json:
        print_json({**summary, "settings": dict(step.settings), "warnings": warnings})
        return
    console = stdout()
    told = str(onto) if onto is not None else f"{height:g} m tall"
    print_title(console, str(source), f"onto {told}")
    print_pairs(console, _in_words(step.findings))
    if warnings:
        print_title(console, "Warnings")
        print_warnings(console, warnings)
    console.print(f"\nWritten: {output}", soft_wrap=True)


def _retargeted(
    found: "Solution | Motion",
    onto: Path | None,
    height: float | None,
    output: Path,
    parts: dict[str, dict[str, str]],
    settings: "Settings",
) -> "tuple[Solution | Motion, tuple[str, ...]]":
    """Return the result after it was written, and what the rig has no place for."""
    from kinesphere.cli.convert import part_for, write_as_set
    from kinesphere.cli.files import write_solved
    from kinesphere.data import Skeleton, Solution
    from kinesphere.editing import stature
    from kinesphere.editing.scaling import LEAST, MOST
    from kinesphere.io import read, read_rig, rig_format, write_on_rig
    from kinesphere.pipeline import retarget as put

    target: Any
    rig = None if onto is None else rig_format(onto)
    if onto is None:
        assert height is not None
        motion = found.motion if isinstance(found, Solution) else found
        tall = stature(motion)
        target = height / tall
        if not LEAST <= target <= MOST:
            raise BadArgument(
                f"--height {height:g}: the figure is {tall:.2f} m tall, and {LEAST * tall:.2g} to "
                f"{MOST * tall:.3g} m can be made of it"
            )
    elif rig is not None:
        target = read_rig(onto)
    else:
        target = read(onto)
        if not isinstance(target, Solution | Skeleton):
            raise BadArgument(
                f"{onto} holds a {type(target).__name__}; a rig (.bvh, .glb, .gltf) or a solved "
                "folder is wanted"
            )
    result = put(found, target, settings=settings, parts=parts["rig"], source_parts=parts["source"])
    if onto is not None and rig is not None and output.suffix.lower() == f".{rig}":
        return result, write_on_rig(result, onto, output)
    if isinstance(result, Solution) and (output.is_dir() or not output.suffix):
        write_solved(result, output, f"{output.name}, retargeted", settings.bvh)
    else:
        part = part_for(result, output) if isinstance(result, Solution) else result
        write_as_set(part, output, settings)
    return result, ()


def _in_words(findings: Any) -> list[tuple[str, str]]:
    pairs = [
        ("legs", f"{findings['scale']:.3f} times as long"),
        ("limbs told by", str(findings["parts_from"])),
    ]
    if "contacts" in findings:
        pairs += [
            ("contacts", f"{findings['contacts']}, in each the foot stands still"),
            ("would have slid", f"{findings['slide_before_mm']:.1f} mm on the mean"),
            ("pelvis lowered by", f"{findings['pelvis_lowered_mm']:.0f} mm at most"),
        ]
        if findings["missed_mm"] > 0.1:
            pairs.append(("out of reach", f"{findings['missed_mm']:.0f} mm at most"))
    return pairs
