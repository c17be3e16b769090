"""A tiny BVH reader and forward kinematics, written from the format alone: the writer's oracle."""

import numpy as np
from scipy.spatial.transform import Rotation


def evaluate(path):
    """Return node → (parent, offset, channels), node → positions, node → rotations, frame time.

    Positions (n_frames, 3) in the file's unit and rotations (n_frames, 3, 3) are global. End sites
    are called ``NODE_end``.
    """
    words = path.read_text().split()
    assert words[0] == "HIERARCHY"
    nodes, open_nodes, last, i = {}, [], None, 1
    while words[i] != "MOTION":
        if words[i] in ("ROOT", "JOINT"):
            last, i = words[i + 1], i + 2
        elif words[i] == "End":
            last, i = f"{open_nodes[-1]}_end", i + 2
        elif words[i] == "{":
            parent = open_nodes[-1] if open_nodes else None
            nodes[last] = [parent, None, []]
            open_nodes.append(last)
            i += 1
        elif words[i] == "}":
            open_nodes.pop()
            i += 1
        elif words[i] == "OFFSET":
            nodes[open_nodes[-1]][1] = np.array(words[i + 1 : i + 4], dtype=float)
            i += 4
        elif words[i] == "CHANNELS":
            n = int(words[i + 1])
            nodes[open_nodes[-1]][2] = words[i + 2 : i + 2 + n]
            i += 2 + n
        else:
            raise AssertionError(f"unexpected word {words[i]!r}")
    assert words[i + 1] == "Frames:"
    assert words[i + 3 : i + 5] == ["Frame", "Time:"]
    n_frames, frame_time = int(words[i + 2]), float(words[i + 5])
    values = np.array(words[i + 6 :], dtype=float).reshape(n_frames, -1)

    positions, rotations, column = {}, {}, 0
    for name, (parent, offset, channels) in nodes.items():
        place = np.tile(offset, (n_frames, 1))
        turn = np.tile(np.eye(3), (n_frames, 1, 1))
        for channel in channels:
            numbers = values[:, column]
            column += 1
            axis = "XYZ".index(channel[0])
            if channel.endswith("position"):
                place[:, axis] = numbers
            else:
                assert channel.endswith("rotation")
                turn = turn @ Rotation.from_euler("xyz"[axis], numbers[:, None], degrees=True).as_matrix()
        if parent is not None:
            place = positions[parent] + (rotations[parent] @ place[..., None])[..., 0]
            turn = rotations[parent] @ turn
        positions[name], rotations[name] = place, turn
    assert column == values.shape[1]
    return nodes, positions, rotations, frame_time
