"""``kinesphere settings``: every setting of every stage."""

from typing import Annotated, Any

import typer

from kinesphere.cli.options import BadArgument, JsonOption, SetOption, SettingsOption


def settings(
    stage: Annotated[
        str | None, typer.Argument(metavar="[STAGE]", help="Only this one, with sources.")
    ] = None,
    assignments: SetOption = None,
    settings_file: SettingsOption = None,
    as_json: JsonOption = False,
) -> None:
    """Show every setting: value, unit, range, what it does.

    Examples: [bold]kinesphere settings[/bold], [bold]kinesphere settings axes[/bold]
    """
    from kinesphere.cli.console import print_json, print_setting, print_title, stdout
    from kinesphere.cli.options import settings_from_options

    rows = setting_rows(settings_from_options(assignments, settings_file))
    if stage is not None and stage not in rows:
        raise BadArgument(f"no stage is called {stage!r}; known are {', '.join(rows)}")
    shown = {stage: rows[stage]} if stage is not None else rows
    if as_json:
        print_json(shown)
        return
    console = stdout()
    for name, entries in shown.items():
        print_title(console, name)
        for entry in entries:
            value = " ".join(
                part for part in (value_in_words(entry["value"]), entry["unit"]) if part
            )
            lines = [entry["doc"]]
            if stage is not None and entry["source"]:
                lines.append(f"source: {entry['source']}")
            print_setting(console, f"{name}.{entry['key']}", value, allowed_in_words(entry), lines)


def setting_rows(values: Any) -> dict[str, list[dict[str, Any]]]:
    """Return stage → its settings, each with value, type, unit, range, choices, doc, source."""
    from kinesphere.pipeline import settings_fields, stage_settings, type_as_text

    return {
        name: [
            {
                "key": field.name,
                "value": value,
                "type": type_as_text(annotation),
                **{k: field.metadata[k] for k in ("unit", "low", "high", "doc", "source")},
                "choices": list(field.metadata["choices"]),
            }
            for field, annotation, value in settings_fields(part)
        ]
        for name, part in stage_settings(values).items()
    }


def value_in_words(value: Any) -> str:
    """Return a setting's value as a person would write it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None or value == "":
        return "none" if value is None else '""'
    return f"{value:g}" if isinstance(value, float) else str(value)


def allowed_in_words(entry: dict[str, Any]) -> str:
    """Return what one of ``setting_rows`` may be: its choices, its range, or its type."""
    if entry["choices"]:
        return ", ".join(entry["choices"])
    low, high = entry["low"], entry["high"]
    if low is None and high is None:
        return str(entry["type"])
    if high is None:
        return f"≥ {low:g}"
    return f"≤ {high:g}" if low is None else f"{low:g} … {high:g}"
