"""What a format has no place for: said when a recording is converted to it."""

from kinesphere.data import Recording


def left_behind(recording: Recording, suffix: str) -> tuple[str, ...]:
    """Return what of a recording a file of this suffix cannot hold, a phrase each."""
    if suffix not in (".trc", ".csv"):
        return ()
    held = {
        "analog channels": 0 if recording.analog is None else len(recording.analog.labels),
        "outputs of the vendor": len(recording.outputs),
        "events": len(recording.events),
    }
    lost = [f"{number} {what}" for what, number in held.items() if number]
    if recording.residuals is not None:
        lost.append("the residuals of the points")
    if suffix == ".csv" and recording.first_frame != 1:
        lost.append(f"the number of the first frame ({recording.first_frame})")
    return tuple(lost)
